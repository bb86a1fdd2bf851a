#include "dynamics/eigenmodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Scales of the components that make rows and columns of a matrix alike in size (Osborne): powers of two.
Eigen::VectorXd balance(Eigen::MatrixXd& matrix) {
  const Eigen::Index n = matrix.rows();
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(n);
  for (int sweep = 0, changed = 1; changed != 0 && sweep < 100; ++sweep) {
    changed = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double diagonal = std::abs(matrix(i, i));
      const double row = matrix.row(i).lpNorm<1>() - diagonal, column = matrix.col(i).lpNorm<1>() - diagonal;
      if (!(row > 0.0) || !(column > 0.0)) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (factor == 1.0) continue;
      matrix.row(i) /= factor;
      matrix.col(i) *= factor;
      scales[i] *= factor;
      changed = 1;
    }
  }
  return scales;
}

std::vector<Eigen::Index> order_of(const Eigen::VectorXcd& values) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  // Of a pair both have the same size, bit by bit, as they are conjugate.
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index i, Eigen::Index j) {
    const double a = std::abs(values[i]), b = std::abs(values[j]);
    return a != b ? a < b : values[i].imag() > values[j].imag();
  });
  return order;
}

}  // namespace

Eigenmodes eigenmodes(const Derivative& matrix) {
  Eigenmodes result;
  const Eigen::Index n = matrix.value.rows();
  result.values.resize(n);
  result.vectors.resize(n, n);
  result.errors.resize(n);
  if (n == 0) return result;
  Eigen::MatrixXd balanced = matrix.value;
  const Eigen::VectorXd scales = balance(balanced);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(balanced);
  Eigen::MatrixXcd right = solver.eigenvectors();
  // Left eigenvectors are the rows of the inverse; a matrix without enough eigenvectors gets large ones, as it should.
  const Eigen::MatrixXcd left = right.fullPivLu().inverse();
  Eigen::MatrixXd wrong = scales.cwiseInverse().asDiagonal() * matrix.error * scales.asDiagonal();
  const double size = balanced.norm();
  wrong.array() += eps * size;
  // Where eigenvalues fall together an error of the matrix moves them by its root.
  const double meeting = std::sqrt(wrong.norm() * std::max(size, wrong.norm()));
  const std::vector<Eigen::Index> order = order_of(solver.eigenvalues());
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index i = order[static_cast<std::size_t>(k)];
    result.values[k] = solver.eigenvalues()[i];
    result.vectors.col(k) = scales.asDiagonal() * right.col(i);
    const double moved = (left.row(i).cwiseAbs() * wrong * right.col(i).cwiseAbs()).value();
    result.errors[k] = std::isfinite(moved) ? std::min(moved, meeting) : meeting;
  }
  return result;
}

}  // namespace koppel

#include "closure/continuation_lu.hpp"

#include <cmath>
#include <utility>

namespace koppel {
namespace {

/// y -= a x for complex numbers stored as pairs; std::complex would test each product for NaN.
void subtract(const std::complex<double>* x, std::complex<double> a, std::complex<double>* y, Eigen::Index n) {
  const double* u = reinterpret_cast<const double*>(x);
  double* v = reinterpret_cast<double*>(y);
  const double re = a.real(), im = a.imag();
  for (Eigen::Index i = 0; i < 2 * n; i += 2) {
    v[i] -= re * u[i] - im * u[i + 1];
    v[i + 1] -= re * u[i + 1] + im * u[i];
  }
}

}  // namespace

bool SmallLu::factorise() {
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    std::complex<double>* column = &matrix(0, k);
    Eigen::Index pivot = k;
    double largest = 0.0;
    for (Eigen::Index i = k; i < n; ++i) {
      const double size = std::norm(column[i]);
      if (size > largest) largest = size, pivot = i;
    }
    pivots_[k] = pivot;
    if (!(largest > 0.0) || !std::isfinite(largest)) return false;
    if (pivot != k) matrix.row(k).swap(matrix.row(pivot));
    const std::complex<double> inverse = std::conj(column[k]) / std::norm(column[k]);
    for (Eigen::Index i = k + 1; i < n; ++i) column[i] *= inverse;
    for (Eigen::Index j = k + 1; j < n; ++j) {
      subtract(column + k + 1, matrix(k, j), matrix.data() + j * n + k + 1, n - k - 1);
    }
  }
  return true;
}

void SmallLu::solve(Eigen::VectorXcd& b) const {
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index k = 0; k < n; ++k) std::swap(b[k], b[pivots_[k]]);
  for (Eigen::Index k = 0; k < n; ++k) subtract(matrix.data() + k * n + k + 1, b[k], b.data() + k + 1, n - k - 1);
  for (Eigen::Index k = n; k-- > 0;) {
    const std::complex<double> d = matrix(k, k);
    b[k] *= std::conj(d) / std::norm(d);
    subtract(matrix.data() + k * n, b[k], b.data(), k);
  }
}

}  // namespace koppel

#include "dynamics/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

constexpr double rounding = 1e-13;  // part of the forces' size
constexpr double dependent = 1e-9;  // reciprocal condition below which states do not come to rest by themselves

/// Lets internal states follow the coordinates to where they rest. False: they have no such place.
bool condense(const Derivative& by_all, Eigen::Index f, Derivative& by_coordinates) {
  const Eigen::Index n = by_all.value.cols() - f;
  by_coordinates.value = by_all.value.topLeftCorner(f, f);
  by_coordinates.error = by_all.error.topLeftCorner(f, f);
  if (n == 0) return true;
  const Eigen::FullPivLU<Eigen::MatrixXd> of_states(by_all.value.bottomRightCorner(n, n));
  if (!(of_states.rcond() > dependent)) return false;
  const Eigen::MatrixXd follow = -of_states.solve(by_all.value.bottomLeftCorner(n, f));
  const Eigen::MatrixXd backed = -of_states.inverse().transpose() * by_all.value.topRightCorner(f, n).transpose();
  by_coordinates.value += by_all.value.topRightCorner(f, n) * follow;
  const Eigen::MatrixXd size = follow.cwiseAbs(), back = backed.transpose().cwiseAbs();
  by_coordinates.error += by_all.error.topRightCorner(f, n) * size + back * by_all.error.bottomLeftCorner(n, f) +
                          back * by_all.error.bottomRightCorner(n, n) * size;
  return true;
}

/// Eigenvalues, ascending, with the directions in scaled independent coordinates.
void decompose(const Eigen::MatrixXd& scaled, bool symmetric, Eigen::VectorXd& values, Eigen::MatrixXd& directions) {
  if (symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (scaled + scaled.transpose()));
    values = solver.eigenvalues();
    directions = solver.eigenvectors();
    return;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(scaled);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(scaled.rows()));
  std::iota(order.begin(), order.end(), 0);
  const Eigen::VectorXd real = solver.eigenvalues().real();
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return real[a] < real[b]; });
  const Eigen::MatrixXd vectors = solver.eigenvectors().real();
  values.resize(real.size());
  directions.resize(real.size(), real.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = real[order[i]];
    directions.col(static_cast<Eigen::Index>(i)) = vectors.col(order[i]);
  }
}

}  // namespace

std::uint32_t Stiffness::count(Holding kind) const {
  return static_cast<std::uint32_t>(std::count(holding.begin(), holding.end(), kind));
}

bool find_stiffness(const Mechanism& mechanism, Statics& statics, double force_scale, Stiffness& stiffness) {
  const Eigen::Index f = statics.freedoms();
  stiffness = {};
  stiffness.directions.resize(mechanism.nv, f);
  if (f == 0) return true;
  Derivative by_all, scaled;
  Eigen::Index failed = -1;
  const auto beside = [&](const Eigen::VectorXd& z, Eigen::VectorXd& r) { return statics.evaluate(z, r); };
  const Eigen::VectorXd middle = Eigen::VectorXd::Zero(statics.size());
  if (!differentiate(beside, middle, Eigen::VectorXd::Ones(statics.size()), by_all, failed)) return false;
  stiffness.states_held = !condense(by_all, f, scaled);
  scaled.value = -scaled.value;
  const Eigen::VectorXd unscale = statics.scale().cwiseInverse();
  stiffness.matrix.value = unscale.asDiagonal() * scaled.value * unscale.asDiagonal();
  stiffness.matrix.error = unscale.asDiagonal() * scaled.error * unscale.asDiagonal();
  const Eigen::MatrixXd skew = 0.5 * (scaled.value - scaled.value.transpose());
  const double size = scaled.value.cwiseAbs().maxCoeff();
  // A symmetric error moves an eigenvalue by no more than its norm.
  stiffness.error = std::max(scaled.error.norm(), rounding * std::max(size, force_scale));
  stiffness.circulatory = skew.norm() > 10.0 * stiffness.error;
  Eigen::MatrixXd directions;
  decompose(scaled.value, !stiffness.circulatory, stiffness.eigenvalues, directions);
  for (const double value : stiffness.eigenvalues) {
    stiffness.holding.push_back(value > stiffness.error    ? Holding::stable
                                : value < -stiffness.error ? Holding::unstable
                                                           : Holding::indifferent);
  }
  stiffness.directions = statics.follow() * directions;
  const Eigen::Map<const Eigen::VectorXd> of_rates(mechanism.rate_scale.data(), mechanism.nv);
  for (Eigen::Index i = 0; i < f; ++i) {
    auto direction = stiffness.directions.col(i);
    Eigen::Index greatest = 0;
    direction.cwiseQuotient(of_rates).cwiseAbs().maxCoeff(&greatest);
    if (direction[greatest] != 0.0) direction /= direction[greatest] / of_rates[greatest];
  }
  return true;
}

}  // namespace koppel

#include "dynamics/rest_search.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

constexpr double balanced = 1e-10;      // part of the forces' size that may be left
constexpr double settled = 1e-9;        // scaled: by how much what is left may displace
constexpr double slack = 1e-7;          // part of the greatest stiffness below which a direction is not held
constexpr double stencil = 0x1p-13;     // scaled step of the differences on the way
constexpr double first_radius = 0.125;  // scaled: how far the first step may go
constexpr double loop_radius = 0.5;     // and any step where loops have to close
constexpr double curved_radius = 1.0;   // or rotations to be unique
constexpr double least_radius = 1e-12;
constexpr double far = 1e6;  // scaled distance from the start at which forces are said to drive it away
constexpr std::uint32_t usual_iterations = 200;
constexpr int polishing = 4;  // steps at most that only lessen rounding

}  // namespace

RestSearch::RestSearch(const Mechanism& mechanism, Statics& statics, std::uint32_t max_iterations)
    : mechanism_(mechanism),
      statics_(statics),
      most_(max_iterations > 0 ? max_iterations : usual_iterations),
      weight_(statics.motion().inertias().mass * mechanism.gravity.norm() * mechanism.length) {}

bool RestSearch::fail(std::string why) {
  why_ = std::move(why);
  return false;
}

/// Evaluates where the statics stand, with central differences.
bool RestSearch::look() {
  const Eigen::Index n = statics_.size(), f = statics_.freedoms();
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n), ahead, behind;
  broken_ = true;
  if (!statics_.evaluate(z, place_.r)) return fail("nothing can be evaluated there");
  place_.jacobian.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    z[j] = stencil;
    if (!statics_.evaluate(z, ahead)) return fail("nothing can be evaluated beside it");
    z[j] = -stencil;
    if (!statics_.evaluate(z, behind)) return fail("nothing can be evaluated beside it");
    z[j] = 0.0;
    place_.jacobian.col(j) = (ahead - behind) / (2.0 * stencil);
  }
  broken_ = false;
  if (f > 0) stiffest_ = std::max(stiffest_, place_.jacobian.topLeftCorner(f, f).cwiseAbs().maxCoeff());
  newton_.setZero(n);
  if (n == 0) return true;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(slack);
  factors.compute(place_.jacobian);
  newton_ = factors.solve(-place_.r);
  return true;
}

double RestSearch::residual() const {
  const Eigen::Index f = statics_.freedoms();
  const double force = f > 0 ? place_.r.head(f).lpNorm<Eigen::Infinity>() : 0.0;
  const Eigen::Index states = place_.r.size() - f;
  const double rate = states > 0 ? place_.r.tail(states).lpNorm<Eigen::Infinity>() : 0.0;
  return std::max(force > 0.0 ? force / force_scale() : 0.0, rate);
}

bool RestSearch::is_balanced() const { return residual() <= balanced && error() <= settled; }

/// The coordinate along which the greatest force acts, or the state that changes fastest.
std::string RestSearch::strongest() const {
  Eigen::Index i = 0;
  if (place_.r.size() == 0) return "nothing";
  place_.r.cwiseAbs().maxCoeff(&i);
  return statics_.name(i);
}

double RestSearch::most_radius() const {
  if (mechanism_.rows > 0) return loop_radius;
  const bool curved = std::any_of(mechanism_.blocks.begin(), mechanism_.blocks.end(),
                                  [](const StateBlock& block) { return !is_scalar(block.kind); });
  return curved ? curved_radius : std::numeric_limits<double>::infinity();
}

/// Newton's steps as long as each takes half of what is left: down to rounding. Leaves the best place.
bool RestSearch::polish() {
  for (int i = 0; i < polishing; ++i) {
    const double before = residual();
    const Place best = place_;
    const Eigen::VectorXd q = statics_.q(), states = statics_.states(), newton = newton_;
    Eigen::VectorXd r;
    if (before == 0.0 || !statics_.evaluate(newton, r) || !statics_.move_on() || !look() || residual() > 0.5 * before) {
      if (!statics_.stand(q, states)) return fail("nothing can be evaluated there");
      return look();
    }
    ++iterations_;
  }
  return true;
}

/// The step that gains most by the forces and their stiffness here, no longer than the radius (Moré and Sorensen).
/// What nothing holds and nothing pushes stays.
Eigen::VectorXd RestSearch::step_within(double radius) const {
  const Eigen::MatrixXd stiffness = -0.5 * (place_.jacobian + place_.jacobian.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness);
  const Eigen::VectorXd& values = solver.eigenvalues();
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * place_.r;
  const double held = slack * values.cwiseAbs().maxCoeff();
  const double push = balanced * force_scale();
  double least = std::numeric_limits<double>::infinity();
  const auto moves = [&](Eigen::Index i) { return values[i] > held || std::abs(along[i]) > push; };
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (moves(i)) least = std::min(least, values[i]);
  }
  const auto step = [&](double shift) {
    Eigen::VectorXd parts = Eigen::VectorXd::Zero(values.size());
    for (Eigen::Index i = 0; i < parts.size(); ++i) {
      if (moves(i)) parts[i] = along[i] / (values[i] + shift);
    }
    return parts;
  };
  if (least > held && step(0.0).norm() <= radius) return newton_;
  double low = std::max(0.0, -least), high = low + along.norm() / radius;
  for (int i = 0; i < 60 && high - low > 1e-3 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (step(middle).norm() > radius ? low : high) = middle;
  }
  return solver.eigenvectors() * step(high);
}

/// Stands where the statics were evaluated last; back where it was if nothing can be evaluated there.
bool RestSearch::advance() {
  const Eigen::VectorXd q = statics_.q(), states = statics_.states();
  ++iterations_;
  if (statics_.move_on() && look()) return true;
  const bool plugin = statics_.motion().obstacle() == Obstacle::plugin;
  if (plugin || !statics_.stand(q, states) || !look()) {
    broken_ = true;
    return false;
  }
  return fail("the way leads into a singular position of the loops, pushed on along " + strongest());
}

/// A plugin failed when it was asked last.
bool RestSearch::plugin_failed(bool evaluated) {
  if (!evaluated && statics_.motion().obstacle() == Obstacle::plugin) broken_ = true;
  return broken_;
}

bool RestSearch::descend() {
  const Eigen::VectorXd start = statics_.q();
  Eigen::VectorXd r, travelled(mechanism_.nv);
  double radius = first_radius;
  if (!look()) return false;
  while (true) {
    if (is_balanced()) return polish();
    if (iterations_ >= most_) {
      return fail("the forces do not come to balance in " + std::to_string(most_) + " steps: " + strongest() +
                  " is pushed most");
    }
    const Eigen::VectorXd z = step_within(radius);
    const double length = z.norm();
    const double foreseen = place_.r.dot(z) + 0.5 * z.dot(place_.jacobian * z);
    // What the forces do on the way, by the trapezoidal rule: exact enough where the potential would drown in rounding.
    const bool there = statics_.evaluate(z, r);
    if (plugin_failed(there)) return false;
    const double gain = there ? 0.5 * z.dot(place_.r + r) : 0.0;
    const double quality = there && foreseen > 0.0 ? gain / foreseen : 0.0;
    if (quality < 0.25) radius = 0.25 * length;
    if (quality > 0.75 && length > 0.9 * radius) radius = std::min(2.0 * radius, most_radius());
    if (quality < 0.1) {
      if (radius > least_radius) continue;
      return fail(there ? "the forces along " + strongest() + " jump"
                        : "the loops let it go no further, though the forces push on along " + strongest());
    }
    if (!advance()) return false;
    difference(mechanism_, start, statics_.q(), travelled);
    for (Eigen::Index i = 0; i < travelled.size(); ++i) {
      if (std::abs(travelled[i]) < far * mechanism_.rate_scale[static_cast<std::size_t>(i)]) continue;
      return fail("the forces drive " + mechanism_.rate_names[static_cast<std::size_t>(i)].name + " away without end");
    }
  }
}

bool RestSearch::find_root() {
  double damping = 1e-3;
  if (!look()) return false;
  while (true) {
    if (is_balanced()) return polish();
    if (iterations_ >= most_) return fail("no root of the forces was found in " + std::to_string(most_) + " steps");
    // Forces over their size, so that they and the rates of states weigh alike.
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(place_.r.size());
    if (force_scale() > 0.0) weights.head(statics_.freedoms()).setConstant(1.0 / force_scale());
    const Eigen::MatrixXd j = weights.asDiagonal() * place_.jacobian;
    const Eigen::VectorXd r = weights.cwiseProduct(place_.r);
    const Eigen::VectorXd slope = j.transpose() * r;
    const Eigen::MatrixXd normal = j.transpose() * j;
    const double size = normal.diagonal().maxCoeff();
    if (!(slope.norm() > 1e-9 * r.norm() * std::sqrt(size))) {
      return fail("the forces along " + strongest() + " do not vanish near by: here they are least");
    }
    Eigen::MatrixXd damped = normal;
    damped.diagonal().array() += damping * size;
    Eigen::VectorXd z = -damped.ldlt().solve(slope), beside;
    const double too_long = z.head(statics_.freedoms()).norm() / std::min(most_radius(), curved_radius);
    if (too_long > 1.0) z /= too_long;
    const bool there = statics_.evaluate(z, beside);
    if (plugin_failed(there)) return false;
    const bool better = there && weights.cwiseProduct(beside).norm() < r.norm();
    damping *= better ? 0.1 : 10.0;
    if (better && !advance()) return false;
    if (damping > 1e12) {
      return fail("the forces along " + strongest() + " do not vanish near by: here they are least");
    }
  }
}

}  // namespace koppel

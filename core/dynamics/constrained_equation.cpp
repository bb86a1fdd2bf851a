#include "dynamics/constrained_equation.hpp"

#include <cmath>
#include <limits>

namespace koppel {

ConstrainedEquation::ConstrainedEquation(EquationsOfMotion& motion)
    : MultiplierEquation(motion, AfterSteps::leave),
      near_(motion.mechanism()),
      rates_now_(Eigen::VectorXd::Zero(rates_)),
      accelerations_(rates_now_),
      multipliers_(Eigen::VectorXd::Zero(motion.mechanism().rows)),
      opening_(multipliers_),
      efforts_(rates_now_),
      moved_(rates_now_),
      moved_rate_(rates_now_),
      position_(motion.mechanism().nq) {}

ConstrainedEquation::Sizes ConstrainedEquation::sizes() const {
  const Mechanism& mechanism = motion_.mechanism();
  return {mechanism.unknowns, mechanism.internal_start.size(), static_cast<Eigen::Index>(motion_.conditions().size())};
}

/// The first columns are those that are not driven.
void ConstrainedEquation::take(const Eigen::VectorXd& of_rates, double* to) const {
  const Mechanism& mechanism = motion_.mechanism();
  for (std::uint32_t i = 0; i < mechanism.unknowns; ++i) to[i] = of_rates[mechanism.rate_of_column[i]];
}

void ConstrainedEquation::put(const double* from, Eigen::VectorXd& of_rates) const {
  const Mechanism& mechanism = motion_.mechanism();
  for (std::uint32_t i = 0; i < mechanism.unknowns; ++i) of_rates[mechanism.rate_of_column[i]] = from[i];
}

void ConstrainedEquation::gather(const Eigen::VectorXd& y, Eigen::VectorXd& u) const {
  const auto [n, s, m] = sizes();
  u.resize(2 * n + s + 1);
  for (Eigen::Index i = 0; i < n; ++i) u[i] = y[motion_.mechanism().rate_of_column[static_cast<std::size_t>(i)]];
  u.segment(n, n) = rates_of(y).head(n);
  u.tail(s + 1) = y.tail(s + 1);
}

bool ConstrainedEquation::stand(double time, const Eigen::VectorXd& u) {
  put(u.data(), delta_);
  put(u.data() + sizes().coordinates, rates_now_);
  return motion_.drive(chart_, time, delta_, rates_now_) && motion_.stand(chart_, time, delta_, rates_now_);
}

bool ConstrainedEquation::spread(double time, const Eigen::VectorXd& u, Eigen::VectorXd& y) {
  const bool stands = stand(time, u);
  const Eigen::Index others = sizes().states + 1;
  y.resize(size());
  y.head(rates_) = delta_;
  write(rates_now_, y);
  y.tail(others) = u.tail(others);
  return stands;
}

bool ConstrainedEquation::begin(double time, const Eigen::VectorXd& y, Eigen::VectorXd& u_rate,
                                Eigen::VectorXd& lambda) {
  y_rate_.resize(size());
  if (!rate(time, y, y_rate_)) return false;
  gather(y_rate_, u_rate);
  const Eigen::VectorXd& all = motion_.multipliers();
  lambda.resize(sizes().conditions);
  for (std::size_t i = 0; i < motion_.conditions().size(); ++i) {
    lambda[static_cast<Eigen::Index>(i)] = all[motion_.conditions()[i]];
  }
  return u_rate.allFinite() && lambda.allFinite();
}

bool ConstrainedEquation::residual(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& u_rate,
                                   const Eigen::VectorXd& lambda, const Eigen::VectorXd& mu, Eigen::VectorXd& missing) {
  const auto [n, s, m] = sizes();
  const std::vector<std::uint32_t>& kept = motion_.conditions();
  const Mechanism& mechanism = motion_.mechanism();
  if (!stand(time, u) || !motion_.opening_rates(opening_)) return false;
  missing.resize(2 * n + s + 1 + 2 * m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const std::uint32_t row = kept[static_cast<std::size_t>(i)];
    missing[2 * n + s + 1 + i] = motion_.closure()[row];
    missing[2 * n + s + 1 + m + i] = opening_[row];
    multipliers_[row] = mu[i];
  }
  moved_.setZero();
  motion_.subtract_loops(multipliers_, moved_);
  for (std::uint32_t v = 0; v < mechanism.nv; ++v) {
    moved_[v] = rates_now_[v] + mechanism.rate_scale[v] * mechanism.rate_scale[v] * moved_[v];
  }
  chart_.rates(delta_, moved_, moved_rate_);
  take(moved_rate_, missing.data());
  missing.head(n) = u_rate.head(n) - missing.head(n);

  put(u_rate.data() + n, accelerations_);
  for (Eigen::Index i = 0; i < m; ++i) multipliers_[kept[static_cast<std::size_t>(i)]] = lambda[i];
  double* const of_states = missing.data() + 2 * n;
  if (!motion_.imbalance(u.data() + 2 * n, accelerations_, multipliers_, of_states, efforts_)) return false;
  take(efforts_, missing.data() + n);
  if (!motion_.power(u.data() + 2 * n, of_states[s])) return false;
  missing.segment(2 * n, s + 1) = u_rate.tail(s + 1) - missing.segment(2 * n, s + 1);
  return missing.allFinite();
}

void ConstrainedEquation::unknown_scales(Eigen::VectorXd& of_unknowns) const { gather(scales(), of_unknowns); }

void ConstrainedEquation::move(const Eigen::VectorXd& increment, Eigen::VectorXd& u) {
  if (chart_.is_flat()) {
    u.head(increment.size()) += increment;
    return;
  }
  go_near(u);
  put(increment.data(), moved_);
  near_.position(moved_, position_);
  chart_.coordinates(position_, moved_);
  take(moved_, u.data());
}

void ConstrainedEquation::go_near(const Eigen::VectorXd& u) {
  moved_.setZero();
  put(u.data(), moved_);
  chart_.position(moved_, position_);
  near_.set_base(position_);
}

/// Turns by a constant rate are straight lines of the group; the axes along which rates of a unit vector count turn.
void ConstrainedEquation::bend(const Eigen::VectorXd& u, Eigen::VectorXd& bending) {
  const Eigen::Index n = sizes().coordinates;
  bending.setZero(n);
  const double speed = u.segment(n, n).lpNorm<Eigen::Infinity>();
  if (chart_.is_flat() || !(speed > 0.0)) return;
  go_near(u);
  put(u.data() + n, rates_now_);
  const double ahead = std::cbrt(std::numeric_limits<double>::epsilon()) / speed;
  for (const double way : {ahead, -ahead}) {
    moved_ = way * rates_now_;
    near_.rates(moved_, rates_now_, moved_rate_);
    take(moved_rate_, moved_.data());
    bending += moved_.head(n) / (2.0 * way);
  }
}

}  // namespace koppel

#include "dynamics/minimal_equation.hpp"

#include <limits>

namespace koppel {
namespace {

constexpr double worn_pivot = 1e-2;  // beside the entries of its row
constexpr double worn_turn = 1.0;    // rad, of a chart that ends at a full turn

}  // namespace

MinimalEquation::MinimalEquation(EquationsOfMotion& motion)
    : motion_(motion),
      chart_(motion.mechanism()),
      rates_(motion.mechanism().nv),
      delta_(Eigen::VectorXd::Zero(rates_)),
      delta_rate_(delta_) {
  lay_out();
}

void MinimalEquation::lay_out() {
  const Mechanism& mechanism = motion_.mechanism();
  const std::vector<std::uint32_t>& independent = motion_.independent();
  const auto f = static_cast<Eigen::Index>(independent.size());
  states_ = rates_ + f;
  size_ = states_ + mechanism.internal_start.size() + 1;
  scales_.setConstant(size_, std::numeric_limits<double>::infinity());
  independent_.resize(f);
  for (Eigen::Index i = 0; i < f; ++i) {
    const std::uint32_t rate = independent[static_cast<std::size_t>(i)];
    scales_[rate] = scales_[rates_ + i] = mechanism.rate_scale[rate];
  }
  scales_.segment(states_, mechanism.internal_start.size()).setOnes();
  scales_[size_ - 1] = energy_scale_;
}

void MinimalEquation::set_energy_scale(double joules) { scales_[size_ - 1] = energy_scale_ = joules; }

void MinimalEquation::write(const Eigen::VectorXd& v, Eigen::VectorXd& y) const {
  const std::vector<std::uint32_t>& independent = motion_.independent();
  for (std::size_t i = 0; i < independent.size(); ++i) y[rates_ + static_cast<Eigen::Index>(i)] = v[independent[i]];
}

bool MinimalEquation::start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double time,
                            const Eigen::VectorXd& states, Eigen::VectorXd& y) {
  if (!motion_.choose(q, time)) return false;
  chart_.set_base(q);
  lay_out();
  y.setZero(size_);
  write(v, y);
  y.segment(states_, states.size()) = states;
  return place(time, y);
}

bool MinimalEquation::place(double time, const Eigen::VectorXd& y) {
  delta_ = y.head(rates_);
  independent_ = y.segment(rates_, independent_.size());
  return motion_.close(chart_, time, delta_) && motion_.velocities(independent_);
}

bool MinimalEquation::realise(double time, const Eigen::VectorXd& y) { return rate(time, y, y_rate_); }

bool MinimalEquation::is_worn() const {
  return motion_.conditioning() < worn_pivot || chart_.greatest_turn(delta_) > worn_turn;
}

bool MinimalEquation::renew(double time, Eigen::VectorXd& y) {
  start_q_ = motion_.q();
  start_v_ = motion_.v();
  const Eigen::VectorXd rest = y.tail(size_ - states_);
  if (!motion_.choose(start_q_, time)) return false;
  chart_.set_base(start_q_);
  lay_out();
  y.setZero(size_);
  write(start_v_, y);
  y.tail(rest.size()) = rest;
  return place(time, y);
}

void MinimalEquation::take_closed(Eigen::VectorXd& y) const { y.head(rates_) = delta_; }

bool MinimalEquation::rate(double time, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) {
  y_rate.resize(size_);
  if (!place(time, y)) return false;
  if (!motion_.accelerations(states(y), y_rate.data() + states_)) return false;
  chart_.rates(delta_, motion_.v(), delta_rate_);
  y_rate.head(rates_) = delta_rate_;
  const std::vector<std::uint32_t>& independent = motion_.independent();
  for (std::size_t i = 0; i < independent.size(); ++i) {
    y_rate[rates_ + static_cast<Eigen::Index>(i)] = motion_.a()[independent[i]];
  }
  return motion_.power(states(y), y_rate[size_ - 1]);
}

}  // namespace koppel

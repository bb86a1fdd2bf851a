#include "dynamics/motion_equation.hpp"

#include "dynamics/constrained_equation.hpp"
#include "dynamics/minimal_equation.hpp"
#include "dynamics/multiplier_equation.hpp"

namespace koppel {
namespace {

constexpr double worn_turn = 1.0;  // rad, of a chart that ends at a full turn

}  // namespace

MotionEquation::MotionEquation(EquationsOfMotion& motion)
    : motion_(motion),
      chart_(motion.mechanism()),
      rates_(motion.mechanism().nv),
      delta_(Eigen::VectorXd::Zero(rates_)),
      delta_rate_(delta_) {}

void MotionEquation::lay_out() {
  const Mechanism& mechanism = motion_.mechanism();
  const auto count = static_cast<Eigen::Index>(integrated().size());
  states_ = rates_ + count;
  size_ = states_ + mechanism.internal_start.size() + 1;
  scales_.setConstant(size_, std::numeric_limits<double>::infinity());
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::uint32_t rate = integrated()[static_cast<std::size_t>(i)];
    scales_[rate] = scales_[rates_ + i] = mechanism.rate_scale[rate];
  }
  scales_.segment(states_, mechanism.internal_start.size()).setOnes();
  scales_[size_ - 1] = energy_scale_;
}

void MotionEquation::set_energy_scale(double joules) { scales_[size_ - 1] = energy_scale_ = joules; }

void MotionEquation::write(const Eigen::VectorXd& v, Eigen::VectorXd& y) const {
  for (std::size_t i = 0; i < integrated().size(); ++i) y[rates_ + static_cast<Eigen::Index>(i)] = v[integrated()[i]];
}

bool MotionEquation::choose(const Eigen::VectorXd& q, double time) {
  if (!motion_.choose(q, time)) return false;
  chart_.set_base(q);
  chosen_at_ = time;
  lay_out();
  return true;
}

/// What was chosen follows from where and when.
bool MotionEquation::exchange(Archive& archive) {
  Eigen::VectorXd base = chart_.base();
  archive(base, chosen_at_, energy_scale_);
  if (!archive.good() || base.size() != chart_.base().size()) return false;
  if (archive.is_reading() && !choose(base, chosen_at_)) return false;
  return motion_.exchange(archive);
}

bool MotionEquation::start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double time,
                           const Eigen::VectorXd& states, Eigen::VectorXd& y) {
  if (!choose(q, time)) return false;
  y.setZero(size_);
  write(v, y);
  y.segment(states_, states.size()) = states;
  return place(time, y);
}

bool MotionEquation::is_worn() const {
  return motion_.conditioning() < worn_pivot || chart_.greatest_turn(delta_) > worn_turn;
}

bool MotionEquation::renew(double time, Eigen::VectorXd& y) {
  start_q_ = motion_.q();
  start_v_ = motion_.v();
  const Eigen::VectorXd rest = y.tail(size_ - states_);
  if (!choose(start_q_, time)) return false;
  y.setZero(size_);
  write(start_v_, y);
  y.tail(rest.size()) = rest;
  return place(time, y);
}

/// Where the loops' equations are near to losing rank, positions that close them to rounding are off by its part; their
/// rates depend on these positions, and accelerations on the rates, by as much again each.
double MotionEquation::rounding() const {
  const double margin = motion_.margin();
  return std::numeric_limits<double>::epsilon() / (margin * margin * margin);
}

bool MotionEquation::position_rates(double time, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) {
  y_rate.resize(size_);
  if (!place(time, y)) return false;
  chart_.rates(delta_, motion_.v(), delta_rate_);
  y_rate.head(rates_) = delta_rate_;
  return true;
}

bool MotionEquation::rate(double time, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) {
  if (!position_rates(time, y, y_rate)) return false;
  if (!motion_.accelerations(states(y), y_rate.data() + states_)) return false;
  write(motion_.a(), y_rate);
  return motion_.power(states(y), y_rate[size_ - 1]);
}

std::unique_ptr<MotionEquation> make_equation(Formulation formulation, EquationsOfMotion& motion) {
  switch (formulation) {
    case Formulation::projected: return std::make_unique<MultiplierEquation>(motion, AfterSteps::project);
    case Formulation::baumgarte: return std::make_unique<MultiplierEquation>(motion, AfterSteps::leave);
    case Formulation::ggl:
    case Formulation::index3: return std::make_unique<ConstrainedEquation>(motion);
    case Formulation::minimal: break;
  }
  return std::make_unique<MinimalEquation>(motion);
}

}  // namespace koppel

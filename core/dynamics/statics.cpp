#include "dynamics/statics.hpp"

#include <algorithm>
#include <cmath>

namespace koppel {

Statics::Statics(std::shared_ptr<const Mechanism> mechanism, Inertias inertias, double time, bool moving)
    : mechanism_(mechanism),
      motion_(mechanism, std::move(inertias)),
      chart_(*mechanism),
      time_(time),
      rest_(Eigen::VectorXd::Zero(mechanism->nv)),
      delta_(rest_),
      state_rates_(Eigen::VectorXd::Zero(mechanism->internal_start.size())) {
  motion_.hold_drives(!moving);
}

bool Statics::stand(const Eigen::VectorXd& q, const Eigen::VectorXd& states) {
  states_ = moved_states_ = states;
  if (!motion_.choose(q, time_)) return false;
  chart_.set_base(q);
  delta_.setZero();
  if (!motion_.close(chart_, time_, delta_)) return false;
  chart_.set_base(motion_.q());
  return settle();
}

/// What follows from the choice of coordinates and the place.
bool Statics::settle() {
  const std::vector<std::uint32_t>& independent = motion_.independent();
  const auto f = static_cast<Eigen::Index>(independent.size());
  scale_.resize(f);
  efforts_.resize(f);
  still_.setZero(f);
  follow_.resize(mechanism_->nv, f);
  if (!motion_.velocities(still_)) return false;
  rest_ = motion_.v();
  for (Eigen::Index i = 0; i < f; ++i) {
    scale_[i] = mechanism_->rate_scale[independent[static_cast<std::size_t>(i)]];
    if (!motion_.velocities(scale_[i] * Eigen::VectorXd::Unit(f, i))) return false;
    follow_.col(i) = motion_.v() - rest_;
  }
  unrest_ = 0.0;
  for (std::uint32_t c = 0; c < mechanism_->unknowns; ++c) {
    const std::uint32_t v = mechanism_->rate_of_column[c];
    unrest_ = std::max(unrest_, std::abs(rest_[v]) / mechanism_->rate_scale[v]);
  }
  return true;
}

bool Statics::evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& r) {
  const Eigen::Index f = freedoms();
  // The others start from where they would go if they followed along straight lines.
  delta_ = follow_ * z.head(f);
  moved_states_ = states_ + z.tail(states_.size());
  if (!motion_.close(chart_, time_, delta_) || !motion_.velocities(still_)) return false;
  if (!motion_.efforts(moved_states_.data(), state_rates_.data(), efforts_)) return false;
  r.resize(size());
  r.head(f) = scale_.cwiseProduct(efforts_);
  r.tail(states_.size()) = state_rates_;
  return true;
}

bool Statics::move_on() {
  const Eigen::VectorXd q = motion_.q(), states = moved_states_;
  return stand(q, states);
}

bool Statics::potential(double& energy) {
  EquationsOfMotion::Energy both;
  if (!motion_.energy(moved_states_.data(), both)) return false;
  energy = both.potential;
  return true;
}

std::string Statics::name(Eigen::Index i) const {
  const Eigen::Index f = freedoms();
  if (i >= f) return state_name(*mechanism_, static_cast<std::uint32_t>(i - f));
  return mechanism_->rate_names[motion_.independent()[static_cast<std::size_t>(i)]].name;
}

std::string state_name(const Mechanism& mechanism, std::uint32_t i) {
  for (const Force& force : mechanism.forces) {
    if (i < force.first_state || i >= force.first_state + force.type->states.size()) continue;
    return force.name + "." + force.type->states[i - force.first_state].name;
  }
  return {};
}

Error plugin_error(const EquationsOfMotion& motion) {
  return make_error(Code::plugin_misbehaved, motion.culprit(), "failed, or gave a number that is not finite",
                    "report it to the author of the plugin");
}

}  // namespace koppel

#include "dynamics/simulation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace koppel {

Simulation::Simulation(std::shared_ptr<const Mechanism> mechanism, Inertias inertias, const SimulationOptions& options)
    : mechanism_(mechanism),
      options_(options),
      motion_(mechanism, std::move(inertias)),
      equation_(motion_),
      a_(mechanism->nv) {}

Result<std::unique_ptr<Simulation>> Simulation::of(std::shared_ptr<const Mechanism> mechanism,
                                                   const SimulationOptions& options) {
  KOPPEL_TRY(Inertias bodies, inertias(*mechanism));
  return std::unique_ptr<Simulation>(new Simulation(std::move(mechanism), std::move(bodies), options));
}

Result<void> Simulation::stuck(double time) const {
  const std::string at = " at t = " + std::to_string(time) + " s";
  switch (motion_.obstacle()) {
    case Obstacle::plugin:
      return tl::make_unexpected(make_error(Code::plugin_misbehaved, motion_.culprit(),
                                            "failed, or gave a number that is not finite" + at,
                                            "report it to the author of the plugin"));
    case Obstacle::massless:
      return tl::make_unexpected(make_error(Code::massless, "coordinate " + motion_.culprit(),
                                            "moves without any mass that resists" + at,
                                            "give the bodies that it moves a mass or an inertia, or drive it"));
    case Obstacle::open:
    case Obstacle::singular:
    case Obstacle::none: break;
  }
  return tl::make_unexpected(make_error(
      Code::simulation_stuck, motion_.culprit(),
      "no step is small enough to go on" + at +
          (motion_.obstacle() == Obstacle::singular ? ": the loops are at a singular position" : ""),
      "look at the motion up to there: a drive at its limit, a singular position, or a force that is too stiff"));
}

/// The independent rates that come nearest to what is asked for.
bool Simulation::take_rates(const State& state) {
  const bool known = state.stage >= Stage::velocities;
  std::vector<std::uint32_t> asked;
  for (const StateBlock& block : mechanism_->blocks) {
    const bool given = mechanism_->joints[block.joint.index()].blocks[block.block].described.start_rate.has_value();
    for (std::uint32_t v = block.v; v < block.v + rate_count(block.kind); ++v) {
      if (mechanism_->column_of_rate[v] >= 0 && (known || given)) asked.push_back(v);
    }
  }
  const auto f = static_cast<Eigen::Index>(motion_.independent().size());
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(f);
  if (!motion_.velocities(rates)) return false;
  const Eigen::VectorXd rest = motion_.v();
  Eigen::MatrixXd lever(asked.size(), f);
  Eigen::VectorXd wish(asked.size());
  const auto weight = [&](std::uint32_t v) { return 1.0 / mechanism_->rate_scale[v]; };
  for (Eigen::Index i = 0; i < f; ++i) {
    if (!motion_.velocities(Eigen::VectorXd::Unit(f, i))) return false;
    for (std::size_t k = 0; k < asked.size(); ++k) {
      lever(static_cast<Eigen::Index>(k), i) = weight(asked[k]) * (motion_.v()[asked[k]] - rest[asked[k]]);
    }
  }
  for (std::size_t k = 0; k < asked.size(); ++k) {
    wish[static_cast<Eigen::Index>(k)] = weight(asked[k]) * (state.v[asked[k]] - rest[asked[k]]);
  }
  if (f > 0 && !asked.empty()) rates = lever.completeOrthogonalDecomposition().solve(wish);
  if (!motion_.velocities(rates)) return false;
  for (const std::uint32_t v : asked) {
    summary_.start_change = std::max(summary_.start_change, weight(v) * std::abs(motion_.v()[v] - state.v[v]));
  }
  return true;
}

/// An energy of the size of those that will come: what is there, or a fall through the mechanism's length.
double Simulation::energy_scale(double kinetic) const {
  const double fall = motion_.inertias().mass * mechanism_->gravity.norm() * mechanism_->length;
  const double size = kinetic + fall;
  return size > 0.0 ? size : 1.0;
}

Result<void> Simulation::start(const State& state) {
  summary_ = {};
  if (!equation_.start(state.q, state.v, state.time, state.internal, y_) || !take_rates(state))
    return stuck(state.time);
  const Eigen::VectorXd v = motion_.v(), q = motion_.q();
  if (!equation_.start(q, v, state.time, state.internal, y_)) return stuck(state.time);
  EquationsOfMotion::Energy energy;
  if (!motion_.energy(equation_.states(y_), energy)) return stuck(state.time);
  if (!mechanism_->inputs.empty() || !mechanism_->forces.empty())
    equation_.set_energy_scale(energy_scale(energy.kinetic));
  method_ = std::make_unique<RungeKutta>(equation_, options_.step > 0.0 ? 0.0 : options_.tolerance, options_.step);
  if (!method_->start(state.time, y_)) return stuck(state.time);
  summary_.energy = balance_ = energy.kinetic + energy.potential;
  lowest_ = highest_ = energy.potential;
  liveliest_ = energy.kinetic;
  shown_ = state.time;
  return {};
}

/// Energy and drift where the last step has ended; the motion stands there.
bool Simulation::judge() {
  EquationsOfMotion::Energy energy;
  const Eigen::VectorXd& y = method_->y();
  if (!motion_.energy(equation_.states(y), energy)) return false;
  summary_.steps = method_->statistics().steps;
  summary_.rejected = method_->statistics().rejected;
  summary_.evaluations = method_->statistics().evaluations;
  summary_.energy = energy.kinetic + energy.potential;
  lowest_ = std::min(lowest_, energy.potential);
  highest_ = std::max(highest_, energy.potential);
  liveliest_ = std::max(liveliest_, energy.kinetic);
  summary_.energy_size = liveliest_ + highest_ - lowest_;
  summary_.energy_error = std::max(summary_.energy_error, std::abs(summary_.energy - equation_.work(y) - balance_));
  summary_.position_drift = std::max(summary_.position_drift, motion_.residual());
  summary_.velocity_drift = std::max(summary_.velocity_drift, motion_.opening());
  return true;
}

Result<void> Simulation::step(double limit) {
  const double time = method_->time();
  if (equation_.is_worn()) {
    const std::vector<std::uint32_t> before = motion_.independent();
    y_ = method_->y();
    if (!equation_.place(time, y_) || !equation_.renew(time, y_)) return stuck(time);
    if (motion_.independent() != before) ++summary_.switches;
    if (!method_->restart(y_)) return stuck(time);
  }
  if (method_->step(limit) != StepStatus::done) return stuck(time);
  return {};
}

Result<void> Simulation::advance(double time, State& state) {
  // Steps of a fixed length end where something is to be seen; others are read between their ends.
  const double limit = options_.step > 0.0 ? time : std::max(options_.end, time);
  while (method_->time() < time) {
    KOPPEL_CHECK(step(limit));
    if (!judge()) return stuck(method_->time());
    y_ = method_->y();
    equation_.take_closed(y_);
    method_->settle(y_);
  }
  return show(time, state);
}

Result<void> Simulation::show(double time, State& state) {
  method_->interpolate(time, y_);
  if (!equation_.realise(time, y_) || !motion_.complete(a_)) return stuck(time);
  if (const Input* failed = set_time(*mechanism_, time, state)) {
    return tl::make_unexpected(make_error(Code::plugin_misbehaved, "drive " + failed->name,
                                          "its function gave no finite value",
                                          "report it to the author of the plugin"));
  }
  shown_ = time;
  state.q = motion_.q();
  state.v = motion_.v();
  state.a = a_;
  state.internal = Eigen::Map<const Eigen::VectorXd>(equation_.states(y_), state.internal.size());
  state.stage = Stage::accelerations;
  state.history.time = time;
  state.history.step = 0.0;
  state.history.sides[0] = 0;
  return {};
}

}  // namespace koppel

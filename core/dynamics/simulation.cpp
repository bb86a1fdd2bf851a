#include "dynamics/simulation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace koppel {
namespace {

constexpr double runaway = 1e9;  // [rad/s, m/s]: nothing moves so fast but what is integrated in too long steps
constexpr double fixed_rate_met = 1e-10;  // part of a fixed start rate, or radians a second, that rounding may take

/// x that meets hard x = met as nearly as can be, then soft x = wished as nearly as that leaves, and is least then.
Eigen::VectorXd nearest_rates(const Eigen::MatrixXd& hard, const Eigen::VectorXd& met, const Eigen::MatrixXd& soft,
                              const Eigen::VectorXd& wished) {
  const Eigen::Index f = hard.cols();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(f);
  Eigen::MatrixXd free = Eigen::MatrixXd::Identity(f, f);
  if (hard.rows() > 0) {
    const Eigen::MatrixXd inverse = hard.completeOrthogonalDecomposition().pseudoInverse();
    x = inverse * met;
    free -= inverse * hard;
  }
  if (soft.rows() > 0) {
    const Eigen::MatrixXd left = soft * free;
    x += free * left.completeOrthogonalDecomposition().solve(wished - soft * x);
  }
  return x;
}

tl::unexpected<Error> unmet_rate(const std::string& name, double wanted, double got) {
  return tl::make_unexpected(make_error(Code::inputs_inconsistent, "coordinate " + name,
                                        "has the fixed start rate " + std::to_string(wanted) +
                                            ", and the loops, the drives and other fixed rates give it " +
                                            std::to_string(got),
                                        "fix fewer start rates: others then follow as nearly as they can"));
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const Mechanism> mechanism, Inertias inertias, const SimulationOptions& options)
    : mechanism_(mechanism),
      options_(options),
      motion_(mechanism, std::move(inertias)),
      equation_(make_equation(options.formulation, motion_)),
      watch_(motion_, *equation_),
      crossings_(motion_, *equation_),
      a_(mechanism->nv) {}

Result<std::unique_ptr<Simulation>> Simulation::of(std::shared_ptr<const Mechanism> mechanism,
                                                   const SimulationOptions& options) {
  KOPPEL_TRY(Inertias bodies, inertias(*mechanism));
  return std::unique_ptr<Simulation>(new Simulation(std::move(mechanism), std::move(bodies), options));
}

Result<void> Simulation::stuck(double time) const {
  const std::string at = " at t = " + std::to_string(time) + " s";
  // Whatever fails first then: the steps are to blame.
  if (motion_.v().size() > 0 && !(motion_.v().lpNorm<Eigen::Infinity>() < runaway)) {
    return tl::make_unexpected(
        make_error(Code::simulation_stuck, {}, "rates have grown beyond all bounds" + at, remedy()));
  }
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
  return tl::make_unexpected(
      make_error(Code::simulation_stuck, motion_.culprit(),
                 "no step is small enough to go on" + at +
                     (motion_.obstacle() == Obstacle::singular ? ": the loops are at a singular position" : ""),
                 remedy()));
}

std::string Simulation::remedy() const {
  const std::string look = "look at the motion up to there: a drive at its limit, a singular position";
  if (options_.step > 0.0)
    return look + ", or forces too stiff for the step: take a smaller one, or the integrator cvode";
  if (options_.formulation == Formulation::ggl || options_.formulation == Formulation::index3)
    return look + ", where multipliers have no values: the formulation minimal goes across";
  if (options_.integrator == IntegratorKind::cvode) return look + ", or a force that jumps";
  return look + ", or a force that is too stiff: for such there is the integrator cvode";
}

/// Independent rates that give fixed start rates and, among those, come nearest to what else is asked for.
Result<void> Simulation::take_rates(const State& state) {
  const bool known = state.stage >= Stage::velocities;
  std::vector<std::uint32_t> fixed, asked;
  for (const StateBlock& block : mechanism_->blocks) {
    const CoordinateDescription& about = mechanism_->joints[block.joint.index()].blocks[block.block].described;
    const bool given = about.start_rate.has_value();
    for (std::uint32_t v = block.v; v < block.v + rate_count(block.kind); ++v) {
      const std::int32_t column = mechanism_->column_of_rate[v];
      const bool driven = column >= static_cast<std::int32_t>(mechanism_->unknowns);
      if (!known && given && about.fixed && !driven)
        fixed.push_back(v);
      else if (column >= 0 && (known || given))
        asked.push_back(v);
    }
  }
  const auto f = static_cast<Eigen::Index>(motion_.independent().size());
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(f);
  if (!motion_.velocities(rates)) return stuck(state.time);
  const Eigen::VectorXd rest = motion_.v();
  Eigen::MatrixXd all(mechanism_->nv, f);
  for (Eigen::Index i = 0; i < f; ++i) {
    if (!motion_.velocities(Eigen::VectorXd::Unit(f, i))) return stuck(state.time);
    all.col(i) = motion_.v() - rest;
  }
  const auto weight = [&](std::uint32_t v) { return 1.0 / mechanism_->rate_scale[v]; };
  const auto lever = [&](const std::vector<std::uint32_t>& of) {
    Eigen::MatrixXd rows(of.size(), f);
    for (std::size_t k = 0; k < of.size(); ++k) rows.row(static_cast<Eigen::Index>(k)) = weight(of[k]) * all.row(of[k]);
    return rows;
  };
  const auto wish = [&](const std::vector<std::uint32_t>& of) {
    Eigen::VectorXd values(of.size());
    for (std::size_t k = 0; k < of.size(); ++k) {
      values[static_cast<Eigen::Index>(k)] = weight(of[k]) * (state.v[of[k]] - rest[of[k]]);
    }
    return values;
  };
  if (f > 0) rates = nearest_rates(lever(fixed), wish(fixed), lever(asked), wish(asked));
  if (!motion_.velocities(rates)) return stuck(state.time);
  for (const std::uint32_t v : fixed) {
    const double got = motion_.v()[v], wanted = state.v[v];
    if (weight(v) * std::abs(got - wanted) <= fixed_rate_met * (1.0 + weight(v) * std::abs(wanted))) continue;
    return unmet_rate(mechanism_->rate_names[v].name, wanted, got);
  }
  for (const std::uint32_t v : asked) {
    summary_.start_change = std::max(summary_.start_change, weight(v) * std::abs(motion_.v()[v] - state.v[v]));
  }
  return {};
}

/// An energy of the size of those that will come: what is there, or a fall through the mechanism's length.
double Simulation::energy_scale(double kinetic) const {
  const double fall = motion_.inertias().mass * mechanism_->gravity.norm() * mechanism_->length;
  const double size = kinetic + fall;
  return size > 0.0 ? size : 1.0;
}

/// Baumgarte's parameter [1/s]: what stands open fades in a twentieth of the time that the mechanism takes to fall, or
/// to move as it starts, through its length; with fixed steps h by no more than 1/(2 h), well within what is stable.
double Simulation::pull() const {
  double speed = 0.0;
  for (std::uint32_t v = 0; v < mechanism_->nv; ++v) {
    speed = std::max(speed, std::abs(motion_.v()[v]) / mechanism_->rate_scale[v]);
  }
  const double slowness = std::sqrt(mechanism_->gravity.norm() / (2.0 * mechanism_->length));
  const double pull = 20.0 * std::max({speed, slowness, 1.0 / std::max(1.0, mechanism_->duration)});
  return options_.step > 0.0 ? std::min(pull, 0.5 / options_.step) : pull;
}

Result<void> Simulation::start(const State& state) {
  summary_ = {};
  if (!equation_->start(state.q, state.v, state.time, state.internal, y_)) return stuck(state.time);
  KOPPEL_CHECK(take_rates(state));
  const Eigen::VectorXd v = motion_.v(), q = motion_.q();
  if (!equation_->start(q, v, state.time, state.internal, y_)) return stuck(state.time);
  EquationsOfMotion::Energy energy;
  if (!motion_.energy(equation_->states(y_), energy)) return stuck(state.time);
  if (!mechanism_->inputs.empty() || !mechanism_->forces.empty())
    equation_->set_energy_scale(energy_scale(energy.kinetic));
  if (options_.formulation == Formulation::baumgarte) motion_.stabilise(pull());
  method_ = make_integrator(options_.integrator, *equation_, options_.tolerance, options_.step);
  if (!method_->start(state.time, y_) || !watch_.start(y_)) return stuck(state.time);
  summary_.energy = balance_ = energy.kinetic + energy.potential;
  lowest_ = highest_ = energy.potential;
  liveliest_ = energy.kinetic;
  shown_ = state.time;
  failed_.reset();
  worn_ = equation_->is_worn();
  crossings_.take_sides();
  return {};
}

/// Energy and drift where the last step has ended; the motion stands there.
bool Simulation::judge() {
  EquationsOfMotion::Energy energy;
  const Eigen::VectorXd& y = method_->y();
  if (!motion_.energy(equation_->states(y), energy)) return false;
  summary_.steps = method_->statistics().steps;
  summary_.rejected = method_->statistics().rejected;
  summary_.evaluations = method_->statistics().evaluations;
  summary_.events = watch_.events();
  summary_.stiff = method_->statistics().stiff;
  summary_.energy = energy.kinetic + energy.potential;
  lowest_ = std::min(lowest_, energy.potential);
  highest_ = std::max(highest_, energy.potential);
  liveliest_ = std::max(liveliest_, energy.kinetic);
  summary_.energy_size = liveliest_ + highest_ - lowest_;
  summary_.energy_error = std::max(summary_.energy_error, std::abs(summary_.energy - equation_->work(y) - balance_));
  summary_.position_drift = std::max(summary_.position_drift, motion_.residual());
  summary_.velocity_drift = std::max(summary_.velocity_drift, motion_.opening());
  worn_ = equation_->is_worn();
  return true;
}

Result<void> Simulation::step(double limit) {
  if (!watch_.cross(*method_, limit)) return stuck(method_->time());
  const double time = method_->time();
  if (worn_) {
    const std::vector<std::uint32_t> before = motion_.independent();
    y_ = method_->y();
    if (!equation_->place(time, y_) || !equation_->renew(time, y_)) return stuck(time);
    if (motion_.independent() != before) ++summary_.switches;
    if (!method_->restart(time, y_)) return stuck(time);
  }
  if (method_->step(limit) != StepStatus::done) return stuck(time);
  if (!watch_.look(*method_)) return stuck(method_->time());
  return {};
}

Result<void> Simulation::advance(double time, State& state) {
  if (failed_) return tl::make_unexpected(*failed_);
  auto gone = [&]() -> Result<void> {
    while (method_->time() < time) KOPPEL_CHECK(go_on(time));
    return show(time, state);
  }();
  if (gone) crossings_.take_sides();
  if (!gone) failed_ = gone.error();
  return gone;
}

Result<std::optional<Crossing>> Simulation::advance_watching(double time, State& state) {
  if (failed_) return tl::make_unexpected(*failed_);
  auto found = go_watching(time);
  if (found) {
    if (auto shown = show(*found ? (*found)->time : time, state); !shown) found = tl::make_unexpected(shown.error());
  }
  if (!found) failed_ = found.error();
  return found;
}

/// To a time, or to the first crossing before it.
Result<std::optional<Crossing>> Simulation::go_watching(double time) {
  std::optional<Crossing> found;
  for (double from = shown_;;) {
    const double until = std::min(time, method_->time());
    if (until > from && !crossings_.find(*method_, from, until, found))
      return tl::make_unexpected(stuck(until).error());
    if (found || method_->time() >= time) return found;
    from = std::max(from, until);
    KOPPEL_CHECK(go_on(time));
  }
}

/// One step on the way to a time.
Result<void> Simulation::go_on(double time) {
  // Steps of a fixed length end where something is to be seen; others are read between their ends.
  KOPPEL_CHECK(step(options_.step > 0.0 ? time : std::max(options_.end, time)));
  if (!judge()) return stuck(method_->time());
  y_ = method_->y();
  if (!equation_->settle(method_->time(), y_)) return stuck(method_->time());
  method_->settle(y_);
  return {};
}

Result<void> Simulation::show(double time, State& state) {
  method_->interpolate(time, y_);
  if (!equation_->realise(time, y_) || !motion_.complete(a_)) return stuck(time);
  if (const Input* failed = set_time(*mechanism_, time, state)) {
    return tl::make_unexpected(make_error(Code::plugin_misbehaved, "drive " + failed->name,
                                          "its function gave no finite value",
                                          "report it to the author of the plugin"));
  }
  shown_ = time;
  state.q = motion_.q();
  state.v = motion_.v();
  state.a = a_;
  state.internal = Eigen::Map<const Eigen::VectorXd>(equation_->states(y_), state.internal.size());
  state.stage = Stage::accelerations;
  state.history.time = time;
  state.history.step = 0.0;
  state.history.sides[0] = 0;
  return {};
}

}  // namespace koppel

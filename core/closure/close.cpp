#include "closure/close.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "closure/ceres_closure.hpp"
#include "closure/newton.hpp"

namespace koppel {
namespace {

constexpr double largest_move = 0.35;      // of any unknown in one step that is believed without looking closer
constexpr double smallest_fraction = 1.0 / 4096.0;
constexpr double near_singular = 1e6;      // condition number (C-18)
constexpr std::uint32_t default_ceres_iterations = 500;

/// Solves one closure; holds what its steps share.
class Closing {
 public:
  Closing(Work& work, const State& state, const CloseOptions& options, Report& report)
      : work_(work), mechanism_(*work.mechanism), state_(state), options_(options), report_(report) {
    newton_.max_iterations = options.max_iterations == 0 ? 50 : options.max_iterations;
    if (options.tolerance > 0.0) newton_.tolerance = options.tolerance;
    ceres_iterations_ = options.max_iterations == 0 ? default_ceres_iterations : options.max_iterations;
  }

  /// True: work.q is closed and the equations stand there.
  bool follow() {
    predict();
    if (options_.method != Method::ceres && try_newton() && moved_little()) return true;
    if (plugin_failed) return false;
    if (options_.method == Method::automatic && lead(state_.q)) return true;
    if (plugin_failed || options_.method == Method::newton) return false;
    work_.q = state_.q;
    set_inputs(1.0);
    if (!try_ceres()) return false;
    work_.q_start = state_.q;
    branch_changed = !moved_little();
    return true;
  }

  bool assemble() {
    work_.q = state_.q;
    set_inputs(1.0);
    if (options_.method != Method::ceres && try_newton()) return true;
    if (plugin_failed || options_.method == Method::newton) return false;
    work_.q = state_.q;
    set_inputs(1.0);
    if (try_ceres()) return true;
    if (plugin_failed || options_.method == Method::ceres || mechanism_.inputs.empty()) return false;
    // Let the inputs go, close wherever it is nearest, and lead them to where they should be.
    work_.q = state_.q;
    if (!try_newton(InputsAre::free)) {
      work_.q = state_.q;
      if (plugin_failed || !try_ceres(InputsAre::free)) return false;
    }
    return lead(work_.q);
  }

  bool plugin_failed = false;
  bool branch_changed = false;

 private:
  bool try_newton(InputsAre inputs = InputsAre::held) {
    newton_.inputs = inputs;
    const NewtonResult result = newton(work_, state_.time, newton_);
    report_.iterations += result.iterations;
    if (result.iterations > 0) report_.solver = SolverUsed::newton;
    plugin_failed = result.plugin_failed;
    return result.converged;
  }

  /// Ceres comes near; Newton takes it down to rounding.
  bool try_ceres(InputsAre inputs = InputsAre::held) {
    if (!work_.ceres) work_.ceres = std::make_unique<CeresClosure>(work_);
    const CeresClosure::Result result = work_.ceres->solve(state_.time, ceres_iterations_, inputs);
    report_.iterations += result.iterations;
    plugin_failed = result.plugin_failed;
    if (plugin_failed) return false;
    const bool converged = try_newton(inputs);
    report_.solver = SolverUsed::ceres;
    return converged;
  }

  /// Sets the driven coordinates of work.q to a fraction of the way from where the search started to their targets.
  void set_inputs(double fraction) {
    for (std::size_t i = 0; i < mechanism_.inputs.size(); ++i) {
      const std::uint32_t q = mechanism_.inputs[i].q;
      const double target = state_.input[static_cast<Eigen::Index>(i)];
      // Exactly the target at the end, not a sum that rounds.
      work_.q[q] = fraction == 1.0 ? target : work_.q_start[q] + fraction * (target - work_.q_start[q]);
    }
  }

  /// From the last position along velocity, acceleration and the change of acceleration over the last step.
  void predict() {
    work_.q = state_.q;
    const double h = state_.time - state_.history.time;
    if (state_.stage == Stage::accelerations && h != 0.0) {
      work_.delta = h * state_.v + (h * h / 2.0) * state_.a;
      if (state_.history.step != 0.0) {
        work_.delta += (h * h * h / 6.0 / state_.history.step) * (state_.a - state_.history.acceleration);
      }
      // A wild extrapolation is worse than none.
      if (greatest_unknown(work_.delta) <= largest_move) integrate(mechanism_, state_.q, work_.delta, work_.q);
    }
    work_.q_start = work_.q;
    set_inputs(1.0);
  }

  /// Largest component of a change of coordinates, in radians' size; of unknowns only.
  double greatest_unknown(const Eigen::VectorXd& delta) const {
    double result = 0.0;
    for (std::uint32_t i = 0; i < mechanism_.unknowns; ++i) {
      const std::uint32_t rate = mechanism_.rate_of_column[i];
      result = std::max(result, std::abs(delta[rate]) / mechanism_.rate_scale[rate]);
    }
    return result;
  }

  bool moved_little() {
    difference(mechanism_, work_.q_start, work_.q, work_.delta);
    return greatest_unknown(work_.delta) <= largest_move;
  }

  /// Leads the inputs from a closed position to their targets, in steps that halve when they are not believed.
  bool lead(const Eigen::VectorXd& from) {
    Eigen::VectorXd& here = work_.q_start;
    if (&from != &here) here = from;
    double done = 0.0, fraction = 1.0;
    while (done < 1.0) {
      const double left = 1.0 - done;
      const double next = std::min(left, fraction);
      work_.q = here;
      set_inputs(next >= left ? 1.0 : next / left);
      if (try_newton() && moved_little()) {
        here = work_.q;
        done = next >= left ? 1.0 : done + next;
        fraction = std::min(1.0, 2.0 * next);
        continue;
      }
      if (plugin_failed || next <= smallest_fraction) return false;
      fraction = next / 2.0;
    }
    return true;
  }

  Work& work_;
  const Mechanism& mechanism_;
  const State& state_;
  const CloseOptions& options_;
  Report& report_;
  NewtonOptions newton_;
  std::uint32_t ceres_iterations_ = 0;
};

bool inputs_taken(const Mechanism& mechanism, const State& state) {
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    if (state.q[mechanism.inputs[i].q] != state.input[static_cast<Eigen::Index>(i)]) return false;
  }
  return true;
}

/// Jacobian and factorisation where the equations stand.
void factorise_here(Work& work, const Eigen::VectorXd& q, double time) {
  work.equations.evaluate_jacobian();
  work.factorisation.compute(work.equations.jacobian.leftCols(work.mechanism->unknowns));
  work.factorised = true;
  work.factorised_at = q;
  work.factorised_time = time;
}

/// The same at a given position, unless all of it is there already.
bool factorise_at(Work& work, const Eigen::VectorXd& q, double time) {
  if (work.factorised && work.factorised_at == q && work.factorised_time == time) return true;
  if (!work.equations.evaluate(q, time)) return false;
  factorise_here(work, q, time);
  return true;
}

/// Report and remarks for the closed position where work is factorised.
koppel_status describe(Work& work, Report& report) {
  const Mechanism& mechanism = *work.mechanism;
  const Factorisation::Condition condition = work.factorisation.condition();
  report.verdict = mechanism.relations.empty() ? Verdict::open : Verdict::closed;
  report.residual = work.equations.error();
  report.rank = static_cast<std::uint32_t>(work.factorisation.rank());
  report.condition = condition.ratio;
  // Residuals are themselves known only to rounding of the positions that they are differences of.
  double reach = 1.0;
  for (const Pose& pose : work.equations.kinematics.poses) {
    reach = std::max(reach, pose.position.lpNorm<Eigen::Infinity>() / mechanism.length);
  }
  const double uncertain = work.equations.residual.norm() + 8.0 * reach * std::numeric_limits<double>::epsilon();
  report.coordinate_error = condition.smallest > 0.0 ? uncertain / condition.smallest : 0.0;
  koppel_status status = KOPPEL_OK;
  if (report.rank < mechanism.rows) status |= KOPPEL_REDUNDANT;
  if (report.condition > near_singular) status |= KOPPEL_NEAR_SINGULAR;
  if (any_limit_exceeded(mechanism, work.factorised_at)) status |= KOPPEL_LIMIT_EXCEEDED;
  return status;
}

void remember(State& state) {
  const bool known = state.stage == Stage::accelerations && state.time != state.history.time;
  state.history.step = known ? state.time - state.history.time : 0.0;
  if (known) state.history.acceleration = state.a;
  state.history.time = state.time;
}

/// The greatest of a set of rates or accelerations, in radians' size.
double greatest(const Mechanism& mechanism, const Eigen::VectorXd& rates) {
  double result = 0.0;
  for (Eigen::Index i = 0; i < rates.size(); ++i) {
    result = std::max(result, std::abs(rates[i]) / mechanism.rate_scale[static_cast<std::size_t>(i)]);
  }
  return result;
}

/// x of the unknowns from J_u x = rhs. False: the equations cannot be met, not even to `allowed` times the size of what is
/// moving (the terms that rhs is a sum of; rhs itself may be what rounding left of them).
bool solve_rates(Work& work, double moving, Eigen::VectorXd& rates) {
  const Mechanism& mechanism = *work.mechanism;
  work.rhs_copy = work.rhs;
  work.factorisation.solve(work.rhs, work.step);
  for (std::uint32_t i = 0; i < mechanism.unknowns; ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[i];
    rates[rate] = mechanism.rate_scale[rate] * work.step[i];
  }
  if (mechanism.rows == 0) return true;
  constexpr double allowed = 1e-9;
  const double asked = work.rhs_copy.lpNorm<Eigen::Infinity>();
  const double lever = work.equations.jacobian.lpNorm<Eigen::Infinity>();
  work.rhs_copy.noalias() -= work.equations.jacobian.leftCols(mechanism.unknowns) * work.step.head(mechanism.unknowns);
  return work.rhs_copy.lpNorm<Eigen::Infinity>() <= allowed * std::max(asked, lever * moving);
}

/// rhs -= J_d times the driven rates (or accelerations) that stand in `rates`.
void subtract_driven(Work& work, const Eigen::VectorXd& rates) {
  const Mechanism& mechanism = *work.mechanism;
  for (std::uint32_t i = mechanism.unknowns; i < mechanism.columns; ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[i];
    work.rhs -= rates[rate] / mechanism.rate_scale[rate] * work.equations.jacobian.col(i);
  }
}

}  // namespace

koppel_status close(Work& work, State& state, const CloseOptions& options, Report& report) {
  const Mechanism& mechanism = *work.mechanism;
  report = Report{};
  const bool tracking = state.stage != Stage::assigned;
  if (tracking && inputs_taken(mechanism, state)) {
    if (!factorise_at(work, state.q, state.time)) return KOPPEL_PLUGIN;
    if (!mechanism.explicit_time || work.equations.error() <= NewtonOptions{}.tolerance) {
      if (state.time != state.history.time) remember(state);
      return describe(work, report);
    }
  }
  Closing closing(work, state, options, report);
  const bool closed = tracking ? closing.follow() : closing.assemble();
  if (closing.plugin_failed) return KOPPEL_PLUGIN;
  if (!closed) {
    report.residual = work.equations.error();
    report.verdict = tracking && options.method == Method::newton ? Verdict::retry : Verdict::not_found;
    return report.verdict == Verdict::retry ? KOPPEL_RETRY : KOPPEL_NOT_CLOSED;
  }
  if (!work.equations.cut_coordinates(work.q)) return KOPPEL_PLUGIN;
  factorise_here(work, work.q, state.time);
  const koppel_status status = describe(work, report);
  remember(state);
  state.q = work.q;
  state.stage = Stage::closed;
  return closing.branch_changed ? status | KOPPEL_BRANCH_CHANGED : status;
}

koppel_status velocities(Work& work, State& state) {
  const Mechanism& mechanism = *work.mechanism;
  if (state.stage == Stage::assigned || !inputs_taken(mechanism, state)) return KOPPEL_INVALID_ARGUMENT;
  if (!factorise_at(work, state.q, state.time)) return KOPPEL_PLUGIN;
  Eigen::VectorXd& v = work.delta;
  v.setZero();
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    v[mechanism.inputs[i].v] = state.input_rate[static_cast<Eigen::Index>(i)];
  }
  if (!work.equations.time_rate(work.rhs)) return KOPPEL_PLUGIN;
  work.rhs = -work.rhs;
  subtract_driven(work, v);
  if (!solve_rates(work, greatest(mechanism, v), v)) return KOPPEL_SINGULAR;
  if (!work.equations.motion(state.q, v, work.rest) || !work.equations.cut_rates(state.q, v)) return KOPPEL_PLUGIN;
  state.v = v;
  state.stage = Stage::velocities;
  return KOPPEL_OK;
}

koppel_status accelerations(Work& work, State& state) {
  const Mechanism& mechanism = *work.mechanism;
  if (state.stage < Stage::velocities || !inputs_taken(mechanism, state)) return KOPPEL_INVALID_ARGUMENT;
  if (!factorise_at(work, state.q, state.time)) return KOPPEL_PLUGIN;
  Eigen::VectorXd& a = work.delta;
  a.setZero();
  if (!work.equations.motion(state.q, state.v, a) || !work.equations.bias(state.q, state.v, work.rhs)) {
    return KOPPEL_PLUGIN;
  }
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    a[mechanism.inputs[i].v] = state.input_acceleration[static_cast<Eigen::Index>(i)];
  }
  const double speed = greatest(mechanism, state.v);
  work.rhs = -work.rhs;
  subtract_driven(work, a);
  if (!solve_rates(work, greatest(mechanism, a) + speed * speed, a)) return KOPPEL_SINGULAR;
  if (!work.equations.motion(state.q, state.v, a) || !work.equations.cut_accelerations(state.q, state.v, a)) {
    return KOPPEL_PLUGIN;
  }
  state.a = a;
  state.stage = Stage::accelerations;
  return KOPPEL_OK;
}

koppel_status move(Work& work, State& state, double time, Report& report) {
  report = Report{};
  work.saved = state;
  const auto back = [&](koppel_status status) {
    state = work.saved;
    return status;
  };
  if (set_time(*work.mechanism, time, state) != nullptr) return KOPPEL_PLUGIN;
  const koppel_status closed = close(work, state, {}, report);
  if (closed < 0) return back(closed);
  for (const auto step : {velocities, accelerations}) {
    const koppel_status status = step(work, state);
    if (status < 0) return back(status);
  }
  return closed;
}

bool realise(Work& work, const State& state) {
  work.factorised = false;
  return work.equations.evaluate(state.q, state.time) && work.equations.motion(state.q, state.v, state.a);
}

}  // namespace koppel

#include "closure/close.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "closure/closing.hpp"
#include "closure/flow_tracker.hpp"

namespace koppel {
namespace {

constexpr double near_singular = 1e6;  // condition number (C-18)

bool inputs_taken(const Mechanism& mechanism, const State& state) {
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    if (state.q[mechanism.inputs[i].q] != state.input[static_cast<Eigen::Index>(i)]) return false;
  }
  return true;
}

/// Rates of the state still belong to its inputs.
bool velocities_taken(const Mechanism& mechanism, const State& state) {
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    if (state.v[mechanism.inputs[i].v] != state.input_rate[static_cast<Eigen::Index>(i)]) return false;
  }
  return true;
}

/// Rates and accelerations do.
bool rates_taken(const Mechanism& mechanism, const State& state) {
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    if (state.a[mechanism.inputs[i].v] != state.input_acceleration[static_cast<Eigen::Index>(i)]) return false;
  }
  return velocities_taken(mechanism, state);
}

/// The position is closed for the inputs and the time that the state has now.
bool closed_here(const Mechanism& mechanism, const State& state) {
  return is_closed(mechanism, state) && inputs_taken(mechanism, state);
}

/// Puts a state back to what it was, unless it is told that all went well.
class Restorer {
 public:
  Restorer(State& state, const State& before) : state_(state), before_(before) {}
  Restorer(const Restorer&) = delete;
  Restorer& operator=(const Restorer&) = delete;
  ~Restorer() {
    if (!kept_) state_ = before_;  // same sizes: nothing is allocated
  }
  void keep() { kept_ = true; }

 private:
  State& state_;
  const State& before_;
  bool kept_ = false;
};

/// Jacobian and factorisation at a position, unless all of it is there already.
bool factorise_at(Work& work, const Eigen::VectorXd& q, double time) {
  if (work.factorised && work.factorised_at == q && work.factorised_time == time) return true;
  work.factorised = false;
  if (!work.equations.evaluate(q, time)) return false;
  work.factorise(q, time);
  return true;
}

/// Report and remarks for the closed position where work is factorised.
koppel_status describe(Work& work, Report& report) {
  const Mechanism& mechanism = *work.mechanism;
  const Factorisation::Condition condition = work.condition;
  report.verdict = mechanism.relations.empty() ? Verdict::open : Verdict::closed;
  report.residual = work.equations.error();
  report.rank = static_cast<std::uint32_t>(work.factorisation->rank());
  report.condition = condition.ratio;
  // Residuals are themselves known only to rounding of the positions that they are differences of.
  double reach = 1.0;
  for (const Pose& pose : work.equations.kinematics.poses) {
    reach = std::max(reach, pose.position.lpNorm<Eigen::Infinity>() / mechanism.length);
  }
  const double uncertain = work.equations.residual.norm() + 8.0 * reach * std::numeric_limits<double>::epsilon();
  report.coordinate_error = condition.smallest > 0.0 ? uncertain / condition.smallest : 0.0;
  // Beside a change point the branch tells where it is.
  if (work.branch_rates) report.coordinate_error = std::min(report.coordinate_error, 100.0 * uncertain);
  koppel_status status = KOPPEL_OK;
  if (report.rank < mechanism.rows) status |= KOPPEL_REDUNDANT;
  if (report.condition > near_singular || work.branch_rates) status |= KOPPEL_NEAR_SINGULAR;
  if (report.change_points > 0) status |= KOPPEL_CHANGE_POINT;
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

/// x of the unknowns from J_u x = rhs. False: the equations cannot be met, not even to `allowed` times the size of what
/// is moving (the terms that rhs is a sum of; rhs itself may be what rounding left of them).
bool solve_rates(Work& work, double moving, Eigen::VectorXd& rates) {
  const Mechanism& mechanism = *work.mechanism;
  work.rhs_copy = work.rhs;
  work.factorisation->solve(work.rhs, work.step);
  for (std::uint32_t i = 0; i < mechanism.unknowns; ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[i];
    rates[rate] = mechanism.rate_scale[rate] * work.step[i];
  }
  if (mechanism.rows == 0) return true;
  constexpr double allowed = 1e-9;
  const double asked = work.rhs_copy.lpNorm<Eigen::Infinity>();
  const double lever = work.equations.jacobian.coeffs().matrix().lpNorm<Eigen::Infinity>();
  work.rhs_copy -= work.equations.jacobian.leftCols(mechanism.unknowns) * work.step.head(mechanism.unknowns);
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

/// The tracker of the mechanism, made on first need; null if it has none.
FlowTracker* tracker_of(Work& work) {
  if (work.tracker_sought) return work.tracker.get();
  work.tracker_sought = true;
  for (const FlowChoice choice : {FlowChoice::first, FlowChoice::best}) {
    if (auto tracker = FlowTracker::of(*work.mechanism, plan_flow(*work.mechanism, choice))) {
      work.tracker = std::make_unique<FlowTracker>(std::move(*tracker));
      break;
    }
  }
  return work.tracker.get();
}

/// From a closed state to the time and the inputs that it has now, by closed forms, from work.q, which is to be near
/// by; with rates and accelerations. Nothing: not here.
std::optional<koppel_status> follow_flow(Work& work, State& state, Report& report) {
  const Mechanism& mechanism = *work.mechanism;
  FlowTracker* tracker = tracker_of(work);
  if (tracker == nullptr) return std::nullopt;
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    work.q[mechanism.inputs[i].q] = state.input[k];
    work.v[mechanism.inputs[i].v] = state.input_rate[k];
    work.a[mechanism.inputs[i].v] = state.input_acceleration[k];
  }
  if (state.history.sides[0] == 0) tracker->find_sides(state.q, state.history.sides);
  TrackedAccuracy accuracy;
  if (!tracker->follow(work.q, work.v, work.a, state.history.sides, accuracy)) return std::nullopt;
  if (!tracker->regular_rank) {
    if (!factorise_at(work, work.q, state.time)) return KOPPEL_PLUGIN;
    tracker->regular_rank = static_cast<std::uint32_t>(work.factorisation->rank());
  }
  remember(state);
  state.history.rank = *tracker->regular_rank;
  state.history.weakest = 0.0;  // not known
  state.q = work.q;
  state.v = work.v;
  state.a = work.a;
  state.stage = Stage::accelerations;
  report.verdict = Verdict::closed;
  report.solver = SolverUsed::flow;
  report.rank = state.history.rank;
  report.residual = accuracy.residual;
  report.condition = accuracy.condition;
  report.coordinate_error = accuracy.coordinate_error;
  koppel_status status = KOPPEL_OK;
  if (report.rank < mechanism.rows) status |= KOPPEL_REDUNDANT;
  if (any_limit_exceeded(mechanism, state.q)) status |= KOPPEL_LIMIT_EXCEEDED;
  return status;
}

/// From a closed state with accelerations to the time and the inputs that it has now, by closed forms. Nothing: not
/// here.
std::optional<koppel_status> track(Work& work, State& state, Report& report) {
  const double h = state.time - state.history.time;
  if (state.stage != Stage::accelerations || h == 0.0) return std::nullopt;
  work.delta = h * state.v + (h * h / 2.0) * state.a;
  if (state.history.step != 0.0) {
    work.delta += (h * h * h / 6.0 / state.history.step) * (state.a - state.history.acceleration);
  }
  integrate(*work.mechanism, state.q, work.delta, work.q);
  return follow_flow(work, state, report);
}

/// The time in which the inputs, as they move, come to where they shall be now; 0 if they are on another way.
double time_to_inputs(const Mechanism& mechanism, const State& state) {
  const auto left_and_rate = [&](std::size_t i) {
    const Input& input = mechanism.inputs[i];
    const double scale = mechanism.rate_scale[input.v];
    return std::pair((state.input[static_cast<Eigen::Index>(i)] - state.q[input.q]) / scale, state.v[input.v] / scale);
  };
  double along = 0.0, square = 0.0, most = 0.0;
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    const auto [left, rate] = left_and_rate(i);
    along += left * rate;
    square += rate * rate;
    most = std::max(most, std::abs(left));
  }
  if (square == 0.0) return 0.0;
  constexpr double nearly = 0.1;  // a start value is all that is wanted
  const double time = along / square;
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    const auto [left, rate] = left_and_rate(i);
    if (std::abs(left - time * rate) > nearly * most) return 0.0;
  }
  return time;
}

/// Whether nothing is asked for but the closed position that continues the motion.
bool is_plain(const CloseOptions& options) {
  return options.method == Method::automatic && options.branch == Branch::stay && options.max_iterations == 0 &&
         options.tolerance == 0.0;
}

/// Closes with the start values held that are fixed, so that the others give way.
koppel_status close_with_start_held(const Work& work, State& state, const CloseOptions& options, Report& report) {
  const auto& held = work.mechanism->with_start_held;
  Work of_held(held);
  State closed(*held);
  closed.q = state.q;
  closed.time = state.time;
  closed.input.head(state.input.size()) = state.input;
  for (std::size_t i = work.mechanism->inputs.size(); i < held->inputs.size(); ++i) {
    closed.input[static_cast<Eigen::Index>(i)] = state.q[held->inputs[i].q];
  }
  const koppel_status status = close(of_held, closed, options, report);
  if (status >= 0) state.q = closed.q;
  return status;
}

/// By Newton and what else there is where that does not do.
koppel_status close_by_equations(Work& work, State& state, const CloseOptions& options, Report& report) {
  const Mechanism& mechanism = *work.mechanism;
  report = Report{};
  work.branch_rates.reset();
  const bool tracking = state.stage != Stage::assigned;
  if (tracking && inputs_taken(mechanism, state)) {
    if (!factorise_at(work, state.q, state.time)) return KOPPEL_PLUGIN;
    const bool same_equations = !mechanism.explicit_time || state.time == state.history.time;
    if (same_equations || work.equations.error() <= NewtonOptions{}.tolerance) {
      const bool same_motion = state.time == state.history.time && rates_taken(mechanism, state);
      if (state.time != state.history.time) remember(state);
      if (!same_motion) state.stage = Stage::closed;
      return describe(work, report);
    }
  }
  std::uint32_t iterations = 0;
  if (!tracking && mechanism.with_start_held) {
    const koppel_status status = close_with_start_held(work, state, options, report);
    if (status < 0) {
      report.open_row = mechanism.rows;  // none of these equations
      return status;
    }
    iterations = report.iterations;
    report = Report{};
  }
  Closing closing(work, state, options, report);
  report.iterations = iterations;
  const bool closed = options.method == Method::flow ? closing.by_flow()
                      : tracking                     ? closing.follow()
                                                     : closing.assemble();
  if (closing.plugin_failed()) return KOPPEL_PLUGIN;
  if (!closed) {
    report.residual = closing.nearest();
    report.open_row = closing.nearest_row();
    if (report.verdict == Verdict::limit || report.verdict == Verdict::unreachable) return KOPPEL_NOT_CLOSED;
    report.verdict = tracking && options.method == Method::newton ? Verdict::retry : Verdict::not_found;
    return report.verdict == Verdict::retry ? KOPPEL_RETRY : KOPPEL_NOT_CLOSED;
  }
  if (!work.equations.cut_coordinates(work.q)) return KOPPEL_PLUGIN;
  if (work.factorised) {
    work.factorised_at = work.q;  // but for the cut joints they were there already
  } else {
    work.factorise(work.q, state.time);
  }
  const koppel_status status = describe(work, report);
  remember(state);
  state.history.sides[0] = 0;
  state.history.rank = report.rank;
  state.history.weakest = work.condition.smallest;
  state.q = work.q;
  state.stage = Stage::closed;
  return closing.branch_changed() ? status | KOPPEL_BRANCH_CHANGED : status;
}

}  // namespace

bool is_closed(const Mechanism& mechanism, const State& state) {
  return state.stage != Stage::assigned && (!mechanism.explicit_time || state.time == state.history.time);
}

koppel_status close(Work& work, State& state, const CloseOptions& options, Report& report) {
  if (is_plain(options) && state.stage != Stage::assigned && !inputs_taken(*work.mechanism, state)) {
    report = Report{};
    work.branch_rates.reset();
    const double h = state.stage == Stage::accelerations ? time_to_inputs(*work.mechanism, state) : 0.0;
    work.delta = h * state.v + (h * h / 2.0) * state.a;
    integrate(*work.mechanism, state.q, work.delta, work.q);
    if (const auto status = follow_flow(work, state, report)) return *status;
  }
  return close_by_equations(work, state, options, report);
}

koppel_status velocities(Work& work, State& state) {
  const Mechanism& mechanism = *work.mechanism;
  if (!closed_here(mechanism, state)) return KOPPEL_INVALID_ARGUMENT;
  // What is known stays as it is.
  if (state.stage >= Stage::velocities && velocities_taken(mechanism, state)) return KOPPEL_OK;
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
  if (state.stage < Stage::velocities || !closed_here(mechanism, state)) return KOPPEL_INVALID_ARGUMENT;
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    const double asked = state.input_rate[static_cast<Eigen::Index>(i)];
    if (state.v[mechanism.inputs[i].v] != asked) return KOPPEL_INVALID_ARGUMENT;
  }
  if (state.stage == Stage::accelerations && rates_taken(mechanism, state)) return KOPPEL_OK;
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

koppel_status move(Work& work, State& state, double time, Report& report, Branch branch) {
  report = Report{};
  work.saved = state;
  Restorer restorer(state, work.saved);
  if (state.history.pace != 1.0) {
    // It followed its curve: its rates are not those by time.
    state.history.pace = 1.0;
    state.stage = std::min(state.stage, Stage::closed);
  }
  if (const Input* failed = set_time(*work.mechanism, time, state)) {
    work.equations.blame(*failed);
    return KOPPEL_PLUGIN;
  }
  if (branch == Branch::stay) {
    if (const auto status = track(work, state, report)) {
      if (*status >= 0) restorer.keep();
      return *status;
    }
  }
  CloseOptions options;
  options.branch = branch;
  const koppel_status closed = close_by_equations(work, state, options, report);
  if (closed < 0) return closed;
  if (work.branch_rates) {
    state.v = work.branch_rates->v;
    state.a = work.branch_rates->a;
    state.stage = Stage::accelerations;
    restorer.keep();
    return closed;
  }
  for (const auto step : {velocities, accelerations}) {
    const koppel_status status = step(work, state);
    if (status < 0) return status;
  }
  restorer.keep();
  return closed;
}

bool realise(Work& work, const State& state) {
  work.factorised = false;
  return work.equations.evaluate(state.q, state.time) && work.equations.motion(state.q, state.v, state.a);
}

}  // namespace koppel

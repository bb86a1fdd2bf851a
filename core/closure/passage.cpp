#include "closure/passage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "closure/close.hpp"
#include "closure/decompositions.hpp"
#include "closure/newton.hpp"
#include "closure/walk.hpp"
#include "mechanism/coordinates.hpp"

namespace koppel {
namespace {

/// The direction in which the state moves, as the curve's tangents are laid out; empty: not known.
Eigen::VectorXd direction_of(const Mechanism& mechanism, const State& state, const InputWay& way) {
  if (state.stage < Stage::velocities || !way.by_drives()) return {};
  Eigen::VectorXd along(mechanism.unknowns + 1);
  for (std::uint32_t i = 0; i < mechanism.unknowns; ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[i];
    along[i] = state.v[rate] / mechanism.rate_scale[rate];
  }
  along[mechanism.unknowns] = state.history.pace / way.scale();
  return state.time < state.history.time ? Eigen::VectorXd(-along) : along;
}

/// The scalar coordinate other than the inputs that moves most: the best to drive instead. -1: none.
std::int32_t fastest_coordinate(const Mechanism& mechanism, const Eigen::VectorXd& tangent) {
  std::int32_t result = -1;
  double greatest = 0.0;
  for (const StateBlock& block : mechanism.blocks) {
    const std::int32_t column = mechanism.column_of_rate[block.v];
    if (!is_scalar(block.kind) || column < 0 || column >= static_cast<std::int32_t>(mechanism.unknowns)) continue;
    const double moves = std::abs(tangent[column]);
    // What moves as fast but for rounding does not take the place of another.
    if (moves > greatest * (1.0 + 1e-9)) {
      greatest = moves;
      result = static_cast<std::int32_t>(block.q);
    }
  }
  return result;
}

void tell_limit(Curve& curve, const CurvePoint& limit, Report& report) {
  const Mechanism& mechanism = curve.mechanism();
  const std::size_t input = stopped_input(curve, limit);
  report.limit_input = static_cast<std::int32_t>(input);
  report.limit_time = curve.way().time();
  ++report.limits;
  report.limit_value = limit.q[mechanism.inputs[input].q];
  report.drive_instead = fastest_coordinate(mechanism, limit.tangent);
}

void tell_passed(Curve& curve, const Walk& walk, Report& report) {
  report.change_points = 0;
  for (const SingularPosition& passed : walk.passed) {
    if (passed.kind == SingularKind::limit) {
      tell_limit(curve, passed.point, report);
      continue;
    }
    ++report.change_points;
    if (curve.way().evaluate(passed.point.parameter)) report.change_point_time = curve.way().time();
  }
}

/// Takes q to the inputs exactly. False: there is no closed position within rounding of it.
bool finish(Work& work, const State& state, const CurvePlace& place) {
  const Mechanism& mechanism = *work.mechanism;
  const auto set_inputs = [&] {
    for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
      work.q[mechanism.inputs[i].q] = state.input[static_cast<Eigen::Index>(i)];
    }
  };
  work.q = place.point.q;
  set_inputs();
  if (!place.beside_change_point && newton(work, state.time, {}).converged) {
    constexpr double same = 1e-7;
    difference(mechanism, place.point.q, work.q, work.delta);
    if (work.delta.lpNorm<Eigen::Infinity>() <= same) return true;
  }
  // Newton's method may run away along what hardly changes the equations; the curve does not.
  work.q = place.point.q;
  set_inputs();
  work.factorised = false;
  return work.equations.evaluate(work.q, state.time) && work.equations.error() <= closed_limit;
}

/// Rates and accelerations that the drives ask for, from the branch's derivatives.
bool take_rates(Work& work, const State& state, const CurvePlace& place, const InputWay& way) {
  const Mechanism& mechanism = *work.mechanism;
  const Eigen::VectorXd& tangent = place.point.tangent;
  const double pace = tangent[mechanism.unknowns];
  auto rates = std::make_unique<BranchRates>();
  rates->v.setZero(mechanism.nv);
  rates->a.setZero(mechanism.nv);
  for (std::uint32_t i = 0; i < mechanism.unknowns; ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[i];
    const double first = tangent[i] / pace;
    const double second = (place.second[i] - first * place.second[mechanism.unknowns]) / (pace * pace);
    rates->v[rate] = mechanism.rate_scale[rate] * first / way.scale();
    rates->a[rate] = mechanism.rate_scale[rate] * second / (way.scale() * way.scale());
  }
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    rates->v[mechanism.inputs[i].v] = state.input_rate[k];
    rates->a[mechanism.inputs[i].v] = state.input_acceleration[k];
  }
  Equations& equations = work.equations;
  if (!equations.evaluate(work.q, state.time) || !equations.cut_coordinates(work.q) ||
      !equations.motion(work.q, rates->v, rates->a) || !equations.cut_rates(work.q, rates->v) ||
      !equations.cut_accelerations(work.q, rates->v, rates->a)) {
    return false;
  }
  work.branch_rates = std::move(rates);
  return true;
}

/// Rates of the state by the arc length, at a place of the curve: all but those of cut joints.
Eigen::VectorXd rates_along(const Curve& curve, const InputWay& way, const Eigen::VectorXd& tangent) {
  const Mechanism& mechanism = curve.mechanism();
  Eigen::VectorXd v = Eigen::VectorXd::Zero(mechanism.nv);
  for (std::uint32_t i = 0; i < mechanism.unknowns; ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[i];
    v[rate] = mechanism.rate_scale[rate] * tangent[i];
  }
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    v[mechanism.inputs[i].v] = way.rate()[static_cast<Eigen::Index>(i)] * way.scale() * tangent[mechanism.unknowns];
  }
  return v;
}

/// What the inputs add to accelerations by the arc length where the parameter runs evenly.
double bending(const InputWay& way, Eigen::Index input, double pace) {
  return way.acceleration()[input] * way.scale() * way.scale() * pace * pace;
}

/// The derivative of the tangent by the arc length, from the second derivative of the equations.
bool find_curvature(Curve& curve, CurvePlace& place) {
  const Mechanism& mechanism = curve.mechanism();
  Work& work = curve.work();
  CurvePoint& point = place.point;
  if (!curve.linearise(point.q, point.parameter)) return false;
  Eigen::VectorXd v = rates_along(curve, curve.way(), point.tangent);
  Equations& equations = work.equations;
  if (!equations.motion(point.q, v, work.rest) || !equations.cut_rates(point.q, v) ||
      !equations.motion(point.q, v, work.rest) || !equations.bias(point.q, v, work.rhs)) {
    return false;
  }
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    const std::uint32_t rate = mechanism.inputs[i].v;
    const double bent = bending(curve.way(), static_cast<Eigen::Index>(i), point.tangent[mechanism.unknowns]);
    work.rhs += bent / mechanism.rate_scale[rate] * equations.jacobian.col(mechanism.column_of_rate[rate]);
  }
  Eigen::MatrixXd matrix(mechanism.rows + 1, mechanism.unknowns + 1);
  matrix << curve.extended(), point.tangent.transpose();
  Eigen::VectorXd rhs(mechanism.rows + 1);
  rhs << -work.rhs, 0.0;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(1e-11);
  place.second = factors.compute(matrix).solve(rhs);
  return true;
}

/// The state at a place of the curve, with rates by a path parameter that runs with the arc length at some speed.
bool take_place(Curve& curve, const CurvePlace& place, double speed, State& state) {
  const Mechanism& mechanism = curve.mechanism();
  Equations& equations = curve.work().equations;
  const CurvePoint& point = place.point;
  state.q = point.q;
  if (!curve.linearise(state.q, point.parameter) || !equations.cut_coordinates(state.q)) return false;
  const InputWay& way = curve.way();
  state.time = state.history.time = way.time();
  state.history.step = 0.0;
  state.history.pace = speed * way.scale() * point.tangent[mechanism.unknowns];
  state.v = speed * rates_along(curve, way, point.tangent);
  state.a = speed * speed * rates_along(curve, way, place.second);
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    const Input& input = mechanism.inputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    state.a[input.v] += speed * speed * bending(way, k, point.tangent[mechanism.unknowns]);
    state.input[k] = state.q[input.q];
    state.input_rate[k] = state.v[input.v];
    state.input_acceleration[k] = state.a[input.v];
  }
  state.stage = Stage::accelerations;
  return equations.motion(state.q, state.v, state.a) && equations.cut_rates(state.q, state.v) &&
         equations.cut_accelerations(state.q, state.v, state.a);
}

/// Closed, moving, and its inputs where the drives are at its time.
bool is_on_curve(const Mechanism& mechanism, const State& state) {
  if (state.stage < Stage::velocities || state.time != state.history.time || mechanism.explicit_time) return false;
  State drives(mechanism);
  if (set_time(mechanism, state.time, drives) != nullptr) return false;
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    if (drives.input[static_cast<Eigen::Index>(i)] != state.q[mechanism.inputs[i].q]) return false;
  }
  return !mechanism.inputs.empty() && mechanism.rows > 0 && mechanism.unknowns > 0;
}

}  // namespace

koppel_status follow(Work& work, State& state, double duration, double speed, Branch branch, Report& report) {
  const Mechanism& mechanism = *work.mechanism;
  report = Report{};
  if (!is_on_curve(mechanism, state)) return KOPPEL_INVALID_ARGUMENT;
  Curve curve(work, InputWay::of_drives(mechanism, 0.0, mechanism.duration));
  const Eigen::VectorXd along = direction_of(mechanism, state, curve.way());
  if (speed <= 0.0) speed = along.norm();
  Walk walk = walk_by(curve, state.q, state.time, along, speed * duration, branch);
  if (walk.end == WalkEnd::plugin_failed) return KOPPEL_PLUGIN;
  if (walk.end != WalkEnd::arrived) return KOPPEL_NOT_CLOSED;
  if (!walk.place.beside_change_point && !find_curvature(curve, walk.place)) return KOPPEL_PLUGIN;
  State next = state;
  if (!take_place(curve, walk.place, speed, next)) return KOPPEL_PLUGIN;
  const koppel_status status = close(work, next, {}, report);  // closed already: only describes it
  if (status < 0) return status;
  // Known across the curve, not along the unknowns alone: beside a change point from the branch, at a limit too.
  const double across = walk.place.beside_change_point ? 0.01 : walk.place.point.weakest;
  report.coordinate_error *= std::min(1.0, work.condition.smallest / across);
  next.history.sides[0] = 0;
  next.history.rank = report.rank;
  next.history.weakest = work.condition.smallest;
  tell_passed(curve, walk, report);
  report.pace = next.history.pace;
  state = std::move(next);
  return report.change_points > 0 ? status | KOPPEL_CHANGE_POINT : status;
}

PassageEnd pass(Work& work, const State& state, Branch branch, Report& report) {
  const Mechanism& mechanism = *work.mechanism;
  work.branch_rates.reset();
  if (mechanism.rows == 0 || mechanism.unknowns == 0) return PassageEnd::lost;
  const bool drives = drives_lead(mechanism, state);
  Curve curve(work, drives ? InputWay::of_drives(mechanism, state.history.time, state.time)
                           : InputWay::straight(mechanism, state));
  const double from = drives ? state.history.time : 0.0, to = drives ? state.time : 1.0;
  Walk walk = walk_to(curve, state.q, from, direction_of(mechanism, state, curve.way()), to, branch);
  switch (walk.end) {
    case WalkEnd::plugin_failed: return PassageEnd::plugin_failed;
    case WalkEnd::lost: return PassageEnd::lost;
    case WalkEnd::limit:
      tell_limit(curve, walk.place.point, report);
      report.verdict = Verdict::limit;
      return PassageEnd::limit;
    case WalkEnd::arrived: break;
  }
  report.solver = SolverUsed::newton;
  tell_passed(curve, walk, report);
  if (!finish(work, state, walk.place)) return PassageEnd::lost;
  if (drives && walk.place.beside_change_point && !take_rates(work, state, walk.place, curve.way())) {
    return PassageEnd::plugin_failed;
  }
  return PassageEnd::arrived;
}

}  // namespace koppel

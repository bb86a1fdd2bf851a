#include "closure/passage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
  along[mechanism.unknowns] = 1.0 / way.scale();
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
  report.verdict = Verdict::limit;
  report.limit_input = static_cast<std::int32_t>(input);
  report.limit_time = curve.way().time();
  report.limit_value = limit.q[mechanism.inputs[input].q];
  report.drive_instead = fastest_coordinate(mechanism, limit.tangent);
}

void tell_passed(Curve& curve, const Walk& walk, Report& report) {
  report.change_points = 0;
  for (const SingularPosition& passed : walk.passed) {
    if (passed.kind != SingularKind::change_point) continue;
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

}  // namespace

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
    case WalkEnd::limit: tell_limit(curve, walk.place.point, report); return PassageEnd::limit;
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

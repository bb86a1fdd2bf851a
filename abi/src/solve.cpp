#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "boundary.hpp"
#include "closure/analysis.hpp"
#include "closure/close.hpp"
#include "closure/explain.hpp"
#include "closure/freedoms.hpp"
#include "closure/independent.hpp"
#include "closure/passage.hpp"

namespace {

using koppel::Code;
using koppel::Mechanism;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

/// A length, or an angle in degrees, with all digits that are sure.
std::string quantity(const Mechanism& m, std::uint32_t coordinate, double value) {
  const bool angle = m.coordinate_names[coordinate].unit == "rad";
  char text[48];
  std::snprintf(text, sizeof text, "%.9f %s", angle ? value * 180.0 / std::numbers::pi : value, angle ? "deg" : "m");
  return text;
}

/// Which drive goes no further, where, and what to drive instead.
void explain_limit(const Mechanism& m, const koppel::Report& report, double asked, koppel::Error& e) {
  const koppel::Input& input = m.inputs[static_cast<std::size_t>(report.limit_input)];
  const std::string& name = m.coordinate_names[input.q].name;
  char time[32];
  std::snprintf(time, sizeof time, "%.9f", report.limit_time);
  e.code = Code::drive_limit;
  e.element = "drive of " + name;
  e.message = "no closed position at time " + number(asked) + " s: `" + name + "` goes no further than " +
              quantity(m, input.q, report.limit_value) + ", a limit position that it reaches at " + time + " s";
  e.advice = "reverse the drive";
  if (report.drive_instead >= 0) {
    const auto other = static_cast<std::size_t>(report.drive_instead);
    e.advice += ", drive `" + m.coordinate_names[other].name + "` instead, which moves most there";
  }
  e.advice += ", or follow the curve past the limit (`koppel run --through`, koppel_follow)";
}

/// What stands in the way, in words; texts are made only now that somebody asks.
/// `time`: that was asked for. `report`: of the closure, if there was one.
koppel_status explain_failure(koppel_status status, const koppel::Work& work, double time, const koppel::Report* report,
                              koppel_error* error) {
  const koppel::Mechanism& m = *work.mechanism;
  koppel::Error e = koppel::make_error(Code::internal, "mechanism " + m.name, {});
  switch (status) {
    case KOPPEL_NOT_CLOSED:
    case KOPPEL_RETRY: {
      if (report != nullptr && report->verdict == koppel::Verdict::limit) {
        explain_limit(m, *report, time, e);
        break;
      }
      const bool unreachable = report != nullptr && report->verdict == koppel::Verdict::unreachable;
      e.code = unreachable ? Code::unreachable : status == KOPPEL_RETRY ? Code::retry_smaller : Code::not_closed;
      const std::string where =
          "time " + number(time) + " s" + (m.with_start_held ? " that keeps the fixed start values" : "");
      e.message = unreachable ? "there is no closed position at " + where +
                                    ": all solutions of the closure equations are known, and none is real"
                              : "no closed position found at " + where;
      if (report != nullptr && std::isfinite(report->residual) && report->open_row < m.equation_names.size()) {
        e.message += std::string(unreachable ? "; at best" : ":") + " `" + m.equation_names[report->open_row].name +
                     "` stays open by " + number(report->residual) + " (radians, or metres over the length " +
                     number(m.length) + " m)";
      }
      e.advice = unreachable ? "change the inputs or the lengths; `koppel modes --time` shows when there are positions"
                 : status == KOPPEL_RETRY
                     ? "move the inputs in smaller steps"
                     : "give `start` values near a known position, or check lengths and inputs: the "
                       "mechanism may not reach this position";
      if (m.with_start_held) e.advice += "; or fix fewer start values";
      break;
    }
    case KOPPEL_SINGULAR:
      e.code = Code::inputs_inconsistent;
      e.message = "the inputs ask for rates that are impossible at time " + number(time) + " s";
      e.advice =
          "this is a limit position, or there are more inputs than freedoms: stop before it, or drive another "
          "coordinate";
      break;
    case KOPPEL_PLUGIN:
      e.code = Code::plugin_misbehaved;
      e.element = work.equations.culprit();
      e.message = "a function of the plugin failed or gave a value that is not finite";
      e.advice = "check the parameters of the element; if they are right, report it to the author of the plugin";
      break;
    default:
      e.code = Code::not_closed_yet;
      e.message = "the state is not closed for its inputs, or velocities are missing";
      e.advice = "call close, then velocities, then accelerations";
      break;
  }
  return koppel::fail(status, e, error);
}

bool acceptable(const koppel_close_options& o) {
  return o.method >= KOPPEL_METHOD_AUTO && o.method <= KOPPEL_METHOD_FLOW && std::isfinite(o.tolerance) &&
         o.tolerance >= 0.0 && o.max_iterations <= std::numeric_limits<std::int32_t>::max();
}

koppel::CloseOptions options_of(const koppel_close_options& o) {
  koppel::CloseOptions options;
  options.method = o.method == KOPPEL_METHOD_NEWTON  ? koppel::Method::newton
                   : o.method == KOPPEL_METHOD_CERES ? koppel::Method::ceres
                   : o.method == KOPPEL_METHOD_FLOW  ? koppel::Method::flow
                                                     : koppel::Method::automatic;
  options.max_iterations = o.max_iterations;
  options.tolerance = o.tolerance;
  return options;
}

void write_report(const koppel::Mechanism& m, const koppel::Report& report, koppel_report* to) {
  if (to == nullptr) return;
  koppel_report out{};
  out.verdict = static_cast<std::int32_t>(report.verdict);
  out.solver = static_cast<std::int32_t>(report.solver);
  out.iterations = report.iterations;
  out.rank = report.rank;
  out.equations = m.rows;
  out.unknowns = m.unknowns;
  out.residual = report.residual;
  out.condition = report.condition;
  out.coordinate_error = report.coordinate_error;
  out.change_points = report.change_points;
  out.change_point_time = report.change_point_time;
  out.limit_input = report.limit_input;
  out.limit_time = report.limit_time;
  out.limit_value = report.limit_value;
  out.drive_instead = report.drive_instead;
  out.limits = report.limits;
  out.pace = report.pace;
  koppel::write_struct(out, to);
}

bool acceptable(const koppel_motion_options& o) {
  return o.branch >= KOPPEL_BRANCH_STAY && o.branch <= KOPPEL_BRANCH_TAKE && std::isfinite(o.speed) && o.speed >= 0.0;
}

koppel::Branch branch_of(const koppel_motion_options& o) {
  return o.branch == KOPPEL_BRANCH_TAKE ? koppel::Branch::take : koppel::Branch::stay;
}

koppel_status misfit(koppel_error* error) {
  return koppel::invalid_argument("state or work is NULL, or they belong to different mechanisms", error);
}

koppel_status freedoms_of(const koppel_state* state, koppel_work* work, koppel::Freedoms& freedoms,
                          koppel_error* error) {
  if (!koppel::fit(state, work)) return misfit(error);
  const auto explained = [&](koppel_status status) {
    return explain_failure(status, work->work, state->state.time, nullptr, error);
  };
  if (!koppel::is_closed(*state->mechanism, state->state)) return explained(KOPPEL_INVALID_ARGUMENT);
  return koppel::find_freedoms(work->work, state->state, freedoms) ? KOPPEL_OK : explained(KOPPEL_PLUGIN);
}

}  // namespace

static_assert(static_cast<int>(koppel::Verdict::open) == KOPPEL_VERDICT_OPEN);
static_assert(static_cast<int>(koppel::Verdict::closed) == KOPPEL_VERDICT_CLOSED);
static_assert(static_cast<int>(koppel::Verdict::not_found) == KOPPEL_VERDICT_NOT_FOUND);
static_assert(static_cast<int>(koppel::Verdict::retry) == KOPPEL_VERDICT_RETRY);
static_assert(static_cast<int>(koppel::Verdict::limit) == KOPPEL_VERDICT_LIMIT);
static_assert(static_cast<int>(koppel::Verdict::unreachable) == KOPPEL_VERDICT_UNREACHABLE);
static_assert(static_cast<int>(koppel::SolverUsed::none) == KOPPEL_SOLVER_NONE);
static_assert(static_cast<int>(koppel::SolverUsed::newton) == KOPPEL_SOLVER_NEWTON);
static_assert(static_cast<int>(koppel::SolverUsed::ceres) == KOPPEL_SOLVER_CERES);
static_assert(static_cast<int>(koppel::SolverUsed::flow) == KOPPEL_SOLVER_FLOW);

koppel_status koppel_work_create(const koppel_mechanism* mechanism, koppel_work** work) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (mechanism == nullptr || work == nullptr) return KOPPEL_INVALID_ARGUMENT;
    *work = new koppel_work{mechanism->registry, koppel::Work(mechanism->mechanism), nullptr};
    return KOPPEL_OK;
  });
}

void koppel_work_destroy(koppel_work* work) { delete work; }

koppel_status koppel_close(koppel_state* state, koppel_work* work, const koppel_close_options* options,
                           koppel_report* report, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) return misfit(error);
    const koppel_close_options given = koppel::read_struct(options);
    if (!acceptable(given)) return koppel::invalid_argument("the options name no method, tolerance or limit", error);
    koppel::Report result;
    const koppel_status status = koppel::close(work->work, state->state, options_of(given), result);
    if (status >= 0 || status == KOPPEL_NOT_CLOSED || status == KOPPEL_RETRY) {
      write_report(*state->mechanism, result, report);
    }
    return status >= 0 ? status : explain_failure(status, work->work, state->state.time, &result, error);
  });
}

koppel_status koppel_velocities(koppel_state* state, koppel_work* work, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) return misfit(error);
    const koppel_status status = koppel::velocities(work->work, state->state);
    return status >= 0 ? status : explain_failure(status, work->work, state->state.time, nullptr, error);
  });
}

koppel_status koppel_accelerations(koppel_state* state, koppel_work* work, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) return misfit(error);
    const koppel_status status = koppel::accelerations(work->work, state->state);
    return status >= 0 ? status : explain_failure(status, work->work, state->state.time, nullptr, error);
  });
}

koppel_status koppel_move(koppel_state* state, koppel_work* work, double time, koppel_report* report,
                          koppel_error* error) {
  return koppel_move_on(state, work, time, nullptr, report, error);
}

koppel_status koppel_move_on(koppel_state* state, koppel_work* work, double time, const koppel_motion_options* options,
                             koppel_report* report, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) return misfit(error);
    if (!std::isfinite(time)) return koppel::invalid_argument("time is not finite", error);
    const koppel_motion_options given = koppel::read_struct(options);
    if (!acceptable(given)) return koppel::invalid_argument("the options name no branch or speed", error);
    koppel::Report result;
    const koppel_status status = koppel::move(work->work, state->state, time, result, branch_of(given));
    if (status >= 0 || status == KOPPEL_NOT_CLOSED || status == KOPPEL_RETRY) {
      write_report(*state->mechanism, result, report);
    }
    return status >= 0 ? status : explain_failure(status, work->work, time, &result, error);
  });
}

koppel_status koppel_follow(koppel_state* state, koppel_work* work, double duration,
                            const koppel_motion_options* options, koppel_report* report, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) return misfit(error);
    const koppel_motion_options given = koppel::read_struct(options);
    if (!acceptable(given)) return koppel::invalid_argument("the options name no branch or speed", error);
    if (!std::isfinite(duration) || duration < 0.0) {
      return koppel::invalid_argument("the duration is negative or not finite", error);
    }
    koppel::Report result;
    const koppel_status status =
        koppel::follow(work->work, state->state, duration, given.speed, branch_of(given), result);
    if (status >= 0) write_report(*state->mechanism, result, report);
    if (status == KOPPEL_INVALID_ARGUMENT) {
      return koppel::invalid_argument(
          "the state does not move with its drives along a curve: move it to a time first; it must have drives and "
          "loops, and no constraint that depends on time",
          error);
    }
    return status >= 0 ? status : explain_failure(status, work->work, state->state.time, nullptr, error);
  });
}

koppel_status koppel_independent(const koppel_state* state, koppel_work* work, uint32_t* rates, size_t size,
                                 size_t* count, double* quality, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) return misfit(error);
    if (count == nullptr || (rates == nullptr && size > 0) || *count > size) {
      return koppel::invalid_argument("rates or count is NULL, or count is larger than size", error);
    }
    const Mechanism& m = *state->mechanism;
    if (!koppel::is_closed(m, state->state)) {
      return explain_failure(KOPPEL_INVALID_ARGUMENT, work->work, state->state.time, nullptr, error);
    }
    koppel::IndependentSet set;
    set.rates.assign(rates, rates + *count);
    std::sort(set.rates.begin(), set.rates.end());
    const bool twice = std::adjacent_find(set.rates.begin(), set.rates.end()) != set.rates.end();
    if (twice || (!set.rates.empty() && set.rates.back() >= m.nv)) {
      return koppel::invalid_argument("the set so far names a rate twice, or one that there is not", error);
    }
    bool switched = false;
    if (!koppel::update_independent(work->work, state->state, set, switched)) {
      return explain_failure(KOPPEL_PLUGIN, work->work, state->state.time, nullptr, error);
    }
    if (set.rates.size() > size) {
      *count = set.rates.size();
      return koppel::invalid_argument("there is too little room for the independent rates", error);
    }
    std::copy(set.rates.begin(), set.rates.end(), rates);
    *count = set.rates.size();
    if (quality != nullptr) *quality = set.quality;
    return KOPPEL_OK;
  });
}

koppel_status koppel_analyse(const koppel_state* state, koppel_work* work, koppel_analysis* analysis,
                             koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) return misfit(error);
    if (analysis == nullptr) return koppel::invalid_argument("analysis is NULL", error);
    koppel::Analysis result;
    if (!koppel::analyse(work->work, state->state, result)) {
      return explain_failure(KOPPEL_PLUGIN, work->work, state->state.time, nullptr, error);
    }
    koppel_analysis out{};
    out.mobility_count = result.mobility_count;
    out.mobility_rank = result.mobility_rank;
    out.rank = result.rank;
    out.equations = state->mechanism->rows;
    out.tree_rates = state->mechanism->columns;
    out.largest_singular_value = result.largest_singular_value;
    out.last_singular_value = result.last_singular_value;
    out.gap = result.gap;
    koppel::write_struct(out, analysis);
    return KOPPEL_OK;
  });
}

koppel_status koppel_find_freedoms(const koppel_state* state, koppel_work* work, koppel_freedoms* freedoms,
                                   koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (freedoms == nullptr) return koppel::invalid_argument("freedoms is NULL", error);
    koppel::Freedoms found;
    const koppel_status status = freedoms_of(state, work, found, error);
    if (status < 0) return status;
    const auto of_kind = [&](koppel::LoopKind kind) {
      return static_cast<std::uint32_t>(std::count_if(found.loops.begin(), found.loops.end(),
                                                      [kind](const auto& loop) { return loop.kind == kind; }));
    };
    koppel_freedoms out{};
    out.mobility_by_kind = found.mobility_by_kind;
    out.mobility_here = found.mobility_here;
    out.mobility_nearby = found.mobility_nearby;
    out.redundant_here = found.redundant_here;
    out.redundant_nearby = found.redundant_nearby;
    out.planar_loops = of_kind(koppel::LoopKind::planar);
    out.spherical_loops = of_kind(koppel::LoopKind::spherical);
    out.isolated = static_cast<std::uint32_t>(found.isolated.size());
    out.indeterminate = static_cast<std::uint32_t>(found.indeterminate.size());
    out.shaky = found.shaky ? 1 : 0;
    koppel::write_struct(out, freedoms);
    return KOPPEL_OK;
  });
}

koppel_status koppel_explain_freedoms(const koppel_state* state, koppel_work* work, char* text, size_t size,
                                      size_t* needed) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    koppel::Freedoms found;
    const koppel_status status = freedoms_of(state, work, found, nullptr);
    if (status < 0) return status;
    return koppel::write_text(koppel::explain(*state->mechanism, found), text, size, needed);
  });
}

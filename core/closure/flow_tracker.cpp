#include "closure/flow_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "closure/loop_cut.hpp"

namespace koppel {
namespace {

constexpr std::size_t written_out = 3;  // variables of a condition: with more of them walking costs less

/// The places of all variables for one sample of a form.
std::vector<Place<double>> places_at(std::span<const Variable> all, std::span<const std::uint32_t> variables,
                                     std::span<const double> x) {
  std::vector<Place<double>> at(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    // What does not enter may be anything: here it does not move.
    if (all[i].kind != VariableKind::slide) at[i][0] = 1.0;
  }
  for (std::size_t i = 0; i < variables.size(); ++i) {
    at[variables[i]] = place_at(all[variables[i]].kind, x[i]);
  }
  return at;
}

/// With one variable moved to the end.
std::vector<std::uint32_t> with_last(std::vector<std::uint32_t> variables, std::uint32_t last) {
  std::erase(variables, last);
  variables.push_back(last);
  return variables;
}

}  // namespace

std::optional<FlowTracker> FlowTracker::of(const Mechanism& mechanism, const Flow& flow) {
  if (!flow.obstacle.empty() || !flow.held.empty() || flow.steps.empty()) return std::nullopt;
  for (const std::uint32_t v : flow.outside) {
    if (std::find(flow.inputs.begin(), flow.inputs.end(), v) == flow.inputs.end()) return std::nullopt;
  }
  FlowTracker tracker(mechanism, flow);
  for (const FlowStep& from : flow.steps) {
    Step step;
    if (!tracker.compile(flow, from, step)) return std::nullopt;
    tracker.steps_.push_back(std::move(step));
  }
  return tracker;
}

FlowTracker::FlowTracker(const Mechanism& mechanism, const Flow& flow)
    : length_(mechanism.length),
      variables_(flow.loops.variables),
      inputs_(flow.inputs),
      bases_(variables_.size()),
      places_(variables_.size()),
      errors_(variables_.size(), 0.0) {}

bool FlowTracker::compile(const Flow& flow, const FlowStep& from, Step& step) const {
  if (from.kind == StepKind::spin || from.kind == StepKind::numerical) return false;
  step.kind = from.kind;
  step.given = from.given;
  step.unknowns = from.unknowns;
  if (from.kind == StepKind::joint) compile_joint(flow, from, step);
  for (const FlowRow& from_row : from.rows) {
    const LoopCut& cut = flow.cuts[from_row.cut];
    const Loop& loop = flow.loops.loops[cut.loop];
    Row row{cut.conditions[from_row.condition], std::nullopt, lower_way(loop, variables_, cut),
            upper_way(loop, variables_, cut)};
    const auto variables = with_last(from_row.variables, from.unknowns.back());
    const bool small = variables.size() <= written_out || from.kind == StepKind::two_unknowns;
    if (small) {
      row.form = ProductForm::of(variables, variables_, length_, [&](std::span<const double> x) {
        return openness(row.condition, row.lower, row.upper, places_at(variables_, variables, x), length_);
      });
    }
    if (from.kind == StepKind::two_unknowns && !row.form) return false;
    step.rows.push_back(std::move(row));
  }
  return true;
}

void FlowTracker::compile_joint(const Flow& flow, const FlowStep& from, Step& step) const {
  const LoopCut& cut = flow.cuts[from.cut];
  const Loop& loop = flow.loops.loops[cut.loop];
  step.around = lower_way(loop, variables_, cut);
  step.unknowns.clear();
  for (std::size_t i = 0; i < cut.a.count; ++i) {
    const LoopMotion& motion = loop.motions[(cut.a.first + i) % loop.motions.size()];
    step.unknowns.push_back(motion.variable);
    step.inverse.push_back(motion.inverse);
    step.against = step.against || (i == 1 && motion.to.rotation(2, 2) < 0.0);
  }
}

void FlowTracker::find_sides(const Eigen::VectorXd& q, Sides& sides) {
  Eigen::VectorXd copy = q;
  q_ = &copy;
  for (std::uint32_t i = 0; i < variables_.size(); ++i) {
    if (variables_[i].kind == VariableKind::ball) {
      std::copy_n(q.data() + variables_[i].q, 4, places_[i].at.begin());
    } else {
      place(i, q[variables_[i].q]);
    }
  }
  for (std::size_t i = 0; i < steps_.size(); ++i) sides[i] = side_of(steps_[i]);
}

bool FlowTracker::follow(Eigen::VectorXd& q, Eigen::VectorXd& v, Eigen::VectorXd& a, const Sides& sides,
                         TrackedAccuracy& accuracy) {
  q_ = &q;
  v_ = &v;
  a_ = &a;
  accuracy_ = {};
  for (const std::uint32_t input : inputs_) {
    const Variable& variable = variables_[input];
    place(input, q[variable.q]);
    set_motion(input, v[variable.v], a[variable.v]);
    errors_[input] = 0.0;
  }
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    switch (step.kind) {
      case StepKind::one_unknown:
        if (!solve_one(step, sides[i])) return false;
        break;
      case StepKind::two_unknowns:
        if (!solve_two(step, sides[i])) return false;
        break;
      case StepKind::joint: read_joint(step); break;
      case StepKind::spin:
      case StepKind::numerical: return false;  // not compiled
    }
  }
  accuracy = accuracy_;
  constexpr double closed = 1e-13;
  return std::isfinite(accuracy_.coordinate_error) && accuracy_.residual <= closed;
}

void FlowTracker::place(std::uint32_t variable, double x) {
  if (variables_[variable].kind == VariableKind::turn) {
    place_turn(variable, x, std::cos(x), std::sin(x));
  } else {
    (*q_)[variables_[variable].q] = x;
    bases_[variable].set_slide(x);
    places_[variable].at[0] = x;
  }
}

void FlowTracker::place_turn(std::uint32_t variable, double x, double cosine, double sine) {
  (*q_)[variables_[variable].q] = x;
  bases_[variable].set_turn(cosine, sine);
  places_[variable].at = {cosine, sine, 0.0, 0.0};
}

void FlowTracker::set_motion(std::uint32_t variable, double v, double a) {
  (*v_)[variables_[variable].v] = v;
  (*a_)[variables_[variable].v] = a;
  bases_[variable].set_motion(variables_[variable].kind, v, a);
  places_[variable].rate[0] = v;
  places_[variable].acceleration[0] = a;
}

void FlowTracker::take_error(std::uint32_t variable, double error) {
  errors_[variable] = error * (variables_[variable].kind == VariableKind::slide ? length_ : 1.0);
  accuracy_.coordinate_error = std::max(accuracy_.coordinate_error, error);
}

}  // namespace koppel

#include "closure/explain_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>
#include <tuple>

#include "closure/flow_words.hpp"

namespace koppel {
namespace {

/// What tells a cut of a loop from others, whichever step uses it.
using CutPlace = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>;

CutPlace place_of(const LoopCut& cut) {
  return {cut.a.first, cut.a.count, cut.b ? cut.b->first : 0, cut.b ? cut.b->count : 0};
}

/// Conditions of one cut, gathered from the steps that use them.
struct UsedCut {
  const LoopCut* cut = nullptr;
  std::array<int, 5> types{};  ///< how many of each
};

std::vector<UsedCut> used_cuts(const Flow& flow, std::uint32_t loop) {
  std::vector<UsedCut> used;
  for (const FlowStep& step : flow.steps) {
    for (const FlowRow& row : step.rows) {
      const LoopCut& cut = flow.cuts[row.cut];
      if (cut.loop != loop) continue;
      const auto same = [&](const UsedCut& other) { return place_of(*other.cut) == place_of(cut); };
      auto at = std::find_if(used.begin(), used.end(), same);
      if (at == used.end()) at = used.insert(used.end(), {&cut, {}});
      ++at->types[static_cast<std::size_t>(cut.conditions[row.condition].type) - 1];
    }
  }
  return used;
}

void explain_cut(const Mechanism& mechanism, const Flow& flow, const UsedCut& used, std::ostream& out) {
  out << "     cut at " << cut_letters(flow, *used.cut) << " (" << listed(cut_names(mechanism, flow, *used.cut))
      << "): ";
  std::string separator;
  for (std::size_t i = 0; i < used.types.size(); ++i) {
    if (used.types[i] == 0) continue;
    out << separator;
    if (used.types[i] > 1) out << used.types[i] << " of ";
    out << "type " << i + 1 << " (" << type_name(static_cast<ClosureType>(i + 1)) << ')';
    separator = ", ";
  }
  out << '\n';
}

void explain_loops(const Mechanism& mechanism, const Flow& flow, std::ostream& out) {
  out << "\nLoops\n";
  std::set<std::uint32_t> whole;
  for (const FlowStep& step : flow.steps) whole.insert(step.whole_loops.begin(), step.whole_loops.end());
  for (std::uint32_t i = 0; i < flow.loops.loops.size(); ++i) {
    out << "  " << i + 1 << ". " << listed(joint_names(mechanism, flow, flow.loops.loops[i].joints)) << '\n';
    const std::vector<UsedCut> cuts = used_cuts(flow, i);
    for (const UsedCut& used : cuts) explain_cut(mechanism, flow, used, out);
    if (whole.contains(i)) out << "     not cut: enters with all conditions that close it\n";
    if (cuts.empty() && !whole.contains(i)) out << "     not cut: what the other loops leave open is read off\n";
  }
  for (std::uint32_t i = 0; i < flow.loops.imaginary.size(); ++i) {
    const auto number = static_cast<std::uint32_t>(mechanism.joints.size()) + i;
    const auto& [a, b] = flow.loops.imaginary[i];
    out << "  " << joint_name(mechanism, flow, {number}) << " is imaginary: it makes the pose of "
        << mechanism.bodies[b.index()].name << " against " << mechanism.bodies[a.index()].name << " a coordinate\n";
  }
}

void explain_variables(const Mechanism& mechanism, const Flow& flow, const std::string& title,
                       const std::vector<std::uint32_t>& variables, std::ostream& out) {
  if (variables.empty()) return;
  out << '\n' << title << "\n  " << listed(variable_names(mechanism, flow, variables)) << '\n';
}

/// The cuts that a step uses, each with its joints: "loop 1 cut at S-T (ball, fork)". Of many loops, not all again.
std::string cuts_of(const Mechanism& mechanism, const Flow& flow, const FlowStep& step) {
  if (step.loops.size() > 2) return "the loops cut as told above";
  std::string text;
  std::set<std::uint32_t> seen;
  for (const FlowRow& row : step.rows) {
    if (!seen.insert(row.cut).second) continue;
    const LoopCut& cut = flow.cuts[row.cut];
    text += (text.empty() ? "" : "; ") + loop_words({cut.loop}) + " cut at " + cut_letters(flow, cut) + " (" +
            listed(cut_names(mechanism, flow, cut)) + ")";
  }
  for (const std::uint32_t loop : step.whole_loops)
    text += (text.empty() ? "" : "; ") + loop_words({loop}) + " as a whole";
  if (text.empty()) text = loop_words(step.loops);
  return text;
}

/// In which order steps are told: those that are done anyway, then those on demand.
std::vector<std::size_t> told_order(const Flow& flow) {
  std::vector<std::size_t> order(flow.steps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return !flow.steps[i].only_here; });
  return order;
}

void explain_step(const Mechanism& mechanism, const Flow& flow, const FlowStep& step, std::size_t number,
                  std::ostream& out) {
  out << "  " << number << ". " << listed(variable_names(mechanism, flow, step.unknowns)) << '\n';
  if (!step.given.empty()) out << "     from " << listed(variable_names(mechanism, flow, step.given)) << '\n';
  out << "     " << solver_words(mechanism, flow, step) << "; " << cuts_of(mechanism, flow, step) << '\n';
  if (step.twins) out << "     both solutions look alike: the link turned over about the line of its joints\n";
}

void explain_steps(const Mechanism& mechanism, const Flow& flow, std::ostream& out) {
  std::size_t number = 0;
  bool on_demand = false;
  out << "\nSteps\n";
  for (const std::size_t i : told_order(flow)) {
    if (flow.steps[i].only_here && !on_demand) out << "\nOn demand: coordinates of the cut joints\n";
    on_demand = flow.steps[i].only_here;
    explain_step(mechanism, flow, flow.steps[i], ++number, out);
  }
}

void explain_coupling(const Flow& flow, std::ostream& out) {
  std::string text;
  std::size_t number = 0;
  for (const std::size_t i : told_order(flow)) {
    ++number;
    const StepKind kind = flow.steps[i].kind;
    if (kind != StepKind::two_unknowns && kind != StepKind::numerical) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(unknowns_in(flow, flow.steps[i])) + " in step " +
            std::to_string(number);
  }
  out << "\nUnknowns that must be found together: " << (text.empty() ? "none" : text) << '\n';
}

/// A body that has two turns about one axis on the way of a loop: there the angles add up, and more bodies than two are
/// joined on that axis (K-II-4.2.3).
/// Here as the two variables, ascending, and whether their axes are opposite.
using SummingPoint = std::tuple<std::uint32_t, std::uint32_t, bool>;

std::set<SummingPoint> summing_points(const Flow& flow) {
  const double tolerance = std::sqrt(std::numeric_limits<double>::epsilon());
  std::set<SummingPoint> points;
  for (const Loop& loop : flow.loops.loops) {
    for (std::size_t i = 0; i < loop.motions.size() && loop.motions.size() > 1; ++i) {
      const LoopMotion& here = loop.motions[i];
      const LoopMotion& next = loop.motions[(i + 1) % loop.motions.size()];
      const Variable &a = flow.loops.variables[here.variable], &b = flow.loops.variables[next.variable];
      if (a.kind != VariableKind::turn || b.kind != VariableKind::turn || a.joint == b.joint) continue;
      const bool parallel = next.to.rotation.col(2).head<2>().norm() < tolerance;
      const bool on_axis = next.to.position.head<2>().norm() < tolerance * flow.length;
      if (!parallel || !on_axis) continue;
      points.insert({std::min(here.variable, next.variable), std::max(here.variable, next.variable),
                     next.to.rotation(2, 2) < 0.0});
    }
  }
  return points;
}

/// The body that two joints share, and those that they join to it; empty names if there is no such.
std::array<std::string, 3> bodies_of(const Mechanism& mechanism, const Joint& a, const Joint& b) {
  const auto ends = [](const Joint& joint) { return std::array{joint.inlet.body, joint.outlet.body}; };
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (ends(a)[i] != ends(b)[k]) continue;
      const auto name = [&](BodyId body) { return mechanism.bodies[body.index()].name; };
      return {name(ends(a)[i]), name(ends(a)[1 - i]), name(ends(b)[1 - k])};
    }
  }
  return {};
}

void explain_summing_points(const Mechanism& mechanism, const Flow& flow, std::ostream& out) {
  for (const auto& [first, second, opposite] : summing_points(flow)) {
    const JointId a = flow.loops.variables[first].joint, b = flow.loops.variables[second].joint;
    const auto [shared, from, to] = bodies_of(mechanism, mechanism.joints[a.index()], mechanism.joints[b.index()]);
    if (shared.empty()) continue;
    out << "Summing point at " << shared << ": " << from << " and " << to << " turn about one axis there, and "
        << variable_name(mechanism, flow, first) << (opposite ? " - " : " + ") << variable_name(mechanism, flow, second)
        << " give the angle between them\n";
  }
}

}  // namespace

std::string explain(const Mechanism& mechanism, const Flow& flow) {
  std::ostringstream out;
  out << "Solution flow of " << mechanism.name;
  if (!mechanism.title.empty()) out << ": " << mechanism.title;
  out << '\n';
  if (!flow.obstacle.empty()) {
    out << "\nThere is none: " << flow.obstacle << "\nAll loops are closed together, numerically\n";
    return out.str();
  }
  if (!flow.loops.loops.empty()) explain_loops(mechanism, flow, out);
  explain_variables(mechanism, flow, "Inputs", flow.inputs, out);
  explain_variables(mechanism, flow, "Taken as they are: no input determines them", flow.held, out);
  std::vector<std::uint32_t> outside = flow.outside;
  std::erase_if(outside, [&](std::uint32_t v) { return std::count(flow.inputs.begin(), flow.inputs.end(), v) > 0; });
  explain_variables(mechanism, flow, "In no loop", outside, out);
  if (flow.loops.loops.empty()) {
    out << "\nThere are no loops: nothing has to be solved\n";
    return out.str();
  }
  explain_steps(mechanism, flow, out);
  explain_coupling(flow, out);
  explain_summing_points(mechanism, flow, out);
  out << (flow.in_closed_form() ? "Every step is in closed form\n" : "Not every step is in closed form\n");
  return out.str();
}

}  // namespace koppel

#include "closure/flow.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "closure/flow_plan.hpp"

namespace koppel {

bool Flow::in_closed_form() const {
  return obstacle.empty() && std::none_of(steps.begin(), steps.end(),
                                          [](const FlowStep& step) { return step.kind == StepKind::numerical; });
}

namespace {

constexpr std::size_t most_loops = 64;  // of mechanisms for which more than one choice of loops is tried

/// What must be solved together: the largest block, all of them, and pairs of unknowns. Sizes are about the degrees of
/// the equations: a turn enters twice as often as a slide.
std::tuple<std::size_t, std::size_t, std::size_t> cost(const Flow& flow) {
  std::size_t largest = 0, sum = 0, pairs = 0;
  for (const FlowStep& step : flow.steps) {
    if (step.kind == StepKind::two_unknowns) ++pairs;
    if (step.kind != StepKind::numerical) continue;
    std::size_t size = 0;
    for (const std::uint32_t v : step.unknowns) {
      const VariableKind kind = flow.loops.variables[v].kind;
      size += kind == VariableKind::ball   ? std::size_t{3}
              : kind == VariableKind::turn ? std::size_t{2}
                                           : std::size_t{1};
    }
    largest = std::max(largest, size);
    sum += size;
  }
  return {largest, sum, pairs};
}

Flow plan_with(const Mechanism& mechanism, const LoopChoice& choice) {
  Flow flow;
  LoopsOrObstacle found = find_loops(mechanism, choice);
  flow.obstacle = std::move(found.obstacle);
  if (!flow.obstacle.empty()) return flow;
  flow.loops = std::move(found.loops);
  flow.length = mechanism.length;
  std::set<std::uint32_t> driven;
  for (const Input& input : mechanism.inputs) driven.insert(input.v);
  for (std::uint32_t i = 0; i < flow.loops.variables.size(); ++i) {
    if (driven.contains(flow.loops.variables[i].v)) flow.inputs.push_back(i);
  }
  FlowPlan(flow).run();
  return flow;
}

/// Pairs of bodies that many joints hold, as the platform and the base of a parallel robot.
std::vector<ImaginaryJoint> hubs(const Mechanism& mechanism) {
  constexpr int many = 3;
  std::vector<int> count(mechanism.bodies.size(), 0);
  for (const Joint& joint : mechanism.joints) {
    ++count[joint.inlet.body.index()];
    ++count[joint.outlet.body.index()];
  }
  std::vector<ImaginaryJoint> pairs;
  for (std::uint32_t a = 0; a < count.size(); ++a) {
    for (std::uint32_t b = a + 1; b < count.size(); ++b) {
      if (count[a] >= many && count[b] >= many) pairs.push_back({{a}, {b}});
    }
  }
  return pairs;
}

/// A body with a ball is placed together with others: its pose is the better unknown (K-II-4.3.2b).
bool places_a_body(const Flow& flow) {
  const auto is_ball = [&](std::uint32_t v) { return flow.loops.variables[v].kind == VariableKind::ball; };
  return std::any_of(flow.steps.begin(), flow.steps.end(), [&](const FlowStep& step) {
    return step.kind == StepKind::numerical && step.loops.size() > 1 &&
           std::any_of(step.unknowns.begin(), step.unknowns.end(), is_ball);
  });
}

/// The joints of all loops of steps that are not solved for one unknown at a time.
std::set<JointId> joints_to_favour(const Flow& flow) {
  std::set<JointId> joints;
  for (const FlowStep& step : flow.steps) {
    if (step.kind != StepKind::numerical && step.kind != StepKind::two_unknowns) continue;
    if (step.loops.size() < 2) continue;
    for (const std::uint32_t loop : step.loops) {
      joints.insert(flow.loops.loops[loop].joints.begin(), flow.loops.loops[loop].joints.end());
    }
  }
  return joints;
}

}  // namespace

Flow plan_flow(const Mechanism& mechanism, FlowChoice choice) {
  Flow best = plan_with(mechanism, {});
  if (choice == FlowChoice::first || best.loops.loops.size() > most_loops) return best;
  const auto attempt = [&](const LoopChoice& loops) {
    Flow other = plan_with(mechanism, loops);
    if (cost(other) < cost(best)) best = std::move(other);
  };
  for (const JointId joint : joints_to_favour(best)) attempt({joint, std::nullopt});
  if (places_a_body(best)) {
    for (const ImaginaryJoint& pair : hubs(mechanism)) attempt({std::nullopt, pair});
  }
  return best;
}

}  // namespace koppel

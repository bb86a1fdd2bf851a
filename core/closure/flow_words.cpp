#include "closure/flow_words.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string_view>

namespace koppel {
namespace {

/// The names of the joints whose motions make a cut joint, in the order of the loop.
std::vector<std::string> joints_in(const Mechanism& mechanism, const Flow& flow, std::uint32_t loop,
                                   const CutJoint& joint) {
  const std::vector<LoopMotion>& motions = flow.loops.loops[loop].motions;
  std::vector<JointId> joints;
  for (std::size_t i = 0; i < joint.count; ++i) {
    const JointId id = flow.loops.variables[motions[(joint.first + i) % motions.size()].variable].joint;
    if (joints.empty() || joints.back() != id) joints.push_back(id);
  }
  return joint_names(mechanism, flow, joints);
}

/// "RP": by what a run consists of.
std::string letters_of_motions(const Flow& flow, std::uint32_t loop, const CutJoint& joint) {
  const std::vector<LoopMotion>& motions = flow.loops.loops[loop].motions;
  std::string letters;
  for (std::size_t i = 0; i < joint.count; ++i) {
    const Variable& variable = flow.loops.variables[motions[(joint.first + i) % motions.size()].variable];
    letters += variable.kind == VariableKind::slide ? 'P' : 'R';
  }
  return letters;
}

std::string letters(const Flow& flow, std::uint32_t loop, const CutJoint& joint) {
  switch (joint.shape) {
    case CutShape::turn: return "R";
    case CutShape::slide: return "P";
    case CutShape::cylinder: return "C";
    case CutShape::cross: return "T";
    case CutShape::ball: return "S";
    case CutShape::plane: return "E";
    case CutShape::turning_plane:
    case CutShape::sliding_plane: return letters_of_motions(flow, loop, joint);
  }
  return "";
}

/// In how many places a condition can vanish as a function of a coordinate, complex ones counted: its degree.
std::size_t degree(ClosureType type, VariableKind kind) {
  if (kind == VariableKind::turn) return type == ClosureType::point_line ? 4 : 2;
  return type == ClosureType::point_point || type == ClosureType::point_line ? 2 : 1;
}

ClosureType type_of(const Flow& flow, const FlowRow& row) { return flow.cuts[row.cut].conditions[row.condition].type; }

/// One condition, or several that must agree: the least degree bounds the solutions.
std::size_t most_of_one(const Flow& flow, const FlowStep& step) {
  const VariableKind kind = flow.loops.variables[step.unknowns.front()].kind;
  std::size_t most = 4;
  for (const FlowRow& row : step.rows) most = std::min(most, degree(type_of(flow, row), kind));
  return most;
}

/// Two polynomials of degrees (a1, b1) and (a2, b2) in two unknowns have at most a1 b2 + a2 b1 common roots
/// (Bernstein 1975).
std::size_t most_of_two(const Flow& flow, const FlowStep& step) {
  const auto degree_of = [&](std::size_t row, std::size_t unknown) {
    return degree(type_of(flow, step.rows[row]), flow.loops.variables[step.unknowns[unknown]].kind);
  };
  return degree_of(0, 0) * degree_of(1, 1) + degree_of(1, 0) * degree_of(0, 1);
}

std::string at_most(std::size_t count) {
  return count == 1 ? "1 solution" : "at most " + std::to_string(count) + " solutions";
}

}  // namespace

std::string listed(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::string joint_name(const Mechanism& mechanism, const Flow& flow, JointId joint) {
  if (joint.index() < mechanism.joints.size()) return mechanism.joints[joint.index()].name;
  const ImaginaryJoint& imaginary = flow.loops.imaginary[joint.index() - mechanism.joints.size()];
  return "[" + mechanism.bodies[imaginary.a.index()].name + " to " + mechanism.bodies[imaginary.b.index()].name + "]";
}

std::vector<std::string> joint_names(const Mechanism& mechanism, const Flow& flow, const std::vector<JointId>& joints) {
  std::vector<std::string> names(joints.size());
  std::transform(joints.begin(), joints.end(), names.begin(),
                 [&](JointId joint) { return joint_name(mechanism, flow, joint); });
  return names;
}

std::string variable_name(const Mechanism& mechanism, const Flow& flow, std::uint32_t variable) {
  const Variable& v = flow.loops.variables[variable];
  if (v.q >= mechanism.nq) {
    // Three slides along the axes, in this order, before the ball.
    constexpr std::array axes{".x", ".y", ".z"};
    std::size_t before = 0;
    while (before < variable && flow.loops.variables[variable - 1 - before].joint == v.joint) ++before;
    return joint_name(mechanism, flow, v.joint) + (v.kind == VariableKind::ball ? ".rotation" : axes.at(before));
  }
  const std::string& name = mechanism.coordinate_names[v.q].name;
  // The four numbers of a ball are named by a suffix, ".w" the first of them.
  return v.kind == VariableKind::ball ? name.substr(0, name.rfind('.')) : name;
}

std::vector<std::string> variable_names(const Mechanism& mechanism, const Flow& flow,
                                        const std::vector<std::uint32_t>& variables) {
  std::vector<std::string> names(variables.size());
  std::transform(variables.begin(), variables.end(), names.begin(),
                 [&](std::uint32_t v) { return variable_name(mechanism, flow, v); });
  return names;
}

std::string cut_letters(const Flow& flow, const LoopCut& cut) {
  const std::string a = letters(flow, cut.loop, cut.a);
  return cut.b ? a + "-" + letters(flow, cut.loop, *cut.b) : a;
}

std::vector<std::string> cut_names(const Mechanism& mechanism, const Flow& flow, const LoopCut& cut) {
  const auto name = [&](const CutJoint& joint) {
    std::string out;
    for (const std::string& part : joints_in(mechanism, flow, cut.loop, joint))
      out += (out.empty() ? "" : " + ") + part;
    return out;
  };
  std::vector<std::string> names{name(cut.a)};
  if (cut.b) names.push_back(name(*cut.b));
  return names;
}

std::string type_name(ClosureType type) {
  switch (type) {
    case ClosureType::point_point: return "distance of two points";
    case ClosureType::point_plane: return "distance of a point from a plane";
    case ClosureType::point_line: return "distance of a point from a line";
    case ClosureType::angle: return "angle of two directions";
    case ClosureType::line_line: return "distance of two lines";
  }
  return "";
}

std::string type_numbers(const Flow& flow, const FlowStep& step) {
  std::set<int> types;
  for (const FlowRow& row : step.rows) types.insert(static_cast<int>(type_of(flow, row)));
  std::string out = types.size() == 1 ? "type " : "types ";
  std::size_t i = 0;
  for (const int type : types) {
    if (i > 0) out += i + 1 == types.size() ? " and " : ", ";
    out += std::to_string(type);
    ++i;
  }
  return out;
}

std::string loop_words(const std::vector<std::uint32_t>& loops) {
  std::vector<std::string> numbers(loops.size());
  std::transform(loops.begin(), loops.end(), numbers.begin(), [](std::uint32_t i) { return std::to_string(i + 1); });
  return (loops.size() == 1 ? "loop " : "loops ") + listed(numbers);
}

std::size_t unknowns_in(const Flow& flow, const FlowStep& step) {
  return std::accumulate(step.unknowns.begin(), step.unknowns.end(), std::size_t{0},
                         [&](std::size_t sum, auto v) { return sum + freedoms_of(flow.loops.variables[v].kind); });
}

std::string solver_words(const Mechanism& mechanism, const Flow& flow, const FlowStep& step) {
  switch (step.kind) {
    case StepKind::one_unknown:
      return "closed form, " + at_most(most_of_one(flow, step)) + " (" + type_numbers(flow, step) + ")";
    case StepKind::two_unknowns:
      return "closed form by elimination, " + at_most(most_of_two(flow, step)) + " (" + type_numbers(flow, step) + ")";
    case StepKind::joint: {
      const std::vector<std::string> joints = cut_names(mechanism, flow, flow.cuts[step.cut]);
      return "read off joint " + listed(joints);
    }
    case StepKind::spin: {
      const std::vector<std::string> balls = cut_names(mechanism, flow, flow.cuts[step.cut]);
      return "spin kept: nothing determines how the link between " + balls.front() + " and " + balls.back() +
             " is turned about their line";
    }
    case StepKind::numerical:
      return "numerical: " + std::to_string(unknowns_in(flow, step)) + " unknowns of " + loop_words(step.loops) +
             " together";
  }
  return "";
}

}  // namespace koppel

// What a FlowPlan knows of its loops: where each can be cut, and what enters the conditions that are left.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "closure/flow_plan.hpp"
#include "closure/loop_kind.hpp"

namespace koppel {
namespace {

const double tolerance = std::sqrt(std::numeric_limits<double>::epsilon());
constexpr double rounding = 1e-12;  // of derivatives: some thousand units
constexpr int trials = 3;           // random positions: a derivative that vanishes at all of them vanishes everywhere
constexpr std::size_t longest_run = 3;

std::vector<Place<double>> random_places(std::span<const Variable> variables, double length, std::mt19937_64& random) {
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  std::vector<Place<double>> at;
  for (const Variable& variable : variables) {
    Place<double> p{};
    if (variable.kind == VariableKind::turn) {
      const double angle = std::numbers::pi * between(random);
      p = {std::cos(angle), std::sin(angle), 0.0, 0.0};
    } else if (variable.kind == VariableKind::slide) {
      p[0] = length * between(random);
    } else {
      std::generate(p.begin(), p.end(), [&] { return between(random); });
      const double norm = std::hypot(std::hypot(p[0], p[1]), std::hypot(p[2], p[3]));
      for (double& x : p) x /= norm;
    }
    at.push_back(p);
  }
  return at;
}

/// Whether a loop that is cut at one joint meets the conditions with opposite axes, too.
bool turned_over(const LoopCut& cut) {
  return !cut.b && std::any_of(cut.conditions.begin(), cut.conditions.end(),
                               [](const ClosureCondition& condition) { return condition.type == ClosureType::angle; });
}

bool overlap(const CutJoint& a, const CutJoint& b, std::size_t n) {
  for (std::size_t i = 0; i < a.count; ++i) {
    if ((a.first + i + n - b.first) % n < b.count) return true;
  }
  return false;
}

}  // namespace

/// All runs of unknown motions that make a joint.
std::vector<CutJoint> FlowPlan::cut_joints(std::uint32_t index) const {
  const Loop& loop = flow_.loops.loops[index];
  const std::size_t n = loop.motions.size();
  std::vector<CutJoint> result;
  for (std::size_t first = 0; first < n; ++first) {
    for (std::size_t count = 1; count <= std::min(longest_run, n); ++count) {
      if (known_[loop.motions[(first + count - 1) % n].variable]) break;
      if (auto joint = cut_joint(loop, flow_.loops.variables, first, count, flow_.length, &flow_.doubtful))
        result.push_back(*joint);
    }
  }
  return result;
}

/// The loop, closed for these places by another link before a motion that is known; as it is if there is none.
Loop FlowPlan::closed(std::uint32_t index, std::span<const Place<double>> at) const {
  Loop loop = flow_.loops.loops[index];
  const auto known = std::find_if(loop.motions.begin(), loop.motions.end(),
                                  [this](const LoopMotion& motion) { return known_[motion.variable]; });
  if (known == loop.motions.end()) return loop;
  Pose before, after;
  for (auto motion = loop.motions.begin(); motion != loop.motions.end(); ++motion) {
    Pose& frame = motion < known ? before : after;
    if (motion != known) frame = frame * motion->to;
    const VariableKind kind = flow_.loops.variables[motion->variable].kind;
    apply(kind, at[motion->variable], kind == VariableKind::ball && motion->inverse, frame);
  }
  known->to = before.inverse() * after.inverse();
  return loop;
}

/// For each condition the variables that change it, in any positions or in closed ones.
std::vector<std::vector<std::uint32_t>> FlowPlan::entering(const LoopCut& cut, Positions positions) {
  const std::span<const Variable> variables = flow_.loops.variables;
  std::vector<std::vector<std::uint32_t>> result(cut.conditions.size());
  std::vector<WalkColumn<double>> columns;
  for (int trial = 0; trial < trials; ++trial) {
    const auto at = random_places(variables, flow_.length, random_);
    const Loop loop = positions == Positions::closed ? closed(cut.loop, at) : flow_.loops.loops[cut.loop];
    const CutWalk<double> walk(loop, variables, at);
    for (const bool lower : {true, false}) {
      columns.clear();
      const Pose a_in_b = lower ? walk.lower(cut, &columns) : walk.upper(cut, &columns);
      for (const WalkColumn<double>& column : columns) {
        const Vector3 linear = column.along + column.angular.cross(a_in_b.position - column.point);
        const bool slide = variables[column.variable].kind == VariableKind::slide;
        for (std::size_t k = 0; k < cut.conditions.size(); ++k) {
          const double rate = change(cut.conditions[k], a_in_b, column.angular, linear) * (slide ? flow_.length : 1.0);
          const double relative = std::abs(rate) / size_of(cut.conditions[k], flow_.length);
          if (relative > tolerance) {
            insert_sorted(result[k], column.variable);
          } else if (relative > rounding) {
            flow_.doubtful = true;
          }
        }
      }
    }
  }
  return result;
}

/// The cut with those of its conditions that something unknown enters.
PlannedCut FlowPlan::planned(std::uint32_t loop, const CutJoint& a, const std::optional<CutJoint>& b) {
  PlannedCut result;
  const auto all = b ? pair_conditions(a.shape, b->shape) : joint_conditions(a.shape);
  result.cut = {loop, a, b, {all.begin(), all.end()}};
  result.mirror = b && up_to_mirror(a.shape, b->shape);
  result.isolated = b ? isolated_freedoms(a.shape, b->shape) : 0;
  const auto enters = entering(result.cut, Positions::any);
  const auto changed = entering(result.cut, Positions::closed);
  std::vector<ClosureCondition> kept;
  for (std::size_t k = 0; k < enters.size(); ++k) {
    if (unknown_of(enters[k]).empty()) continue;
    kept.push_back(result.cut.conditions[k]);
    result.enters.push_back(enters[k]);
    result.tells.push_back(!unknown_of(changed[k]).empty());
  }
  result.cut.conditions = std::move(kept);
  return result;
}

void FlowPlan::refresh(std::uint32_t loop) {
  if (!stale_[loop]) return;
  stale_[loop] = false;
  cuts_[loop].clear();
  const std::size_t n = flow_.loops.loops[loop].motions.size();
  const std::vector<CutJoint> joints = cut_joints(loop);
  const auto add = [&](const CutJoint& a, const std::optional<CutJoint>& b) {
    PlannedCut cut = planned(loop, a, b);
    if (std::find(cut.tells.begin(), cut.tells.end(), true) != cut.tells.end()) cuts_[loop].push_back(std::move(cut));
  };
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (i == j || overlap(joints[i], joints[j], n) || pair_conditions(joints[i].shape, joints[j].shape).empty()) {
        continue;
      }
      const bool either_way = joints[i].shape == joints[j].shape;
      if (!either_way || i < j) add(joints[i], joints[j]);
    }
    if (!joint_conditions(joints[i].shape).empty()) add(joints[i], std::nullopt);
  }
}

/// Whether the unknowns of a loop are a ball and a Cardan joint, and the cut is at the ball and one turn of the other.
bool FlowPlan::leaves_cross(std::uint32_t loop, const LoopCut& cut) const {
  if (cut.a.shape != CutShape::ball || !cut.b || cut.b->shape != CutShape::turn) return false;
  if (unknown_in(loop).size() != cut.a.count + 2) return false;
  const std::size_t n = flow_.loops.loops[loop].motions.size();
  const std::vector<CutJoint> joints = cut_joints(loop);
  return std::any_of(joints.begin(), joints.end(), [&](const CutJoint& joint) {
    return joint.shape == CutShape::cross && !overlap(joint, cut.a, n) && overlap(joint, *cut.b, n);
  });
}

/// Whether two conditions have independent derivatives by two variables at a random position.
bool FlowPlan::independent(std::span<const LoopCondition> conditions, const Variables& by) {
  const std::span<const Variable> variables = flow_.loops.variables;
  const auto at = random_places(variables, flow_.length, random_);
  Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
  std::vector<WalkColumn<double>> columns;
  for (Eigen::Index i = 0; i < 2; ++i) {
    const LoopCut& cut = *conditions[static_cast<std::size_t>(i)].cut;
    const ClosureCondition& condition = cut.conditions[conditions[static_cast<std::size_t>(i)].condition];
    const CutWalk<double> walk(flow_.loops.loops[cut.loop], variables, at);
    for (const bool lower : {true, false}) {
      columns.clear();
      const Pose a_in_b = lower ? walk.lower(cut, &columns) : walk.upper(cut, &columns);
      for (const WalkColumn<double>& column : columns) {
        const auto found = std::find(by.begin(), by.end(), column.variable);
        if (found == by.end()) continue;
        const Vector3 linear = column.along + column.angular.cross(a_in_b.position - column.point);
        const double slide = variables[column.variable].kind == VariableKind::slide ? flow_.length : 1.0;
        jacobian(i, found - by.begin()) += (lower ? 1.0 : -1.0) * slide / size_of(condition, flow_.length) *
                                           change(condition, a_in_b, column.angular, linear);
      }
    }
  }
  const double size = jacobian.norm();
  return std::abs(jacobian.determinant()) > tolerance * size * size;
}

/// What enters a numerical block on behalf of a loop: the conditions of a cut that hides what no other loop needs, or
/// all that close the loop.
FlowPlan::Share FlowPlan::share_of(std::uint32_t loop) {
  const Variables unknown = unknown_in(loop);
  const int count = conditions_of(loop);
  Share best{loop, std::nullopt, unknown, static_cast<std::size_t>(count)};
  int least = freedoms(unknown) - count;
  const Loop& motions = flow_.loops.loops[loop];
  for (std::size_t i = 0; i < cuts_[loop].size(); ++i) {
    const PlannedCut& cut = cuts_[loop][i];
    if (cut.mirror || (count == 6 && turned_over(cut.cut))) continue;
    bool exclusive = true;
    for (std::size_t k = 0; k < motions.motions.size(); ++k) {
      exclusive = exclusive && !(cut.cut.hides(k, motions.motions.size()) && shared(motions.motions[k].variable, loop));
    }
    if (!exclusive) continue;
    Variables core;
    for (std::size_t k = 0; k < cut.enters.size(); ++k) {
      for (const std::uint32_t v : unknown_of(cut.enters[k])) insert_sorted(core, v);
    }
    const auto telling = static_cast<std::size_t>(std::count(cut.tells.begin(), cut.tells.end(), true));
    const auto rows = std::min(telling, static_cast<std::size_t>(freedoms(core)));
    const int left = freedoms(core) - static_cast<int>(rows);
    const bool smaller = best.cut ? freedoms(core) < freedoms(best.core) : true;
    if (left > least || (left == least && !smaller)) continue;
    least = left;
    best = {loop, i, core, rows};
  }
  return best;
}

int FlowPlan::conditions_of(std::uint32_t index) {
  const Loop& loop = flow_.loops.loops[index];
  const auto at = random_places(flow_.loops.variables, flow_.length, random_);
  std::vector<WalkColumn<double>> walked;
  CutWalk<double>(loop, flow_.loops.variables, at).round(&walked);
  std::vector<Column> columns;
  for (const WalkColumn<double>& column : walked) columns.push_back({column.angular, column.along, column.point});
  return loop_kind(columns, flow_.length).conditions;
}

}  // namespace koppel

// What a FlowPlan knows of its loops: where each can be cut, and what enters the conditions that are left.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "closure/decompositions.hpp"
#include "closure/flow_plan.hpp"
#include "closure/loop_kind.hpp"

namespace koppel {
namespace {

const double tolerance = std::sqrt(std::numeric_limits<double>::epsilon());
constexpr double rounding = 1e-12;  // of derivatives: some thousand units
constexpr int trials = 3;           // random positions: a derivative that vanishes at all of them vanishes everywhere
constexpr std::size_t longest_run = 3;

Place<double> random_place(VariableKind kind, double length, std::mt19937_64& random) {
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  if (kind == VariableKind::turn) {
    const double angle = std::numbers::pi * between(random);
    return {std::cos(angle), std::sin(angle), 0.0, 0.0};
  }
  if (kind == VariableKind::slide) return {length * between(random), 0.0, 0.0, 0.0};
  Place<double> place{};
  std::generate(place.begin(), place.end(), [&] { return between(random); });
  const double norm = std::hypot(std::hypot(place[0], place[1]), std::hypot(place[2], place[3]));
  for (double& x : place) x /= norm;
  return place;
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

Eigen::Index rank_of(const Eigen::MatrixXd& matrix) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  qr.setThreshold(tolerance);
  return qr.rank();
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

/// Other random places for the variables of a loop; those of other loops stay.
std::span<const Place<double>> FlowPlan::shuffled(std::uint32_t loop) {
  for (const LoopMotion& motion : flow_.loops.loops[loop].motions) {
    places_[motion.variable] = random_place(flow_.loops.variables[motion.variable].kind, flow_.length, random_);
  }
  return places_;
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

/// Calls f(condition, column, rate) for each condition of a cut and each column of its ways: by how much the condition
/// changes with the column's rate, in radians' size and relative to the condition's.
template <typename Function>
void FlowPlan::for_each_rate(const LoopCut& cut, const Loop& loop, std::span<const Place<double>> at,
                             const Function& f) const {
  const std::span<const Variable> variables = flow_.loops.variables;
  std::vector<WayColumn<double>> columns;
  for (const bool lower : {true, false}) {
    columns.clear();
    const Way way = lower ? lower_way(loop, variables, cut) : upper_way(loop, variables, cut);
    const Pose a_in_b = walk<double>(way, at, &columns);
    for (const WayColumn<double>& column : columns) {
      const double unit = variables[column.variable].kind == VariableKind::slide ? flow_.length : 1.0;
      for (std::size_t k = 0; k < cut.conditions.size(); ++k) {
        const ClosureCondition& condition = cut.conditions[k];
        const double rate = change<double>(condition, a_in_b, column.angular, column.velocity(a_in_b.position));
        f(k, column, (lower ? unit : -unit) * rate / size_of(condition, flow_.length));
      }
    }
  }
}

/// For each condition the variables that change it, in any positions or in closed ones.
std::vector<std::vector<std::uint32_t>> FlowPlan::entering(const LoopCut& cut, Positions positions) {
  std::vector<std::vector<std::uint32_t>> result(cut.conditions.size());
  for (int trial = 0; trial < trials; ++trial) {
    const auto at = shuffled(cut.loop);
    const Loop loop = positions == Positions::closed ? closed(cut.loop, at) : flow_.loops.loops[cut.loop];
    for_each_rate(cut, loop, at, [&](std::size_t condition, const WayColumn<double>& column, double rate) {
      if (std::abs(rate) > tolerance) {
        insert_sorted(result[condition], column.variable);
      } else if (std::abs(rate) > rounding) {
        flow_.doubtful = true;
      }
    });
  }
  return result;
}

/// The cut with those of its conditions that something unknown enters.
PlannedCut FlowPlan::planned(std::uint32_t loop, const CutJoint& a, const std::optional<CutJoint>& b) {
  PlannedCut result;
  const auto all = b ? pair_conditions(a.shape, b->shape) : joint_conditions(a.shape);
  result.cut = {loop, a, b, {all.begin(), all.end()}};
  result.mirror = b && up_to_mirror(a.shape, b->shape);
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
  for (const LoopCondition& row : conditions) shuffled(row.cut->loop);
  Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
  for (Eigen::Index i = 0; i < 2; ++i) {
    const LoopCondition& row = conditions[static_cast<std::size_t>(i)];
    for_each_rate(*row.cut, flow_.loops.loops[row.cut->loop], places_,
                  [&](std::size_t condition, const WayColumn<double>& column, double rate) {
                    const auto found = std::find(by.begin(), by.end(), column.variable);
                    if (condition == row.condition && found != by.end()) jacobian(i, found - by.begin()) += rate;
                  });
  }
  const double size = jacobian.norm();
  return std::abs(jacobian.determinant()) > tolerance * size * size;
}

/// How many of a cut's conditions are independent in some variables, at a random position where the loop is closed.
std::size_t FlowPlan::rank_of(const LoopCut& cut, const Variables& by) {
  const auto at = shuffled(cut.loop);
  Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(cut.conditions.size()), 3 * static_cast<Eigen::Index>(by.size()));
  for_each_rate(cut, closed(cut.loop, at), at,
                [&](std::size_t condition, const WayColumn<double>& column, double rate) {
                  const auto found = std::find(by.begin(), by.end(), column.variable);
                  if (found == by.end()) return;
                  jacobian(static_cast<Eigen::Index>(condition), 3 * (found - by.begin()) + column.rate) += rate;
                });
  return static_cast<std::size_t>(koppel::rank_of(jacobian));
}

/// How many of the motions that a cut hides belong to other loops that are not done, too.
int FlowPlan::hidden_shared(std::uint32_t index, const LoopCut& cut) const {
  const std::vector<LoopMotion>& motions = flow_.loops.loops[index].motions;
  int count = 0;
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (cut.hides(k, motions.size()) && shared(motions[k].variable, index)) ++count;
  }
  return count;
}

/// What enters a numerical block on behalf of a loop: the conditions of a cut that hides what no other loop needs, or
/// all that close the loop.
FlowPlan::Share FlowPlan::share_of(std::uint32_t loop) {
  const Variables unknown = unknown_in(loop);
  const int count = conditions_of(loop);
  const int rank = rank_of_loop(loop);
  Share best{loop, std::nullopt, unknown, static_cast<std::size_t>(rank)};
  int least = freedoms(unknown) - rank;
  for (std::size_t i = 0; i < cuts_[loop].size(); ++i) {
    const PlannedCut& cut = cuts_[loop][i];
    if (cut.mirror || (count == 6 && turned_over(cut.cut)) || hidden_shared(loop, cut.cut) > 0) continue;
    Variables core;
    for (const auto& enters : cut.enters) {
      for (const std::uint32_t v : unknown_of(enters)) insert_sorted(core, v);
    }
    const std::size_t rows = rank_of(cut.cut, core);
    const int left = freedoms(core) - static_cast<int>(rows);
    const bool smaller = best.cut ? freedoms(core) < freedoms(best.core) : true;
    if (left > least || (left == least && !smaller)) continue;
    least = left;
    best = {loop, i, core, rows};
  }
  return best;
}

/// How many conditions close a loop, by the motions that its joints make.
int FlowPlan::conditions_of(std::uint32_t index) {
  const auto at = shuffled(index);
  std::vector<WayColumn<double>> walked;
  walk<double>(round_way(flow_.loops.loops[index], flow_.loops.variables), at, &walked);
  std::vector<Column> columns;
  columns.reserve(walked.size());
  for (const WayColumn<double>& column : walked) columns.push_back({column.angular, column.along, column.point});
  return loop_kind(columns, flow_.length).conditions;
}

/// How many of them its unknowns can meet, at a random position where it is closed: not the spin of a link.
int FlowPlan::rank_of_loop(std::uint32_t index) {
  const auto at = shuffled(index);
  std::vector<WayColumn<double>> columns;
  walk<double>(round_way(closed(index, at), flow_.loops.variables), at, &columns);
  std::erase_if(columns, [this](const WayColumn<double>& column) { return known_[column.variable]; });
  Eigen::MatrixXd screws(6, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool slide = flow_.loops.variables[columns[i].variable].kind == VariableKind::slide;
    screws.col(static_cast<Eigen::Index>(i)) << columns[i].angular * (slide ? 0.0 : 1.0),
        columns[i].velocity(Vector3::Zero()) / (slide ? 1.0 : flow_.length);
  }
  return static_cast<int>(koppel::rank_of(screws));
}

}  // namespace koppel

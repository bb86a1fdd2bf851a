#include "closure/flow_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "closure/block_order.hpp"
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

template <typename T>
void insert_sorted(std::vector<T>& into, const T& value) {
  const auto at = std::lower_bound(into.begin(), into.end(), value);
  if (at == into.end() || *at != value) into.insert(at, value);
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

FlowPlan::FlowPlan(Flow& flow)
    : flow_(flow),
      known_(flow.loops.variables.size(), false),
      loops_of_(flow.loops.variables.size()),
      done_(flow.loops.loops.size(), false),
      stale_(flow.loops.loops.size(), true),
      recovering_(flow.loops.loops.size(), false),
      used_cut_(flow.loops.loops.size()),
      cuts_(flow.loops.loops.size()) {
  for (std::uint32_t i = 0; i < flow.loops.loops.size(); ++i) {
    for (const LoopMotion& motion : flow.loops.loops[i].motions) loops_of_[motion.variable].push_back(i);
  }
  for (std::uint32_t i = 0; i < loops_of_.size(); ++i) {
    if (loops_of_[i].empty()) flow.outside.push_back(i);
  }
  learn(flow.inputs);
}

void FlowPlan::run() {
  const auto unfinished = [this] { return std::find(done_.begin(), done_.end(), false) != done_.end(); };
  while (unfinished()) {
    bool read = false;
    for (std::uint32_t loop = 0; loop < done_.size(); ++loop) {
      if (!done_[loop] && unknown_in(loop).empty()) done_[loop] = true;
      if (!done_[loop] && stale_[loop]) read = read_joint(loop) || read;
    }
    if (read || !unfinished()) continue;
    if (take_one() || take_two() || take_spin() || take_block()) continue;
    hold_one();
  }
  mark_only_here();
}

FlowPlan::Variables FlowPlan::unknown_of(const Variables& variables) const {
  Variables result;
  std::copy_if(variables.begin(), variables.end(), std::back_inserter(result),
               [this](std::uint32_t v) { return !known_[v]; });
  return result;
}

FlowPlan::Variables FlowPlan::unknown_in(std::uint32_t loop) const {
  Variables result;
  for (const LoopMotion& motion : flow_.loops.loops[loop].motions) {
    if (!known_[motion.variable]) insert_sorted(result, motion.variable);
  }
  return result;
}

int FlowPlan::freedoms(const Variables& variables) const {
  int sum = 0;
  for (const std::uint32_t v : variables) sum += flow_.loops.variables[v].kind == VariableKind::ball ? 3 : 1;
  return sum;
}

bool FlowPlan::shared(std::uint32_t variable, std::uint32_t loop) const {
  return std::any_of(loops_of_[variable].begin(), loops_of_[variable].end(),
                     [&](std::uint32_t other) { return other != loop && !done_[other]; });
}

void FlowPlan::learn(const Variables& variables) {
  for (const std::uint32_t v : variables) {
    known_[v] = true;
    for (const std::uint32_t loop : loops_of_[v]) stale_[loop] = true;
  }
}

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

std::uint32_t FlowPlan::number_of(const LoopCut& cut) {
  flow_.cuts.push_back(cut);
  return static_cast<std::uint32_t>(flow_.cuts.size() - 1);
}

void FlowPlan::add(FlowStep step) {
  std::sort(step.unknowns.begin(), step.unknowns.end());
  learn(step.unknowns);
  steps_of_recovery_.push_back(
      std::all_of(step.loops.begin(), step.loops.end(), [this](std::uint32_t loop) { return recovering_[loop]; }));
  // A loop whose unknowns are all hidden in the cut that was used is closed; what comes then, only tells where the cut
  // joints are.
  for (const FlowRow& row : step.rows) used_cut_[flow_.cuts[row.cut].loop] = row.cut;
  for (const std::uint32_t v : step.unknowns) {
    for (const std::uint32_t index : loops_of_[v]) {
      if (!used_cut_[index]) continue;
      const LoopCut& cut = flow_.cuts[*used_cut_[index]];
      const Loop& loop = flow_.loops.loops[index];
      bool all_hidden = true;
      for (std::size_t i = 0; i < loop.motions.size(); ++i) {
        all_hidden = all_hidden && (known_[loop.motions[i].variable] || cut.hides(i, loop.motions.size()));
      }
      recovering_[index] = recovering_[index] || all_hidden;
    }
  }
  flow_.steps.push_back(std::move(step));
}

/// A loop in which all is known but one joint.
bool FlowPlan::read_joint(std::uint32_t index) {
  const Loop& loop = flow_.loops.loops[index];
  const Variables unknown = unknown_in(index);
  for (const CutJoint& joint : cut_joints(index)) {
    if (joint.count != unknown.size()) continue;
    const bool readable = joint.count == 1 || joint.shape == CutShape::cylinder;
    if (!readable) continue;
    FlowStep step;
    step.kind = StepKind::joint;
    step.unknowns = unknown;
    for (const LoopMotion& motion : loop.motions) {
      if (known_[motion.variable]) insert_sorted(step.given, motion.variable);
    }
    step.cut = number_of({index, joint, std::nullopt, {}});
    step.loops = {index};
    recovering_[index] = recovering_[index] || loops_of_[unknown.front()].size() == 1;
    add(std::move(step));
    return true;
  }
  return false;
}

std::optional<FlowPlan::Candidate> FlowPlan::best_single(std::uint32_t loop) const {
  std::optional<Candidate> best;
  const Loop& motions = flow_.loops.loops[loop];
  for (std::size_t i = 0; i < cuts_[loop].size(); ++i) {
    const PlannedCut& cut = cuts_[loop][i];
    int hidden_shared = 0;
    for (std::size_t k = 0; k < motions.motions.size(); ++k) {
      const bool hidden = cut.cut.hides(k, motions.motions.size());
      hidden_shared += hidden && shared(motions.motions[k].variable, loop) ? 1 : 0;
    }
    for (std::size_t k = 0; k < cut.enters.size(); ++k) {
      const Variables unknown = unknown_of(cut.enters[k]);
      if (!cut.tells[k] || unknown.size() != 1 || flow_.loops.variables[unknown[0]].kind == VariableKind::ball)
        continue;
      const bool fourth = cut.cut.conditions[k].type == ClosureType::point_line;
      const int freedoms_hidden = cut.cut.a.freedoms + (cut.cut.b ? cut.cut.b->freedoms : 0);
      const Candidate candidate{{fourth, hidden_shared, -freedoms_hidden, cut.mirror, i}, unknown[0], i};
      if (!best || candidate.cost < best->cost) best = candidate;
    }
  }
  return best;
}

bool FlowPlan::take_one() {
  std::optional<Candidate> best;
  std::uint32_t from = 0;
  for (std::uint32_t loop = 0; loop < done_.size(); ++loop) {
    if (done_[loop]) continue;
    refresh(loop);
    const auto candidate = best_single(loop);
    if (!candidate || (best && !(candidate->cost < best->cost))) continue;
    best = candidate;
    from = loop;
    const auto& [fourth, hidden_shared, hidden, mirror, index] = best->cost;
    if (!fourth && hidden_shared == 0) break;
  }
  if (!best) return false;
  const PlannedCut& cut = cuts_[from][best->cut];
  FlowStep step;
  step.unknowns = {best->unknown};
  step.loops = {from};
  const std::uint32_t number = number_of(cut.cut);
  for (std::uint32_t k = 0; k < cut.enters.size(); ++k) {
    if (unknown_of(cut.enters[k]) != step.unknowns) continue;
    step.rows.push_back({number, k, cut.enters[k]});
    for (const std::uint32_t v : cut.enters[k]) {
      if (known_[v]) insert_sorted(step.given, v);
    }
  }
  step.twins = leaves_cross(from, cut.cut);
  add(std::move(step));
  return true;
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

/// Two conditions on the same two unknowns: of one cut, or of two loops. Their derivatives must be independent at a
/// random position.
bool FlowPlan::take_two() {
  struct Found {
    std::tuple<int, int, int> cost;
    std::uint32_t loop;
    std::size_t cut, condition;
  };
  std::map<Variables, std::vector<Found>> by_pair;
  for (std::uint32_t loop = 0; loop < done_.size(); ++loop) {
    if (done_[loop]) continue;
    for (std::size_t i = 0; i < cuts_[loop].size(); ++i) {
      const PlannedCut& cut = cuts_[loop][i];
      const Loop& motions = flow_.loops.loops[loop];
      int hidden_shared = 0;
      for (std::size_t k = 0; k < motions.motions.size(); ++k) {
        const bool hidden = cut.cut.hides(k, motions.motions.size());
        hidden_shared += hidden && shared(motions.motions[k].variable, loop) ? 1 : 0;
      }
      for (std::size_t k = 0; k < cut.enters.size(); ++k) {
        const Variables unknown = unknown_of(cut.enters[k]);
        const auto ball = [this](std::uint32_t v) { return flow_.loops.variables[v].kind == VariableKind::ball; };
        if (!cut.tells[k] || unknown.size() != 2 || std::any_of(unknown.begin(), unknown.end(), ball)) continue;
        const int fourth = cut.cut.conditions[k].type == ClosureType::point_line ? 1 : 0;
        by_pair[unknown].push_back({{fourth, cut.mirror ? 1 : 0, hidden_shared}, loop, i, k});
      }
    }
  }
  std::optional<std::pair<Found, Found>> best;
  const auto cost = [](const std::pair<Found, Found>& p) {
    return std::tuple(std::get<0>(p.first.cost) + std::get<0>(p.second.cost),
                      std::get<1>(p.first.cost) + std::get<1>(p.second.cost),
                      std::get<2>(p.first.cost) + std::get<2>(p.second.cost), p.first.loop, p.first.cut, p.second.loop,
                      p.second.cut, p.first.condition, p.second.condition);
  };
  const Variables* unknowns = nullptr;
  for (const auto& [pair, rows] : by_pair) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = i + 1; j < rows.size(); ++j) {
        if (rows[i].loop == rows[j].loop && rows[i].cut != rows[j].cut) continue;
        const std::pair candidate{rows[i], rows[j]};
        if (best && !(cost(candidate) < cost(*best))) continue;
        const std::array both{LoopCondition{&cuts_[rows[i].loop][rows[i].cut].cut, rows[i].condition},
                              LoopCondition{&cuts_[rows[j].loop][rows[j].cut].cut, rows[j].condition}};
        if (!independent(both, pair)) continue;
        best = candidate;
        unknowns = &pair;
      }
    }
  }
  if (!best) return false;
  FlowStep step;
  step.kind = StepKind::two_unknowns;
  step.unknowns = *unknowns;
  const PlannedCut& first = cuts_[best->first.loop][best->first.cut];
  const PlannedCut& second = cuts_[best->second.loop][best->second.cut];
  const bool same = best->first.loop == best->second.loop;
  const std::uint32_t number = number_of(first.cut), other = same ? number : number_of(second.cut);
  const auto take = [&](const PlannedCut& cut, std::uint32_t in, std::size_t condition) {
    step.rows.push_back({in, static_cast<std::uint32_t>(condition), cut.enters[condition]});
    for (const std::uint32_t v : cut.enters[condition]) {
      if (known_[v]) insert_sorted(step.given, v);
    }
  };
  take(first, number, best->first.condition);
  take(second, other, best->second.condition);
  step.loops = {best->first.loop};
  if (!same) insert_sorted(step.loops, best->second.loop);
  add(std::move(step));
  return true;
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

/// A loop in which all is known but two balls: the link between them may spin.
bool FlowPlan::take_spin() {
  for (std::uint32_t index = 0; index < done_.size(); ++index) {
    if (done_[index]) continue;
    const std::vector<CutJoint> joints = cut_joints(index);
    const Variables unknown = unknown_in(index);
    if (unknown.size() != 2 || joints.size() != 2 || freedoms(unknown) != 6) continue;
    // Another loop that passes one of the balls may tell how the link is turned.
    if (shared(unknown[0], index) || shared(unknown[1], index)) continue;
    const Loop& loop = flow_.loops.loops[index];
    FlowStep step;
    step.kind = StepKind::spin;
    step.unknowns = {loop.motions[joints[1].first].variable};
    step.cut = number_of({index, joints[0], joints[1], {}});
    step.loops = {index};
    for (const LoopMotion& motion : loop.motions) {
      if (known_[motion.variable]) insert_sorted(step.given, motion.variable);
    }
    add(std::move(step));
    return true;
  }
  return false;
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

bool FlowPlan::take_block() {
  std::vector<Share> shares;
  std::vector<BlockEquation> equations;
  std::map<std::uint32_t, std::vector<std::uint32_t>> slots;  // of each unknown
  std::uint32_t slot_count = 0;
  for (std::uint32_t loop = 0; loop < done_.size(); ++loop) {
    if (done_[loop]) continue;
    shares.push_back(share_of(loop));
    for (const std::uint32_t v : shares.back().core) {
      if (slots.contains(v)) continue;
      for (int k = 0; k < freedoms({v}); ++k) slots[v].push_back(slot_count++);
    }
  }
  for (std::uint32_t i = 0; i < shares.size(); ++i) {
    BlockEquation equation{i, {}};
    for (const std::uint32_t v : shares[i].core) {
      equation.unknowns.insert(equation.unknowns.end(), slots[v].begin(), slots[v].end());
    }
    equations.insert(equations.end(), shares[i].rows, equation);
  }
  const std::vector<std::uint32_t> block = least_block(equations, slot_count);
  if (block.empty()) return false;
  FlowStep step;
  step.kind = StepKind::numerical;
  for (const std::uint32_t member : block) {
    const Share& share = shares[member];
    insert_sorted(step.loops, share.loop);
    for (const std::uint32_t v : share.core) insert_sorted(step.unknowns, v);
    if (share.cut) {
      const PlannedCut& cut = cuts_[share.loop][*share.cut];
      const std::uint32_t number = number_of(cut.cut);
      for (std::uint32_t k = 0; k < cut.enters.size(); ++k) {
        if (!cut.tells[k]) continue;
        step.rows.push_back({number, k, cut.enters[k]});
        for (const std::uint32_t v : cut.enters[k]) {
          if (known_[v]) insert_sorted(step.given, v);
        }
      }
    } else {
      step.whole_loops.push_back(share.loop);
      for (const LoopMotion& motion : flow_.loops.loops[share.loop].motions) {
        if (known_[motion.variable]) insert_sorted(step.given, motion.variable);
      }
    }
  }
  add(std::move(step));
  return true;
}

/// Nothing is determined: a freedom that no input drives is taken as it is. One that many loops need comes first.
void FlowPlan::hold_one() {
  std::optional<std::tuple<bool, int, std::uint32_t>> best;
  for (std::uint32_t v = 0; v < known_.size(); ++v) {
    if (known_[v] || loops_of_[v].empty()) continue;
    const bool ball = flow_.loops.variables[v].kind == VariableKind::ball;
    const std::tuple candidate{ball, -static_cast<int>(loops_of_[v].size()), v};
    if (!best || candidate < *best) best = candidate;
  }
  if (!best) return;
  flow_.held.push_back(std::get<2>(*best));
  learn({std::get<2>(*best)});
}

void FlowPlan::mark_only_here() {
  std::set<std::uint32_t> wanted;
  for (std::size_t i = flow_.steps.size(); i-- > 0;) {
    FlowStep& step = flow_.steps[i];
    step.only_here = steps_of_recovery_[i] && std::none_of(step.unknowns.begin(), step.unknowns.end(),
                                                           [&](std::uint32_t v) { return wanted.contains(v); });
    if (!step.only_here) wanted.insert(step.given.begin(), step.given.end());
  }
}

}  // namespace koppel

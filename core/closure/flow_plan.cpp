#include "closure/flow_plan.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "closure/block_order.hpp"

namespace koppel {

FlowPlan::FlowPlan(Flow& flow)
    : flow_(flow),
      places_(flow.loops.variables.size()),
      known_(flow.loops.variables.size(), false),
      loops_of_(flow.loops.variables.size()),
      done_(flow.loops.loops.size(), false),
      touched_(flow.loops.loops.size(), true),
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
      if (done_[loop] || !touched_[loop]) continue;
      touched_[loop] = false;
      if (unknown_in(loop).empty()) {
        done_[loop] = true;
      } else {
        read = read_joint(loop) || read;
      }
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
  for (const std::uint32_t v : variables) sum += static_cast<int>(freedoms_of(flow_.loops.variables[v].kind));
  return sum;
}

bool FlowPlan::shared(std::uint32_t variable, std::uint32_t loop) const {
  return std::any_of(loops_of_[variable].begin(), loops_of_[variable].end(),
                     [&](std::uint32_t other) { return other != loop && !done_[other]; });
}

void FlowPlan::learn(const Variables& variables) {
  for (const std::uint32_t v : variables) {
    known_[v] = true;
    for (const std::uint32_t loop : loops_of_[v]) touched_[loop] = stale_[loop] = true;
  }
}

std::uint32_t FlowPlan::number_of(const LoopCut& cut) {
  flow_.cuts.push_back(cut);
  return static_cast<std::uint32_t>(flow_.cuts.size() - 1);
}

/// What of these is known is given to the step.
void FlowPlan::give(FlowStep& step, const Variables& variables) const {
  for (const std::uint32_t v : variables) {
    if (known_[v]) insert_sorted(step.given, v);
  }
}

void FlowPlan::give_known(FlowStep& step, std::uint32_t loop) const {
  for (const LoopMotion& motion : flow_.loops.loops[loop].motions) give(step, {motion.variable});
}

void FlowPlan::take_row(FlowStep& step, const PlannedCut& cut, std::uint32_t number, std::size_t condition) const {
  step.rows.push_back({number, static_cast<std::uint32_t>(condition), cut.enters[condition]});
  give(step, cut.enters[condition]);
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
  const Variables unknown = unknown_in(index);
  for (const CutJoint& joint : cut_joints(index)) {
    if (joint.count != unknown.size()) continue;
    const bool readable = joint.count == 1 || joint.shape == CutShape::cylinder;
    if (!readable) continue;
    FlowStep step;
    step.kind = StepKind::joint;
    step.unknowns = unknown;
    give_known(step, index);
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
  for (std::size_t i = 0; i < cuts_[loop].size(); ++i) {
    const PlannedCut& cut = cuts_[loop][i];
    for (std::size_t k = 0; k < cut.enters.size(); ++k) {
      const Variables unknown = unknown_of(cut.enters[k]);
      if (!cut.tells[k] || unknown.size() != 1 || flow_.loops.variables[unknown[0]].kind == VariableKind::ball)
        continue;
      const bool fourth = cut.cut.conditions[k].type == ClosureType::point_line;
      const int freedoms_hidden = cut.cut.a.freedoms + (cut.cut.b ? cut.cut.b->freedoms : 0);
      const Candidate candidate{{fourth, hidden_shared(loop, cut.cut), -freedoms_hidden, cut.mirror, i}, unknown[0], i};
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
    const auto& [fourth, shared_too, hidden, mirror, index] = best->cost;
    if (!fourth && shared_too == 0) break;
  }
  if (!best) return false;
  const PlannedCut& cut = cuts_[from][best->cut];
  FlowStep step;
  step.unknowns = {best->unknown};
  step.loops = {from};
  const std::uint32_t number = number_of(cut.cut);
  for (std::uint32_t k = 0; k < cut.enters.size(); ++k) {
    if (unknown_of(cut.enters[k]) == step.unknowns) take_row(step, cut, number, k);
  }
  step.twins = leaves_cross(from, cut.cut);
  add(std::move(step));
  return true;
}

/// All conditions with two unknowns, by these.
std::map<FlowPlan::Variables, std::vector<FlowPlan::PairRow>> FlowPlan::rows_of_pairs() const {
  std::map<Variables, std::vector<PairRow>> rows;
  const auto ball = [this](std::uint32_t v) { return flow_.loops.variables[v].kind == VariableKind::ball; };
  for (std::uint32_t loop = 0; loop < done_.size(); ++loop) {
    for (std::size_t i = 0; i < cuts_[loop].size() && !done_[loop]; ++i) {
      const PlannedCut& cut = cuts_[loop][i];
      const int hidden = hidden_shared(loop, cut.cut);
      for (std::size_t k = 0; k < cut.enters.size(); ++k) {
        const Variables unknown = unknown_of(cut.enters[k]);
        if (!cut.tells[k] || unknown.size() != 2 || std::any_of(unknown.begin(), unknown.end(), ball)) continue;
        const int fourth = cut.cut.conditions[k].type == ClosureType::point_line ? 1 : 0;
        rows[unknown].push_back({{fourth, cut.mirror ? 1 : 0, hidden}, loop, i, k});
      }
    }
  }
  return rows;
}

/// Two conditions on the same two unknowns: of one cut, or of two loops. Their derivatives must be independent at a
/// random position.
bool FlowPlan::take_two() {
  using Pair = std::pair<PairRow, PairRow>;
  const auto cost = [](const Pair& p) {
    std::array<int, 3> sum = p.first.cost;
    for (std::size_t i = 0; i < 3; ++i) sum[i] += p.second.cost[i];
    return std::tuple(sum, p.first.loop, p.first.cut, p.second.loop, p.second.cut, p.first.condition,
                      p.second.condition);
  };
  std::optional<std::pair<Pair, Variables>> best;
  for (const auto& [unknowns, rows] : rows_of_pairs()) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = i + 1; j < rows.size(); ++j) {
        if (rows[i].loop == rows[j].loop && rows[i].cut != rows[j].cut) continue;
        const Pair candidate{rows[i], rows[j]};
        if (best && !(cost(candidate) < cost(best->first))) continue;
        const std::array both{LoopCondition{&cuts_[rows[i].loop][rows[i].cut].cut, rows[i].condition},
                              LoopCondition{&cuts_[rows[j].loop][rows[j].cut].cut, rows[j].condition}};
        if (independent(both, unknowns)) best = {candidate, unknowns};
      }
    }
  }
  if (!best) return false;
  const auto& [one, other] = best->first;
  FlowStep step;
  step.kind = StepKind::two_unknowns;
  step.unknowns = best->second;
  const PlannedCut& cut = cuts_[one.loop][one.cut];
  const std::uint32_t number = number_of(cut.cut);
  take_row(step, cut, number, one.condition);
  const PlannedCut& second = cuts_[other.loop][other.cut];
  take_row(step, second, one.loop == other.loop ? number : number_of(second.cut), other.condition);
  step.loops = {one.loop};
  insert_sorted(step.loops, other.loop);
  add(std::move(step));
  return true;
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
    give_known(step, index);
    add(std::move(step));
    return true;
  }
  return false;
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
        if (cut.tells[k]) take_row(step, cut, number, k);
      }
    } else {
      step.whole_loops.push_back(share.loop);
      give_known(step, share.loop);
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

#include "closure/loop_cut.hpp"

#include <cmath>

namespace koppel {

Place<double> place_at(VariableKind kind, double x) {
  if (kind == VariableKind::turn) return {std::cos(x), std::sin(x), 0.0, 0.0};
  return {x, 0.0, 0.0, 0.0};
}

Place<double> place(const Variable& variable, const double* q) {
  const double* at = q + variable.q;
  if (variable.kind == VariableKind::ball) return {at[0], at[1], at[2], at[3]};
  return place_at(variable.kind, *at);
}

std::vector<Place<double>> places(std::span<const Variable> variables, const double* q) {
  std::vector<Place<double>> result;
  result.reserve(variables.size());
  for (const Variable& variable : variables) result.push_back(place(variable, q));
  return result;
}

namespace {

Leg leg_of(const LoopMotion& motion, std::span<const Variable> variables, bool backwards, const Pose& to) {
  const VariableKind kind = variables[motion.variable].kind;
  return {motion.variable, kind, (kind == VariableKind::ball && motion.inverse) != backwards, to};
}

}  // namespace

Way lower_way(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut) {
  const CutJoint& start = cut.b ? *cut.b : cut.a;
  const std::size_t n = loop.motions.size(), first = start.first + start.count;
  const std::size_t count = (cut.a.first + 2 * n - first) % n;
  Way way;
  Pose constant = start.after.inverse();
  for (std::size_t i = 0; i < count; ++i) {
    const LoopMotion& motion = loop.motions[(first + i) % n];
    way.legs.push_back(leg_of(motion, variables, false, constant * motion.to));
    constant = Pose{};
  }
  way.last = constant * cut.a.before;
  return way;
}

Way upper_way(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut) {
  Way way;
  if (!cut.b) return way;
  const std::size_t n = loop.motions.size(), first = cut.a.first + cut.a.count;
  const std::size_t count = (cut.b->first + 2 * n - first) % n;
  Pose constant = cut.b->before.inverse();
  for (std::size_t i = count; i-- > 0;) {
    const LoopMotion& motion = loop.motions[(first + i) % n];
    way.legs.push_back(leg_of(motion, variables, true, constant));
    constant = motion.to.inverse();
  }
  way.last = constant * cut.a.after;
  return way;
}

Way round_way(const Loop& loop, std::span<const Variable> variables) {
  Way way;
  for (const LoopMotion& motion : loop.motions) way.legs.push_back(leg_of(motion, variables, false, motion.to));
  return way;
}

double openness(const ClosureCondition& condition, const Way& lower, const Way& upper,
                std::span<const Place<double>> at, double length) {
  return (value(condition, walk<double>(lower, at)) - value(condition, walk<double>(upper, at))) /
         size_of(condition, length);
}

}  // namespace koppel

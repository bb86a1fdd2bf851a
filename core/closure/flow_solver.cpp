#include "closure/flow_solver.hpp"

#include <algorithm>
#include <cmath>

#include "closure/block_problem.hpp"
#include "closure/common_roots.hpp"
#include "closure/scalar_roots.hpp"
#include "spatial/rotation_coordinates.hpp"

namespace koppel {
namespace {

// A condition that one root misses by more is not met by it. Much more than rounding: what is in a file was rounded
// there, and near a limit position an error grows to its square root.
constexpr double allowed = 1e-6;

bool second_order(const ClosureCondition& condition, VariableKind kind) {
  return condition.type == ClosureType::point_line ||
         (kind == VariableKind::slide && condition.type == ClosureType::point_point);
}

}  // namespace

double FlowSolver::residual(const FlowRow& row, const std::vector<Place<double>>& at) const {
  const LoopCut& cut = flow_.cuts[row.cut];
  const Loop& loop = flow_.loops.loops[cut.loop];
  const std::span<const Variable> variables = flow_.loops.variables;
  return openness(cut.conditions[row.condition], lower_way(loop, variables, cut), upper_way(loop, variables, cut), at,
                  flow_.length);
}

StepSolutions FlowSolver::solve(const FlowStep& step, const Eigen::VectorXd& q) {
  switch (step.kind) {
    case StepKind::one_unknown: return one_unknown(step, q);
    case StepKind::two_unknowns: return two_unknowns(step, q);
    case StepKind::joint: return joint(step, q);
    case StepKind::spin: return spin(step, q);
    case StepKind::numerical: return numerical(step, q);
  }
  return {};
}

StepSolutions FlowSolver::one_unknown(const FlowStep& step, const Eigen::VectorXd& q) {
  const Variable& variable = flow_.loops.variables[step.unknowns[0]];
  std::vector<Place<double>> at = places(flow_.loops.variables, q.data());
  const auto sample = [&](const FlowRow& row, const auto& points, double unit) {
    std::remove_cvref_t<decltype(points)> values{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double x = unit * points[i];
      at[step.unknowns[0]] = place_at(variable.kind, x);
      values[i] = residual(row, at);
    }
    return values;
  };
  Roots found;
  if (variable.kind == VariableKind::slide) {
    std::vector<Quadratic> rows;
    for (const FlowRow& row : step.rows) {
      rows.push_back(Quadratic::from_samples(sample(row, Quadratic::samples, flow_.length), flow_.length));
    }
    found = displacement_of_rows(rows, 1.0, allowed).roots;
  } else {
    std::vector<FirstHarmonic> rows;
    std::optional<SecondHarmonic> fourth;
    for (const FlowRow& row : step.rows) {
      if (second_order(flow_.cuts[row.cut].conditions[row.condition], variable.kind)) {
        fourth = SecondHarmonic::from_samples(sample(row, SecondHarmonic::samples, 1.0));
      } else {
        rows.push_back(FirstHarmonic::from_samples(sample(row, FirstHarmonic::samples, 1.0)));
      }
    }
    found = rows.empty() ? roots(*fourth, 1.0) : angle_of_rows(rows, 1.0, allowed).roots;
  }
  StepSolutions result;
  if (found.everywhere) {
    result.undetermined = true;
    result.positions.push_back(q);
  }
  for (int i = 0; i < found.count && !found.everywhere; ++i) {
    const double value = found.values[static_cast<std::size_t>(i)];
    result.positions.push_back(q);
    result.positions.back()[variable.q] =
        variable.kind == VariableKind::turn ? unwrapped<double>(value, q[variable.q]) : value;
  }
  if (result.positions.empty()) {
    result.missed_by = found.missed_by;
    result.nearest = found.nearest;
  }
  return result;
}

StepSolutions FlowSolver::two_unknowns(const FlowStep& step, const Eigen::VectorXd& q) {
  std::vector<Place<double>> at = places(flow_.loops.variables, q.data());
  std::array<Unknown, 2> unknowns;
  for (std::size_t i = 0; i < 2; ++i) {
    const VariableKind kind = flow_.loops.variables[step.unknowns[i]].kind;
    unknowns[i].kind = kind == VariableKind::turn ? Unknown::Kind::angle : Unknown::Kind::displacement;
    unknowns[i].length = flow_.length;
    for (const FlowRow& row : step.rows) {
      if (second_order(flow_.cuts[row.cut].conditions[row.condition], kind)) unknowns[i].order = 2;
    }
  }
  const auto set = [&](std::size_t i, double x) {
    at[step.unknowns[i]] = place_at(flow_.loops.variables[step.unknowns[i]].kind, x);
  };
  std::array<Condition2, 2> conditions;
  for (std::size_t k = 0; k < 2; ++k) {
    Eigen::Matrix<double, 5, 5> values = Eigen::Matrix<double, 5, 5>::Zero();
    for (int i = 0; i < unknowns[0].terms(); ++i) {
      for (int j = 0; j < unknowns[1].terms(); ++j) {
        set(0, unknowns[0].sample(i));
        set(1, unknowns[1].sample(j));
        values(i, j) = residual(step.rows[k], at);
      }
    }
    conditions[k] = Condition2::from_samples(unknowns[0], unknowns[1], values);
  }
  const CommonRoots found = common_roots(unknowns[0], unknowns[1], conditions[0], conditions[1], 1.0);
  StepSolutions result;
  for (const CommonRoot& root : found.roots) {
    result.positions.push_back(q);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint32_t place = flow_.loops.variables[step.unknowns[i]].q;
      const double x = i == 0 ? root.x : root.y;
      result.positions.back()[place] = unknowns[i].kind == Unknown::Kind::angle ? unwrapped<double>(x, q[place]) : x;
    }
  }
  if (found.degenerate) {
    result.complete = false;
    result.why = "a block of two unknowns has a whole curve of solutions";
  }
  return result;
}

StepSolutions FlowSolver::joint(const FlowStep& step, const Eigen::VectorXd& q) {
  const LoopCut& cut = flow_.cuts[step.cut];
  const Loop& loop = flow_.loops.loops[cut.loop];
  const auto at = places(flow_.loops.variables, q.data());
  const Pose moved = walk<double>(lower_way(loop, flow_.loops.variables, cut), at).inverse();
  StepSolutions result;
  result.positions.push_back(q);
  Eigen::VectorXd& found = result.positions.back();
  double along = 1.0;  // of a slide's axis on the turn's
  if (cut.a.count == 2) along = loop.motions[(cut.a.first + 1) % loop.motions.size()].to.rotation(2, 2);
  for (std::size_t i = 0; i < cut.a.count; ++i) {
    const LoopMotion& motion = loop.motions[(cut.a.first + i) % loop.motions.size()];
    const Variable& variable = flow_.loops.variables[motion.variable];
    switch (variable.kind) {
      case VariableKind::turn: {
        const Matrix3& r = moved.rotation;
        found[variable.q] = unwrapped<double>(std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1)), q[variable.q]);
        break;
      }
      case VariableKind::slide: found[variable.q] = along < 0.0 ? -moved.position.z() : moved.position.z(); break;
      case VariableKind::ball: {
        const Matrix3 r = motion.inverse ? Matrix3(moved.rotation.transpose()) : moved.rotation;
        Vector4 quaternion = quaternion_of_rotation<double>(r);
        if (quaternion.dot(q.segment<4>(variable.q)) < 0.0) quaternion = -quaternion;
        found.segment<4>(variable.q) = quaternion;
        break;
      }
    }
  }
  return result;
}

StepSolutions FlowSolver::spin(const FlowStep& step, const Eigen::VectorXd& q) {
  const LoopCut& cut = flow_.cuts[step.cut];
  const Loop& loop = flow_.loops.loops[cut.loop];
  const auto at = places(flow_.loops.variables, q.data());
  const LoopMotion& motion = loop.motions[cut.b->first];
  const Variable& variable = flow_.loops.variables[motion.variable];
  const Vector4 before = q.segment<4>(variable.q);
  Matrix3 now = rotation_of_quaternion<double>(before);
  if (motion.inverse) now.transposeInPlace();
  // Ball b must bring the point of ball a, as it is seen from behind b, to where it is seen from before b.
  const std::span<const Variable> variables = flow_.loops.variables;
  const Vector3 from = now * walk<double>(lower_way(loop, variables, cut), at).position;
  const Vector3 to = walk<double>(upper_way(loop, variables, cut), at).position;
  now = Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix() * now;
  if (motion.inverse) now.transposeInPlace();
  Vector4 quaternion = quaternion_of_rotation<double>(now);
  if (quaternion.dot(before) < 0.0) quaternion = -quaternion;
  StepSolutions result;
  result.undetermined = true;
  result.positions.push_back(q);
  result.positions.back().segment<4>(variable.q) = quaternion;
  return result;
}

StepSolutions FlowSolver::numerical(const FlowStep& step, const Eigen::VectorXd& q) {
  using Family = BlockProblem::Family;
  StepSolutions result;
  for (const Family family : {Family::these_measures, Family::all_measures}) {
    BlockProblem problem(flow_, step, q, family);
    if (!problem.is_square()) {
      result.complete = false;
      result.why = "a numerical block does not have as many conditions as unknowns";
      return result;
    }
    ContinuationOptions options = options_;
    options.known_count = problem.known_count();
    const AllSolutions all = find_all(problem, ComplexVector::Zero(problem.parameters()), options);
    add(problem, all, q, result);
    if (result.complete || problem.known_count() == 0 || all.stopped) break;
  }
  return result;
}

/// Takes over the real solutions of a block and tells how they were found.
void FlowSolver::add(const BlockProblem& problem, const AllSolutions& all, const Eigen::VectorXd& q,
                     StepSolutions& result) {
  for (const ContinuationSolution& solution : all.solutions) {
    if (!solution.real) continue;
    Eigen::VectorXd found = q;
    problem.read(solution.point, found);
    const auto known = [&](const Eigen::VectorXd& other) { return problem.equal(found, other); };
    if (std::none_of(result.positions.begin(), result.positions.end(), known)) result.positions.push_back(found);
  }
  const auto count = [](Eigen::Index n, const std::string& what) { return std::to_string(n) + " " + what; };
  const bool known = problem.known_count() != 0 && all.generic == problem.known_count();
  result.complete = known && all.complete();
  result.why = "a block of " + count(problem.unknowns(), "unknowns has ") + count(all.generic, "complex solutions") +
               (known ? ", as many as are possible" : ", found by monodromy; that there are no others is not proven");
  if (all.lost > 0) result.why += "; " + count(all.lost, "paths were lost");
  if (all.singular > 0) result.why += "; " + count(all.singular, "paths end in singular positions");
}

}  // namespace koppel

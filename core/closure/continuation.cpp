#include "closure/continuation.hpp"

#include <algorithm>
#include <cmath>

#include "closure/continuation_end.hpp"
#include "closure/continuation_generic.hpp"

namespace koppel {
namespace {

constexpr std::size_t most_nodes = 4;  // to set off from
constexpr double tighter = 0.1;        // for paths that were lost, or that share a regular end

/// One path and its end in the list of solutions (-1: none).
struct Path {
  PathLimit limit;
  ComplexVector print;
  Eigen::Index solution = -1;
};

/// Paths' ends, gathered.
class Ends {
 public:
  Ends(ContinuationProblem& problem, const ComplexVector& target) : problem_(problem), target_(target) {}

  /// Lists every path's end anew.
  void gather(std::vector<Path>& paths) {
    solutions.clear();
    for (const PathEnd kind : {PathEnd::singular, PathEnd::regular}) {
      set_ = {};
      for (Path& path : paths) {
        if (path.limit.end == kind) place(path);
      }
      if (kind == PathEnd::singular) singular_.swap(solutions);
    }
    solutions.insert(solutions.end(), singular_.begin(), singular_.end());
    singular_.clear();
  }

  std::vector<ContinuationSolution> solutions;

  /// Whether a solution has the conjugate print.
  bool has_conjugate(const ContinuationSolution& solution) const {
    return set_.find(solution.print.conjugate(), tolerance(solution.accuracy / scale(solution.print))) >= 0;
  }

 private:
  /// Ends apart by no more than their errors are one. Singular ones are seldom better known than to sqrt(eps).
  static double tolerance(double accuracy, PathEnd end = PathEnd::regular) {
    return std::max(2.0 * accuracy, end == PathEnd::singular ? 1e-7 : 0.0);
  }
  static double scale(const ComplexVector& print) {
    return print.size() == 0 ? 1.0 : std::max(1.0, std::sqrt(print.cwiseAbs2().maxCoeff()));
  }

  void place(Path& path) {
    problem_.fingerprint(path.limit.point, path.print);
    path.solution = set_.find(path.print, tolerance(path.limit.accuracy, path.limit.end));
    if (path.solution >= 0) {
      ContinuationSolution& known = solutions[static_cast<std::size_t>(path.solution)];
      ++known.paths;
      known.winding = std::max(known.winding, path.limit.winding);
      return;
    }
    path.solution = set_.size();
    set_.add(path.limit.point, path.print);
    const PointState state = inspect(problem_, target_, path.limit.point);
    ContinuationSolution solution;
    solution.end = path.limit.end;
    solution.point = path.limit.point;
    solution.print = path.print;
    solution.residual = state.residual;
    solution.condition = state.condition;
    solution.accuracy = path.limit.accuracy * scale(path.print);
    solution.real = path.print.size() == 0 || path.print.imag().cwiseAbs().maxCoeff() <= solution.accuracy;
    solution.winding = path.limit.winding;
    solutions.push_back(std::move(solution));
  }

  ContinuationProblem& problem_;
  const ComplexVector& target_;
  SolutionSet set_;  ///< of the regular ones in the end
  std::vector<ContinuationSolution> singular_;
};

/// From one node. `persist`: what gets lost is followed again with shorter steps.
AllSolutions follow_node(ContinuationProblem& problem, const GenericNode& node, const ComplexVector& target,
                         const ContinuationOptions& options, bool persist) {
  AllSolutions result;
  const auto total = static_cast<Eigen::Index>(node.points.size());
  Tracker tracker(problem);
  Endgame endgame(tracker, node.parameters, target);
  StepBounds bounds = StepBounds{}.tightened(options.tightness);
  bounds.steps = options.max_steps;
  const StepBounds tight = bounds.tightened(tighter);

  std::vector<Path> paths;
  for (const ComplexVector& start : node.points) {
    Path path;
    path.limit = endgame.follow(start, bounds);
    if (path.limit.end == PathEnd::lost && persist) path.limit = endgame.follow(start, tight);
    paths.push_back(std::move(path));
    const auto done = static_cast<Eigen::Index>(paths.size());
    if (options.progress && !options.progress({ContinuationProgress::Phase::target, done, total, total})) {
      result.stopped = true;
      break;
    }
  }

  Ends ends(problem, target);
  ends.gather(paths);
  const auto shared = [&](const Path& path) {
    return path.limit.end == PathEnd::regular && ends.solutions[static_cast<std::size_t>(path.solution)].paths > 1;
  };
  // A regular solution has one path: another one has jumped, unless shorter steps say the same.
  if (std::any_of(paths.begin(), paths.end(), shared)) {
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (shared(paths[i])) paths[i].limit = endgame.follow(node.points[i], tight);
    }
    ends.gather(paths);
  }

  for (const Path& path : paths) {
    result.regular += path.limit.end == PathEnd::regular ? 1 : 0;
    result.singular += path.limit.end == PathEnd::singular ? 1 : 0;
    result.diverging += path.limit.end == PathEnd::diverging ? 1 : 0;
    result.lost += path.limit.end == PathEnd::lost ? 1 : 0;
  }
  for (const ContinuationSolution& solution : ends.solutions) {
    if (solution.end != PathEnd::regular) continue;
    result.doubled += solution.paths - 1;
    result.real += solution.real ? 1 : 0;
    result.unpaired += !solution.real && !ends.has_conjugate(solution) ? 1 : 0;
  }
  result.solutions = std::move(ends.solutions);
  result.cost = tracker.cost;
  return result;
}

}  // namespace

void ContinuationCost::add(const ContinuationCost& other) {
  paths += other.paths;
  steps += other.steps;
  evaluations += other.evaluations;
}

void ContinuationProblem::lift(const ComplexVector& x, const ComplexVector& rate, ComplexVector& derivative,
                               ComplexVector& scratch) const {
  // Truncation and rounding both come to about 1e-10 of the point.
  const double size = rate.size() == 0 ? 0.0 : std::sqrt(rate.cwiseAbs2().maxCoeff());
  if (!(size > 0.0)) {
    derivative.setZero();
    return;
  }
  const double step = 1e-5 / size;
  move(x, step * rate, derivative);
  move(x, -step * rate, scratch);
  derivative = (derivative - scratch) / (2.0 * step);
}

GenericSolutions find_generic(ContinuationProblem& problem, const ContinuationOptions& options) {
  return MonodromyGraph(problem, options).run();
}

AllSolutions follow_all(ContinuationProblem& problem, const GenericSolutions& generic, const ComplexVector& target,
                        const ContinuationOptions& options) {
  AllSolutions best;
  ContinuationCost cost;
  const std::size_t nodes = std::min(generic.nodes.size(), most_nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    AllSolutions result = follow_node(problem, generic.nodes[i], target, options, i + 1 == nodes);
    cost.add(result.cost);
    const auto faults = [](const AllSolutions& a) { return a.lost + a.doubled; };
    if (i == 0 || (!result.stopped && faults(result) < faults(best))) best = std::move(result);
    if (best.stopped || faults(best) == 0) break;
  }
  best.generic = generic.count();
  best.settled = generic.settled;
  best.stopped = best.stopped || generic.stopped;
  best.cost = cost;
  best.generic_cost = generic.cost;
  return best;
}

AllSolutions find_all(ContinuationProblem& problem, const ComplexVector& target, const ContinuationOptions& options) {
  return follow_all(problem, find_generic(problem, options), target, options);
}

}  // namespace koppel

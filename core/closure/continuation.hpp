// All solutions of a square system f(x; p) = 0 over the complex numbers: monodromy finds those for generic parameters,
// a parameter homotopy follows them to the parameters that are asked for.
// Duff, Hill, Jensen, Lee, Leykin, Sommars, Solving polynomial systems via homotopy continuation and monodromy, IMA J.
// Numer. Anal. 2018; Sommese, Wampler, The numerical solution of systems of polynomials, 2005.
#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>

namespace koppel {

using Complex = std::complex<double>;
using ComplexVector = Eigen::VectorXcd;
using ComplexMatrix = Eigen::MatrixXcd;

/// A family of systems f(x; p) = 0. Points, tangent coordinates, equations and prints are to be scaled by the caller to
/// the order of 1; all are analytic in x and p. Results are never aliases of arguments and come in the right size.
/// A function that has no value at a point answers with numbers that are not finite; a path then takes shorter steps.
class ContinuationProblem {
 public:
  virtual ~ContinuationProblem() = default;

  virtual Eigen::Index unknowns() const = 0;    ///< n: tangent coordinates, as many as equations
  virtual Eigen::Index point_size() const = 0;  ///< numbers that store a point, like cos and sin of a complex angle
  /// m: numbers, any of C^m. The more of what may vary they hold, dimensions of links too, the better loops mix
  /// solutions; with few (only the legs of a platform) the last solutions may take many loops to be found.
  virtual Eigen::Index parameters() const = 0;

  /// Residual (n) and, where not null, its Jacobian in tangent coordinates (n x n) and its derivative along dp (n).
  /// dp and along_dp are both null or both not.
  virtual void evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual,
                        ComplexMatrix* jacobian, const ComplexVector* dp, ComplexVector* along_dp) = 0;

  /// The point reached from x by delta, on the manifold (to first order what the Jacobian means by delta). x may lie a
  /// little beside the manifold, which move(x, 0) mends.
  virtual void move(const ComplexVector& x, const ComplexVector& delta, ComplexVector& result) const = 0;

  /// Derivative (point_size) of move(x, s rate) by s at 0. Only predictions rest on it. Unless overridden: by central
  /// differences, with the given scratch (point_size).
  virtual void lift(const ComplexVector& x, const ComplexVector& rate, ComplexVector& derivative,
                    ComplexVector& scratch) const;

  /// What tells solutions apart, of any fixed length, made by this function with resize(): points of equal prints count
  /// as one solution. Real where the solution is; for a real problem conjugate solutions have conjugate prints.
  virtual void fingerprint(const ComplexVector& x, ComplexVector& print) const = 0;

  /// A random point and parameters of which it is a regular solution, complex and generic: drawn anew, p must not stay
  /// in a real or algebraic subset. False: none could be made.
  virtual bool seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) = 0;
};

struct ContinuationProgress {
  enum class Phase { generic, target } phase = Phase::generic;
  Eigen::Index done = 0;       ///< paths of this phase (for the target: counted anew if another node is tried)
  Eigen::Index total = 0;      ///< paths; 0 in the generic phase, where it is not known before
  Eigen::Index solutions = 0;  ///< generic ones known of so far
};

struct ContinuationOptions {
  std::uint64_t random_seed = 1;       ///< equal seeds, equal answers
  Eigen::Index known_count = 0;        ///< generic solutions proven to exist: stop there. 0: unknown
  Eigen::Index max_solutions = 10000;  ///< give up (not settled) beyond it
  int nodes = 6;                       ///< generic parameters of the monodromy graph, at least 2
  int idle_edges = 15;   ///< settled after so many further edges, each a new loop for all solutions, without growth ...
  int idle_paths = 120;  ///< ... and so many paths on these, or 20 edges: more loops where solutions are few ...
  int idle_seeds = 20;   ///< ... and so many further seeds. These find what no loop joins, and blocks of solutions
  int max_edges = 60;    ///< not settled if the graph has grown to this
  double tightness = 1.0;         ///< of the tracker's bounds; below 1 shorter steps and less risk of jumps
  std::int32_t max_steps = 1500;  ///< on one path
  /// Called after each path. False stops: the answer then holds what was found, and says `stopped`.
  std::function<bool(const ContinuationProgress&)> progress;
};

struct ContinuationCost {
  std::int64_t paths = 0;        ///< followed, including those for checking
  std::int64_t steps = 0;        ///< tried, including rejected ones
  std::int64_t evaluations = 0;  ///< of residual and Jacobian together
  void add(const ContinuationCost& other);
};

struct GenericNode {
  ComplexVector parameters;
  std::vector<ComplexVector> points;
};

/// The solutions for generic parameters. One set serves any number of targets.
struct GenericSolutions {
  std::vector<GenericNode> nodes;  ///< those with most solutions; one is enough, others help where paths get lost
  bool seeded = false;             ///< false: the problem made too few seeds, nothing was done
  bool settled = false;            ///< no growth as the options demand and two nodes equally full, or known_count
  bool stopped = false;            ///< by `progress` or max_solutions
  Eigen::Index edges = 0;          ///< of the graph in the end
  Eigen::Index failed = 0;         ///< paths of the graph that were lost; other edges make up for them
  Eigen::Index jumps = 0;          ///< found out by two paths with one end, and mended
  ContinuationCost cost;

  Eigen::Index count() const { return nodes.empty() ? 0 : static_cast<Eigen::Index>(nodes.front().points.size()); }
};

enum class PathEnd {
  regular,    ///< Newton converges quadratically, condition below singular_condition
  singular,   ///< a finite limit where the Jacobian loses rank
  diverging,  ///< no finite limit
  lost        ///< steps became too short, or too many: the answer is not complete
};

/// From here on a root cannot be told from a double one: rounding in the equations, eps, moves a double root by
/// sqrt(eps), where the condition is 1 / sqrt(eps).
inline constexpr double singular_condition = 6.7e7;

struct ContinuationSolution {
  PathEnd end = PathEnd::regular;  ///< regular or singular
  ComplexVector point;
  ComplexVector print;
  double residual = 0.0;   ///< greatest entry
  double condition = 1.0;  ///< largest singular value (at least 1, the scale) of the Jacobian to the smallest
  double accuracy = 0.0;   ///< bound of the error of the print as estimated: condition times rounding, or the endgame's
  bool real = false;       ///< imaginary part of the print within the accuracy
  int paths = 1;           ///< that end here: at singular points a lower bound of the multiplicity
  int winding = 1;         ///< largest winding number of these paths
};

struct AllSolutions {
  std::vector<ContinuationSolution> solutions;  ///< regular ones first; each once
  Eigen::Index generic = 0;                     ///< paths that were to follow: solutions for generic parameters
  bool settled = false;                         ///< of the generic solutions
  bool stopped = false;
  Eigen::Index regular = 0, singular = 0, diverging = 0, lost = 0;  ///< paths; together `generic` unless stopped
  Eigen::Index doubled = 0;  ///< paths whose regular end another path has as well, even when followed tightly: doubtful
  Eigen::Index real = 0;     ///< regular solutions that are real
  /// Regular solutions that are not real and whose conjugate is missing: not 0 for a real problem with a real target
  /// says that solutions are missing.
  Eigen::Index unpaired = 0;
  ContinuationCost cost, generic_cost;

  /// Every isolated regular solution is here as far as numerics can tell (a proof only if known_count is one). For a
  /// real problem see `unpaired`, too.
  bool complete() const { return settled && !stopped && lost == 0 && doubled == 0; }
};

/// Monodromy on a growing graph of seeds' parameters. The edges between two nodes run on the complex line through both,
/// along different arcs of circles from one to the other.
GenericSolutions find_generic(ContinuationProblem& problem, const ContinuationOptions& options);

/// Follows generic solutions along the straight line to the target and classifies the ends. Where paths get lost, those
/// of the next node are followed instead, which miss the place.
AllSolutions follow_all(ContinuationProblem& problem, const GenericSolutions& generic, const ComplexVector& target,
                        const ContinuationOptions& options);

/// Both in turn.
AllSolutions find_all(ContinuationProblem& problem, const ComplexVector& target, const ContinuationOptions& options);

}  // namespace koppel

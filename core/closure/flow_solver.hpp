// Solving the steps of a flow: all values that the unknowns of a step can have, given what is known before.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "closure/continuation.hpp"
#include "closure/flow.hpp"

namespace koppel {

class BlockProblem;

/// What a step has found. Without solutions it says by how much they are missed, if that is known.
struct StepSolutions {
  std::vector<Eigen::VectorXd> positions;  ///< q of the state with the step's unknowns set
  bool undetermined = false;               ///< an unknown does not matter here and was left as it is
  std::optional<double> missed_by;         ///< of one unknown: see Roots::missed_by
  std::optional<double> nearest;           ///< and the value nearest to a solution
  bool complete = true;                    ///< there are no others
  std::string why;                         ///< of a numerical step: how they were found, and why all or not
};

/// Follows a flow at given inputs. Allocates; for steps that only ever have few solutions.
class FlowSolver {
 public:
  FlowSolver(const Flow& flow, ContinuationOptions options) : flow_(flow), options_(std::move(options)) {}

  /// All solutions of a step; q holds everything that the step is given, and start values where nothing is determined.
  StepSolutions solve(const FlowStep& step, const Eigen::VectorXd& q);

 private:
  double residual(const FlowRow& row, const std::vector<Place<double>>& at) const;
  StepSolutions one_unknown(const FlowStep& step, const Eigen::VectorXd& q);
  StepSolutions two_unknowns(const FlowStep& step, const Eigen::VectorXd& q);
  StepSolutions joint(const FlowStep& step, const Eigen::VectorXd& q);
  StepSolutions spin(const FlowStep& step, const Eigen::VectorXd& q);
  StepSolutions numerical(const FlowStep& step, const Eigen::VectorXd& q);
  static void add(const BlockProblem& problem, const AllSolutions& all, const Eigen::VectorXd& q,
                  StepSolutions& result);

  const Flow& flow_;
  ContinuationOptions options_;
};

}  // namespace koppel

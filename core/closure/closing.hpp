// The search for a closed position: following a mechanism from the last one, or assembling it from anywhere.
#pragma once

#include <cstdint>
#include <limits>

#include "closure/close.hpp"
#include "closure/newton.hpp"
#include "closure/report.hpp"
#include "closure/work.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// One closure. Where a function returns true, work.q is closed for the state's inputs and the equations stand there.
class Closing {
 public:
  Closing(Work& work, const State& state, const CloseOptions& options, Report& report);

  /// From the state's q, which was closed for other inputs: extrapolates, and leads the inputs in smaller steps if that
  /// is not enough; follows the curve where that is not sure of its branch; falls back on Ceres. The report's verdict
  /// tells of a limit.
  bool follow();
  /// From any q: Newton if it is near, Ceres from further away; lets the inputs go, closes, and leads them back; last
  /// by the solution flow. The report's verdict tells if the position is unreachable.
  bool assemble();

  /// By the solution flow alone.
  bool by_flow();

  bool plugin_failed() const { return plugin_failed_; }
  /// After a search without success: the least error that was left with the inputs where they should be, and the
  /// equation that had it.
  double nearest() const { return nearest_; }
  std::uint32_t nearest_row() const { return nearest_row_; }
  /// follow() only came through by a jump.
  bool branch_changed() const { return branch_changed_; }

 private:
  bool try_newton(InputsAre inputs = InputsAre::held);
  bool try_ceres(InputsAre inputs = InputsAre::held);
  void set_inputs(double fraction);
  bool inputs_at_target() const;
  void predict();
  bool moved_little();
  double greatest_unknown(const Eigen::VectorXd& delta) const;
  bool lead(const Eigen::VectorXd& from, double* weakest = nullptr);
  bool believed(double correction, double motion);
  bool same_orientation();
  bool weakest_here(double& weakest);
  bool assemble_numerically();
  double distance(const Eigen::VectorXd& from);

  Work& work_;
  const Mechanism& mechanism_;
  const State& state_;
  const CloseOptions& options_;
  Report& report_;
  NewtonOptions newton_;
  std::uint32_t ceres_iterations_ = 0;
  double nearest_ = std::numeric_limits<double>::infinity();
  std::uint32_t nearest_row_ = 0;
  bool plugin_failed_ = false;
  bool branch_changed_ = false;
};

}  // namespace koppel

// The equations of motion in all coordinates of the spanning tree, with multipliers for the loops (index 1): only
// accelerations close them, so that positions and rates drift and are brought back.
#pragma once

#include "dynamics/motion_equation.hpp"

namespace koppel {

enum class AfterSteps {
  project,  ///< positions, then rates, go back to where the loops are closed
  leave,    ///< the accelerations pull them back (EquationsOfMotion::stabilise)
};

class MultiplierEquation : public MotionEquation {
 public:
  MultiplierEquation(EquationsOfMotion& motion, AfterSteps after);

  bool place(double time, const Eigen::VectorXd& y) override;
  bool realise(double time, const Eigen::VectorXd& y) override;
  bool settle(double time, Eigen::VectorXd& y) override;

 protected:
  const std::vector<std::uint32_t>& integrated() const override { return motion_.mechanism().rate_of_column; }

 private:
  bool project(double time, Eigen::VectorXd& y);

  AfterSteps after_;
  Eigen::VectorXd v_, independent_, shown_, shown_rate_;
};

}  // namespace koppel

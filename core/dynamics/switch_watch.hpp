// Where forces have kinks and jumps, steps end: methods keep their order only on smooth pieces.
#pragma once

#include <Eigen/Core>

#include "dynamics/equations_of_motion.hpp"
#include "dynamics/integrator.hpp"
#include "dynamics/motion_equation.hpp"

namespace koppel {

/// Watches the switches of a motion's forces from step to step, and makes steps end just before one changes its sign. A
/// switch that changes twice within a step passes unnoticed. Borrows the motion and its equation.
class SwitchWatch {
 public:
  SwitchWatch(EquationsOfMotion& motion, MotionEquation& equation);

  /// Takes the signs where the motion stands. False: the motion tells why.
  bool start(const Eigen::VectorXd& y);
  /// After a step, the motion standing at its end. If a switch has changed its sign, the step is shortened so that it
  /// ends before that, to rounding. False: as start().
  bool look(Integrator& method);
  /// Before a step: takes the method to the other side of a switch that was met. False: as start().
  bool cross(Integrator& method, double limit);

  /// Where a method has gone back within its last step, before what was met there. False: as start().
  bool go_back(const Integrator& method);
  /// Tells all that it goes on from. False: what is read does not fit.
  bool exchange(Archive& archive);

  std::uint64_t events() const { return events_; }

 private:
  bool values_at(double t, Integrator& method, Eigen::VectorXd& values);
  bool read(const Eigen::VectorXd& y, Eigen::VectorXd& values);
  void take_sides(const Eigen::VectorXd& values);
  /// The switch that changes first by a straight line between the values at two times; -1: none changes.
  Eigen::Index first_change(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;
  bool locate(Integrator& method);
  bool refine(Integrator& method, double end, double slope);

  EquationsOfMotion& motion_;
  MotionEquation& equation_;
  Eigen::Index count_;
  Eigen::VectorXd sides_;  ///< the sign of each; 0: not known yet
  Eigen::VectorXd begin_, end_, from_, to_, middle_, y_, rate_;
  Eigen::Index met_ = -1;  ///< the switch that was met at the end of the last step
  double behind_ = 0.0;    ///< [s] where it has changed
  std::uint64_t events_ = 0;
  int in_a_row_ = 0;
};

}  // namespace koppel

// Where the coordinates that a scene watches cross the values that it names.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "dynamics/equations_of_motion.hpp"
#include "dynamics/integrator.hpp"
#include "dynamics/motion_equation.hpp"

namespace koppel {

struct Crossing {
  std::uint32_t watch = 0;  ///< among Mechanism::watches
  double time = 0.0;        ///< [s] the first at which it lies on the other side, to rounding
  bool rising = false;
};

/// Looks for sign changes on the polynomials of steps, which it leaves as they are. A value that is crossed twice
/// between two looks passes unnoticed. Borrows the motion and its equation.
class Crossings {
 public:
  Crossings(EquationsOfMotion& motion, MotionEquation& equation);

  /// Takes the sides on which the values lie where the motion stands.
  void take_sides();
  /// The first crossing after a time up to another one, both within the last step of the method. False: the motion
  /// tells why.
  bool find(Integrator& method, double from, double until, std::optional<Crossing>& found);

  /// Tells the sides. False: what is read does not fit.
  bool exchange(Archive& archive);

 private:
  double value(std::size_t watch) const;
  bool stand(Integrator& method, double t);
  void take_side(std::size_t watch);
  bool is_crossed(std::size_t watch) const;
  bool locate(Integrator& method, std::size_t watch, double from, double& time);

  EquationsOfMotion& motion_;
  MotionEquation& equation_;
  Eigen::VectorXd sides_;  ///< sign of each value that was seen last; 0: not known yet
  Eigen::VectorXd y_;
};

}  // namespace koppel

// A mechanism at rest: what acts on it along its independent coordinates, about one position after another.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamics/chart.hpp"
#include "dynamics/equations_of_motion.hpp"

namespace koppel {

/// Scratch of one thread. A function that returns false has an obstacle in motion().
///
/// Numbers are scaled: lengths over the mechanism's, so that every force along a coordinate is in joules.
class Statics {
 public:
  /// moving: drives go on with their rates, and only what they do not move rests.
  Statics(std::shared_ptr<const Mechanism> mechanism, Inertias inertias, double time, bool moving);

  /// Closes the loops from q on, and stands there: chooses the independent coordinates.
  bool stand(const Eigen::VectorXd& q, const Eigen::VectorXd& states);
  const Eigen::VectorXd& q() const { return chart_.base(); }
  const Eigen::VectorXd& states() const { return states_; }
  Eigen::Index freedoms() const { return scale_.size(); }
  /// Freedoms and internal states of forces.
  Eigen::Index size() const { return freedoms() + states_.size(); }

  /// Beside the place where it stands, by z: independent coordinates, then internal states. r: what acts along each
  /// coordinate [J], then the rates of the states.
  bool evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& r);
  /// Stands where evaluate() was last.
  bool move_on();

  /// How all rates (nv, in their own units) follow from the scaled independent ones where it stands.
  const Eigen::MatrixXd& follow() const { return follow_; }
  /// Length of the mechanism for independent lines, 1 for others.
  const Eigen::VectorXd& scale() const { return scale_; }
  /// Greatest scaled rate of what no drive sets, with the independent coordinates at rest [1/s].
  double unrest() const { return unrest_; }
  /// All rates then.
  const Eigen::VectorXd& v() const { return rest_; }
  /// Potential energy of gravity and of the forces that store it, where evaluate() was last [J].
  bool potential(double& energy);
  /// A name of each number of z.
  std::string name(Eigen::Index i) const;

  EquationsOfMotion& motion() { return motion_; }
  double time() const { return time_; }

 private:
  bool settle();

  std::shared_ptr<const Mechanism> mechanism_;
  EquationsOfMotion motion_;
  Chart chart_;
  double time_ = 0.0, unrest_ = 0.0;
  Eigen::VectorXd states_, moved_states_, scale_, rest_, delta_, efforts_, state_rates_, still_;
  Eigen::MatrixXd follow_;
};

/// "force pendulum.integral": of the i-th internal state.
std::string state_name(const Mechanism& mechanism, std::uint32_t i);

/// What a plugin did wrong, where a function of the equations of motion has failed with Obstacle::plugin.
Error plugin_error(const EquationsOfMotion& motion);

}  // namespace koppel

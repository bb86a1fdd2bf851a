// What the forces of a scene do to its nodes and rates: each is asked through the table of its plugin, and its wrench
// and efforts are carried to where the equations of motion need them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "koppel/plugin.h"
#include "mechanism/kinematics.hpp"
#include "mechanism/mechanism.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// Scratch of one thread; nothing is allocated after construction. Borrows the mechanism.
///
/// Every function takes the kinematics of q, and except for energy() of v as well (forward_motion(); accelerations do
/// not count), and the internal states of all forces (State::internal; null if there are none). They return
/// false if a plugin failed or returned something not finite; culprit() then says which, and results are incomplete.
class Forces {
 public:
  explicit Forces(const Mechanism& mechanism);

  /// Adds to `on_nodes` the wrench on each node, in world axes, the moment about the node's origin; to `efforts` (nv)
  /// the efforts on coordinates. Writes the rates of the internal states (null if there are none).
  bool evaluate(const Kinematics& kinematics, const double* q, const double* v, double time, const double* states,
                std::vector<Wrench>& on_nodes, Eigen::VectorXd& efforts, double* state_rates);

  /// The potential energy [J] of all forces that have one.
  bool energy(const Kinematics& kinematics, const double* q, double time, const double* states, double& potential);

  /// Power [W]: lost in forces with an energy, and delivered to the mechanism by forces without.
  bool power(const Kinematics& kinematics, const double* q, const double* v, double time, const double* states,
             double& dissipated, double& external);

  /// Numbers whose change of sign marks a kink or jump of some force.
  std::size_t switch_count() const { return switch_count_; }
  bool switches(const Kinematics& kinematics, const double* q, const double* v, double time, const double* states,
                double* values);

  /// "force NAME of type T (origin)", after a function has returned false.
  std::string culprit() const;

 private:
  /// Tells where a force's instance stands; without v, of its position alone.
  koppel_configuration at(const Kinematics& kinematics, const Force& force, double time, const double* q,
                          const double* v);
  bool call(const Force& force, const koppel_configuration& configuration, const double* states, double* state_rates);
  void add(const Kinematics& kinematics, const Force& force, std::vector<Wrench>& on_nodes) const;
  const double* states_of(const Force& force, const double* states) const;
  double delivered(const Force& force) const;
  bool failed(const Force& force);

  const Mechanism& mechanism_;
  std::size_t switch_count_ = 0;
  const Force* culprit_ = nullptr;
  // Of the force that was asked last: its frames in the world, and what its plugin sees and answers.
  Pose a_, b_;
  std::array<double, 12> pose_{};
  std::array<double, 6> twist_{}, wrench_{};
  std::vector<double> q_, v_, effort_, unused_rates_;
};

}  // namespace koppel

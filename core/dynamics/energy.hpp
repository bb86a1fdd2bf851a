// Energy and momentum of a whole mechanism.
#pragma once

#include "dynamics/inertias.hpp"
#include "mechanism/kinematics.hpp"

namespace koppel {

/// World axes.
struct MechanicalState {
  double kinetic = 0.0;                        ///< [J]
  double potential = 0.0;                      ///< of gravity [J], zero with all mass at the world's origin
  double mass = 0.0;                           ///< [kg]
  Vector3 centre = Vector3::Zero();            ///< of mass [m]; without mass the world's origin
  Vector3 velocity = Vector3::Zero();          ///< of the centre of mass [m/s]
  Vector3 momentum = Vector3::Zero();          ///< [N s]
  Vector3 angular_momentum = Vector3::Zero();  ///< about the centre of mass [N m s]
};

/// Of the motion that stands in the kinematics (forward_motion; accelerations do not count). gravity [m/s^2]. Nothing
/// is allocated.
MechanicalState mechanical_state(const Inertias& inertias, const Kinematics& kinematics, const Vector3& gravity);

/// The two energies [J] alone.
double kinetic_energy(const Inertias& inertias, const Kinematics& kinematics);
double potential_energy(const Inertias& inertias, const Kinematics& kinematics, const Vector3& gravity);

}  // namespace koppel

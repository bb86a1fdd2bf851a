// The equations of motion linear about a state: x' = A x + B u, y = C x + D u for small deviations, with the errors of
// all entries; eigenvalues and modes.
#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "base/error.hpp"
#include "dynamics/derivative.hpp"
#include "mechanism/state.hpp"

namespace koppel {

struct LinearisationOptions {
  bool held = false;                   ///< at rest: drives stand still, and rates of the state do not count
  std::vector<std::uint32_t> efforts;  ///< rates along which efforts are inputs
};

/// How the mechanism moves where it is linearised.
enum class Course {
  unsteady,  ///< its rates change: eigenvalues tell of this instant only
  steady,    ///< they do not, and A, B, C, D do not either as far as A tells
  resting,   ///< nothing of x changes
};

/// x ~ shape exp(eigenvalue t).
struct NaturalMode {
  std::complex<double> eigenvalue;  ///< [1/s]
  double error = 0.0;               ///< estimate, to first order in the errors of A [1/s]
  Eigen::VectorXcd state;           ///< of x, in its units
  Eigen::VectorXcd shape;           ///< of all rates (nv), taken as displacements; greatest scaled one 1
};

/// x: independent coordinates (of quaternions and unit vectors small turns along their rates), their rates, internal
/// states of forces. u: value, rate and acceleration of each drive, then efforts. y: the recorded columns; recorded
/// loads take efforts as if they acted along the independent coordinates.
struct Linearisation {
  std::vector<std::uint32_t> independent;  ///< rates
  std::vector<NamedNumber> states, inputs, outputs;
  Derivative a, b, c, d;
  Eigen::MatrixXd mass;           ///< in the independent coordinates [kg m^2, kg m, kg]
  Derivative stiffness, damping;  ///< -mass times the parts of A: mass a + damping v + stiffness q = efforts
  Eigen::VectorXd x_rate;         ///< where it is linearised
  Course course = Course::unsteady;
  double drift = 0.0;              ///< greatest scaled change of a rate [rad/s^2, lengths/s^2], or of an internal state
  std::vector<NaturalMode> modes;  ///< slow ones first; of a pair that with the positive frequency first
};

/// About a closed state, with its rates if it has them, at rest else. Errors: those of inertias(), plugin_misbehaved,
/// massless, no_linearisation.
Result<Linearisation> linearise(std::shared_ptr<const Mechanism> mechanism, const State& state,
                                const LinearisationOptions& options);

}  // namespace koppel

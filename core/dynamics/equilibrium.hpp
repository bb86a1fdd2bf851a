// Static equilibrium: where a mechanism rests under its forces while its drives stand still.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/error.hpp"
#include "dynamics/stiffness.hpp"
#include "mechanism/state.hpp"

namespace koppel {

struct EquilibriumOptions {
  bool moving = false;   ///< drives go on with their rates, and only what they do not move shall rest: steady motion
  bool nearest = false;  ///< the nearest root of the forces, be it stable or not; else where the forces push it to
  std::uint32_t max_iterations = 0;  ///< 0: 200
};

/// An equilibrium, or where the search for one ended. Forces are along the independent coordinates; scaled ones are
/// times the mechanism's length if that is a line [J].
struct Equilibrium {
  bool found = false;
  std::string why;                         ///< it was not found; a sentence without a full stop
  double time = 0.0;                       ///< of the drives [s]
  bool moving = false;                     ///< as the options said
  Eigen::VectorXd q, v;                    ///< closed; rates are zero but for moving drives
  Eigen::VectorXd internal;                ///< states of the forces
  std::vector<std::uint32_t> independent;  ///< rates
  Eigen::VectorXd force;                   ///< left, of each [N m, N]
  double worst_force = 0.0;                ///< the greatest of them, as scaled [N m, N]
  std::uint32_t worst = 0;                 ///< the rate along which the greatest scaled force is left
  double residual = 0.0;                   ///< that one over `force_scale`, or the greatest rate of an internal state
  double force_scale = 0.0;                ///< size of the forces [J]: of weights that turn, and of stiffness
  double coordinate_error = 0.0;           ///< what the force left displaces [rad, lengths of the mechanism]
  double energy = 0.0;                     ///< potential energy, of gravity and of forces that store it [J]
  double moved = 0.0;                      ///< greatest scaled change of a coordinate from the start
  std::uint32_t moved_most = 0;            ///< the rate of it
  std::uint32_t iterations = 0;
  double unrest = 0.0;  ///< greatest scaled rate of what no drive sets [1/s]: in steady motion rounding only
  Stiffness stiffness;  ///< there; empty if not found
};

/// From a closed state, at its time. Statics needs no masses; gravity acts on those that there are. Not found is no
/// error. Errors: those of inertias(), plugin_misbehaved, no_equilibrium where not even the start can be evaluated.
Result<Equilibrium> find_equilibrium(std::shared_ptr<const Mechanism> mechanism, const State& state,
                                     const EquilibriumOptions& options);

/// Puts a state of the mechanism there, internal states of forces too. Held drives stand still, and nothing has rates
/// or accelerations; beside moving ones accelerations are left to be computed. Null: done; else as set_time().
const Input* take_place(const Mechanism& mechanism, const Equilibrium& equilibrium, State& state);

}  // namespace koppel

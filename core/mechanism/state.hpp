// Where a mechanism stands: plain numbers, copied and saved freely. All history that matters for the next step is here.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mechanism/mechanism.hpp"

namespace koppel {

/// How much of a state holds: each stage includes those before it.
enum class Stage { assigned, closed, velocities, accelerations };

struct State {
  /// Where the scene lets it start: positions, and rates of what no drive sets.
  explicit State(const Mechanism& mechanism);

  Eigen::VectorXd q;         ///< nq: all joints in file order, angles not wrapped
  Eigen::VectorXd v;         ///< nv
  Eigen::VectorXd a;         ///< nv
  Eigen::VectorXd internal;  ///< internal states of the forces
  double time = 0.0;
  Stage stage = Stage::assigned;

  /// What the inputs ask for; q takes it over when the state is closed.
  Eigen::VectorXd input, input_rate, input_acceleration;

  /// From the last two closed positions, for extrapolation.
  struct History {
    double time = 0.0;             ///< of the position in q
    double step = 0.0;             ///< from the one before; 0: there is none
    Eigen::VectorXd acceleration;  ///< nv, of the one before
    std::uint32_t rank = 0;        ///< of the closure's equations in the unknowns at the position in q
    double weakest = 0.0;          ///< singular value there that counts
    /// On which side of the singular positions each step of the closed forms stands (see FlowTracker); 0: not known.
    std::vector<std::int8_t> sides;
    double pace = 1.0;  ///< time of the drives by path parameter, of a state that follows its curve
  } history;
};

/// Evaluates every drive at a time [s] and makes it the state's inputs. Null: done; else the input whose function
/// failed or returned something not finite (the state is untouched then).
const Input* set_time(const Mechanism& mechanism, double time, State& state);

/// result = q moved by the tangent vector delta (nv).
void integrate(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& delta,
               Eigen::VectorXd& result);

/// delta (nv) that leads from one position to another.
void difference(const Mechanism& mechanism, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                Eigen::VectorXd& delta);

/// Names of scalar coordinates outside their limits (empty: none).
std::vector<std::string> limits_exceeded(const Mechanism& mechanism, const State& state);
bool any_limit_exceeded(const Mechanism& mechanism, const Eigen::VectorXd& q);

}  // namespace koppel

// How far a simulation may be from the true motion, by comparing it with a finer one.
#pragma once

#include <vector>

#include "common/handles.hpp"
#include "common/model.hpp"

namespace koppel::app {

/// A second simulation with a tenth of the tolerance, or half the step. The differences estimate the error of the
/// first: they are no bound, and where neighbouring motions part quickly they say little more than that.
class GlobalError {
 public:
  explicit GlobalError(const Model& model);

  /// Beside a simulation that starts from a state with these options. Below 0: error tells why.
  koppel_status begin(const koppel_state* state, const koppel_simulation* simulation, koppel_simulation_options how,
                      koppel_error& error);
  /// On to the time at which the simulation shows a state.
  koppel_status compare(const koppel_state* state, double time, koppel_error& error);

  /// Greatest difference of a coordinate (radians, lengths over the scene's, components of quaternions) at any of these
  /// times, and at the last.
  double greatest() const { return greatest_; }
  double last() const { return last_; }

 private:
  Motion motion_;
  Simulation finer_;
  std::vector<double> weights_, coarse_, fine_;
  bool is_fixed_ = false;  ///< steps are
  double greatest_ = 0.0, last_ = 0.0;
};

}  // namespace koppel::app

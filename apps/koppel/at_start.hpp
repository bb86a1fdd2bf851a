// A mechanism at time 0, where check looks at it and where a run begins; or at another one.
#pragma once

#include <optional>

#include "common/model.hpp"

namespace koppel::app {

struct AtStart {
  Motion motion;                     ///< the state that the rest tells of
  koppel_status status = KOPPEL_OK;  ///< of the first call that failed
  koppel_error error = sized<koppel_error>();
  koppel_report report = sized<koppel_report>();
  bool closed = false;                      ///< true also where the rates that the inputs ask for are impossible
  std::optional<koppel_analysis> analysis;  ///< of the closed position, or of the start values if none was found
};

/// Closes a fresh state at time 0, computes its velocities and accelerations, and counts its freedoms.
AtStart at_start(const Model& model);

/// Closes a fresh state at time 0, and moves it by its drives to another time [s].
koppel_status close_at(const Motion& motion, double time, koppel_error& error);

}  // namespace koppel::app

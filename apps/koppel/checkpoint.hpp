// A simulation in a file, to go on from later.
#pragma once

#include <string>

#include "common/handles.hpp"
#include "common/model.hpp"

namespace koppel::app {

/// Saves a simulation; a file that is there is replaced at once, never half. Below 0: error tells why.
koppel_status write_checkpoint(koppel_simulation* simulation, const std::string& file, koppel_error& error);
/// What was saved, of the model's scene.
koppel_status read_checkpoint(const Model& model, const std::string& file, Simulation& simulation, koppel_error& error);

}  // namespace koppel::app

// The picture of a suspension: three positions from the front and from above, toe and camber over travel.
#pragma once

#include <string>

#include "suspension/sweep.hpp"

namespace koppel::app {

/// An SVG document. Rods are drawn between frames NAME_inner and NAME_outer.
std::string picture(const Model& model, const SweepOptions& options, const SweepResult& result);

}  // namespace koppel::app

// Whether the joints of a loop keep its bodies in parallel planes, or turn all of them about one point.
#pragma once

#include <span>

#include "closure/freedoms.hpp"
#include "mechanism/joint.hpp"

namespace koppel {

/// From the motions of all joints of the loop, each about or along an axis in the world; `length` [m] is the
/// mechanism's. Axes count as parallel, or as meeting, to half the digits: what is in a file was rounded there
/// (K-II-1.1.2).
LoopFreedoms loop_kind(std::span<const Column> motions, double length);

}  // namespace koppel

// The elementary motions of a product joint, as its plugin tells them, checked.
#pragma once

#include <vector>

#include "base/error.hpp"
#include "plugin/type.hpp"

namespace koppel {

/// One motion for each coordinate block, in the order in which they act. Every block moves exactly one motion that fits
/// its kind; axes have unit length to rounding; what a kind of motion does not use is zero. Empty for a joint without
/// coordinates. type: a product joint (JointType::is_product).
/// Errors: plugin_misbehaved (motions() failed or gave a number that is not finite), plugin_malformed (all else).
Result<std::vector<koppel_motion>> joint_motions(const JointType& type, const Instance& instance);

}  // namespace koppel

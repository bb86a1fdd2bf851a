// T: rotation about the axis z, then about a second axis that has turned with it. The two axes meet in the origin.
#include <cmath>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Universal {
  double axis2[3];  // unit length
};

constexpr double x_axis[3] = {1, 0, 0};
constexpr double least_sine = 1e-6;  // of the angle between the two axes

constexpr koppel_coordinate coordinates[] = {angle("angle1"), angle("angle2")};
constexpr koppel_parameter parameters[] = {
    optional(KOPPEL_PARAMETER_DIRECTION, "axis2", "", "Second axis; by default x of the inlet", x_axis),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const double* axis2 = values[0].reals;
  if (std::hypot(axis2[0], axis2[1]) < least_sine) {
    return reject(host, "axis2", "is parallel to the axis of the joint",
                  "choose a direction that is not along the axis; usually one at right angles to it");
  }
  return keep<Universal>(instance, [&] { return Universal{{axis2[0], axis2[1], axis2[2]}}; });
}

koppel_status motions(const void* instance, koppel_motion* out) {
  const auto& axis2 = as<Universal>(instance).axis2;
  out[0] = rotation_about_z(0);
  out[1] = motion(KOPPEL_MOTION_ROTATION, 1, axis2[0], axis2[1], axis2[2]);
  return KOPPEL_OK;
}

constexpr koppel_type described =
    type<Universal>("universal", "Rotations about two axes that meet", parameters, create);
constexpr koppel_joint_type table = product_joint(described, coordinates, motions);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

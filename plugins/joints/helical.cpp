// H: rotation about the axis z with an advance along it in proportion.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Helical {
  double pitch;  // [m/rad]
};

constexpr koppel_coordinate coordinates[] = {angle("angle")};
constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_REAL, "pitch", "m/rad", "Advance along the axis for each radian of rotation"),
};

koppel_status create(const koppel_host*, const koppel_value* values, void** instance) {
  return keep<Helical>(instance, [&] { return Helical{real(values[0])}; });
}

koppel_status motions(const void* instance, koppel_motion* out) {
  out[0] = motion(KOPPEL_MOTION_SCREW, 0, 0, 0, 1, as<Helical>(instance).pitch);
  return KOPPEL_OK;
}

constexpr koppel_type described = type<Helical>("helical", "Screw motion of constant pitch", parameters, create);
constexpr koppel_joint_type table = product_joint(described, coordinates, motions);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

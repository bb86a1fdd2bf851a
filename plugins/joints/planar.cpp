// E: translations along x and y of the inlet, then rotation about z.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr koppel_coordinate coordinates[] = {line("x"), line("y"), angle("angle")};

koppel_status motions(const void*, koppel_motion* out) {
  out[0] = translation(0, 1, 0, 0);
  out[1] = translation(1, 0, 1, 0);
  out[2] = rotation_about_z(2);
  return KOPPEL_OK;
}

constexpr koppel_type described = type("planar", "Motion in the plane normal to the axis");
constexpr koppel_joint_type table = product_joint(described, coordinates, motions);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

// R: one rotation about the axis z.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr koppel_coordinate coordinates[] = {angle("angle")};

koppel_status motions(const void*, koppel_motion* out) {
  out[0] = rotation_about_z(0);
  return KOPPEL_OK;
}

constexpr koppel_type described = type("revolute", "Rotation about the axis");
constexpr koppel_joint_type table = product_joint(described, coordinates, motions);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

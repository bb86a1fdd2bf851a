// All six freedoms: the position of the outlet in inlet axes, and its rotation.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr koppel_coordinate coordinates[] = {quaternion("rotation"), line("x"), line("y"), line("z")};

koppel_status motions(const void*, koppel_motion* out) {
  out[0] = translation(1, 1, 0, 0);
  out[1] = translation(2, 0, 1, 0);
  out[2] = translation(3, 0, 0, 1);
  out[3] = free_rotation(0);
  return KOPPEL_OK;
}

constexpr koppel_type described = type("free", "Free motion");
constexpr koppel_joint_type table = product_joint(described, coordinates, motions);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

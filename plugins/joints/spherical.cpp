// S: free rotation about the common origin.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr koppel_coordinate coordinates[] = {quaternion("rotation")};

koppel_status motions(const void*, koppel_motion* out) {
  out[0] = free_rotation(0);
  return KOPPEL_OK;
}

constexpr koppel_type described = type("spherical", "Free rotation about a point");
constexpr koppel_joint_type table = product_joint(described, coordinates, motions);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

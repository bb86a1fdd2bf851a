// P: one translation along the axis z.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr koppel_coordinate coordinates[] = {line("displacement")};

koppel_status motions(const void*, koppel_motion* out) {
  out[0] = translation(0, 0, 0, 1);
  return KOPPEL_OK;
}

constexpr koppel_type described = type("prismatic", "Translation along the axis");
constexpr koppel_joint_type table = product_joint(described, coordinates, motions);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

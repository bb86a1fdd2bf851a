// A rigid connection: no coordinate, no motion.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr koppel_type described = type("weld", "Rigid connection");

constexpr koppel_joint_type fixed() {
  koppel_joint_type joint{};
  joint.struct_size = sizeof(koppel_joint_type);
  joint.type = &described;
  return joint;
}
constexpr koppel_joint_type table = fixed();

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

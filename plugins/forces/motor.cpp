// An actuator on a coordinate: a constant effort, one that follows time, and one that depends on speed, added up.
#include "characteristic.hpp"

using namespace koppel::plugin;

namespace {

struct Motor {
  double effort;
  Characteristic by_time, by_speed;

  void evaluate(const Standing& at, const Action& out) const {
    *out.effort = effort + by_time.value(at.time) + by_speed.value(*at.v);
  }
};

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_COORDINATES, "of", "", "Coordinate that it acts on"),
    optional(KOPPEL_PARAMETER_REAL, "effort", "N m or N", "Constant effort", zeros),
    pairs("by_time", "s", "Pairs of time in s and effort in N m or N, times increasing"),
    pairs("by_speed", "", "Pairs of speed in rad/s or m/s and effort in N m or N, speeds increasing"),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  if (const koppel_status status = check_increasing(host, "by_time", values[2]); status < 0) return status;
  if (const koppel_status status = check_increasing(host, "by_speed", values[3]); status < 0) return status;
  return keep<Motor>(instance, [&] {
    return Motor{real(values[1]), Characteristic(values[2]), Characteristic(values[3])};
  });
}

constexpr koppel_type described = type<Motor>("motor", "Effort on a coordinate by time and speed", parameters, create);
constexpr koppel_force_type table = force<Motor>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

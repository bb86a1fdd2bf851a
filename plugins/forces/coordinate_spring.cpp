// A spring and damper on one coordinate of a joint: it turns on an angle and pulls on a length.
#include "characteristic.hpp"

using namespace koppel::plugin;

namespace {

struct CoordinateSpring {
  double stiffness, damping, free;
  Characteristic characteristic;

  void evaluate(const Standing& at, const Action& out) const {
    const double stretch = *at.q - free;
    *out.effort = -(stiffness * stretch + characteristic.value(stretch)) - damping * *at.v;
  }
  double energy(const Standing& at) const {
    const double stretch = *at.q - free;
    return stiffness * stretch * stretch / 2 + characteristic.integral(stretch);
  }
  double dissipation(const Standing& at) const { return damping * *at.v * *at.v; }
};

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_COORDINATES, "of", "", "Coordinate that it acts on"),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "stiffness", "N m/rad or N/m", "Stiffness", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "damping", "N m s/rad or N s/m", "Damping", zeros)),
    optional(KOPPEL_PARAMETER_REAL, "free", "", "Value at which it is relaxed, in rad or m", zeros),
    pairs("table", "",
          "Pairs of stretch in rad or m and effort against it in N m or N, added to the rest; stretches increase"),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  if (const koppel_status status = check_increasing(host, "table", values[4]); status < 0) return status;
  return keep<CoordinateSpring>(instance, [&] {
    return CoordinateSpring{real(values[1]), real(values[2]), real(values[3]), Characteristic(values[4])};
  });
}

constexpr koppel_type described =
    type<CoordinateSpring>("coordinate_spring", "Spring and damper on a coordinate", parameters, create);
constexpr koppel_force_type table = force<CoordinateSpring>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

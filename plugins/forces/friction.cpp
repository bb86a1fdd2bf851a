// Dry and viscous friction of a coordinate. The jump of Coulomb's law at rest is made a steep but smooth tanh, so that
// under a steady load the coordinate creeps, at less than the given speed up to three quarters of the Coulomb effort.
#include <cmath>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Friction {
  double coulomb, viscous, speed;

  double against(double v) const { return coulomb * std::tanh(v / speed) + viscous * v; }
  void evaluate(const Standing& at, const Action& out) const { *out.effort = -against(*at.v); }
  /// Nothing is stored.
  double energy(const Standing&) const { return 0; }
  double dissipation(const Standing& at) const { return against(*at.v) * *at.v; }
};

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_COORDINATES, "of", "", "Coordinate that it acts on"),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "coulomb", "N m or N", "Effort of dry friction in motion", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "viscous", "N m s/rad or N s/m", "Viscous friction", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "speed", "rad/s or m/s",
                          "Speed at which dry friction has three quarters of its effort: it goes with tanh(rate/speed)",
                          nullptr)),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const double coulomb = real(values[1]), speed = values[3].count > 0 ? real(values[3]) : 0;
  if (coulomb > 0 && !(speed > 0)) {
    return reject(host, "speed", "must be given and be greater than zero where there is dry friction",
                  "take a speed far below those that matter");
  }
  return keep<Friction>(instance, [&] { return Friction{coulomb, real(values[2]), speed > 0 ? speed : 1.0}; });
}

constexpr koppel_type described = type<Friction>("friction", "Dry and viscous friction", parameters, create);
constexpr koppel_force_type table = force<Friction>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

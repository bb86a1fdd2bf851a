// f(x) = offset + amplitude sin(2 pi frequency x + phase)
#include <cmath>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Sine {
  double amplitude, frequency, phase, offset;

  Jet at(double x) const {
    const double omega = 2 * pi * frequency;
    const double s = amplitude * std::sin(omega * x + phase);
    const double c = amplitude * std::cos(omega * x + phase);
    return {offset + s, omega * c, -omega * omega * s};
  }
};

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_REAL, "amplitude", "", "Greatest deviation from the offset"),
    required(KOPPEL_PARAMETER_REAL, "frequency", "Hz", "Periods in each second"),
    optional(KOPPEL_PARAMETER_REAL, "phase", "rad", "Phase at zero", zeros),
    optional(KOPPEL_PARAMETER_REAL, "offset", "", "Mean value", zeros),
};

koppel_status create(const koppel_host*, const koppel_value* values, void** instance) {
  return keep<Sine>(instance, [&] { return Sine{real(values[0]), real(values[1]), real(values[2]), real(values[3])}; });
}

constexpr koppel_type described = type<Sine>("sine", "A harmonic oscillation", parameters, create);
constexpr koppel_function_type table = function<Sine>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

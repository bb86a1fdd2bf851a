// A rise from one value to another along a cycloid: at rest before and after, without jumps in velocity and
// acceleration.
#include <cmath>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Cycloid {
  double from, to, start, duration;

  Jet at(double t) const {
    const double x = (t - start) / duration;
    if (x <= 0) return {from, 0, 0};
    if (x >= 1) return {to, 0, 0};
    const double rise = to - from;
    const double half = std::sin(pi * x);
    return {from + rise * (x - std::sin(2 * pi * x) / (2 * pi)), rise / duration * 2 * half * half,
            rise / (duration * duration) * 2 * pi * std::sin(2 * pi * x)};
  }
};

constexpr koppel_parameter parameters[] = {
    optional(KOPPEL_PARAMETER_REAL, "from", "", "Value before the rise", zeros),
    required(KOPPEL_PARAMETER_REAL, "to", "", "Value after the rise"),
    optional(KOPPEL_PARAMETER_REAL, "start", "s", "When the rise begins", zeros),
    not_negative(required(KOPPEL_PARAMETER_REAL, "duration", "s", "How long it takes")),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  if (!(real(values[3]) > 0)) {
    return reject(host, "duration", "must be greater than zero", "a rise in no time would be a jump");
  }
  return keep<Cycloid>(instance, [&] {
    return Cycloid{real(values[0]), real(values[1]), real(values[2]), real(values[3])};
  });
}

constexpr koppel_type described =
    type<Cycloid>("cycloid", "A smooth rise from one value to another", parameters, create);
constexpr koppel_function_type table = function<Cycloid>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

// f(x) = start + slope x
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Ramp {
  double start, slope;

  Jet at(double x) const { return {start + slope * x, slope, 0}; }
};

constexpr koppel_parameter parameters[] = {
    optional(KOPPEL_PARAMETER_REAL, "start", "", "Value at zero", zeros),
    required(KOPPEL_PARAMETER_REAL, "slope", "", "Change in each second"),
};

koppel_status create(const koppel_host*, const koppel_value* values, void** instance) {
  return keep<Ramp>(instance, [&] { return Ramp{real(values[0]), real(values[1])}; });
}

constexpr koppel_type described = type<Ramp>("ramp", "A straight line", parameters, create);
constexpr koppel_function_type table = function<Ramp>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

// f(x) = value
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Constant {
  double value;

  Jet at(double) const { return {value, 0, 0}; }
};

constexpr koppel_parameter parameters[] = {required(KOPPEL_PARAMETER_REAL, "value", "", "The value")};

koppel_status create(const koppel_host*, const koppel_value* values, void** instance) {
  return keep<Constant>(instance, [&] { return Constant{real(values[0])}; });
}

constexpr koppel_type described = type<Constant>("constant", "The same value always", parameters, create);
constexpr koppel_function_type table = function<Constant>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

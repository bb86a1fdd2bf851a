// f(x) = c0 + c1 x + c2 x^2 + ...
#include <vector>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Polynomial {
  std::vector<double> coefficients;

  /// Horner's scheme for value, derivative and half the second derivative at once.
  Jet at(double x) const {
    Jet jet{0, 0, 0};
    for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) {
      jet.second = jet.second * x + jet.first;
      jet.first = jet.first * x + jet.value;
      jet.value = jet.value * x + *c;
    }
    return {jet.value, jet.first, 2 * jet.second};
  }
};

constexpr koppel_parameter parameters[] = {
    counted(required(KOPPEL_PARAMETER_REAL, "coefficients", "", "Coefficients, constant term first"), 1, 64),
};

koppel_status create(const koppel_host*, const koppel_value* values, void** instance) {
  return keep<Polynomial>(
      instance, [&] { return Polynomial{std::vector<double>(values[0].reals, values[0].reals + values[0].count)}; });
}

constexpr koppel_type described = type<Polynomial>("polynomial", "A polynomial", parameters, create);
constexpr koppel_function_type table = function<Polynomial>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

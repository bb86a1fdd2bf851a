// A linear relation of joint coordinates: gears, belts, differentials, a rack and its pinion.
#include <vector>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Coupling {
  std::vector<double> factors;
  double offset;
};

constexpr uint32_t most = 64;
constexpr koppel_row rows[] = {row("coupling", "1")};
constexpr koppel_parameter parameters[] = {
    counted(required(KOPPEL_PARAMETER_COORDINATES, "coordinates", "", "Coordinates that are coupled"), 1, most),
    counted(required(KOPPEL_PARAMETER_REAL, "factors", "", "Factor of each coordinate"), 1, most),
    optional(KOPPEL_PARAMETER_REAL, "offset", "", "What factors times coordinates add up to", zeros),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const koppel_value& factors = values[1];
  if (values[0].count != factors.count) {
    return reject(host, "factors", "has not as many entries as `coordinates`", "give one factor for each coordinate");
  }
  bool any = false;
  for (size_t i = 0; i < factors.count; ++i) any = any || factors.reals[i] != 0;
  if (!any) return reject(host, "factors", "are all zero", "give at least one that is not");
  return keep<Coupling>(instance, [&] {
    return Coupling{std::vector<double>(factors.reals, factors.reals + factors.count), real(values[2])};
  });
}

koppel_status residual(size_t count, const void* const* instances, const koppel_configuration* at, double* out) {
  for (size_t i = 0; i < count; ++i) {
    const auto& coupling = as<Coupling>(instances[i]);
    const double* q = at->q + at->coordinates * i;
    out[i] = -coupling.offset;
    for (size_t j = 0; j < at->coordinates; ++j) out[i] += coupling.factors[j] * q[j];
  }
  return KOPPEL_OK;
}

koppel_status jacobian(size_t count, const void* const* instances, const koppel_configuration* at, double*,
                       double* by_rate) {
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j < at->coordinates; ++j) {
      by_rate[at->coordinates * i + j] = as<Coupling>(instances[i]).factors[j];
    }
  }
  return KOPPEL_OK;
}

koppel_status second_order(size_t count, const void* const*, const koppel_configuration*, double* out) {
  for (size_t i = 0; i < count; ++i) out[i] = 0;
  return KOPPEL_OK;
}

constexpr koppel_type described =
    type<Coupling>("coupling", "Linear relation of joint coordinates", parameters, create);
constexpr koppel_constraint_type table = {
    sizeof(koppel_constraint_type), &described, rows, 1, residual, jacobian, nullptr, second_order};

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

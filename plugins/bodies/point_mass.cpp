// A body whose mass sits in one point.
#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct PointMass {
  koppel_inertia inertia;
};

constexpr koppel_parameter parameters[] = {
    not_negative(required(KOPPEL_PARAMETER_REAL, "mass", "kg", "Mass")),
    optional(KOPPEL_PARAMETER_VECTOR, "at", "m", "Where the mass sits in the body frame", zeros),
};

koppel_status create(const koppel_host*, const koppel_value* values, void** instance) {
  const double* at = values[1].reals;
  return keep<PointMass>(instance, [&] {
    return PointMass{inertia_about_origin(real(values[0]), {at[0], at[1], at[2]}, zeros)};
  });
}

koppel_status inertia(size_t count, const void* const* instances, koppel_inertia* out) {
  for (size_t i = 0; i < count; ++i) out[i] = as<PointMass>(instances[i]).inertia;
  return KOPPEL_OK;
}

constexpr koppel_type described = type<PointMass>("point_mass", "Mass in one point", parameters, create);
constexpr koppel_body_type table = {sizeof(koppel_body_type), &described, inertia, nullptr, 0};

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

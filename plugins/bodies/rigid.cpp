// A rigid body with mass, centre of mass and inertia tensor, all optional: kinematics needs none of them.
#include <algorithm>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Rigid {
  koppel_inertia inertia;
};

constexpr koppel_parameter parameters[] = {
    not_negative(optional(KOPPEL_PARAMETER_REAL, "mass", "kg", "Mass", zeros)),
    optional(KOPPEL_PARAMETER_VECTOR, "centre_of_mass", "m", "Centre of mass in the body frame", zeros),
    counted(optional(KOPPEL_PARAMETER_REAL, "inertia", "kg m^2",
                     "Inertia tensor xx yy zz xy xz yz about the centre of mass, in body axes", zeros),
            6, 6),
};

/// Whether some distribution of mass has this tensor: the second moments tr(I)/2 E - I of the mass must not be
/// negative in any direction. Digits that a table has lost by rounding are forgiven.
bool is_physical(const double* i) {
  const double half = (i[0] + i[1] + i[2]) / 2;
  const double slack = 1e-6 * half;
  const double a = half - i[0] + slack, b = half - i[1] + slack, c = half - i[2] + slack;
  const double ab = -i[3], ac = -i[4], bc = -i[5];
  const double determinant = a * (b * c - bc * bc) - ab * (ab * c - bc * ac) + ac * (ab * bc - b * ac);
  return half >= 0 && std::min({a, b, c}) >= 0 && std::min({a * b - ab * ab, a * c - ac * ac, b * c - bc * bc}) >= 0 &&
         determinant >= 0;
}

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const double* c = values[1].reals;
  const double* i = values[2].reals;
  if (!is_physical(i)) {
    return reject(
        host, "inertia", "belongs to no distribution of mass",
        "give xx yy zz xy xz yz of the tensor about the centre of mass; each of xx, yy, zz is at most the sum "
        "of the other two, and the products have the signs that they have in the tensor");
  }
  return keep<Rigid>(instance, [&] {
    return Rigid{inertia_about_origin(real(values[0]), {c[0], c[1], c[2]}, {i[0], i[1], i[2], i[3], i[4], i[5]})};
  });
}

koppel_status inertia(size_t count, const void* const* instances, koppel_inertia* out) {
  for (size_t i = 0; i < count; ++i) out[i] = as<Rigid>(instances[i]).inertia;
  return KOPPEL_OK;
}

constexpr koppel_type described = type<Rigid>("rigid", "Rigid body", parameters, create);
constexpr koppel_body_type table = {sizeof(koppel_body_type), &described, inertia, nullptr, 0};

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

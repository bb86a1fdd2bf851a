// The origins of two frames keep a distance: a massless rod with a ball at each end.
#include <cmath>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Distance {
  double distance;  // [m]
};

constexpr koppel_row rows[] = {row("distance", "m")};
constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_FRAME, "from", "", "Frame at whose origin the distance begins"),
    required(KOPPEL_PARAMETER_FRAME, "to", "", "Frame at whose origin it ends"),
    not_negative(required(KOPPEL_PARAMETER_REAL, "distance", "m", "Distance of the two origins")),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  if (!(real(values[2]) > 0)) {
    return reject(host, "distance", "must be greater than zero",
                  "to hold two points together use a spherical joint; a distance of zero has no direction");
  }
  return keep<Distance>(instance, [&] { return Distance{real(values[2])}; });
}

/// The vector between the origins: length, and direction in the axes of the second frame.
struct Span {
  double length;
  double n[3];
};

Span span_of(const double* pose) {
  const double* r = pose;
  const double* p = pose + 9;
  const double length = std::hypot(p[0], p[1], p[2]);
  // Where the points coincide no direction is better than another; x gets an assembly going.
  const double u[3] = {length > 0 ? p[0] / length : 1.0, length > 0 ? p[1] / length : 0.0,
                       length > 0 ? p[2] / length : 0.0};
  Span out{length, {}};
  for (int j = 0; j < 3; ++j) out.n[j] = r[j] * u[0] + r[3 + j] * u[1] + r[6 + j] * u[2];
  return out;
}

koppel_status residual(size_t count, const void* const* instances, const koppel_configuration* at, double* out) {
  for (size_t i = 0; i < count; ++i) out[i] = span_of(at->pose + 12 * i).length - as<Distance>(instances[i]).distance;
  return KOPPEL_OK;
}

/// r' = n . v, with n and the velocity v of the second origin in the axes of the second frame.
koppel_status jacobian(size_t count, const void* const*, const koppel_configuration* at, double* by_twist, double*) {
  for (size_t i = 0; i < count; ++i) {
    const Span span = span_of(at->pose + 12 * i);
    for (int j = 0; j < 3; ++j) {
      by_twist[6 * i + static_cast<size_t>(j)] = 0;
      by_twist[6 * i + 3 + static_cast<size_t>(j)] = span.n[j];
    }
  }
  return KOPPEL_OK;
}

/// r'' - n . v' = n . (omega x v) + (v . v - (n . v)^2) / |p|: the axes turn, and the direction does.
koppel_status second_order(size_t count, const void* const*, const koppel_configuration* at, double* out) {
  for (size_t i = 0; i < count; ++i) {
    const Span span = span_of(at->pose + 12 * i);
    const double* n = span.n;
    const double* omega = at->twist + 6 * i;
    const double* v = omega + 3;
    const double turning = n[0] * (omega[1] * v[2] - omega[2] * v[1]) + n[1] * (omega[2] * v[0] - omega[0] * v[2]) +
                           n[2] * (omega[0] * v[1] - omega[1] * v[0]);
    // |n x v|^2 = v.v - (n.v)^2 without its cancellation.
    const double x = n[1] * v[2] - n[2] * v[1], y = n[2] * v[0] - n[0] * v[2], z = n[0] * v[1] - n[1] * v[0];
    out[i] = turning + (span.length > 0 ? (x * x + y * y + z * z) / span.length : 0.0);
  }
  return KOPPEL_OK;
}

constexpr koppel_type described = type<Distance>("distance", "Two points keep a distance", parameters, create);
constexpr koppel_constraint_type table = {
    sizeof(koppel_constraint_type), &described, rows, 1, residual, jacobian, nullptr, second_order};

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

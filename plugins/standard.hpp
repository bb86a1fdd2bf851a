// What the standard plugins have in common: tables and entries are written down once here, in terms of plugin.h alone.
#pragma once

#include <cstddef>
#include <cstring>
#include <iterator>
#include <new>

#include "koppel/plugin.h"

namespace koppel::plugin {

// ---------------------------------------------------------------------------------------------- schema

inline constexpr double zeros[6] = {};

/// A parameter that a scene must give.
constexpr koppel_parameter required(int32_t kind, const char* name, const char* unit, const char* doc) {
  koppel_parameter p{};
  p.struct_size = sizeof(koppel_parameter);
  p.kind = kind;
  p.name = name;
  p.unit = unit;
  p.doc = doc;
  p.required = 1;
  return p;
}

/// A parameter with a default, as many numbers as its kind and count_min ask for.
constexpr koppel_parameter optional(int32_t kind, const char* name, const char* unit, const char* doc,
                                    const double* fallback) {
  koppel_parameter p = required(kind, name, unit, doc);
  p.required = 0;
  p.fallback = fallback;
  return p;
}

constexpr koppel_parameter counted(koppel_parameter p, uint32_t count_min, uint32_t count_max) {
  p.count_min = count_min;
  p.count_max = count_max;
  return p;
}

constexpr koppel_parameter not_negative(koppel_parameter p) {
  p.minimum = zeros;
  return p;
}

/// A table of pairs, at least two where it is given; without it there is none.
constexpr koppel_parameter pairs(const char* name, const char* unit, const char* doc) {
  koppel_parameter p = optional(KOPPEL_PARAMETER_TABLE, name, unit, doc, nullptr);
  p.columns = 2;
  p.count_min = 2;  // count_max 0: as many rows as there are
  return p;
}

constexpr koppel_coordinate line(const char* name) { return {sizeof(koppel_coordinate), KOPPEL_BLOCK_LINE, name}; }
constexpr koppel_coordinate angle(const char* name) { return {sizeof(koppel_coordinate), KOPPEL_BLOCK_ANGLE, name}; }
constexpr koppel_coordinate quaternion(const char* name) {
  return {sizeof(koppel_coordinate), KOPPEL_BLOCK_QUATERNION, name};
}

constexpr koppel_row row(const char* name, const char* unit) { return {sizeof(koppel_row), name, unit}; }

// ---------------------------------------------------------------------------------------------- types

using Create = koppel_status (*)(const koppel_host*, const koppel_value*, void**);

/// A type whose instances have nothing to keep.
constexpr koppel_type type(const char* name, const char* summary) {
  return {sizeof(koppel_type), name, summary, nullptr, 0, nullptr, nullptr};
}

template <typename T>
void destroy(void* instance) {
  delete static_cast<T*>(instance);
}

/// A type whose instances are a T, made by `create` with keep<T>().
template <typename T, std::size_t n>
constexpr koppel_type type(const char* name, const char* summary, const koppel_parameter (&parameters)[n],
                           Create create) {
  return {sizeof(koppel_type), name, summary, parameters, n, create, destroy<T>};
}

/// Hands over a T that `make` builds; running out of memory while building is a status, not an exception.
template <typename T, typename Make>
koppel_status keep(void** instance, Make&& make) {
  try {
    *instance = new T(make());
    return KOPPEL_OK;
  } catch (const std::bad_alloc&) {
    return KOPPEL_NO_MEMORY;
  }
}

inline koppel_status reject(const koppel_host* host, const char* parameter, const char* message, const char* advice) {
  host->reject(host->context, parameter, message, advice);
  return KOPPEL_INVALID_ARGUMENT;
}

template <typename T>
const T& as(const void* instance) {
  return *static_cast<const T*>(instance);
}

inline double real(const koppel_value& value) { return value.reals[0]; }

// ---------------------------------------------------------------------------------------------- joints

constexpr koppel_motion motion(int32_t kind, uint32_t coordinate, double x, double y, double z, double pitch = 0.0) {
  return {sizeof(koppel_motion), kind, coordinate, {x, y, z}, {0.0, 0.0, 0.0}, pitch};
}
constexpr koppel_motion rotation_about_z(uint32_t coordinate) {
  return motion(KOPPEL_MOTION_ROTATION, coordinate, 0.0, 0.0, 1.0);
}
constexpr koppel_motion translation(uint32_t coordinate, double x, double y, double z) {
  return motion(KOPPEL_MOTION_TRANSLATION, coordinate, x, y, z);
}
constexpr koppel_motion free_rotation(uint32_t coordinate) {
  return motion(KOPPEL_MOTION_FREE_ROTATION, coordinate, 0.0, 0.0, 0.0);
}

using Motions = koppel_status (*)(const void*, koppel_motion*);

/// A joint whose motion is a product of elementary motions.
template <std::size_t n>
constexpr koppel_joint_type product_joint(const koppel_type& type, const koppel_coordinate (&coordinates)[n],
                                          Motions motions) {
  koppel_joint_type joint{};
  joint.struct_size = sizeof(koppel_joint_type);
  joint.type = &type;
  joint.coordinates = coordinates;
  joint.coordinate_count = n;
  joint.motions = motions;
  return joint;
}

// ---------------------------------------------------------------------------------------------- bodies

/// The inertia tensor about the origin from that about the centre of mass (parallel axes, Steiner); both as xx yy zz
/// xy xz yz.
inline koppel_inertia inertia_about_origin(double mass, const double (&centre)[3], const double (&about_centre)[6]) {
  koppel_inertia out{};
  out.struct_size = sizeof(koppel_inertia);
  out.mass = mass;
  const double x = centre[0], y = centre[1], z = centre[2];
  const double steiner[6] = {y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z};
  for (int i = 0; i < 3; ++i) out.centre_of_mass[i] = centre[i];
  for (int i = 0; i < 6; ++i) out.about_origin[i] = about_centre[i] + mass * steiner[i];
  return out;
}

// ---------------------------------------------------------------------------------------------- functions

/// Value, first and second derivative.
struct Jet {
  double value, first, second;
};

/// Evaluates T::at(x), which gives a Jet, for each instance.
template <typename T>
koppel_status evaluate_all(size_t count, const void* const* instances, const double* x, double* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const Jet jet = as<T>(instances[i]).at(x[i]);
    out[3 * i] = jet.value;
    out[3 * i + 1] = jet.first;
    out[3 * i + 2] = jet.second;
  }
  return KOPPEL_OK;
}

template <typename T>
constexpr koppel_function_type function(const koppel_type& type) {
  return {sizeof(koppel_function_type), &type, evaluate_all<T>};
}

// ---------------------------------------------------------------------------------------------- forces

constexpr koppel_internal_state internal_state(const char* name, const char* unit) {
  return {sizeof(koppel_internal_state), name, unit};
}

/// Where one instance of a force stands; pose and twist, or q and v, are null where it has no such subject.
struct Standing {
  double time;
  const double *pose, *twist, *q, *v;
  const double* states;
};

template <typename T>
Standing standing(const koppel_configuration& at, const double* states, std::size_t i) {
  const auto item = [i](const double* first, std::size_t size) {
    return first == nullptr ? nullptr : first + size * i;
  };
  std::size_t state_count = 0;
  if constexpr (requires { T::states; }) state_count = std::size(T::states);
  return {at.time,
          item(at.pose, 12),
          item(at.twist, 6),
          item(at.q, at.coordinates),
          item(at.v, at.coordinates),
          item(states, state_count)};
}

/// What one instance answers: [moment; force] on the second frame, efforts on coordinates, rates of internal states.
struct Action {
  double *wrench, *effort, *state_rates;
};

template <typename T>
koppel_status evaluate_forces(size_t count, const void* const* instances, const koppel_configuration* at,
                              const double* states, double* wrench, double* effort, double* state_rates) {
  for (std::size_t i = 0; i < count; ++i) {
    as<T>(instances[i]).evaluate(standing<T>(*at, states, i), Action{wrench, effort, state_rates});
    if (wrench != nullptr) wrench += 6;
    if (effort != nullptr) effort += at->coordinates;
    if constexpr (requires { T::states; }) state_rates += std::size(T::states);
  }
  return KOPPEL_OK;
}

template <typename T>
koppel_status energies(size_t count, const void* const* instances, const koppel_configuration* at, const double* states,
                       double* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = as<T>(instances[i]).energy(standing<T>(*at, states, i));
  return KOPPEL_OK;
}

template <typename T>
koppel_status dissipations(size_t count, const void* const* instances, const koppel_configuration* at,
                           const double* states, double* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = as<T>(instances[i]).dissipation(standing<T>(*at, states, i));
  return KOPPEL_OK;
}

template <typename T>
koppel_status switches_of(size_t count, const void* const* instances, const koppel_configuration* at,
                          const double* states, double* out) {
  for (std::size_t i = 0; i < count; ++i) {
    as<T>(instances[i]).switches(standing<T>(*at, states, i), out + T::switch_count * i);
  }
  return KOPPEL_OK;
}

/// The table of a force whose instances are a T. T::evaluate(Standing, Action) it must have; T::states, T::energy and
/// T::dissipation (Standing to number), T::switch_count and T::switches(Standing, numbers) it may have.
template <typename T>
constexpr koppel_force_type force(const koppel_type& type) {
  koppel_force_type out{};
  out.struct_size = sizeof(koppel_force_type);
  out.type = &type;
  out.evaluate = evaluate_forces<T>;
  if constexpr (requires { T::states; }) {
    out.states = T::states;
    out.state_count = std::size(T::states);
  }
  if constexpr (requires { &T::energy; }) out.energy = energies<T>;
  if constexpr (requires { &T::dissipation; }) out.dissipation = dissipations<T>;
  if constexpr (requires { &T::switches; }) {
    out.switch_count = T::switch_count;
    out.switches = switches_of<T>;
  }
  return out;
}

// ---------------------------------------------------------------------------------------------- entry

constexpr const char* interface_of(const koppel_joint_type&) { return KOPPEL_JOINT_INTERFACE; }
constexpr const char* interface_of(const koppel_body_type&) { return KOPPEL_BODY_INTERFACE; }
constexpr const char* interface_of(const koppel_constraint_type&) { return KOPPEL_CONSTRAINT_INTERFACE; }
constexpr const char* interface_of(const koppel_function_type&) { return KOPPEL_FUNCTION_INTERFACE; }
constexpr const char* interface_of(const koppel_force_type&) { return KOPPEL_FORCE_INTERFACE; }

template <const auto& table>
const void* only_table(const char* interface_id, size_t index) {
  return index == 0 && std::strcmp(interface_id, interface_of(table)) == 0 ? &table : nullptr;
}

/// The entry of a plugin with one type.
template <const auto& table>
constexpr koppel_plugin_entry entry() {
  return {sizeof(koppel_plugin_entry),
          {KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, KOPPEL_ABI_PATCH},
          "koppel",
          nullptr,
          nullptr,
          only_table<table>};
}

}  // namespace koppel::plugin

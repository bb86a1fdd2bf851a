// A constraint of this program's own that depends on frames, on a coordinate and on time:
// |p|^2 - radius^2 - t c = 0, p the second frame's origin in the first, c the coordinate.
#pragma once

#include <string_view>

#include <Eigen/Core>

#include "koppel/plugin.h"

namespace koppel::test {

namespace wave {

constexpr double radius = 1.0;

inline Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(const koppel_configuration& at,
                                                                               size_t i) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(at.pose + 12 * i);
}
inline Eigen::Map<const Eigen::Vector3d> position(const koppel_configuration& at, size_t i) {
  return Eigen::Map<const Eigen::Vector3d>(at.pose + 12 * i + 9);
}

inline koppel_status residual(size_t count, const void* const*, const koppel_configuration* at, double* out) {
  for (size_t i = 0; i < count; ++i) out[i] = position(*at, i).squaredNorm() - radius * radius - at->time * at->q[i];
  return KOPPEL_OK;
}
inline koppel_status jacobian(size_t count, const void* const*, const koppel_configuration* at, double* by_twist,
                              double* by_rate) {
  for (size_t i = 0; i < count; ++i) {
    Eigen::Map<Eigen::Matrix<double, 6, 1>> row(by_twist + 6 * i);
    row << Eigen::Vector3d::Zero(), 2 * rotation(*at, i).transpose() * position(*at, i);
    by_rate[i] = -at->time;
  }
  return KOPPEL_OK;
}
inline koppel_status time_rate(size_t count, const void* const*, const koppel_configuration* at, double* out) {
  for (size_t i = 0; i < count; ++i) out[i] = -at->q[i];
  return KOPPEL_OK;
}
inline koppel_status second_order(size_t count, const void* const*, const koppel_configuration* at, double* out) {
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Map<const Eigen::Vector3d> omega(at->twist + 6 * i), v(at->twist + 6 * i + 3);
    out[i] =
        2 * v.squaredNorm() + 2 * (rotation(*at, i).transpose() * position(*at, i)).dot(omega.cross(v)) - 2 * at->v[i];
  }
  return KOPPEL_OK;
}

constexpr koppel_parameter parameter(std::int32_t kind, const char* name) {
  koppel_parameter out{};
  out.struct_size = sizeof(koppel_parameter);
  out.kind = kind;
  out.name = name;
  out.doc = name;
  out.required = 1;
  return out;
}
constexpr koppel_parameter parameters[] = {parameter(KOPPEL_PARAMETER_FRAME, "from"),
                                           parameter(KOPPEL_PARAMETER_FRAME, "to"),
                                           parameter(KOPPEL_PARAMETER_COORDINATES, "coordinate")};
constexpr koppel_type type = {sizeof(koppel_type),
                              "wave.growing_sphere",
                              "A sphere that grows",
                              parameters,
                              std::size(parameters),
                              nullptr,
                              nullptr};
constexpr koppel_row rows[] = {{sizeof(koppel_row), "radius", "m^2"}};
constexpr koppel_constraint_type constraint = {
    sizeof(koppel_constraint_type), &type, rows, 1, residual, jacobian, time_rate, second_order};

inline const void* type_table(const char* interface_id, size_t index) {
  return std::string_view(interface_id) == KOPPEL_CONSTRAINT_INTERFACE && index == 0 ? &constraint : nullptr;
}

}  // namespace wave

inline const koppel_plugin_entry wave_plugin = {sizeof(koppel_plugin_entry),
                                                {KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, KOPPEL_ABI_PATCH},
                                                "wave",
                                                nullptr,
                                                nullptr,
                                                wave::type_table};

}  // namespace koppel::test

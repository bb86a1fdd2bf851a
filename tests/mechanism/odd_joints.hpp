// A plugin of this program with joints that no standard one is like: what core may and may not cut.
#pragma once

#include <cmath>
#include <string_view>

#include "koppel/plugin.h"

namespace koppel::test {

namespace odd {

constexpr koppel_coordinate coordinate(std::int32_t kind, const char* name) {
  return {sizeof(koppel_coordinate), kind, name};
}
constexpr koppel_coordinate two_angles[] = {coordinate(KOPPEL_BLOCK_ANGLE, "one"),
                                            coordinate(KOPPEL_BLOCK_ANGLE, "two")};
constexpr koppel_coordinate angle_and_line[] = {coordinate(KOPPEL_BLOCK_ANGLE, "angle"),
                                                coordinate(KOPPEL_BLOCK_LINE, "shift")};
constexpr koppel_coordinate two_lines[] = {coordinate(KOPPEL_BLOCK_LINE, "one"), coordinate(KOPPEL_BLOCK_LINE, "two")};
constexpr koppel_coordinate direction[] = {coordinate(KOPPEL_BLOCK_UNIT_VECTOR, "direction")};

constexpr koppel_motion rotation_z(std::uint32_t block, double point_x = 0) {
  return {sizeof(koppel_motion), KOPPEL_MOTION_ROTATION, block, {0, 0, 1}, {point_x, 0, 0}, 0};
}
constexpr koppel_motion translation(std::uint32_t block, double x, double y, double z) {
  return {sizeof(koppel_motion), KOPPEL_MOTION_TRANSLATION, block, {x, y, z}, {0, 0, 0}, 0};
}

template <int which>
koppel_status motions(const void*, koppel_motion* out) {
  if constexpr (which == 0) out[0] = rotation_z(0), out[1] = rotation_z(1);                 // parallel axes
  if constexpr (which == 1) out[0] = rotation_z(0, 0.1), out[1] = translation(1, 0, 0, 1);  // beside the origin
  if constexpr (which == 2) out[0] = rotation_z(0), out[1] = translation(1, 1, 0, 0);       // slides after turning
  if constexpr (which == 3) out[0] = rotation_z(0), out[1] = translation(1, 0, 0, 1);       // turns, slides along
  if constexpr (which == 4) out[0] = translation(0, 1, 0, 0), out[1] = translation(1, 0.6, 0.8, 0);  // oblique
  return KOPPEL_OK;
}

/// The outlet's z axis is the unit vector, reached by the shortest turn.
inline koppel_status pointing_pose(size_t count, const void* const*, const double* q, double* pose) {
  for (size_t i = 0; i < count; ++i, q += 3, pose += 12) {
    const double x = q[0], y = q[1], z = q[2], f = 1 / (1 + z);
    const double values[12] = {1 - f * x * x, -f * x * y,   x, -f * x * y, 1 - f * y * y, y, -x, -y, z, 0.1 * x,
                               0.1 * y,       0.1 * z - 0.1};
    for (int k = 0; k < 12; ++k) pose[k] = values[k];
  }
  return KOPPEL_OK;
}

/// A turn that carries a curve along, both bent by a shift: S and its bias change with all coordinates.
inline koppel_status cam_pose(size_t count, const void* const*, const double* q, double* pose) {
  for (size_t i = 0; i < count; ++i, q += 2, pose += 12) {
    const double angle = q[0], shift = q[1], tilt = 0.5 * angle * shift;
    const double c = std::cos(angle), s = std::sin(angle), a = std::cos(tilt), b = std::sin(tilt);
    const double values[12] = {c,     -s * a,
                               s * b, s,
                               c * a, -c * b,
                               0,     b,
                               a,     0.1 * std::sin(2 * angle),
                               shift, 0.1 * (1 - c) + 0.2 * angle * shift};
    for (int k = 0; k < 12; ++k) pose[k] = values[k];
  }
  return KOPPEL_OK;
}

constexpr koppel_type type(const char* name) {
  koppel_type out{};
  out.struct_size = sizeof(koppel_type);
  out.name = name;
  out.summary = "Odd";
  return out;
}
constexpr koppel_type parallel_type = type("odd.parallel"), beside_type = type("odd.beside"),
                      slide_type = type("odd.slide"), along_type = type("odd.along"),
                      oblique_type = type("odd.oblique"), pointing_type = type("odd.pointing"),
                      cam_type = type("odd.cam");

constexpr koppel_joint_type product(const koppel_type& of, const koppel_coordinate* coordinates,
                                    koppel_status (*motions)(const void*, koppel_motion*)) {
  koppel_joint_type out{};
  out.struct_size = sizeof(koppel_joint_type);
  out.type = &of;
  out.coordinates = coordinates;
  out.coordinate_count = 2;
  out.motions = motions;
  return out;
}
using PoseFunction = koppel_status(size_t count, const void* const* instances, const double* q, double* pose);
constexpr koppel_joint_type by_pose(const koppel_type& of, const koppel_coordinate* coordinates, size_t count,
                                    PoseFunction* pose) {
  koppel_joint_type out{};
  out.struct_size = sizeof(koppel_joint_type);
  out.type = &of;
  out.coordinates = coordinates;
  out.coordinate_count = count;
  out.pose = pose;
  return out;
}
constexpr koppel_joint_type joints[] = {
    product(parallel_type, two_angles, motions<0>),  product(beside_type, angle_and_line, motions<1>),
    product(slide_type, angle_and_line, motions<2>), product(along_type, angle_and_line, motions<3>),
    product(oblique_type, two_lines, motions<4>),    by_pose(pointing_type, direction, 1, pointing_pose),
    by_pose(cam_type, angle_and_line, 2, cam_pose)};

inline const void* type_table(const char* interface_id, size_t index) {
  return std::string_view(interface_id) == KOPPEL_JOINT_INTERFACE && index < std::size(joints) ? &joints[index]
                                                                                               : nullptr;
}

}  // namespace odd

inline const koppel_plugin_entry odd_plugin = {sizeof(koppel_plugin_entry),
                                               {KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, KOPPEL_ABI_PATCH},
                                               "odd",
                                               nullptr,
                                               nullptr,
                                               odd::type_table};

}  // namespace koppel::test

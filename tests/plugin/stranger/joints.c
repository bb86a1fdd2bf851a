/* Product joints that move as the standard ones do, under other names. */
#include <stdlib.h>

#include "acme.h"

#define COORDINATE(block, its_name) \
  { .struct_size = sizeof(koppel_coordinate), .kind = (block), .name = (its_name) }
#define ROTATION(block)                                                                                              \
  {                                                                                                                  \
    .struct_size = sizeof(koppel_motion), .kind = KOPPEL_MOTION_ROTATION, .coordinate = (block), .axis = { 0, 0, 1 } \
  }
#define TRANSLATION(block, x, y, z)                                                                           \
  {                                                                                                           \
    .struct_size = sizeof(koppel_motion), .kind = KOPPEL_MOTION_TRANSLATION, .coordinate = (block), .axis = { \
      x,                                                                                                      \
      y,                                                                                                      \
      z                                                                                                       \
    }                                                                                                         \
  }
#define FREE_ROTATION(block) \
  { .struct_size = sizeof(koppel_motion), .kind = KOPPEL_MOTION_FREE_ROTATION, .coordinate = (block) }

#define TYPE(its_name) \
  { .struct_size = sizeof(koppel_type), .name = "acme." its_name, .summary = "Like the standard one" }

/* A joint without parameters: its coordinates and its motions, in the order in which they act. */
#define JOINT(symbol, its_name, its_coordinates, ...)                                \
  static koppel_status symbol##_motions(const void* instance, koppel_motion* out) {  \
    static const koppel_motion motions[] = {__VA_ARGS__};                            \
    size_t i;                                                                        \
    (void)instance;                                                                  \
    for (i = 0; i < ACME_COUNT(motions); ++i) out[i] = motions[i];                   \
    return KOPPEL_OK;                                                                \
  }                                                                                  \
  static const koppel_type symbol##_type = TYPE(its_name);                           \
  const koppel_joint_type symbol = {.struct_size = sizeof(koppel_joint_type),        \
                                    .type = &symbol##_type,                          \
                                    .coordinates = (its_coordinates),                \
                                    .coordinate_count = ACME_COUNT(its_coordinates), \
                                    .motions = symbol##_motions}

static const koppel_coordinate angle[] = {COORDINATE(KOPPEL_BLOCK_ANGLE, "angle")};
static const koppel_coordinate displacement[] = {COORDINATE(KOPPEL_BLOCK_LINE, "displacement")};
static const koppel_coordinate angle_and_displacement[] = {COORDINATE(KOPPEL_BLOCK_ANGLE, "angle"),
                                                           COORDINATE(KOPPEL_BLOCK_LINE, "displacement")};
static const koppel_coordinate two_angles[] = {COORDINATE(KOPPEL_BLOCK_ANGLE, "angle1"),
                                               COORDINATE(KOPPEL_BLOCK_ANGLE, "angle2")};
static const koppel_coordinate rotation[] = {COORDINATE(KOPPEL_BLOCK_QUATERNION, "rotation")};
static const koppel_coordinate in_plane[] = {COORDINATE(KOPPEL_BLOCK_LINE, "x"), COORDINATE(KOPPEL_BLOCK_LINE, "y"),
                                             COORDINATE(KOPPEL_BLOCK_ANGLE, "angle")};
static const koppel_coordinate all_six[] = {COORDINATE(KOPPEL_BLOCK_QUATERNION, "rotation"),
                                            COORDINATE(KOPPEL_BLOCK_LINE, "x"), COORDINATE(KOPPEL_BLOCK_LINE, "y"),
                                            COORDINATE(KOPPEL_BLOCK_LINE, "z")};

JOINT(acme_hinge, "hinge", angle, ROTATION(0));
JOINT(acme_revolute, "revolute", angle, ROTATION(0));
JOINT(acme_prismatic, "prismatic", displacement, TRANSLATION(0, 0, 0, 1));
JOINT(acme_cylindrical, "cylindrical", angle_and_displacement, ROTATION(0), TRANSLATION(1, 0, 0, 1));
JOINT(acme_spherical, "spherical", rotation, FREE_ROTATION(0));
JOINT(acme_planar, "planar", in_plane, TRANSLATION(0, 1, 0, 0), TRANSLATION(1, 0, 1, 0), ROTATION(2));
JOINT(acme_free, "free", all_six, TRANSLATION(1, 1, 0, 0), TRANSLATION(2, 0, 1, 0), TRANSLATION(3, 0, 0, 1),
      FREE_ROTATION(0));

static const koppel_type weld_type = TYPE("weld");
const koppel_joint_type acme_weld = {.struct_size = sizeof(koppel_joint_type), .type = &weld_type};

/* ---- the two with a parameter; their instances are plain numbers */

static koppel_status keep_numbers(const koppel_value* value, void** instance) {
  double* numbers = malloc(value->count * sizeof(double));
  size_t i;
  if (numbers == NULL) return KOPPEL_NO_MEMORY;
  for (i = 0; i < value->count; ++i) numbers[i] = value->reals[i];
  *instance = numbers;
  return KOPPEL_OK;
}

static koppel_status create_numbers(const koppel_host* host, const koppel_value* values, void** instance) {
  (void)host;
  return keep_numbers(&values[0], instance);
}

static koppel_status helical_motions(const void* instance, koppel_motion* out) {
  const koppel_motion screw = {.struct_size = sizeof(koppel_motion),
                               .kind = KOPPEL_MOTION_SCREW,
                               .coordinate = 0,
                               .axis = {0, 0, 1},
                               .pitch = *(const double*)instance};
  out[0] = screw;
  return KOPPEL_OK;
}

static const koppel_parameter helical_parameters[] = {{.struct_size = sizeof(koppel_parameter),
                                                       .kind = KOPPEL_PARAMETER_REAL,
                                                       .name = "pitch",
                                                       .unit = "m/rad",
                                                       .doc = "Advance for each radian",
                                                       .required = 1}};
static const koppel_type helical_type = {.struct_size = sizeof(koppel_type),
                                         .name = "acme.helical",
                                         .summary = "Like the standard one",
                                         .parameters = helical_parameters,
                                         .parameter_count = 1,
                                         .create = create_numbers,
                                         .destroy = free};
const koppel_joint_type acme_helical = {.struct_size = sizeof(koppel_joint_type),
                                        .type = &helical_type,
                                        .coordinates = angle,
                                        .coordinate_count = ACME_COUNT(angle),
                                        .motions = helical_motions};

static koppel_status universal_motions(const void* instance, koppel_motion* out) {
  const double* axis2 = instance;
  const koppel_motion first = ROTATION(0);
  const koppel_motion second = {.struct_size = sizeof(koppel_motion),
                                .kind = KOPPEL_MOTION_ROTATION,
                                .coordinate = 1,
                                .axis = {axis2[0], axis2[1], axis2[2]}};
  out[0] = first;
  out[1] = second;
  return KOPPEL_OK;
}

static const double x_axis[3] = {1, 0, 0};
static const koppel_parameter universal_parameters[] = {{.struct_size = sizeof(koppel_parameter),
                                                         .kind = KOPPEL_PARAMETER_DIRECTION,
                                                         .name = "axis2",
                                                         .doc = "Second axis",
                                                         .fallback = x_axis}};
static const koppel_type universal_type = {.struct_size = sizeof(koppel_type),
                                           .name = "acme.universal",
                                           .summary = "Like the standard one",
                                           .parameters = universal_parameters,
                                           .parameter_count = 1,
                                           .create = create_numbers,
                                           .destroy = free};
const koppel_joint_type acme_universal = {.struct_size = sizeof(koppel_joint_type),
                                          .type = &universal_type,
                                          .coordinates = two_angles,
                                          .coordinate_count = ACME_COUNT(two_angles),
                                          .motions = universal_motions};

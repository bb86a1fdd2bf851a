/* A screw whose pitch varies: turning by `angle` advances s(angle) = pitch angle + growth angle^2 along z. No product
 * of elementary motions makes such a motion, so the joint is given by callbacks.
 *
 * acme.varying_screw offers all of them, acme.bare_screw only the pose and leaves the rest to the engine. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "acme.h"

static const double pi = 3.14159265358979323846;

typedef struct screw {
  double pitch;  /* [m/rad] at angle 0 */
  double growth; /* [m/rad^2] */
} screw;

static double advance(const screw* s, double angle) { return (s->pitch + s->growth * angle) * angle; }
static double advance_rate(const screw* s, double angle) { return s->pitch + 2 * s->growth * angle; }

/* The angle that belongs to an advance, on the branch that goes through zero; where the screw does not reach, the angle
 * of the turning point (just before it, so that the rate does not vanish). */
static double angle_of_advance(const screw* s, double z) {
  const double least = 1e-12 * s->pitch * s->pitch;
  const double discriminant = fmax(s->pitch * s->pitch + 4 * s->growth * z, least);
  return 2 * z / (s->pitch + copysign(sqrt(discriminant), s->pitch));
}

/* A pose has 12 numbers: rotation row by row, then position. R[row, column] is pose[3 row + column]. */
static void pose_of(const screw* s, double angle, double* pose) {
  const double c = cos(angle), n = sin(angle);
  const double values[12] = {c, -n, 0, n, c, 0, 0, 0, 1, 0, 0, advance(s, angle)};
  memcpy(pose, values, sizeof values);
}

static koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  screw* s;
  if (values[0].reals[0] == 0) {
    host->reject(host->context, "pitch", "must not be zero", "use a hinge if nothing shall advance");
    return KOPPEL_INVALID_ARGUMENT;
  }
  s = malloc(sizeof *s);
  if (s == NULL) return KOPPEL_NO_MEMORY;
  s->pitch = values[0].reals[0];
  s->growth = values[1].reals[0];
  *instance = s;
  return KOPPEL_OK;
}

static koppel_status pose(size_t count, const void* const* instances, const double* q, double* out) {
  size_t i;
  for (i = 0; i < count; ++i) pose_of(instances[i], q[i], out + 12 * i);
  return KOPPEL_OK;
}

static koppel_status subspace(size_t count, const void* const* instances, const double* q, double* out) {
  size_t i;
  for (i = 0; i < count; ++i) {
    const double column[6] = {0, 0, 1, 0, 0, advance_rate(instances[i], q[i])};
    memcpy(out + 6 * i, column, sizeof column);
  }
  return KOPPEL_OK;
}

static koppel_status bias(size_t count, const void* const* instances, const double* q, const double* u, const double* w,
                          double* out) {
  size_t i;
  (void)q;
  for (i = 0; i < count; ++i) {
    const screw* s = instances[i];
    const double column[6] = {0, 0, 0, 0, 0, 2 * s->growth * u[i] * w[i]};
    memcpy(out + 6 * i, column, sizeof column);
  }
  return KOPPEL_OK;
}

/* ---- the implicit face
 * Any rotation is a turn about z and then a tilt by the rotation vector w = (w_x, w_y, 0). The outlet sees the inlet's
 * z axis as a = (-w_y sin t, w_x sin t, cos t) with t = |w|, hence w = f (a_y, -a_x) with f = t / sin t. */

typedef struct tilt {
  double a[3];
  double f;       /* t / sin t */
  double f_slope; /* df/dt(time) = -f_slope da_z/dt(time) */
} tilt;

static tilt tilt_of(const double* pose) {
  tilt out;
  double sine;
  memcpy(out.a, pose + 6, sizeof out.a);
  sine = hypot(out.a[0], out.a[1]);
  if (sine < 1e-4 && out.a[2] > 0) { /* series; what is left out is below rounding */
    const double square = sine * sine;
    out.f = 1 + square / 6;
    out.f_slope = 1.0 / 3 + 2 * square / 15;
  } else {
    const double safe = fmax(sine, 1e-150); /* tilted by just half a turn: far from closed, whatever the direction */
    out.f = atan2(sine, out.a[2]) / safe;
    out.f_slope = (1 - out.f * out.a[2]) / (safe * safe);
  }
  return out;
}

static double turn_of(const double* pose) { return atan2(pose[3] - pose[1], pose[0] + pose[4]); }

static double wrapped(double angle) { return angle - 2 * pi * floor(angle / (2 * pi) + 0.5); }

static void residual_of(const screw* s, const double* pose, double* r) {
  const tilt t = tilt_of(pose);
  r[0] = pose[9];
  r[1] = pose[10];
  r[2] = t.f * t.a[1];
  r[3] = -t.f * t.a[0];
  if (t.a[2] < 0 && r[2] == 0 && r[3] == 0) r[2] = pi; /* upside down is not closed */
  r[4] = wrapped(turn_of(pose) - angle_of_advance(s, pose[11]));
}

/* Along the twist (omega, v): R' = R [omega]x, p' = R v, a' = a x omega. */
static void jacobian_of(const screw* s, const double* pose, double* jacobian) {
  const tilt t = tilt_of(pose);
  const double ax = t.a[0], ay = t.a[1], az = t.a[2];
  const double a_rate[3][3] = {{0, -az, ay}, {az, 0, -ax}, {-ay, ax, 0}}; /* of a_x, a_y, a_z along omega */
  const double n = pose[3] - pose[1], d = pose[0] + pose[4];
  const double n_rate[3] = {-pose[2], -pose[5], d};
  const double d_rate[3] = {pose[5], -pose[2], -n};
  const double slope = 1 / advance_rate(s, angle_of_advance(s, pose[11]));
  int j;
  memset(jacobian, 0, 30 * sizeof *jacobian);
  for (j = 0; j < 3; ++j) {
    const double f_rate = -t.f_slope * a_rate[2][j];
    jacobian[0 + 3 + j] = pose[j];
    jacobian[6 + 3 + j] = pose[3 + j];
    jacobian[12 + j] = f_rate * ay + t.f * a_rate[1][j];
    jacobian[18 + j] = -f_rate * ax - t.f * a_rate[0][j];
    jacobian[24 + j] = (d * n_rate[j] - n * d_rate[j]) / (n * n + d * d);
    jacobian[24 + 3 + j] = -slope * pose[6 + j];
  }
}

static koppel_status implicit(size_t count, const void* const* instances, const double* at, double* residual,
                              double* jacobian) {
  size_t i;
  for (i = 0; i < count; ++i) {
    if (residual != NULL) residual_of(instances[i], at + 12 * i, residual + 5 * i);
    if (jacobian != NULL) jacobian_of(instances[i], at + 12 * i, jacobian + 30 * i);
  }
  return KOPPEL_OK;
}

/* The rotation tells the angle but for full turns, the advance tells these. */
static koppel_status coordinates_of(size_t count, const void* const* instances, const double* at, double* q) {
  size_t i;
  for (i = 0; i < count; ++i) {
    const double turn = turn_of(at + 12 * i);
    q[i] = turn + 2 * pi * floor((angle_of_advance(instances[i], at[12 * i + 11]) - turn) / (2 * pi) + 0.5);
  }
  return KOPPEL_OK;
}

/* ---- tables */

static const koppel_coordinate coordinates[] = {
    {.struct_size = sizeof(koppel_coordinate), .kind = KOPPEL_BLOCK_ANGLE, .name = "angle"}};

#define ROW(its_name, its_unit) \
  { .struct_size = sizeof(koppel_row), .name = (its_name), .unit = (its_unit) }
static const koppel_row rows[] = {ROW("x", "m"), ROW("y", "m"), ROW("tilt_x", "rad"), ROW("tilt_y", "rad"),
                                  ROW("screw", "rad")};

static const double no_growth = 0;
static const koppel_parameter parameters[] = {{.struct_size = sizeof(koppel_parameter),
                                               .kind = KOPPEL_PARAMETER_REAL,
                                               .name = "pitch",
                                               .unit = "m/rad",
                                               .doc = "Advance for each radian at angle zero",
                                               .required = 1},
                                              {.struct_size = sizeof(koppel_parameter),
                                               .kind = KOPPEL_PARAMETER_REAL,
                                               .name = "growth",
                                               .unit = "m/rad^2",
                                               .doc = "Half the change of pitch for each radian",
                                               .fallback = &no_growth}};

#define TYPE(its_name)                                                                                     \
  {                                                                                                        \
    .struct_size = sizeof(koppel_type), .name = (its_name), .summary = "Screw of varying pitch",           \
    .parameters = parameters, .parameter_count = ACME_COUNT(parameters), .create = create, .destroy = free \
  }

static const koppel_type varying_screw_type = TYPE("acme.varying_screw");
const koppel_joint_type acme_varying_screw = {.struct_size = sizeof(koppel_joint_type),
                                              .type = &varying_screw_type,
                                              .coordinates = coordinates,
                                              .coordinate_count = ACME_COUNT(coordinates),
                                              .pose = pose,
                                              .subspace = subspace,
                                              .bias = bias,
                                              .rows = rows,
                                              .row_count = ACME_COUNT(rows),
                                              .implicit = implicit,
                                              .coordinates_of = coordinates_of};

static const koppel_type bare_screw_type = TYPE("acme.bare_screw");
const koppel_joint_type acme_bare_screw = {.struct_size = sizeof(koppel_joint_type),
                                           .type = &bare_screw_type,
                                           .coordinates = coordinates,
                                           .coordinate_count = ACME_COUNT(coordinates),
                                           .pose = pose};

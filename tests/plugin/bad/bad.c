/* A correct plugin with one type of each kind. Each bad plugin of the tests is this one with a single thing wrong: the
 * build defines one of the macros below to something else. Functions are not static, because a fault may leave one
 * unused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "koppel/plugin.h"

/* ---- entry */
#ifndef ENTRY
#define ENTRY KOPPEL_PLUGIN_SYMBOL
#endif
#ifndef ENTRY_SIZE
#define ENTRY_SIZE sizeof(koppel_plugin_entry)
#endif
#ifndef MAJOR
#define MAJOR KOPPEL_ABI_MAJOR
#endif
#ifndef MINOR
#define MINOR KOPPEL_ABI_MINOR
#endif
#ifndef VENDOR
#define VENDOR "bad"
#endif
#ifndef INIT_STATUS
#define INIT_STATUS KOPPEL_OK
#endif
#ifndef TYPE_TABLE
#define TYPE_TABLE type_table
#endif
#ifndef LAST_TABLE /* of each interface */
#define LAST_TABLE 0
#endif
#ifndef FIRST_TABLE
#define FIRST_TABLE 0
#endif

/* ---- type of the joint */
#ifndef JOINT_SIZE
#define JOINT_SIZE sizeof(koppel_joint_type)
#endif
#ifndef JOINT_TYPE
#define JOINT_TYPE &joint_type
#endif
#ifndef TYPE_SIZE
#define TYPE_SIZE sizeof(koppel_type)
#endif
#ifndef TYPE_NAME
#define TYPE_NAME "bad.joint"
#endif
#ifndef CREATE
#define CREATE create
#endif
#ifndef CREATE_STATUS
#define CREATE_STATUS KOPPEL_OK
#endif
#ifndef CREATE_SPEAKS
#define CREATE_SPEAKS 1
#endif

/* ---- its parameters */
#ifndef PARAMETERS
#define PARAMETERS parameters
#endif
#ifndef PARAMETER_COUNT
#define PARAMETER_COUNT 2
#endif
#ifndef PARAMETER_SIZE
#define PARAMETER_SIZE sizeof(koppel_parameter)
#endif
#ifndef PARAMETER_NAME
#define PARAMETER_NAME "second"
#endif
#ifndef PARAMETER_KIND
#define PARAMETER_KIND KOPPEL_PARAMETER_REAL
#endif
#ifndef COUNT_MIN
#define COUNT_MIN 1
#endif
#ifndef COUNT_MAX
#define COUNT_MAX 3
#endif
#ifndef FALLBACK
#define FALLBACK 1.0
#endif
#ifndef MINIMUM
#define MINIMUM 0.0
#endif

/* ---- its coordinates and motion */
#ifndef COORDINATES
#define COORDINATES coordinates
#endif
#ifndef COORDINATE_NAME
#define COORDINATE_NAME "displacement"
#endif
#ifndef COORDINATE_KIND
#define COORDINATE_KIND KOPPEL_BLOCK_LINE
#endif
#ifndef MOTIONS
#define MOTIONS motions
#endif
#ifndef MOTIONS_STATUS
#define MOTIONS_STATUS KOPPEL_OK
#endif
#ifndef MOTION_COUNT
#define MOTION_COUNT 2
#endif
#ifndef MOTION_SIZE
#define MOTION_SIZE sizeof(koppel_motion)
#endif
#ifndef MOTION_KIND
#define MOTION_KIND KOPPEL_MOTION_SCREW
#endif
#ifndef MOTION_COORDINATE
#define MOTION_COORDINATE 0
#endif
#ifndef AXIS_Z
#define AXIS_Z 1.0
#endif
#ifndef POINT_X
#define POINT_X 0.5
#endif
#ifndef PITCH
#define PITCH 0.01
#endif
#ifndef POSE
#define POSE NULL
#endif
#ifndef POSE_NUMBER
#define POSE_NUMBER 1.0
#endif
#ifndef IMPLICIT
#define IMPLICIT NULL
#endif
#ifndef COORDINATES_OF
#define COORDINATES_OF NULL
#endif
#ifndef ROW_COUNT
#define ROW_COUNT 0
#endif

/* ---- the other types */
#ifndef INERTIA
#define INERTIA inertia
#endif
#ifndef BODY_COORDINATES
#define BODY_COORDINATES NULL
#endif
#ifndef RESIDUAL
#define RESIDUAL residual
#endif
#ifndef JACOBIAN
#define JACOBIAN jacobian
#endif
#ifndef SECOND_ORDER
#define SECOND_ORDER residual
#endif
#ifndef SECOND_FRAME
#define SECOND_FRAME KOPPEL_PARAMETER_FRAME
#endif
#ifndef SECOND_REQUIRED
#define SECOND_REQUIRED 1
#endif
#ifndef CONSTRAINT_ROWS
#define CONSTRAINT_ROWS 1
#endif
#ifndef ROW_NAME
#define ROW_NAME "row"
#endif
#ifndef ROW_UNIT
#define ROW_UNIT "m"
#endif
#ifndef EVALUATE
#define EVALUATE evaluate
#endif

/* ---- the force: on one frame and on coordinates, with two internal states */
#ifndef FORCE_SIZE
#define FORCE_SIZE sizeof(koppel_force_type)
#endif
#ifndef ACT
#define ACT act
#endif
#ifndef ACT_STATUS
#define ACT_STATUS KOPPEL_OK
#endif
#ifndef ACT_NUMBER
#define ACT_NUMBER 1.0
#endif
#ifndef ACT_WRITES
#define ACT_WRITES 1
#endif
#ifndef SUBJECT_KINDS
#define SUBJECT_KINDS KOPPEL_PARAMETER_FRAME, KOPPEL_PARAMETER_COORDINATES, KOPPEL_PARAMETER_REAL
#endif
#ifndef ON_REQUIRED
#define ON_REQUIRED 1
#endif
#ifndef STATES
#define STATES states
#endif
#ifndef STATE_COUNT
#define STATE_COUNT 2
#endif
#ifndef STATE_NAME
#define STATE_NAME "state"
#endif
#ifndef STATE_UNIT
#define STATE_UNIT "m"
#endif
#ifndef INITIAL_NUMBER
#define INITIAL_NUMBER 0.5
#endif
#ifndef ENERGY
#define ENERGY energy
#endif
#ifndef ENERGY_STATUS
#define ENERGY_STATUS KOPPEL_OK
#endif
#ifndef ENERGY_NUMBER
#define ENERGY_NUMBER 2.0
#endif
#ifndef DISSIPATION_NUMBER
#define DISSIPATION_NUMBER 3.0
#endif
#ifndef SWITCHES
#define SWITCHES switches
#endif
#ifndef SWITCH_COUNT
#define SWITCH_COUNT 1
#endif
#ifndef SWITCH_NUMBER
#define SWITCH_NUMBER 4.0
#endif

#define SIZED(type) .struct_size = (uint32_t)sizeof(type)

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  (void)values;
  if (CREATE_STATUS < 0 && CREATE_SPEAKS) host->reject(host->context, "second", "is not to my taste", "try 7");
  *instance = NULL;
  return CREATE_STATUS;
}

koppel_status motions(const void* instance, koppel_motion* out) {
  koppel_motion moved = {.struct_size = (uint32_t)(MOTION_SIZE), .kind = MOTION_KIND, .coordinate = MOTION_COORDINATE};
  koppel_motion along = {SIZED(koppel_motion), .kind = KOPPEL_MOTION_TRANSLATION, .coordinate = 1, .axis = {1, 0, 0}};
  int i;
  (void)instance;
  moved.axis[2] = AXIS_Z;
  moved.point[0] = POINT_X;
  moved.pitch = PITCH;
  for (i = 0; i < MOTION_COUNT; ++i) out[i] = i == 0 ? moved : along;
  return MOTIONS_STATUS;
}

koppel_status pose(size_t count, const void* const* instances, const double* q, double* out) {
  size_t i;
  (void)instances;
  (void)q;
  for (i = 0; i < 12 * count; ++i) out[i] = i % 12 < 9 && i % 12 % 4 == 0 ? POSE_NUMBER : 0;
  return KOPPEL_OK;
}

koppel_status implicit(size_t count, const void* const* instances, const double* at, double* r, double* j) {
  (void)count, (void)instances, (void)at, (void)r, (void)j;
  return KOPPEL_OK;
}

koppel_status coordinates_of(size_t count, const void* const* instances, const double* at, double* q) {
  (void)count, (void)instances, (void)at, (void)q;
  return KOPPEL_OK;
}

koppel_status inertia(size_t count, const void* const* instances, koppel_inertia* out) {
  koppel_inertia none = {SIZED(koppel_inertia)};
  size_t i;
  (void)instances;
  for (i = 0; i < count; ++i) out[i] = none;
  return KOPPEL_OK;
}

koppel_status residual(size_t count, const void* const* instances, const koppel_configuration* at, double* r) {
  (void)instances, (void)at;
  memset(r, 0, count * sizeof *r);
  return KOPPEL_OK;
}

koppel_status jacobian(size_t count, const void* const* instances, const koppel_configuration* at, double* by_twist,
                       double* by_rate) {
  (void)instances, (void)at, (void)by_rate;
  memset(by_twist, 0, 6 * count * sizeof *by_twist);
  return KOPPEL_OK;
}

koppel_status evaluate(size_t count, const void* const* instances, const double* x, double* out) {
  (void)instances, (void)x;
  memset(out, 0, 3 * count * sizeof *out);
  return KOPPEL_OK;
}

koppel_status initial(size_t count, const void* const* instances, double* out) {
  size_t i;
  (void)instances;
  for (i = 0; i < STATE_COUNT * count; ++i) out[i] = INITIAL_NUMBER;
  return KOPPEL_OK;
}

koppel_status act(size_t count, const void* const* instances, const koppel_configuration* at, const double* x,
                  double* wrench, double* effort, double* rates) {
  size_t i;
  (void)instances, (void)x;
  if (!ACT_WRITES) return ACT_STATUS;
  for (i = 0; i < 6 * count && wrench != NULL; ++i) wrench[i] = ACT_NUMBER;
  for (i = 0; i < at->coordinates * count && effort != NULL; ++i) effort[i] = 1;
  for (i = 0; i < 2 * count; ++i) rates[i] = 1;
  return ACT_STATUS;
}

koppel_status energy(size_t count, const void* const* instances, const koppel_configuration* at, const double* x,
                     double* out) {
  size_t i;
  (void)instances, (void)at, (void)x;
  for (i = 0; i < count; ++i) out[i] = ENERGY_NUMBER;
  return ENERGY_STATUS;
}

koppel_status dissipation(size_t count, const void* const* instances, const koppel_configuration* at, const double* x,
                          double* out) {
  size_t i;
  (void)instances, (void)at, (void)x;
  for (i = 0; i < count; ++i) out[i] = DISSIPATION_NUMBER;
  return KOPPEL_OK;
}

koppel_status switches(size_t count, const void* const* instances, const koppel_configuration* at, const double* x,
                       double* out) {
  size_t i;
  (void)instances, (void)at, (void)x;
  for (i = 0; i < count; ++i) out[i] = SWITCH_NUMBER;
  return KOPPEL_OK;
}

const double fallback = FALLBACK;
const double minimum = MINIMUM;
const koppel_parameter parameters[] = {
    {.struct_size = (uint32_t)(PARAMETER_SIZE), .kind = KOPPEL_PARAMETER_REAL, .name = "first"},
    {.struct_size = (uint32_t)(PARAMETER_SIZE),
     .kind = PARAMETER_KIND,
     .name = PARAMETER_NAME,
     .count_min = COUNT_MIN,
     .count_max = COUNT_MAX,
     .fallback = &fallback,
     .minimum = &minimum}};
const koppel_coordinate coordinates[] = {{SIZED(koppel_coordinate), .kind = KOPPEL_BLOCK_ANGLE, .name = "angle"},
                                         {SIZED(koppel_coordinate), .kind = COORDINATE_KIND, .name = COORDINATE_NAME}};
const koppel_row rows[] = {{SIZED(koppel_row), .name = ROW_NAME, .unit = ROW_UNIT},
                           {SIZED(koppel_row), .name = "row1", .unit = "m"},
                           {SIZED(koppel_row), .name = "row2", .unit = "m"},
                           {SIZED(koppel_row), .name = "row3", .unit = "m"}};

const koppel_type joint_type = {.struct_size = (uint32_t)(TYPE_SIZE),
                                .name = TYPE_NAME,
                                .parameters = PARAMETERS,
                                .parameter_count = PARAMETER_COUNT,
                                .create = CREATE};
const koppel_joint_type joint = {.struct_size = (uint32_t)(JOINT_SIZE),
                                 .type = JOINT_TYPE,
                                 .coordinates = COORDINATES,
                                 .coordinate_count = 2,
                                 .motions = MOTIONS,
                                 .pose = POSE,
                                 .rows = rows,
                                 .row_count = ROW_COUNT,
                                 .implicit = IMPLICIT,
                                 .coordinates_of = COORDINATES_OF};

const koppel_type body_type = {SIZED(koppel_type), .name = "bad.body"};
const koppel_body_type body = {SIZED(koppel_body_type), .type = &body_type, .inertia = INERTIA,
                               .coordinates = BODY_COORDINATES};

const koppel_parameter frames[] = {
    {SIZED(koppel_parameter), .kind = KOPPEL_PARAMETER_FRAME, .name = "from", .required = 1},
    {SIZED(koppel_parameter), .kind = SECOND_FRAME, .name = "to", .required = SECOND_REQUIRED}};
const koppel_type constraint_type = {SIZED(koppel_type), .name = "bad.constraint", .parameters = frames,
                                     .parameter_count = 2};
const koppel_constraint_type constraint = {
    SIZED(koppel_constraint_type), .type = &constraint_type, .rows = rows,
    .row_count = CONSTRAINT_ROWS,  .residual = RESIDUAL,     .jacobian = JACOBIAN,
    .second_order = SECOND_ORDER};

const koppel_type function_type = {SIZED(koppel_type), .name = "bad.function"};
const koppel_function_type function = {SIZED(koppel_function_type), .type = &function_type, .evaluate = EVALUATE};

const int32_t kinds[] = {SUBJECT_KINDS};
koppel_parameter subjects[] = {
    {SIZED(koppel_parameter), .name = "on", .required = ON_REQUIRED},
    {SIZED(koppel_parameter), .name = "of"},
    {SIZED(koppel_parameter), .name = "with"},
};
const koppel_internal_state states[] = {{SIZED(koppel_internal_state), .name = "wear", .unit = "m"},
                                        {SIZED(koppel_internal_state), .name = STATE_NAME, .unit = STATE_UNIT}};
const koppel_type force_type = {SIZED(koppel_type), .name = "bad.force", .parameters = subjects, .parameter_count = 3};
const koppel_force_type force = {.struct_size = (uint32_t)(FORCE_SIZE),
                                 .type = &force_type,
                                 .states = STATES,
                                 .state_count = STATE_COUNT,
                                 .initial = initial,
                                 .evaluate = ACT,
                                 .energy = ENERGY,
                                 .dissipation = dissipation,
                                 .switch_count = SWITCH_COUNT,
                                 .switches = SWITCHES};

#ifdef UNRESOLVED
extern double nobody_defines_this(void);
double call_it(void);
double call_it(void) { return nobody_defines_this(); }
#endif

koppel_status init(const koppel_host* host) {
  if (INIT_STATUS < 0) host->reject(host->context, NULL, "no licence for today", "come back tomorrow");
  return INIT_STATUS;
}

const void* type_table(const char* interface_id, size_t index) {
  if (index < FIRST_TABLE || index > LAST_TABLE) return NULL;
  if (strcmp(interface_id, KOPPEL_JOINT_INTERFACE) == 0) return &joint;
  if (strcmp(interface_id, KOPPEL_BODY_INTERFACE) == 0) return &body;
  if (strcmp(interface_id, KOPPEL_CONSTRAINT_INTERFACE) == 0) return &constraint;
  if (strcmp(interface_id, KOPPEL_FUNCTION_INTERFACE) == 0) return &function;
  if (strcmp(interface_id, KOPPEL_FORCE_INTERFACE) == 0) {
    size_t i;
    for (i = 0; i < 3; ++i) subjects[i].kind = kinds[i];
    return &force;
  }
  return NULL;
}

extern KOPPEL_EXPORT const koppel_plugin_entry ENTRY;
const koppel_plugin_entry ENTRY = {.struct_size = (uint32_t)(ENTRY_SIZE),
                                   .abi = {MAJOR, MINOR, KOPPEL_ABI_PATCH},
                                   .name = VENDOR,
                                   .init = init,
                                   .type_table = TYPE_TABLE};

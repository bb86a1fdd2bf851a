/* koppel/plugin.h - extend koppel: joints, bodies, constraints, functions and forces as plugins.
 *
 * A plugin is a shared library (or a linked-in object) that exports one object, `koppel_plugin`, of type
 * koppel_plugin_entry. Nothing happens when it is loaded; the engine calls the entry's functions.
 *
 * Words used everywhere
 * - Units are SI, angles radians. A pose is 12 doubles: the rotation matrix row by row (it maps components of the
 *   second frame into the first), then the position of the second origin in the first frame.
 * - A twist is 6 doubles [angular; linear], taken at a named origin and in named axes.
 * - Every struct that may grow starts with its size. The writer sets struct_size = sizeof(the struct); the reader
 *   treats what lies beyond as zero. An array of such structs has the struct_size of its first element as stride.
 * - A capability is a function pointer that is not NULL.
 * - Callbacks that evaluate take `count` instances at once; each array argument holds the items one after another.
 *   They may be called from several threads at the same time: instances hold parameters only and do not change.
 * - No function of a plugin throws.
 * - Strings and tables that a plugin hands out live as long as the library; what the engine hands in lives until the
 *   call returns.
 */
#ifndef KOPPEL_PLUGIN_H
#define KOPPEL_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of these two headers. Major: breaks. Minor: adds. */
#define KOPPEL_ABI_MAJOR 0u
#define KOPPEL_ABI_MINOR 1u
#define KOPPEL_ABI_PATCH 0u

typedef struct koppel_version {
  uint32_t major;
  uint32_t minor;
  uint32_t patch;
} koppel_version;

/* 0: fine. Above 0: usable, with remarks (bits). Below 0: no result, outputs untouched. */
typedef int32_t koppel_status;
enum {
  KOPPEL_OK = 0,
  KOPPEL_REDUNDANT = 1,      /* closed; some equations say the same as others */
  KOPPEL_BRANCH_CHANGED = 2, /* closed, but only by a jump from the last position */
  KOPPEL_NEAR_SINGULAR = 4,  /* closed; the position is badly conditioned */
  KOPPEL_LIMIT_EXCEEDED = 8, /* closed; a coordinate lies outside its limits */
  KOPPEL_CHANGE_POINT = 16,  /* closed; a position where branches meet was passed on the branch asked for */
  KOPPEL_RETRY = -1,         /* state untouched; a smaller step may succeed */
  KOPPEL_INVALID_ARGUMENT = -2,
  KOPPEL_INVALID_SCENE = -3, /* the diagnostics say where and why */
  KOPPEL_NOT_CLOSED = -4,    /* no closed position found from this start */
  KOPPEL_SINGULAR = -5,      /* the drives ask for what the mechanism cannot do here */
  KOPPEL_PLUGIN = -6,        /* a plugin is missing, refused or misbehaved */
  KOPPEL_VERSION = -7,
  KOPPEL_IO = -8,
  KOPPEL_NO_MEMORY = -9,
  KOPPEL_INTERNAL = -10
};

enum { KOPPEL_LOG_DEBUG = 0, KOPPEL_LOG_INFO = 1, KOPPEL_LOG_WARNING = 2, KOPPEL_LOG_ERROR = 3 };

/* ------------------------------------------------------------------------------------------------ parameters */

enum {
  KOPPEL_PARAMETER_REAL = 1,       /* `count` numbers, in `unit` */
  KOPPEL_PARAMETER_INTEGER = 2,    /* `count` whole numbers */
  KOPPEL_PARAMETER_BOOLEAN = 3,    /* 0 or 1 */
  KOPPEL_PARAMETER_STRING = 4,     /* text */
  KOPPEL_PARAMETER_VECTOR = 5,     /* 3 numbers, in `unit` */
  KOPPEL_PARAMETER_DIRECTION = 6,  /* unit vector; given like the axis of the joint, arrives in inlet-frame axes */
  KOPPEL_PARAMETER_TABLE = 7,      /* rows of `columns` numbers */
  KOPPEL_PARAMETER_FRAME = 8,      /* a frame to act on; its pose arrives in koppel_configuration */
  KOPPEL_PARAMETER_COORDINATES = 9 /* scalar joint coordinates to act on; their values arrive in koppel_configuration */
};

/* One parameter that a type understands. The engine checks scenes against it before the plugin sees a value. */
typedef struct koppel_parameter {
  uint32_t struct_size;
  int32_t kind;           /* KOPPEL_PARAMETER_REAL ... */
  const char* name;       /* the key in a scene: lower case, digits, underscore */
  const char* unit;       /* "m", "rad", "kg", ...; "" or NULL: a pure number. For TABLE: of the first column */
  const char* doc;        /* one sentence */
  int32_t required;       /* not 0: a scene must give it */
  uint32_t columns;       /* TABLE: numbers in a row */
  uint32_t count_min;     /* REAL, INTEGER, COORDINATES: least and greatest number of entries, */
  uint32_t count_max;     /*   TABLE: of rows; count_max 0: both are 1 (TABLE: any number of rows) */
  const double* fallback; /* used when absent; NULL: absent means a value with count 0 */
  const double* minimum;  /* least allowed value, inclusive; NULL: any */
  const double* maximum;  /* greatest allowed value, inclusive; NULL: any */
} koppel_parameter;

/* One value as it reaches koppel_type.create, in the order of the schema. */
typedef struct koppel_value {
  uint32_t struct_size;
  int32_t given;       /* 1: the scene gave it. 0: fallback, or absent */
  const double* reals; /* count numbers (TABLE: row by row); integers and booleans too */
  size_t count;        /* 0: absent. FRAME: 1. COORDINATES: how many */
  const char* text;    /* STRING only, else NULL */
} koppel_value;

/* ------------------------------------------------------------------------------------------------ host */

/* What the engine offers to a plugin. Valid during the call that it was passed to. */
typedef struct koppel_host {
  uint32_t struct_size;
  koppel_version version;
  void* context; /* pass it back as first argument */
  void (*log)(void* context, int32_t severity, const char* message);
  /* Called by create() before it returns an error: why, and what to write instead. `parameter`: name or NULL. */
  void (*reject)(void* context, const char* parameter, const char* message, const char* advice);
} koppel_host;

/* ------------------------------------------------------------------------------------------------ types */

/* What every type has, whatever its kind. */
typedef struct koppel_type {
  uint32_t struct_size;
  const char* name;    /* "vendor.type"; names without a dot belong to koppel */
  const char* summary; /* one sentence */
  const koppel_parameter* parameters;
  size_t parameter_count;
  /* Builds an instance from checked values (parameter_count of them). May be NULL if there is nothing to keep:
   * then instances are NULL. KOPPEL_OK and *instance set, or below 0 after host->reject. */
  koppel_status (*create)(const koppel_host* host, const koppel_value* values, void** instance);
  void (*destroy)(void* instance); /* NULL: nothing to free */
} koppel_type;

/* ---- joints: "koppel.joint/0" ---------------------------------------------------------------------------------
 * A joint lets an outlet frame move relative to an inlet frame; both coincide where all coordinates are zero. */

enum {
  KOPPEL_BLOCK_LINE = 1,  /* 1 number [m], 1 rate */
  KOPPEL_BLOCK_ANGLE = 2, /* 1 number [rad], not wrapped, 1 rate */
  KOPPEL_BLOCK_QUATERNION =
      3, /* 4 numbers w x y z; 3 rates: angular velocity, outlet relative to inlet, in outlet axes */
  KOPPEL_BLOCK_UNIT_VECTOR = 4 /* 3 numbers; 2 rates along the tangent vectors that koppel.h documents */
};

/* A block of coordinates. Rates are numbered in the order of the blocks. */
typedef struct koppel_coordinate {
  uint32_t struct_size;
  int32_t kind;
  const char* name;
} koppel_coordinate;

enum {
  KOPPEL_MOTION_ROTATION = 1,     /* about the axis, by an ANGLE */
  KOPPEL_MOTION_TRANSLATION = 2,  /* along the axis, by a LINE */
  KOPPEL_MOTION_SCREW = 3,        /* about the axis by an ANGLE and along it by pitch times the angle */
  KOPPEL_MOTION_FREE_ROTATION = 4 /* about the point, by a QUATERNION */
};

/* An elementary motion. Axis and point are constant in the frame that the motions before it have produced. */
typedef struct koppel_motion {
  uint32_t struct_size;
  int32_t kind;
  uint32_t coordinate; /* the block that moves it; each block moves exactly one motion */
  double axis[3];      /* unit length; not used by FREE_ROTATION */
  double point[3];     /* [m] a point on the axis; not used by TRANSLATION */
  double pitch;        /* [m/rad] SCREW only */
} koppel_motion;

/* A scalar equation: what it is called and how it is measured. */
typedef struct koppel_row {
  uint32_t struct_size;
  const char* name;
  const char* unit; /* "m" rows are divided by the length of the scene, all others are taken as they are */
} koppel_row;

/* A joint is data, where its motion is a product of elementary motions: motions() alone says all. Other joints give
 * pose(), and as much of the rest as they can; what they leave out, the engine forms numerically. */
typedef struct koppel_joint_type {
  uint32_t struct_size;
  const koppel_type* type;
  const koppel_coordinate* coordinates;
  size_t coordinate_count;

  /* Product joints: writes one motion for each coordinate block, in the order in which they act. */
  koppel_status (*motions)(const void* instance, koppel_motion* out);

  /* Other joints. q: as many numbers as the blocks have; pose: of the outlet in the inlet. */
  koppel_status (*pose)(size_t count, const void* const* instances, const double* q, double* pose);
  /* S, 6 x nv column by column: twist of the outlet relative to the inlet, outlet axes, at the outlet origin. */
  koppel_status (*subspace)(size_t count, const void* const* instances, const double* q, double* subspace);
  /* dS(q; u, w): the derivative of S(q) w along the rates u; bilinear in u and w, 6 numbers. */
  koppel_status (*bias)(size_t count, const void* const* instances, const double* q, const double* u, const double* w,
                        double* bias);
  /* Implicit face, for loops that are cut here: 6 - nv residuals that vanish where the joint allows the pose, and
   * their derivative (row_count x 6, row by row) along the twist of the outlet relative to the inlet, outlet axes, at
   * the outlet origin. Needs coordinates_of as well. */
  const koppel_row* rows;
  size_t row_count;
  koppel_status (*implicit)(size_t count, const void* const* instances, const double* pose, double* residual,
                            double* jacobian);
  /* The coordinates of an allowed pose; q holds the last known values on entry (angles continue from there). */
  koppel_status (*coordinates_of)(size_t count, const void* const* instances, const double* pose, double* q);
} koppel_joint_type;

/* ---- bodies: "koppel.body/0" ------------------------------------------------------------------------------------ */

typedef struct koppel_inertia {
  uint32_t struct_size;
  double mass;              /* [kg] */
  double centre_of_mass[3]; /* [m] in the body frame */
  double about_origin[6];   /* [kg m^2] xx yy zz xy xz yz of the inertia tensor about the body frame's origin */
} koppel_inertia;

typedef struct koppel_body_type {
  uint32_t struct_size;
  const koppel_type* type;
  koppel_status (*inertia)(size_t count, const void* const* instances, koppel_inertia* out);
  /* Internal coordinates (rotors): they do not move the body frame. Reserved: must be NULL and 0 in /0. */
  const koppel_coordinate* coordinates;
  size_t coordinate_count;
} koppel_body_type;

/* ---- constraints: "koppel.constraint/0" --------------------------------------------------------------------------
 * Equations between two frames (parameters of kind FRAME: none or two), or on joint coordinates (COORDINATES), or
 * both, with explicit time if need be. */

/* Where the instances stand. Item i of each array belongs to instance i. */
typedef struct koppel_configuration {
  uint32_t struct_size;
  double time;        /* [s] */
  const double* pose; /* 12 each: the second frame in the first; NULL without frames */
  const double*
      twist;          /* 6 each: second relative to first, in axes and at the origin of the second; NULL if not asked */
  const double* q;    /* the coordinates, in the order of the parameter */
  const double* v;    /* their rates; NULL if not asked */
  size_t coordinates; /* how many each instance has */
} koppel_configuration;

typedef struct koppel_constraint_type {
  uint32_t struct_size;
  const koppel_type* type;
  const koppel_row* rows;
  size_t row_count;
  /* r, row_count each. No false roots, no vanishing gradient at the root: rotations are measured as axis times angle.
   */
  koppel_status (*residual)(size_t count, const void* const* instances, const koppel_configuration* at,
                            double* residual);
  /* r' = by_twist * twist + by_rate * v + dr/dt. by_twist: row_count x 6, by_rate: row_count x coordinates, row by
   * row; either is NULL where there is nothing of that kind. */
  koppel_status (*jacobian)(size_t count, const void* const* instances, const koppel_configuration* at,
                            double* by_twist, double* by_rate);
  /* dr/dt with everything at rest; NULL: time does not occur. */
  koppel_status (*time_rate)(size_t count, const void* const* instances, const koppel_configuration* at,
                             double* time_rate);
  /* r'' minus the terms that are linear in the derivatives of twist and v. */
  koppel_status (*second_order)(size_t count, const void* const* instances, const koppel_configuration* at,
                                double* second_order);
} koppel_constraint_type;

/* ---- functions: "koppel.function/0" ------------------------------------------------------------------------------ */

typedef struct koppel_function_type {
  uint32_t struct_size;
  const koppel_type* type;
  /* out: value, first and second derivative at each x, 3 numbers each. */
  koppel_status (*evaluate)(size_t count, const void* const* instances, const double* x, double* out);
} koppel_function_type;

/* ---- forces: "koppel.force/0" -------------------------------------------------------------------------------------
 * What acts on one frame or between two (parameters of kind FRAME: none, one, which the ground then answers, or two, of
 * which one may be left out if it is not required), on joint coordinates (COORDINATES), or on both. The configuration's
 * pose and twist are those of the second frame relative to the first; of a single frame relative to the ground. */

/* An internal state: what it is called and how it is measured. The engine integrates it along with the motion. */
typedef struct koppel_internal_state {
  uint32_t struct_size;
  const char* name;
  const char* unit;
} koppel_internal_state;

typedef struct koppel_force_type {
  uint32_t struct_size;
  const koppel_type* type;
  const koppel_internal_state* states;
  size_t state_count;
  /* Where the internal states start, state_count each; NULL: at zero. */
  koppel_status (*initial)(size_t count, const void* const* instances, double* states);
  /* wrench: 6 each, [moment; force] on the second frame, in its axes and about its origin; the opposite acts on the
   * first frame, along the same line. NULL without frames. effort: `coordinates` each, [N m] on angles, [N] on lines,
   * positive in the direction of the rate; NULL without coordinates. state_rates: state_count each; NULL without. */
  koppel_status (*evaluate)(size_t count, const void* const* instances, const koppel_configuration* at,
                            const double* states, double* wrench, double* effort, double* state_rates);
  /* Potential energy [J] at a position: twist and v are NULL. A type that gives it is a store: what flows into it can
   * be had back, except for what it says to dissipate. NULL: whatever the force does is work from outside. */
  koppel_status (*energy)(size_t count, const void* const* instances, const koppel_configuration* at,
                          const double* states, double* energy);
  /* Power [W] that is lost in it, of a type with energy: the power of its wrench and efforts is minus the rate of the
   * energy, minus this. NULL: nothing is lost. */
  koppel_status (*dissipation)(size_t count, const void* const* instances, const koppel_configuration* at,
                               const double* states, double* power);
  /* Numbers whose change of sign marks a kink or jump of the force, as when a stop is met: integration steps end there.
   * switch_count each. */
  size_t switch_count;
  koppel_status (*switches)(size_t count, const void* const* instances, const koppel_configuration* at,
                            const double* states, double* values);
} koppel_force_type;

/* ------------------------------------------------------------------------------------------------ entry */

#define KOPPEL_JOINT_INTERFACE "koppel.joint/0"
#define KOPPEL_BODY_INTERFACE "koppel.body/0"
#define KOPPEL_CONSTRAINT_INTERFACE "koppel.constraint/0"
#define KOPPEL_FUNCTION_INTERFACE "koppel.function/0"
#define KOPPEL_FORCE_INTERFACE "koppel.force/0"

typedef struct koppel_plugin_entry {
  uint32_t struct_size;
  koppel_version abi; /* KOPPEL_ABI_MAJOR, _MINOR, _PATCH that it was compiled with */
  const char* name;   /* "vendor" */
  /* Called once before the first use; may refuse a host (KOPPEL_VERSION). NULL: nothing to do. */
  koppel_status (*init)(const koppel_host* host);
  void (*deinit)(void); /* called when the last handle that needs the plugin is freed; NULL: nothing to do */
  /* The index-th type table of an interface: const koppel_joint_type * for KOPPEL_JOINT_INTERFACE and so on. NULL
   * past the last one, and for interfaces that the plugin does not know. */
  const void* (*type_table)(const char* interface_id, size_t index);
} koppel_plugin_entry;

#if defined(_WIN32)
#define KOPPEL_EXPORT __declspec(dllexport)
#else
#define KOPPEL_EXPORT __attribute__((visibility("default")))
#endif

/* The exported object. A program that links several plugins gives each a name of its own with
 * -DKOPPEL_PLUGIN_SYMBOL=name. */
#ifndef KOPPEL_PLUGIN_SYMBOL
#define KOPPEL_PLUGIN_SYMBOL koppel_plugin
#endif
#define KOPPEL_PLUGIN_SYMBOL_NAME "koppel_plugin"
extern KOPPEL_EXPORT const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL;

#ifdef __cplusplus
}
#endif
#endif /* KOPPEL_PLUGIN_H */

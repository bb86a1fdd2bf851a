/* koppel/koppel.h - embed koppel: read a scene, compile a mechanism, close and move it, stream its state. Brings
 * koppel/dynamics.h along: forces, masses, simulation.
 *
 * Rules that hold for every function
 * - It returns a koppel_status: 0 fine, above 0 usable with remarks (bits), below 0 no result and all outputs
 * untouched. Where `error` is not NULL it then holds what went wrong, where, and what to do.
 * - Handles are made by _create/_open/_from/_compile and freed by the matching _destroy/_close; NULL may be freed.
 *   A handle made from others keeps what it needs of them alive: they may be freed in any order.
 * - A const handle may be used by many threads at once, a non-const one by one thread at a time.
 * - Arrays belong to the caller and hold as many entries as koppel_sizes says; a wrong count is INVALID_ARGUMENT.
 * - Text is UTF-8. A function that writes text takes a buffer and its size and sets *needed to the size of the whole
 *   text with its final zero; it writes as much as fits, always ended by a zero. A NULL buffer only asks for the size.
 * - Units are SI, angles radians; poses, twists and versions as in plugin.h.
 * - Nothing is thrown, nothing is printed; the only callbacks are those that the host registered.
 */
#ifndef KOPPEL_KOPPEL_H
#define KOPPEL_KOPPEL_H

#include "koppel/plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct koppel_engine koppel_engine;           /* plugins and log of one host */
typedef struct koppel_diagnostics koppel_diagnostics; /* a list of findings about a scene */
typedef struct koppel_scene koppel_scene;             /* a checked description */
typedef struct koppel_mechanism koppel_mechanism;     /* a compiled scene; never changes */
typedef struct koppel_state koppel_state;             /* where a mechanism stands */
typedef struct koppel_work koppel_work;               /* scratch memory, one for each thread */
typedef struct koppel_stream koppel_stream;           /* an open LCM stream */

/* ------------------------------------------------------------------------------------------------ errors */

enum { KOPPEL_SEVERITY_NOTE = 0, KOPPEL_SEVERITY_WARNING = 1, KOPPEL_SEVERITY_ERROR = 2 };

typedef struct koppel_error {
  uint32_t struct_size;
  int32_t status;   /* the koppel_status that goes with it */
  int32_t severity; /* KOPPEL_SEVERITY_NOTE ... */
  int32_t line;     /* from 1; 0: no place in a file */
  int32_t column;   /* from 1, counted in bytes */
  int32_t length;   /* how many bytes it marks */
  char code[8];     /* "E0304"; koppel_explain_code says more */
  char file[512];
  char source_line[512]; /* the line itself */
  char element[128];     /* what it is about, e.g. "joint crank" */
  char message[512];
  char advice[512]; /* what to do instead; may be empty */
} koppel_error;

/* The long explanation of a code such as "E0304". INVALID_ARGUMENT: no such code. */
KOPPEL_EXPORT koppel_status koppel_explain_code(const char* code, char* text, size_t size, size_t* needed);

/* ------------------------------------------------------------------------------------------------ engine */

typedef struct koppel_engine_options {
  uint32_t struct_size;
  /* Folders, separated by ':', that are searched for plugins. NULL: the environment variable KOPPEL_PLUGIN_PATH. */
  const char* plugin_path;
  /* A folder with the standard plugins as shared objects, to be used instead of the linked-in ones. NULL: the
   * environment variable KOPPEL_STANDARD_PLUGINS, or if that is unset the linked-in ones. */
  const char* standard_plugins;
  /* Receives log lines of at least log_level; may be called from the stream's thread too,
   * and must not call the library. It and log_context must outlive every handle made with the engine. NULL: no logging.
   */
  void (*log)(void* context, int32_t level, const char* message);
  void* log_context;
  int32_t log_level; /* KOPPEL_LOG_DEBUG ... */
} koppel_engine_options;

/* The version of this library. */
KOPPEL_EXPORT koppel_version koppel_library_version(void);

/* wanted_major, wanted_minor: KOPPEL_ABI_MAJOR and KOPPEL_ABI_MINOR of the header the host was compiled with. VERSION:
 * the library has another major version or an older minor one. options: NULL for defaults. */
KOPPEL_EXPORT koppel_status koppel_engine_create(uint32_t wanted_major, uint32_t wanted_minor,
                                                 const koppel_engine_options* options, koppel_engine** engine,
                                                 koppel_error* error);
KOPPEL_EXPORT void koppel_engine_destroy(koppel_engine* engine);
/* Adds the types of a plugin that is linked into the host. The entry must outlive everything made with the engine. */
KOPPEL_EXPORT koppel_status koppel_engine_add_plugin(koppel_engine* engine, const koppel_plugin_entry* entry,
                                                     koppel_error* error);
/* Loads a shared object now instead of when a scene names it. */
KOPPEL_EXPORT koppel_status koppel_engine_load_plugin(koppel_engine* engine, const char* path, koppel_error* error);

/* ------------------------------------------------------------------------------------------------ diagnostics */

KOPPEL_EXPORT koppel_status koppel_diagnostics_create(koppel_diagnostics** diagnostics);
KOPPEL_EXPORT void koppel_diagnostics_destroy(koppel_diagnostics* diagnostics);
KOPPEL_EXPORT size_t koppel_diagnostics_count(const koppel_diagnostics* diagnostics);
KOPPEL_EXPORT koppel_status koppel_diagnostics_get(const koppel_diagnostics* diagnostics, size_t index,
                                                   koppel_error* finding);
/* All of them as text for a terminal: place, line, caret, advice. */
KOPPEL_EXPORT koppel_status koppel_diagnostics_render(const koppel_diagnostics* diagnostics, char* text, size_t size,
                                                      size_t* needed);

/* ------------------------------------------------------------------------------------------------ scene */

/* Reads and checks a scene. Every finding goes into `diagnostics` (may be NULL); `error` gets the first error. */
KOPPEL_EXPORT koppel_status koppel_scene_from_file(koppel_engine* engine, const char* path,
                                                   koppel_diagnostics* diagnostics, koppel_scene** scene,
                                                   koppel_error* error);
/* The same from text. directory: what relative file names in it refer to; NULL: they are errors. */
KOPPEL_EXPORT koppel_status koppel_scene_from_text(koppel_engine* engine, const char* text, size_t length,
                                                   const char* directory, koppel_diagnostics* diagnostics,
                                                   koppel_scene** scene, koppel_error* error);
KOPPEL_EXPORT void koppel_scene_destroy(koppel_scene* scene);

/* ------------------------------------------------------------------------------------------------ mechanism */

KOPPEL_EXPORT koppel_status koppel_mechanism_compile(const koppel_scene* scene, koppel_diagnostics* diagnostics,
                                                     koppel_mechanism** mechanism, koppel_error* error);
KOPPEL_EXPORT void koppel_mechanism_destroy(koppel_mechanism* mechanism);

typedef struct koppel_sizes {
  uint32_t struct_size;
  uint32_t bodies; /* ground, number 0, included */
  uint32_t joints;
  uint32_t frames;      /* the named ones */
  uint32_t coordinates; /* numbers in q, of all joints in file order */
  uint32_t rates;       /* numbers in v and in a */
  uint32_t inputs;      /* driven coordinates */
  uint32_t records;     /* columns of recorded output */
  uint32_t loops;       /* independent loops of the graph */
  uint32_t constraints; /* constraint elements, not counting cut joints */
  uint32_t equations;   /* closure equations in all */
  uint32_t unknowns;    /* rates that a closure solves for */
  uint32_t watches;     /* values that a simulation looks out for */
} koppel_sizes;

KOPPEL_EXPORT koppel_status koppel_mechanism_sizes(const koppel_mechanism* mechanism, koppel_sizes* sizes);

typedef struct koppel_settings {
  uint32_t struct_size;
  uint32_t steps;    /* of a run, as the scene proposes */
  double duration;   /* [s] of a run, as the scene proposes */
  double length;     /* [m] characteristic length: residuals in metres are divided by it */
  double gravity[3]; /* [m/s^2] */
  uint64_t hash;     /* of the scene's content */
} koppel_settings;

KOPPEL_EXPORT koppel_status koppel_mechanism_settings(const koppel_mechanism* mechanism, koppel_settings* settings);

enum {
  KOPPEL_KIND_BODY = 1,
  KOPPEL_KIND_FRAME = 2,
  KOPPEL_KIND_JOINT = 3,
  KOPPEL_KIND_COORDINATE = 4, /* "joint.coordinate"; of a quaternion block "joint.coordinate.w" and so on */
  KOPPEL_KIND_RATE = 5,
  KOPPEL_KIND_INPUT = 6,
  KOPPEL_KIND_RECORD = 7,
  KOPPEL_KIND_EQUATION = 8,
  KOPPEL_KIND_SCENE = 9, /* index 0: name, 1: title */
  KOPPEL_KIND_WATCH = 10
};

/* Name and unit of the index-th thing of a kind. Units: "m", "rad", "m/s", "1", ...; bodies and frames have "". */
KOPPEL_EXPORT koppel_status koppel_mechanism_name(const koppel_mechanism* mechanism, int32_t kind, size_t index,
                                                  char* text, size_t size, size_t* needed);
KOPPEL_EXPORT koppel_status koppel_mechanism_unit(const koppel_mechanism* mechanism, int32_t kind, size_t index,
                                                  char* text, size_t size, size_t* needed);
/* INVALID_ARGUMENT if there is none; the error then proposes the nearest name. */
KOPPEL_EXPORT koppel_status koppel_mechanism_find(const koppel_mechanism* mechanism, int32_t kind, const char* name,
                                                  size_t* index, koppel_error* error);

/* What the scene wishes of a coordinate at the start. */
enum { KOPPEL_START_FREE = 0, KOPPEL_START_PREFERRED = 1, KOPPEL_START_FIXED = 2 };
/* value [rad, m]: untouched if the coordinate is free, or driven. */
KOPPEL_EXPORT koppel_status koppel_mechanism_start(const koppel_mechanism* mechanism, size_t coordinate, int32_t* wish,
                                                   double* value);

enum { KOPPEL_CUT_JOINT = 1, KOPPEL_CUT_BODY = 2, KOPPEL_CUT_NONE = 3 };

/* One block of closure equations: a loop (the first `loops` of them), or a constraint. */
typedef struct koppel_closure {
  uint32_t struct_size;
  int32_t kind;            /* where the loop is cut, or KOPPEL_CUT_NONE */
  int32_t joint;           /* the joint that closes the loop; -1 for a constraint */
  uint32_t first_equation; /* its equations are neighbours */
  uint32_t equations;
  uint32_t path; /* how many tree joints its equations depend on */
} koppel_closure;

/* index: below loops + constraints. path: NULL, or room for `path` joint numbers. */
KOPPEL_EXPORT koppel_status koppel_mechanism_closure(const koppel_mechanism* mechanism, size_t index,
                                                     koppel_closure* closure, uint32_t* path, size_t count);

/* What was built and what was left out, how each loop is cut, equations and unknowns: a page of text. */
KOPPEL_EXPORT koppel_status koppel_mechanism_explain(const koppel_mechanism* mechanism, char* text, size_t size,
                                                     size_t* needed);

/* Mass, centre and inertia of a body about its frame, as its plugin tells. */
KOPPEL_EXPORT koppel_status koppel_body_inertia(const koppel_mechanism* mechanism, size_t body, koppel_inertia* inertia,
                                                koppel_error* error);

/* ------------------------------------------------------------------------------------------------ state */

/* A state at time 0 with the scene's start values; not closed yet. PLUGIN: a drive has no finite value at time 0. */
KOPPEL_EXPORT koppel_status koppel_state_create(const koppel_mechanism* mechanism, koppel_state** state);
KOPPEL_EXPORT void koppel_state_destroy(koppel_state* state);
/* Both must belong to the same mechanism. */
KOPPEL_EXPORT koppel_status koppel_state_copy(const koppel_state* from, koppel_state* to);

enum { KOPPEL_Q = 1, KOPPEL_V = 2, KOPPEL_A = 3 };

/* q holds `coordinates` numbers, v and a `rates`. Cut joints' values included, angles not wrapped. Rates of a unit
 * vector n are along the x and y axes as they stand after the shortest turn that takes z to n; at n = -z along x, -y.
 */
KOPPEL_EXPORT koppel_status koppel_state_get(const koppel_state* state, int32_t what, double* values, size_t count);
/* Sets a start for the next close, of all coordinates; quaternions are normalised. The inputs keep their values. */
KOPPEL_EXPORT koppel_status koppel_state_set(koppel_state* state, int32_t what, const double* values, size_t count);
/* Names of the coordinates that lie outside the limits the scene gives them, one in a line; "" if there are none. */
KOPPEL_EXPORT koppel_status koppel_limits_exceeded(const koppel_state* state, char* text, size_t size, size_t* needed);
/* Moves to a time: every input takes value, rate and acceleration from its drive. */
KOPPEL_EXPORT koppel_status koppel_state_set_time(koppel_state* state, double time, koppel_error* error);
KOPPEL_EXPORT double koppel_state_time(const koppel_state* state);
/* Sets one input by hand (until the next set_time). */
KOPPEL_EXPORT koppel_status koppel_state_set_input(koppel_state* state, size_t input, double value, double rate,
                                                   double acceleration);

/* ------------------------------------------------------------------------------------------------ closing and moving
 */

KOPPEL_EXPORT koppel_status koppel_work_create(const koppel_mechanism* mechanism, koppel_work** work);
KOPPEL_EXPORT void koppel_work_destroy(koppel_work* work);

enum {
  KOPPEL_VERDICT_OPEN = 0,       /* nothing to close */
  KOPPEL_VERDICT_CLOSED = 1,     /* closed; REDUNDANT and NEAR_SINGULAR stand in the status */
  KOPPEL_VERDICT_NOT_FOUND = 2,  /* no closed position found from this start */
  KOPPEL_VERDICT_RETRY = 3,      /* the step was too large: halve it */
  KOPPEL_VERDICT_LIMIT = 4,      /* an input goes no further: limit_input and what follows it tell where */
  KOPPEL_VERDICT_UNREACHABLE = 5 /* there is no closed position for these inputs, and that is certain */
};

enum { KOPPEL_SOLVER_NONE = 0, KOPPEL_SOLVER_NEWTON = 1, KOPPEL_SOLVER_CERES = 2, KOPPEL_SOLVER_FLOW = 3 };

/* How a closure went. */
typedef struct koppel_report {
  uint32_t struct_size;
  int32_t verdict;
  int32_t solver;      /* the last that was used; NONE: the state was closed already */
  uint32_t iterations; /* of all solvers together */
  uint32_t rank;       /* of the equations, with respect to the unknowns */
  uint32_t equations;
  uint32_t unknowns;
  double residual;  /* greatest equation, metres divided by the scene's length, radians as they are */
  double condition; /* ratio of extreme singular values (of those that count), estimated within a factor of 2; of FLOW
                       greatest ratio of a condition's amplitude to its slope */
  double coordinate_error;  /* estimated greatest error of an unknown (radians, or metres over the scene's length) */
  uint32_t change_points;   /* positions where branches meet that were passed; CHANGE_POINT stands in the status */
  int32_t limit_input;      /* the input that goes no further: of LIMIT, or passed by koppel_follow; -1: none */
  double change_point_time; /* time of the drives [s] of the last of them */
  double limit_time;        /* time of the drives [s] at the limit */
  double limit_value;       /* of the input there, located to 1e-9 */
  int32_t drive_instead;    /* the coordinate that moves most there; -1: none */
  uint32_t limits;          /* passed by koppel_follow */
  double pace;              /* of koppel_follow: time of the drives that goes by in a unit of the path, at its end */
} koppel_report;

/* AUTO: a closed state goes on along the solution flow; where that does not do, Newton, then Ceres, last all solutions
 * of the flow. FLOW: these alone. */
enum { KOPPEL_METHOD_AUTO = 0, KOPPEL_METHOD_NEWTON = 1, KOPPEL_METHOD_CERES = 2, KOPPEL_METHOD_FLOW = 3 };

typedef struct koppel_close_options {
  uint32_t struct_size;
  int32_t method;
  uint32_t max_iterations; /* 0: 50 for Newton, 500 for Ceres */
  double tolerance;        /* of the residual; 0: down to rounding; nothing above 1e-10 counts as closed */
} koppel_close_options;

/* Closes the loops with the inputs held at their values. A state that is closed stays as it is, bit for bit; if it
 * fails the state is untouched, and the report tells how near it came. options and report may be NULL. */
KOPPEL_EXPORT koppel_status koppel_close(koppel_state* state, koppel_work* work, const koppel_close_options* options,
                                         koppel_report* report, koppel_error* error);
/* Rates of a closed state from the rates of its inputs; free motions get the least norm. */
KOPPEL_EXPORT koppel_status koppel_velocities(koppel_state* state, koppel_work* work, koppel_error* error);
/* Accelerations; the velocities must have been computed. */
KOPPEL_EXPORT koppel_status koppel_accelerations(koppel_state* state, koppel_work* work, koppel_error* error);
/* One step of a run: set_time, close, velocities, accelerations. Steps too large are halved inside, and no further than
 * 2^-12; after a failure the state is as before. */
KOPPEL_EXPORT koppel_status koppel_move(koppel_state* state, koppel_work* work, double time, koppel_report* report,
                                        koppel_error* error);

enum { KOPPEL_BRANCH_STAY = 0, KOPPEL_BRANCH_TAKE = 1 };

typedef struct koppel_motion_options {
  uint32_t struct_size;
  int32_t branch; /* past a change point: STAY goes on as the motion came, TAKE takes the other branch */
  double speed;   /* of koppel_follow: path length in a unit of its `duration`; 0: that which the state has */
} koppel_motion_options;

/* koppel_move on the branch that is asked for. options: NULL for defaults. */
KOPPEL_EXPORT koppel_status koppel_move_on(koppel_state* state, koppel_work* work, double time,
                                           const koppel_motion_options* options, koppel_report* report,
                                           koppel_error* error);
/* Moves a closed state along its curve of closed positions, past the limits of its drives: there their time turns back
 * (koppel_state_time; it stands in the report too, with its pace) while the mechanism goes on. duration: of a path
 * parameter that runs with the arc length of the curve (radians, lengths over the scene's length, over the speed).
 * Velocities and accelerations are those by this parameter. The next koppel_follow goes on in the same direction.
 * NOT_CLOSED: the curve could not be followed, or is longer than some 200 radians in one call. INVALID_ARGUMENT: the
 * state is not where its drives are, or a constraint of the scene depends on time. */
KOPPEL_EXPORT koppel_status koppel_follow(koppel_state* state, koppel_work* work, double duration,
                                          const koppel_motion_options* options, koppel_report* report,
                                          koppel_error* error);

/* Rates (their numbers in v) that determine all others best at a closed state, as many as there are freedoms: by
 * column-pivoted QR. rates: room for `size` numbers, of which *count are the set so far. It is kept while the ratio of
 * the extreme singular values of all others, *quality, is above 1e-3 or no other set has ten times more; *count 0: the
 * best is chosen. INVALID_ARGUMENT: not closed, no such rates, or too little room; *count is then what it takes, if
 * that is more. quality may be NULL. */
KOPPEL_EXPORT koppel_status koppel_independent(const koppel_state* state, koppel_work* work, uint32_t* rates,
                                               size_t size, size_t* count, double* quality, koppel_error* error);

/* Counts at the present position; singular values are those of the scaled Jacobian of all tree coordinates. */
typedef struct koppel_analysis {
  uint32_t struct_size;
  int32_t mobility_count; /* Gruebler, spatial */
  int32_t mobility_rank;  /* rates minus rank */
  uint32_t rank;
  uint32_t equations;
  uint32_t tree_rates;
  double largest_singular_value;
  double last_singular_value; /* the smallest that counts */
  double gap;                 /* last that counts over first that does not; infinity: none left */
} koppel_analysis;

KOPPEL_EXPORT koppel_status koppel_analyse(const koppel_state* state, koppel_work* work, koppel_analysis* analysis,
                                           koppel_error* error);

/* The freedoms at the present position, inputs taken for free, and why counting them gives what it gives. */
typedef struct koppel_freedoms {
  uint32_t struct_size;
  int32_t mobility_by_kind; /* Gruebler, with the conditions that each loop needs by its kind */
  int32_t mobility_here;    /* by rank */
  int32_t mobility_nearby;  /* by rank at closed positions near by, if any: less in a singular one */
  uint32_t redundant_here;  /* equations that follow from the others */
  uint32_t redundant_nearby;
  uint32_t planar_loops;
  uint32_t spherical_loops;
  uint32_t isolated;      /* freedoms of one body alone, as of a link between two balls */
  uint32_t indeterminate; /* joints whose reactions statics alone does not determine */
  int32_t shaky;          /* 1: gives way here, but has no other closed position near by */
} koppel_freedoms;

/* The state must be closed: INVALID_ARGUMENT. */
KOPPEL_EXPORT koppel_status koppel_find_freedoms(const koppel_state* state, koppel_work* work,
                                                 koppel_freedoms* freedoms, koppel_error* error);
/* The same as a page of text, with names, axes and places; the bodies' screw axes if the state has velocities. */
KOPPEL_EXPORT koppel_status koppel_explain_freedoms(const koppel_state* state, koppel_work* work, char* text,
                                                    size_t size, size_t* needed);

/* ------------------------------------------------------------------------------------------------ flow and modes */

enum { KOPPEL_FLOW_TEXT = 0, KOPPEL_FLOW_DOT = 1 };

/* The solution flow for the mechanism's inputs: the loops, where each is cut, and in which order and how the
 * coordinates follow from the inputs; depends on measures only, not on a position. TEXT: a page of text. DOT: a block
 * diagram in the language of Graphviz. Planned anew in every call. */
KOPPEL_EXPORT koppel_status koppel_flow_explain(const koppel_mechanism* mechanism, int32_t format, char* text,
                                                size_t size, size_t* needed);

typedef struct koppel_modes koppel_modes; /* assembly modes that were found; never changes */

typedef struct koppel_modes_options {
  uint32_t struct_size;
  int32_t all_twins; /* 1: list every position of links that turn over unnoticed, not only if there is one such link */
  uint64_t most;     /* modes; the search ends there. 0: 4096 */
  uint64_t restarts; /* random starts where there is no other way. 0: 2000 */
  /* Called now and then, by the thread that searches, with the modes found and the part done (0 to 1): other than 0
   * stops the search, and what was found is kept. Must not call the library with the same state or work. NULL: none. */
  int32_t (*progress)(size_t found, double part, void* user);
  void* user;
} koppel_modes_options;

typedef struct koppel_modes_summary {
  uint32_t struct_size;
  int32_t complete; /* 1: there are no others. With count 0: the inputs are out of reach */
  uint64_t count;
  uint64_t twins;   /* how many positions each mode stands for: links that turn over unnoticed. 1 if all are listed */
  double missed_by; /* without a mode: how far a condition stays open at best, scaled by the length; 0: not known */
} koppel_modes_summary;

typedef struct koppel_mode {
  uint32_t struct_size;
  int32_t limit;   /* 1: two modes meet here, or nearly */
  double residual; /* greatest equation, metres divided by the scene's length, radians as they are */
} koppel_mode;

/* Finds all closed positions for the state's inputs; what no input determines stays as it is in the state, which need
 * not be closed. None found is no failure. options: NULL for defaults. The modes belong to the caller. PLUGIN: a plugin
 * failed. */
KOPPEL_EXPORT koppel_status koppel_modes_find(const koppel_state* state, koppel_work* work,
                                              const koppel_modes_options* options, koppel_modes** modes,
                                              koppel_error* error);
KOPPEL_EXPORT void koppel_modes_destroy(koppel_modes* modes);
KOPPEL_EXPORT koppel_status koppel_modes_summarise(const koppel_modes* modes, koppel_modes_summary* summary);
/* How it is known that there are no others, or why it is not: a line of text. */
KOPPEL_EXPORT koppel_status koppel_modes_why(const koppel_modes* modes, char* text, size_t size, size_t* needed);
/* index: below count. */
KOPPEL_EXPORT koppel_status koppel_modes_get(const koppel_modes* modes, size_t index, koppel_mode* mode);
/* Its branch, as "1.2.1": which solution was taken in each step of the flow that has several. */
KOPPEL_EXPORT koppel_status koppel_modes_id(const koppel_modes* modes, size_t index, char* text, size_t size,
                                            size_t* needed);
/* Puts a state of the same mechanism there, as a start for koppel_close, which confirms it if the state still has the
 * time and the inputs of the search. */
KOPPEL_EXPORT koppel_status koppel_modes_take(const koppel_modes* modes, size_t index, koppel_state* state);

/* ------------------------------------------------------------------------------------------------ results */

/* what: KOPPEL_KIND_BODY or KOPPEL_KIND_FRAME. poses: 12 numbers each, in the world, of all `bodies` or all `frames`.
 * count, here and below: of numbers, so 12 times the bodies. */
KOPPEL_EXPORT koppel_status koppel_poses(const koppel_state* state, koppel_work* work, int32_t what, double* poses,
                                         size_t count);
/* Twists in world axes, each at its own frame's origin: 6 numbers each. They, accelerations and records are those of
 * the v and a that the state holds: after koppel_close compute them anew first. */
KOPPEL_EXPORT koppel_status koppel_twists(const koppel_state* state, koppel_work* work, int32_t what, double* twists,
                                          size_t count);
/* [angular acceleration; acceleration of the origin] in world axes: 6 numbers each. */
KOPPEL_EXPORT koppel_status koppel_frame_accelerations(const koppel_state* state, koppel_work* work, int32_t what,
                                                       double* accelerations, size_t count);
/* Geometric Jacobian of a body or frame: 6 x rates, row by row, world axes, at its origin; columns of joints that the
 * spanning tree does not use are zero. rate: NULL, or its time derivative at the state's v. */
KOPPEL_EXPORT koppel_status koppel_jacobian(const koppel_state* state, koppel_work* work, int32_t what, size_t index,
                                            double* jacobian, double* rate, size_t count);
/* What joints and drives bear at a closed state, for its v and a and the forces that act: inverse dynamics of trees and
 * loops. wrenches: [moment N m; force N] of each joint, with its drive and the forces on its coordinates, on the body
 * at its outlet (on that at its inlet: the opposite), axes and origin of the outlet frame; 6 numbers each. efforts [N
 * m, N]: one for each rate; what drives deliver, and along rates that nothing drives what is missing to their
 * accelerations: zero where these come from the forces. Where redundant joints leave them undetermined, all loads
 * together are the least possible. determined: NULL, or one byte for each of wrench_count + effort_count numbers; 1:
 * the motion determines it. INVALID_ARGUMENT: not closed, or a count is wrong. */
KOPPEL_EXPORT koppel_status koppel_reactions(const koppel_state* state, koppel_work* work, double* wrenches,
                                             size_t wrench_count, double* efforts, size_t effort_count,
                                             uint8_t* determined, koppel_error* error);
/* The recorded columns, `records` numbers. NaN: an axis that is infinitely far or not there, a transfer function of a
 * drive that cannot move. INVALID_ARGUMENT also: not closed, and a transfer function is recorded. */
KOPPEL_EXPORT koppel_status koppel_records(const koppel_state* state, koppel_work* work, double* values, size_t count);

/* ------------------------------------------------------------------------------------------------ stream */

typedef struct koppel_stream_options {
  uint32_t struct_size;
  const char*
      url; /* LCM provider: "udpm://239.255.76.67:7667?ttl=0", "file:///path?mode=w", "memq://"; NULL: LCM's default */
  const char*
      name;      /* channels are KOPPEL_<NAME>_STATE and so on; NULL: the scene's name. Letters, digits, underscore */
  double period; /* [s] wall clock, least time between two published states; 0: every one */
} koppel_stream_options;

typedef struct koppel_stream_statistics {
  uint32_t struct_size;
  uint32_t reserved;
  uint64_t published; /* states taken from the host */
  uint64_t sent;      /* states that went out */
  uint64_t dropped;   /* states overtaken by newer ones (network only; a file takes every one) */
  uint64_t failed;    /* states that LCM could not send */
} koppel_stream_statistics;

KOPPEL_EXPORT koppel_status koppel_stream_open(const koppel_mechanism* mechanism, const koppel_stream_options* options,
                                               koppel_stream** stream, koppel_error* error);
/* Hands over state, poses and report (NULL: none). Never waits for the network; a file may push back. */
KOPPEL_EXPORT koppel_status koppel_stream_publish(koppel_stream* stream, const koppel_state* state, koppel_work* work,
                                                  const koppel_report* report);
/* Sends a line of text as event. severity: KOPPEL_SEVERITY_NOTE ... */
KOPPEL_EXPORT koppel_status koppel_stream_event(koppel_stream* stream, double time, int32_t severity, const char* text);
/* Sends what is waiting, closes and frees. statistics may be NULL. */
KOPPEL_EXPORT koppel_status koppel_stream_close(koppel_stream* stream, koppel_stream_statistics* statistics);

#ifdef __cplusplus
}
#endif

#include "koppel/dynamics.h"

#endif /* KOPPEL_KOPPEL_H */

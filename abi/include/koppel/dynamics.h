/* koppel/dynamics.h - part of koppel/koppel.h: simulation, equilibrium, linear equations, and the dynamics of trees.
 * The rules that stand there hold here.
 */
#ifndef KOPPEL_DYNAMICS_H
#define KOPPEL_DYNAMICS_H

#include "koppel/koppel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------ simulation */

typedef struct koppel_simulation
    koppel_simulation; /* a motion under forces and drives, with all that it goes on from */

typedef struct koppel_simulation_options {
  uint32_t struct_size;
  uint32_t reserved;
  double
      tolerance; /* of one step: radians, lengths over the scene's, their rates per second; 0: the scene's, or 1e-8 */
  double step;   /* [s] of fixed steps; 0: the scene's, or steps by the tolerance */
  double end;    /* [s] where the last step shall end; 0: the scene's duration after the start */
  const char* integrator;  /* a name that koppel_integrators lists; NULL: the formulation's own, the scene's if it goes
                              with tolerance and step, or "dormand_prince" with a tolerance, "classical" with a step */
  const char* formulation; /* a name that koppel_formulations lists; NULL: the integrator's own, or "minimal" */
} koppel_simulation_options;

/* How it went so far. */
typedef struct koppel_simulation_summary {
  uint32_t struct_size;
  uint32_t freedoms; /* independent coordinates */
  uint32_t switches; /* how often others were chosen */
  uint32_t reserved;
  uint64_t steps;
  uint64_t rejected;
  uint64_t evaluations;
  double energy;         /* [J] kinetic and potential, at the end of the last step */
  double energy_error;   /* [J] greatest change of the energy that no work explains */
  double energy_size;    /* [J] what to compare it with: greatest kinetic energy, and range of the potential one */
  double position_drift; /* greatest closure equation at the end of a step, scaled as koppel_report.residual */
  double velocity_drift; /* greatest rate [1/s] of one */
  double start_change;   /* greatest change of a start rate that the loops did not allow [rad/s, lengths per second] */
  double tolerance;      /* of a step, as it is used; 0: steps are fixed */
  double step;           /* [s] of fixed steps; 0: by the tolerance */
  int32_t stiff;         /* 1: many steps were as short as stability wants them, not accuracy: "cvode" suits better */
  uint32_t events;       /* kinks and jumps of forces at which steps were made to end */
} koppel_simulation_summary;

/* From a closed state on: with its rates if it has them, else with those that the scene asks for, as nearly as the
 * loops allow. options: NULL for defaults. INVALID_ARGUMENT: the state is not closed, or the integrator is not known or
 * lacks its step. NOT_CLOSED: nothing can be computed at the start. */
KOPPEL_EXPORT koppel_status koppel_simulation_create(const koppel_state* state,
                                                     const koppel_simulation_options* options,
                                                     koppel_simulation** simulation, koppel_error* error);
KOPPEL_EXPORT void koppel_simulation_destroy(koppel_simulation* simulation);
/* On to a time not before the last one; the state of the same mechanism comes out there, with velocities and
 * accelerations. NOT_CLOSED: the integration goes no further; PLUGIN: a plugin failed. The state is untouched then, and
 * the same error comes again. */
KOPPEL_EXPORT koppel_status koppel_simulation_advance(koppel_simulation* simulation, double time, koppel_state* state,
                                                      koppel_error* error);

/* Where a value that the scene watches was crossed. */
typedef struct koppel_crossing {
  uint32_t struct_size;
  uint32_t watch; /* among the scene's; KOPPEL_NO_WATCH: none */
  double time;    /* [s] the first at which it lies on the other side, to rounding */
  int32_t rising; /* 1: from below, 0: from above */
  int32_t stop;   /* 1: the scene wants the simulation to end there */
} koppel_crossing;
#define KOPPEL_NO_WATCH UINT32_MAX

/* As koppel_simulation_advance, but no further than to the first crossing of a value that the scene watches: the state
 * comes out there, and the next call goes on. The motion is the same whether it is watched or not. A value that is
 * crossed twice between two calls, or within one step, passes unnoticed. */
KOPPEL_EXPORT koppel_status koppel_simulation_watch(koppel_simulation* simulation, double time, koppel_state* state,
                                                    koppel_crossing* crossing, koppel_error* error);
KOPPEL_EXPORT koppel_status koppel_simulation_summarise(const koppel_simulation* simulation,
                                                        koppel_simulation_summary* summary);
/* Where it stands: the time that was advanced to last, or the start [s]; 0 for NULL. */
KOPPEL_EXPORT double koppel_simulation_time(const koppel_simulation* simulation);
/* All that a simulation goes on from, as bytes: at most `size` of them, and their number in *needed. NULL bytes only
 * ask for the number. What is loaded goes on bit for bit as what was saved; integrators of SUNDIALS start again here,
 * in both. The bytes are of this machine's kind. */
KOPPEL_EXPORT koppel_status koppel_simulation_save(koppel_simulation* simulation, void* bytes, size_t size,
                                                   size_t* needed, koppel_error* error);
/* Goes on from what was saved, with the same scene; advancing to koppel_simulation_time gives the state there.
 * INVALID_ARGUMENT: the bytes are damaged, of another version of the format, or of another scene. */
KOPPEL_EXPORT koppel_status koppel_simulation_load(const koppel_mechanism* mechanism, const void* bytes, size_t size,
                                                   koppel_simulation** simulation, koppel_error* error);
/* The names of the integrator and of the formulation that are used. */
KOPPEL_EXPORT koppel_status koppel_simulation_integrator(const koppel_simulation* simulation, char* text, size_t size,
                                                         size_t* needed);
KOPPEL_EXPORT koppel_status koppel_simulation_formulation(const koppel_simulation* simulation, char* text, size_t size,
                                                          size_t* needed);
/* All integrators, and all formulations of the equations of motion, one in a line: "name: what it is". */
KOPPEL_EXPORT koppel_status koppel_integrators(char* text, size_t size, size_t* needed);
KOPPEL_EXPORT koppel_status koppel_formulations(char* text, size_t size, size_t* needed);

/* ------------------------------------------------------------------------------------------------ equilibrium */

typedef struct koppel_equilibrium koppel_equilibrium; /* a place of rest, or where the search for one ended */

enum { KOPPEL_DRIVES_HELD = 0, KOPPEL_DRIVES_MOVING = 1 };
enum { KOPPEL_SEARCH_SETTLE = 0, KOPPEL_SEARCH_NEAREST = 1 };

typedef struct koppel_equilibrium_options {
  uint32_t struct_size;
  int32_t drives; /* HELD: they stand still; MOVING: they go on, and only what they do not move rests (steady motion) */
  int32_t search; /* SETTLE: where the forces push it to, else any; NEAREST: a root of the forces, stable or not */
  uint32_t max_iterations; /* 0: 200 */
} koppel_equilibrium_options;

/* Forces are along the independent coordinates; scaled ones, in joules, are times the scene's length if that is a line.
 */
typedef struct koppel_equilibrium_summary {
  uint32_t struct_size;
  int32_t found;     /* 1: the forces balance */
  uint32_t freedoms; /* independent coordinates */
  uint32_t iterations;
  uint32_t stable; /* how many of the directions in which it could move are held there */
  uint32_t unstable;
  uint32_t indifferent;
  int32_t circulatory; /* 1: the stiffness is not symmetric, so that statics alone cannot tell */
  int32_t states_held; /* 1: internal states of forces, as of an integral controller, were held for the stiffness */
  uint32_t worst;      /* the rate along which the greatest scaled force is left */
  uint32_t moved_most; /* the rate whose coordinate has changed most since the start */
  uint32_t reserved;
  double residual;         /* greatest scaled force left over force_scale, or rate of an internal state */
  double force;            /* left along `worst` [N m, N] */
  double force_scale;      /* [J] size of the forces: of weights that turn, and of stiffness */
  double coordinate_error; /* what is left displaces [rad, lengths of the scene] */
  double energy;           /* [J] potential, of gravity and of the forces that store it */
  double moved;            /* change of the coordinate that moved most [rad, lengths of the scene] */
  double unrest;           /* [1/s] of MOVING: greatest rate of what no drive sets; in steady motion rounding only */
  double stiffness_error;  /* [J] of an eigenvalue of the stiffness; below it a direction is indifferent */
} koppel_equilibrium_summary;

/* Looks for a position of rest at the time of a closed state, which is left as it is. None found is no failure.
 * options: NULL for defaults. INVALID_ARGUMENT: the state is not closed. NOT_CLOSED: the start cannot be evaluated.
 * PLUGIN: a plugin failed. */
KOPPEL_EXPORT koppel_status koppel_equilibrium_find(const koppel_state* state,
                                                    const koppel_equilibrium_options* options,
                                                    koppel_equilibrium** equilibrium, koppel_error* error);
KOPPEL_EXPORT void koppel_equilibrium_destroy(koppel_equilibrium* equilibrium);
KOPPEL_EXPORT koppel_status koppel_equilibrium_summarise(const koppel_equilibrium* equilibrium,
                                                         koppel_equilibrium_summary* summary);
/* Why none was found: a line of text; "" if one was. */
KOPPEL_EXPORT koppel_status koppel_equilibrium_why(const koppel_equilibrium* equilibrium, char* text, size_t size,
                                                   size_t* needed);
/* Puts a state of the same mechanism there, closed, internal states of forces at rest too. HELD: with velocities and
 * accelerations, all zero; MOVING: with velocities, those of the drives. */
KOPPEL_EXPORT koppel_status koppel_equilibrium_take(const koppel_equilibrium* equilibrium, koppel_state* state);
/* The rates that are independent there: `freedoms` numbers. */
KOPPEL_EXPORT koppel_status koppel_equilibrium_independent(const koppel_equilibrium* equilibrium, uint32_t* rates,
                                                           size_t count);
/* Force against displacement in the independent coordinates [N m, N by rad, m]: freedoms x freedoms, row by row, and
 * what each entry may be wrong by (NULL: not asked). INVALID_ARGUMENT: none was found. */
KOPPEL_EXPORT koppel_status koppel_equilibrium_stiffness(const koppel_equilibrium* equilibrium, double* stiffness,
                                                         double* errors, size_t count);
/* index: below freedoms, stiffness ascending. stiffness [J]: eigenvalue in scaled coordinates. direction: NULL, or the
 * `rates` that belong to it, the greatest scaled one 1. INVALID_ARGUMENT: none was found. */
KOPPEL_EXPORT koppel_status koppel_equilibrium_direction(const koppel_equilibrium* equilibrium, size_t index,
                                                         double* stiffness, double* direction, size_t count);

/* ------------------------------------------------------------------------------------------------ linear equations */

typedef struct koppel_linearisation koppel_linearisation; /* never changes */

typedef struct koppel_linearisation_options {
  uint32_t struct_size;
  int32_t drives;                        /* KOPPEL_DRIVES_HELD: about rest; MOVING: with the rates of the state */
  const koppel_equilibrium* equilibrium; /* linearise there instead of at the state's position; NULL: none */
  const uint32_t* efforts;               /* rates along which efforts are inputs */
  size_t effort_count;
} koppel_linearisation_options;

enum {
  KOPPEL_COURSE_UNSTEADY = 0, /* its rates change: eigenvalues tell of this instant only */
  KOPPEL_COURSE_STEADY = 1,   /* it moves at rates that stay, and the equations with them */
  KOPPEL_COURSE_RESTING = 2
};

typedef struct koppel_linearisation_summary {
  uint32_t struct_size;
  int32_t course;
  uint32_t freedoms;
  uint32_t states;  /* x: coordinates, their rates, internal states of forces */
  uint32_t inputs;  /* u: value, rate and acceleration of each drive, then the efforts asked for */
  uint32_t outputs; /* y: the recorded columns that vary smoothly: no axodes, no transfer functions; loads take efforts
                       as acting along the independent coordinates */
  double drift;     /* greatest change of a rate [rad/s^2, lengths of the scene/s^2], or of an internal state */
} koppel_linearisation_summary;

/* x' = A x + B u, y = C x + D u for small deviations from a closed state, with its rates if it has velocities. A state
 * need not rest: the summary tells. options: NULL for defaults. INVALID_ARGUMENT: the state is not closed. SINGULAR:
 * nothing can be evaluated beside it, or something has no mass. PLUGIN: a plugin failed. */
KOPPEL_EXPORT koppel_status koppel_linearise(const koppel_state* state, const koppel_linearisation_options* options,
                                             koppel_linearisation** linearisation, koppel_error* error);
KOPPEL_EXPORT void koppel_linearisation_destroy(koppel_linearisation* linearisation);
KOPPEL_EXPORT koppel_status koppel_linearisation_summarise(const koppel_linearisation* linearisation,
                                                           koppel_linearisation_summary* summary);

enum { KOPPEL_LINEAR_STATE = 1, KOPPEL_LINEAR_INPUT = 2, KOPPEL_LINEAR_OUTPUT = 3 };

/* Name and unit of the index-th number of x, u or y. */
KOPPEL_EXPORT koppel_status koppel_linearisation_name(const koppel_linearisation* linearisation, int32_t kind,
                                                      size_t index, char* text, size_t size, size_t* needed);
KOPPEL_EXPORT koppel_status koppel_linearisation_unit(const koppel_linearisation* linearisation, int32_t kind,
                                                      size_t index, char* text, size_t size, size_t* needed);

enum {
  KOPPEL_MATRIX_A = 1,
  KOPPEL_MATRIX_B = 2,
  KOPPEL_MATRIX_C = 3,
  KOPPEL_MATRIX_D = 4,
  KOPPEL_MATRIX_MASS = 5,      /* these three in the independent coordinates: mass q'' + damping q' + stiffness q */
  KOPPEL_MATRIX_STIFFNESS = 6, /* are the efforts */
  KOPPEL_MATRIX_DAMPING = 7
};

/* Row by row, and what each entry may be wrong by, by the differences that it was formed from (NULL: not asked). */
KOPPEL_EXPORT koppel_status koppel_linearisation_matrix(const koppel_linearisation* linearisation, int32_t what,
                                                        double* values, double* errors, size_t count);

typedef struct koppel_eigenmode {
  uint32_t struct_size;
  uint32_t reserved;
  double real; /* [1/s] of the eigenvalue */
  double imaginary;
  double error; /* [1/s] of it, by the errors of A */
} koppel_eigenmode;

/* index: below `states`, by the size of the eigenvalue, of a pair that with positive imaginary part first. shape_real,
 * shape_imaginary: NULL, or the displacements along all `rates`, the greatest scaled one 1. */
KOPPEL_EXPORT koppel_status koppel_linearisation_mode(const koppel_linearisation* linearisation, size_t index,
                                                      koppel_eigenmode* mode, double* shape_real,
                                                      double* shape_imaginary, size_t count);

/* ------------------------------------------------------------------------------------------------ trees */

typedef struct koppel_tree koppel_tree; /* dynamics of a spanning tree, with its scratch memory: one for each thread */

/* Of the bodies on the joints of the spanning tree, under gravity. Loops are open where they are cut; constraints,
 * [[force]]s and drives do not act, and driven rates are rates as all others. What belongs to cut joints does not
 * count, and comes out zero. PLUGIN, INVALID_SCENE: a body has no sound inertia. */
KOPPEL_EXPORT koppel_status koppel_tree_create(const koppel_mechanism* mechanism, koppel_tree** tree,
                                               koppel_error* error);
KOPPEL_EXPORT void koppel_tree_destroy(koppel_tree* tree);

/* The functions below take `count` states, one after another, and give for each what it gives alone, bit for bit. q:
 * `coordinates` numbers for each state; quaternions and unit vectors are normalised. v, a, efforts [N m, N]: `rates`
 * numbers; as input NULL for zero. Matrices: `rates` x `rates`, row by row. Outputs must not overlap inputs; of several
 * each may be NULL: not asked. Nothing is allocated but for errors.
 * INVALID_ARGUMENT: an array is missing, or a number is not finite. PLUGIN: a joint's plugin failed; SINGULAR, of
 * forward dynamics: something moves without mass. The error tells which state of the batch, from 0; results of the
 * states before it are written then, no others. */

/* Efforts that a motion takes, by the recursive Newton-Euler algorithm: mass a + bias. With a NULL they are the bias,
 * with v NULL too the load of gravity. */
KOPPEL_EXPORT koppel_status koppel_tree_inverse_dynamics(koppel_tree* tree, size_t count, const double* q,
                                                         const double* v, const double* a, double* efforts,
                                                         koppel_error* error);
/* Accelerations that efforts cause, by articulated bodies. */
KOPPEL_EXPORT koppel_status koppel_tree_forward_dynamics(koppel_tree* tree, size_t count, const double* q,
                                                         const double* v, const double* efforts, double* a,
                                                         koppel_error* error);
/* The mass matrix, by composite rigid bodies: symmetric; v mass v / 2 is the kinetic energy. */
KOPPEL_EXPORT koppel_status koppel_tree_mass_matrix(koppel_tree* tree, size_t count, const double* q, double* mass,
                                                    koppel_error* error);
/* [J], one number for each state; the potential energy is that of gravity, zero with all mass at the world's origin. */
KOPPEL_EXPORT koppel_status koppel_tree_energy(koppel_tree* tree, size_t count, const double* q, const double* v,
                                               double* kinetic, double* potential, koppel_error* error);
/* For each state mass [kg], and in world axes 3 numbers each: centre of mass [m], momentum [N s], angular momentum
 * about the centre of mass [N m s]. */
KOPPEL_EXPORT koppel_status koppel_tree_momentum(koppel_tree* tree, size_t count, const double* q, const double* v,
                                                 double* mass, double* centre, double* momentum,
                                                 double* angular_momentum, koppel_error* error);
/* Efforts (rows) by displacements along the rates and by the rates (columns); by accelerations it is the mass matrix. A
 * displacement moves q along a rate as plugin.h describes rates, and leaves the numbers in v and a as they are. Exact
 * to rounding; of joints that are no product of motions, what their plugin leaves out, and how their bias changes with
 * q, is formed by differences within the joint (Carpentier, Mansard 2018; Singh, Russo, Wensing 2022). */
KOPPEL_EXPORT koppel_status koppel_tree_inverse_dynamics_derivatives(koppel_tree* tree, size_t count, const double* q,
                                                                     const double* v, const double* a, double* by_q,
                                                                     double* by_v, koppel_error* error);
/* Accelerations (rows) by displacements, rates and efforts (columns); by_effort is the inverse of the mass matrix. */
KOPPEL_EXPORT koppel_status koppel_tree_forward_dynamics_derivatives(koppel_tree* tree, size_t count, const double* q,
                                                                     const double* v, const double* efforts,
                                                                     double* by_q, double* by_v, double* by_effort,
                                                                     koppel_error* error);

#ifdef __cplusplus
}
#endif
#endif /* KOPPEL_DYNAMICS_H */

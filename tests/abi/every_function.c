/* A host in strict C11 that calls every function of koppel.h on real scenes and checks what comes back.
 * every_function SCENE PLUGIN URL: the file of X-5LINK, a plugin to load, a log to stream into. */
#include <koppel/koppel.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int checks = 0, failures = 0;

static void check(int true_or_not, const char* what, int line) {
  ++checks;
  if (true_or_not) return;
  ++failures;
  fprintf(stderr, "every_function.c:%d: %s\n", line, what);
}
#define CHECK(condition) check((condition) ? 1 : 0, #condition, __LINE__)
#define CHECK_OK(call) CHECK((call) >= KOPPEL_OK)
#define CHECK_NEAR(a, b, tolerance) CHECK(fabs((a) - (b)) <= (tolerance))
#define SIZED(type, name) type name = {.struct_size = sizeof(type)}

enum { MOST = 256 }; /* numbers of anything in the scenes used here */

/* ---- a plugin that is linked into the host: the function x^2 */

static koppel_status square(size_t count, const void* const* instances, const double* x, double* out) {
  (void)instances;
  for (size_t i = 0; i < count; ++i) {
    out[3 * i] = x[i] * x[i];
    out[3 * i + 1] = 2.0 * x[i];
    out[3 * i + 2] = 2.0;
  }
  return KOPPEL_OK;
}

static const void* host_types(const char* interface_id, size_t index) {
  static const koppel_type type = {.struct_size = sizeof type, .name = "host.square", .summary = "The square of time."};
  static const koppel_function_type function = {.struct_size = sizeof function, .type = &type, .evaluate = square};
  return strcmp(interface_id, KOPPEL_FUNCTION_INTERFACE) == 0 && index == 0 ? &function : NULL;
}

static const koppel_plugin_entry host_plugin = {
    .struct_size = sizeof(koppel_plugin_entry),
    .abi = {KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, KOPPEL_ABI_PATCH},
    .name = "host",
    .type_table = host_types,
};

static void count_lines(void* context, int32_t level, const char* message) {
  *(int*)context += level >= KOPPEL_LOG_DEBUG && message[0] != '\0';
}

/* ---- findings and codes */

static void explains_its_findings(koppel_engine* engine) {
  static const char text[] = "schema = 1\n[[body]]\nname = \"arm\"\nmas = 2\n";
  koppel_diagnostics* diagnostics = NULL;
  koppel_scene* scene = NULL;
  SIZED(koppel_error, error);
  SIZED(koppel_error, finding);
  char words[2048];
  size_t needed = 0;
  CHECK_OK(koppel_diagnostics_create(&diagnostics));
  CHECK(koppel_diagnostics_count(diagnostics) == 0);
  CHECK(koppel_scene_from_text(engine, text, strlen(text), NULL, diagnostics, &scene, &error) == KOPPEL_INVALID_SCENE);
  CHECK(scene == NULL);
  CHECK(koppel_diagnostics_count(diagnostics) == 1);
  CHECK_OK(koppel_diagnostics_get(diagnostics, 0, &finding));
  CHECK(memcmp(&error, &finding, sizeof error) == 0);
  CHECK(strcmp(finding.code, "E0201") == 0 && finding.line == 4 && strcmp(finding.source_line, "mas = 2") == 0);
  CHECK_OK(koppel_diagnostics_render(diagnostics, words, sizeof words, &needed));
  CHECK(strstr(words, "mas = 2") != NULL && needed == strlen(words) + 1);
  CHECK_OK(koppel_explain_code(finding.code, words, sizeof words, &needed));
  CHECK(needed == strlen(words) + 1);
  koppel_diagnostics_destroy(diagnostics);
}

/* ---- what is known of a mechanism before it moves */

static void describes_itself(const koppel_mechanism* mechanism) {
  SIZED(koppel_sizes, sizes);
  SIZED(koppel_settings, settings);
  SIZED(koppel_closure, closure);
  SIZED(koppel_inertia, inertia);
  SIZED(koppel_error, error);
  char text[8192];
  uint32_t path[MOST];
  size_t index = MOST, needed = 0;
  CHECK_OK(koppel_mechanism_sizes(mechanism, &sizes));
  CHECK(sizes.bodies == 8 && sizes.joints == 12 && sizes.loops == 5 && sizes.inputs == 2 && sizes.constraints == 0);
  CHECK_OK(koppel_mechanism_settings(mechanism, &settings));
  CHECK(settings.steps == 320 && settings.duration == 1.0 && settings.gravity[2] == -9.81 && settings.hash != 0);
  CHECK_OK(koppel_mechanism_find(mechanism, KOPPEL_KIND_INPUT, "rack.displacement", &index, &error));
  CHECK(index == 1);
  CHECK_OK(koppel_mechanism_name(mechanism, KOPPEL_KIND_INPUT, index, text, sizeof text, &needed));
  CHECK(strcmp(text, "rack.displacement") == 0);
  CHECK_OK(koppel_mechanism_unit(mechanism, KOPPEL_KIND_INPUT, index, text, sizeof text, NULL));
  CHECK(strcmp(text, "m") == 0);
  int32_t wish = -1;
  double value = -1.0;
  CHECK_OK(koppel_mechanism_start(mechanism, 0, &wish, &value));
  CHECK(wish >= KOPPEL_START_FREE && wish <= KOPPEL_START_FIXED);
  CHECK(koppel_mechanism_start(mechanism, sizes.coordinates, &wish, &value) == KOPPEL_INVALID_ARGUMENT);
  CHECK_OK(koppel_mechanism_explain(mechanism, text, sizeof text, &needed));
  uint32_t equations = 0;
  for (uint32_t i = 0; i < sizes.loops + sizes.constraints; ++i) {
    CHECK_OK(koppel_mechanism_closure(mechanism, i, &closure, NULL, 0));
    CHECK(closure.first_equation == equations && closure.path > 0 && closure.path <= sizes.joints);
    CHECK_OK(koppel_mechanism_closure(mechanism, i, &closure, path, closure.path));
    CHECK(path[0] < sizes.joints && (int32_t)path[0] != closure.joint);
    equations += closure.equations;
  }
  CHECK(equations == sizes.equations);
  CHECK_OK(koppel_body_inertia(mechanism, 1, &inertia, &error));
}

/* ---- closing, rates, results */

static void closes_by_every_method(const koppel_mechanism* mechanism, koppel_work* work) {
  for (int32_t method = KOPPEL_METHOD_AUTO; method <= KOPPEL_METHOD_FLOW; ++method) {
    koppel_state* state = NULL;
    koppel_close_options options = {.struct_size = sizeof options, .method = method};
    SIZED(koppel_report, report);
    SIZED(koppel_analysis, analysis);
    CHECK_OK(koppel_state_create(mechanism, &state));
    CHECK_OK(koppel_close(state, work, &options, &report, NULL));
    CHECK(report.verdict == KOPPEL_VERDICT_CLOSED && report.residual < 1e-13 && report.rank == 15);
    CHECK_OK(koppel_analyse(state, work, &analysis, NULL));
    CHECK(analysis.mobility_count == 2 && analysis.mobility_rank == 2);
    SIZED(koppel_freedoms, freedoms);
    CHECK_OK(koppel_find_freedoms(state, work, &freedoms, NULL));
    CHECK(freedoms.mobility_here == 2 && freedoms.mobility_by_kind == 2 && freedoms.indeterminate == 0);
    char text[8192];
    size_t needed = 0;
    CHECK_OK(koppel_explain_freedoms(state, work, text, sizeof text, &needed));
    CHECK(strstr(text, "Freedoms: 2 by rank") != NULL);
    koppel_state_destroy(state);
  }
}

/* ---- flow and modes */

static int32_t count_calls(size_t found, double part, void* user) {
  CHECK(part >= 0.0 && part <= 1.0 + 1e-12 && found <= 4096);
  ++*(int*)user;
  return 0;
}

static void explains_its_flow(const koppel_mechanism* mechanism) {
  char text[16384];
  size_t needed = 0;
  CHECK_OK(koppel_flow_explain(mechanism, KOPPEL_FLOW_TEXT, text, sizeof text, &needed));
  CHECK(needed == strlen(text) + 1 && strstr(text, "rack.displacement") != NULL);
  CHECK_OK(koppel_flow_explain(mechanism, KOPPEL_FLOW_DOT, text, sizeof text, &needed));
  CHECK(needed == strlen(text) + 1 && strncmp(text, "digraph", 7) == 0);
}

static void finds_its_modes(const koppel_mechanism* mechanism, koppel_work* work, const koppel_sizes* sizes) {
  koppel_state* state = NULL;
  koppel_modes* modes = NULL;
  int calls = 0;
  koppel_modes_options options = {.struct_size = sizeof options, .progress = count_calls, .user = &calls};
  SIZED(koppel_modes_summary, summary);
  SIZED(koppel_mode, mode);
  SIZED(koppel_report, report);
  char text[256];
  double start[MOST], closed[MOST];
  CHECK_OK(koppel_state_create(mechanism, &state));
  CHECK_OK(koppel_modes_find(state, work, &options, &modes, NULL));
  CHECK_OK(koppel_modes_summarise(modes, &summary));
  CHECK(summary.count > 0 && summary.complete == 1 && summary.twins == 32 && calls > 0);
  CHECK_OK(koppel_modes_why(modes, text, sizeof text, NULL));
  CHECK(text[0] != '\0');
  for (size_t i = 0; i < summary.count; ++i) {
    CHECK_OK(koppel_modes_get(modes, i, &mode));
    CHECK(mode.residual < 1e-13);
    CHECK_OK(koppel_modes_id(modes, i, text, sizeof text, NULL));
    CHECK(text[0] != '\0');
    CHECK_OK(koppel_modes_take(modes, i, state));
    CHECK_OK(koppel_state_get(state, KOPPEL_Q, start, sizes->coordinates));
    CHECK_OK(koppel_close(state, work, NULL, &report, NULL));
    CHECK_OK(koppel_state_get(state, KOPPEL_Q, closed, sizes->coordinates));
    for (size_t k = 0; k < sizes->coordinates; ++k) CHECK_NEAR(closed[k], start[k], 1e-12);
  }
  koppel_modes_destroy(modes);
  koppel_state_destroy(state);
}

/* The wheel goes up at 1 m/s from the design position: golden rates of X-5LINK. */
static void has_rates(koppel_state* state, koppel_work* work, size_t frame, const koppel_sizes* sizes) {
  static const double golden[6] = {-0.452162529, -0.166312272, -0.377515966, -0.008969121, -0.006120659, 1.0};
  double twists[6 * MOST], accelerations[6 * MOST], jacobian[6 * MOST], rate[6 * MOST], v[MOST], a[MOST];
  CHECK_OK(koppel_state_set_input(state, 0, 0.0, 1.0, 0.0));
  CHECK_OK(koppel_state_set_input(state, 1, 0.0, 0.0, 0.0));
  CHECK_OK(koppel_close(state, work, NULL, NULL, NULL));
  CHECK_OK(koppel_velocities(state, work, NULL));
  CHECK_OK(koppel_accelerations(state, work, NULL));
  CHECK_OK(koppel_state_get(state, KOPPEL_V, v, sizes->rates));
  CHECK_OK(koppel_state_get(state, KOPPEL_A, a, sizes->rates));
  CHECK_OK(koppel_twists(state, work, KOPPEL_KIND_FRAME, twists, 6 * (size_t)sizes->frames));
  CHECK_OK(koppel_frame_accelerations(state, work, KOPPEL_KIND_FRAME, accelerations, 6 * (size_t)sizes->frames));
  CHECK_OK(koppel_jacobian(state, work, KOPPEL_KIND_FRAME, frame, jacobian, rate, 6 * (size_t)sizes->rates));
  for (size_t row = 0; row < 6; ++row) {
    double twist = 0.0, acceleration = 0.0; /* J v, and J a + J' v */
    for (size_t i = 0; i < sizes->rates; ++i) {
      twist += jacobian[row * sizes->rates + i] * v[i];
      acceleration += jacobian[row * sizes->rates + i] * a[i] + rate[row * sizes->rates + i] * v[i];
    }
    CHECK_NEAR(twists[6 * frame + row], golden[row], 0.5e-9);
    CHECK_NEAR(twists[6 * frame + row], twist, 1e-12);
    CHECK_NEAR(accelerations[6 * frame + row], acceleration, 1e-11);
  }
}

static void moves(koppel_state* state, koppel_work* work, size_t frame, const koppel_sizes* sizes) {
  SIZED(koppel_report, report);
  double poses[12 * MOST], records[MOST];
  for (int i = 0; i <= 20; ++i) {
    CHECK_OK(koppel_move(state, work, i / 20.0, &report, NULL));
    CHECK(report.residual < 1e-13);
  }
  CHECK(koppel_state_time(state) == 1.0);
  SIZED(koppel_motion_options, way);
  way.branch = KOPPEL_BRANCH_TAKE;
  CHECK_OK(koppel_follow(state, work, 0.1, &way, &report, NULL));
  CHECK(report.residual < 1e-13 && report.limits == 0 && report.pace > 0.0);
  CHECK(koppel_state_time(state) > 1.0);
  uint32_t independent[MOST];
  size_t count = 0;
  double quality = 0.0;
  CHECK_OK(koppel_independent(state, work, independent, MOST, &count, &quality, NULL));
  CHECK(count == 2 && independent[0] < independent[1] && independent[1] < sizes->rates && quality > 1e-3);
  const uint32_t first = independent[0];
  CHECK_OK(koppel_independent(state, work, independent, MOST, &count, NULL, NULL));
  CHECK(count == 2 && independent[0] == first);
  CHECK(koppel_independent(state, work, independent, 1, &count, NULL, NULL) == KOPPEL_INVALID_ARGUMENT);
  count = 0;
  CHECK(koppel_independent(state, work, independent, 1, &count, NULL, NULL) == KOPPEL_INVALID_ARGUMENT && count == 2);
  CHECK_OK(koppel_move_on(state, work, 1.0, &way, &report, NULL));
  CHECK(koppel_state_time(state) == 1.0 && report.change_points == 0 && report.limit_input == -1);
  char names[8] = "#";
  CHECK_OK(koppel_limits_exceeded(state, names, sizeof names, NULL));
  CHECK(names[0] == '\0'); /* the scene sets none */
  CHECK_OK(koppel_poses(state, work, KOPPEL_KIND_FRAME, poses, 12 * (size_t)sizes->frames));
  CHECK_NEAR(poses[12 * frame + 9], 0.000131326, 0.5e-9); /* X-5LINK at +80 mm */
  CHECK_NEAR(poses[12 * frame + 10], -0.749874340, 0.5e-9);
  double wrenches[6 * MOST], efforts[MOST];
  uint8_t determined[7 * MOST];
  const size_t loads = 6 * (size_t)sizes->joints;
  CHECK_OK(koppel_reactions(state, work, wrenches, loads, efforts, sizes->rates, determined, NULL));
  for (size_t i = 0; i < loads; ++i) CHECK(wrenches[i] == 0.0 && determined[i] == 1); /* bodies without mass */
  CHECK(koppel_reactions(state, work, wrenches, loads - 1, efforts, sizes->rates, NULL, NULL) ==
        KOPPEL_INVALID_ARGUMENT);
  CHECK_OK(koppel_records(state, work, records, sizes->records));
  CHECK_NEAR(records[0], 0.08, 1e-15);
}

static void keeps_copies(const koppel_mechanism* mechanism, const koppel_state* state, const koppel_sizes* sizes) {
  koppel_state* other = NULL;
  double q[MOST], same[MOST];
  CHECK_OK(koppel_state_create(mechanism, &other));
  CHECK_OK(koppel_state_copy(state, other));
  CHECK_OK(koppel_state_get(state, KOPPEL_Q, q, sizes->coordinates));
  CHECK_OK(koppel_state_get(other, KOPPEL_Q, same, sizes->coordinates));
  CHECK(memcmp(q, same, sizes->coordinates * sizeof q[0]) == 0);
  CHECK_OK(koppel_state_set_time(other, 0.25, NULL));
  CHECK(koppel_state_time(other) == 0.25 && koppel_state_time(state) == 1.0);
  CHECK_OK(koppel_state_set(other, KOPPEL_Q, q, sizes->coordinates));
  koppel_state_destroy(other);
}

/* ---- streams */

static void streams(const koppel_mechanism* mechanism, const koppel_state* state, koppel_work* work, const char* url) {
  SIZED(koppel_report, report);
  SIZED(koppel_stream_statistics, statistics);
  koppel_stream_options options = {.struct_size = sizeof options, .url = url, .name = "WHEEL"};
  koppel_stream* stream = NULL;
  CHECK_OK(koppel_stream_open(mechanism, &options, &stream, NULL));
  for (int i = 0; i < 10; ++i) CHECK_OK(koppel_stream_publish(stream, state, work, &report));
  CHECK_OK(koppel_stream_event(stream, 1.0, KOPPEL_SEVERITY_NOTE, "at the bump stop"));
  CHECK_OK(koppel_stream_close(stream, &statistics));
  CHECK(statistics.published == 10 && statistics.sent == 10 && statistics.dropped == 0 && statistics.failed == 0);
}

/* ---- the whole life of a host */

static void drives_by_its_own_function(koppel_engine* engine) {
  static const char text[] =
      "schema = 1\n[[body]]\nname = \"arm\"\n[[joint]]\nname = \"pivot\"\ntype = \"revolute\"\n"
      "between = [\"ground\", \"arm\"]\n[[drive]]\nof = \"pivot.angle\"\ntype = \"host.square\"\n";
  koppel_scene* scene = NULL;
  koppel_mechanism* mechanism = NULL;
  koppel_state* state = NULL;
  koppel_work* work = NULL;
  double q = 0.0, v = 0.0, a = 0.0;
  CHECK_OK(koppel_scene_from_text(engine, text, strlen(text), NULL, NULL, &scene, NULL));
  CHECK_OK(koppel_mechanism_compile(scene, NULL, &mechanism, NULL));
  CHECK_OK(koppel_state_create(mechanism, &state));
  CHECK_OK(koppel_work_create(mechanism, &work));
  CHECK_OK(koppel_move(state, work, 3.0, NULL, NULL));
  CHECK_OK(koppel_state_get(state, KOPPEL_Q, &q, 1));
  CHECK_OK(koppel_state_get(state, KOPPEL_V, &v, 1));
  CHECK_OK(koppel_state_get(state, KOPPEL_A, &a, 1));
  CHECK(q == 9.0 && v == 6.0 && a == 2.0);
  koppel_work_destroy(work);
  koppel_state_destroy(state);
  koppel_mechanism_destroy(mechanism);
  koppel_scene_destroy(scene);
}

/* A weight on a rod, let go from the horizontal: its energy stays, and its angle is known after a second. */
static void simulates_a_pendulum(koppel_engine* engine) {
  static const char text[] =
      "schema = 1\n[scene]\ngravity = [0, -9.81, 0]\nduration = 2\n[[body]]\nname = 'weight'\ntype = 'point_mass'\n"
      "mass = 1\nat = [0, -1, 0]\n[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'weight'\n"
      "start = { angle = '-90 deg' }\n[[watch]]\nname = 'halfway'\nof = 'pin.angle'\nvalue = '-45 deg'\n";
  koppel_scene* scene = NULL;
  koppel_mechanism* mechanism = NULL;
  koppel_state* state = NULL;
  koppel_work* work = NULL;
  koppel_simulation* simulation = NULL;
  SIZED(koppel_crossing, crossing);
  SIZED(koppel_simulation_options, options);
  SIZED(koppel_simulation_summary, summary);
  SIZED(koppel_error, error);
  double q = 0.0, v = 0.0;
  double again = 0.0;
  static unsigned char saved[1 << 16];
  char name[32], list[2048];
  size_t needed = 0;
  CHECK_OK(koppel_scene_from_text(engine, text, sizeof text - 1, NULL, NULL, &scene, &error));
  CHECK_OK(koppel_mechanism_compile(scene, NULL, &mechanism, &error));
  CHECK_OK(koppel_state_create(mechanism, &state));
  CHECK_OK(koppel_work_create(mechanism, &work));
  CHECK(koppel_simulation_create(state, NULL, &simulation, &error) == KOPPEL_INVALID_ARGUMENT); /* not closed yet */
  CHECK_OK(koppel_close(state, work, NULL, NULL, &error));
  options.tolerance = 1e-10;
  CHECK_OK(koppel_simulation_create(state, &options, &simulation, &error));
  CHECK_OK(koppel_simulation_watch(simulation, 1.0, state, &crossing, &error));
  CHECK(crossing.watch == 0 && crossing.rising == 1 && crossing.stop == 0 && crossing.time > 0.0);
  CHECK(koppel_simulation_time(simulation) == crossing.time);
  CHECK_OK(koppel_state_get(state, KOPPEL_Q, &q, 1));
  CHECK_NEAR(q, -0.785398163397448, 1e-14);
  CHECK_OK(koppel_simulation_watch(simulation, crossing.time, state, &crossing, &error));
  CHECK(crossing.watch == KOPPEL_NO_WATCH);
  CHECK_OK(koppel_simulation_advance(simulation, 1.0, state, &error));
  CHECK_OK(koppel_state_get(state, KOPPEL_Q, &q, 1));
  CHECK_OK(koppel_state_get(state, KOPPEL_V, &v, 1));
  CHECK_NEAR(sin(q), 0.986291751131875319, 1e-8);
  CHECK_NEAR(v * v / 2.0, 9.81 * cos(q), 1e-7);
  CHECK(koppel_simulation_advance(simulation, 0.5, state, &error) == KOPPEL_INVALID_ARGUMENT);
  CHECK_OK(koppel_simulation_summarise(simulation, &summary));
  CHECK(summary.freedoms == 1 && summary.steps > 0 && summary.energy_error < 1e-7);
  CHECK(summary.tolerance == 1e-10 && summary.step == 0.0 && summary.stiff == 0);
  CHECK_OK(koppel_simulation_integrator(simulation, name, sizeof name, &needed));
  CHECK(strcmp(name, "dormand_prince") == 0);
  CHECK_OK(koppel_simulation_formulation(simulation, name, sizeof name, &needed));
  CHECK(strcmp(name, "minimal") == 0);
  CHECK_OK(koppel_integrators(list, sizeof list, &needed));
  CHECK(strstr(list, "dormand_prince: ") == list && strstr(list, "\ncvode: ") != NULL);
  CHECK_OK(koppel_formulations(list, sizeof list, &needed));
  CHECK(strstr(list, "minimal: ") == list && strstr(list, "\nprojected: ") != NULL);
  CHECK(koppel_simulation_time(simulation) == 1.0);
  CHECK_OK(koppel_simulation_save(simulation, NULL, 0, &needed, &error));
  CHECK(needed <= sizeof saved);
  CHECK(koppel_simulation_save(simulation, saved, needed - 1, &needed, &error) == KOPPEL_INVALID_ARGUMENT);
  CHECK_OK(koppel_simulation_save(simulation, saved, sizeof saved, &needed, &error));
  CHECK_OK(koppel_simulation_advance(simulation, 1.5, state, &error));
  CHECK_OK(koppel_state_get(state, KOPPEL_Q, &q, 1));
  koppel_simulation_destroy(simulation);
  simulation = NULL;
  CHECK(koppel_simulation_load(mechanism, saved, needed - 1, &simulation, &error) == KOPPEL_INVALID_ARGUMENT);
  CHECK_OK(koppel_simulation_load(mechanism, saved, needed, &simulation, &error));
  CHECK_OK(koppel_simulation_advance(simulation, 1.5, state, &error));
  CHECK_OK(koppel_state_get(state, KOPPEL_Q, &again, 1));
  CHECK(again == q); /* bit for bit */
  koppel_simulation_destroy(simulation);
  simulation = NULL;
  options.integrator = "rk45";
  CHECK(koppel_simulation_create(state, &options, &simulation, &error) == KOPPEL_INVALID_ARGUMENT);
  CHECK(strstr(error.advice, "dop853") != NULL && simulation == NULL);
  options.integrator = NULL;
  options.formulation = "maximal";
  CHECK(koppel_simulation_create(state, &options, &simulation, &error) == KOPPEL_INVALID_ARGUMENT);
  CHECK(strstr(error.advice, "baumgarte") != NULL && simulation == NULL);
  koppel_work_destroy(work);
  koppel_state_destroy(state);
  koppel_mechanism_destroy(mechanism);
  koppel_scene_destroy(scene);
}

/* The same weight hangs at rest, swings about that place, and is pushed at its pin. */
static void rests_and_linearises(koppel_engine* engine) {
  static const char text[] =
      "schema = 1\n[scene]\ngravity = [0, -9.81, 0]\n[[body]]\nname = 'weight'\ntype = 'point_mass'\n"
      "mass = 1\nat = [0, -1, 0]\n[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'weight'\n"
      "start = { angle = '-90 deg' }\n";
  koppel_scene* scene = NULL;
  koppel_mechanism* mechanism = NULL;
  koppel_state* state = NULL;
  koppel_work* work = NULL;
  koppel_equilibrium* rest = NULL;
  koppel_linearisation* linear = NULL;
  SIZED(koppel_equilibrium_options, how);
  SIZED(koppel_equilibrium_summary, found);
  SIZED(koppel_linearisation_options, options);
  SIZED(koppel_linearisation_summary, summary);
  SIZED(koppel_eigenmode, mode);
  SIZED(koppel_error, error);
  char name[32];
  const uint32_t efforts[] = {0};
  uint32_t independent = 9;
  double q = 9.0, stiffness = 0.0, wrong = 1.0, along = 0.0, a[4], b[2], wrongs[4], real = 0.0, imaginary = 9.0;
  CHECK_OK(koppel_scene_from_text(engine, text, sizeof text - 1, NULL, NULL, &scene, &error));
  CHECK_OK(koppel_mechanism_compile(scene, NULL, &mechanism, &error));
  CHECK_OK(koppel_state_create(mechanism, &state));
  CHECK_OK(koppel_work_create(mechanism, &work));
  CHECK_OK(koppel_close(state, work, NULL, NULL, &error));
  how.max_iterations = 50;
  CHECK_OK(koppel_equilibrium_find(state, &how, &rest, &error));
  CHECK_OK(koppel_equilibrium_summarise(rest, &found));
  CHECK(found.found == 1 && found.freedoms == 1 && found.stable == 1 && found.residual < 1e-14);
  CHECK_OK(koppel_equilibrium_why(rest, name, sizeof name, NULL));
  CHECK(name[0] == '\0');
  CHECK_OK(koppel_equilibrium_take(rest, state));
  CHECK_OK(koppel_state_get(state, KOPPEL_Q, &q, 1));
  CHECK_NEAR(q, 0.0, 1e-14);
  CHECK_OK(koppel_equilibrium_independent(rest, &independent, 1));
  CHECK(independent == 0);
  CHECK_OK(koppel_equilibrium_stiffness(rest, &stiffness, &wrong, 1));
  CHECK_NEAR(stiffness, 9.81, wrong);
  CHECK_OK(koppel_equilibrium_direction(rest, 0, &stiffness, &along, 1));
  CHECK_NEAR(stiffness, 9.81, found.stiffness_error);
  CHECK(along == 1.0);
  options.equilibrium = rest;
  options.efforts = efforts;
  options.effort_count = 1;
  CHECK_OK(koppel_linearise(state, &options, &linear, &error));
  CHECK_OK(koppel_linearisation_summarise(linear, &summary));
  CHECK(summary.course == KOPPEL_COURSE_RESTING && summary.states == 2 && summary.inputs == 1 && summary.outputs == 1);
  CHECK_OK(koppel_linearisation_name(linear, KOPPEL_LINEAR_INPUT, 0, name, sizeof name, NULL));
  CHECK(strcmp(name, "pin.angle effort") == 0);
  CHECK_OK(koppel_linearisation_unit(linear, KOPPEL_LINEAR_STATE, 1, name, sizeof name, NULL));
  CHECK(strcmp(name, "rad/s") == 0);
  CHECK_OK(koppel_linearisation_matrix(linear, KOPPEL_MATRIX_A, a, wrongs, 4));
  CHECK(a[1] == 1.0);
  CHECK_NEAR(a[2], -9.81, wrongs[2]);
  CHECK_OK(koppel_linearisation_matrix(linear, KOPPEL_MATRIX_B, b, NULL, 2));
  CHECK_NEAR(b[1], 1.0, 1e-12);
  CHECK_OK(koppel_linearisation_mode(linear, 0, &mode, &real, &imaginary, 1));
  CHECK_NEAR(mode.imaginary, sqrt(9.81), mode.error);
  CHECK(real == 1.0 && imaginary == 0.0);
  koppel_linearisation_destroy(linear);
  koppel_equilibrium_destroy(rest);
  koppel_work_destroy(work);
  koppel_state_destroy(state);
  koppel_mechanism_destroy(mechanism);
  koppel_scene_destroy(scene);
}

/* The same weight once more, as a tree: what holds it, how it falls, what it has. Two states: at the side, and below.
 */
static void knows_the_dynamics_of_trees(koppel_engine* engine) {
  static const char text[] =
      "schema = 1\n[scene]\ngravity = [0, -9.81, 0]\n[[body]]\nname = 'weight'\ntype = 'point_mass'\n"
      "mass = 2\nat = [0, -1, 0]\n[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'weight'\n";
  koppel_scene* scene = NULL;
  koppel_mechanism* mechanism = NULL;
  koppel_tree* tree = NULL;
  SIZED(koppel_error, error);
  const double right = acos(0.0), q[] = {right, 0.0}, v[] = {3.0, 3.0};
  double efforts[2], a[2], mass[2], kinetic[2], potential[2], centre[6], momentum[6], spin[6], by_q[2], by_v[2],
      by_f[2];
  CHECK_OK(koppel_scene_from_text(engine, text, sizeof text - 1, NULL, NULL, &scene, &error));
  CHECK_OK(koppel_mechanism_compile(scene, NULL, &mechanism, &error));
  CHECK_OK(koppel_tree_create(mechanism, &tree, &error));
  CHECK_OK(koppel_tree_inverse_dynamics(tree, 2, q, v, NULL, efforts, &error));
  CHECK_NEAR(efforts[0], 2.0 * 9.81, 1e-14);
  CHECK_NEAR(efforts[1], 0.0, 1e-14);
  CHECK_OK(koppel_tree_forward_dynamics(tree, 2, q, v, NULL, a, &error));
  CHECK_NEAR(a[0], -9.81, 1e-14);
  CHECK_OK(koppel_tree_mass_matrix(tree, 2, q, mass, &error));
  CHECK_NEAR(mass[0], 2.0, 1e-14);
  CHECK_OK(koppel_tree_energy(tree, 2, q, v, kinetic, potential, &error));
  CHECK_NEAR(kinetic[1], 9.0, 1e-14);
  CHECK_NEAR(potential[1], -2.0 * 9.81, 1e-14);
  CHECK_OK(koppel_tree_momentum(tree, 2, q, v, mass, centre, momentum, spin, &error));
  CHECK(mass[1] == 2.0);
  CHECK_NEAR(centre[0], 1.0, 1e-14);
  CHECK_NEAR(momentum[1], 6.0, 1e-14);
  CHECK_NEAR(spin[2], 0.0, 1e-14);
  CHECK_OK(koppel_tree_inverse_dynamics_derivatives(tree, 2, q, v, NULL, by_q, by_v, &error));
  CHECK_NEAR(by_q[1], 2.0 * 9.81, 1e-14);
  CHECK_NEAR(by_v[1], 0.0, 1e-14);
  CHECK_OK(koppel_tree_forward_dynamics_derivatives(tree, 2, q, v, NULL, by_q, by_v, by_f, &error));
  CHECK_NEAR(by_q[1], -9.81, 1e-14);
  CHECK_NEAR(by_f[0], 0.5, 1e-14);
  koppel_tree_destroy(tree);
  koppel_mechanism_destroy(mechanism);
  koppel_scene_destroy(scene);
}

static void uses_a_suspension(koppel_engine* engine, const char* file, const char* url) {
  koppel_scene* scene = NULL;
  koppel_mechanism* mechanism = NULL;
  koppel_state* state = NULL;
  koppel_work* work = NULL;
  SIZED(koppel_sizes, sizes);
  SIZED(koppel_error, error);
  size_t frame = MOST;
  CHECK_OK(koppel_scene_from_file(engine, file, NULL, &scene, &error));
  CHECK_OK(koppel_mechanism_compile(scene, NULL, &mechanism, &error));
  CHECK_OK(koppel_mechanism_sizes(mechanism, &sizes));
  CHECK_OK(koppel_mechanism_find(mechanism, KOPPEL_KIND_FRAME, "wheel_centre", &frame, &error));
  CHECK_OK(koppel_state_create(mechanism, &state));
  CHECK_OK(koppel_work_create(mechanism, &work));
  if (failures > 0 || sizes.coordinates > MOST) return;
  describes_itself(mechanism);
  closes_by_every_method(mechanism, work);
  explains_its_flow(mechanism);
  finds_its_modes(mechanism, work, &sizes);
  has_rates(state, work, frame, &sizes);
  moves(state, work, frame, &sizes);
  keeps_copies(mechanism, state, &sizes);
  streams(mechanism, state, work, url);
  koppel_work_destroy(work);
  koppel_state_destroy(state);
  koppel_mechanism_destroy(mechanism);
  koppel_scene_destroy(scene);
}

int main(int count, char** arguments) {
  if (count != 4) return 2;
  int lines = 0;
  koppel_engine* engine = NULL;
  SIZED(koppel_error, error);
  koppel_engine_options options = {
      .struct_size = sizeof options, .log = count_lines, .log_context = &lines, .log_level = KOPPEL_LOG_DEBUG};
  const koppel_version version = koppel_library_version();
  CHECK(version.major == KOPPEL_ABI_MAJOR && version.minor >= KOPPEL_ABI_MINOR);
  CHECK_OK(koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, &options, &engine, &error));
  CHECK_OK(koppel_engine_add_plugin(engine, &host_plugin, &error));
  CHECK_OK(koppel_engine_load_plugin(engine, arguments[2], &error));
  CHECK(lines > 0);
  explains_its_findings(engine);
  drives_by_its_own_function(engine);
  simulates_a_pendulum(engine);
  rests_and_linearises(engine);
  knows_the_dynamics_of_trees(engine);
  uses_a_suspension(engine, arguments[1], arguments[3]);
  koppel_engine_destroy(engine);
  printf("%d checks, %d failures\n", checks, failures);
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* The smallest useful host: a four-bar linkage turns once; the rocker's angle is printed.
 * Build against an installed tree or this one: cc -std=c11 -I abi/include embed.c -L build/lib -lkoppel */
#include <koppel/koppel.h>
#include <stdio.h>
#include <string.h>

static const char scene_text[] =
    "schema = 1\n"
    "[scene]\n"
    "name = \"fourbar\"\n"
    "[[body]]\n"
    "name = \"crank\"\n"
    "[[body]]\n"
    "name = \"coupler\"\n"
    "[[body]]\n"
    "name = \"rocker\"\n"
    "[[joint]]\n" /* design position: the crank points up, all axes along world z */
    "name = \"crank\"\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0, 0]\n"
    "[[joint]]\n"
    "name = \"a\"\ntype = \"revolute\"\nbetween = [\"crank\", \"coupler\"]\nat = [0, 0.1, 0]\n"
    "[[joint]]\n"
    "name = \"b\"\ntype = \"revolute\"\nbetween = [\"coupler\", \"rocker\"]\nat = [0.3, 0.25, 0]\n"
    "[[joint]]\n"
    "name = \"rocker\"\ntype = \"revolute\"\nbetween = [\"rocker\", \"ground\"]\nat = [0.35, 0, 0]\n"
    "[[drive]]\n"
    "of = \"crank.angle\"\ntype = \"ramp\"\nslope = \"360 deg\"\n"
    "[[record]]\n"
    "of = \"rocker.angle\"\n";

enum { STEPS = 12 };

static int complain(const koppel_error* error) {
  fprintf(stderr, "%s: %s\n%s\n", error->code, error->message, error->advice);
  return 1;
}

/* Turns the crank once; the handles belong to the caller. */
static int turn(koppel_state* state, koppel_work* work, koppel_error* error) {
  for (int i = 0; i <= STEPS; ++i) {
    koppel_report report = {.struct_size = sizeof report};
    double angle = 0.0;
    if (koppel_move(state, work, (double)i / STEPS, &report, error) < 0) return complain(error);
    if (koppel_records(state, work, &angle, 1) < 0) return 1;
    printf("%.4f s  rocker %+.6f rad  residual %.1e\n", koppel_state_time(state), angle, report.residual);
  }
  return 0;
}

int main(void) {
  koppel_engine* engine = NULL;
  koppel_scene* scene = NULL;
  koppel_mechanism* mechanism = NULL;
  koppel_state* state = NULL;
  koppel_work* work = NULL;
  koppel_error error = {.struct_size = sizeof error};
  int failed = 1;

  if (koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, NULL, &engine, &error) < 0 ||
      koppel_scene_from_text(engine, scene_text, strlen(scene_text), NULL, NULL, &scene, &error) < 0 ||
      koppel_mechanism_compile(scene, NULL, &mechanism, &error) < 0) {
    complain(&error);
  } else if (koppel_state_create(mechanism, &state) >= 0 && koppel_work_create(mechanism, &work) >= 0) {
    failed = turn(state, work, &error);
  }

  koppel_work_destroy(work);
  koppel_state_destroy(state);
  koppel_mechanism_destroy(mechanism);
  koppel_scene_destroy(scene);
  koppel_engine_destroy(engine);
  return failed;
}

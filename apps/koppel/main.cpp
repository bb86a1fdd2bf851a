// The `koppel` command.
#include <cstdio>
#include <exception>
#include <string>

#include "koppel/command.hpp"

namespace {

using namespace koppel::app;

constexpr const char* description =
    "koppel: mechanisms with closed loops, assembled, moved and streamed.\n"
    "A mechanism is described in a scene, a TOML file; apps/scenes/README.md explains the language.";

constexpr const char* footer =
    "Examples:\n"
    "  koppel check fourbar.toml                       find every fault; count freedoms; close at t = 0\n"
    "  koppel explain fourbar.toml                     how the loops are cut, equations and unknowns\n"
    "  koppel explain fourbar.toml --flow flow.svg     in which order the coordinates follow from the inputs, drawn\n"
    "  koppel explain E0304                            what a finding means\n"
    "  koppel modes fourbar.toml                       every closed position for the inputs at t = 0\n"
    "  koppel run fourbar.toml                         move the drives as the scene proposes\n"
    "  koppel run fourbar.toml --steps 1000 --csv -    and print the recorded columns\n"
    "  koppel run fourbar.toml --log run.lcm           and keep every state in an LCM log\n"
    "  koppel run fourbar.toml --through               and go on past the limits of its drives\n"
    "  koppel simulate pendulum.toml                   move by forces and masses; energy balance and drift of the "
    "loops\n"
    "  koppel reactions pendulum.toml --time 0.5       what every joint and drive bears there\n"
    "  koppel equilibrium fourbar.toml                 where it rests, and whether it stays there\n"
    "  koppel linearise fourbar.toml                   frequencies, damping and modes about that position\n"
    "  koppel bench --out results                      speed against error; a page with curves and tables\n"
    "Exit codes:\n"
    "  0 fine   1 the scene has errors   2 wrong usage   3 the mechanism did not close, or cannot move or rest as "
    "asked\n"
    "  4 a file, a stream or the system failed   5 a bench fails a hard case or is less exact than an older one\n"
    "Results go to standard output, findings and progress to standard error.";

std::string version_text() {
  const koppel_version library = koppel_library_version();
  return "koppel " + std::to_string(library.major) + '.' + std::to_string(library.minor) + '.' +
         std::to_string(library.patch);
}

int command(int argc, char** argv) {
  CLI::App app(description, "koppel");
  app.footer(footer);
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.fallthrough();
  Common common;
  Exit outcome = Exit::fine;
  app.add_flag("-v,--verbose", common.verbose, "Print the library's log on standard error");
  add_bench(app, common, outcome);
  add_check(app, common, outcome);
  add_equilibrium(app, common, outcome);
  add_explain(app, common, outcome);
  add_linearise(app, common, outcome);
  add_modes(app, common, outcome);
  add_reactions(app, common, outcome);
  add_run(app, common, outcome);
  add_simulate(app, common, outcome);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(Exit::usage);
  }
  return static_cast<int>(outcome);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return command(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return static_cast<int>(koppel::app::Exit::system);
  }
}

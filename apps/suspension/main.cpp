// suspension SCENE: the table and the picture that a suspension engineer looks for.
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <numbers>
#include <string>

#include <CLI/CLI.hpp>

#include "common/table.hpp"
#include "suspension/picture.hpp"
#include "suspension/sweep.hpp"

namespace {

using namespace koppel::app;

constexpr double degree = std::numbers::pi / 180.0;

struct Options {
  std::string scene, svg, log, csv;
  SweepOptions sweep;
};

/// Changes of track and wheelbase against the design position, of this wheel alone.
struct Change {
  double track, wheelbase;
};

Change change(const SweepResult& result, const Row& row) {
  const Wheel& design = result.rows[result.design].wheel;
  return {result.side * (row.wheel.contact[1] - design.contact[1]), row.wheel.contact[0] - design.contact[0]};
}

/// Rounded to the digits shown, so that no zero has a sign.
double shown(double value, double digit) { return std::round(value / digit) * digit + 0.0; }

void print_table(const SweepResult& result) {
  std::puts("travel      wheel centre [mm]           camber      toe     track  wheelbase    residual   error    time");
  std::puts("  [mm]         x         y         z     [deg]    [deg]      [mm]       [mm]                        [us]");
  for (const Row& row : result.rows) {
    const Wheel& wheel = row.wheel;
    const auto [track, wheelbase] = change(result, row);
    std::printf("%+6.0f %9.3f %9.3f %9.3f %+9.4f %+8.4f %+9.3f %+10.3f     %.1e %.1e %7.2f\n", 1e3 * row.travel,
                shown(1e3 * wheel.centre[0], 1e-3), shown(1e3 * wheel.centre[1], 1e-3),
                shown(1e3 * wheel.centre[2], 1e-3), shown(wheel.camber / degree, 1e-4), shown(wheel.toe / degree, 1e-4),
                shown(1e3 * track, 1e-3), shown(1e3 * wheelbase, 1e-3), row.report.residual,
                row.report.coordinate_error, 1e6 * row.seconds);
  }
  const Wheel& design = result.rows[result.design].wheel;
  std::printf("at the design position: camber %+.3f deg, toe %+.3f deg for each 10 mm of travel\n",
              design.camber_rate / degree * 0.01 / result.speed, design.toe_rate / degree * 0.01 / result.speed);
  std::puts("ISO 8855: x forward, y left, z up; toe-in positive, camber positive when the top leans out; track and");
  std::puts("wheelbase change of this wheel alone. residual: of the closure, in parts of the scene's length (radians");
  std::puts("for rotations); error: estimate for the worst coordinate; time: position, velocity and acceleration.");
}

bool write_table(const std::string& file, const SweepResult& result) {
  Table table(file, {"travel", "x", "y", "z", "camber", "toe", "track_change", "wheelbase_change", "residual",
                     "coordinate_error", "seconds"});
  for (const Row& row : result.rows) {
    const Wheel& wheel = row.wheel;
    const auto [track, wheelbase] = change(result, row);
    table.row({row.travel, wheel.centre[0], wheel.centre[1], wheel.centre[2], wheel.camber, wheel.toe, track, wheelbase,
               row.report.residual, row.report.coordinate_error, row.seconds});
  }
  return table.good();
}

Exit cannot_write(const std::string& file) {
  std::fprintf(stderr, "error: cannot write %s\n", file.c_str());
  return Exit::system;
}

Exit show(const Options& options) {
  const Model model = load(options.scene, false);
  model.print_findings();
  if (!model.mechanism) return model.outcome;

  Stream stream;
  if (!options.log.empty()) {
    const std::string url = "file://" + options.log + "?mode=w";
    auto stream_options = sized<koppel_stream_options>();
    stream_options.url = url.c_str();
    auto error = sized<koppel_error>();
    koppel_stream* opened = nullptr;
    if (koppel_stream_open(model.mechanism.get(), &stream_options, &opened, &error) < 0) {
      print_error(error);
      return Exit::system;
    }
    stream.reset(opened);
  }

  const SweepResult result = sweep(model, options.sweep, stream.get());
  if (result.outcome != Exit::fine) {
    print_error(result.error);
    return result.outcome;
  }
  print_table(result);
  if (!options.csv.empty() && !write_table(options.csv, result)) return cannot_write(options.csv);
  if (!options.svg.empty()) {
    std::ofstream file(options.svg);
    file << picture(model, options.sweep, result);
    if (!file.flush()) return cannot_write(options.svg);
    std::printf("picture: %s\n", options.svg.c_str());
  }
  if (stream) {
    if (koppel_stream_close(stream.release(), nullptr) < 0) return cannot_write(options.log);
    std::printf("LCM log: %s\n", options.log.c_str());
  }
  return Exit::fine;
}

int command(int argc, char** argv) {
  CLI::App app("Moves a wheel suspension through its travel: wheel centre, camber, toe, track and wheelbase.",
               "suspension");
  Options options;
  app.add_option("SCENE", options.scene, "The scene file")->required()->type_name("");
  app.add_option("--svg", options.svg, "Write a picture: three positions, toe and camber over travel")
      ->type_name("FILE");
  app.add_option("--log", options.log, "Keep every position in an LCM log")->type_name("FILE");
  app.add_option("--csv", options.csv, "Write the table with all digits, SI units and radians")->type_name("FILE");
  app.add_option("--input", options.sweep.input, "The driven coordinate that lifts the wheel")
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option("--frame", options.sweep.frame,
                 "Frame of the wheel: origin at its centre, y along its axis to the left")
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option("--travel", options.sweep.travel, "Up and down from the design position")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--spacing", options.sweep.spacing, "Between two rows")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--tyre-radius", options.sweep.radius, "Track and wheelbase are then those of the contact point")
      ->type_name("METRES")
      ->check(CLI::NonNegativeNumber);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(Exit::usage);
  }
  return static_cast<int>(show(options));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return command(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return static_cast<int>(Exit::system);
  }
}

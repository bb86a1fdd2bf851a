#include "koppel/simulate_options.hpp"

#include <cmath>
#include <utility>

namespace koppel::app {
namespace {

std::string positive(const std::string& text) {
  double value = 0.0;
  const bool good = CLI::detail::lexical_cast(text, value) && value > 0.0 && std::isfinite(value);
  return good ? "" : "must be a positive number";
}

}  // namespace

void add_simulate_options(CLI::App& app, const std::shared_ptr<SimulateOptions>& options, std::function<void()> run) {
  CLI::App* command = app.add_subcommand(
      "simulate", "Move a scene by its forces, masses and drives; record, stream, tell how exactly and how fast");
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_option("--duration", options->duration, "How long; default: as the scene proposes")
      ->check(positive)
      ->type_name("SECONDS");
  command->add_option("--steps", options->steps, "How many rows of output; default: as the scene proposes")
      ->check(CLI::Range(1u, 1000000000u))
      ->type_name("N");
  CLI::Option* tolerance =
      command
          ->add_option("--tolerance", options->tolerance,
                       "Error of an integration step that is allowed; default: as the scene says, or 1e-8")
          ->check(positive)
          ->type_name("X");
  CLI::Option* step = command->add_option("--step", options->step, "Integrate in fixed steps instead")
                          ->check(positive)
                          ->excludes(tolerance)
                          ->type_name("SECONDS");
  CLI::Option* integrator =
      command
          ->add_option("--integrator", options->integrator,
                       "Default: as the scene says, or dormand_prince, or classical with --step. One of\n" +
                           text_of(koppel_integrators))
          ->check(not_empty)
          ->type_name("NAME");
  CLI::Option* formulation = command
                                 ->add_option("--formulation", options->formulation,
                                              "How loops enter the equations of motion; default: minimal. One of\n" +
                                                  text_of(koppel_formulations))
                                 ->check(not_empty)
                                 ->type_name("NAME");
  CLI::Option* estimate =
      command->add_flag("--estimate", options->estimate,
                        "Estimate the error of the whole motion by a second one with a tenth of the tolerance, or half "
                        "the step");
  CLI::Option* checkpoint = command
                                ->add_option("--checkpoint", options->checkpoint,
                                             "At the end, keep in a file all that the motion goes on from")
                                ->check(not_empty)
                                ->type_name("FILE");
  command->add_option("--checkpoint-every", options->every, "And so often, at the rows from then on")
      ->check(positive)
      ->needs(checkpoint)
      ->type_name("SECONDS");
  command->add_option("--resume", options->resume, "Go on from a checkpoint of this scene, by the same integrator")
      ->check(not_empty)
      ->excludes(tolerance)
      ->excludes(step)
      ->excludes(integrator)
      ->excludes(formulation)
      ->excludes(estimate)
      ->type_name("FILE");
  CLI::Option* csv = add_recorder_options(*command, options->record,
                                          "Write time and recorded columns (SI units, radians); - is standard output");
  command->add_flag("--realtime", options->realtime, "Let a second of the motion take a second");
  command->add_flag("-q,--quiet", options->quiet, "Print errors only");
  command->add_flag("--json", options->json, "Print the summary as JSON");
  command->callback([options, csv, run = std::move(run)] {
    if (options->json && csv->count() > 0 && options->record.csv == "-") {
      throw CLI::ValidationError("--csv", "standard output cannot take both the table and --json");
    }
    run();
  });
}

}  // namespace koppel::app

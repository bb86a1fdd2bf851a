// What `koppel simulate` can be told.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "koppel/command.hpp"
#include "koppel/recorder.hpp"

namespace koppel::app {

struct SimulateOptions {
  std::string scene;
  std::optional<double> duration;
  std::optional<std::uint32_t> steps;
  double tolerance = 0.0, step = 0.0;
  std::string integrator, formulation;
  std::string checkpoint, resume;  ///< files
  double every = 0.0;              ///< [s] of the motion, between checkpoints; 0: at the end only
  bool estimate = false;
  RecorderOptions record;
  bool realtime = false;
  bool quiet = false;
  bool json = false;
};

/// Adds the command with its options; run is called when the user chooses it.
void add_simulate_options(CLI::App& app, const std::shared_ptr<SimulateOptions>& options, std::function<void()> run);

}  // namespace koppel::app

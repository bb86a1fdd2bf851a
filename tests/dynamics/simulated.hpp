// A scene on its way: what tests of simulations start from.
#pragma once

#include <fstream>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "../mechanism/built.hpp"
#include "closure/close.hpp"
#include "dynamics/simulation.hpp"
#include "folders.hpp"

namespace koppel::test {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

inline std::string scene(const std::string& name) {
  std::ifstream file(scenes_folder() + "/dynamics/" + name + ".toml");
  EXPECT_TRUE(file) << name;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A scene on its way, from its start at t = 0.
struct Simulated {
  Simulated(const std::string& text, const SimulationOptions& options, double push = 0.0)
      : built(text), work(built.mechanism), state(*built.mechanism) {
    CloseOptions how;
    Report report;
    EXPECT_GE(close(work, state, how, report), 0);
    if (push != 0.0) {
      for (const StateBlock& block : built->blocks) {
        if (is_scalar(block.kind) && built->column_of_rate[block.v] >= 0) state.v[block.v] += push;
      }
    }
    auto made = Simulation::of(built.mechanism, options);
    if (!made) throw std::runtime_error(koppel::render(made.error()));
    simulation = std::move(*made);
    started = simulation->start(state);
  }

  void to(double time) {
    ASSERT_TRUE(started) << koppel::render(started.error());
    const auto advanced = simulation->advance(time, state);
    ASSERT_TRUE(advanced) << koppel::render(advanced.error());
  }
  double q(const std::string& name) const { return state.q[built.coordinate(name)]; }
  double v(const std::string& name) const {
    for (std::size_t i = 0; i < built->rate_names.size(); ++i) {
      if (built->rate_names[i].name == name) return state.v[static_cast<Eigen::Index>(i)];
    }
    throw std::runtime_error("no rate " + name);
  }

  Built built;
  Work work;
  State state;
  std::unique_ptr<Simulation> simulation;
  Result<void> started;
};

inline SimulationOptions within(double tolerance, double end) {
  SimulationOptions options;
  options.tolerance = tolerance;
  options.end = end;
  return options;
}

inline SimulationOptions by(IntegratorKind integrator, double tolerance, double step, double end) {
  SimulationOptions options;
  options.integrator = integrator;
  options.formulation = formulation_for(integrator).kind;
  options.tolerance = tolerance;
  options.step = step;
  options.end = end;
  return options;
}

}  // namespace koppel::test

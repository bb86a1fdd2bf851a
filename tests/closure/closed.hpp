// Mechanisms with their work and state, made from shipped scenes or short texts.
#pragma once

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "../mechanism/built.hpp"
#include "../spatial/directions.hpp"
#include "closure/close.hpp"
#include "folders.hpp"

namespace koppel::test {

using Replacements = std::vector<std::pair<std::string, std::string>>;

/// The text of a shipped scene, changed here and there.
inline std::string shipped(const std::string& name, const Replacements& replacements = {}) {
  std::ifstream file(std::filesystem::path(scenes_folder()) / (name + ".toml"));
  std::ostringstream text;
  text << file.rdbuf();
  const std::size_t start = text.str().find("schema");
  std::string result = text.str().substr(start == std::string::npos ? 0 : start);
  for (const auto& [old, with] : replacements) result = replaced(result, old, with);
  return result;
}

struct Closed {
  explicit Closed(const std::string& text, std::shared_ptr<Registry> types = Built::types())
      : built(text, std::move(types)) {}

  koppel_status close(const CloseOptions& options = {}) { return koppel::close(work, state, options, report); }
  koppel_status move(double time) { return koppel::move(work, state, time, report); }
  double at(const std::string& coordinate) const { return state.q[built.coordinate(coordinate)]; }
  /// What the equations say of the state, evaluated by a work of their own.
  double residual() const {
    Equations equations(*built);
    EXPECT_TRUE(equations.evaluate(state.q, state.time));
    return equations.error();
  }

  Built built;
  Work work{built.mechanism};
  State state{*built.mechanism};
  Report report;
};

/// Shipped scenes whose flow is in closed form and leaves no choice.
inline constexpr std::array closed_form_scenes = {"4bar",   "rstr",  "rscr",        "rccc", "swash",   "drive",
                                                  "sph4",   "chain", "7b10j",       "sar",  "9body",   "bennett",
                                                  "cardan", "panto", "slidercrank", "3rpr", "6r_pose", "6joint"};

inline bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0);
}

inline bool same_bits(const State& a, const State& b) {
  return same_bits(a.q, b.q) && same_bits(a.v, b.v) && same_bits(a.a, b.a) && a.time == b.time && a.stage == b.stage &&
         same_bits(a.input, b.input) && same_bits(a.input_rate, b.input_rate) &&
         same_bits(a.input_acceleration, b.input_acceleration) && a.history.time == b.history.time &&
         a.history.step == b.history.step && same_bits(a.history.acceleration, b.history.acceleration);
}

}  // namespace koppel::test

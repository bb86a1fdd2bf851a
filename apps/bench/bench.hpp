// What `koppel bench` measures. Each part of the bench fills a section of one JSON document (README.md describes it)
// and leaves with `rounds` what is to be timed; page, tables and comparison are made from the document alone.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/rounds.hpp"

namespace koppel::app::bench {

struct Plan {
  std::vector<std::string> names;  ///< of what is wanted: "andrews", "simulation/andrews", "simulation"; none: all
  std::string scenes;              ///< folder
  std::string peers;               ///< folder of the programs of other engines; empty: they are not asked
  bool quick = false;              ///< fewer settings, smaller sizes, less time for each
};

/// A bench on its way.
struct Bench {
  const Plan& plan;
  Json document;
  Rounds rounds;

  bool wants(const std::string& section, const std::string& name) const;
  /// A new entry of a section, as a path for Rounds::add and document.at.
  Json::json_pointer entry(const std::string& section, Json data);
};

/// Everything that can be measured, as "section/name".
std::vector<std::string> all_names(const Plan& plan);

/// The sections: motions by forces, error over time for each method and setting;
void add_simulations(Bench& bench);
/// closed positions of shipped scenes, from near and from the start;
void add_closures(Bench& bench);
/// chains of growing length: time, error and memory;
void add_scaling(Bench& bench);
/// hard cases, each with what should come out (true: all did);
bool add_cases(Bench& bench);
/// and where the time goes in the run of each scene. At once: nothing is left to the rounds.
void add_profiles(Bench& bench);

/// Runs all of it; `seconds` and the state of the machine are in the document at the end.
Json run(const Plan& plan);

}  // namespace koppel::app::bench

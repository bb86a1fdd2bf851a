// Hard cases. Each knows what should come out, from mechanics and not from koppel, and how near that must be met.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/bench.hpp"

namespace koppel::app::bench {

struct Outcome {
  std::string found;   ///< in words
  double error = 0.0;  ///< from what is expected; NaN: it failed
  double allowed = 0.0;
  bool pass() const { return error <= allowed; }
};

struct Case {
  std::string name;
  std::string what;      ///< what is hard about it
  std::string expected;  ///< what should come out, and why the error may be as large as it may
  std::function<Outcome(const Plan& plan)> run;
};

std::vector<Case> cases();
/// Parts of that list: mechanisms moved by drives,
std::vector<Case> singular_positions();
std::vector<Case> odd_measures();
std::vector<Case> verdicts();
/// and by forces.
std::vector<Case> hard_motions();

}  // namespace koppel::app::bench

#include "bench/cases.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace koppel::app::bench {

std::vector<Case> cases() {
  std::vector<Case> all;
  for (auto part : {singular_positions, odd_measures, verdicts, hard_motions}) {
    std::vector<Case> some = part();
    std::move(some.begin(), some.end(), std::back_inserter(all));
  }
  return all;
}

bool add_cases(Bench& bench) {
  bool pass = true;
  for (const Case& hard : cases()) {
    if (!bench.wants("case", hard.name)) continue;
    progress("case/" + hard.name);
    const Stopwatch watch;
    const Outcome outcome = hard.run(bench.plan);
    const double seconds = watch.seconds();
    pass = pass && outcome.pass();
    bench.entry("cases", {{"name", hard.name},
                          {"what", hard.what},
                          {"expected", hard.expected},
                          {"found", outcome.found},
                          {"error", std::isfinite(outcome.error) ? Json(outcome.error) : Json(nullptr)},
                          {"allowed", outcome.allowed},
                          {"pass", outcome.pass()},
                          {"took", seconds}});
  }
  return pass;
}

}  // namespace koppel::app::bench

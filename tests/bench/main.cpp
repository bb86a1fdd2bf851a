// koppel_bench: times of core's kinematics and closure on shipped scenes. README.md tells how to run and read it.
#include <cstdio>
#include <utility>

#include "benchmarks.hpp"

namespace {

using koppel::bench::Run;

constexpr std::pair<const char*, void (*)(benchmark::State&, const Run&)> benchmarks[] = {
    {"position", koppel::bench::position},
    {"position_and_motion", koppel::bench::position_and_motion},
    {"newton_warm", koppel::bench::newton_warm},
    {"ceres_cold", koppel::bench::ceres_cold},
    {"rates", koppel::bench::rates},
    {"move", koppel::bench::move_step},
    {"modes", koppel::bench::all_modes}};

constexpr const char* scenes[] = {"4bar", "rstr", "multilink", "stewart", "9body", "chain"};

}  // namespace

int main(int count, char** arguments) {
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  benchmark::AddCustomContext("compiler", KOPPEL_COMPILER);
  benchmark::AddCustomContext("flags", KOPPEL_FLAGS);
  std::vector<Run> runs;
  for (const char* scene : scenes) {
    auto run = koppel::bench::load(scene);
    if (!run) {
      std::fputs(koppel::render(run.error()).c_str(), stderr);
      return 1;
    }
    runs.push_back(std::move(*run));
  }
  for (const auto& [name, function] : benchmarks) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::string title = std::string(name) + "/" + scenes[i];
      benchmark::RegisterBenchmark(title.c_str(), function, std::cref(runs[i]))->Unit(benchmark::kMicrosecond);
    }
  }
  constexpr int lengths[] = {1, 4, 16, 64};
  std::vector<Run> rows;
  for (const int length : lengths) {
    auto row = koppel::bench::load_chain(length);
    if (!row) {
      std::fputs(koppel::render(row.error()).c_str(), stderr);
      return 1;
    }
    rows.push_back(std::move(*row));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string title = "move/row_of_" + std::to_string(lengths[i]);
    benchmark::RegisterBenchmark(title.c_str(), koppel::bench::move_step, std::cref(rows[i]))
        ->Unit(benchmark::kMicrosecond);
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}

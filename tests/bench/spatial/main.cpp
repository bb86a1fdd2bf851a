// spatial_bench: times of core/spatial's conversions and operations, with their errors beside them and next to other
// libraries. ../README.md tells how to run and read it.
#include <map>
#include <utility>

#include <benchmark/benchmark.h>

#include "batch.hpp"
#include "problems.hpp"

namespace koppel::bench {
namespace {

constexpr std::size_t count = 1000;  // inputs that are compared
constexpr std::size_t timed = 128;   // of them; they fit the first cache
constexpr double another = 1e6;      // units of rounding: this is not an error but another function

struct Rotated {
  const char* name;
  Rotations rotations;
  std::map<std::string, Problem> problems;  // by operation, made when one is needed
};

const Problem& problem(Rotated& inputs, const Operation& operation) {
  auto& problems = inputs.problems;
  if (!problems.contains(operation.name)) problems[operation.name] = operation.problem(inputs.rotations);
  return problems[operation.name];
}

void measure(benchmark::State& timer, const Library& library, const Operation& operation, Rotated& inputs) {
  const Problem& task = problem(inputs, operation);
  const auto batch = library.batch(operation.name, task.inputs);
  const Errors errors = task.errors(batch->results());
  if (errors.by_condition > another && inputs.name == std::string("random")) {
    return timer.SkipWithError("the results are those of another function");
  }
  while (timer.KeepRunningBatch(timed)) batch->run(timed);
  timer.counters["error"] = errors.error;
  timer.counters["error/condition"] = errors.by_condition;
}

}  // namespace
}  // namespace koppel::bench

int main(int argument_count, char** arguments) {
  using namespace koppel::bench;
  // A table, and not too long for each of its many rows, unless the command line says otherwise.
  char table[] = "--benchmark_counters_tabular=true", time[] = "--benchmark_min_time=0.1";
  std::vector<char*> words(arguments, arguments + argument_count);
  words.insert(words.begin() + 1, {table, time});
  int word_count = static_cast<int>(words.size());
  benchmark::Initialize(&word_count, words.data());
  if (benchmark::ReportUnrecognizedArguments(word_count, words.data())) return 2;
  benchmark::AddCustomContext("compiler", KOPPEL_COMPILER);
  benchmark::AddCustomContext("flags", KOPPEL_FLAGS);

  const std::vector<std::pair<const char*, Library>> libraries = {
      {"koppel", koppel_library()},   {"eigen", eigen_library()}, {"ceres", ceres_library()},
#ifdef SPATIAL_BENCH_KDL
      {"kdl", kdl_library()},
#endif
#ifdef SPATIAL_BENCH_SIMBODY
      {"simbody", simbody_library()},
#endif
  };
  const std::vector<Operation> list = operations();
  Rotated batches[] = {{"random", random_rotations(count), {}}, {"special", special_rotations(count), {}}};
  for (const Operation& operation : list) {
    for (Rotated& inputs : batches) {
      for (const auto& [name, library] : libraries) {
        if (!library.has(operation.name)) continue;
        const std::string row = operation.name + "/" + inputs.name + "/" + name;
        benchmark::RegisterBenchmark(row.c_str(), measure, std::cref(library), std::cref(operation), std::ref(inputs));
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}

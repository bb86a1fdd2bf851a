// dynamics_bench: times of the dynamics of open trees, each with its error beside it. README.md tells how to run and
// read it.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "../dynamics/spatial_reference.hpp"
#include "evaluation.hpp"

namespace koppel::bench {
namespace {

using Reference = test::SpatialReference<long double>;
using Vector = Reference::Vector;

double relative(const Vector& found, const Vector& exact) {
  return static_cast<double>((found - exact).norm() / exact.norm());
}

/// Errors against the textbook in long double; where the answer is a solution, of what was to be solved.
double no_error(Evaluation&, const TreeState&) { return 0.0; }
double efforts_error(Evaluation& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Vector exact = reference.efforts(state.q, state.v, state.a, bench.mechanism.gravity);
  return relative(bench.result.cast<long double>(), exact);
}
double mass_error(Evaluation& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Reference::Matrix exact = reference.mass(state.q);
  Eigen::MatrixXd found;
  bench.matrix.dense(found);
  return static_cast<double>((found.cast<long double>() - exact).norm() / exact.norm());
}
/// Of both derivatives; dual numbers carry the exact ones.
double derivatives_error(Evaluation& bench, const TreeState& state) {
  using Number = Dual<long double>;
  test::SpatialReference<Number> reference(bench.mechanism, bench.tree.inertias);
  const Vector3& gravity = bench.mechanism.gravity;
  long double off = 0.0L, size = 0.0L;
  for (std::uint32_t j = 0; j < bench.mechanism.nv; ++j) {
    const auto by_q = reference.efforts(test::displaced(bench.mechanism, state.q, j), state.v, state.a, gravity);
    Eigen::Matrix<Number, Eigen::Dynamic, 1> faster = state.v.cast<Number>();
    faster[j].dual = 1;
    const auto by_v = reference.efforts(state.q, faster, state.a, gravity);
    for (std::uint32_t k = 0; k < bench.mechanism.nv; ++k) {
      off += std::pow(by_q[k].dual - bench.by_q(k, j), 2) + std::pow(by_v[k].dual - bench.by_v(k, j), 2);
      size += std::pow(by_q[k].dual, 2) + std::pow(by_v[k].dual, 2);
    }
  }
  return static_cast<double>(std::sqrt(off / size));
}
double accelerations_error(Evaluation& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Vector needed = reference.efforts(state.q, state.v, bench.result, bench.mechanism.gravity);
  const Vector exact = state.efforts.cast<long double>();
  const Vector off = reference.mass(state.q).llt().solve(needed - exact);
  return static_cast<double>(off.norm() / bench.result.cast<long double>().norm());
}
double energy_error(Evaluation& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Vector v = state.v.cast<long double>();
  const long double exact = v.dot(reference.mass(state.q) * v) / 2;
  return static_cast<double>(std::abs(static_cast<long double>(bench.result[0]) - exact) / exact);
}

struct Row {
  const char* name;
  void (*evaluate)(Evaluation&, const TreeState&);
  double (*error)(Evaluation&, const TreeState&);
};

constexpr Row rows[] = {
    {"position", [](Evaluation& b, const TreeState& s) { b.position(s); }, no_error},
    {"motion", [](Evaluation& b, const TreeState& s) { b.motion(s, s.a); }, no_error},
    {"inverse_dynamics", [](Evaluation& b, const TreeState& s) { b.efforts(s); }, efforts_error},
    {"mass_matrix", [](Evaluation& b, const TreeState& s) { b.mass(s); }, mass_error},
    {"articulated_bodies", [](Evaluation& b, const TreeState& s) { b.by_bodies(s); }, accelerations_error},
    {"factored_mass", [](Evaluation& b, const TreeState& s) { b.by_factors(s); }, accelerations_error},
    {"derivatives", [](Evaluation& b, const TreeState& s) { b.efforts_by(s); }, derivatives_error},
    {"forward_derivatives", [](Evaluation& b, const TreeState& s) { b.accelerations_by(s); }, no_error},
    {"differences", [](Evaluation& b, const TreeState& s) { b.efforts_by_differences(s); }, derivatives_error},
    {"energy", [](Evaluation& b, const TreeState& s) { b.energy(s); }, energy_error},
};

void run(benchmark::State& timer, const Row& row, const Tree& tree) {
  Evaluation bench(tree);
  const auto batch = static_cast<benchmark::IterationCount>(tree.states.size());
  while (timer.KeepRunningBatch(batch)) {
    for (const TreeState& state : tree.states) {
      row.evaluate(bench, state);
      benchmark::ClobberMemory();
    }
  }
  if (!bench.fine) return timer.SkipWithError("a joint failed, or nothing resists");
  double worst = 0.0;
  for (const TreeState& state : tree.states) {
    row.evaluate(bench, state);
    worst = std::max(worst, row.error(bench, state));
  }
  timer.counters["error"] = worst;
  timer.counters["rates"] = static_cast<double>(tree.mechanism->nv);
}

}  // namespace
}  // namespace koppel::bench

int main(int count, char** arguments) {
  using namespace koppel::bench;
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  benchmark::AddCustomContext("compiler", KOPPEL_COMPILER);
  benchmark::AddCustomContext("flags", KOPPEL_FLAGS);
  const std::vector<Tree> trees{arm7(), chain(30), chain(200), humanoid30()};
  for (const Row& row : rows) {
    for (const Tree& tree : trees) {
      benchmark::RegisterBenchmark((std::string(row.name) + "/" + tree.name).c_str(), run, row, std::cref(tree))
          ->Unit(benchmark::kMicrosecond);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}

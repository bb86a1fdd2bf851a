// dynamics_bench: times of the dynamics of open trees, each with its error beside it. README.md tells how to run and
// read it.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "../dynamics/spatial_reference.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/forward_dynamics.hpp"
#include "dynamics/inverse_dynamics.hpp"
#include "dynamics/mass_matrix.hpp"
#include "dynamics/tree_derivatives.hpp"
#include "dynamics/tree_dynamics.hpp"
#include "trees.hpp"

namespace koppel::bench {
namespace {

using Reference = test::SpatialReference<long double>;
using Vector = Reference::Vector;

/// One evaluation after another of what is timed; everything that it needs.
struct Bench {
  explicit Bench(const Tree& of)
      : tree(of),
        mechanism(*of.mechanism),
        layout(mechanism),
        kinematics(mechanism),
        rest(Eigen::VectorXd::Zero(mechanism.nv)),
        result(rest),
        carried(mechanism.nodes),
        matrix(layout),
        mass_matrix(layout, tree.inertias),
        articulated(layout, tree.inertias),
        factored(layout, tree.inertias),
        derivatives(layout, tree.inertias),
        by_q(RowMatrix::Zero(mechanism.nv, mechanism.nv)),
        by_v(by_q),
        dynamics(of.mechanism, of.inertias) {}

  void position(const TreeState& state) { fine &= forward_position(mechanism, state.q.data(), kinematics); }
  void motion(const TreeState& state, const Eigen::VectorXd& a) {
    position(state);
    fine &= forward_motion(mechanism, state.q.data(), state.v.data(), a.data(), kinematics);
  }
  void efforts(const TreeState& state) {
    motion(state, state.a);
    inverse_dynamics(mechanism, tree.inertias, kinematics, mechanism.gravity, {}, carried, result);
  }
  void mass(const TreeState& state) {
    position(state);
    mass_matrix.evaluate(kinematics, matrix);
  }
  void by_bodies(const TreeState& state) {
    motion(state, rest);
    fine &= articulated.evaluate(kinematics, mechanism.gravity, {}, state.efforts, result);
  }
  void by_factors(const TreeState& state) {
    motion(state, rest);
    fine &= factored.evaluate(kinematics, mechanism.gravity, {}, state.efforts, result);
  }
  void efforts_by(const TreeState& state) {
    position(state);
    fine &=
        derivatives.evaluate(kinematics, mechanism.gravity, state.q.data(), state.v.data(), state.a.data(), by_q, by_v);
  }
  /// What the same takes by central differences of the efforts; good for some ten digits.
  void efforts_by_differences(const TreeState& state) {
    constexpr double step = 6e-6;  // the cube root of rounding
    TreeState ahead = state, behind = state;
    for (std::uint32_t j = 0; j < mechanism.nv; ++j) {
      rest[j] = step;
      integrate(mechanism, state.q, rest, ahead.q);
      integrate(mechanism, state.q, -rest, behind.q);
      rest[j] = 0.0;
      difference(ahead, behind, step, by_q.col(j));
    }
    ahead.q = behind.q = state.q;
    for (std::uint32_t j = 0; j < mechanism.nv; ++j) {
      ahead.v[j] = state.v[j] + step;
      behind.v[j] = state.v[j] - step;
      difference(ahead, behind, step, by_v.col(j));
      ahead.v[j] = behind.v[j] = state.v[j];
    }
  }
  void difference(const TreeState& ahead, const TreeState& behind, double step,
                  Eigen::Ref<Eigen::VectorXd, 0, Eigen::InnerStride<>> column) {
    efforts(ahead);
    column = result;
    efforts(behind);
    column = (column - result) / (2 * step);
  }
  void accelerations_by(const TreeState& state) {
    fine &= !dynamics.forward_derivatives(state.q.data(), state.v.data(), state.efforts.data());
  }
  void energy(const TreeState& state) {
    motion(state, rest);
    result[0] = mechanical_state(tree.inertias, kinematics, mechanism.gravity).kinetic;
  }

  const Tree& tree;
  const Mechanism& mechanism;
  TreeLayout layout;
  Kinematics kinematics;
  Eigen::VectorXd rest, result;
  std::vector<Wrench> carried;
  TreeMatrix matrix;
  MassMatrix mass_matrix;
  ArticulatedBodies articulated;
  FactoredDynamics factored;
  TreeDerivatives derivatives;
  RowMatrix by_q, by_v;
  TreeDynamics dynamics;
  bool fine = true;
};

double relative(const Vector& found, const Vector& exact) {
  return static_cast<double>((found - exact).norm() / exact.norm());
}

/// Errors against the textbook in long double; where the answer is a solution, of what was to be solved.
double no_error(Bench&, const TreeState&) { return 0.0; }
double efforts_error(Bench& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Vector exact = reference.efforts(state.q, state.v, state.a, bench.mechanism.gravity);
  return relative(bench.result.cast<long double>(), exact);
}
double mass_error(Bench& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Reference::Matrix exact = reference.mass(state.q);
  Eigen::MatrixXd found;
  bench.matrix.dense(found);
  return static_cast<double>((found.cast<long double>() - exact).norm() / exact.norm());
}
/// Of both derivatives; dual numbers carry the exact ones.
double derivatives_error(Bench& bench, const TreeState& state) {
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
double accelerations_error(Bench& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Vector needed = reference.efforts(state.q, state.v, bench.result, bench.mechanism.gravity);
  const Vector exact = state.efforts.cast<long double>();
  const Vector off = reference.mass(state.q).llt().solve(needed - exact);
  return static_cast<double>(off.norm() / bench.result.cast<long double>().norm());
}
double energy_error(Bench& bench, const TreeState& state) {
  Reference reference(bench.mechanism, bench.tree.inertias);
  const Vector v = state.v.cast<long double>();
  const long double exact = v.dot(reference.mass(state.q) * v) / 2;
  return static_cast<double>(std::abs(static_cast<long double>(bench.result[0]) - exact) / exact);
}

struct Row {
  const char* name;
  void (*evaluate)(Bench&, const TreeState&);
  double (*error)(Bench&, const TreeState&);
};

constexpr Row rows[] = {
    {"position", [](Bench& b, const TreeState& s) { b.position(s); }, no_error},
    {"motion", [](Bench& b, const TreeState& s) { b.motion(s, s.a); }, no_error},
    {"inverse_dynamics", [](Bench& b, const TreeState& s) { b.efforts(s); }, efforts_error},
    {"mass_matrix", [](Bench& b, const TreeState& s) { b.mass(s); }, mass_error},
    {"articulated_bodies", [](Bench& b, const TreeState& s) { b.by_bodies(s); }, accelerations_error},
    {"factored_mass", [](Bench& b, const TreeState& s) { b.by_factors(s); }, accelerations_error},
    {"derivatives", [](Bench& b, const TreeState& s) { b.efforts_by(s); }, derivatives_error},
    {"forward_derivatives", [](Bench& b, const TreeState& s) { b.accelerations_by(s); }, no_error},
    {"differences", [](Bench& b, const TreeState& s) { b.efforts_by_differences(s); }, derivatives_error},
    {"energy", [](Bench& b, const TreeState& s) { b.energy(s); }, energy_error},
};

void run(benchmark::State& timer, const Row& row, const Tree& tree) {
  Bench bench(tree);
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

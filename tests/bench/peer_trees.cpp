// trees_bench: the same algorithms on the same trees and states by koppel and by other engines, in one run, each with
// its error beside it. README.md tells how to run and read it.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "../dynamics/spatial_reference.hpp"
#include "evaluation.hpp"
#include "peer_table.hpp"
#include "peers/trees.hpp"

namespace koppel::bench {
namespace {

using peer::Algorithm;
using Reference = test::SpatialReference<long double>;
using Exact = std::vector<long double>;

/// Beyond this error an engine does not compute the same: its time does not count.
constexpr double same_result = 1e-6;

std::vector<double> numbers_of(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

/// What an engine is handed; the joints of the tree are revolute, about z, in the order of their rates.
peer::Tree handed(const Tree& tree) {
  const Mechanism& mechanism = *tree.mechanism;
  peer::Tree to;
  Eigen::Map<Vector3>(to.gravity.data()) = mechanism.gravity;
  std::map<Node, int> link_of{{Node{0}, -1}};
  for (const TreeStep& step : mechanism.steps) {
    peer::Link link;
    const SpatialInertia& body = tree.inertias.of_node[step.child];
    const Matrix3& i = body.about_centre;
    const Eigen::Quaterniond turn(step.to_near.rotation);
    link.parent = link_of.at(step.parent);
    link_of[step.child] = static_cast<int>(to.links.size());
    Eigen::Map<Vector3>(link.place.data()) = step.to_near.position;
    link.turn = {turn.w(), turn.x(), turn.y(), turn.z()};
    link.mass = body.mass;
    Eigen::Map<Vector3>(link.centre.data()) = body.centre;
    link.inertia = {i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)};
    to.links.push_back(link);
  }
  for (const TreeState& state : tree.states)
    to.states.push_back({numbers_of(state.q), numbers_of(state.v), numbers_of(state.a), numbers_of(state.efforts)});
  return to;
}

/// koppel, timed like the others. factored: accelerations by a factorisation of the mass matrix.
class KoppelTree final : public peer::TreeEngine {
 public:
  KoppelTree(const Tree& tree, bool factored) : evaluation_(tree), factored_(factored) {}

  void evaluate(Algorithm algorithm, std::size_t number) override {
    const TreeState& state = evaluation_.tree.states[number];
    switch (algorithm) {
      case Algorithm::position: return evaluation_.position(state);
      case Algorithm::inverse_dynamics: return evaluation_.efforts(state);
      case Algorithm::mass_matrix: return evaluation_.mass(state);
      case Algorithm::forward_dynamics: return factored_ ? evaluation_.by_factors(state) : evaluation_.by_bodies(state);
    }
  }

  std::vector<double> result(Algorithm algorithm) override {
    std::vector<double> numbers;
    if (algorithm == Algorithm::position) {
      for (const TreeStep& step : evaluation_.mechanism.steps) {
        const Vector3& origin = evaluation_.kinematics.poses[step.child].position;
        numbers.insert(numbers.end(), origin.begin(), origin.end());
      }
      return numbers;
    }
    if (algorithm != Algorithm::mass_matrix) return numbers_of(evaluation_.result);
    Eigen::MatrixXd mass;
    evaluation_.matrix.dense(mass);
    return {mass.data(), mass.data() + mass.size()};
  }

 private:
  Evaluation evaluation_;
  bool factored_;
};

/// The results of one algorithm for all states, by the textbook in extended precision.
std::vector<Exact> exact_results(const Tree& tree, Algorithm algorithm) {
  const Mechanism& mechanism = *tree.mechanism;
  Reference reference(mechanism, tree.inertias);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(mechanism.nv);
  std::vector<Exact> results;
  for (const TreeState& state : tree.states) {
    Exact exact;
    const auto take = [&exact](const auto& values) {
      exact.insert(exact.end(), values.data(), values.data() + values.size());
    };
    const bool forward = algorithm == Algorithm::forward_dynamics;
    const Reference::Vector efforts = reference.efforts(state.q, state.v, forward ? rest : state.a, mechanism.gravity);
    if (algorithm == Algorithm::inverse_dynamics) take(efforts);
    if (algorithm == Algorithm::mass_matrix) take(reference.mass(state.q));
    if (forward) {
      const Reference::Vector free = state.efforts.cast<long double>() - efforts;
      take(Reference::Vector(reference.mass(state.q).llt().solve(free)));
    }
    if (algorithm == Algorithm::position) {
      for (const TreeStep& step : mechanism.steps) take(reference.poses()[step.child].position);
    }
    results.push_back(std::move(exact));
  }
  return results;
}

/// Of the worst state: the length of the difference over that of the exact result.
double error_of(const double* found, std::size_t count, const std::vector<Exact>& exact) {
  using Numbers = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const std::size_t each = exact.front().size();
  if (count != each * exact.size()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (const Exact& state : exact) {
    const auto size = static_cast<Eigen::Index>(each);
    const auto right = Numbers::Map(state.data(), size);
    const auto off = (Eigen::VectorXd::Map(found, size).cast<long double>() - right).norm() / right.norm();
    if (!(off <= worst)) worst = static_cast<double>(off);
    found += each;
  }
  return worst;
}

using Answer = std::vector<double>;

/// What is timed.
struct Engine {
  std::string name;
  bool only_forward = false;  ///< it is another way to forward dynamics, and nothing else
  /// Seconds of one evaluation, then all results; nothing if it cannot. The tree stands in the file too.
  std::function<Answer(const Tree& tree, const std::string& file, Algorithm algorithm)> ask;

  bool does(Algorithm algorithm) const { return !only_forward || algorithm == Algorithm::forward_dynamics; }
};

Engine koppel_engine(const char* name, bool factored) {
  return {name, factored, [factored](const Tree& tree, const std::string& /*file*/, Algorithm algorithm) {
            KoppelTree engine(tree, factored);
            return peer::answer_of(engine, algorithm, tree.states.size());
          }};
}

/// koppel first.
std::vector<Engine> all_engines(const std::vector<PeerProgram>& peers) {
  std::vector<Engine> engines = {koppel_engine("koppel", false), koppel_engine("koppel, factored", true)};
  for (const PeerProgram& program : peers) {
    engines.push_back(
        {program.engine, false, [program](const Tree& /*tree*/, const std::string& file, Algorithm algorithm) {
           const char* const name = peer::algorithm_names[static_cast<std::size_t>(algorithm)];
           const std::string bytes =
               output_of(std::string(program.command).append(" trees '").append(file).append("' ").append(name));
           Answer answer(bytes.size() / sizeof(double));
           std::memcpy(answer.data(), bytes.data(), answer.size() * sizeof(double));
           return answer;
         }});
  }
  return engines;
}

/// All engines in turn, round by round, so that what else the machine does meets all alike.
void compare(const std::vector<Engine>& engines, const Tree& tree, const std::string& file, Algorithm algorithm,
             int rounds) {
  const std::vector<Exact> exact = exact_results(tree, algorithm);
  std::vector<Row> rows(engines.size());
  for (int round = 0; round < rounds; ++round) {
    double first = 0.0;
    for (std::size_t i = 0; i < engines.size(); ++i) {
      if (!engines[i].does(algorithm)) continue;
      const Answer answer = engines[i].ask(tree, file, algorithm);
      if (answer.empty()) continue;
      if (i == 0) first = answer[0];
      rows[i].seconds.push_back(answer[0]);
      rows[i].ratios.push_back(answer[0] / first);
      rows[i].error = std::max(rows[i].error, error_of(answer.data() + 1, answer.size() - 1, exact));
    }
  }
  for (std::size_t i = 0; i < engines.size(); ++i) {
    if (engines[i].does(algorithm))
      rows[i].show(tree.name, peer::algorithm_names[static_cast<std::size_t>(algorithm)], engines[i].name, same_result);
  }
  std::fflush(stdout);
}

/// A file that is gone with its owner.
struct Scratch {
  std::string name = (std::filesystem::temp_directory_path() / ("koppel_tree_" + std::to_string(getpid()))).string();
  Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { std::remove(name.c_str()); }
};

}  // namespace
}  // namespace koppel::bench

int main(int count, char** arguments) {
  using namespace koppel::bench;
  const int rounds = count < 2 ? 7 : std::max(1, std::atoi(arguments[1]));
  std::printf("%s, %s; medians of %d rounds (least to greatest)\n", KOPPEL_COMPILER, KOPPEL_FLAGS, rounds);
  const std::vector<PeerProgram> peers = peer_programs();
  const std::vector<Engine> engines = all_engines(peers);
  const Scratch file;
  for (const Tree& tree : {arm7(), chain(30), chain(200)}) {
    koppel::peer::write_tree(handed(tree), file.name);
    for (std::size_t i = 0; i < koppel::peer::algorithm_names.size(); ++i)
      compare(engines, tree, file.name, static_cast<koppel::peer::Algorithm>(i), rounds);
  }
  compare_loops(peers, rounds);
}

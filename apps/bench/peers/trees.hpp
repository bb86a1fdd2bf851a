// Algorithms on open trees of revolute joints: what is handed to an engine, what it is asked for, and how that is
// timed, koppel's own engine like any other.
#pragma once

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace koppel::peer {

/// A body and its revolute joint about z of a frame on the parent. The body's frame is the joint's at angle zero.
struct Link {
  int parent = -1;                ///< number of the link; -1: the ground
  std::array<double, 3> place{};  ///< of the frame in the parent
  std::array<double, 4> turn{};   ///< likewise, as quaternion w x y z
  double mass = 0.0;
  std::array<double, 3> centre{};
  std::array<double, 6> inertia{};  ///< about the centre: xx yy zz xy xz yz
};

/// What one evaluation is given, by links.
struct TreeState {
  std::vector<double> q, v, a, efforts;
};

struct Tree {
  std::array<double, 3> gravity{};
  std::vector<Link> links;  ///< parents before children
  std::vector<TreeState> states;
};

/// Results: origins of all bodies in the world; efforts for the accelerations a; mass matrix, row by row; accelerations
/// for the efforts.
enum class Algorithm { position, inverse_dynamics, mass_matrix, forward_dynamics };

constexpr std::array<const char*, 4> algorithm_names = {"position", "inverse_dynamics", "mass_matrix",
                                                        "forward_dynamics"};

/// Evaluates a tree; the states are its own already, so that no time goes into handing them over.
class TreeEngine {
 public:
  TreeEngine() = default;
  TreeEngine(const TreeEngine&) = delete;
  TreeEngine& operator=(const TreeEngine&) = delete;
  virtual ~TreeEngine() = default;

  /// From nothing but the state of that number, as if nothing was known of it.
  virtual void evaluate(Algorithm algorithm, std::size_t state) = 0;
  /// Of the last evaluation.
  virtual std::vector<double> result(Algorithm algorithm) = 0;
};

/// The engine of the program that asks.
std::unique_ptr<TreeEngine> make_tree(const Tree& tree);

/// Time [s] of something short: the least of some milliseconds' repetitions.
template <typename Function>
double least_seconds(const Function& once) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int i = 0; i < 10000 && (i < 3 || sum < 20e-3); ++i) {
    const auto begin = Clock::now();
    once();
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    sum += seconds;
    if (seconds < best) best = seconds;
  }
  return best;
}

/// Of one evaluation [s], as the mean over all states.
inline double seconds_of(TreeEngine& engine, Algorithm algorithm, std::size_t states) {
  const double all = least_seconds([&] {
    for (std::size_t state = 0; state < states; ++state) engine.evaluate(algorithm, state);
  });
  return all / static_cast<double>(states);
}

/// Calls a function with every number of the tree, in the order of its file; `links` and `states` are of their sizes.
template <typename T, typename Function>
void each_number(T& tree, const Function& with) {
  for (auto& x : tree.gravity) with(x);
  for (auto& link : tree.links) {
    with(link.parent);
    for (auto& x : link.place) with(x);
    for (auto& x : link.turn) with(x);
    with(link.mass);
    for (auto& x : link.centre) with(x);
    for (auto& x : link.inertia) with(x);
  }
  for (auto& state : tree.states) {
    for (auto* const part : {&state.q, &state.v, &state.a, &state.efforts}) {
      for (auto& x : *part) with(x);
    }
  }
}

inline void write_tree(const Tree& tree, const std::string& file) {
  std::ofstream out(file);
  out.precision(17);
  out << tree.links.size() << ' ' << tree.states.size() << '\n';
  each_number(tree, [&out](const auto& x) { out << x << ' '; });
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

inline Tree read_tree(const std::string& file) {
  std::ifstream in(file);
  std::size_t links = 0, states = 0;
  in >> links >> states;
  Tree tree;
  tree.links.resize(links);
  const std::vector<double> zeros(links);
  tree.states.assign(states, {zeros, zeros, zeros, zeros});
  each_number(tree, [&in](auto& x) { in >> x; });
  if (!in) throw std::runtime_error("no tree in " + file);
  return tree;
}

/// The seconds of one evaluation and the results for all states, one after the other. A program writes them as they lie
/// in memory.
inline std::vector<double> answer_of(TreeEngine& engine, Algorithm algorithm, std::size_t states) {
  std::vector<double> numbers = {seconds_of(engine, algorithm, states)};
  for (std::size_t state = 0; state < states; ++state) {
    engine.evaluate(algorithm, state);
    const std::vector<double> result = engine.result(algorithm);
    numbers.insert(numbers.end(), result.begin(), result.end());
  }
  return numbers;
}

}  // namespace koppel::peer

// What every shim does: another engine moves a mechanism of koppel bench by one of its own methods and tells where it
// ended and how long that took. The bench judges the end by its own reference, as koppel's.
//
//   koppel_peer_NAME                                  what it can do, as JSON
//   koppel_peer_NAME PROBLEM END METHOD SETTING       {"seconds": ..., "values": {"pivot.angle": ..., ...}}
//   koppel_peer_NAME accelerations PROBLEM            the same with the accelerations at the start
//   koppel_peer_NAME trees FILE ALGORITHM             the same for algorithms on trees, in the numbers of trees.hpp
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "trees.hpp"

namespace koppel::peer {

struct Value {
  std::string name;
  double value;
};

struct End {
  double seconds;  ///< for the motion alone, from the assembled start
  std::vector<Value> values;
};

/// A way to integrate, and the values of its one setting, from coarse to fine.
struct Method {
  std::string name, setting;
  std::vector<double> values;
};

struct Peer {
  std::string engine;  ///< with its version
  std::vector<Method> methods;
  std::vector<std::string> problems;
  /// Moves the problem to a time [s] once. Throws what it cannot.
  std::function<End(const std::string& problem, double end, const std::string& method, double setting)> run;
  /// Accelerations of a problem's coordinates at its start, and the time of one evaluation. Empty: it knows only steps.
  std::function<End(const std::string& problem)> accelerate;
};

inline void print_list(const char* name, const std::vector<std::string>& words) {
  std::printf("\"%s\": [", name);
  for (std::size_t i = 0; i < words.size(); ++i) std::printf("%s\"%s\"", i == 0 ? "" : ", ", words[i].c_str());
  std::printf("]");
}

inline void describe(const Peer& peer) {
  std::printf("{\"engine\": \"%s\", ", peer.engine.c_str());
  print_list("problems", peer.problems);
  std::printf(", \"methods\": [");
  for (const Method& method : peer.methods) {
    std::printf("%s{\"method\": \"%s\", \"setting\": \"%s\", \"values\": [", &method == peer.methods.data() ? "" : ", ",
                method.name.c_str(), method.setting.c_str());
    for (std::size_t i = 0; i < method.values.size(); ++i) std::printf("%s%.17g", i == 0 ? "" : ", ", method.values[i]);
    std::printf("]}");
  }
  std::printf("]}\n");
}

/// The least time of three runs, and again while they are short, as koppel is timed.
inline End best(const Peer& peer, char** arguments) {
  End best{std::numeric_limits<double>::infinity(), {}};
  double sum = 0.0;
  for (int i = 0; i < 1000 && (i < 3 || sum < 0.02) && !(i > 0 && sum > 2.0); ++i) {
    End end = peer.run(arguments[1], std::atof(arguments[2]), arguments[3], std::atof(arguments[4]));
    sum += end.seconds;
    if (end.seconds < best.seconds) best = std::move(end);
  }
  return best;
}

inline void print(const End& end) {
  std::printf("{\"seconds\": %.9g, \"values\": {", end.seconds);
  for (const Value& value : end.values) {
    if (!std::isfinite(value.value)) throw std::runtime_error(value.name + " is not finite");
    std::printf("%s\"%s\": %.17g", &value == end.values.data() ? "" : ", ", value.name.c_str(), value.value);
  }
  std::printf("}}\n");
}

inline void evaluate_tree(const std::string& file, const std::string& name) {
  const Tree tree = read_tree(file);
  const std::unique_ptr<TreeEngine> engine = make_tree(tree);
  const auto* const found = std::find(algorithm_names.begin(), algorithm_names.end(), name);
  if (found == algorithm_names.end()) throw std::runtime_error("no such algorithm");
  const auto algorithm = static_cast<Algorithm>(found - algorithm_names.begin());
  const std::vector<double> answer = answer_of(*engine, algorithm, tree.states.size());
  std::fwrite(answer.data(), sizeof(double), answer.size(), stdout);
}

inline int main_of(const Peer& peer, int count, char** arguments) {
  const std::string what = count > 1 ? arguments[1] : "";
  const bool trees = count == 4 && what == "trees", accelerations = count == 3 && what == "accelerations";
  if (count != 5 && !trees && !accelerations) {
    describe(peer);
    return count == 1 ? 0 : 2;
  }
  try {
    if (accelerations && !peer.accelerate) throw std::runtime_error("it knows only steps");
    if (trees) {
      evaluate_tree(arguments[2], arguments[3]);
    } else {
      print(accelerations ? peer.accelerate(arguments[2]) : best(peer, arguments));
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace koppel::peer

// Constrained forward dynamics: accelerations where a scene starts, its loops held by their equations.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include <nlohmann/json.hpp>

#include "closure/close.hpp"
#include "dynamics/simulation.hpp"
#include "folders.hpp"
#include "peer_table.hpp"
#include "peers/trees.hpp"
#include "scene/scene.hpp"
#include "standard_types.hpp"

namespace koppel::bench {
namespace {

/// Engines whose loops are soft come only so near.
constexpr double same_motion = 1e-2;

using Values = std::map<std::string, double>;

/// A mechanism of apps/scenes/dynamics at its start.
class Loop {
 public:
  explicit Loop(const std::string& name) : registry_(standard_types()) {
    Diagnostics findings;
    const auto scene = read_scene_file(*registry_, test::scenes_folder() + "/dynamics/" + name + ".toml", findings);
    auto mechanism = scene ? compile(*scene, findings) : tl::make_unexpected(scene.error());
    auto masses = mechanism ? inertias(**mechanism) : tl::make_unexpected(mechanism.error());
    if (!masses) stop(masses.error());
    mechanism_ = *mechanism;
    motion_ = std::make_unique<EquationsOfMotion>(mechanism_, std::move(*masses));
    chart_ = std::make_unique<Chart>(*mechanism_);
    start();
  }

  bool evaluate() {
    return motion_->stand(*chart_, 0.0, delta_, v_) && motion_->accelerations(states_.data(), state_rates_.data());
  }

  Values accelerations() {
    Eigen::VectorXd a;
    Values values;
    if (!evaluate() || !motion_->complete(a)) return values;
    for (std::uint32_t i = 0; i < mechanism_->nv; ++i) values[mechanism_->rate_names[i].name] = a[i];
    return values;
  }

 private:
  [[noreturn]] static void stop(const Error& error) {
    std::fputs(render(error).c_str(), stderr);
    std::exit(1);
  }

  /// Closed, with the rates that the scene asks for.
  void start() {
    State state(*mechanism_);
    Work work(mechanism_);
    Report report;
    close(work, state, CloseOptions(), report);
    auto simulation = Simulation::of(mechanism_, SimulationOptions());
    if (!simulation) stop(simulation.error());
    if (auto started = (*simulation)->start(state); !started) stop(started.error());
    if (auto shown = (*simulation)->advance(0.0, state); !shown) stop(shown.error());
    chart_->set_base(state.q);
    delta_ = Eigen::VectorXd::Zero(mechanism_->nv);
    v_ = state.v;
    states_ = mechanism_->internal_start;
    state_rates_ = states_;
    motion_->choose(state.q, 0.0);
  }

  std::shared_ptr<Registry> registry_;
  std::shared_ptr<const Mechanism> mechanism_;
  std::unique_ptr<EquationsOfMotion> motion_;
  std::unique_ptr<Chart> chart_;
  Eigen::VectorXd delta_, v_, states_, state_rates_;
};

/// Greatest difference of those that both know, over the greatest of all.
double difference(const Values& found, const Values& right) {
  double off = 0.0, size = 0.0;
  for (const auto& [name, value] : right) {
    size = std::max(size, std::abs(value));
    if (const auto it = found.find(name); it != found.end()) off = std::max(off, std::abs(it->second - value));
  }
  return off / size;
}

void compare_loop(const std::vector<PeerProgram>& peers, const std::string& name, int rounds) {
  Loop loop(name);
  const Values right = loop.accelerations();
  Row own;
  own.is_measure = true;
  std::vector<Row> rows(peers.size());
  for (int round = 0; round < rounds; ++round) {
    own.seconds.push_back(peer::least_seconds([&loop] { loop.evaluate(); }));
    own.ratios.push_back(1.0);
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const std::string text = output_of(std::string(peers[i].command).append(" accelerations ").append(name));
      const auto answer = nlohmann::json::parse(text, nullptr, false);
      if (!answer.is_object()) continue;
      rows[i].seconds.push_back(answer["seconds"].get<double>());
      rows[i].ratios.push_back(rows[i].seconds.back() / own.seconds.back());
      rows[i].error = difference(answer["values"].get<Values>(), right);
    }
  }
  own.show(name, "accelerations", "koppel", same_motion);
  for (std::size_t i = 0; i < peers.size(); ++i) rows[i].show(name, "accelerations", peers[i].engine, same_motion);
}

}  // namespace

void compare_loops(const std::vector<PeerProgram>& peers, int rounds) {
  for (const char* const name : {"fourbar_free", "andrews", "bricard"}) compare_loop(peers, name, rounds);
}

}  // namespace koppel::bench

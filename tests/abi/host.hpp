// A host for the tests of the C ABI: a scene on its way to a state that can move.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/handles.hpp"
#include "folders.hpp"

namespace koppel::test {

using namespace koppel::app;

inline Engine make_engine() {
  koppel_engine* engine = nullptr;
  EXPECT_EQ(koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, nullptr, &engine, nullptr), KOPPEL_OK);
  return Engine(engine);
}

inline Mechanism compile(const koppel_scene* scene) {
  koppel_mechanism* mechanism = nullptr;
  EXPECT_EQ(koppel_mechanism_compile(scene, nullptr, &mechanism, nullptr), KOPPEL_OK);
  return Mechanism(mechanism);
}

inline State make_state(const Mechanism& mechanism) {
  koppel_state* state = nullptr;
  EXPECT_EQ(koppel_state_create(mechanism.get(), &state), KOPPEL_OK);
  return State(state);
}

inline Work make_work(const Mechanism& mechanism) {
  koppel_work* work = nullptr;
  EXPECT_EQ(koppel_work_create(mechanism.get(), &work), KOPPEL_OK);
  return Work(work);
}

/// Everything that a host holds for a scene: a shipped one by its name, or another by its file.
struct Host {
  explicit Host(const std::string& name) : engine(make_engine()) {
    const std::string file = name.find('/') == std::string::npos ? scenes_folder() + "/" + name + ".toml" : name;
    koppel_scene* read = nullptr;
    EXPECT_EQ(koppel_scene_from_file(engine.get(), file.c_str(), nullptr, &read, nullptr), KOPPEL_OK);
    scene.reset(read);
    mechanism = compile(read);
    state = make_state(mechanism);
    work = make_work(mechanism);
    EXPECT_EQ(koppel_mechanism_sizes(mechanism.get(), &sizes), KOPPEL_OK);
  }

  koppel_status move(double time) const { return koppel_move(state.get(), work.get(), time, nullptr, nullptr); }

  Engine engine;
  Scene scene;
  Mechanism mechanism;
  State state;
  Work work;
  koppel_sizes sizes = sized<koppel_sizes>();
};

/// All that can be read of a state.
struct Reading {
  std::vector<double> q, v, a;
  double time = 0.0;
  bool operator==(const Reading&) const = default;
};

inline Reading read(const koppel_state* state, const koppel_sizes& sizes) {
  Reading reading{std::vector<double>(sizes.coordinates), std::vector<double>(sizes.rates),
                  std::vector<double>(sizes.rates), koppel_state_time(state)};
  EXPECT_EQ(koppel_state_get(state, KOPPEL_Q, reading.q.data(), reading.q.size()), KOPPEL_OK);
  EXPECT_EQ(koppel_state_get(state, KOPPEL_V, reading.v.data(), reading.v.size()), KOPPEL_OK);
  EXPECT_EQ(koppel_state_get(state, KOPPEL_A, reading.a.data(), reading.a.size()), KOPPEL_OK);
  return reading;
}

inline Reading read(const Host& host) { return read(host.state.get(), host.sizes); }

/// An output with a pattern in every byte, to see whether somebody wrote into it.
template <typename Plain>
class Output {
 public:
  Output() {
    const auto bytes = std::as_writable_bytes(std::span(&value, 1));
    std::fill(bytes.begin(), bytes.end(), pattern);
  }
  Plain* operator&() { return &value; }
  bool untouched() const {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == pattern; });
  }

  Plain value;

 private:
  static constexpr std::byte pattern{0x5a};
};

}  // namespace koppel::test

// Handles in any order, and one mechanism in several threads.
#include <algorithm>
#include <numeric>
#include <string>
#include <thread>

#include "folders.hpp"
#include "host.hpp"

namespace koppel::test {
namespace {

/// What a handle that outlives the others is still good for.
void expect_usable(Host& host) {
  if (host.mechanism) {
    EXPECT_TRUE(make_state(host.mechanism) != nullptr);
  }
  if (host.scene) {
    EXPECT_TRUE(compile(host.scene.get()) != nullptr);
  }
  if (host.state && host.work) {
    EXPECT_GE(host.move(0.5), KOPPEL_OK);
  }
  if (host.state) {
    read(host);
  }
}

TEST(Handles, MayBeFreedInAnyOrder) {
  std::vector<int> order(5);
  std::iota(order.begin(), order.end(), 0);
  do {
    Host host("rstr");
    for (const int handle : order) {
      switch (handle) {
        case 0: host.engine.reset(); break;
        case 1: host.scene.reset(); break;
        case 2: host.mechanism.reset(); break;
        case 3: host.state.reset(); break;
        default: host.work.reset(); break;
      }
      expect_usable(host);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Handles, OfAStreamOutliveTheRest) {
  Host host("rstr");
  auto options = sized<koppel_stream_options>();
  options.url = "memq://";
  koppel_stream* stream = nullptr;
  ASSERT_EQ(koppel_stream_open(host.mechanism.get(), &options, &stream, nullptr), KOPPEL_OK);
  ASSERT_EQ(koppel_stream_publish(stream, host.state.get(), host.work.get(), nullptr), KOPPEL_OK);
  host.engine.reset();
  host.scene.reset();
  host.mechanism.reset();
  host.state.reset();
  host.work.reset();
  EXPECT_EQ(koppel_stream_event(stream, 0.0, KOPPEL_SEVERITY_NOTE, "alone"), KOPPEL_OK);
  EXPECT_EQ(koppel_stream_close(stream, nullptr), KOPPEL_OK);
}

/// A loaded plugin's code stays as long as anything was made from it.
TEST(Handles, KeepAPluginLoaded) {
  Host host("rstr");
  auto options = sized<koppel_engine_options>();
  const std::string plugins = standard_plugins_folder();
  options.standard_plugins = plugins.c_str();
  koppel_engine* engine = nullptr;
  ASSERT_EQ(koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, &options, &engine, nullptr), KOPPEL_OK);
  host.state.reset();
  host.work.reset();
  koppel_scene* scene = nullptr;
  EXPECT_EQ(koppel_scene_from_file(engine, (scenes_folder() + "/rstr.toml").c_str(), nullptr, &scene, nullptr),
            KOPPEL_OK);
  koppel_engine_destroy(engine);
  host.mechanism = compile(scene);
  koppel_scene_destroy(scene);
  host.state = make_state(host.mechanism);
  host.work = make_work(host.mechanism);
  host.mechanism.reset();
  EXPECT_GE(host.move(0.3), KOPPEL_OK);
}

/// A run from the start to the end: the state at every step.
std::vector<Reading> run(const koppel_mechanism* mechanism, const koppel_sizes& sizes, int steps) {
  koppel_state* state = nullptr;
  koppel_work* work = nullptr;
  EXPECT_EQ(koppel_state_create(mechanism, &state), KOPPEL_OK);
  EXPECT_EQ(koppel_work_create(mechanism, &work), KOPPEL_OK);
  const State owned_state(state);
  const Work owned_work(work);
  std::vector<Reading> readings;
  for (int i = 0; i <= steps; ++i) {
    EXPECT_GE(koppel_move(state, work, static_cast<double>(i) / steps, nullptr, nullptr), KOPPEL_OK);
    readings.push_back(read(state, sizes));
  }
  return readings;
}

TEST(Threads, OfOneMechanismGiveTheSameBits) {
  for (const char* name : {"rstr", "5link", "4bar"}) {
    const Host host(name);
    const koppel_mechanism* mechanism = host.mechanism.get();
    const std::vector<Reading> alone = run(mechanism, host.sizes, 60);
    std::vector<std::vector<Reading>> together(4);
    std::vector<std::thread> threads;
    threads.reserve(together.size());
    for (auto& readings : together) {
      threads.emplace_back([&] { readings = run(mechanism, host.sizes, 60); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& readings : together) EXPECT_TRUE(readings == alone) << name;
  }
}

}  // namespace
}  // namespace koppel::test

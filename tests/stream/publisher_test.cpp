#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include "example.hpp"
#include "koppel/closure_t.hpp"
#include "koppel/event_t.hpp"
#include "koppel/model_t.hpp"
#include "koppel/poses_t.hpp"
#include "koppel/state_t.hpp"
#include "stream/network_sink.hpp"

namespace koppel::test {
namespace {

const char* const model_channel = "KOPPEL_FOUR_BAR_MODEL";
const char* const state_channel = "KOPPEL_FOUR_BAR_STATE";
const char* const poses_channel = "KOPPEL_FOUR_BAR_POSES";
const char* const closure_channel = "KOPPEL_FOUR_BAR_CLOSURE";
const char* const event_channel = "KOPPEL_FOUR_BAR_EVENT";

std::unique_ptr<Publisher> open(std::unique_ptr<Sink> sink, const StreamOptions& options = {},
                                Clock clock = steady_clock) {
  auto publisher = Publisher::open(example_model(), options, std::move(sink), silent_logger(), std::move(clock));
  EXPECT_TRUE(publisher) << render(publisher.error());
  return std::move(*publisher);
}

template <typename Range>
std::vector<double> list(const Range& range) {
  return {std::begin(range), std::end(range)};
}

template <typename Message>
void expect_head(const Message& message, double time, std::int64_t sequence) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const std::int64_t utime = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  EXPECT_LE(message.utime, utime);
  EXPECT_GT(message.utime, utime - 60'000'000);
  EXPECT_EQ(message.time, time);
  EXPECT_EQ(message.sequence, sequence);
  EXPECT_EQ(static_cast<std::uint64_t>(message.hash), example_model().hash);
}

void expect_example_model(const model_t& model) {
  EXPECT_EQ(model.scene, "four-bar");
  EXPECT_EQ(model.title, "A four-bar linkage");
  EXPECT_EQ(model.version, "0.1.0");
  EXPECT_EQ(model.length, 0.3);
  EXPECT_EQ(model.coordinate_names, (std::vector<std::string>{"crank.angle", "slide.shift", "ball.w"}));
  EXPECT_EQ(model.coordinate_units, (std::vector<std::string>{"rad", "m", "1"}));
  EXPECT_EQ(model.rate_names, (std::vector<std::string>{"crank.angle", "slide.shift"}));
  EXPECT_EQ(model.rate_units, (std::vector<std::string>{"rad/s", "m/s"}));
  EXPECT_EQ(model.joint_names, (std::vector<std::string>{"crank", "slide", "ball"}));
  EXPECT_EQ(model.body_names, (std::vector<std::string>{"ground", "rod"}));
}

/// The three messages of one snapshot, each exactly once.
void expect_numbers(const Record& record, const Numbers& numbers, std::int64_t sequence) {
  const auto states = record.all<state_t>(state_channel);
  ASSERT_EQ(states.size(), 1u);
  expect_head(states[0], numbers.time, sequence);
  EXPECT_EQ(states[0].q, list(numbers.q));
  EXPECT_TRUE(std::signbit(states[0].q[1])) << "-0.0 must stay what it is";
  EXPECT_EQ(states[0].v, list(numbers.v));
  EXPECT_EQ(states[0].a, list(numbers.a));

  const auto poses = record.all<poses_t>(poses_channel);
  ASSERT_EQ(poses.size(), 1u);
  expect_head(poses[0], numbers.time, sequence);
  ASSERT_EQ(poses[0].poses.size(), 2u);
  EXPECT_EQ(list(poses[0].poses[0].position), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(list(poses[0].poses[0].quaternion), (std::vector<double>{1, 0, 0, 0}));
  EXPECT_EQ(list(poses[0].poses[1].position), (std::vector<double>{numbers.poses[21], numbers.poses[22], -3e-17}));
  const auto& quaternion = poses[0].poses[1].quaternion;
  EXPECT_NEAR(quaternion[0], std::sqrt(0.5), 2e-16);
  EXPECT_EQ(quaternion[1], 0);
  EXPECT_EQ(quaternion[2], 0);
  EXPECT_NEAR(quaternion[3], std::sqrt(0.5), 2e-16) << "a quarter turn about z maps x onto y";

  const auto closures = record.all<closure_t>(closure_channel);
  ASSERT_EQ(closures.size(), 1u);
  expect_head(closures[0], numbers.time, sequence);
  EXPECT_EQ(closures[0].verdict, closure_t::VERDICT_CLOSED);
  EXPECT_EQ(closures[0].solver, closure_t::SOLVER_CERES);
  EXPECT_EQ(closures[0].status, 4);
  EXPECT_EQ(closures[0].iterations, static_cast<int>(numbers.closure.iterations));
  EXPECT_EQ(closures[0].rank, 5);
  EXPECT_EQ(closures[0].equations, 6);
  EXPECT_EQ(closures[0].unknowns, 7);
  EXPECT_EQ(closures[0].residual, numbers.closure.residual);
  EXPECT_EQ(closures[0].condition, numbers.closure.condition);
  EXPECT_EQ(closures[0].coordinate_error, numbers.closure.coordinate_error);
}

TEST(Publisher, SendsEveryMessageThroughLcm) {
  const std::unique_ptr<lcm_t, void (*)(lcm_t*)> lcm(lcm_create("memq://"), lcm_destroy);
  ASSERT_TRUE(lcm);
  Record heard;
  const auto listener = [](const lcm_recv_buf_t* message, const char* channel, void* user) {
    static_cast<Record*>(user)->add(channel, {static_cast<const std::uint8_t*>(message->data), message->data_size});
  };
  lcm_subscribe(lcm.get(), "KOPPEL_.*", listener, &heard);

  const Numbers numbers(7);
  auto publisher = open(std::make_unique<NetworkSink>(lcm.get()));
  ASSERT_TRUE(publisher->event(0.5, Severity::warning, "near a dead centre"));
  ASSERT_TRUE(publisher->publish(numbers.snapshot()));
  const auto statistics = publisher->close();
  while (lcm_handle_timeout(lcm.get(), 0) > 0) {
  }

  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->published, 1u);
  EXPECT_EQ(statistics->sent, 1u);
  EXPECT_EQ(statistics->dropped, 0u);
  const auto models = heard.all<model_t>(model_channel);
  ASSERT_EQ(models.size(), 1u);
  expect_head(models[0], 0, 0);
  expect_example_model(models[0]);
  expect_numbers(heard, numbers, 0);
  const auto events = heard.all<event_t>(event_channel);
  ASSERT_EQ(events.size(), 1u);
  expect_head(events[0], 0.5, 0);
  EXPECT_EQ(events[0].severity, event_t::SEVERITY_WARNING);
  EXPECT_EQ(events[0].text, "near a dead centre");
}

TEST(Publisher, LeavesTheClosureOutWhenThereIsNone) {
  const auto record = std::make_shared<Record>();
  auto publisher = open(std::make_unique<RecordingSink>(record, true));
  const Numbers numbers(1);
  Snapshot snapshot = numbers.snapshot();
  ASSERT_TRUE(publisher->publish(snapshot));
  snapshot.closure = nullptr;
  ASSERT_TRUE(publisher->publish(snapshot));
  ASSERT_TRUE(publisher->close());
  EXPECT_EQ(record->all<state_t>(state_channel).size(), 2u);
  EXPECT_EQ(record->all<closure_t>(closure_channel).size(), 1u);
}

TEST(Publisher, NeverWaitsForAStalledNetwork) {
  const auto record = std::make_shared<Record>();
  const auto gate = std::make_shared<Gate>();
  auto publisher = open(std::make_unique<StalledSink>(record, gate, false));
  constexpr std::int64_t count = 100'000;
  for (int n = 0; n < count; ++n) ASSERT_TRUE(publisher->publish(Numbers(n).snapshot()));
  EXPECT_TRUE(record->messages().empty()) << "nothing has gone through the gate yet";

  gate->open();
  const auto statistics = publisher->close();
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->published, static_cast<std::uint64_t>(count));
  EXPECT_EQ(statistics->sent + statistics->dropped, statistics->published);

  const auto states = record->all<state_t>(state_channel);
  EXPECT_EQ(states.size(), statistics->sent);
  EXPECT_LE(states.size(), 2u) << "one was being sent at most, one was waiting";
  EXPECT_EQ(states.back().sequence, count - 1) << "the newest wins";
  EXPECT_EQ(states.back().q, list(Numbers(count - 1).q));
}

TEST(Publisher, ShowsDropsAsGapsOfTheSequence) {
  const auto record = std::make_shared<Record>();
  auto publisher = open(std::make_unique<RecordingSink>(record, false));
  for (int n = 0; n < 20'000; ++n) ASSERT_TRUE(publisher->publish(Numbers(n).snapshot()));
  const auto statistics = publisher->close();
  ASSERT_TRUE(statistics);

  std::uint64_t missing = 0;
  std::int64_t expected = 0;
  for (const state_t& state : record->all<state_t>(state_channel)) {
    ASSERT_GE(state.sequence, expected);
    missing += static_cast<std::uint64_t>(state.sequence - expected);
    expected = state.sequence + 1;
    EXPECT_EQ(state.q, list(Numbers(static_cast<int>(state.sequence)).q)) << "a slot was changed while it was sent";
  }
  EXPECT_EQ(expected, 20'000) << "the last one always goes";
  EXPECT_EQ(missing, statistics->dropped);
}

TEST(Publisher, GivesEverySnapshotToALosslessSinkEvenAfterAStall) {
  const auto record = std::make_shared<Record>();
  const auto gate = std::make_shared<Gate>();
  auto publisher = open(std::make_unique<StalledSink>(record, gate, true));
  std::atomic<int> handed_over = 0;
  std::thread host([&] {
    for (int n = 0; n < 1000; ++n) {
      EXPECT_TRUE(publisher->publish(Numbers(n).snapshot()));
      ++handed_over;
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LT(handed_over, 1000) << "a lossless sink pushes back";
  gate->open();
  host.join();
  const auto statistics = publisher->close();
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->sent, 1000u);
  EXPECT_EQ(statistics->dropped, 0u);
  const auto states = record->all<state_t>(state_channel);
  ASSERT_EQ(states.size(), 1000u);
  for (int n = 0; n < 1000; ++n) EXPECT_EQ(states[static_cast<std::size_t>(n)].sequence, n);
}

TEST(Publisher, KeepsEventsInTheirPlaceAmongTheSnapshots) {
  const auto record = std::make_shared<Record>();
  auto publisher = open(std::make_unique<RecordingSink>(record, true));
  std::vector<std::string> expected;
  for (int n = 0; n < 300; ++n) {
    ASSERT_TRUE(publisher->publish(Numbers(n).snapshot()));
    expected.emplace_back(state_channel);
    if (n % 3 != 0) continue;
    ASSERT_TRUE(publisher->event(n, Severity::note, "third"));
    expected.emplace_back(event_channel);
  }
  ASSERT_TRUE(publisher->close());
  std::vector<std::string> order;
  for (const auto& [channel, bytes] : record->messages())
    if (channel == state_channel || channel == event_channel) order.push_back(channel);
  EXPECT_EQ(order, expected);
}

TEST(Publisher, TellsTheModelAgainEverySecond) {
  const auto record = std::make_shared<Record>();
  const auto now = std::make_shared<std::atomic<std::int64_t>>(0);
  auto publisher = open(std::make_unique<RecordingSink>(record, false), {}, [now] { return now->load(); });
  ASSERT_TRUE(record->wait_for(model_channel, 1)) << "the first comes at once";
  *now += 999'999;
  ASSERT_TRUE(publisher->publish(Numbers(3).snapshot()));
  ASSERT_TRUE(record->wait_for(closure_channel, 1));
  EXPECT_EQ(record->all<model_t>(model_channel).size(), 1u);
  *now += 1;
  ASSERT_TRUE(record->wait_for(model_channel, 2)) << "although nothing is published";
  *now += 1'000'000;
  ASSERT_TRUE(record->wait_for(model_channel, 3));
  ASSERT_TRUE(publisher->close());
  const auto models = record->all<model_t>(model_channel);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_head(models[i], i == 0 ? 0 : Numbers(3).time, static_cast<std::int64_t>(i));
    expect_example_model(models[i]);
  }
}

TEST(Publisher, KeepsThePeriodButSendsTheLastState) {
  const auto record = std::make_shared<Record>();
  const auto now = std::make_shared<std::atomic<std::int64_t>>(0);
  StreamOptions options;
  options.period = 0.02;
  auto publisher = open(std::make_unique<RecordingSink>(record, false), options, [now] { return now->load(); });
  ASSERT_TRUE(publisher->publish(Numbers(0).snapshot()));
  ASSERT_TRUE(record->wait_for(closure_channel, 1));
  for (int n = 1; n < 10; ++n) ASSERT_TRUE(publisher->publish(Numbers(n).snapshot()));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(record->all<state_t>(state_channel).size(), 1u) << "the clock has not moved";
  *now += 20'000;
  ASSERT_TRUE(record->wait_for(closure_channel, 2));
  ASSERT_TRUE(publisher->publish(Numbers(10).snapshot()));
  const auto statistics = publisher->close();
  ASSERT_TRUE(statistics);
  const auto states = record->all<state_t>(state_channel);
  ASSERT_EQ(states.size(), 3u);
  EXPECT_EQ(states[1].sequence, 9);
  EXPECT_EQ(states[2].sequence, 10);
  EXPECT_EQ(statistics->dropped, 8u);
}

TEST(Publisher, NamesItsChannelsAfterTheOptionOrTheScene) {
  const auto first_channel = [](const std::string& name, const std::string& scene) {
    const auto record = std::make_shared<Record>();
    StreamModel model = example_model();
    model.scene = scene;
    StreamOptions options;
    options.name = name;
    auto publisher = Publisher::open(model, options, std::make_unique<RecordingSink>(record, false), silent_logger());
    if (!publisher) return code_text(publisher.error().code, publisher.error().severity);
    (*publisher)->close();
    return record->messages().front().first;
  };
  EXPECT_EQ(first_channel("", "left.four-bar"), "KOPPEL_LEFT_FOUR_BAR_MODEL");
  EXPECT_EQ(first_channel("Rig_2", "four-bar"), "KOPPEL_RIG_2_MODEL");
  EXPECT_EQ(first_channel(std::string(48, 'x'), "").size(), 7u + 48u + 6u);
  EXPECT_EQ(first_channel(std::string(49, 'x'), ""), "E0803");
  EXPECT_EQ(first_channel("four-bar", ""), "E0803") << "a name that somebody chose is not changed";
  EXPECT_EQ(first_channel("", ""), "E0803");
  EXPECT_EQ(first_channel("", "b\xc3\xa4r"), "E0803");
}

TEST(Publisher, RefusesWhatDoesNotFit) {
  const auto record = std::make_shared<Record>();
  auto publisher = open(std::make_unique<RecordingSink>(record, true));
  const Numbers numbers(1);
  for (int part = 0; part < 4; ++part) {
    Snapshot snapshot = numbers.snapshot();
    std::span<const double>* const parts[] = {&snapshot.q, &snapshot.v, &snapshot.a, &snapshot.poses};
    *parts[part] = parts[part]->first(parts[part]->size() - 1);
    const auto result = publisher->publish(snapshot);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, Code::invalid_argument);
  }
  ASSERT_TRUE(publisher->close());
  EXPECT_FALSE(publisher->publish(numbers.snapshot())) << "it is closed";
  EXPECT_FALSE(publisher->event(0, Severity::note, "late"));
  const auto statistics = publisher->close();
  ASSERT_TRUE(statistics) << "closing again changes nothing";
  EXPECT_EQ(statistics->published, 0u);

  for (const double period : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    StreamOptions options;
    options.period = period;
    const auto opened =
        Publisher::open(example_model(), options, std::make_unique<RecordingSink>(record, false), silent_logger());
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, Code::invalid_argument);
  }
}

TEST(Publisher, LetsTheHostGoWhenALosslessSinkBreaks) {
  class BreakingSink : public Sink {
   public:
    explicit BreakingSink(std::shared_ptr<Gate> gate) : gate_(std::move(gate)) {}
    bool lossless() const override { return true; }
    bool send(const std::string&, std::span<const std::uint8_t>) override {
      gate_->pass();
      return false;
    }
    bool flush() override { return false; }

   private:
    std::shared_ptr<Gate> gate_;
  };
  const auto gate = std::make_shared<Gate>();
  auto publisher = open(std::make_unique<BreakingSink>(gate));
  std::thread host([&] {
    while (publisher->publish(Numbers(1).snapshot())) {
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the host is waiting by now
  gate->open();
  host.join();
  const auto statistics = publisher->close();
  ASSERT_FALSE(statistics);
  EXPECT_EQ(statistics.error().code, Code::stream_failed);
}

TEST(Publisher, CountsWhatTheNetworkRefuses) {
  class DeadSink : public Sink {
   public:
    bool lossless() const override { return false; }
    bool send(const std::string&, std::span<const std::uint8_t>) override { return false; }
    bool flush() override { return true; }
  };
  auto publisher = open(std::make_unique<DeadSink>());
  for (int n = 0; n < 100; ++n) EXPECT_TRUE(publisher->publish(Numbers(n).snapshot()));
  const auto statistics = publisher->close();
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->sent, 0u);
  EXPECT_GE(statistics->failed, 1u);
  EXPECT_EQ(statistics->failed + statistics->dropped, 100u);
}

}  // namespace
}  // namespace koppel::test

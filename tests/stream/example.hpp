// A small stream that the tests share: its model, numbers to send, and sinks that remember or stall.
#pragma once

#include <array>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "stream/publisher.hpp"

namespace koppel::test {

inline StreamModel example_model() {
  StreamModel model;
  model.scene = "four-bar";
  model.title = "A four-bar linkage";
  model.version = "0.1.0";
  model.length = 0.3;
  model.hash = 0xfedc'ba98'7654'3210;
  model.coordinates = {{"crank.angle", "rad"}, {"slide.shift", "m"}, {"ball.w", "1"}};
  model.rates = {{"crank.angle", "rad/s"}, {"slide.shift", "m/s"}};
  model.joints = {"crank", "slide", "ball"};
  model.bodies = {"ground", "rod"};
  return model;
}

/// Numbers of a snapshot that fits example_model(), all different for each n, awkward ones among them.
struct Numbers {
  explicit Numbers(int n)
      : time(0.001 * n),
        q{std::sin(n), -0.0, 1e-310 * (n + 1)},
        v{std::cos(n), 1.0 / 3.0 + n},
        a{-std::exp(0.1 * (n % 100)), 1e300},
        poses{1,     0,  0, 0, 1, 0, 0, 0, 1, 0,       0,
              0,  // the ground
              0,     -1, 0, 1, 0, 0, 0, 0, 1, 0.1 * n, std::sqrt(n + 2.0),
              -3e-17} {
    closure.verdict = 1;
    closure.solver = 2;
    closure.status = 4;
    closure.iterations = static_cast<std::uint32_t>(n);
    closure.rank = 5;
    closure.equations = 6;
    closure.unknowns = 7;
    closure.residual = 1e-16 * (n + 1);
    closure.condition = 12.5 + n;
    closure.coordinate_error = 3e-15 * (n + 1);
  }

  Snapshot snapshot() const { return {time, q, v, a, poses, &closure}; }

  double time;
  std::array<double, 3> q;
  std::array<double, 2> v;
  std::array<double, 2> a;
  std::array<double, 24> poses;  // of the second body: a quarter turn about z
  ClosureFigures closure;
};

/// What a sink was given, shared with the test while the publisher owns the sink.
class Record {
 public:
  using Message = std::pair<std::string, std::vector<std::uint8_t>>;

  void add(const std::string& channel, std::span<const std::uint8_t> bytes) {
    const std::lock_guard lock(mutex_);
    messages_.push_back({channel, {bytes.begin(), bytes.end()}});
    arrived_.notify_all();
  }
  std::vector<Message> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }
  /// Waits until `count` messages have come on a channel; false after ten seconds.
  bool wait_for(const std::string& channel, std::size_t count) const {
    std::unique_lock lock(mutex_);
    return arrived_.wait_for(lock, std::chrono::seconds(10), [&] {
      std::size_t found = 0;
      for (const Message& message : messages_) found += message.first == channel ? 1 : 0;
      return found >= count;
    });
  }
  /// All messages of a channel, decoded.
  template <typename Type>
  std::vector<Type> all(const std::string& channel) const {
    std::vector<Type> result;
    for (const auto& [name, bytes] : messages()) {
      if (name != channel) continue;
      Type message{};
      if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) == static_cast<int>(bytes.size()))
        result.push_back(std::move(message));
    }
    return result;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable arrived_;
  std::vector<Message> messages_;
};

class RecordingSink : public Sink {
 public:
  RecordingSink(std::shared_ptr<Record> record, bool lossless) : record_(std::move(record)), lossless_(lossless) {}
  bool lossless() const override { return lossless_; }
  bool send(const std::string& channel, std::span<const std::uint8_t> message) override {
    record_->add(channel, message);
    return true;
  }
  bool flush() override { return true; }

 private:
  std::shared_ptr<Record> record_;
  bool lossless_;
};

/// A gate that is shut at first.
class Gate {
 public:
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

/// Sends nothing before the gate opens, as a network that hangs.
class StalledSink : public RecordingSink {
 public:
  StalledSink(std::shared_ptr<Record> record, std::shared_ptr<Gate> gate, bool lossless)
      : RecordingSink(std::move(record), lossless), gate_(std::move(gate)) {}
  bool send(const std::string& channel, std::span<const std::uint8_t> message) override {
    gate_->pass();
    return RecordingSink::send(channel, message);
  }

 private:
  std::shared_ptr<Gate> gate_;
};

}  // namespace koppel::test

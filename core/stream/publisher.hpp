// Streams a mechanism's motion by LCM: to the network without ever waiting for it, or into a log without losing
// anything.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/log.hpp"
#include "stream/sink.hpp"
#include "stream/snapshot.hpp"

namespace koppel {

struct StreamOptions {
  /// "udpm://239.255.76.67:7667?ttl=0", "file:///path?mode=w" or "memq://". Empty: LCM's default.
  std::string url;
  /// Channels are KOPPEL_<NAME>_MODEL, _STATE, _POSES, _CLOSURE and _EVENT. Letters, digits and underscores, at
  /// most 48. Empty: the scene's name, its hyphens and dots turned into underscores.
  std::string name;
  /// [s] wall clock, least time between two states that go to the network; the last one always goes. A log takes every
  /// one.
  double period = 0;
};

struct StreamStatistics {
  std::uint64_t published = 0;  ///< snapshots taken from the host
  std::uint64_t sent = 0;       ///< that went out
  std::uint64_t dropped = 0;    ///< that were overtaken by newer ones
  std::uint64_t failed = 0;     ///< that LCM could not send
};

/// A clock for periods: [us], never running back.
using Clock = std::function<std::int64_t()>;
std::int64_t steady_clock();

/// One thread of its own makes all calls of LCM. The host's functions may be called by one thread at a time.
class Publisher {
 public:
  /// stream_url, stream_name, invalid_argument (period), stream_failed (the log cannot be written).
  static Result<std::unique_ptr<Publisher>> open(StreamModel model, const StreamOptions& options, Logger logger);
  /// The same for a given sink; the options' URL is not used.
  static Result<std::unique_ptr<Publisher>> open(StreamModel model, const StreamOptions& options,
                                                 std::unique_ptr<Sink> sink, Logger logger, Clock clock = steady_clock);
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;
  /// Closes it.
  ~Publisher();

  /// Hands a snapshot over; allocates nothing. To the network it never waits; a log may push back. invalid_argument:
  /// sizes are not the model's, or the stream is closed; stream_failed: the log could not be written (a network's
  /// failures are only counted).
  Result<void> publish(const Snapshot& snapshot);
  /// Hands a line of text over, sent in its place among the snapshots. Errors as in publish.
  Result<void> event(double time, Severity severity, std::string_view text);
  /// Sends what is waiting and ends the stream. stream_failed: the log is incomplete. Closing again changes nothing.
  Result<StreamStatistics> close();

 private:
  class Worker;
  explicit Publisher(std::unique_ptr<Worker> worker);

  std::unique_ptr<Worker> worker_;
};

}  // namespace koppel

// What waits between the host, which must not wait, and the thread that sends.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "stream/snapshot.hpp"

namespace koppel {

/// A snapshot that owns its numbers.
struct Slot {
  std::int64_t utime = 0;
  std::int64_t sequence = 0;
  double time = 0;
  std::vector<double> q, v, a, poses;
  std::optional<ClosureFigures> closure;
};

struct Event {
  std::int64_t utime = 0;
  std::int64_t sequence = 0;
  double time = 0;
  Severity severity = Severity::note;
  std::string text;
};

/// Snapshots in slots that are allocated once, and events. When it is full, a lossless outbox makes the host wait; any
/// other one drops its oldest snapshot, or the new event. Numbers what it is given, so that gaps show what was dropped.
/// One thread puts, another one takes.
class Outbox {
 public:
  struct Nothing {};  ///< the waiting time is over
  struct Closed {};   ///< closed, and everything was taken
  using Item = std::variant<Nothing, Closed, const Slot*, Event>;

  Outbox(const StreamModel& model, bool lossless);

  /// Copies the snapshot, whose sizes must be the model's. Does not allocate.
  void put(const Snapshot& snapshot, std::int64_t utime);
  void put(Event event);
  /// Nothing is put any more.
  void close();
  /// Drops everything from now on, and ends all waiting: it cannot be sent.
  void give_up();

  /// The next item in the order in which they were put. A slot is the taker's until the next call. Waits no longer than
  /// `longest`; snapshots stay where they are unless `snapshots`.
  Item take(bool snapshots, std::chrono::microseconds longest);

  std::uint64_t published() const { return published_; }
  std::uint64_t dropped() const { return dropped_; }
  bool closed() const;

 private:
  struct Waiting {
    Event event;
    std::int64_t before;  // the number of the snapshot that was put next
  };

  bool is_ready(bool snapshots) const;
  void make_room(std::unique_lock<std::mutex>& lock);

  const bool lossless_;
  const std::size_t depth_;  // how many snapshots may wait
  std::vector<Slot> slots_;
  std::size_t writing_ = 0;  // the host's slot
  std::size_t reading_ = 1;  // the taker's slot

  mutable std::mutex mutex_;  // never held while anything is sent
  std::condition_variable ready_;
  std::condition_variable room_;
  std::vector<std::size_t> free_;
  std::vector<std::size_t> waiting_;  // a ring of depth_ slots
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::deque<Waiting> events_;
  std::int64_t event_count_ = 0;
  std::uint64_t published_ = 0;
  std::uint64_t dropped_ = 0;
  bool snapshot_wanted_ = false;  // the taker sleeps and would take one
  bool closed_ = false;
  bool given_up_ = false;
};

}  // namespace koppel

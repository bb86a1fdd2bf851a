#include "stream/outbox.hpp"

#include <algorithm>
#include <utility>

namespace koppel {
namespace {

constexpr std::size_t lossless_depth = 64;
constexpr std::size_t most_events = 256;

Slot slot_for(const StreamModel& model) {
  Slot slot;
  slot.q.resize(model.coordinates.size());
  slot.v.resize(model.rates.size());
  slot.a.resize(model.rates.size());
  slot.poses.resize(12 * model.bodies.size());
  return slot;
}

}  // namespace

Outbox::Outbox(const StreamModel& model, bool lossless)
    : lossless_(lossless),
      depth_(lossless ? lossless_depth : 1),
      slots_(depth_ + 2, slot_for(model)),
      waiting_(depth_) {
  free_.reserve(slots_.size());
  for (std::size_t slot = 2; slot < slots_.size(); ++slot) free_.push_back(slot);
}

void Outbox::put(const Snapshot& snapshot, std::int64_t utime) {
  Slot& slot = slots_[writing_];
  slot.utime = utime;
  slot.time = snapshot.time;
  std::copy(snapshot.q.begin(), snapshot.q.end(), slot.q.begin());
  std::copy(snapshot.v.begin(), snapshot.v.end(), slot.v.begin());
  std::copy(snapshot.a.begin(), snapshot.a.end(), slot.a.begin());
  std::copy(snapshot.poses.begin(), snapshot.poses.end(), slot.poses.begin());
  slot.closure.reset();
  if (snapshot.closure != nullptr) slot.closure = *snapshot.closure;

  std::unique_lock lock(mutex_);
  slot.sequence = static_cast<std::int64_t>(published_++);
  make_room(lock);
  if (given_up_) {
    ++dropped_;
    return;
  }
  waiting_[(first_ + count_++) % depth_] = writing_;
  writing_ = free_.back();
  free_.pop_back();
  const bool wake = std::exchange(snapshot_wanted_, false);
  lock.unlock();
  if (wake) ready_.notify_one();
}

void Outbox::make_room(std::unique_lock<std::mutex>& lock) {
  if (lossless_) {
    room_.wait(lock, [&] { return count_ < depth_; });
  } else if (count_ == depth_) {
    free_.push_back(waiting_[first_]);
    first_ = (first_ + 1) % depth_;
    --count_;
    ++dropped_;
  }
}

void Outbox::put(Event event) {
  std::unique_lock lock(mutex_);
  event.sequence = event_count_++;
  if (lossless_) room_.wait(lock, [&] { return events_.size() < most_events; });
  if (given_up_ || events_.size() >= most_events) return;
  events_.push_back({std::move(event), static_cast<std::int64_t>(published_)});
  lock.unlock();
  ready_.notify_one();
}

void Outbox::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  ready_.notify_one();
}

void Outbox::give_up() {
  const std::lock_guard lock(mutex_);
  given_up_ = true;
  dropped_ += count_;
  for (; count_ > 0; --count_) {
    free_.push_back(waiting_[first_]);
    first_ = (first_ + 1) % depth_;
  }
  events_.clear();
  room_.notify_all();
}

bool Outbox::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

bool Outbox::is_ready(bool snapshots) const { return !events_.empty() || (snapshots && count_ > 0) || closed_; }

Outbox::Item Outbox::take(bool snapshots, std::chrono::microseconds longest) {
  std::unique_lock lock(mutex_);
  snapshot_wanted_ = snapshots;
  ready_.wait_for(lock, longest, [&] { return is_ready(snapshots); });
  snapshot_wanted_ = false;

  const bool event_first =
      !events_.empty() && (count_ == 0 || events_.front().before <= slots_[waiting_[first_]].sequence || !snapshots);
  if (event_first) {
    Event event = std::move(events_.front().event);
    events_.pop_front();
    room_.notify_all();
    return event;
  }
  if (count_ > 0 && (snapshots || closed_)) {
    free_.push_back(reading_);
    reading_ = waiting_[first_];
    first_ = (first_ + 1) % depth_;
    --count_;
    room_.notify_all();
    return &slots_[reading_];
  }
  if (closed_) return Closed{};
  return Nothing{};
}

}  // namespace koppel

// Turns snapshots and events into LCM messages (abi/lcm) and hands them to a sink.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "stream/outbox.hpp"
#include "stream/sink.hpp"
#include "stream/snapshot.hpp"

namespace koppel {

class Encoder {
 public:
  /// Channels are KOPPEL_<stem>_MODEL and so on.
  Encoder(const StreamModel& model, const std::string& stem);
  ~Encoder();

  /// False, here and below: the sink could not send it.
  bool send_model(Sink& sink, std::int64_t utime);
  /// State and poses, and the closure if there is one.
  bool send(Sink& sink, const Slot& slot);
  bool send(Sink& sink, const Event& event);

 private:
  struct Messages;  // they are kept, so that nothing is allocated for each snapshot
  std::unique_ptr<Messages> messages_;
};

}  // namespace koppel

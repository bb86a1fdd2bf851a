// Where encoded messages go. Used by the publisher's thread alone.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace koppel {

class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;

  /// True: takes every message and may push back. False: only the newest matters, older ones may be dropped.
  virtual bool lossless() const = 0;
  /// False: the message could not be sent.
  virtual bool send(const std::string& channel, std::span<const std::uint8_t> message) = 0;
  /// Makes what was sent outlive this process. False: part of it is lost.
  virtual bool flush() = 0;
};

}  // namespace koppel

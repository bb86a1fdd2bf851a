// Messages written to an LCM log. LCM's own file provider leaves them in a buffer until it is closed, so that a killed
// process would lose the end of its log; this one is flushed, and writes whole events only.
#pragma once

#include <cstddef>
#include <memory>

#include "base/error.hpp"
#include "stream/sink.hpp"
#include "stream/url.hpp"

struct _lcm_eventlog_t;

namespace koppel {

class LogSink : public Sink {
 public:
  /// Overwrites the file. stream_failed: it cannot be opened.
  static Result<std::unique_ptr<LogSink>> open(const ProviderUrl& url);

  bool lossless() const override { return true; }
  /// The event's timestamp is the wall clock when it is written, as LCM's own logger does it.
  bool send(const std::string& channel, std::span<const std::uint8_t> message) override;
  bool flush() override;

 private:
  using Handle = std::unique_ptr<_lcm_eventlog_t, void (*)(_lcm_eventlog_t*)>;
  LogSink(Handle log, std::unique_ptr<char[]> buffer) : buffer_(std::move(buffer)), log_(std::move(log)) {}

  std::unique_ptr<char[]> buffer_;  // the file's; must outlive it
  Handle log_;
  std::size_t buffered_ = 0;  // [byte] at most
};

}  // namespace koppel

#include "stream/log_sink.hpp"

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <utility>

#include <lcm/eventlog.h>

namespace koppel {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;
constexpr std::size_t header_size = 28;  // sync word, number, time, two lengths

}  // namespace

Result<std::unique_ptr<LogSink>> LogSink::open(const ProviderUrl& url) {
  errno = 0;
  Handle log(lcm_eventlog_create(url.path.c_str(), "w"), lcm_eventlog_destroy);
  if (!log) {
    Error error;
    error.code = Code::stream_failed;
    error.element = "stream " + url.text;
    error.message = "the log cannot be written: " + std::string(std::strerror(errno));
    error.advice = "name a file in a folder that exists and may be written to";
    return tl::make_unexpected(std::move(error));
  }
  auto buffer = std::make_unique<char[]>(buffer_size);
  std::setvbuf(log->f, buffer.get(), _IOFBF, buffer_size);
  return std::unique_ptr<LogSink>(new LogSink(std::move(log), std::move(buffer)));
}

bool LogSink::send(const std::string& channel, std::span<const std::uint8_t> message) {
  // Flushed before it is full: each write to the file then ends between two events.
  const std::size_t size = header_size + channel.size() + message.size();
  if (buffered_ + size > buffer_size && !flush()) return false;
  buffered_ += size;

  using std::chrono::duration_cast, std::chrono::microseconds, std::chrono::system_clock;
  lcm_eventlog_event_t event{};
  event.timestamp = duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
  event.channellen = static_cast<std::int32_t>(channel.size());
  event.datalen = static_cast<std::int32_t>(message.size());
  // LCM's C interface takes pointers to changeable data, but only reads them.
  event.channel = const_cast<char*>(channel.c_str());
  event.data = const_cast<std::uint8_t*>(message.data());
  return lcm_eventlog_write_event(log_.get(), &event) == 0;
}

bool LogSink::flush() {
  buffered_ = 0;
  return std::fflush(log_->f) == 0;
}

}  // namespace koppel

#include "plugin/host.hpp"

#include <spdlog/logger.h>

namespace koppel {
namespace {

spdlog::level::level_enum level_of(int32_t severity) {
  if (severity <= KOPPEL_LOG_DEBUG) return spdlog::level::debug;
  if (severity == KOPPEL_LOG_INFO) return spdlog::level::info;
  if (severity == KOPPEL_LOG_WARNING) return spdlog::level::warn;
  return spdlog::level::err;
}

const char* text_or_empty(const char* text) { return text != nullptr ? text : ""; }

}  // namespace

Host::Host(Logger log, std::string speaker)
    : log_(log ? std::move(log) : silent_logger()),
      speaker_(std::move(speaker)),
      table_{sizeof(koppel_host), served_abi, this, write, reject} {}

// The plugin may be written in C: nothing may be thrown through it.
void Host::write(void* context, int32_t severity, const char* message) {
  if (context == nullptr) return;
  const Host& host = *static_cast<const Host*>(context);
  guarded([&] {
    host.log_->log(level_of(severity), "{}: {}", host.speaker_, text_or_empty(message));
    return KOPPEL_OK;
  });
}

void Host::reject(void* context, const char* parameter, const char* message, const char* advice) {
  if (context == nullptr) return;
  guarded([&] {
    static_cast<Host*>(context)->rejection_ =
        Rejection{text_or_empty(parameter), text_or_empty(message), text_or_empty(advice)};
    return KOPPEL_OK;
  });
}

std::string describe_failure(std::optional<koppel_status> status) {
  return status ? "returned " + std::to_string(*status) : "threw an exception";
}

}  // namespace koppel

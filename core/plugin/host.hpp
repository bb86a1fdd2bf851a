// What a plugin sees of the engine while one of its functions runs.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/log.hpp"
#include "koppel/plugin.h"

namespace koppel {

/// The version of the ABI that this engine serves.
inline constexpr koppel_version served_abi = {KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, KOPPEL_ABI_PATCH};

/// The host table for the time of one call; collects the reason if the plugin rejects something.
class Host {
 public:
  struct Rejection {
    std::string parameter;  ///< may be empty
    std::string message;
    std::string advice;  ///< may be empty
  };

  /// speaker: stands before every line that the plugin logs.
  Host(Logger log, std::string speaker);
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  const koppel_host* table() const { return &table_; }
  const std::optional<Rejection>& rejection() const { return rejection_; }

 private:
  static void write(void* context, int32_t severity, const char* message);
  static void reject(void* context, const char* parameter, const char* message, const char* advice);

  Logger log_;
  std::string speaker_;
  std::optional<Rejection> rejection_;
  koppel_host table_;
};

/// The status that a plugin's function returns; nothing if it lets an exception out, which no plugin may.
template <typename Call>
std::optional<koppel_status> guarded(Call&& call) noexcept {
  try {
    return std::forward<Call>(call)();
  } catch (...) {
    return std::nullopt;
  }
}

/// "returned -6" or "threw an exception".
std::string describe_failure(std::optional<koppel_status> status);

}  // namespace koppel

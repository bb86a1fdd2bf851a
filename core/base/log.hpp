// Logging: one spdlog logger for each engine, silent unless the host gives it a sink.
#pragma once

#include <memory>

// Who logs includes <spdlog/logger.h>, which takes a compiler longer than most files of the engine.
namespace spdlog {
class logger;
}

namespace koppel {

using Logger = std::shared_ptr<spdlog::logger>;

/// A logger without a sink.
Logger silent_logger();

}  // namespace koppel

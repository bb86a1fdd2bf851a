// Logging: one spdlog logger for each engine, silent unless the host gives it a sink.
#pragma once

#include <memory>

#include <spdlog/logger.h>

namespace koppel {

using Logger = std::shared_ptr<spdlog::logger>;

/// A logger without a sink.
Logger silent_logger();

}  // namespace koppel

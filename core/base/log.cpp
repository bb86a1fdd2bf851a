#include "base/log.hpp"

#include <spdlog/logger.h>
#include <spdlog/sinks/null_sink.h>

namespace koppel {

Logger silent_logger() {
  auto logger = std::make_shared<spdlog::logger>("koppel", std::make_shared<spdlog::sinks::null_sink_mt>());
  logger->set_level(spdlog::level::off);
  return logger;
}

}  // namespace koppel

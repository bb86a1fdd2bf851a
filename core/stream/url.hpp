// Provider URLs of LCM, checked before LCM sees them: its own checks print to stderr.
#pragma once

#include <string>

#include "base/error.hpp"

namespace koppel {

/// A URL that LCM accepts for publishing.
struct ProviderUrl {
  enum class Kind { multicast, log, memory };
  Kind kind = Kind::multicast;
  std::string text;  ///< the whole of it
  std::string path;  ///< of a log
};

/// Reads "udpm://address:port?ttl=0", "file://path?mode=w" or "memq://". Empty text: the environment variable
/// LCM_DEFAULT_URL, or if that is unset LCM's default. stream_url: another form, or multicast that this machine cannot
/// send now (no route, no interface). The file of a log is not touched.
Result<ProviderUrl> read_provider_url(std::string text);

}  // namespace koppel

// The document as text for a terminal and as comma-separated values.
#pragma once

#include <string>
#include <vector>

#include "bench/rounds.hpp"

namespace koppel::app::bench {

struct File {
  std::string name, text;
};

/// One CSV for each section that is not empty.
std::vector<File> tables(const Json& document);

/// For a terminal.
std::string text(const Json& document);

/// False: a hard case failed, or a comparison found an error or an outcome that is worse.
bool all_well(const Json& document);

/// A time [s], an error, any number in few digits; "-" for null.
std::string in_seconds(const Json& number);
std::string in_powers(const Json& number);
std::string in_short(const Json& number);
std::string median_of(const Json& seconds);

}  // namespace koppel::app::bench

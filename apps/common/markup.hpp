// Text in XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace koppel::app {

/// With the characters that have a meaning there replaced.
std::string escaped(std::string_view text);

}  // namespace koppel::app

// Columns of text on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace koppel::app {

/// How many places a text takes on a terminal: its characters, whatever bytes they have.
std::size_t places(const std::string& text);

/// Prints columns of equally many texts on standard output: the first one flush left, all others right.
void print_table(const std::vector<std::vector<std::string>>& columns);

}  // namespace koppel::app

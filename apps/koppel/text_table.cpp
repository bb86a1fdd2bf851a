#include "koppel/text_table.hpp"

#include <algorithm>
#include <cstdio>

namespace koppel::app {

std::size_t places(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

void print_table(const std::vector<std::vector<std::string>>& columns) {
  std::vector<std::size_t> widths;
  for (const auto& column : columns) {
    std::size_t width = 0;
    for (const std::string& text : column) width = std::max(width, places(text));
    widths.push_back(width);
  }
  for (std::size_t row = 0; row < columns.front().size(); ++row) {
    std::string line;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string& text = columns[i][row];
      const std::size_t space = widths[i] - places(text);
      if (i > 0) line.append(space + 2, ' ');
      line += text;
      if (i == 0) line.append(space, ' ');
    }
    std::puts(line.c_str());
  }
}

}  // namespace koppel::app

#include "common/table.hpp"

#include <array>
#include <charconv>
#include <iostream>

namespace koppel::app {

Table::Table(const std::string& file, const std::vector<std::string>& columns) : out_(file == "-" ? std::cout : file_) {
  if (file != "-") file_.open(file);
  for (std::size_t i = 0; i < columns.size(); ++i) out_ << (i == 0 ? "" : ",") << columns[i];
  out_ << '\n';
}

void Table::row(const std::vector<double>& values) {
  std::array<char, 32> digits{};  // the shortest exact text of a double has at most 24 characters
  for (std::size_t i = 0; i < values.size(); ++i) {
    // The sum turns a negative zero into zero and leaves every other number as it is.
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), values[i] + 0.0).ptr;
    if (i > 0) out_.put(',');
    out_.write(digits.data(), end - digits.data());
  }
  out_.put('\n');
}

bool Table::good() { return out_.flush().good(); }

}  // namespace koppel::app

// Tables of numbers as comma-separated values.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace koppel::app {

/// Writes rows to a file, or to standard output for the name "-". Numbers have as many digits as it takes to read them
/// back exactly.
class Table {
 public:
  /// good() tells whether the file could be opened and everything was written.
  Table(const std::string& file, const std::vector<std::string>& columns);
  void row(const std::vector<double>& values);
  /// Writes out what is still held back.
  bool good();

 private:
  std::ofstream file_;
  std::ostream& out_;
};

}  // namespace koppel::app

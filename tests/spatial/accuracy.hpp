// Errors in units of rounding, the worst of many, collected into tables that the program prints and keeps.
#pragma once

#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "spatial/types.hpp"

namespace koppel::test {

using Long = long double;

/// Unit of rounding of double: the greatest relative error of one operation.
constexpr Long unit = 0x1p-53L;

/// The greatest of many errors, in units of what they may be compared with.
class Worst {
 public:
  void take(Long error, Long scale) {
    const double units = error == 0 ? 0.0 : static_cast<double>(error / (unit * scale));
    // What is no number is the worst of all.
    if (!(units <= worst_)) worst_ = std::isnan(units) ? INFINITY : units;
    ++count_;
  }
  template <typename A, typename B>
  void take(const Eigen::MatrixBase<A>& computed, const Eigen::MatrixBase<B>& exact, Long scale) {
    take((computed.template cast<Long>() - exact).norm(), scale);
  }
  double value() const { return worst_; }
  long count() const { return count_; }

 private:
  double worst_ = 0;
  long count_ = 0;
};

/// Rows of errors. As Markdown, with fixed widths, so that it reads as text, too.
class ErrorList {
 public:
  explicit ErrorList(std::string title) : title_(std::move(title)) {}

  Worst& operator[](const std::string& what) {
    for (auto& [name, worst] : rows_) {
      if (name == what) return worst;
    }
    return rows_.emplace_back(what, Worst()).second;
  }
  const std::vector<std::pair<std::string, Worst>>& rows() const { return rows_; }

  std::string text() const {
    std::ostringstream out;
    out << "\n" << title_ << "\n\n| what | worst | cases |\n| --- | --- | --- |\n";
    for (const auto& [name, worst] : rows_) {
      out << "| " << std::left << std::setw(60) << name << " | " << std::right << std::fixed << std::setprecision(2)
          << std::setw(6) << worst.value() << " | " << std::setw(8) << worst.count() << " |\n";
    }
    return out.str();
  }

 private:
  std::string title_;
  std::vector<std::pair<std::string, Worst>> rows_;
};

/// Errors of what leads from one of a few kinds to another.
template <std::size_t n>
class ErrorSquare {
 public:
  ErrorSquare(std::string title, std::array<std::string, n> names)
      : title_(std::move(title)), names_(std::move(names)) {}

  Worst& at(std::size_t from, std::size_t to) { return worst_[from][to]; }
  const std::string& name(std::size_t kind) const { return names_[kind]; }

  std::string text() const {
    std::ostringstream out;
    out << "\n" << title_ << " (" << worst_[0][1].count() << " cases each)\n\n| from \\ to       |";
    for (const auto& name : names_) out << " " << std::setw(15) << name << " |";
    out << "\n| --- |";
    for (std::size_t k = 0; k < n; ++k) out << " --- |";
    for (std::size_t from = 0; from < n; ++from) {
      out << "\n| " << std::left << std::setw(15) << names_[from] << " |" << std::right << std::fixed
          << std::setprecision(2);
      for (std::size_t to = 0; to < n; ++to) {
        if (from == to) {
          out << "                 |";
        } else {
          out << " " << std::setw(15) << worst_[from][to].value() << " |";
        }
      }
    }
    out << "\n";
    return out.str();
  }

 private:
  std::string title_;
  std::array<std::string, n> names_;
  std::array<std::array<Worst, n>, n> worst_;
};

}  // namespace koppel::test

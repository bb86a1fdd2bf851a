// What became of random mechanisms, in numbers.
#pragma once

#include <algorithm>
#include <array>
#include <iomanip>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "random_mechanism.hpp"

namespace koppel::test {

/// A sample of a quantity; prints where its share lies.
struct Percentiles {
  std::string name;
  std::vector<double> values;

  void print(std::ostream& out) {
    std::sort(values.begin(), values.end());
    out << std::left << std::setw(44) << name << std::right << std::setw(9) << values.size();
    for (const double share : {0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto last = static_cast<double>(values.size()) - 1.0;
      out << std::setw(11);
      if (values.empty()) {
        out << "-";
      } else {
        out << std::setprecision(2) << values[static_cast<std::size_t>(share * last + 0.5)];
      }
    }
    out << "\n";
  }
};

/// How often something was tried, and how often it went well.
struct Rate {
  std::size_t tried = 0, well = 0;
  void add(bool went_well) {
    ++tried;
    if (went_well) ++well;
  }
  std::string text() const {
    if (tried == 0) return "-";
    std::ostringstream out;
    out << std::fixed << std::setprecision(2) << 100.0 * static_cast<double>(well) / static_cast<double>(tried) << "% "
        << tried;
    return out.str();
  }
};

struct RandomMechanismTable {
  /// The columns; each as a rate of success and its sample.
  enum Column { near, very_near, on_known, from_afar, afar_on_known, refused, complete, column_count };
  static constexpr std::array<const char*, column_count> headings{
      "near closes", "very near", "on the known", "from afar", "afar on known", "too long refused", "modes complete"};

  std::array<std::size_t, special_names.size()> cases{};
  std::array<std::size_t, special_names.size()> unreachable{};  ///< how often that was said
  std::array<std::array<Rate, column_count>, special_names.size()> rates{};
  Percentiles near_residual{"residual from near", {}}, afar_residual{"residual from afar", {}},
      substituted{"open by substitution, of the extent", {}}, near_iterations{"iterations from near", {}},
      afar_iterations{"iterations from afar, closed", {}}, lost_iterations{"iterations from afar, not found", {}},
      missed{"way from the known position, times sigma", {}}, mode_count{"modes, where complete", {}};
  std::map<std::string, std::size_t> failures;

  void add(Special special, Column column, bool well) { rates[static_cast<std::size_t>(special)][column].add(well); }

  void print(std::ostream& out) {
    out << std::left << std::setw(17) << "share and number" << std::right << std::setw(7) << "cases";
    for (const char* heading : headings) out << std::setw(18) << heading;
    out << std::setw(18) << "said unreachable"
        << "\n";
    for (std::size_t i = 0; i < cases.size(); ++i) {
      out << std::left << std::setw(17) << special_names[i] << std::right << std::setw(7) << cases[i];
      for (const Rate& rate : rates[i]) out << std::setw(18) << rate.text();
      out << std::setw(18) << unreachable[i] << "\n";
    }
    out << std::left << std::setw(44) << "percentiles" << std::right << std::setw(9) << "number";
    for (const char* share : {"50 %", "90 %", "99 %", "99.9 %", "greatest"}) out << std::setw(11) << share;
    out << "\n";
    for (Percentiles* sample : {&near_residual, &afar_residual, &substituted, &missed, &near_iterations,
                                &afar_iterations, &lost_iterations, &mode_count}) {
      sample->print(out);
    }
    const auto rounding = std::upper_bound(near_residual.values.begin(), near_residual.values.end(), 1e-13);
    out << "from near with a residual up to 1e-13: " << rounding - near_residual.values.begin() << " of "
        << near_residual.values.size() << "\n";
    for (const auto& [what, count] : failures) out << "FAILED " << count << " times: " << what << "\n";
  }
};

}  // namespace koppel::test

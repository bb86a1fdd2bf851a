// Values of keys: numbers, quantities and expressions, lists of them, directions, texts. Each function reports what is
// wrong and then returns nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/findings.hpp"
#include "scene/scene_parameters.hpp"
#include "scene/toml_text.hpp"
#include "spatial/types.hpp"

namespace koppel {

/// Reads values of one element. Borrows the parameters in force.
class ValueReader {
 public:
  ValueReader(Reporter report, SceneParameters& parameters) : report_(std::move(report)), parameters_(&parameters) {}

  const Reporter& report() const { return report_; }

  // `what` is the key as messages name it; `unit` the SI unit of the value: a plain quantity must fit it. In units such
  // as m/rad, the quantity is the numerator.

  /// A finite number. Errors: wrong_kind (also for a unit that does not fit), bad_expression, not_finite; out_of_range
  /// for lengths beyond any mechanism.
  std::optional<double> number(const Node& node, std::string_view what, std::string_view unit = "") const;
  /// The same, and greater than 0. Error: out_of_range.
  std::optional<double> positive(const Node& node, std::string_view what, std::string_view unit = "") const;
  /// A list of numbers. Errors also: wrong_count.
  std::optional<std::vector<double>> numbers(const Node& node, std::string_view what, std::size_t count_min,
                                             std::size_t count_max, std::string_view unit = "",
                                             std::string_view advice = "") const;
  std::optional<Vector3> vector(const Node& node, std::string_view what, std::string_view unit = "") const;
  /// A vector of any length but zero, normalised. Error: zero_direction.
  std::optional<Vector3> direction(const Node& node, std::string_view what) const;
  /// w x y z of any length but zero, normalised. Error: zero_direction.
  std::optional<Vector4> quaternion(const Node& node, std::string_view what) const;
  std::optional<std::string> text(const Node& node, std::string_view what) const;
  std::optional<bool> truth(const Node& node, std::string_view what) const;
  bool is_list(const Node& node, std::string_view what, std::size_t count_min, std::size_t count_max,
               std::string_view advice = "") const;

  /// Error: wrong_kind.
  bool is_whole(double value, const Node& node, std::string_view what) const;

  void wrong_kind(const Node& node, std::string_view what, std::string_view expected,
                  std::string_view advice = "") const;

 private:
  bool fits(const Node& string, std::string_view what, std::string_view unit) const;
  std::optional<double> within_reach(double value, const Node& node, std::string_view what,
                                     std::string_view unit) const;

  Reporter report_;
  SceneParameters* parameters_;
};

/// "3", "2 to 4", "at least 2": how many entries are allowed.
std::string count_text(std::size_t count_min, std::size_t count_max);

/// A number as messages show it, without trailing zeros.
std::string number_text(double value);

/// Stands for "any number of entries".
inline constexpr std::size_t unbounded = SIZE_MAX;

}  // namespace koppel

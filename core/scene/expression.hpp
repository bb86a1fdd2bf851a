// Quantities and expressions: "30 deg", "2*crank*sin(alpha)".
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "base/error.hpp"

namespace koppel {

/// What is wrong with an expression, and where in it.
struct ExpressionFault {
  Code code = Code::bad_expression;
  std::size_t offset = 0;
  std::size_t length = 1;
  std::string message;
  std::string advice;
};

/// Computes expressions of named constants, in SI units. Units, functions and `pi` are always known.
class Calculator {
 public:
  Calculator();
  ~Calculator();
  Calculator(Calculator&&) noexcept;
  Calculator& operator=(Calculator&&) noexcept;

  /// `name` must be a name by is_parameter_name() and no reserved_word().
  void define(const std::string& name, double value);
  /// Faults: bad_expression, not_finite.
  tl::expected<double, ExpressionFault> evaluate(const std::string& text) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The names that stand in an expression; functions and units too.
std::vector<std::string> names_in(std::string_view expression);

/// A letter or underscore, then letters, digits and underscores.
bool is_parameter_name(std::string_view text);

/// What a word of the language is: "a unit", "a function", "a constant"; empty for all other words.
std::string_view reserved_word(std::string_view word);

/// For a plain quantity, a number and a unit, the SI unit that it is measured in: "m", "rad", "s" or "kg". Else empty.
std::string_view quantity_unit(std::string_view text);

}  // namespace koppel

// Findings: what went wrong, where, and what to do. One type for errors, warnings and notes of every room.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace koppel {

enum class Severity { note, warning, error };

enum class Code : std::uint16_t {
#define KOPPEL_CODE(number, identifier, explanation) identifier = number,
#include "base/codes.inc"
#undef KOPPEL_CODE
};

/// A place in a text, with the line itself so that it can be shown without the file.
struct Source {
  std::string file;
  std::string line_text;
  int line = 0;    ///< from 1; 0: no place
  int column = 0;  ///< from 1, in bytes
  int length = 0;  ///< bytes that are marked
};

struct Error {
  Code code = Code::internal;
  Severity severity = Severity::error;
  Source source;
  std::string element;  ///< "joint crank"; may be empty
  std::string message;  ///< one sentence without a full stop
  std::string advice;   ///< what to do instead; may be empty
};

/// An error about an element, without a place in a text.
Error make_error(Code code, std::string element, std::string message, std::string advice = {});

/// The value, or why there is none.
template <typename T>
using Result = tl::expected<T, Error>;

/// "E0304", "W0408", "N0601": the letter tells the severity.
std::string code_text(Code code, Severity severity);

/// The explanation of "E0304" or "304"; nothing if there is no such code.
std::optional<std::string> explain_code(std::string_view text);

/// The finding as a compiler would print it: place, line with caret, message, advice. Ends with a newline.
std::string render(const Error& error);

/// The candidate nearest to a misspelt name, if one is near enough to be worth proposing.
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// All findings of a reading or compiling, in the order in which they were made.
class Diagnostics {
 public:
  void add(Error finding);
  const std::vector<Error>& findings() const { return findings_; }
  bool has_errors() const;
  /// The first error; only to be called when there is one.
  const Error& first_error() const;
  std::string render() const;

 private:
  std::vector<Error> findings_;
};

}  // namespace koppel

/// Returns from the enclosing function with the error of a failed Result; otherwise goes on.
#define KOPPEL_CHECK(expression)                                     \
  do {                                                               \
    if (auto koppel_checked = (expression); !koppel_checked) {       \
      return tl::make_unexpected(std::move(koppel_checked).error()); \
    }                                                                \
  } while (false)

#define KOPPEL_CONCATENATE_(a, b) a##b
#define KOPPEL_CONCATENATE(a, b) KOPPEL_CONCATENATE_(a, b)
#define KOPPEL_TRY_(result, declaration, expression)                  \
  auto result = (expression);                                         \
  if (!result) return tl::make_unexpected(std::move(result).error()); \
  declaration = std::move(*result)

/// KOPPEL_TRY(auto x, f()): the value of a Result, or return with its error.
#define KOPPEL_TRY(declaration, expression) \
  KOPPEL_TRY_(KOPPEL_CONCATENATE(koppel_result_, __LINE__), declaration, expression)

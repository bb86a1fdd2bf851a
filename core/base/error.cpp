#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

namespace koppel {
namespace {

struct Explanation {
  int number;
  std::string_view text;
};

constexpr auto explanations = std::to_array<Explanation>({
#define KOPPEL_CODE(number, identifier, explanation) {number, explanation},
#include "base/codes.inc"
#undef KOPPEL_CODE
});

char letter(Severity severity) {
  switch (severity) {
    case Severity::note: return 'N';
    case Severity::warning: return 'W';
    case Severity::error: return 'E';
  }
  return 'E';
}

std::string_view word(Severity severity) {
  switch (severity) {
    case Severity::note: return "note";
    case Severity::warning: return "warning";
    case Severity::error: return "error";
  }
  return "error";
}

/// Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<std::size_t> before_last(columns), last(columns), row(columns);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last.back();
}

}  // namespace

Error make_error(Code code, std::string element, std::string message, std::string advice) {
  Error error;
  error.code = code;
  error.element = std::move(element);
  error.message = std::move(message);
  error.advice = std::move(advice);
  return error;
}

std::string code_text(Code code, Severity severity) {
  std::string digits = std::to_string(static_cast<int>(code));
  return letter(severity) + std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits;
}

std::optional<std::string> explain_code(std::string_view text) {
  if (!text.empty() && (text[0] == 'E' || text[0] == 'W' || text[0] == 'N')) text.remove_prefix(1);
  int number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (status != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  const auto found = std::find_if(explanations.begin(), explanations.end(),
                                  [number](const Explanation& e) { return e.number == number; });
  if (found == explanations.end()) return std::nullopt;
  return std::string(found->text);
}

std::string render(const Error& error) {
  std::string out;
  const Source& at = error.source;
  if (at.line > 0) {
    out += at.file + ':' + std::to_string(at.line) + ':' + std::to_string(at.column) + ": ";
  } else if (!at.file.empty()) {
    out += at.file + ": ";
  }
  out += std::string(word(error.severity)) + '[' + code_text(error.code, error.severity) + "]: ";
  if (!error.element.empty()) out += error.element + ": ";
  out += error.message + '\n';
  if (at.line > 0 && at.column > 0) {
    const std::string margin = std::to_string(at.line);
    out += "  " + margin + " | " + at.line_text + '\n';
    out += "  " + std::string(margin.size(), ' ') + " | ";
    // Tabs stay tabs, so that the caret stands under what it marks.
    for (int i = 0; i + 1 < at.column; ++i) {
      const auto k = static_cast<std::size_t>(i);
      out += k < at.line_text.size() && at.line_text[k] == '\t' ? '\t' : ' ';
    }
    out += '^' + std::string(static_cast<std::size_t>(std::max(0, at.length - 1)), '~') + '\n';
  }
  if (!error.advice.empty()) out += "  help: " + error.advice + '\n';
  return out;
}

std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  const std::size_t allowed = std::max<std::size_t>(1, name.size() / 3);
  std::optional<std::string> best;
  std::size_t best_distance = allowed + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

void Diagnostics::add(Error finding) { findings_.push_back(std::move(finding)); }

bool Diagnostics::has_errors() const {
  return std::any_of(findings_.begin(), findings_.end(), [](const Error& e) { return e.severity == Severity::error; });
}

const Error& Diagnostics::first_error() const {
  return *std::find_if(findings_.begin(), findings_.end(),
                       [](const Error& e) { return e.severity == Severity::error; });
}

std::string Diagnostics::render() const {
  std::string out;
  for (const Error& finding : findings_) out += koppel::render(finding);
  return out;
}

}  // namespace koppel

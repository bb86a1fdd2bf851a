// Findings of one reading: collected from all passes, told once each and in the order of the text.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "scene/toml_text.hpp"

namespace koppel {

class Findings {
 public:
  void add(Error finding) { findings_.push_back(std::move(finding)); }
  bool has_errors() const;
  /// Hands them over. A finding made twice at one place, by a file that is included twice, is told once.
  void hand_over(Diagnostics& diagnostics);

 private:
  std::vector<Error> findings_;
};

/// Speaks about one element of one document. Borrows both.
class Reporter {
 public:
  Reporter(Findings& findings, const Document& document, std::string element)
      : findings_(&findings), document_(&document), element_(std::move(element)) {}

  const Document& document() const { return *document_; }
  void error(Code code, const Place& place, std::string message, std::string advice = {}) const;
  void warning(Code code, const Place& place, std::string message, std::string advice = {}) const;
  void note(Code code, const Place& place, std::string message, std::string advice = {}) const;
  /// A finding of another room, which knows neither place nor element.
  void error(Error finding, const Place& place) const;

 private:
  void add(Code code, Severity severity, const Place& place, std::string message, std::string advice) const;

  Findings* findings_;
  const Document* document_;
  std::string element_;
};

/// A word as messages show it: in backquotes.
std::string quote(std::string_view word);

/// The advice "did you mean `x`?", or nothing if no candidate is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace koppel

#include "scene/findings.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace koppel {

bool Findings::has_errors() const {
  return std::any_of(findings_.begin(), findings_.end(), [](const Error& e) { return e.severity == Severity::error; });
}

void Findings::hand_over(Diagnostics& diagnostics) {
  std::vector<std::string> files;  // in the order in which they were first spoken of
  const auto rank = [&files](const Error& e) {
    const auto found = std::find(files.begin(), files.end(), e.source.file);
    const auto index = found - files.begin();
    if (found == files.end()) files.push_back(e.source.file);
    return index;
  };
  using Key = std::tuple<std::ptrdiff_t, int, int, std::size_t>;
  std::vector<Key> order;
  for (std::size_t i = 0; i < findings_.size(); ++i) {
    const Error& e = findings_[i];
    order.emplace_back(rank(e), e.source.line, e.source.column, i);
  }
  std::sort(order.begin(), order.end());
  std::set<std::tuple<std::ptrdiff_t, int, int, Code, std::string>> told;
  for (const auto& [file, line, column, i] : order) {
    Error& e = findings_[i];
    if (told.emplace(file, line, column, e.code, e.message).second) diagnostics.add(std::move(e));
  }
  findings_.clear();
}

void Reporter::add(Code code, Severity severity, const Place& place, std::string message, std::string advice) const {
  findings_->add({code, severity, document_->source(place), element_, std::move(message), std::move(advice)});
}

void Reporter::error(Code code, const Place& place, std::string message, std::string advice) const {
  add(code, Severity::error, place, std::move(message), std::move(advice));
}

void Reporter::warning(Code code, const Place& place, std::string message, std::string advice) const {
  add(code, Severity::warning, place, std::move(message), std::move(advice));
}

void Reporter::note(Code code, const Place& place, std::string message, std::string advice) const {
  add(code, Severity::note, place, std::move(message), std::move(advice));
}

void Reporter::error(Error finding, const Place& place) const {
  finding.source = document_->source(place);
  finding.element = element_;
  findings_->add(std::move(finding));
}

std::string quote(std::string_view word) { return '`' + std::string(word) + '`'; }

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const auto nearest = nearest_name(word, candidates);
  return nearest ? "did you mean " + quote(*nearest) + '?' : std::string{};
}

}  // namespace koppel

#include "scene/names.hpp"

#include <algorithm>

namespace koppel {
namespace {

std::string joined(std::string_view prefix, std::string_view name) { return std::string(prefix) + std::string(name); }

/// The nearest name; where none is near, the one that is so without the prefix of an included scene.
std::string nearest_advice(std::string_view name, const std::vector<std::string>& candidates) {
  std::string advice = did_you_mean(name, candidates);
  if (!advice.empty()) return advice;
  std::vector<std::string> ends;
  ends.reserve(candidates.size());
  for (const std::string& candidate : candidates) ends.push_back(candidate.substr(candidate.rfind('.') + 1));
  const auto nearest = nearest_name(name, ends);
  if (!nearest) return {};
  const auto index = std::find(ends.begin(), ends.end(), *nearest) - ends.begin();
  return "did you mean " + quote(candidates[static_cast<std::size_t>(index)]) + '?';
}

/// All names that can be written in a file with this prefix, as they are written there.
template <typename Value, typename Wanted>
std::vector<std::string> visible(const std::map<std::string, Value>& names, std::string_view prefix, Wanted wanted) {
  std::vector<std::string> out;
  for (auto i = names.lower_bound(std::string(prefix)); i != names.end() && i->first.rfind(prefix, 0) == 0; ++i) {
    if (i->first.size() > prefix.size() && wanted(i->second)) out.push_back(i->first.substr(prefix.size()));
  }
  return out;
}

}  // namespace

Names::Names() { add_body("ground", ground); }

std::optional<Names::Fixed> Names::find_fixed(std::string_view prefix, std::string_view name) const {
  const auto found = fixed_.find(name == "ground" ? std::string(name) : joined(prefix, name));
  return found == fixed_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<JointId> Names::find_joint(std::string_view prefix, std::string_view name) const {
  const auto found = joints_.find(joined(prefix, name));
  return found == joints_.end() ? std::nullopt : std::optional(found->second);
}

bool Names::is_lost(std::string_view prefix, std::string_view name) const {
  const std::string full = joined(prefix, name);
  if (refused_.count(full) > 0) return true;
  return std::any_of(lost_.begin(), lost_.end(), [&full](const std::string& lost) { return full.rfind(lost, 0) == 0; });
}

std::optional<BodyId> Names::body(std::string_view name, const Mention& mention) const {
  const auto found = find_fixed(mention.prefix, name);
  if (found && found->is_body) return BodyId{found->index};
  if (is_lost(mention.prefix, name)) return std::nullopt;
  auto bodies = visible(fixed_, mention.prefix, [](const Fixed& f) { return f.is_body; });
  bodies.emplace_back("ground");
  mention.report.error(Code::unknown_body, mention.place,
                       found ? quote(name) + " is a frame; here a body is needed" : "no body is called " + quote(name),
                       nearest_advice(name, bodies));
  return std::nullopt;
}

std::optional<Names::Fixed> Names::fixed(std::string_view name, const Mention& mention) const {
  const auto found = find_fixed(mention.prefix, name);
  if (found || is_lost(mention.prefix, name)) return found;
  auto frames = visible(fixed_, mention.prefix, [](const Fixed&) { return true; });
  frames.emplace_back("ground");
  mention.report.error(Code::unknown_frame, mention.place, "no frame or body is called " + quote(name),
                       nearest_advice(name, frames));
  return std::nullopt;
}

std::optional<JointId> Names::joint(std::string_view name, const Mention& mention) const {
  const auto found = find_joint(mention.prefix, name);
  if (found || is_lost(mention.prefix, name)) return found;
  mention.report.error(Code::unknown_joint, mention.place, "no joint is called " + quote(name),
                       nearest_advice(name, visible(joints_, mention.prefix, [](JointId) { return true; })));
  return std::nullopt;
}

bool is_element_name(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (name.empty() || !is_letter(name.front())) return false;
  return std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

}  // namespace koppel

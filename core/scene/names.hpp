// The names of a scene: bodies and frames share one name space, joints have their own. Names of included scenes begin
// with a prefix; within their file they are written without it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/id.hpp"
#include "scene/findings.hpp"

namespace koppel {

/// Where a name is written: the prefix that its file has, who speaks of it, and where it stands.
struct Mention {
  std::string_view prefix;
  const Reporter& report;
  Place place;
};

class Names {
 public:
  struct Fixed {
    bool is_body = true;
    std::uint32_t index = 0;  ///< of the body or the frame
  };

  Names();

  // False: the name is taken.
  bool add_body(const std::string& name, BodyId id) { return fixed_.emplace(name, Fixed{true, id.value}).second; }
  bool add_frame(const std::string& name, FrameId id) { return fixed_.emplace(name, Fixed{false, id.value}).second; }
  bool add_joint(const std::string& name, JointId id) { return joints_.emplace(name, id).second; }
  /// Names with this prefix are unknown because an include failed: nobody complains of them.
  void give_up(std::string prefix) { lost_.push_back(std::move(prefix)); }

  /// An element has this name, with prefix, but may not: nobody complains that it is unknown.
  void refuse(std::string name) { refused_.insert(std::move(name)); }
  /// Whether a name is unknown because of a fault that has been reported.
  bool is_lost(std::string_view prefix, std::string_view name) const;

  std::optional<Fixed> find_fixed(std::string_view prefix, std::string_view name) const;
  std::optional<JointId> find_joint(std::string_view prefix, std::string_view name) const;

  // The same, with an error if there is none: unknown_body, unknown_frame, unknown_joint.
  std::optional<BodyId> body(std::string_view name, const Mention& mention) const;
  std::optional<Fixed> fixed(std::string_view name, const Mention& mention) const;
  std::optional<JointId> joint(std::string_view name, const Mention& mention) const;

 private:
  std::map<std::string, Fixed> fixed_;
  std::map<std::string, JointId> joints_;
  std::vector<std::string> lost_;
  std::set<std::string> refused_;
};

/// A letter or underscore, then letters, digits, underscores and hyphens.
bool is_element_name(std::string_view name);

}  // namespace koppel

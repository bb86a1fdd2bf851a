// Rewrites of a scene that leave its motion as it is, on the parsed text. They know the scene language and nothing of
// the engine. [[record]] is left out of what they write: bodies are compared, and they have poses without it.
#pragma once

#include <map>
#include <random>
#include <set>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <toml++/toml.h>

namespace koppel::test {

using Random = std::mt19937_64;

/// Where the whole scene lies: turns about x, y and z as turned so far, then a shift [m].
struct Place {
  Eigen::Vector3d turns = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();

  Eigen::Matrix3d rotation() const;
};

Place random_place(Random& random);

/// The text of a scene under rewriting.
class Rewriting {
 public:
  /// Throws std::runtime_error where the scene uses something that the rewrites do not know.
  explicit Rewriting(std::string_view text);

  std::string text() const;

  /// Gives bodies, frames, joints, constraints, drives and forces new names in a random order; old to new ones of the
  /// bodies.
  std::map<std::string, std::string> rename(Random& random);
  /// Shuffles bodies, frames, joints, constraints, drives and forces.
  void reorder(Random& random);
  /// Swaps inlet and outlet of a random half of the joints that no drive or force acts on, as far as their motion is
  /// one of the same type then: R, P, H, C, S, T and weld; how many it swapped.
  std::size_t swap_joints(Random& random);
  /// Moves everything that is fixed in the world, and gravity.
  void relocate(const Place& place);
  /// type = "revolute" becomes "vendor.revolute", and so on for all joints.
  void change_vendor(std::string_view vendor);

 private:
  toml::array& tables(std::string_view key);
  template <typename Do>
  void each(std::string_view key, Do action);
  std::set<std::string> bound_joints();
  /// The description in place of what `inlet` or `outlet` of a joint names.
  toml::table described(const toml::node& frame);
  bool swap(toml::table& joint);
  void swap_universal(toml::table& joint);
  void relocate_joint(toml::table& joint, const Place& place);
  void relocate_force(toml::table& force, const Place& place);
  void relocate_frame(toml::table& frame, const Place& place);

  toml::table root_;
};

}  // namespace koppel::test

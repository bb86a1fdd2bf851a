// What must not change the motion of a scene: names, order, which side of a joint is its inlet, where the scene lies in
// the world, and whose plugin a joint's type comes from.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "folders.hpp"
#include "model.hpp"
#include "rewriting.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr std::uint64_t seeds[] = {1, 2, 3};

/// Bodies between two balls spin about their own line without anything that decides how: only how that line lies can
/// be compared.
const std::multimap<std::string, std::string>& free_spins() {
  static const std::multimap<std::string, std::string> spins{{"dwb", "upper_link"}};
  return spins;
}

using Names = std::map<std::string, std::string>;

struct SameMotion : testing::TestWithParam<std::string> {
  const std::string text = shipped_scene(GetParam());
  const Model original{text};

  /// Bodies of the other scene move as those of the original do, seen from `place`. names: of bodies, old to new;
  /// those not in it are the same.
  void expect_same_motion(const std::string& other_text, const Names& names, const Place& place = {}) {
    const Model other(other_text);
    ASSERT_EQ(other.sizes().bodies, original.sizes().bodies);
    EXPECT_EQ(other.sizes().loops, original.sizes().loops);
    EXPECT_NEAR(other.settings().length, original.settings().length, 8 * eps * original.settings().length);
    Motion first(original), second(other);
    for (std::size_t i = 0; i <= original.settings().steps; ++i) {
      const Outcome a = first.move(original.time(i)), b = second.move(original.time(i));
      ASSERT_TRUE(a) << "step " << i << ": " << a.message;
      ASSERT_TRUE(b) << "step " << i << ": " << b.message << '\n' << other_text;
      compare(first, second, names, place, a.report.coordinate_error + b.report.coordinate_error);
      if (HasFailure()) {
        ADD_FAILURE() << "step " << i << '\n' << other_text;
        return;
      }
    }
    EXPECT_EQ(first.analysis().mobility_rank, second.analysis().mobility_rank);
  }

  /// The same numbers throughout, bit for bit.
  void expect_same_bits(const Model& other) {
    Motion first(original), second(other);
    for (std::size_t i = 0; i <= original.settings().steps; ++i) {
      ASSERT_TRUE(first.move(original.time(i)));
      const Outcome outcome = second.move(original.time(i));
      ASSERT_TRUE(outcome) << "step " << i << ": " << outcome.message;
      ASSERT_TRUE(same_bits(first.positions(), second.positions())) << "step " << i;
      ASSERT_TRUE(same_bits(first.accelerations(), second.accelerations())) << "step " << i;
    }
  }

 private:
  void compare(Motion& first, Motion& second, const Names& names, const Place& place, double coordinate_error) {
    const Eigen::MatrixXd ours = first.poses(KOPPEL_KIND_BODY), theirs = second.poses(KOPPEL_KIND_BODY);
    const Eigen::Matrix3d turned = place.rotation();
    // Every joint on the way to a body adds what its coordinate may be wrong by, turned about a point within reach.
    const double reach = original.settings().length + place.shift.norm() + ours.bottomRows(3).cwiseAbs().maxCoeff();
    const double joints = original.sizes().joints;
    const double turn_allowed = joints * (coordinate_error + 16 * eps), move_allowed = reach * turn_allowed;
    for (std::size_t body = 1; body < original.sizes().bodies; ++body) {
      const std::string name = original.name(KOPPEL_KIND_BODY, body);
      const auto renamed = names.find(name);
      const std::size_t twin = second.model().find(KOPPEL_KIND_BODY, renamed == names.end() ? name : renamed->second);
      const auto pose = ours.col(static_cast<Eigen::Index>(body));
      const auto twin_pose = theirs.col(static_cast<Eigen::Index>(twin));
      if (spins(name)) continue;
      EXPECT_LE((turned * rotation_of(pose) - rotation_of(twin_pose)).norm(), turn_allowed) << name;
      EXPECT_LE((turned * position_of(pose) + place.shift - position_of(twin_pose)).norm(), move_allowed) << name;
    }
  }

  bool spins(const std::string& body) const {
    const auto [begin, end] = free_spins().equal_range(GetParam());
    return std::any_of(begin, end, [&](const auto& entry) { return entry.second == body; });
  }
};

// Otherwise more bodies would move as nobody says.
TEST_P(SameMotion, IsDecidedByTheInputsButForFreeSpins) {
  Motion motion(original);
  motion.run_to(0);
  const auto spinning = static_cast<std::int32_t>(free_spins().count(GetParam()));
  EXPECT_EQ(motion.analysis().mobility_rank, static_cast<std::int32_t>(original.sizes().inputs) + spinning);
}

TEST_P(SameMotion, WhenRenamed) {
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    Rewriting rewriting(text);
    const Names names = rewriting.rename(random);
    expect_same_motion(rewriting.text(), names);
    expect_same_bits(Model(rewriting.text()));
  }
}

TEST_P(SameMotion, WhenReordered) {
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    Rewriting rewriting(text);
    rewriting.reorder(random);
    expect_same_motion(rewriting.text(), {});
  }
}

TEST_P(SameMotion, WithInletsAndOutletsSwapped) {
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    Rewriting rewriting(text);
    rewriting.swap_joints(random);
    expect_same_motion(rewriting.text(), {});
  }
}

TEST_P(SameMotion, AnywhereInTheWorld) {
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    Rewriting rewriting(text);
    const Place place = random_place(random);
    rewriting.relocate(place);
    expect_same_motion(rewriting.text(), {}, place);
  }
}

TEST_P(SameMotion, WithAllOfThisTogether) {
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    Rewriting rewriting(text);
    const Place place = random_place(random);
    rewriting.swap_joints(random);
    rewriting.reorder(random);
    rewriting.relocate(place);
    const Names names = rewriting.rename(random);
    expect_same_motion(rewriting.text(), names, place);
  }
}

TEST_P(SameMotion, ToTheBitWithStandardPluginsAsSharedObjects) {
  expect_same_bits(Model(text, {{}, standard_plugins_folder()}));
}

TEST_P(SameMotion, ToTheBitWithAStrangersJoints) {
  Rewriting rewriting(text);
  rewriting.change_vendor("acme");
  expect_same_bits(Model(rewriting.text(), {test_plugins_folder(), {}}));
}

INSTANTIATE_TEST_SUITE_P(Scenes, SameMotion, testing::ValuesIn(shipped_scenes()),
                         [](const auto& test) { return test_name(test.param); });

/// A shipped scene changed here and there.
std::string changed(const std::string& scene, const std::vector<std::pair<std::string, std::string>>& replacements) {
  std::string text = shipped_scene(scene);
  for (const auto& [old, with] : replacements) text.replace(text.find(old), old.size(), with);
  return text;
}

/// Its crank swings to and fro.
std::string long_crank() {
  return changed(
      "rstr", {{"crank = 0.10", "crank = 0.30"}, {"slope = \"360 deg\"", "start = \"100 deg\"\nslope = \"10 deg\""}});
}

/// Its links come to lie in line after one second.
std::string parallelogram() {
  return changed("4bar", {{"crank = 0.12", "crank = 0.25"},
                          {"coupler = 0.35", "coupler = 0.40"},
                          {"start = { angle = \"45 deg\" }", "start = { angle = \"-90 deg\" }"},
                          {"start = { angle = \"97.5 deg\" }", "start = { angle = \"90 deg\" }"},
                          {"start = { angle = \"-52.5 deg\" }", "start = { angle = \"-90 deg\" }"},
                          {"slope = \"360 deg\"", "start = \"90 deg\"\nslope = \"90 deg\""}});
}

/// What a rewritten scene says of the step over a singular position.
struct OverSingularPosition : testing::TestWithParam<std::uint64_t> {
  static koppel_report report_of(const std::string& text) {
    const Model model(text);
    Motion motion(model);
    EXPECT_TRUE(motion.move(0.0));
    EXPECT_TRUE(motion.move(0.9));
    // Up to here the parallelogram has no change point, and the long crank no limit.
    Outcome outcome = motion.move(1.23);
    if (outcome && outcome.report.change_points == 0) outcome = motion.move(8.0);
    return outcome.report;
  }

  void expect_same(const std::string& text, const std::string& other_text) {
    const koppel_report one = report_of(text), other = report_of(other_text);
    EXPECT_EQ(one.verdict, other.verdict) << other_text;
    EXPECT_EQ(one.change_points, other.change_points) << other_text;
    EXPECT_NEAR(one.change_point_time, other.change_point_time, 1e-11) << other_text;
    EXPECT_NEAR(one.limit_time, other.limit_time, 1e-12 * (1 + one.limit_time)) << other_text;
    EXPECT_NEAR(one.limit_value, other.limit_value, 1e-13 * (1 + one.limit_value)) << other_text;
  }
};

TEST_P(OverSingularPosition, NothingIsToldOtherwiseByARewrittenScene) {
  for (const std::string& text : {long_crank(), parallelogram()}) {
    Random random(GetParam());
    const koppel_report report = report_of(text);
    EXPECT_EQ(report.limits + report.change_points, 1u);
    Rewriting rewriting(text);
    rewriting.rename(random);
    expect_same(text, rewriting.text());
    rewriting.reorder(random);
    expect_same(text, rewriting.text());
    rewriting.swap_joints(random);
    expect_same(text, rewriting.text());
    rewriting.relocate(random_place(random));
    expect_same(text, rewriting.text());
  }
}

INSTANTIATE_TEST_SUITE_P(Of, OverSingularPosition, testing::Range<std::uint64_t>(1, 21));

}  // namespace
}  // namespace koppel::test

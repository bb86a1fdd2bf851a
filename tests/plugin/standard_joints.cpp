// The standard joints: coordinates as the scene language documents them, motions as the field defines them.
#include <cmath>

#include "fixtures.hpp"
#include "plugin/motion.hpp"

namespace koppel::test {
namespace {

struct Expected {
  std::string type;
  Given given;
  std::vector<std::string> coordinates;
  std::vector<std::pair<int32_t, uint32_t>> motions;  ///< kind and coordinate, in order
};

const std::vector<Expected> expected = {
    {"revolute", {}, {"angle"}, {{KOPPEL_MOTION_ROTATION, 0}}},
    {"prismatic", {}, {"displacement"}, {{KOPPEL_MOTION_TRANSLATION, 0}}},
    {"helical", {{"pitch", {0.01}}}, {"angle"}, {{KOPPEL_MOTION_SCREW, 0}}},
    {"cylindrical", {}, {"angle", "displacement"}, {{KOPPEL_MOTION_ROTATION, 0}, {KOPPEL_MOTION_TRANSLATION, 1}}},
    {"universal", {}, {"angle1", "angle2"}, {{KOPPEL_MOTION_ROTATION, 0}, {KOPPEL_MOTION_ROTATION, 1}}},
    {"spherical", {}, {"rotation"}, {{KOPPEL_MOTION_FREE_ROTATION, 0}}},
    {"planar",
     {},
     {"x", "y", "angle"},
     {{KOPPEL_MOTION_TRANSLATION, 0}, {KOPPEL_MOTION_TRANSLATION, 1}, {KOPPEL_MOTION_ROTATION, 2}}},
    {"free",
     {},
     {"rotation", "x", "y", "z"},
     {{KOPPEL_MOTION_TRANSLATION, 1},
      {KOPPEL_MOTION_TRANSLATION, 2},
      {KOPPEL_MOTION_TRANSLATION, 3},
      {KOPPEL_MOTION_FREE_ROTATION, 0}}},
    {"weld", {}, {}, {}},
};

/// The standard joint and the stranger's that moves as it does are held against the same table.
void expect_joint(Registry& registry, const std::string& name, const Expected& wanted) {
  SCOPED_TRACE(name);
  const JointType* type = expect_value(registry.joint(name, {}));
  ASSERT_EQ(type->blocks.size(), wanted.coordinates.size());
  for (std::size_t i = 0; i < type->blocks.size(); ++i) EXPECT_EQ(type->blocks[i].name, wanted.coordinates[i]);
  ASSERT_TRUE(type->is_product());
  const Instance instance = expect_value(create(*type, wanted.given));
  const auto motions = expect_value(joint_motions(*type, instance));
  ASSERT_EQ(motions.size(), wanted.motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    EXPECT_EQ(motions[i].kind, wanted.motions[i].first);
    EXPECT_EQ(motions[i].coordinate, wanted.motions[i].second);
  }
}

TEST(StandardJoints, MoveAsTheFieldDefinesThem) {
  Registry registry(linked_in());
  for (const Expected& wanted : expected) expect_joint(registry, wanted.type, wanted);
}

TEST(StandardJoints, MoveTheSameAsSharedObjects) {
  Registry registry(as_shared_objects());
  for (const Expected& wanted : expected) expect_joint(registry, wanted.type, wanted);
}

TEST(StandardJoints, AreNotSpecial) {
  Registry registry(with_strangers());
  for (const Expected& wanted : expected) expect_joint(registry, "acme." + wanted.type, wanted);
}

koppel_motion motion_of(const std::string& type, std::size_t index, const Given& given = {}) {
  Registry registry(linked_in());
  const JointType* joint = expect_value(registry.joint(type, {}));
  const Instance instance = expect_value(create(*joint, given));
  return expect_value(joint_motions(*joint, instance)).at(index);
}

void expect_axis(const koppel_motion& motion, double x, double y, double z) {
  EXPECT_EQ(motion.axis[0], x);
  EXPECT_EQ(motion.axis[1], y);
  EXPECT_EQ(motion.axis[2], z);
}

TEST(StandardJoints, HaveTheirAxisAlongZ) {
  for (const char* type : {"revolute", "prismatic", "cylindrical", "universal"})
    expect_axis(motion_of(type, 0), 0, 0, 1);
  expect_axis(motion_of("helical", 0, {{"pitch", {0.01}}}), 0, 0, 1);
  expect_axis(motion_of("cylindrical", 1), 0, 0, 1);
  expect_axis(motion_of("planar", 2), 0, 0, 1);
}

TEST(StandardJoints, TranslateAlongInletAxes) {
  for (const char* type : {"planar", "free"}) {
    expect_axis(motion_of(type, 0), 1, 0, 0);
    expect_axis(motion_of(type, 1), 0, 1, 0);
  }
  expect_axis(motion_of("free", 2), 0, 0, 1);
}

TEST(StandardJoints, HelicalAdvancesByItsPitch) {
  EXPECT_EQ(motion_of("helical", 0, {{"pitch", {-0.02}}}).pitch, -0.02);
}

TEST(StandardJoints, UniversalTurnsAboutItsSecondAxis) {
  expect_axis(motion_of("universal", 1), 1, 0, 0);
  expect_axis(motion_of("universal", 1, {{"axis2", {0, 0.6, 0.8}}}), 0, 0.6, 0.8);
}

TEST(StandardJoints, UniversalRefusesParallelAxes) {
  Registry registry(linked_in());
  const JointType* type = expect_value(registry.joint("universal", {}));
  for (const double z : {1.0, -1.0}) {
    const auto instance = create(*type, {{"axis2", {0.5e-6, 0, z}}});
    ASSERT_FALSE(instance);
    EXPECT_EQ(instance.error().code, Code::instance_refused);
    expect_mentions(instance.error(), {"universal", "axis2", "parallel"});
  }
  EXPECT_TRUE(create(*type, {{"axis2", {2e-6, 0, 1}}}));
}

TEST(StandardJoints, CountTheirNumbers) {
  Registry registry(linked_in());
  const JointType* free = expect_value(registry.joint("free", {}));
  EXPECT_EQ(free->nq(), 7u);
  EXPECT_EQ(free->nv(), 6u);
  const JointType* weld = expect_value(registry.joint("weld", {}));
  EXPECT_EQ(weld->nq(), 0u);
  EXPECT_TRUE(weld->is_product());
}

TEST(JointMotions, AreNormalisedWhereTheirLengthIsOneToRounding) {
  const double slightly = 1 + 0.9e-9;
  const koppel_motion motion = motion_of("universal", 1, {{"axis2", {slightly, 0, 0}}});
  EXPECT_EQ(motion.axis[0], 1.0);
}

}  // namespace
}  // namespace koppel::test

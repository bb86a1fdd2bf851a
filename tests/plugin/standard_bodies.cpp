// The standard bodies: mass, centre and inertia about the body frame's origin.
#include <array>

#include "fixtures.hpp"

namespace koppel::test {
namespace {

koppel_inertia inertia_of(const std::string& name, const Given& given) {
  Registry registry(linked_in());
  const BodyType* type = expect_value(registry.body(name, {}));
  const Instance instance = expect_value(create(*type, given));
  const void* pointer = instance.get();
  koppel_inertia out{};
  out.struct_size = sizeof out;
  EXPECT_EQ(type->calls.inertia(1, &pointer, &out), KOPPEL_OK);
  return out;
}

void expect_about_origin(const koppel_inertia& inertia, const std::array<double, 6>& expected) {
  for (std::size_t i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(inertia.about_origin[i], expected[i]) << "entry " << i;
}

TEST(RigidBody, HasNoMassUnlessGiven) {
  const koppel_inertia inertia = inertia_of("rigid", {});
  EXPECT_EQ(inertia.mass, 0.0);
  expect_about_origin(inertia, {0, 0, 0, 0, 0, 0});
}

TEST(RigidBody, MovesItsInertiaToTheOrigin) {
  // 2 kg at (1, 2, 3): m(y^2+z^2) = 26, m(x^2+z^2) = 20, m(x^2+y^2) = 10, -mxy = -4, -mxz = -6, -myz = -12.
  const koppel_inertia inertia =
      inertia_of("rigid", {{"mass", {2}}, {"centre_of_mass", {1, 2, 3}}, {"inertia", {4, 5, 6, 0.25, 0.5, 0.75}}});
  EXPECT_EQ(inertia.mass, 2.0);
  EXPECT_EQ(inertia.centre_of_mass[2], 3.0);
  expect_about_origin(inertia, {30, 25, 16, -3.75, -5.5, -11.25});
}

TEST(RigidBody, RefusesAnInertiaThatNoBodyHas) {
  Registry registry(linked_in());
  const BodyType* type = expect_value(registry.body("rigid", {}));
  // Breaks the triangle inequality, is negative, has products that are too large.
  for (const std::vector<double>& impossible :
       {std::vector<double>{1, 1, 2.1, 0, 0, 0}, {-1, -1, -1, 0, 0, 0}, {1, 1, 1, 0.6, 0, 0}}) {
    const auto instance = create(*type, {{"mass", {1}}, {"inertia", impossible}});
    ASSERT_FALSE(instance);
    expect_mentions(instance.error(), {"rigid", "inertia", "no distribution of mass"});
  }
}

TEST(RigidBody, AcceptsALaminaAndAThinRod) {
  EXPECT_EQ(inertia_of("rigid", {{"mass", {1}}, {"inertia", {1, 1, 2, 0, 0, 0}}}).about_origin[2], 2.0);
  EXPECT_EQ(inertia_of("rigid", {{"mass", {1}}, {"inertia", {1, 1, 0, 0, 0, 0}}}).about_origin[2], 0.0);
}

TEST(PointMass, TurnsAboutTheOriginOnAnArm) {
  const koppel_inertia inertia = inertia_of("point_mass", {{"mass", {2}}, {"at", {1, 2, 3}}});
  EXPECT_EQ(inertia.mass, 2.0);
  EXPECT_EQ(inertia.centre_of_mass[0], 1.0);
  expect_about_origin(inertia, {26, 20, 10, -4, -6, -12});
}

TEST(Bodies, DoNotAcceptNegativeMass) {
  Registry registry(linked_in());
  for (const char* name : {"rigid", "point_mass"}) {
    EXPECT_EQ(expect_value(registry.body(name, {}))->parameters.front().minimum, 0.0);
  }
}

}  // namespace
}  // namespace koppel::test

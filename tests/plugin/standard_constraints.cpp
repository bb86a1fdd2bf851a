// The standard constraints: residuals by hand, first and second derivatives against differences along constant twists.
#include <limits>
#include <random>

#include "curve.hpp"
#include "fixtures.hpp"

namespace koppel::test {
namespace {

/// One instance of a constraint with the library that holds it.
struct Subject {
  Registry registry{linked_in()};
  const ConstraintType* type;
  Instance instance;

  Subject(const std::string& name, const Given& given)
      : type(expect_value(registry.constraint(name, {}))), instance(expect_value(create(*type, given))) {}

  double residual(const koppel_configuration& at) const {
    const void* pointer = instance.get();
    double out = 0;
    EXPECT_EQ(type->calls.residual(1, &pointer, &at, &out), KOPPEL_OK);
    return out;
  }
  double second_order(const koppel_configuration& at) const {
    const void* pointer = instance.get();
    double out = 0;
    EXPECT_EQ(type->calls.second_order(1, &pointer, &at, &out), KOPPEL_OK);
    return out;
  }
};

koppel_configuration at_pose(const PoseNumbers& pose, const double* twist = nullptr) {
  koppel_configuration at{};
  at.struct_size = sizeof at;
  at.pose = pose.data();
  at.twist = twist;
  return at;
}

Vector6 row_by_twist(const Subject& subject, const PoseNumbers& pose) {
  const void* pointer = subject.instance.get();
  const koppel_configuration at = at_pose(pose);
  Vector6 row;
  EXPECT_EQ(subject.type->calls.jacobian(1, &pointer, &at, row.data(), nullptr), KOPPEL_OK);
  return row;
}

class DistanceConstraint : public testing::Test {
 protected:
  const Subject rod{"distance", {{"distance", {0.75}}}};
  std::mt19937 random{7};

  Vector3 random_vector() {
    std::uniform_real_distribution<double> uniform(-1, 1);
    return {uniform(random), uniform(random), uniform(random)};
  }
  /// Origins about 1 m apart, so that the difference formulas' length is about 1.
  Pose random_pose() {
    const Vector3 axis = random_vector().normalized();
    return {rotation_about<double>(axis, 3 * random_vector().x()), random_vector().normalized()};
  }
  Vector6 random_twist() {
    Vector6 twist;
    twist << random_vector(), 0.5 * random_vector();
    return twist;
  }
};

TEST_F(DistanceConstraint, IsHowMuchTheOriginsAreTooFarApart) {
  const PoseNumbers pose = numbers_of({Matrix3::Identity(), {3, 4, 12}});
  EXPECT_DOUBLE_EQ(rod.residual(at_pose(pose)), 13 - 0.75);
}

// Differences in steps of 0.01 on a function of scale 1 and rates up to 2: truncation below 1e-11, rounding (a few eps
// over h, over h^2 for second derivatives) below 1e-13 and 1e-11.
TEST_F(DistanceConstraint, DerivativesAreThoseAlongATwist) {
  for (int trial = 0; trial < 100; ++trial) {
    const Pose pose = random_pose();
    const Vector6 twist = random_twist();
    const auto r = [&](double t) { return rod.residual(at_pose(numbers_of(along_twist(pose, twist, t)))); };
    const PoseNumbers now = numbers_of(pose);
    EXPECT_NEAR(row_by_twist(rod, now).dot(twist), derivative(r), 1e-10);
    EXPECT_NEAR(rod.second_order(at_pose(now, twist.data())), second_derivative(r), 1e-9);
  }
}

TEST_F(DistanceConstraint, HasADirectionEvenWhereThePointsCoincide) {
  const PoseNumbers pose = numbers_of({rotation_about<double>(Vector3::UnitZ(), 0.5), Vector3::Zero()});
  const Vector6 row = row_by_twist(rod, pose);
  EXPECT_DOUBLE_EQ(row.norm(), 1.0);
  EXPECT_DOUBLE_EQ(row[3], std::cos(0.5));  // x of the first frame in the axes of the second
  EXPECT_DOUBLE_EQ(row[4], -std::sin(0.5));
  const Vector6 twist = random_twist();
  EXPECT_TRUE(std::isfinite(rod.second_order(at_pose(pose, twist.data()))));
}

TEST_F(DistanceConstraint, RefusesZero) {
  const auto instance = create(*rod.type, {{"distance", {0}}});
  ASSERT_FALSE(instance);
  EXPECT_EQ(instance.error().code, Code::instance_refused);
  expect_mentions(instance.error(), {"distance", "greater than zero", "spherical"});
}

TEST_F(DistanceConstraint, IsMeasuredInMetres) {
  ASSERT_EQ(rod.type->rows.size(), 1u);
  EXPECT_EQ(rod.type->rows[0].unit, "m");
}

TEST(CouplingConstraint, IsTheWeightedSumMinusTheOffset) {
  const Subject gears("coupling", {{"coordinates", {0, 0}}, {"factors", {2, -3}}, {"offset", {0.5}}});
  const double q[] = {5, 7};
  koppel_configuration at{};
  at.struct_size = sizeof at;
  at.q = q;
  at.v = q;
  at.coordinates = 2;
  EXPECT_DOUBLE_EQ(gears.residual(at), 2 * 5 - 3 * 7 - 0.5);
  EXPECT_EQ(gears.second_order(at), 0.0);
  const void* pointer = gears.instance.get();
  double by_rate[2] = {};
  ASSERT_EQ(gears.type->calls.jacobian(1, &pointer, &at, nullptr, by_rate), KOPPEL_OK);
  EXPECT_EQ(by_rate[0], 2.0);
  EXPECT_EQ(by_rate[1], -3.0);
}

TEST(CouplingConstraint, TakesABatch) {
  const Subject gears("coupling", {{"coordinates", {0, 0}}, {"factors", {1, 1}}});
  const void* pointers[] = {gears.instance.get(), gears.instance.get()};
  const double q[] = {1, 2, 3, 4};
  koppel_configuration at{};
  at.struct_size = sizeof at;
  at.q = q;
  at.coordinates = 2;
  double r[2] = {};
  ASSERT_EQ(gears.type->calls.residual(2, pointers, &at, r), KOPPEL_OK);
  EXPECT_EQ(r[0], 3.0);
  EXPECT_EQ(r[1], 7.0);
}

TEST(CouplingConstraint, NeedsAFactorForEachCoordinate) {
  Registry registry(linked_in());
  const ConstraintType* type = expect_value(registry.constraint("coupling", {}));
  const auto too_few = create(*type, {{"coordinates", {0, 0}}, {"factors", {1}}});
  ASSERT_FALSE(too_few);
  expect_mentions(too_few.error(), {"coupling", "factors", "one factor for each coordinate"});
  const auto zero = create(*type, {{"coordinates", {0}}, {"factors", {0}}});
  ASSERT_FALSE(zero);
  expect_mentions(zero.error(), {"factors", "all zero"});
}

}  // namespace
}  // namespace koppel::test

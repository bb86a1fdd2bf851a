// The standard forces: their power against the rate of their energy and what they dissipate, along random motions, and
// by hand where they store nothing; kinks, ends of tables, refusals.
#include <random>

#include "curve.hpp"
#include "fixtures.hpp"

namespace koppel::test {
namespace {

/// Where one instance stands, as numbers that live as long as they are asked for.
struct Point {
  PoseNumbers pose{};
  Vector6 twist = Vector6::Zero();
  std::vector<double> q, v;
  double time = 0.0;
};

struct Answer {
  Vector6 wrench = Vector6::Zero();
  double effort = 0.0, state_rate = 0.0;
};

/// One instance of a force with the library that holds it.
struct Subject {
  Registry registry{linked_in()};
  const ForceType* type;
  Instance instance;
  const void* pointer;

  Subject(const std::string& name, const Given& given)
      : type(expect_value(registry.force(name, {}))),
        instance(expect_value(create(*type, given))),
        pointer(instance.get()) {}

  static koppel_configuration configuration(const Point& at, bool moving) {
    koppel_configuration out{};
    out.struct_size = sizeof out;
    out.time = at.time;
    out.pose = at.pose.data();
    out.q = at.q.data();
    out.coordinates = at.q.size();
    if (moving) out.twist = at.twist.data();
    if (moving) out.v = at.v.data();
    return out;
  }
  Answer act(const Point& at, double state = 0.0) const {
    Answer out;
    const koppel_configuration here = configuration(at, true);
    EXPECT_EQ(type->calls.evaluate(1, &pointer, &here, &state, out.wrench.data(), &out.effort, &out.state_rate),
              KOPPEL_OK);
    return out;
  }
  double energy(const Point& at) const {
    const koppel_configuration here = configuration(at, false);
    double out = std::nan("");
    EXPECT_EQ(type->calls.energy(1, &pointer, &here, nullptr, &out), KOPPEL_OK);
    return out;
  }
  double dissipation(const Point& at) const {
    const koppel_configuration here = configuration(at, true);
    double out = std::nan("");
    EXPECT_EQ(type->calls.dissipation(1, &pointer, &here, nullptr, &out), KOPPEL_OK);
    return out;
  }
  std::vector<double> switches(const Point& at, double state = 0.0) const {
    const koppel_configuration here = configuration(at, true);
    std::vector<double> out(type->calls.switch_count, std::nan(""));
    EXPECT_EQ(type->calls.switches(1, &pointer, &here, &state, out.data()), KOPPEL_OK);
    return out;
  }
};

Point on_coordinate(double q, double v = 0.0, double time = 0.0) {
  Point out;
  out.q = {q};
  out.v = {v};
  out.time = time;
  return out;
}

Point at_pose(const Pose& pose, const Vector6& twist = Vector6::Zero()) {
  Point out;
  out.pose = numbers_of(pose);
  out.twist = twist;
  return out;
}

/// A symmetric positive semidefinite matrix of rank 6, all entries different, as a table's numbers.
std::vector<double> full_matrix(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Matrix6 root;
  for (double& entry : root.reshaped()) entry = uniform(random);
  const Matrix6 product = root * root.transpose();
  const Matrix6 matrix = (product + product.transpose()) / 2;
  return {matrix.data(), matrix.data() + 36};
}

struct Store {
  std::string name, type;
  Given given;
  std::vector<double> corners;  ///< stretches at which the third derivative of the energy jumps
};
void PrintTo(const Store& store, std::ostream* out) { *out << store.name; }
std::string name_of(const testing::TestParamInfo<Store>& info) { return info.param.name; }

const std::vector<double> progressive = {-0.4, -1.5, -0.1, -0.2, 0, 0, 0.2, 0.1, 0.5, 2.5};
const std::vector<double> its_corners = {-0.4, -0.1, 0, 0.2, 0.5};

// ------------------------------------------------------------------------------------- between two frames

class BetweenFrames : public testing::TestWithParam<Store> {
 protected:
  std::mt19937 random{11};

  Vector3 random_vector() {
    std::uniform_real_distribution<double> uniform(-1, 1);
    return {uniform(random), uniform(random), uniform(random)};
  }
  /// Origins about 1 m apart, turned by up to 2.2 rad: over steps of 0.01 everything changes slowly.
  Pose random_pose() {
    return {rotation_about<double>(random_vector().normalized(), 2.2 * random_vector().x()),
            (1 + 0.4 * random_vector().x()) * random_vector().normalized()};
  }
  Vector6 random_twist() {
    Vector6 twist;
    twist << random_vector(), 0.5 * random_vector();
    return twist;
  }
  bool is_near_corner(const Pose& pose) const {
    const double stretch = pose.position.norm() - 0.9;
    return std::any_of(GetParam().corners.begin(), GetParam().corners.end(),
                       [&](double corner) { return std::abs(stretch - corner) < 0.03; });
  }
};

INSTANTIATE_TEST_SUITE_P(
    Of, BetweenFrames,
    testing::Values(Store{"spring", "spring", {{"stiffness", {3}}, {"length", {0.9}}}, {}},
                    Store{"preloaded", "spring", {{"stiffness", {3}}, {"preload", {-2}}, {"length", {0.9}}}, {}},
                    Store{"damper", "spring", {{"damping", {0.7}}}, {}},
                    Store{"spring_and_damper", "spring", {{"stiffness", {3}}, {"damping", {0.7}}}, {}},
                    Store{"spring_by_table", "spring", {{"table", progressive}, {"length", {0.9}}}, its_corners},
                    Store{"bushing",
                          "bushing",
                          {{"stiffness", {1, 2, 3}},
                           {"rotational_stiffness", {0.5, 0.7, 1.1}},
                           {"damping", {0.1, 0.4, 0.2}},
                           {"rotational_damping", {0.3, 0.2, 0.6}}},
                          {}},
                    Store{"bushing_by_matrix",
                          "bushing",
                          {{"stiffness_matrix", full_matrix(1)}, {"damping_matrix", full_matrix(2)}},
                          {}}),
    name_of);

// The distance of the origins, 0.6 m at least, changes at 0.87 m/s at most: the seventh derivative of an energy E is
// about 7! E / 0.7^7, and the sixth-order formula with steps of 3 ms leaves h^6/140 of it, 3e-13 E. Rounding leaves eps
// E / h, 1e-13 E. Energies along the way are up to ten times those at its middle, or 1 J.
TEST_P(BetweenFrames, PowerIsWhatTheEnergyLosesAndNothingElse) {
  const Subject force(GetParam().type, GetParam().given);
  int checked = 0;
  while (checked < 200) {
    const Pose pose = random_pose();
    if (is_near_corner(pose)) continue;
    ++checked;
    const Vector6 twist = random_twist();
    const Point now = at_pose(pose, twist);
    const double gain = derivative([&](double t) { return force.energy(at_pose(along_twist(pose, twist, t))); }, 3e-3);
    const double lost = force.dissipation(now);
    EXPECT_GE(lost, 0.0);
    EXPECT_NEAR(force.act(now).wrench.dot(twist), -gain - lost, 1e-11 * (1 + force.energy(now)));
  }
}

TEST_P(BetweenFrames, ABatchIsOneAfterAnother) {
  const Subject force(GetParam().type, GetParam().given);
  const Point points[] = {at_pose(random_pose(), random_twist()), at_pose(random_pose(), random_twist())};
  const void* pointers[] = {force.pointer, force.pointer};
  std::array<double, 24> poses{};
  std::array<double, 12> twists{}, wrenches{};
  for (std::size_t i = 0; i < 2; ++i) {
    std::copy(points[i].pose.begin(), points[i].pose.end(), poses.begin() + 12 * static_cast<std::ptrdiff_t>(i));
    Eigen::Map<Vector6>(twists.data() + 6 * i) = points[i].twist;
  }
  koppel_configuration at{};
  at.struct_size = sizeof at;
  at.pose = poses.data();
  at.twist = twists.data();
  ASSERT_EQ(force.type->calls.evaluate(2, pointers, &at, nullptr, wrenches.data(), nullptr, nullptr), KOPPEL_OK);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(Eigen::Map<Vector6>(wrenches.data() + 6 * i), force.act(points[i]).wrench);
  }
}

TEST(Spring, PullsAlongTheLineWhenItIsLong) {
  const Subject spring("spring", {{"stiffness", {10}}, {"length", {4}}, {"damping", {2}}});
  // 5 m long, 1 m stretched; the second frame is turned by a quarter about z, and moves away at 3 m/s along the line.
  const Pose pose{rotation_about<double>(Vector3::UnitZ(), std::acos(0.0)), {3, 0, 4}};
  Vector6 twist;
  twist << 7, 8, 9, pose.rotation.transpose() * Vector3(1.8, 0, 2.4);
  const Vector6 wrench = spring.act(at_pose(pose, twist)).wrench;
  EXPECT_EQ(Vector3(wrench.head<3>()), Vector3::Zero());
  EXPECT_LT((pose.rotation * wrench.tail<3>() - Vector3(-9.6, 0, -12.8)).norm(), 1e-14 * 16);
}

TEST(Spring, HasNoDirectionWhereItsEndsMeet) {
  const Subject spring("spring", {{"stiffness", {10}}, {"length", {0.1}}, {"damping", {1}}});
  Vector6 twist;
  twist << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(spring.act(at_pose({}, twist)).wrench, Vector6::Zero());
  EXPECT_DOUBLE_EQ(spring.energy(at_pose({})), 0.05);
}

TEST(Bushing, IsLinearInTheRotationVector) {
  const Subject bushing("bushing", {{"rotational_stiffness", {2, 3, 5}}, {"stiffness", {7, 11, 13}}});
  const Vector3 axis = Vector3(1, -2, 2) / 3;
  // Unequal stiffness turns the moment away from the axis; the energy is half the sum of stiffness times angle squared.
  for (const double angle : {1e-9, 0.05, 0.1, 0.3, 1.0, 2.0, 3.0, 3.14159}) {
    const Vector3 phi = angle * axis;
    const double expected = (2 * phi.x() * phi.x() + 3 * phi.y() * phi.y() + 5 * phi.z() * phi.z()) / 2;
    // The angle itself is known to an epsilon from a matrix of rounded entries, whatever its size.
    EXPECT_NEAR(bushing.energy(at_pose({rotation_about<double>(axis, angle), Vector3::Zero()})), expected,
                2e-15 * 5 * angle);
  }
  const Vector6 wrench = bushing.act(at_pose({Matrix3::Identity(), {1, 2, 3}})).wrench;
  EXPECT_EQ(wrench, (Vector6() << 0, 0, 0, -7, -22, -39).finished());
}

TEST(Bushing, TurnsBackAtEveryAngle) {
  const Subject bushing("bushing", {{"rotational_stiffness", {2, 2, 2}}});
  std::mt19937 random{5};
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double angle : {1e-12, 1e-4, 0.09, 0.11, 1.0, 1.6, 2.5, 3.1, 3.1415926}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Vector3 axis = Vector3(uniform(random), uniform(random), uniform(random)).normalized();
      const Vector6 wrench = bushing.act(at_pose({rotation_about<double>(axis, angle), Vector3::Zero()})).wrench;
      // The entries of the matrix are rounded, to 1e-16 each; at half a turn an angle is lost by as much as that over
      // the rotation vector's length.
      EXPECT_LT((wrench.head<3>() + 2 * angle * axis).norm(), 4e-15);
    }
  }
}

TEST(Bushing, RefusesMatricesThatAreNoEnergies) {
  Registry registry(linked_in());
  const ForceType* type = expect_value(registry.force("bushing", {}));
  std::vector<double> crooked = full_matrix(3), negative = full_matrix(3), hollow(36, 0.0);
  crooked[1] += 1;
  negative[35] = -negative[35];
  hollow[1] = hollow[6] = 1;
  for (const auto& [matrix, reason] :
       {std::pair(crooked, "not symmetric"), {negative, "negative"}, {hollow, "negative"}}) {
    const auto refused = create(*type, {{"damping_matrix", matrix}});
    ASSERT_FALSE(refused);
    expect_mentions(refused.error(), {"damping_matrix", reason});
  }
  const auto both = create(*type, {{"stiffness", {1, 1, 1}}, {"stiffness_matrix", full_matrix(3)}});
  ASSERT_FALSE(both);
  expect_mentions(both.error(), {"stiffness_matrix", "single axes"});
  std::vector<double> singular(36, 1.0);
  EXPECT_TRUE(create(*type, {{"damping_matrix", singular}}));
  EXPECT_TRUE(create(*type, {{"damping_matrix", std::vector<double>(36, 0.0)}}));
}

// ----------------------------------------------------------------------------------------- on a coordinate

class OnACoordinate : public testing::TestWithParam<Store> {};

INSTANTIATE_TEST_SUITE_P(
    Of, OnACoordinate,
    testing::Values(
        Store{"coordinate_spring", "coordinate_spring", {{"stiffness", {3}}, {"damping", {0.7}}, {"free", {0.2}}}, {}},
        Store{"coordinate_spring_by_table", "coordinate_spring", {{"table", progressive}}, its_corners},
        Store{
            "stop", "stop", {{"lower", {-0.4}}, {"upper", {0.5}}, {"stiffness", {8}}, {"damping", {0.6}}}, {-0.4, 0.5}},
        Store{"lower_stop", "stop", {{"lower", {-0.4}}, {"stiffness", {8}}}, {-0.4}},
        Store{"friction", "friction", {{"coulomb", {2}}, {"viscous", {0.3}}, {"speed", {0.1}}}, {}}),
    name_of);

TEST_P(OnACoordinate, PowerIsWhatTheEnergyLosesAndNothingElse) {
  const Subject force(GetParam().type, GetParam().given);
  std::mt19937 random{3};
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const double q = uniform(random), v = 3 * uniform(random);
    const auto& corners = GetParam().corners;
    if (std::any_of(corners.begin(), corners.end(), [q](double corner) { return std::abs(q - corner) < 0.031; })) {
      continue;
    }
    const Point now = on_coordinate(q, v);
    // The energies are polynomials of fourth degree at most: the formula is exact but for rounding, of energies up to
    // 5 J over a step of 0.01.
    const double slope = derivative([&](double d) { return force.energy(on_coordinate(q + d)); });
    const double lost = force.dissipation(now);
    EXPECT_GE(lost, 0.0);
    EXPECT_NEAR(force.act(now).effort * v, -slope * v - lost, 1e-12 * (1 + std::abs(v)));
  }
}

TEST(CoordinateSpring, FollowsItsTable) {
  const Subject spring("coordinate_spring", {{"table", progressive}, {"free", {0.25}}});
  for (std::size_t i = 0; i < progressive.size(); i += 2) {
    EXPECT_NEAR(spring.act(on_coordinate(0.25 + progressive[i])).effort, -progressive[i + 1], 1e-15);
  }
  // Between points it rises wherever they do.
  double last = spring.act(on_coordinate(-0.5)).effort;
  for (int i = 1; i <= 1300; ++i) {
    const double now = spring.act(on_coordinate(-0.5 + 1e-3 * i)).effort;
    EXPECT_LE(now, last);
    last = now;
  }
  // Beyond the last point straight on, with the slope of the outermost chord: 2.4 in 0.3.
  EXPECT_NEAR(spring.act(on_coordinate(0.25 + 0.5 + 1)).effort, -(2.5 + 8), 1e-13);
  EXPECT_NEAR(spring.energy(on_coordinate(0.25)), 0.0, 1e-16);
}

TEST(CoordinateSpring, TakesOnlyOrderedTables) {
  Registry registry(linked_in());
  for (const char* name : {"spring", "coordinate_spring"}) {
    const auto refused = create(*expect_value(registry.force(name, {})), {{"table", {0, 0, 1, 2, 1, 3}}});
    ASSERT_FALSE(refused);
    expect_mentions(refused.error(), {"table", "does not increase"});
  }
}

TEST(Stop, PushesAndNeverHolds) {
  const Subject stop("stop", {{"lower", {1}}, {"upper", {2}}, {"stiffness", {100}}, {"damping", {0.5}}});
  for (const double v : {-10.0, 0.0, 10.0}) {
    EXPECT_EQ(stop.act(on_coordinate(1.5, v)).effort, 0.0);
    // It begins at zero, however fast the stop is met.
    EXPECT_EQ(stop.act(on_coordinate(1, v)).effort, 0.0);
    EXPECT_EQ(stop.act(on_coordinate(2, v)).effort, 0.0);
    EXPECT_GE(stop.act(on_coordinate(0.9, v)).effort, 0.0);
    EXPECT_LE(stop.act(on_coordinate(2.1, v)).effort, 0.0);
  }
  EXPECT_DOUBLE_EQ(stop.act(on_coordinate(0.9, -2)).effort, 100 * (1 - 0.9) * 2);
  EXPECT_DOUBLE_EQ(stop.act(on_coordinate(2.25, 2)).effort, -100 * 0.25 * 2);
  EXPECT_EQ(stop.act(on_coordinate(0.9, 2)).effort, 0.0);  // it draws back as fast as the stop can follow
}

TEST(Stop, TellsWhereItIsMet) {
  const Subject stop("stop", {{"lower", {1}}, {"upper", {2}}, {"stiffness", {100}}});
  EXPECT_EQ(stop.switches(on_coordinate(1.25)), (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(stop.switches(on_coordinate(0.5)), (std::vector<double>{-0.5, 1.5}));
  const Subject upper("stop", {{"upper", {2}}, {"stiffness", {100}}});
  EXPECT_GT(upper.switches(on_coordinate(-1e6))[0], 0.0);
}

TEST(Stop, MustStandSomewhere) {
  Registry registry(linked_in());
  const ForceType* type = expect_value(registry.force("stop", {}));
  const auto nowhere = create(*type, {{"stiffness", {1}}});
  ASSERT_FALSE(nowhere);
  expect_mentions(nowhere.error(), {"lower", "upper"});
  const auto swapped = create(*type, {{"stiffness", {1}}, {"lower", {2}}, {"upper", {1}}});
  ASSERT_FALSE(swapped);
  expect_mentions(swapped.error(), {"lower", "above"});
}

TEST(Friction, OpposesMotionAndIsSmoothAtRest) {
  const Subject friction("friction", {{"coulomb", {3}}, {"viscous", {2}}, {"speed", {0.01}}});
  EXPECT_EQ(friction.act(on_coordinate(0, 0)).effort, 0.0);
  EXPECT_DOUBLE_EQ(friction.act(on_coordinate(0, 0.01)).effort, -3 * std::tanh(1.0) - 0.02);
  // Beyond 20 times the speed of regularisation the hyperbolic tangent is one.
  EXPECT_DOUBLE_EQ(friction.act(on_coordinate(0, 5)).effort, -3 - 10);
  EXPECT_DOUBLE_EQ(friction.act(on_coordinate(0, -5)).effort, 3 + 10);
  EXPECT_DOUBLE_EQ(friction.dissipation(on_coordinate(0, -5)), 65);
}

TEST(Friction, NeedsASpeedWhereItIsDry) {
  Registry registry(linked_in());
  const ForceType* type = expect_value(registry.force("friction", {}));
  EXPECT_TRUE(create(*type, {{"viscous", {1}}}));
  for (const Given& given : {Given{{"coulomb", {1}}}, Given{{"coulomb", {1}}, {"speed", {0}}}}) {
    const auto refused = create(*type, given);
    ASSERT_FALSE(refused);
    expect_mentions(refused.error(), {"speed", "greater than zero"});
  }
}

// -------------------------------------------------------------------------------------- work from outside

TEST(Motor, AddsUpWhatItIsTold) {
  const Subject motor("motor", {{"effort", {2}}, {"by_time", {0, 0, 2, 4}}, {"by_speed", {0, 10, 5, 0}}});
  EXPECT_EQ(motor.type->calls.energy, nullptr);
  EXPECT_DOUBLE_EQ(motor.act(on_coordinate(7, 0, 0)).effort, 2 + 0 + 10);
  EXPECT_DOUBLE_EQ(motor.act(on_coordinate(7, 2.5, 1)).effort, 2 + 2 + 5);
}

TEST(Controller, SumsErrorIntegralAndRate) {
  const Subject pid("controller",
                    {{"setpoint", {2}}, {"proportional", {10}}, {"integral", {3}}, {"derivative", {0.5}}});
  ASSERT_EQ(pid.type->states.size(), 1u);
  EXPECT_EQ(pid.type->states[0].name, "integral");
  const Answer answer = pid.act(on_coordinate(0.5, -4), 7);
  EXPECT_DOUBLE_EQ(answer.effort, 10 * 1.5 + 3 * 7 + 0.5 * 4);
  EXPECT_DOUBLE_EQ(answer.state_rate, 1.5);
}

TEST(Controller, FollowsACourse) {
  const Subject pid("controller", {{"course", {0, 0, 1, 3}}, {"proportional", {10}}, {"derivative", {0.5}}});
  EXPECT_DOUBLE_EQ(pid.act(on_coordinate(1, 2, 0.5)).effort, 10 * 0.5 + 0.5 * 1);
}

TEST(Controller, DoesNotWindUpAtItsLimit) {
  const Subject pid("controller", {{"setpoint", {1}}, {"proportional", {10}}, {"integral", {2}}, {"limit", {4}}});
  const Answer held = pid.act(on_coordinate(0), 0.5);
  EXPECT_EQ(held.effort, 4.0);
  EXPECT_EQ(held.state_rate, 0.0);
  // With the error the other way it unwinds.
  const Answer back = pid.act(on_coordinate(1.1), 20);
  EXPECT_EQ(back.effort, 4.0);
  EXPECT_NEAR(back.state_rate, -0.1, 1e-15);
  EXPECT_EQ(pid.switches(on_coordinate(0), 0.5), (std::vector<double>{-7, 15}));
  const Subject free("controller", {{"setpoint", {1}}, {"proportional", {10}}});
  EXPECT_EQ(free.switches(on_coordinate(-1e9)), (std::vector<double>{1, 1}));
}

TEST(Controller, NeedsOneSetpoint) {
  Registry registry(linked_in());
  const ForceType* type = expect_value(registry.force("controller", {}));
  const auto none = create(*type, {});
  ASSERT_FALSE(none);
  expect_mentions(none.error(), {"setpoint", "course"});
  const auto both = create(*type, {{"setpoint", {1}}, {"course", {0, 0, 1, 1}}});
  ASSERT_FALSE(both);
  expect_mentions(both.error(), {"course", "keep one"});
}

/// A wrench with a text among its values.
struct Load {
  Registry registry{linked_in()};
  const ForceType* type = expect_value(registry.force("wrench", {}));

  Result<Instance> with(const std::string& axes, bool against, const std::vector<double>& factors = {}) const {
    std::vector<Value> values = values_of(*type, {{"force", {1, 2, 3}}, {"moment", {4, 5, 6}}, {"factors", factors}});
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string& name = type->parameters[i].name;
      if (name == "against") values[i].count = against ? 1 : 0;
      if (name == "axes") values[i].text = axes;
      if (name == "axes") values[i].count = axes.empty() ? 0 : 1;
    }
    return type->create(values);
  }
  Vector6 wrench(const Instance& instance, const Pose& pose, double time = 0.0) const {
    const void* pointer = instance.get();
    Point point = at_pose(pose);
    point.time = time;
    const koppel_configuration at = Subject::configuration(point, true);
    Vector6 out;
    EXPECT_EQ(type->calls.evaluate(1, &pointer, &at, nullptr, out.data(), nullptr, nullptr), KOPPEL_OK);
    return out;
  }
};

TEST(Wrench, KeepsItsDirectionInTheAxesThatItIsTold) {
  const Load load;
  const Pose pose{rotation_about<double>(Vector3(1, 2, 2) / 3, 0.7), {3, 4, 5}};
  const Vector6 given = (Vector6() << 4, 5, 6, 1, 2, 3).finished();
  EXPECT_EQ(load.wrench(expect_value(load.with("frame", false)), pose), given);
  EXPECT_EQ(load.wrench(expect_value(load.with("", true)), pose), given);
  for (const bool against : {false, true}) {
    const Vector6 wrench = load.wrench(expect_value(load.with(against ? "against" : "world", against)), pose);
    EXPECT_LT((pose.rotation * wrench.tail<3>() - Vector3(1, 2, 3)).norm(), 1e-14);
    EXPECT_LT((pose.rotation * wrench.head<3>() - Vector3(4, 5, 6)).norm(), 1e-14);
  }
}

TEST(Wrench, FollowsItsFactors) {
  const Load load;
  const Instance growing = expect_value(load.with("frame", false, {0, 0, 2, 1}));
  const Vector6 given = (Vector6() << 4, 5, 6, 1, 2, 3).finished();
  EXPECT_EQ(load.wrench(growing, {}, 1.0), given / 2);
}

TEST(Wrench, RefusesAxesThatThereAreNot) {
  const Load load;
  for (const auto& [axes, against] : {std::pair("world", true), {"against", false}, {"body", false}}) {
    const auto refused = load.with(axes, against);
    ASSERT_FALSE(refused) << axes;
    expect_mentions(refused.error(), {"axes"});
  }
}

}  // namespace
}  // namespace koppel::test

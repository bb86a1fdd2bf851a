// The freedoms of a mechanism, and the reasons for them: known for the mechanisms of the books.
#include "closure/freedoms.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "closed.hpp"
#include "closure/loop_kind.hpp"
#include "row_of_four_bars.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A scene, closed at its start, with its freedoms there.
struct Explained : Closed {
  explicit Explained(const std::string& text) : Closed(text) {
    EXPECT_GE(close(), 0);
    EXPECT_TRUE(find_freedoms(work, state, freedoms));
  }
  const IndeterminateReaction* indeterminate(const std::string& joint) const {
    for (const auto& reaction : freedoms.indeterminate) {
      if (built->joints[reaction.joint.index()].name == joint) return &reaction;
    }
    return nullptr;
  }
  Freedoms freedoms;
};

std::string text_of(const Vector3& v) {
  std::ostringstream out;
  out.precision(17);
  out << '[' << v.x() << ", " << v.y() << ", " << v.z() << ']';
  return out.str();
}

/// The text without the lines that start with a word.
std::string without_lines(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(start, 0) != 0) kept += line + '\n';
  }
  return kept;
}

/// Links of a chain that closes on the ground, with a joint at each point. `types`: of the joints, which get the axes.
std::string loop(const std::vector<std::string>& types, const std::vector<Vector3>& points,
                 const std::vector<Vector3>& axes) {
  std::string bodies = "[scene]\nlength = 1\n", joints;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const std::string before = i == 0 ? "ground" : "link" + std::to_string(i);
    const std::string after = i + 1 == types.size() ? "ground" : "link" + std::to_string(i + 1);
    if (i > 0) bodies += "[[body]]\nname = '" + before + "'\n";
    joints += "[[joint]]\nname = 'j" + std::to_string(i) + "'\ntype = '" + types[i] + "'\nbetween = ['" + before +
              "', '" + after + "']\nat = " + text_of(points[i]) + "\naxis = " + text_of(axes[i]) + "\n";
  }
  return bodies + joints;
}

/// Four revolutes about the normals of a plane that lies anywhere.
std::string four_bar(const Pose& x, const std::array<double, 4>& along, const std::array<double, 4>& up) {
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < 4; ++i) points.push_back(x * Vector3(along[i], up[i], 0));
  return loop(std::vector<std::string>(4, "revolute"), points, std::vector<Vector3>(4, x.rotation.col(2)));
}

// Checks K-II-1.1.2, K-II-1.3.1, K-II-1.3.2: the table of counts.
TEST(Freedoms, OfTheBooksMechanismsAreCountedRight) {
  struct Known {
    const char* scene;
    int loops, planar, spherical, by_kind, here;
  };
  for (const Known& known :
       {Known{"4bar", 1, 1, 0, 1, 1}, Known{"slidercrank", 1, 1, 0, 1, 1}, Known{"chain", 4, 4, 0, 1, 1},
        Known{"7b10j", 3, 3, 0, 1, 1}, Known{"sar", 3, 3, 0, 2, 2}, Known{"9body", 4, 4, 0, 1, 1},
        Known{"panto", 1, 1, 0, 4, 4}, Known{"sph4", 1, 0, 1, 1, 1}, Known{"cardan", 2, 0, 2, 1, 1},
        Known{"rstr", 1, 0, 0, 1, 1}, Known{"rccc", 1, 0, 0, 1, 1}, Known{"7h", 1, 0, 0, 1, 1},
        Known{"6joint", 1, 0, 0, 3, 3}, Known{"swash", 2, 0, 0, 3, 3}, Known{"dwb", 1, 0, 0, 2, 2},
        Known{"stewart", 5, 0, 0, 6, 6}, Known{"6r", 0, 0, 0, 6, 6}, Known{"5link", 5, 0, 0, 2, 2}}) {
    SCOPED_TRACE(known.scene);
    const Explained scene(shipped(known.scene));
    const Freedoms& f = scene.freedoms;
    const auto of_kind = [&](LoopKind kind) {
      return std::count_if(f.loops.begin(), f.loops.end(), [kind](const auto& l) { return l.kind == kind; });
    };
    EXPECT_EQ(f.loops.size(), static_cast<std::size_t>(known.loops));
    EXPECT_EQ(of_kind(LoopKind::planar), known.planar);
    EXPECT_EQ(of_kind(LoopKind::spherical), known.spherical);
    EXPECT_EQ(f.mobility_by_kind, known.by_kind);
    EXPECT_EQ(f.mobility_here, known.here);
    EXPECT_EQ(f.mobility_nearby, known.here);
    EXPECT_EQ(f.redundant_here, static_cast<std::uint32_t>(3 * (known.planar + known.spherical)));
    EXPECT_EQ(f.redundant_nearby, f.redundant_here);
    EXPECT_FALSE(f.shaky);
  }
}

// The plane may lie anywhere, a kilometre away as well.
TEST(Freedoms, OfAPlanarLoopDoNotDependOnWhereItLies) {
  Random random(1);
  for (int n = 0; n < 20; ++n) {
    const Pose x{random.rotation(), n < 10 ? random.vector() : Vector3(1000 * random.vector())};
    const Explained scene(four_bar(x, {0, 0.1, 0.4, 0.5}, {0, 0.2, 0.3, 0}));
    ASSERT_EQ(scene.freedoms.loops.size(), 1u);
    EXPECT_EQ(scene.freedoms.loops[0].kind, LoopKind::planar);
    EXPECT_NEAR(std::abs(scene.freedoms.loops[0].normal.dot(x.rotation.col(2))), 1, 8 * eps);
    EXPECT_EQ(scene.freedoms.mobility_by_kind, 1);
    EXPECT_EQ(scene.freedoms.mobility_here, 1);
  }
}

// Checks K-II-1.3.1.
TEST(Freedoms, OfBennettsLinkageAreOwedToItsMeasures) {
  const Explained scene(shipped("bennett"));
  EXPECT_EQ(scene.freedoms.loops[0].kind, LoopKind::spatial);
  EXPECT_EQ(scene.freedoms.mobility_by_kind, -2);
  EXPECT_EQ(scene.freedoms.mobility_nearby, 1) << "everywhere, hence no singular position";
  EXPECT_EQ(scene.freedoms.redundant_nearby, 3u);
}

// A parallelogram all in one line may go on as parallelogram or as antiparallelogram.
TEST(Freedoms, AtAChangePointAreMoreThanNearby) {
  const Explained scene(four_bar(Pose{}, {0, 0.1, 0.3, 0.2}, {0, 0, 0, 0}));
  EXPECT_EQ(scene.freedoms.mobility_here, 2);
  EXPECT_EQ(scene.freedoms.mobility_nearby, 1);
  EXPECT_FALSE(scene.freedoms.shaky);
  EXPECT_EQ(scene.freedoms.redundant_here, scene.freedoms.redundant_nearby + 1);
}

// Two links stretched between two fixed points: their joint gives way sideways, but cannot move.
TEST(Freedoms, OfTwoStretchedLinksAreShaky) {
  const std::vector<Vector3> points{{0, 0, 0}, {0.4, 0, 0}, {1, 0, 0}};
  const Explained scene(loop({"revolute", "revolute", "revolute"}, points, std::vector<Vector3>(3, Vector3::UnitZ())));
  EXPECT_EQ(scene.freedoms.mobility_by_kind, 0);
  EXPECT_EQ(scene.freedoms.mobility_here, 1);
  EXPECT_TRUE(scene.freedoms.shaky);
  const Explained bent(loop({"revolute", "revolute", "revolute"}, {{0, 0, 0}, {0.4, 0.3, 0}, {1, 0, 0}},
                            std::vector<Vector3>(3, Vector3::UnitZ())));
  EXPECT_EQ(bent.freedoms.mobility_here, 0);
  EXPECT_FALSE(bent.freedoms.shaky);
}

// Checks K-II-1.3.1b.
TEST(Freedoms, OfALinkBetweenTwoBallsIsItsSpin) {
  const std::vector<Vector3> points{{0, 0, 0}, {0, 0.2, 0.1}, {0.5, 0.3, 0.2}, {0.6, 0, 0}};
  const std::vector<Vector3> axes{Vector3(1, 0, 0.2).normalized(), Vector3::UnitZ(), Vector3::UnitZ(),
                                  Vector3::UnitX()};
  const Explained scene(loop({"revolute", "spherical", "spherical", "revolute"}, points, axes));
  EXPECT_EQ(scene.freedoms.mobility_here, 2);
  ASSERT_EQ(scene.freedoms.isolated.size(), 1u);
  const IsolatedFreedom& spin = scene.freedoms.isolated[0];
  EXPECT_EQ(scene.built->bodies[spin.body.index()].name, "link2");
  EXPECT_EQ(spin.axis.kind, MotionKind::rotation);
  for (const Vector3& ball : {points[1], points[2]}) EXPECT_LE(distance(spin.axis.line, ball), 1e-12);
  const Explained held(loop({"revolute", "spherical", "universal", "revolute"}, points, axes));
  EXPECT_EQ(held.freedoms.mobility_here, 1);
  EXPECT_TRUE(held.freedoms.isolated.empty());
}

// Checks K-II-1.3.1b. Five links between ten balls: count 6, one of use and five spins.
TEST(Freedoms, OfAFiveLinkSuspensionWithTenBallsAreOneAndFiveSpins) {
  const std::string balls = replaced(shipped("multilink"), "\"universal\"", "\"spherical\"");
  const Explained scene(without_lines(balls, "axis2 = "));
  EXPECT_EQ(scene.freedoms.mobility_here, 2 + 5) << "travel and steering";
  EXPECT_EQ(scene.freedoms.isolated.size(), 5u);
  for (const IsolatedFreedom& freedom : scene.freedoms.isolated) EXPECT_EQ(freedom.axis.kind, MotionKind::rotation);
}

// A door on two hinges is held between the ground and the ground: it turns because it is meant to.
TEST(Freedoms, OfADoorOnTwoHingesAreNotIsolated) {
  const Explained scene(loop({"revolute", "revolute"}, {{0, 0, 0}, {0, 0, 1}}, {Vector3::UnitZ(), Vector3::UnitZ()}));
  EXPECT_EQ(scene.freedoms.mobility_here, 1);
  EXPECT_EQ(scene.freedoms.mobility_by_kind, 1);
  EXPECT_TRUE(scene.freedoms.isolated.empty());
}

// Few loops are judged by singular values, many by elimination: nothing else tells them apart.
TEST(Freedoms, OfManyLoopsAreThoseOfFew) {
  for (const int loops : {3, 100}) {
    const Explained row(row_of_four_bars(loops));
    const Freedoms& found = row.freedoms;
    EXPECT_EQ(found.mobility_by_kind, 1) << loops;
    EXPECT_EQ(found.mobility_here, 1) << loops;
    EXPECT_EQ(found.mobility_nearby, 1) << loops;
    EXPECT_EQ(found.redundant_here, 3u * static_cast<unsigned>(loops));
    EXPECT_EQ(found.redundant_nearby, 3u * static_cast<unsigned>(loops));
    EXPECT_FALSE(found.shaky) << loops;
    EXPECT_TRUE(found.isolated.empty()) << loops;
    // Of every joint the force along the axes and the moments across them.
    EXPECT_EQ(found.indeterminate.size(), row.built->joints.size());
    for (const IndeterminateReaction& reaction : found.indeterminate) {
      EXPECT_EQ(reaction.force, (std::array{false, false, true})) << row.built->joints[reaction.joint.index()].name;
      EXPECT_EQ(reaction.moment, (std::array{true, true, false})) << row.built->joints[reaction.joint.index()].name;
    }
  }
}

// The last link of an open chain moves alone, too, but that is what it is for.
TEST(Freedoms, OfAnOpenChainAreNotIsolated) {
  const Explained scene(shipped("arm2"));
  EXPECT_EQ(scene.freedoms.mobility_here, 2);
  EXPECT_TRUE(scene.freedoms.isolated.empty());
}

// In a plane mechanism: moments about axes in the plane, forces across it. Where a loop is closed by as many equations
// as it needs, none; and none in the joints of its open branches.
TEST(Freedoms, TellWhichReactionsStaticsDoesNotDetermine) {
  const Explained planar(shipped("4bar"));
  EXPECT_EQ(planar.freedoms.indeterminate.size(), 4u);
  for (const IndeterminateReaction& reaction : planar.freedoms.indeterminate) {
    EXPECT_EQ(reaction.moment, (std::array<bool, 3>{true, true, false}));
    EXPECT_EQ(reaction.force, (std::array<bool, 3>{false, false, true}));
  }
  EXPECT_TRUE(Explained(shipped("rstr")).freedoms.indeterminate.empty());
  const Explained robot(shipped("panto"));
  EXPECT_NE(robot.indeterminate("elbow"), nullptr);
  EXPECT_EQ(robot.freedoms.indeterminate.size(), 5u) << "of seven joints, those of the parallelogram";
}

// Checks K-I-3.3.2c on a mechanism: X-4BAR at a crank angle of 60 degrees.
TEST(Freedoms, HaveThePoleOfTheFourBarForAScrewAxis) {
  Closed scene(shipped("4bar"));
  scene.state.input[0] = std::numbers::pi / 3;
  scene.state.input_rate[0] = 1;
  ASSERT_GE(scene.close(), 0);
  ASSERT_GE(velocities(scene.work, scene.state), 0);
  Freedoms freedoms;
  ASSERT_TRUE(find_freedoms(scene.work, scene.state, freedoms));
  for (std::size_t body = 0; body < scene.built->bodies.size(); ++body) {
    if (scene.built->bodies[body].name != "coupler") continue;
    const ScrewAxis& axis = freedoms.axes[body];
    EXPECT_EQ(axis.kind, MotionKind::rotation);
    // Nine digits are published.
    EXPECT_LE((axis.point().head<2>() - Eigen::Vector2d(0.347939080, 0.602648164)).norm(), 1e-9);
    EXPECT_NEAR(axis.rate, 0.208377411, 1e-9);
  }
}

// In a plane that lies anywhere, rounding turns no rotation into a screw, and no translation into a turn far away.
TEST(Freedoms, HaveScrewAxesWithoutRounding) {
  Random random(4);
  for (int n = 0; n < 20; ++n) {
    const Pose x{random.rotation(), random.vector()};
    // A parallelogram: its coupler moves without turning.
    Closed scene(four_bar(x, {0, 0.1, 0.5, 0.4}, {0, 0.2, 0.2, 0}) +
                 "[[drive]]\nof = 'j0.angle'\ntype = 'ramp'\nslope = 1\n");
    ASSERT_GE(scene.move(0.0), 0);
    Freedoms freedoms;
    ASSERT_TRUE(find_freedoms(scene.work, scene.state, freedoms));
    ASSERT_EQ(freedoms.axes.size(), 4u);
    EXPECT_EQ(freedoms.axes[0].kind, MotionKind::rest);
    EXPECT_EQ(freedoms.axes[1].kind, MotionKind::rotation);
    EXPECT_EQ(freedoms.axes[2].kind, MotionKind::translation);
    EXPECT_EQ(freedoms.axes[3].kind, MotionKind::rotation);
  }
}

// The power of the reactions on every rate is what the multipliers make of the equations: J^T lambda.
TEST(Reaction, HasThePowerOfItsMultipliers) {
  for (const char* name : {"4bar", "rstr", "bennett", "swash", "stewart"}) {
    Closed scene(shipped(name));
    ASSERT_GE(scene.close(), 0);
    Equations equations(*scene.built);
    ASSERT_TRUE(equations.evaluate(scene.state.q, 0));
    equations.evaluate_jacobian();
    Random random(2);
    const Eigen::VectorXd multipliers = random_rates(scene.built->rows, random);
    Eigen::VectorXd power = Eigen::VectorXd::Zero(scene.built->columns);
    for (std::size_t i = 0; i < scene.built->relations.size(); ++i) {
      const Wrench wrench = equations.reaction(i, multipliers);
      for (const PathRate& path : scene.built->relations[i].path) {
        const Column& c = equations.kinematics.columns[path.rate];
        const Twist twist{c.angular, c.linear + c.angular.cross(equations.frame_b(i).position - c.point)};
        power[path.column] += path.sign * scene.built->rate_scale[path.rate] * koppel::power(wrench, twist);
      }
    }
    const Eigen::VectorXd exact = equations.jacobian.transpose() * multipliers;
    EXPECT_LE((power - exact).lpNorm<Eigen::Infinity>(), 64 * eps * equations.jacobian.norm() * multipliers.norm())
        << name;
  }
}

Column turn(const Vector3& axis, const Vector3& at) { return {axis, Vector3::Zero(), at}; }
Column slide(const Vector3& direction) { return {Vector3::Zero(), direction, Vector3::Zero()}; }

TEST(LoopKind, IsDecidedByTheAxesWithHalfTheDigits) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const Matrix3 r = random.rotation();
    const Vector3 x = r.col(0), y = r.col(1), z = r.col(2);
    const Vector3 a = random.vector(), b = random.vector(), c = random.vector();
    const Vector3 tilted = (z + 1e-6 * x).normalized(), nearly = (z + 1e-10 * y).normalized();
    const auto kind = [](const std::vector<Column>& motions) { return loop_kind(motions, 1.0).kind; };
    EXPECT_EQ(kind({turn(z, a), turn(-z, b), turn(nearly, c), slide(x + y)}), LoopKind::planar);
    EXPECT_EQ(kind({turn(z, a), turn(z, b), turn(tilted, c)}), LoopKind::spatial);
    EXPECT_EQ(kind({turn(z, a), turn(z, b), slide(z)}), LoopKind::spatial);
    EXPECT_EQ(kind({slide(x), slide(y), slide(x - 2 * y)}), LoopKind::planar);
    const auto conditions = [](const std::vector<Column>& motions) { return loop_kind(motions, 1.0).conditions; };
    EXPECT_EQ(conditions({turn(z, a), turn(z, b), turn(z, c)}), 3);
    EXPECT_EQ(conditions({slide(x), slide(y), slide(x - 2 * y)}), 2) << "a wedge";
    EXPECT_EQ(conditions({slide(x), slide(y), slide(z), slide(x + y + z)}), 3);
    EXPECT_EQ(conditions({slide(x), slide(-x)}), 1);
    EXPECT_EQ(conditions({turn(z, a), turn(z, b), turn(z, c), slide(z)}), 4) << "a SCARA robot's motions";
    EXPECT_EQ(conditions({turn(z, a), turn(z, a + 3 * z)}), 1) << "coaxial";
    EXPECT_EQ(conditions({turn(z, a), slide(z), {z, 0.1 * z, a}}), 2) << "a screw drive";
    EXPECT_EQ(conditions({turn(x, a), turn(y, a), turn(z, a)}), 3);
    EXPECT_EQ(conditions({turn(x, a), turn(y, b), turn(z, c)}), 6);
    EXPECT_EQ(kind({slide(x), slide(y), slide(x + 1e-3 * z)}), LoopKind::spatial);
    EXPECT_EQ(kind({turn(x, a + x), turn(y, a), turn((x + z).normalized(), a)}), LoopKind::spherical);
    EXPECT_EQ(kind({turn(x, a), turn(y, a + 1e-3 * z), turn(z, a)}), LoopKind::spatial);
    EXPECT_EQ(kind({turn(x, a), turn(y, a), slide(z)}), LoopKind::spatial);
    // A screw advances: neither.
    EXPECT_EQ(kind({{z, 0.1 * z, a}, turn(z, b), turn(z, c)}), LoopKind::spatial);
    EXPECT_LE((loop_kind(std::vector{turn(x, a), turn(y, a), turn(z, a)}, 1.0).centre - a).norm(), 16 * eps);
  }
  EXPECT_EQ(loop_kind({}, 1.0).kind, LoopKind::spatial);
}

}  // namespace
}  // namespace koppel::test

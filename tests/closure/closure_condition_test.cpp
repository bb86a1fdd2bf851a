// What the closure conditions of a pair of joints measure does not change when the joints move, is independent, and is
// all that the halves of a loop owe to each other, but for mirror images where the table says so.
#include "closure/closure_condition.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "closure/decompositions.hpp"
#include "closure/loop_cut.hpp"
#include "random_loop.hpp"
#include "spatial/dual.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
using Complex = std::complex<double>;

// ------------------------------------------------------------------ joints that move by themselves

/// A pose of one side of a joint of this shape in the other: everything that leaves its elements where they are.
Pose moved(CutShape shape, Random& random) {
  const auto about_z = [&] { return rotation_about<double>(Vector3::UnitZ(), random.between(-3, 3)); };
  const Matrix3 any = rotation_of_quaternion<double>(random.quaternion());
  const Vector3 along = random.between(-1, 1) * Vector3::UnitZ(),
                across(random.between(-1, 1), random.between(-1, 1), 0);
  switch (shape) {
    case CutShape::turn: return {about_z(), Vector3::Zero()};
    case CutShape::slide: return {Matrix3::Identity(), along};
    case CutShape::cylinder: return {about_z(), along};
    case CutShape::ball: return {any, Vector3::Zero()};
    case CutShape::plane: return {about_z(), across};
    case CutShape::sliding_plane: return {Matrix3::Identity(), across};
    case CutShape::turning_plane: return {about_z(), across[0] * Vector3::UnitX()};
    case CutShape::cross:
      return {about_z() * rotation_about<double>(Vector3::UnitX(), random.between(-3, 3)), Vector3::Zero()};
  }
  return {};
}

int freedoms(CutShape shape) {
  switch (shape) {
    case CutShape::turn:
    case CutShape::slide: return 1;
    case CutShape::cylinder:
    case CutShape::cross:
    case CutShape::turning_plane:
    case CutShape::sliding_plane: return 2;
    case CutShape::ball:
    case CutShape::plane: return 3;
  }
  return 0;
}

struct Row {
  std::string name;
  CutShape a, b;
  std::vector<int> types;  ///< of the conditions, ascending
  bool mirror = false;
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

/// K-II-3.4.2a.
const std::vector<Row> table{{"S_T", CutShape::ball, CutShape::cross, {1}},
                             {"E_T", CutShape::plane, CutShape::cross, {2}},
                             {"S_ER", CutShape::ball, CutShape::turning_plane, {2}},
                             {"S_ER_slides", CutShape::ball, CutShape::sliding_plane, {2}},
                             {"E_EP", CutShape::plane, CutShape::turning_plane, {4}},
                             {"S_C", CutShape::ball, CutShape::cylinder, {3}},
                             {"E_C", CutShape::plane, CutShape::cylinder, {4}},
                             {"C_C", CutShape::cylinder, CutShape::cylinder, {4, 5}},
                             {"S_R", CutShape::ball, CutShape::turn, {1, 2}},
                             {"E_R", CutShape::plane, CutShape::turn, {2, 4}},
                             {"C_R", CutShape::cylinder, CutShape::turn, {3, 4, 5}, true},
                             {"R_R", CutShape::turn, CutShape::turn, {1, 2, 2, 4}, true},
                             {"S_P", CutShape::ball, CutShape::slide, {2, 2}},
                             {"E_P", CutShape::plane, CutShape::slide, {4, 4}, true},
                             {"C_P", CutShape::cylinder, CutShape::slide, {4, 4, 5}, true},
                             {"R_P", CutShape::turn, CutShape::slide, {2, 2, 4, 4}, true},
                             {"P_P", CutShape::slide, CutShape::slide, {4, 4, 4, 5}, true}};

/// Pairs whose link has a freedom of its own, and what still holds them together.
const std::vector<Row> isolated{{"S_S", CutShape::ball, CutShape::ball, {1}},
                                {"S_E", CutShape::ball, CutShape::plane, {2}},
                                {"E_E", CutShape::plane, CutShape::plane, {4}}};

std::vector<Row> all_rows() {
  std::vector<Row> rows = table;
  rows.insert(rows.end(), isolated.begin(), isolated.end());
  return rows;
}

class PairConditions : public testing::TestWithParam<Row> {};

INSTANTIATE_TEST_SUITE_P(Closure, PairConditions, testing::ValuesIn(all_rows()),
                         [](const auto& test) { return test.param.name; });

TEST_P(PairConditions, AreThoseOfTheTable) {
  const Row& row = GetParam();
  std::vector<int> types;
  for (const ClosureCondition& condition : pair_conditions(row.a, row.b))
    types.push_back(static_cast<int>(condition.type));
  std::sort(types.begin(), types.end());
  EXPECT_EQ(types, row.types);
  EXPECT_EQ(up_to_mirror(row.a, row.b), row.mirror);
  // A link between joints of six freedoms keeps one for itself.
  const int hidden = freedoms(row.a) + freedoms(row.b), own = hidden == 6 ? 1 : 0;
  EXPECT_EQ(static_cast<int>(types.size()), 6 - hidden + own);
}

// A half of a loop is moved at both of its joints while it stays rigid: from behind b to before a it looks like from
// before b to behind a. Values of the size 1 or its square, from two products of poses and one of vectors.
TEST_P(PairConditions, DoNotChangeWhenTheJointsMove) {
  const Row& row = GetParam();
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Pose half = random_pose(random, 1.0), same = moved(row.b, random) * half * moved(row.a, random);
    // Positions are sums of three vectors of length up to sqrt(3).
    const double longest = 3 * std::sqrt(3.0), allowed = 3 * 6 * eps * (1 + longest) * (1 + longest);
    for (const ClosureCondition& condition : pair_conditions(row.a, row.b)) {
      EXPECT_NEAR(value(condition, same), value(condition, half), allowed) << static_cast<int>(condition.type);
    }
  }
}

/// How the conditions change with the six motions of frame a: one row each.
Eigen::MatrixXd gradient(std::span<const ClosureCondition> conditions, const Pose& a_in_b) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(conditions.size()), 6);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const ClosureCondition& condition = conditions[static_cast<std::size_t>(i)];
      const Vector3 unit = Vector3::Unit(k), none = Vector3::Zero();
      result(i, k) = change(condition, a_in_b, unit, none);
      result(i, k + 3) = change(condition, a_in_b, none, unit);
    }
  }
  return result;
}

// A condition that depends on the others leaves a singular value of rounding's size, at every position.
bool independent(const Eigen::MatrixXd& gradient) {
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(gradient).singularValues();
  return sigma.minCoeff() > std::sqrt(eps) * sigma.maxCoeff();
}

TEST_P(PairConditions, AreIndependent) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    EXPECT_TRUE(independent(gradient(pair_conditions(GetParam().a, GetParam().b), random_pose(random, 1.0))));
  }
}

// ------------------------------------------------------------------ mirror images

/// Of a pair that the table calls right up to a mirror image: what the conditions leave out, which only changes its
/// sign.
double left_out(const Row& row, const Pose& half) {
  const Vector3 u = half.rotation.col(2), b = Vector3::UnitZ();
  if (row.b == CutShape::turn) {
    const Vector3 normal = b.cross(u);
    return row.a == CutShape::turn ? normal.dot(half.position) : u.cross(normal).dot(half.position);
  }
  return row.a == CutShape::slide ? axial(half.rotation)[0] : u[2];
}

/// Another half of the same values.
Pose mirrored(const Row& row, const Pose& half) {
  Pose other = half;
  const Vector3 u = half.rotation.col(2);
  if (row.a == CutShape::slide) {
    // The diagonal of a rotation is that of the opposite one. The lines keep their distance, too.
    other.rotation = half.rotation.transpose();
    const Vector3 w = other.rotation.col(2);
    const double distance = u[0] * half.position[1] - u[1] * half.position[0];
    other.position = distance / w.head<2>().squaredNorm() * Vector3(-w[1], w[0], 0);
  } else if (row.b == CutShape::slide) {
    // The axis or normal comes out of the slide's two planes on the other side.
    const Vector3 turned(u[0], u[1], -u[2]);
    other.rotation = Eigen::Quaterniond::FromTwoVectors(u, turned).toRotationMatrix() * half.rotation;
  } else if (row.a == CutShape::turn) {
    const Eigen::DiagonalMatrix<double, 3> mirror(-1, 1, 1);  // contains b's axis
    other = {mirror * half.rotation * mirror, mirror * half.position};
  } else {
    // The turn's point on the other side of the plane through the cylinder's axis and the normal of both axes.
    const Vector3 side = u.cross(Vector3::UnitZ().cross(u)).normalized();
    other.position -= 2 * side.dot(half.position) * side;
  }
  return other;
}

class MirrorImage : public testing::TestWithParam<Row> {};

INSTANTIATE_TEST_SUITE_P(Closure, MirrorImage, testing::ValuesIn([] {
                           std::vector<Row> rows = table;
                           std::erase_if(rows, [](const Row& row) { return !row.mirror; });
                           return rows;
                         }()),
                         [](const auto& test) { return test.param.name; });

TEST_P(MirrorImage, HasTheSameValuesAndIsAnotherShape) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose half = random_pose(random, 1.0), other = mirrored(GetParam(), half);
    const Pose same = moved(GetParam().b, random) * half * moved(GetParam().a, random);
    // Of two slides the distance is divided by the square of the sine between them.
    const double allowed = 40 * eps / std::min(1.0, half.rotation.col(2).head<2>().squaredNorm());
    for (const ClosureCondition& condition : pair_conditions(GetParam().a, GetParam().b)) {
      EXPECT_NEAR(value(condition, other), value(condition, half), allowed) << static_cast<int>(condition.type);
    }
    const double here = left_out(GetParam(), half);
    EXPECT_NEAR(left_out(GetParam(), other), -here, allowed);
    EXPECT_NEAR(left_out(GetParam(), same), here, 10 * allowed) << "no motion of the joints changes it";
    EXPECT_GT(std::abs(here), 1e3 * allowed) << "so that the sign tells";
  }
}

// ------------------------------------------------------------------ derivatives

std::vector<ClosureCondition> every_condition() {
  std::vector<ClosureCondition> all;
  for (const Row& row : table) {
    const auto some = pair_conditions(row.a, row.b);
    all.insert(all.end(), some.begin(), some.end());
  }
  for (const CutShape shape : {CutShape::ball, CutShape::plane, CutShape::cylinder, CutShape::turn, CutShape::slide}) {
    const auto some = joint_conditions(shape);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

// At most twenty products of numbers below 2, each a few times.
constexpr double of_derivative = 64 * eps;

TEST(ClosureCondition, ChangesAsItsDualPartSays) {
  Random random(4);
  for (const ClosureCondition& condition : every_condition()) {
    for (int trial = 0; trial < 20; ++trial) {
      const Pose a = random_pose(random, 1.0);
      const Vector3 angular = random.vector(), linear = random.vector();
      const PoseT<Dual<double>> moving{dual(a.rotation, Matrix3(skew(angular) * a.rotation)), dual(a.position, linear)};
      EXPECT_NEAR(change(condition, a, angular, linear), value(condition, moving).dual, 8 * of_derivative)
          << static_cast<int>(condition.type);
    }
  }
}

/// A rotation over the complex numbers, of a random complex quaternion.
PoseT<Complex> complex_pose(Random& random) {
  Vector4T<Complex> q;
  Vector3T<Complex> p;
  const auto number = [&] { return Complex(random.between(-1, 1), random.between(-0.5, 0.5)); };
  std::generate(q.data(), q.data() + 4, number);
  std::generate(p.data(), p.data() + 3, number);
  q[0] += 2.0;  // its bilinear length stays away from zero
  return {rotation_of_quaternion<Complex>(q), p};
}

// Along a straight line the values are polynomials of at most fourth order, of which the central difference over four
// points is the derivative, exactly.
TEST(ClosureCondition, ChangesOverComplexPosesToo) {
  Random random(5);
  for (const ClosureCondition& condition : every_condition()) {
    for (int trial = 0; trial < 20; ++trial) {
      const PoseT<Complex> a = complex_pose(random);
      const PoseT<Complex> velocities = complex_pose(random), others = complex_pose(random);
      const Vector3T<Complex> angular = velocities.position, linear = others.position;
      const auto along = [&](double t) {
        PoseT<Complex> pose = a;
        for (int k = 0; k < 3; ++k) {
          pose.rotation.col(k) += t * cross<Complex>(angular, a.rotation.col(k));
          pose.position[k] += t * linear[k];
        }
        return value(condition, pose);
      };
      const Complex difference = (8.0 * (along(1) - along(-1)) - (along(2) - along(-2))) / 12.0;
      const double largest = std::max({1.0, std::abs(along(2)), std::abs(along(-2)), std::abs(along(1))});
      EXPECT_LE(std::abs(change(condition, a, angular, linear) - difference), of_derivative * largest)
          << static_cast<int>(condition.type);
    }
  }
}

TEST(ClosureCondition, IsMeasuredInItsOwnUnit) {
  Random random(6);
  for (const ClosureCondition& condition : every_condition()) {
    const Pose small = random_pose(random, 1.0), large{small.rotation, 8 * small.position};
    EXPECT_EQ(value(condition, large), size_of(condition, 8.0) * value(condition, small));
    EXPECT_EQ(size_of(condition, 1.0), 1.0);
  }
}

// ------------------------------------------------------------------ one joint

class JointConditions : public testing::TestWithParam<CutShape> {};

INSTANTIATE_TEST_SUITE_P(Closure, JointConditions,
                         testing::Values(CutShape::ball, CutShape::plane, CutShape::cylinder, CutShape::turn,
                                         CutShape::slide),
                         [](const auto& test) {
                           return std::string(1, "RPCTSE"[static_cast<std::size_t>(test.param)]);
                         });

TEST_P(JointConditions, AreSixLessItsFreedoms) {
  EXPECT_EQ(static_cast<int>(joint_conditions(GetParam()).size()), 6 - freedoms(GetParam()));
}

TEST_P(JointConditions, VanishWhereTheJointCanBe) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose there = moved(GetParam(), random).inverse();  // of the frame before in the one behind
    for (const ClosureCondition& condition : joint_conditions(GetParam())) {
      EXPECT_NEAR(value(condition, there), 0.0, 16 * eps) << static_cast<int>(condition.type);
    }
  }
}

TEST_P(JointConditions, AreIndependentThere) {
  Random random(8);
  for (int trial = 0; trial < 50; ++trial) {
    EXPECT_TRUE(independent(gradient(joint_conditions(GetParam()), moved(GetParam(), random).inverse())));
  }
}

TEST(JointConditions, AreNoneForHalfAJoint) {
  for (const CutShape shape : {CutShape::cross, CutShape::turning_plane, CutShape::sliding_plane}) {
    EXPECT_TRUE(joint_conditions(shape).empty());
  }
}

// ------------------------------------------------------------------ both halves of a loop

struct CutLoop {
  std::string name;
  CutShape a, b;
  std::vector<LoopJoint> joints;
};

void PrintTo(const CutLoop& loop, std::ostream* out) { *out << loop.name; }

LoopJoint of_type(const std::string& type) { return {type, "", false, false, false}; }

const LoopJoint ball = of_type("spherical"), turn = of_type("revolute"), slide = of_type("prismatic"),
                cylinder = of_type("cylindrical"), plane = of_type("planar"), cross_joint = of_type("universal"),
                parallel_turn = {"revolute", "", true, false, false},
                slide_across = {"prismatic", "", false, false, true},
                turn_at_point = {"revolute", "", false, true, false};

class HalvesOfALoop : public testing::TestWithParam<CutLoop> {};

/// Between the two joints lie others on either side, so that both halves are more than one body.
INSTANTIATE_TEST_SUITE_P(
    Closure, HalvesOfALoop,
    testing::Values(
        CutLoop{"S_T", CutShape::ball, CutShape::cross, {ball, turn, turn, cross_joint, slide}},
        CutLoop{"S_T_composed", CutShape::ball, CutShape::cross, {ball, turn, slide, turn, turn_at_point, turn}},
        CutLoop{"E_T", CutShape::plane, CutShape::cross, {plane, turn, turn, cross_joint, turn}},
        CutLoop{"S_ER", CutShape::ball, CutShape::turning_plane, {ball, turn, slide, turn, parallel_turn, turn}},
        CutLoop{"S_ER_turn_slide", CutShape::ball, CutShape::turning_plane, {ball, turn, turn, slide_across, turn}},
        CutLoop{"S_ER_slides", CutShape::ball, CutShape::sliding_plane, {ball, turn, slide, slide_across, turn}},
        CutLoop{"E_EP", CutShape::plane, CutShape::turning_plane, {plane, turn, turn, parallel_turn, turn}},
        CutLoop{"S_C", CutShape::ball, CutShape::cylinder, {ball, turn, cylinder, turn}},
        CutLoop{"E_C", CutShape::plane, CutShape::cylinder, {plane, turn, cylinder, turn}},
        CutLoop{"C_C", CutShape::cylinder, CutShape::cylinder, {cylinder, turn, cylinder, turn}},
        CutLoop{"S_R", CutShape::ball, CutShape::turn, {ball, turn, slide, turn}},
        CutLoop{"E_R", CutShape::plane, CutShape::turn, {plane, slide, turn, turn}},
        CutLoop{"C_R", CutShape::cylinder, CutShape::turn, {cylinder, turn, turn, turn}},
        CutLoop{"R_R", CutShape::turn, CutShape::turn, {turn, turn, slide, turn, turn, turn, turn}},
        CutLoop{"S_P", CutShape::ball, CutShape::slide, {ball, turn, slide, turn}},
        CutLoop{"E_P", CutShape::plane, CutShape::slide, {plane, turn, slide, turn}},
        CutLoop{"C_P", CutShape::cylinder, CutShape::slide, {cylinder, turn, slide, turn}},
        CutLoop{"R_P", CutShape::turn, CutShape::slide, {turn, turn, slide, turn, turn}},
        CutLoop{"P_P", CutShape::slide, CutShape::slide, {slide, turn, slide, turn, turn}},
        CutLoop{"S_S", CutShape::ball, CutShape::ball, {ball, turn, ball, turn}}),
    [](const auto& test) { return test.param.name; });

/// All runs of the loop that make this joint.
std::vector<CutJoint> joints_of(CutShape shape, const Loops& loops) {
  std::vector<CutJoint> found;
  const Loop& loop = loops.loops[0];
  for (std::size_t first = 0; first < loop.motions.size(); ++first) {
    for (std::size_t count = 1; count <= 3; ++count) {
      const auto joint = cut_joint(loop, loops.variables, first, count, 1.0);
      if (joint && joint->shape == shape) found.push_back(*joint);
    }
  }
  return found;
}

bool apart(const CutJoint& a, const CutJoint& b, std::size_t n) {
  for (std::size_t i = 0; i < a.count; ++i) {
    if ((a.first + i + n - b.first) % n < b.count) return false;
  }
  return true;
}

// A loop is known to a few roundings for each of its motions, and a value is a product of two lengths of up to 10.
TEST_P(HalvesOfALoop, AgreeWhereItIsClosed) {
  const CutLoop& cut = GetParam();
  Random random(9);
  int pairs = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const RandomLoop loop = random_loop(cut.joints, random);
    const Built built(loop.text);
    const Loops loops = find_loops(*built).loops;
    const std::size_t n = loops.loops.at(0).motions.size();
    const double allowed = static_cast<double>(n + 6) * 24 * eps * 100;
    const auto at = places(loops.variables, loop.known.data());
    for (const CutJoint& a : joints_of(cut.a, loops)) {
      for (const CutJoint& b : joints_of(cut.b, loops)) {
        if (!apart(a, b, n)) continue;
        ++pairs;
        const LoopCut at_pair{0, a, b, {}};
        const Pose lower = walk<double>(lower_way(loops.loops[0], loops.variables, at_pair), at),
                   upper = walk<double>(upper_way(loops.loops[0], loops.variables, at_pair), at);
        for (const ClosureCondition& condition : pair_conditions(cut.a, cut.b)) {
          EXPECT_NEAR(value(condition, lower), value(condition, upper), allowed) << static_cast<int>(condition.type);
        }
      }
    }
    if (HasFailure()) FAIL() << loop.text;
  }
  EXPECT_GE(pairs, 20);
}

TEST_P(HalvesOfALoop, MeetInEachJointWhereItIsClosed) {
  const CutLoop& cut = GetParam();
  Random random(10);
  for (int trial = 0; trial < 10; ++trial) {
    const RandomLoop loop = random_loop(cut.joints, random);
    const Built built(loop.text);
    const Loops loops = find_loops(*built).loops;
    const auto at = places(loops.variables, loop.known.data());
    const double allowed = static_cast<double>(loops.loops[0].motions.size() + 6) * 24 * eps * 10;
    for (const CutJoint& joint : joints_of(cut.a, loops)) {
      const Pose round = walk<double>(lower_way(loops.loops[0], loops.variables, {0, joint, std::nullopt, {}}), at);
      for (const ClosureCondition& condition : joint_conditions(cut.a)) {
        EXPECT_NEAR(value(condition, round), 0.0, allowed) << static_cast<int>(condition.type);
      }
    }
  }
}

/// The core of a loop: what the joints other than the pair do to the conditions, by their screws.
TEST_P(HalvesOfALoop, AreConstrainedByAllConditions) {
  const CutLoop& cut = GetParam();
  Random random(11);
  const RandomLoop loop = random_loop(cut.joints, random);
  const Built built(loop.text);
  const Loops loops = find_loops(*built).loops;
  const std::size_t n = loops.loops.at(0).motions.size();
  const auto at = places(loops.variables, loop.known.data());
  const auto conditions = pair_conditions(cut.a, cut.b);
  const CutJoint a = joints_of(cut.a, loops).front();
  for (const CutJoint& b : joints_of(cut.b, loops)) {
    if (!apart(a, b, n)) continue;
    Eigen::MatrixXd core = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(conditions.size()), built->nv);
    for (const bool lower : {true, false}) {
      std::vector<WayColumn<double>> columns;
      const LoopCut at_pair{0, a, b, {}};
      const Pose half = walk<double>(lower ? lower_way(loops.loops[0], loops.variables, at_pair)
                                           : upper_way(loops.loops[0], loops.variables, at_pair),
                                     at, &columns);
      for (const WayColumn<double>& column : columns) {
        const Vector3 linear = column.along + column.angular.cross(half.position - column.point);
        Vector6 screw;
        screw << column.angular, linear;
        core.col(loops.variables[column.variable].v + column.rate) +=
            (lower ? 1 : -1) * gradient(conditions, half) * screw;
      }
    }
    const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(core).singularValues();
    const auto unknowns = static_cast<Eigen::Index>(n) - static_cast<Eigen::Index>(a.count + b.count);
    const Eigen::Index least = std::min<Eigen::Index>(unknowns, core.rows());
    EXPECT_GT(sigma[least - 1], std::sqrt(eps) * sigma[0]);
  }
}

}  // namespace
}  // namespace koppel::test

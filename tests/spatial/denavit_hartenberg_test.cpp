// Denavit-Hartenberg parameters: from parameters to frames, from axes to parameters, and there and back, in both
// conventions and with axes in every special position.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/denavit_hartenberg_table.hpp"

namespace koppel::test {
namespace {

using Long = long double;
using D = Dual<double>;
using Joint = DenavitHartenbergJoint;
using Convention = DenavitHartenbergConvention;
using Table = DenavitHartenbergTableT<double>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;

Line line_at(const Vector3& point, const Vector3& direction) { return *line_through<double>(point, direction); }
Line z_line(const Pose& x) { return line_at(x.position, x.rotation.col(2)); }
Pose random_pose(Random& random) { return {random.rotation(), random.vector()}; }
double apart(const Pose& a, const Pose& b) {
  return std::max((a.rotation - b.rotation).cwiseAbs().maxCoeff(), (a.position - b.position).cwiseAbs().maxCoeff());
}
DenavitHartenberg random_parameters(Random& random) {
  return {random.between(-pi, pi), random.between(-1, 1), random.between(0, 1), random.between(-pi, pi)};
}

template <typename T>
PoseT<T> turned(const Vector3T<T>& axis, const T& angle) {
  return {rotation_about<T>(axis, angle), Vector3T<T>::Zero()};
}
template <typename T>
PoseT<T> moved(const Vector3T<T>& way) {
  return {Matrix3T<T>::Identity(), way};
}

// Checks K-II-2.3. The product of four elementary motions, in either order.
TEST(DenavitHartenberg, StepIsFourElementaryMotions) {
  Random random(1);
  const Vector3 ex = Vector3::UnitX(), ez = Vector3::UnitZ();
  for (int i = 0; i < 300; ++i) {
    const DenavitHartenberg p = random_parameters(random);
    const Pose about_z = turned<double>(ez, p.angle) * moved<double>(p.offset * ez),
               about_x = moved<double>(p.length * ex) * turned<double>(ex, p.twist);
    EXPECT_LE(apart(classic_transform(p), about_z * about_x), 8 * eps);
    EXPECT_LE(apart(modified_transform(p), about_x * about_z), 8 * eps);
    EXPECT_EQ(apart(denavit_hartenberg_transform(p, Convention::classic), classic_transform(p)), 0);
    EXPECT_EQ(apart(denavit_hartenberg_transform(p, Convention::modified), modified_transform(p)), 0);
  }
  const Pose home = classic_transform(DenavitHartenberg{});
  EXPECT_EQ(apart(home, Pose{}), 0);
  // Parameters of the text: (d cos, d sin, s) is the position.
  const Pose x = classic_transform<double>({pi / 6, 3, 2, pi / 2});
  EXPECT_LE((x.position - Vector3(std::sqrt(3.0), 1, 3)).norm(), 4 * eps);
  EXPECT_LE((x.rotation.col(2) - Vector3(0.5, -std::sqrt(0.75), 0)).norm(), 4 * eps);
}

// Checks K-II-2.3. The fixed part of a prismatic joint has no displacement along z: it would count twice.
TEST(DenavitHartenberg, StepIsWhatTheJointMovesAndWhatTheLinkKeeps) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const DenavitHartenberg p = random_parameters(random);
    for (const Joint joint : {Joint::revolute, Joint::prismatic}) {
      const auto classic = denavit_hartenberg_parts(p, joint),
                 modified = denavit_hartenberg_parts(p, joint, Convention::modified);
      EXPECT_LE(apart(classic.variable * classic.fixed, classic_transform(p)), 4 * eps);
      EXPECT_LE(apart(modified.fixed * modified.variable, modified_transform(p)), 4 * eps);
      const Pose variable =
          joint == Joint::revolute ? turned<double>(Vector3::UnitZ(), p.angle) : moved<double>(Vector3(0, 0, p.offset));
      EXPECT_LE(apart(classic.variable, variable), eps);
      EXPECT_LE(apart(modified.variable, variable), eps);
      DenavitHartenberg other = p;  // another position of the joint
      (joint == Joint::revolute ? other.angle : other.offset) += 0.5;
      EXPECT_EQ(apart(denavit_hartenberg_parts(other, joint).fixed, classic.fixed), 0);
      EXPECT_EQ(apart(denavit_hartenberg_parts(other, joint, Convention::modified).fixed, modified.fixed), 0);
    }
    const Pose after_turn = denavit_hartenberg_parts(p, Joint::revolute).fixed,
               after_slide = denavit_hartenberg_parts(p, Joint::prismatic).fixed;
    EXPECT_EQ(after_turn.position, Vector3(p.length, 0, p.offset));
    EXPECT_LE((after_turn.rotation - rotation_about<double>(Vector3::UnitX(), p.twist)).norm(), 4 * eps);
    EXPECT_EQ(after_slide.position, Vector3(p.length * std::cos(p.angle), p.length * std::sin(p.angle), 0));
    EXPECT_EQ(after_slide.rotation, classic_transform(p).rotation);
  }
}

// Checks K-II-2.3. Positions up to two, directions off by rounding over the sine of the twist.
TEST(DenavitHartenbergStep, FindsTheParametersThatTheAxisWasBuiltWith) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Pose frame = random_pose(random);
    DenavitHartenberg p = random_parameters(random);
    p.length += 0.1;
    p.twist = random.between(0.1, pi - 0.1) * (i % 2 == 0 ? 1 : -1);
    const Pose next = frame * classic_transform(p);
    const Line axis = z_line(next);
    const auto step = denavit_hartenberg_step<double>(frame, {axis.direction, axis.moment});
    const double tolerance = 8 * eps * 4 / std::abs(std::sin(p.twist));
    ASSERT_EQ(step.relation, LineRelation::skew);
    EXPECT_LE(std::abs(std::remainder(step.parameters.angle - p.angle, 2 * pi)), tolerance);
    EXPECT_NEAR(step.parameters.offset, p.offset, tolerance);
    EXPECT_NEAR(step.parameters.length, p.length, tolerance);
    EXPECT_NEAR(step.parameters.twist, p.twist, 16 * eps);
    EXPECT_LE(apart(step.frame, next), 2 * tolerance);
  }
}

// Checks K-II-2.3. With exact numbers, so that everything can be read.
TEST(DenavitHartenbergStep, NamesWhatItHasChosen) {
  const auto step_to = [](const Vector3& point, const Vector3& direction) {
    return denavit_hartenberg_step(Pose{}, line_at(point, direction));
  };
  const auto expect = [](const DenavitHartenbergStepT<double>& step, LineRelation relation,
                         const DenavitHartenberg& expected) {
    EXPECT_EQ(step.relation, relation);
    EXPECT_NEAR(step.parameters.angle, expected.angle, eps);
    EXPECT_NEAR(step.parameters.offset, expected.offset, 2 * eps * expected.offset);
    EXPECT_EQ(step.parameters.length, expected.length);
    EXPECT_NEAR(step.parameters.twist, expected.twist, eps);
    EXPECT_LE(apart(step.frame, classic_transform(step.parameters)), 0);
  };
  const Vector3 y = Vector3::UnitY(), z = Vector3::UnitZ();
  expect(step_to({2, 7, 3}, y), LineRelation::skew, {0, 3, 2, -pi / 2});
  expect(step_to({-2, 7, 3}, y), LineRelation::skew, {pi, 3, 2, pi / 2});
  // Intersecting: x along z_j x z_{j+1} = -x or x, twist not negative.
  expect(step_to({0, 7, 3}, y), LineRelation::intersecting, {pi, 3, 0, pi / 2});
  expect(step_to({0, 7, 3}, -y), LineRelation::intersecting, {0, 3, 0, pi / 2});
  expect(step_to({0, 0, 3}, {0, 1, -1}), LineRelation::intersecting, {pi, 3, 0, 3 * pi / 4});
  // Parallel: the normal through the origin of the first frame, at whatever height the second axis has its point.
  expect(step_to({0, 2, 5}, z), LineRelation::parallel, {pi / 2, 0, 2, 0});
  expect(step_to({0, -2, -5}, -z), LineRelation::parallel, {-pi / 2, 0, 2, pi});
  // Coincident: x kept.
  expect(step_to({0, 0, 9}, z), LineRelation::coincident, {0, 0, 0, 0});
  expect(step_to({0, 0, 9}, -z), LineRelation::coincident, {0, 0, 0, pi});
  EXPECT_LE((step_to({0, 0, 9}, -z).frame.rotation.col(0) - Vector3::UnitX()).norm(), 0);
}

enum class Kind { skew, intersecting, parallel, antiparallel, coincident, opposite };

/// An axis that lies so to another one, or nearly so.
Line next_axis(const Line& axis, Kind kind, double off, Random& random) {
  const Vector3 u = axis.direction, on = axis.nearest_to_origin() + random.between(-1, 1) * u;
  const Vector3 across = rotation_about<double>(u, random.between(-3, 3)) * tangents<double>(u).col(0);
  const Vector3 beside = on + random.between(0.1, 1) * across;
  const Vector3 tilt = off * rotation_about<double>(u, random.between(-3, 3)) * tangents<double>(u).col(0);
  switch (kind) {
    case Kind::skew: return line_at(beside, random.direction());
    case Kind::intersecting: return line_at(on, random.direction());
    case Kind::parallel: return line_at(beside, u + tilt);
    case Kind::antiparallel: return line_at(beside, -u + tilt);
    case Kind::coincident: return line_at(on, u + tilt);
    case Kind::opposite: return line_at(on, -u + tilt);
  }
  return axis;
}

LineRelation relation_of(Kind kind) {
  switch (kind) {
    case Kind::skew: return LineRelation::skew;
    case Kind::intersecting: return LineRelation::intersecting;
    case Kind::parallel:
    case Kind::antiparallel: return LineRelation::parallel;
    case Kind::coincident:
    case Kind::opposite: return LineRelation::coincident;
  }
  return LineRelation::skew;
}

/// A chain of axes with base and end frame.
struct Chain {
  Chain(Random& random, std::size_t joints, bool special, double off = 0)
      : base(random_pose(random)), end(random_pose(random)) {
    axes.push_back(line_at(random.vector(), random.direction()));
    while (axes.size() < joints) {
      const Kind kind = special ? static_cast<Kind>(static_cast<int>(random.between(0, 6))) : Kind::skew;
      kinds.push_back(kind);
      axes.push_back(next_axis(axes.back(), kind, off, random));
    }
  }
  Table table() const { return denavit_hartenberg_table<double>(axes, base, end); }

  Pose base, end;
  std::vector<Line> axes;
  std::vector<Kind> kinds;
};

/// The z axes of the frames are the chain's axes, and the end frame is the end frame. Classic tables correct at every
/// joint what the one before has left, so that errors are rounding at the distance of two neighbouring frames; modified
/// ones, made from the classic, carry it on. What was neglected when axes were named comes on top.
void expect_reproduced(const Chain& chain, const Table& table, double neglected_angle = 0) {
  const std::size_t joints = chain.axes.size(), first = table.convention == Convention::classic ? 0 : 1;
  ASSERT_EQ(table.rows.size(), joints);
  const auto all = frames(table, chain.base);
  double size = std::max(chain.base.position.norm(), chain.end.position.norm()), before = 0;
  for (const Line& axis : chain.axes) size = std::max(size, axis.moment.norm());
  // Axes closer than 64 units of rounding have been taken to meet; rotations are up to 8 off by every product.
  const double factor = (64 + 8 * static_cast<double>(joints)) * eps;
  for (std::size_t k = 0; k <= joints; ++k) {
    const Pose& x = all[k];
    const double here = std::max(size, x.position.norm()), reach = std::max(here, before);
    before = table.convention == Convention::classic ? here : reach;
    if (k == joints) {
      EXPECT_LE(apart(x * table.end, chain.end), factor * reach);
    }
    // Half a unit in each of the products of a step, in both factors; the base comes in twice.
    EXPECT_LE(orthonormality_residual(x.rotation), 6 * eps * static_cast<double>(joints + 2));
    if (k < first || k - first >= joints) continue;
    const Line& axis = chain.axes[k - first];
    EXPECT_LE((x.rotation.col(2) - axis.direction).norm(), factor + neglected_angle);
    EXPECT_LE(distance(axis, x.position), (factor + neglected_angle) * reach);
  }
}

/// What the frames of a table are: x on the common normal of its axis and the next one, origin on it.
void expect_on_normals(const Chain& chain, const Table& table) {
  const auto all = frames(table, chain.base);
  for (std::size_t k = 0; k + 1 < chain.axes.size(); ++k) {
    const Line &axis = chain.axes[k], &next = chain.axes[k + 1];
    // Classic: at the foot on the next axis. Modified: at the foot on its own.
    const Pose& x = all[k + 1];
    const LinePair pair = line_pair(axis, next);
    // Eight units for each of up to eight joints; the foot of the given axes sees them over the sine.
    const double tolerance = 64 * eps;
    EXPECT_NEAR(x.rotation.col(0).dot(axis.direction), 0, tolerance);
    EXPECT_NEAR(x.rotation.col(0).dot(next.direction), 0, tolerance);
    EXPECT_GE(x.rotation.col(0).dot(pair.foot_2 - pair.foot_1), 0);
    const Vector3& foot = table.convention == Convention::classic ? pair.foot_2 : pair.foot_1;
    EXPECT_LE((x.position - foot).norm(), tolerance * (3 + x.position.norm()) / std::sin(pair.angle));
  }
}

// Checks K-II-2.3.
TEST(DenavitHartenbergTable, OfRandomAxesReproducesThem) {
  Random random(4);
  for (int i = 0; i < 10000; ++i) {
    const Chain chain(random, static_cast<std::size_t>(1 + i % 8), false);
    const Table table = chain.table();
    for (std::size_t k = 0; k + 1 < chain.axes.size(); ++k) {
      EXPECT_EQ(table.relations[k], LineRelation::skew);
      EXPECT_GE(table.rows[k].length, 0);
    }
    expect_reproduced(chain, table);
    expect_on_normals(chain, table);
    const Table modified = modified_of_classic(table);
    expect_reproduced(chain, modified);
    expect_on_normals(chain, modified);
  }
}

// Checks K-II-2.3.
TEST(DenavitHartenbergTable, OfAxesInSpecialPositionsReproducesThemAndNamesThem) {
  Random random(5);
  for (int i = 0; i < 10000; ++i) {
    const Chain chain(random, static_cast<std::size_t>(2 + i % 7), true);
    const Table table = chain.table();
    for (std::size_t k = 0; k < chain.kinds.size(); ++k) {
      const DenavitHartenberg& p = table.rows[k];
      const LineRelation relation = relation_of(chain.kinds[k]);
      ASSERT_EQ(table.relations[k], relation);
      EXPECT_GE(p.length, 0);
      if (relation == LineRelation::intersecting) {
        EXPECT_TRUE(p.length == 0 && p.twist > 0 && p.twist < pi);
      }
      if (relation == LineRelation::parallel || relation == LineRelation::coincident) {
        const bool opposite = chain.kinds[k] == Kind::antiparallel || chain.kinds[k] == Kind::opposite;
        EXPECT_EQ(p.offset, 0);
        EXPECT_EQ(p.twist, opposite ? pi : 0);
      }
      if (relation == LineRelation::coincident) {
        EXPECT_TRUE(p.angle == 0 && p.length == 0);
      }
    }
    expect_reproduced(chain, table);
    expect_reproduced(chain, modified_of_classic(table));
  }
}

// Checks K-II-2.3. Nearly parallel axes: their feet are far away, and everything is exact to rounding at that distance.
// Where the angle is less than the root of rounding, they are taken for parallel, unless the caller wants them apart.
TEST(DenavitHartenbergTable, OfNearlyParallelAxesReproducesThem) {
  Random random(6);
  for (const double off : {1e-4, 1e-7, 1e-10, 1e-12}) {
    double farthest = 0;
    for (int i = 0; i < 1000; ++i) {
      Chain chain(random, 3, false);
      const auto kind = static_cast<Kind>(2 + i % 4);
      chain.axes.push_back(next_axis(chain.axes.back(), kind, off, random));
      chain.axes.push_back(next_axis(chain.axes.back(), Kind::skew, 0, random));
      const Table table = chain.table();
      const bool large = off > 1.5e-8;
      const double neglected = large ? 0 : 2 * off;
      const LineRelation relation = table.relations[2];
      EXPECT_EQ(relation == LineRelation::skew || relation == LineRelation::intersecting, large);
      // Lines through a point at a small angle are some way apart elsewhere.
      EXPECT_TRUE(large || relation == relation_of(kind) || relation == LineRelation::parallel);
      expect_reproduced(chain, table, neglected);
      expect_reproduced(chain, modified_of_classic(table), neglected);
      const Table exact = denavit_hartenberg_table<double>(chain.axes, chain.base, chain.end, IncidenceTolerance{});
      EXPECT_NE(exact.relations[2], LineRelation::parallel);
      expect_reproduced(chain, exact);
      expect_reproduced(chain, modified_of_classic(exact));
      farthest = std::max(farthest, frames(exact, chain.base)[3].position.norm());
    }
    EXPECT_GT(farthest, 0.1 / off) << "or the test says nothing";
  }
}

// Checks K-II-2.3. In other units of length, a power of two apart, lengths are the same to the last digit.
TEST(DenavitHartenbergTable, DoesNotDependOnTheUnit) {
  Random random(7);
  for (const double unit : {0x1p-500, 0x1p-30, 0x1p30, 0x1p500}) {
    for (int i = 0; i < 200; ++i) {
      Chain chain(random, 6, true);
      const Table table = chain.table();
      chain.base.position *= unit;
      chain.end.position *= unit;
      for (Line& axis : chain.axes) axis.moment *= unit;
      const Table scaled = chain.table();
      EXPECT_EQ(scaled.relations, table.relations);
      for (std::size_t k = 0; k < 6; ++k) {
        const DenavitHartenberg &p = scaled.rows[k], &q = table.rows[k];
        EXPECT_EQ(p.angle, q.angle);
        EXPECT_EQ(p.twist, q.twist);
        EXPECT_EQ(p.offset / unit, q.offset);
        EXPECT_EQ(p.length / unit, q.length);
      }
      EXPECT_EQ(Vector3(scaled.end.position / unit), table.end.position);
    }
  }
}

// Checks K-II-2.3. A coordinate added to its row moves all that follows about, or along, the axis as it lies.
TEST(DenavitHartenbergTable, JointsMoveWhatFollowsAboutTheirAxes) {
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const Chain chain(random, 5, true);
    const std::size_t joint = static_cast<std::size_t>(i) % 5;
    const double change = random.between(-1, 1);
    const Line& axis = chain.axes[joint];
    const Matrix3 turn = rotation_about<double>(axis.direction, change);
    const Vector3 on = axis.nearest_to_origin();
    for (const Table& home : {chain.table(), modified_of_classic(chain.table())}) {
      double reach = 3;
      for (const Pose& x : frames(home, chain.base)) reach = std::max(reach, x.position.norm());
      const double tolerance = 64 * eps * reach;  // five steps, in two products
      Table turning = home, sliding = home;
      turning.rows[joint].angle += change;
      sliding.rows[joint].offset += change;
      const Pose turned_end = frames(turning, chain.base).back() * turning.end,
                 slid_end = frames(sliding, chain.base).back() * sliding.end;
      EXPECT_LE(apart(turned_end, Pose{turn, on - turn * on} * chain.end), tolerance);
      EXPECT_LE(apart(slid_end, moved<double>(change * axis.direction) * chain.end), tolerance);
    }
  }
}

// Checks K-II-2.3. What remains at the ends is as little as can be.
TEST(DenavitHartenbergTable, LeavesNothingAtTheEndsThatFit) {
  Random random(9);
  for (int i = 0; i < 300; ++i) {
    // Base frame and end frame on the first and last axis.
    Chain chain(random, 4, false);
    chain.base = frame_on_axis(random_pose(random), chain.axes.front());
    chain.end = frame_on_axis(random_pose(random), chain.axes.back());
    const Table table = chain.table();
    EXPECT_LE(apart(table.base, Pose{}), 32 * eps);
    EXPECT_EQ(table.relations.back(), LineRelation::coincident);
    double reach = 3;
    for (const Pose& x : frames(table, chain.base)) reach = std::max(reach, x.position.norm());
    EXPECT_LE(apart(table.end, Pose{}), 32 * eps * reach);
    expect_reproduced(chain, table);
  }
  // Without joints, the end in the base.
  const Pose base = random_pose(random), end = random_pose(random);
  const Table none = denavit_hartenberg_table<double>({}, base, end);
  EXPECT_TRUE(none.rows.empty());
  EXPECT_LE(apart(frames(none, base).front() * none.end, end), 16 * eps);
}

TEST(FrameOnAxis, HasTheXAxisOfTheBaseIfItCan) {
  EXPECT_EQ(apart(frame_on_axis(Pose{}, Line()), Pose{}), 0);
  const Pose along_x = frame_on_axis(Pose{}, line_at({5, 6, 7}, Vector3::UnitX()));
  EXPECT_EQ(along_x.position, Vector3(0, 6, 7));
  EXPECT_EQ(along_x.rotation.col(0), Vector3::UnitY());
  Random random(10);
  for (int i = 0; i < 300; ++i) {
    const Pose base = random_pose(random);
    const Line axis = line_at(random.vector(), random.direction());
    const Pose x = frame_on_axis(base, axis);
    EXPECT_LE(orthonormality_residual(x.rotation), 8 * eps);
    EXPECT_EQ(x.rotation.col(2), axis.direction);
    EXPECT_GT(x.rotation.determinant(), 0);
    EXPECT_LE(distance(axis, x.position), 32 * eps);
    EXPECT_NEAR(axis.direction.dot(x.position - base.position), 0, 32 * eps);
  }
}

// Checks K-II-2.3.
TEST(DenavitHartenbergTable, ChangesConventionThereAndBack) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const Chain chain(random, 5, true);
    const Table classic = chain.table(), modified = modified_of_classic(classic), back = classic_of_modified(modified);
    EXPECT_EQ(modified.convention, Convention::modified);
    EXPECT_EQ(back.convention, Convention::classic);
    EXPECT_EQ(modified_of_classic(modified).rows.back().length, modified.rows.back().length) << "as it is";
    EXPECT_EQ(modified.rows.front().length, 0);
    EXPECT_EQ(modified.rows.front().twist, 0);
    const auto a = frames(classic, chain.base), b = frames(back, chain.base);
    double reach = 3;
    for (const Pose& x : a) reach = std::max(reach, x.position.norm());
    // The length and twist of the last row stay with the end.
    for (std::size_t k = 0; k < 5; ++k) EXPECT_LE(apart(a[k], b[k]), 32 * eps * reach);
    EXPECT_EQ(back.rows.back().length, 0);
    EXPECT_EQ(back.rows.back().twist, 0);
    EXPECT_LE(apart(b.back() * back.end, chain.end), 32 * eps * reach);
  }
}

/// The six-axis robot of the specification: (s, d, delta) and coordinates at which its pose is known.
struct Robot {
  static Table table() {
    constexpr std::array<std::array<double, 3>, 6> data{
        {{0.4, 0.025, -90}, {0, 0.455, 0}, {0, 0.035, -90}, {0.42, 0, 90}, {0, 0, -90}, {0.08, 0, 0}}};
    constexpr std::array<double, 6> q{20, -60, 80, 30, 45, -10};
    Table table;
    for (std::size_t k = 0; k < 6; ++k) {
      table.rows.push_back({q[k] * degree, data[k][0], data[k][1], data[k][2] * degree});
    }
    return table;
  }
  /// Printed with nine digits.
  static Pose pose() {
    Pose x;
    x.rotation << 0.453034916, -0.067672386, -0.888920589,  //
        -0.045601422, -0.997568495, 0.052703025,            //
        -0.890325713, 0.016659733, -0.455019316;
    x.position << 0.062079119, 0.052694444, 0.350998408;
    return x;
  }
};
constexpr double nine_digits = 0.51e-9;

// Checks K-II-2.3.
TEST(SixAxisRobot, HasThePublishedPose) {
  EXPECT_LE(apart(frames(Robot::table()).back(), Robot::pose()), nine_digits);
  Pose by_parts;
  for (const auto& row : Robot::table().rows) {
    const auto parts = denavit_hartenberg_parts(row, Joint::revolute);
    by_parts = by_parts * parts.variable * parts.fixed;
  }
  EXPECT_LE(apart(by_parts, Robot::pose()), nine_digits);
}

// Checks K-II-2.3. Up to the free choice at the wrist: with twist not negative, the fifth x axis is the opposite one,
// and the angles on both sides of it are half a turn off.
TEST(SixAxisRobot, HasItsTableBackFromItsAxes) {
  const auto all = frames(Robot::table());
  std::vector<Line> axes;
  for (std::size_t k = 0; k < 6; ++k) axes.push_back(z_line(all[k]));
  const Table table = denavit_hartenberg_table<double>(axes, Pose{}, all.back());
  constexpr std::array<std::array<double, 4>, 6> expected{{{20, 0.4, 0.025, -90},
                                                           {-60, 0, 0.455, 0},
                                                           {80, 0, 0.035, -90},
                                                           {30, 0.42, 0, 90},
                                                           {-135, 0, 0, 90},
                                                           {170, 0.08, 0, 0}}};
  // Frames of a robot a metre in size after up to six products.
  const double tolerance = 64 * eps;
  ASSERT_EQ(table.rows.size(), 6);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(table.rows[k].angle, expected[k][0] * degree, tolerance / 0.025) << k << ": over the shortest normal";
    EXPECT_NEAR(table.rows[k].offset, expected[k][1], tolerance) << k;
    EXPECT_NEAR(table.rows[k].length, expected[k][2], tolerance) << k;
    EXPECT_NEAR(table.rows[k].twist, expected[k][3] * degree, tolerance) << k;
  }
  EXPECT_EQ(table.relations,
            (std::vector{LineRelation::skew, LineRelation::parallel, LineRelation::skew, LineRelation::intersecting,
                         LineRelation::intersecting, LineRelation::coincident}));
  EXPECT_LE(apart(table.base, Pose{}), 0);
  EXPECT_LE(apart(table.end, Pose{}), 64 * eps);
  for (const Table& t : {table, modified_of_classic(table)}) {
    EXPECT_LE(apart(frames(t).back() * t.end, Robot::pose()), nine_digits);
  }
}

// Checks K-II-2.3. An axis that moves: the frame of the parameters' rates moves with it. With derivatives of what is
// divided by the sine, the condition comes squared.
TEST(DenavitHartenbergStep, CarriesRatesOfTheAxis) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    const Vector3 point = random.vector(), direction = random.direction(), w = random.vector(), v = random.vector();
    const double sine = std::hypot(direction.x(), direction.y());
    if (sine < 0.1) continue;
    const Vector3 moment = point.cross(direction), turning = w.cross(direction);
    const Vector3 moving = v.cross(direction) + point.cross(turning);
    const LineT<D> axis{dual(direction, turning), dual(moment, moving)};
    const auto step = denavit_hartenberg_step<D>(PoseT<D>{}, axis);
    const Vector3T<D> z = step.frame.rotation.col(2), m = step.frame.position.cross(z);
    const double tolerance = 8 * eps * 8 / (sine * sine);
    EXPECT_LE(real_part(z - axis.direction).norm(), tolerance);
    EXPECT_LE(dual_part(z - axis.direction).norm(), tolerance);
    EXPECT_LE(real_part(m - axis.moment).norm(), tolerance);
    EXPECT_LE(dual_part(m - axis.moment).norm(), tolerance);
  }
  const auto exact = denavit_hartenberg_step<Long>(PoseT<Long>{}, *line_through<Long>({0, 2, 5}, {0, 0, -1}));
  EXPECT_EQ(exact.parameters.twist, std::atan2(Long(0), Long(-1)));
  EXPECT_EQ(exact.parameters.length, 2);
}

}  // namespace
}  // namespace koppel::test

// A loop as a sequence of elementary motions: where the mechanism is closed, the product once round is the identity,
// and each coordinate opens it by what its motion does.
#include "closure/loop.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "closure/loop_cut.hpp"
#include "folders.hpp"
#include "random_loop.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// One motion of a walk takes three products of poses: of its two constants, with its frame, and with what it does. An
// entry of a product is a sum of three terms, wrong by at most 2 eps of the sum of their sizes, which in norm is at
// most 3 * 2 eps; cosine, sine and the constants themselves, which come from a text, add as much again.
constexpr double of_motion = 4 * 3 * 2 * eps;

/// All lengths on the way round [m]: what one wrong angle on it can move.
double reach(const Mechanism& mechanism, const Loop& loop, const Eigen::VectorXd& q) {
  double sum = 0.0;
  for (const JointId id : loop.joints) {
    const Joint& joint = mechanism.joints[id.index()];
    sum += joint.inlet.pose.position.norm() + joint.outlet.pose.position.norm();
    for (const ElementaryMotion& motion : joint.motions()) {
      sum += 2 * motion.point.norm() + std::abs(motion.zero);
      if (motion.kind == ElementaryMotionKind::translation) sum += std::abs(q[joint.q + motion.q]);
    }
  }
  return sum;
}

Pose round(const Loops& loops, const Loop& loop, const Eigen::VectorXd& q) {
  const auto at = places(loops.variables, q.data());
  return walk<double>(round_way(loop, loops.variables), at);
}

/// Every loop closes at q; `open`: what the coordinates themselves leave open, in radians.
void expect_closed(const Mechanism& mechanism, const Loops& loops, const Eigen::VectorXd& q, double open) {
  for (std::size_t i = 0; i < loops.loops.size(); ++i) {
    const Loop& loop = loops.loops[i];
    const double allowed = open + static_cast<double>(loop.motions.size()) * of_motion;
    const Pose once = round(loops, loop, q);
    EXPECT_LE((once.rotation - Matrix3::Identity()).norm(), allowed) << "loop " << i;
    EXPECT_LE(once.position.norm(), allowed * reach(mechanism, loop, q)) << "loop " << i;
  }
}

Loops loops_of(const Mechanism& mechanism, const LoopChoice& choice = {}) {
  LoopsOrObstacle found = find_loops(mechanism, choice);
  EXPECT_EQ(found.obstacle, "");
  return std::move(found.loops);
}

/// All shipped scenes but the one whose joints have a pitch.
std::vector<std::string> scenes() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(scenes_folder())) {
    if (file.path().extension() == ".toml" && file.path().stem() != "7h") names.push_back(file.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// ------------------------------------------------------------------ the shipped scenes

class LoopsOfAScene : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Closure, LoopsOfAScene, testing::ValuesIn(scenes()),
                         [](const auto& test) { return "scene_" + test.param; });

TEST_P(LoopsOfAScene, CloseWhereTheMechanismDoes) {
  Closed closed(shipped(GetParam()));
  ASSERT_GE(closed.close(), 0);
  const Mechanism& mechanism = *closed.built;
  const Loops loops = loops_of(mechanism);
  EXPECT_EQ(loops.loops.size(), mechanism.loops);
  // A loop here may be the sum of all those that the equations close; each leaves open at most what its six rows say,
  // lengths in units of the mechanism's, and no arm is shorter than the whole way round.
  double shortest = mechanism.length;
  for (const Loop& loop : loops.loops) shortest = std::min(shortest, reach(mechanism, loop, closed.state.q));
  const double rows = std::sqrt(6.0) * closed.residual() * mechanism.loops;
  expect_closed(mechanism, loops, closed.state.q, rows * mechanism.length / shortest);
}

TEST_P(LoopsOfAScene, AreWalksThroughTheBodies) {
  const Closed closed(shipped(GetParam()));
  const Mechanism& mechanism = *closed.built;
  for (const Loop& loop : loops_of(mechanism).loops) {
    const auto ends = [&](std::size_t i) {
      const Joint& joint = mechanism.joints[loop.joints[i % loop.joints.size()].index()];
      return std::set{joint.inlet.body, joint.outlet.body};
    };
    for (std::size_t i = 0; i < loop.joints.size(); ++i) {
      const std::set<BodyId> here = ends(i), next = ends(i + 1);
      std::vector<BodyId> common;
      std::set_intersection(here.begin(), here.end(), next.begin(), next.end(), std::back_inserter(common));
      EXPECT_FALSE(common.empty()) << mechanism.joints[loop.joints[i].index()].name;
    }
  }
}

TEST_P(LoopsOfAScene, HaveTheCoordinatesOfTheStateAsVariables) {
  const Closed closed(shipped(GetParam()));
  const Mechanism& mechanism = *closed.built;
  const Loops loops = loops_of(mechanism);
  std::set<std::uint32_t> rates;
  for (const Variable& variable : loops.variables) {
    const auto block = std::find_if(mechanism.blocks.begin(), mechanism.blocks.end(),
                                    [&](const StateBlock& b) { return b.v == variable.v; });
    ASSERT_NE(block, mechanism.blocks.end());
    EXPECT_EQ(block->q, variable.q);
    EXPECT_EQ(block->joint, variable.joint);
    EXPECT_EQ(block->kind == BlockKind::quaternion, variable.kind == VariableKind::ball);
    EXPECT_EQ(block->kind == BlockKind::line, variable.kind == VariableKind::slide);
    EXPECT_TRUE(rates.insert(variable.v).second) << "one motion for each coordinate";
  }
  EXPECT_EQ(rates.size(), mechanism.blocks.size());
}

// ------------------------------------------------------------------ joints at random, either way round

struct Part {
  std::string type;  ///< with parameters, as lines of a scene
  bool reversed = false;
};

/// A loop of these joints from the ground round to the ground, closed at `q`. A reversed joint has its outlet first.
struct AnyWay {
  AnyWay(const std::vector<Part>& parts, Random& random) {
    const std::size_t n = parts.size();
    std::vector<Pose> first(n), second(n);
    for (std::size_t i = 0; i < n; ++i) first[i] = random_pose(random, 0.5), second[i] = random_pose(random, 0.5);
    const Built open(written(parts, first, second));
    q = random_position(*open, random, 1.5);
    Pose round;
    for (std::size_t i = 0; i < n; ++i) {
      Pose moved;
      EXPECT_TRUE(open->joints[i].pose(q.data() + open->joints[i].q, moved));
      round = round * first[i] * (parts[i].reversed ? moved.inverse() : moved);
      if (i + 1 == n) second[i] = round;
      round = round * second[i].inverse();
    }
    text = written(parts, first, second);
  }

  static std::string written(const std::vector<Part>& parts, const std::vector<Pose>& first,
                             const std::vector<Pose>& second) {
    const std::size_t n = parts.size();
    const auto body = [&](std::size_t i) {
      return i % n == 0 ? std::string("ground") : std::string("b") + std::to_string(i);
    };
    std::string bodies = "[scene]\nlength = 1\n", joints;
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) bodies += std::string("[[body]]\nname = '") + body(i) + "'\n";
      const std::string near = frame_text(body(i), first[i]), far = frame_text(body(i + 1), second[i]);
      joints += std::string("[[joint]]\nname = 'j") + std::to_string(i) + "'\ntype = " + parts[i].type;
      joints +=
          "\ninlet = " + (parts[i].reversed ? far : near) + "\noutlet = " + (parts[i].reversed ? near : far) + "\n";
    }
    return bodies + joints;
  }

  std::string text;
  Eigen::VectorXd q;
};

const std::vector<std::string> kinds{"'revolute'",
                                     "'prismatic'",
                                     "'cylindrical'",
                                     "'universal'",
                                     "'universal'\naxis2 = [1, 0.3, 0.8]",
                                     "'spherical'",
                                     "'planar'",
                                     "'free'",
                                     "'weld'",
                                     "'revolute'\nzero = { angle = 0.4 }",
                                     "'prismatic'\nzero = { displacement = -0.1 }",
                                     "'cylindrical'\nzero = { angle = -2.4, displacement = 0.3 }",
                                     "'universal'\nzero = { angle1 = 0.7, angle2 = -1.1 }",
                                     "'planar'\nzero = { x = 0.2, y = -0.3, angle = 1.9 }",
                                     "'acme.hinge'",
                                     "'acme.cylindrical'\nzero = { angle = 0.3, displacement = 0.2 }",
                                     "'acme.spherical'",
                                     "'acme.planar'",
                                     "'odd.beside'",
                                     "'odd.slide'",
                                     "'odd.oblique'"};

std::vector<Part> random_parts(Random& random) {
  std::vector<Part> parts;
  const int count = 2 + static_cast<int>(random.between(0, 5));
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<std::size_t>(random.between(0, static_cast<double>(kinds.size())));
    parts.push_back({kinds[kind], random.between(-1, 1) < 0});
  }
  return parts;
}

TEST(Loop, ClosesWhicheverWayItsJointsArePassed) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const AnyWay loop(random_parts(random), random);
    const Built built(loop.text);
    const Loops loops = loops_of(*built);
    ASSERT_EQ(loops.loops.size(), 1u);
    expect_closed(*built, loops, loop.q,
                  static_cast<double>(built->joints.size()) * of_motion);  // the last frame was computed
    if (HasFailure()) FAIL() << loop.text;
  }
}

/// The motion that a variable makes for one of its own: a turn by so many radians, a slide by so many metres.
TEST(Loop, IsOpenedByEachCoordinateAsMuchAsItIsMoved) {
  Random random(2);
  for (int trial = 0; trial < 60; ++trial) {
    const AnyWay loop(random_parts(random), random);
    const Built built(loop.text);
    const Loops loops = loops_of(*built);
    const double allowed = 3 * static_cast<double>(loops.variables.size() + 2) * of_motion;
    for (const Variable& variable : loops.variables) {
      Eigen::VectorXd delta = Eigen::VectorXd::Zero(built->nv), q = loop.q;
      const double by = random.between(0.5, 1.5);
      delta[variable.v] = by;
      integrate(*built, loop.q, delta, q);
      const Pose open = round(loops, loops.loops[0], q);
      const double far = 1.0 + reach(*built, loops.loops[0], q);
      if (variable.kind == VariableKind::slide) {
        EXPECT_LE((open.rotation - Matrix3::Identity()).norm(), allowed);
        EXPECT_NEAR(open.position.norm(), by, allowed * far);
      } else {
        EXPECT_NEAR(axial(open.rotation).norm(), std::sin(by), allowed) << "axial: the sine of the angle";
      }
    }
    if (HasFailure()) FAIL() << loop.text;
  }
}

/// The screws of a walk are derivatives: against those by a step along the imaginary axis, which loses no digits.
TEST(Loop, HasTheScrewsOfItsMotionsAsDerivative) {
  using Complex = std::complex<double>;
  constexpr double h = 1e-100;
  Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const AnyWay any(random_parts(random), random);
    const Built built(any.text);
    const Loops loops = loops_of(*built);
    const Loop& loop = loops.loops[0];
    const Eigen::VectorXd q = random_position(*built, random, 1.5);
    const auto at = places(loops.variables, q.data());
    std::vector<WayColumn<double>> columns;
    const Pose end = walk<double>(round_way(loop, loops.variables), at, &columns);
    ASSERT_EQ(columns.size(), built->nv);
    for (const WayColumn<double>& column : columns) {
      std::vector<Place<Complex>> moved(at.size());
      for (std::size_t i = 0; i < at.size(); ++i) std::copy(at[i].begin(), at[i].end(), moved[i].begin());
      Place<Complex>& place = moved[column.variable];
      switch (loops.variables[column.variable].kind) {
        case VariableKind::turn:
          place = {place[0] - Complex(0, h) * place[1], place[1] + Complex(0, h) * place[0], 0.0, 0.0};
          break;
        case VariableKind::slide: place[0] += Complex(0, h); break;
        case VariableKind::ball: {
          Vector4T<Complex> by(1.0, 0.0, 0.0, 0.0);
          by[1 + column.rate] = Complex(0, h / 2);
          const Vector4T<Complex> turned = quaternion_product<Complex>({place[0], place[1], place[2], place[3]}, by);
          std::copy(turned.data(), turned.data() + 4, place.begin());
          break;
        }
      }
      const PoseT<Complex> shifted = walk<Complex>(round_way(loop, loops.variables), moved);
      const Vector3 linear = column.velocity(end.position);
      const double allowed = 2 * static_cast<double>(loop.motions.size() + 2) * of_motion;
      EXPECT_LE((shifted.rotation.imag() / h - skew(column.angular) * end.rotation).norm(), allowed);
      EXPECT_LE((shifted.position.imag() / h - linear).norm(), allowed * (1.0 + 2 * reach(*built, loop, q)));
    }
    if (HasFailure()) FAIL() << any.text;
  }
}

// ------------------------------------------------------------------ which loops

TEST(Loop, IsTheSameOfAStrangersJoints) {
  const std::string own = shipped("rstr");
  std::string strange = own;
  for (const std::string type : {"revolute", "universal", "spherical"}) {
    strange = replaced(strange, "type = \"" + type, "type = \"acme." + type);
  }
  const Built a(own), b(strange);
  const Loops ours = loops_of(*a), theirs = loops_of(*b);
  ASSERT_EQ(ours.loops.size(), theirs.loops.size());
  const Loop &one = ours.loops[0], &other = theirs.loops[0];
  ASSERT_EQ(one.motions.size(), other.motions.size());
  EXPECT_EQ(one.joints, other.joints);
  for (std::size_t i = 0; i < one.motions.size(); ++i) {
    EXPECT_EQ(one.motions[i].variable, other.motions[i].variable);
    EXPECT_EQ(one.motions[i].inverse, other.motions[i].inverse);
    EXPECT_EQ(one.motions[i].to.rotation, other.motions[i].to.rotation);
    EXPECT_EQ(one.motions[i].to.position, other.motions[i].to.position);
  }
}

TEST(Loop, GoesThroughAFavouredJointWhereItCan) {
  const Built built(shipped("stewart"));
  const JointId leg{static_cast<std::uint32_t>(&built.joint("cardan4") - built->joints.data())};
  for (const Loop& loop : loops_of(*built, {leg, std::nullopt}).loops) {
    EXPECT_TRUE(std::find(loop.joints.begin(), loop.joints.end(), leg) != loop.joints.end());
  }
}

// The pose of a platform over its base as a joint of its own: every leg closes a loop with it, and all loops close
// where the coordinates of that joint are the pose.
TEST(Loop, GoesOverAnImaginaryJointWhereItCan) {
  Closed closed(shipped("stewart"));
  ASSERT_GE(closed.close(), 0);
  const Mechanism& mechanism = *closed.built;
  const BodyId platform = closed.built.joint("ball1").inlet.body;
  const Loops loops = loops_of(mechanism, {std::nullopt, ImaginaryJoint{ground, platform}});
  EXPECT_EQ(loops.loops.size(), mechanism.loops + 1);
  ASSERT_EQ(loops.imaginary.size(), 1u);
  for (const Loop& loop : loops.loops) {
    EXPECT_EQ(std::count(loop.joints.begin(), loop.joints.end(),
                         JointId{static_cast<std::uint32_t>(mechanism.joints.size())}),
              1);
  }
}

// Three loops in a row; the sum of any two is a loop as well, but a longer one.
TEST(Loop, IsOfLeastSize) {
  const Built built(shipped("7b10j"));
  const Loops loops = loops_of(*built);
  ASSERT_EQ(loops.loops.size(), 3u);
  std::vector<std::size_t> sizes;
  for (const Loop& loop : loops.loops) sizes.push_back(loop.joints.size());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{4, 4, 5}));
}

TEST(Loop, IsAbsentInATree) { EXPECT_TRUE(loops_of(*Built(shipped("arm2"))).loops.empty()); }

// ------------------------------------------------------------------ obstacles

void expect_obstacle(const std::string& text, const std::string& words) {
  const Built built(text);
  const LoopsOrObstacle found = find_loops(*built);
  EXPECT_EQ(found.obstacle, words);
  EXPECT_TRUE(found.loops.loops.empty());
  EXPECT_TRUE(found.loops.variables.empty());
}

TEST(Obstacle, IsAScrewWithAPitch) {
  const Built built(shipped("7h"));
  expect_obstacle(shipped("7h"), "joint " + built->joints[0].name + " is a screw with a pitch");
}

TEST(Obstacle, IsAJointWhosePitchVaries) {
  Random random(4);
  const AnyWay loop({{"'revolute'"}, {"'acme.varying_screw'\npitch = 0.2\ngrowth = 0.02"}, {"'spherical'"}}, random);
  expect_obstacle(loop.text, "joint j1 is no product of turns and slides");
}

TEST(Obstacle, IsAJointByCallbacks) {
  Random random(5);
  const AnyWay loop({{"'revolute'"}, {"'spherical'"}, {"'odd.pointing'"}}, random);
  expect_obstacle(loop.text, "joint j2 is no product of turns and slides");
}

TEST(Obstacle, IsAConstraint) {
  Random random(6);
  const AnyWay loop({{"'revolute'"}, {"'spherical'"}, {"'universal'"}, {"'revolute'"}}, random);
  expect_obstacle(loop.text +
                      "[[constraint]]\nname = 'rod'\ntype = 'distance'\nfrom = { on = 'ground', at = [1, 0, 0] }\n"
                      "to = { on = 'b2', at = [0, 1, 0] }\ndistance = 1\n",
                  "constraint rod");
}

// The same motion as that of a turn, under another name.
TEST(Obstacle, IsNoScrewWithoutPitch) {
  Random random(7);
  const AnyWay loop({{"'revolute'"}, {"'helical'\npitch = 0"}, {"'universal'"}, {"'spherical'"}}, random);
  const Built built(loop.text);
  const LoopsOrObstacle found = find_loops(*built);
  EXPECT_EQ(found.obstacle, "");
  if (!found.loops.loops.empty()) expect_closed(*built, found.loops, loop.q, 4 * of_motion);
}

}  // namespace
}  // namespace koppel::test

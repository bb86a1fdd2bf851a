// Runs of turns and slides are known for the joint that they make, and for no other; and what stays fixed in a joint
// stays fixed however it is moved.
#include "closure/cut_joint.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "closure/decompositions.hpp"
#include "closure/loop_cut.hpp"
#include "random_loop.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double least_sine = 0.3;  // of the angle between axes that cross

// Points lie within 1 of a run's origin, and as far away as it is moved and placed: within 8. A product of two poses is
// wrong by 6 eps of that; three motions take two products each to be laid out, two to be recognised and two to be
// moved, and the two frames take three more. The point where axes cross loses the sine of their angle.
constexpr double size = 8.0;
constexpr double allowed = 21 * 6 * eps * size / least_sine;

// ------------------------------------------------------------------ runs by hand

struct Motion {
  VariableKind kind = VariableKind::turn;
  Vector3 axis = Vector3::UnitZ(), point = Vector3::Zero();
};

Motion turn(const Vector3& axis, const Vector3& point) { return {VariableKind::turn, axis, point}; }

/// A run of motions, given where nothing has moved, in a loop with one ball more.
struct Sequence {
  Loop loop;
  std::vector<Variable> variables;
  std::size_t first = 0, count = 0;

  std::optional<CutJoint> joint(double length = 1.0) const { return cut_joint(loop, variables, first, count, length); }
};

/// Lays out the motions anywhere; their frames stand anywhere on their axes, and the run may go over the loop's end.
Sequence laid_out(const std::vector<Motion>& motions, Random& random) {
  Sequence run;
  run.count = motions.size();
  const std::size_t n = run.count + 1;
  run.first = static_cast<std::size_t>(random.between(0, static_cast<double>(n)));
  run.loop.motions.resize(n);
  const Pose place = random_pose(random, 1.0);
  Pose before;
  for (std::size_t i = 0; i < n; ++i) {
    const bool in_run = i < run.count;
    run.variables.push_back({in_run ? motions[i].kind : VariableKind::ball, 4 * static_cast<std::uint32_t>(i), 0, {}});
    Pose frame = random_pose(random, 1.0);
    if (in_run && motions[i].kind != VariableKind::ball) {
      const Vector3 &z = motions[i].axis, across = z.cross(random.direction()).normalized();
      frame.rotation << across, z.cross(across), z;
      frame.position = motions[i].point + random.between(-1, 1) * z;
    } else if (in_run) {
      frame.position = motions[i].point;
    }
    frame = place * frame;
    run.loop.motions[(run.first + i) % n] = {static_cast<std::uint32_t>(i), relative_pose(before, frame),
                                             random.between(-1, 1) < 0};
    before = frame;
  }
  return run;
}

/// The frame that the last motion has moved, in the one before the run, at random coordinates; and the screws.
Pose moved_at_random(const Sequence& run, Random& random, std::vector<WayColumn<double>>* screws = nullptr) {
  Pose frame;
  for (std::size_t i = 0; i < run.count; ++i) {
    const LoopMotion& motion = run.loop.motions[(run.first + i) % run.loop.motions.size()];
    frame = frame * motion.to;
    const VariableKind kind = run.variables[motion.variable].kind;
    Place<double> at{};
    const double x = random.between(-3, 3);
    if (kind == VariableKind::turn) at = {std::cos(x), std::sin(x), 0, 0};
    if (kind == VariableKind::slide) at = {x / 3, 0, 0, 0};
    if (kind == VariableKind::ball) {
      const Vector4 q = random.quaternion();
      at = {q[0], q[1], q[2], q[3]};
    }
    apply(kind, at, motion.inverse, frame);
    const Vector3 z = frame.rotation.col(2), none = Vector3::Zero();
    if (screws == nullptr) continue;
    if (kind == VariableKind::ball) {
      for (int k = 0; k < 3; ++k) screws->push_back({0, 0, Vector3::Unit(k), none, frame.position});
    } else {
      const bool turns = kind == VariableKind::turn;
      screws->push_back({0, 0, turns ? z : none, turns ? none : z, frame.position});
    }
  }
  return frame;
}

/// How many of the motions are independent where they are.
int rank(const std::vector<WayColumn<double>>& screws) {
  Eigen::MatrixXd columns(6, static_cast<Eigen::Index>(screws.size()));
  for (std::size_t i = 0; i < screws.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) << screws[i].angular,
        screws[i].along - screws[i].angular.cross(screws[i].point);
  }
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns);
  svd.setThreshold(std::sqrt(eps));  // rounding is far below, a screw that is another one at random positions above
  return static_cast<int>(svd.rank());
}

/// What both frames of a joint have in common, wherever it is moved.
void expect_same_elements(CutShape shape, const Pose& a, const Pose& b) {
  const Vector3 apart = b.position - a.position, z = a.rotation.col(2);
  const double points = apart.norm(), directions = (b.rotation.col(2) - z).norm(), off_line = z.cross(apart).norm(),
               off_plane = std::abs(z.dot(apart));
  switch (shape) {
    case CutShape::ball:
    case CutShape::cross: EXPECT_LE(points, allowed) << "the point"; break;
    case CutShape::cylinder:
      EXPECT_LE(directions, allowed) << "the line's direction";
      EXPECT_LE(off_line, allowed) << "the line";
      break;
    case CutShape::turn:
      EXPECT_LE(directions, allowed) << "the line";
      EXPECT_LE(points, allowed) << "the point";
      break;
    case CutShape::slide:
      EXPECT_LE((b.rotation - a.rotation).norm(), allowed) << "all directions";
      EXPECT_LE(off_line, allowed) << "the line";
      break;
    case CutShape::plane:
    case CutShape::turning_plane:
    case CutShape::sliding_plane:
      EXPECT_LE(directions, allowed) << "the normal";
      EXPECT_LE(off_plane, allowed) << "the plane";
      if (shape == CutShape::sliding_plane) {
        EXPECT_LE((b.rotation - a.rotation).norm(), allowed) << "all directions";
      }
      break;
  }
}

void expect_joint(const Sequence& run, const std::optional<CutShape>& shape, Random& random) {
  const std::optional<CutJoint> joint = run.joint();
  ASSERT_EQ(joint.has_value(), shape.has_value()) << (joint ? static_cast<int>(joint->shape) : -1);
  if (!joint) return;
  EXPECT_EQ(joint->shape, *shape);
  EXPECT_EQ(joint->first, run.first);
  EXPECT_EQ(joint->count, run.count);
  for (int i = 0; i < 5; ++i) {
    std::vector<WayColumn<double>> screws;
    const Pose moved = moved_at_random(run, random, &screws);
    EXPECT_EQ(joint->freedoms, rank(screws)) << "freedoms";
    expect_same_elements(joint->shape, joint->before, moved * joint->after);
  }
}

// ------------------------------------------------------------------ which runs make which joint

struct Directions {
  Vector3 u, v, w;  ///< unit vectors, any two and all three far from being dependent
  Vector3 p, q, r;  ///< points, their distances across u far from zero
};

Directions random_directions(Random& random) {
  Directions d;
  do {
    d = {random.direction(),  random.direction(),  random.direction(),
         random.vector() / 2, random.vector() / 2, random.vector() / 2};
  } while (std::abs(d.u.dot(d.v.cross(d.w))) < least_sine || d.u.cross(d.q - d.p).norm() < least_sine ||
           d.u.cross(d.r - d.q).norm() < least_sine || d.u.cross(d.r - d.p).norm() < least_sine ||
           std::abs(d.u.cross(d.v).dot(d.q - d.p)) < 0.05);
  return d;
}

Motion slide(const Vector3& axis) { return {VariableKind::slide, axis.normalized(), Vector3::Zero()}; }
Motion ball(const Vector3& point) { return {VariableKind::ball, Vector3::UnitZ(), point}; }

struct Case {
  std::string name;
  std::optional<CutShape> shape;
  std::function<std::vector<Motion>(const Directions&)> motions;
};

void PrintTo(const Case& run, std::ostream* out) { *out << run.name; }

/// Across u, in the plane of all that is across u.
Vector3 across(const Directions& d) { return d.u.cross(d.v).normalized(); }
Vector3 across_too(const Directions& d) { return d.u.cross(d.w).normalized(); }

using D = Directions;

const std::vector<Case> cases{{"turn", CutShape::turn, [](const D& d) { return std::vector{turn(d.u, d.p)}; }},
                              {"slide", CutShape::slide, [](const D& d) { return std::vector{slide(d.u)}; }},
                              {"ball", CutShape::ball, [](const D& d) { return std::vector{ball(d.p)}; }},
                              {"crossing_turns", CutShape::cross,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.v, d.p)};
                               }},
                              {"concurrent_turns", CutShape::ball,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.v, d.p), turn(d.w, d.p)};
                               }},
                              {"concurrent_turns_first_and_last_equal", CutShape::ball,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.v, d.p), turn(d.u, d.p)};
                               }},
                              {"turn_then_slide_along", CutShape::cylinder,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(d.u)};
                               }},
                              {"slide_then_turn_along", CutShape::cylinder,
                               [](const D& d) {
                                 return std::vector{slide(d.u), turn(d.u, d.p)};
                               }},
                              {"turn_then_slide_against", CutShape::cylinder,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(-d.u)};
                               }},
                              {"parallel_turns", CutShape::turning_plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.q)};
                               }},
                              {"opposite_turns", CutShape::turning_plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(-d.u, d.q)};
                               }},
                              {"turn_then_slide_across", CutShape::turning_plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(across(d))};
                               }},
                              {"slide_then_turn_across", CutShape::turning_plane,
                               [](const D& d) {
                                 return std::vector{slide(across(d)), turn(d.u, d.p)};
                               }},
                              {"slides", CutShape::sliding_plane,
                               [](const D& d) {
                                 return std::vector{slide(d.u), slide(d.v)};
                               }},
                              {"parallel_turns_three", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(-d.u, d.q), turn(d.u, d.r)};
                               }},
                              {"parallel_turns_first_and_last_coaxial", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.q), turn(d.u, d.p)};
                               }},
                              {"slides_then_turn", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{slide(across(d)), slide(across_too(d)), turn(d.u, d.p)};
                               }},
                              {"turn_then_slides", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(across(d)), slide(across_too(d))};
                               }},
                              {"turn_between_slides", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{slide(across(d)), turn(d.u, d.p), slide(across_too(d))};
                               }},
                              {"turn_between_parallel_slides", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{slide(across(d)), turn(d.u, d.p), slide(across(d))};
                               }},
                              {"slide_between_turns", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(across(d)), turn(d.u, d.q)};
                               }},
                              {"turns_then_slide", CutShape::plane,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.q), slide(across(d))};
                               }},
                              // No joint of the field.
                              {"skew_turns", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.v, d.q)};
                               }},
                              {"coaxial_turns", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.p)};
                               }},
                              {"coaxial_opposite_turns", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(-d.u, d.p)};
                               }},
                              {"parallel_slides", std::nullopt,
                               [](const D& d) {
                                 return std::vector{slide(d.u), slide(-d.u)};
                               }},
                              {"turn_and_oblique_slide", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(d.u + d.v)};
                               }},
                              {"oblique_slide_and_turn", std::nullopt,
                               [](const D& d) {
                                 return std::vector{slide(d.u + d.v), turn(d.u, d.p)};
                               }},
                              {"turn_and_ball", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), ball(d.p)};
                               }},
                              {"ball_and_slide", std::nullopt,
                               [](const D& d) {
                                 return std::vector{ball(d.p), slide(d.u)};
                               }},
                              {"balls", std::nullopt,
                               [](const D& d) {
                                 return std::vector{ball(d.p), ball(d.q)};
                               }},
                              {"concurrent_turns_first_two_equal", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.p), turn(d.w, d.p)};
                               }},
                              {"concurrent_turns_last_two_equal", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.w, d.p), turn(-d.w, d.p)};
                               }},
                              {"crossing_turns_and_one_beside", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.v, d.p), turn(d.u, d.q)};
                               }},
                              {"parallel_turns_and_a_skew_one", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.q), turn(d.v, d.r)};
                               }},
                              {"three_turns_coaxial_neighbours", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.p), turn(d.u, d.q)};
                               }},
                              {"three_slides", std::nullopt,
                               [](const D& d) {
                                 return std::vector{slide(d.u), slide(d.v), slide(d.w)};
                               }},
                              {"three_slides_in_a_plane", std::nullopt,
                               [](const D& d) {
                                 return std::vector{slide(d.u), slide(d.v), slide(d.u + d.v)};
                               }},
                              {"turn_and_parallel_slides", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(across(d)), slide(-across(d))};
                               }},
                              {"turns_and_slide_along", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.u, d.q), slide(d.u)};
                               }},
                              {"cylinder_and_turn_across", std::nullopt,
                               [](const D& d) {
                                 return std::vector{turn(d.u, d.p), slide(d.u), turn(across(d), d.p)};
                               }},
                              {"turns_and_ball", std::nullopt, [](const D& d) {
                                 return std::vector{turn(d.u, d.p), turn(d.v, d.p), ball(d.p)};
                               }}};

class RunOfMotions : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Closure, RunOfMotions, testing::ValuesIn(cases),
                         [](const auto& test) { return test.param.name; });

TEST_P(RunOfMotions, IsKnownForTheJointThatItMakes) {
  Random random(1);
  for (int trial = 0; trial < 40; ++trial) {
    const Sequence run = laid_out(GetParam().motions(random_directions(random)), random);
    expect_joint(run, GetParam().shape, random);
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

// ------------------------------------------------------------------ limits

TEST(CutJoint, IsNotMadeByNothingNorByMoreThanThereIs) {
  Random random(2);
  const Directions d = random_directions(random);
  Sequence run = laid_out({turn(d.u, d.p)}, random);
  for (const std::size_t count : {0u, 3u, 4u}) {
    EXPECT_FALSE(cut_joint(run.loop, run.variables, 0, count, 1.0)) << count;
  }
}

/// Axes that miss each other by a part of the mechanism's length.
TEST(CutJoint, CountsAxesAsCrossingToHalfTheDigits) {
  Random random(3);
  for (const double length : {0.01, 1.0, 100.0}) {
    const Directions d = random_directions(random);
    const Vector3 normal = d.u.cross(d.v).normalized();
    for (const auto& [part, crosses] : {std::pair{1e-9, true}, std::pair{1e-7, false}}) {
      const Sequence run = laid_out({turn(d.u, d.p), turn(d.v, d.p + part * length * normal)}, random);
      EXPECT_EQ(run.joint(length).has_value(), crosses) << part << " of " << length;
    }
  }
}

TEST(CutJoint, CountsAxesAsParallelToHalfTheDigits) {
  Random random(4);
  const Directions d = random_directions(random);
  for (const auto& [angle, parallel] : {std::pair{1e-9, true}, std::pair{1e-7, false}}) {
    const Vector3 near = rotation_about<double>(across(d), angle) * d.u;
    // Beside each other across the tilt: axes that are not parallel there do not meet.
    const Sequence turns = laid_out({turn(d.u, d.p), turn(near, d.p + across(d))}, random);
    EXPECT_EQ(turns.joint().has_value(), parallel) << angle;
    const Sequence cylinder = laid_out({turn(d.u, d.p), slide(near)}, random);
    EXPECT_EQ(cylinder.joint().has_value(), parallel) << angle;
  }
}

// ------------------------------------------------------------------ joints of plugins

struct PluginJoint {
  std::string type;
  std::optional<CutShape> shape;
};

/// The joint number 1 of a loop of three, as a run.
Sequence run_in_a_loop(const std::string& type, unsigned seed) {
  Random random(seed);
  const LoopJoint turning{"revolute", "", false, false, false};
  const RandomLoop text = random_loop({turning, {type, "", false, false, false}, turning}, random);
  const Built built(text.text);
  LoopsOrObstacle found = find_loops(*built);
  EXPECT_EQ(found.obstacle, "");
  Sequence run;
  run.variables = found.loops.variables;
  run.loop = found.loops.loops.at(0);
  const auto of_joint = [&](const LoopMotion& motion) { return run.variables[motion.variable].joint == JointId{1}; };
  while (!of_joint(run.loop.motions[run.first])) ++run.first;
  while (of_joint(run.loop.motions[run.first + run.count])) ++run.count;
  return run;
}

TEST(CutJoint, OfAPluginIsWhatItsMotionsMake) {
  Random random(5);
  for (const PluginJoint& joint :
       {PluginJoint{"universal", CutShape::cross}, PluginJoint{"universal'\naxis2 = [1, 0.3, 0.8] #'", CutShape::cross},
        PluginJoint{"cylindrical", CutShape::cylinder}, PluginJoint{"planar", CutShape::plane},
        PluginJoint{"spherical", CutShape::ball}, PluginJoint{"revolute", CutShape::turn},
        PluginJoint{"prismatic", CutShape::slide}, PluginJoint{"odd.beside", CutShape::cylinder},
        PluginJoint{"odd.slide", CutShape::turning_plane}, PluginJoint{"odd.along", CutShape::cylinder},
        PluginJoint{"odd.oblique", CutShape::sliding_plane}, PluginJoint{"odd.parallel", std::nullopt}}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      expect_joint(run_in_a_loop(joint.type, seed), joint.shape, random);
      if (HasFailure()) FAIL() << joint.type;
    }
  }
}

TEST(CutJoint, IsTheSameOfAStranger) {
  for (const std::string type : {"universal", "cylindrical", "planar", "spherical", "revolute", "prismatic"}) {
    const auto ours = run_in_a_loop(type, 7).joint(), theirs = run_in_a_loop("acme." + type, 7).joint();
    ASSERT_TRUE(ours && theirs) << type;
    EXPECT_EQ(ours->shape, theirs->shape) << type;
    EXPECT_EQ(ours->freedoms, theirs->freedoms) << type;
    EXPECT_EQ(ours->before.rotation, theirs->before.rotation) << type;
    EXPECT_EQ(ours->before.position, theirs->before.position) << type;
    EXPECT_EQ(ours->after.rotation, theirs->after.rotation) << type;
    EXPECT_EQ(ours->after.position, theirs->after.position) << type;
  }
}

}  // namespace
}  // namespace koppel::test

// Frames and placements against poses worked out by hand.
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "scene_reader.hpp"

namespace koppel {
namespace {

// A handful of roundings of numbers of order one.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

Matrix3 columns(const Vector3& x, const Vector3& y, const Vector3& z) {
  Matrix3 m;
  m << x, y, z;
  return m;
}

void expect_pose(const Pose& pose, const Matrix3& rotation, const Vector3& position) {
  EXPECT_LE((pose.rotation - rotation).cwiseAbs().maxCoeff(), rounding) << pose.rotation << "\nexpected\n" << rotation;
  EXPECT_LE((pose.position - position).cwiseAbs().maxCoeff(), rounding) << pose.position << "\nexpected\n" << position;
}

const Vector3 X = Vector3::UnitX(), Y = Vector3::UnitY(), Z = Vector3::UnitZ();

/// The frame `f` that the given keys describe on the body `b`.
Pose frame_of(const std::string& keys) {
  SceneReader reader;
  const Scene scene = reader.good("schema = 1\n[[body]]\nname = 'b'\n[[frame]]\nname = 'f'\non = 'b'\n" + keys);
  return scene.frames.empty() ? Pose{} : scene.frames[0].on.pose;
}

TEST(Frame, is_that_of_the_body_by_default) { expect_pose(frame_of(""), Matrix3::Identity(), Vector3::Zero()); }

TEST(Frame, has_its_origin_at_a_point) {
  expect_pose(frame_of("at = ['120 mm', 0.5, '-1 m']"), Matrix3::Identity(), {0.12, 0.5, -1.0});
}

TEST(Frame, turns_about_an_axis) {
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  expect_pose(frame_of("rotate = [['z', '30 deg']]"), columns({c, s, 0}, {-s, c, 0}, Z), Vector3::Zero());
}

TEST(Frame, turns_about_axes_as_turned_so_far) {
  // About x: y points to z, z to -y. Then about the new z, which is -y: x points to the new y, which is z.
  expect_pose(frame_of("rotate = [['x', '90 deg'], ['z', '90 deg']]"), columns(Z, -X, -Y), Vector3::Zero());
}

TEST(Frame, turns_exactly_by_quarter_turns) {
  EXPECT_EQ(frame_of("rotate = [['y', '90 deg']]").rotation, columns(-Z, Y, X));
  EXPECT_EQ(frame_of("rotate = [['y', '-90 deg']]").rotation, columns(Z, Y, -X));
  EXPECT_EQ(frame_of("rotate = [['y', '180 deg']]").rotation, columns(-X, Y, -Z));
}

TEST(Frame, takes_a_quaternion_of_any_length) {
  expect_pose(frame_of("quaternion = [2, 0, 0, 2]"), columns(Y, -X, Z), Vector3::Zero());
}

TEST(Frame, has_z_along_the_axis_and_x_near_the_x_axis_of_the_body) {
  // x without its part along z, normalised; y completes.
  const double r = std::sqrt(0.5);
  expect_pose(frame_of("axis = [1, 0, 1]"), columns({r, 0, -r}, Y, {r, 0, r}), Vector3::Zero());
  expect_pose(frame_of("axis = [0, 3, 0]"), columns(X, -Z, Y), Vector3::Zero());
}

TEST(Frame, has_x_near_the_y_axis_where_z_lies_along_x) {
  expect_pose(frame_of("axis = [2, 0, 0]"), columns(Y, Z, X), Vector3::Zero());
  expect_pose(frame_of("axis = [-2, 0, 0]"), columns(Y, -Z, -X), Vector3::Zero());
}

TEST(Frame, has_x_near_a_given_direction) {
  expect_pose(frame_of("axis = [0, 0, 1]\nx_axis = [0, 1, 5]"), columns(Y, -X, Z), Vector3::Zero());
  expect_pose(frame_of("x_axis = [0, -1, 0]"), columns(-Y, X, Z), Vector3::Zero());
}

TEST(Frame, is_orthonormal_however_it_is_given) {
  for (const char* keys :
       {"rotate = [['x', 0.3], ['y', -1.2], ['z', 2.5], ['x', 7]]", "axis = [0.1, -0.7, 0.3]\nx_axis = [1e-5, 2, 3]",
        "quaternion = [0.3, -0.2, 0.9, 1e-3]", "axis = [1, 1e-8, 0]", "axis = [1e200, 2e200, 0]"}) {
    const Matrix3 r = frame_of(keys).rotation;
    EXPECT_LE((r.transpose() * r - Matrix3::Identity()).cwiseAbs().maxCoeff(), rounding) << keys;
    EXPECT_GT(r.col(0).cross(r.col(1)).dot(r.col(2)), 0.0) << keys;
  }
}

const std::string two_bodies =
    "schema = 1\n[[body]]\nname = 'a'\nat = [1, 2, 3]\nrotate = [['z', '90 deg']]\n[[body]]\nname = 'b'\nat = [0, 0, "
    "5]\n";

TEST(Joint, between_bodies_sits_in_the_world_at_the_design_position) {
  SceneReader reader;
  const Scene scene =
      reader.good(two_bodies +
                  "[[joint]]\nname = 'j'\ntype = 'revolute'\nbetween = ['a', 'b']\nat = [1, 3, 3]\naxis = [0, 1, 0]\n");
  ASSERT_GE(scene.joints.size(), 1u);
  const JointDescription& joint = scene.joints[0];
  // World axes of the joint: z = Y, x = X, y = -Z. Body a has its x axis along Y and its y axis along -X.
  EXPECT_EQ(joint.inlet.body, BodyId{1});
  expect_pose(joint.inlet.pose, columns(-Y, -Z, X), X);
  EXPECT_EQ(joint.outlet.body, BodyId{2});
  expect_pose(joint.outlet.pose, columns(X, -Z, Y), {1, 3, -2});
}

TEST(Joint, between_bodies_has_the_world_z_axis_by_default) {
  SceneReader reader;
  const Scene scene = reader.good(two_bodies + "[[joint]]\nname = 'j'\ntype = 'revolute'\nbetween = ['ground', 'b']\n");
  expect_pose(scene.joints.at(0).inlet.pose, Matrix3::Identity(), Vector3::Zero());
  expect_pose(scene.joints.at(0).outlet.pose, Matrix3::Identity(), {0, 0, -5});
}

TEST(Joint, between_frames_takes_names_bodies_and_descriptions) {
  SceneReader reader;
  const Scene scene = reader.good(two_bodies +
                                  "[[joint]]\nname = 'j'\ntype = 'revolute'\ninlet = 'later'\noutlet = 'b'\n"
                                  "[[joint]]\nname = 'k'\ntype = 'revolute'\ninlet = {on = 'ground', at = [1, 0, 0], "
                                  "axis = [1, 0, 0]}\noutlet = 'a'\n"
                                  "[[frame]]\nname = 'later'\non = 'a'\nat = [0, 0, 7]\n");
  EXPECT_EQ(scene.joints.at(0).inlet.body, BodyId{1});
  expect_pose(scene.joints.at(0).inlet.pose, Matrix3::Identity(), {0, 0, 7});
  expect_pose(scene.joints.at(0).outlet.pose, Matrix3::Identity(), Vector3::Zero());
  EXPECT_EQ(scene.joints.at(1).inlet.body, ground);
  expect_pose(scene.joints.at(1).inlet.pose, columns(Y, Z, X), X);
}

std::vector<double> axis2(const std::string& placement) {
  SceneReader reader;
  const Scene scene = reader.good(two_bodies + "[[joint]]\nname = 'j'\ntype = 'universal'\n" + placement);
  return scene.joints.at(0).values.at(0).numbers;
}

TEST(Directions_of_a_joint, are_given_like_its_axis_and_kept_in_inlet_axes) {
  // Joint axes in the world: z = Y, x = X, y = -Z.
  const auto world = axis2("between = ['a', 'b']\naxis = [0, 1, 0]\naxis2 = [0, 0, 2]\n");
  ASSERT_EQ(world.size(), 3u);
  EXPECT_LE((Vector3(world[0], world[1], world[2]) - Vector3(0, -1, 0)).norm(), rounding);
  const auto inlet = axis2("inlet = {on = 'a', axis = [0, 1, 0]}\noutlet = 'b'\naxis2 = [0, 2, 0]\n");
  EXPECT_EQ(inlet, (std::vector<double>{0, 1, 0}));
  // The fallback, x of the inlet, is the plugin's and not turned.
  EXPECT_EQ(axis2("between = ['a', 'b']\naxis = [0, 1, 0]\n"), (std::vector<double>{1, 0, 0}));
}

}  // namespace
}  // namespace koppel

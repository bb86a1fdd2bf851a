// What becomes of bodies, joints, constraints, forces, drives, records and settings of the simulation.
#include <cmath>
#include <numbers>

#include "scene_reader.hpp"

namespace koppel {
namespace {

const std::string chain =
    "schema = 1\n"
    "[[joint]]\nname = 'first'\ntype = 'revolute'\nbetween = ['ground', 'a']\n"
    "[[joint]]\nname = 'second'\ntype = 'cylindrical'\nbetween = ['a', 'b']\n"
    "[[joint]]\nname = 'ball'\ntype = 'spherical'\nbetween = ['b', 'c']\n"
    "[[body]]\nname = 'a'\n[[body]]\nname = 'b'\n[[body]]\nname = 'c'\n";

const Value& value_of(const std::vector<Parameter>& schema, const std::vector<Value>& values, std::string_view name) {
  for (std::size_t i = 0; i < schema.size(); ++i) {
    if (schema[i].name == name) return values.at(i);
  }
  ADD_FAILURE() << "no parameter " << name;
  return values.at(0);
}

TEST(Body, has_the_values_of_its_type) {
  SceneReader reader;
  const Scene scene =
      reader.good("schema = 1\n[[body]]\nname = 'a'\nmass = '250 g'\ncentre_of_mass = [1, '2 mm', 3]\n");
  const BodyDescription& body = scene.bodies.at(1);
  ASSERT_NE(body.type, nullptr);
  EXPECT_EQ(body.type->name, "rigid");
  const auto& schema = body.type->parameters;
  EXPECT_TRUE(value_of(schema, body.values, "mass").given);
  EXPECT_EQ(value_of(schema, body.values, "mass").numbers, std::vector<double>{0.25});
  EXPECT_EQ(value_of(schema, body.values, "centre_of_mass").numbers, (std::vector<double>{1, 0.002, 3}));
  EXPECT_EQ(value_of(schema, body.values, "centre_of_mass").count, 3u);
  EXPECT_FALSE(value_of(schema, body.values, "inertia").given);
  EXPECT_EQ(value_of(schema, body.values, "inertia").count, 6u);
}

TEST(Joint, may_name_bodies_that_come_later) {
  SceneReader reader;
  const Scene scene = reader.good(chain);
  ASSERT_EQ(scene.joints.size(), 3u);
  EXPECT_EQ(scene.joints[0].inlet.body, ground);
  EXPECT_EQ(scene.joints[0].outlet.body, BodyId{1});
  EXPECT_EQ(scene.joints[2].outlet.body, BodyId{3});
}

TEST(Joint, has_settings_for_each_coordinate) {
  SceneReader reader;
  const Scene scene = reader.good(
      "schema = 1\n[[body]]\nname = 'a'\n"
      "[[joint]]\nname = 'c'\ntype = 'cylindrical'\nbetween = ['ground', 'a']\n"
      "zero = { angle = '60 deg' }\nstart = { displacement = '5 mm' }\nlimits = { angle = ['-20 deg', '80 deg'] }\n");
  const auto& coordinates = scene.joints.at(0).coordinates;
  ASSERT_EQ(coordinates.size(), 2u);
  EXPECT_DOUBLE_EQ(coordinates[0].zero, std::numbers::pi / 3);
  EXPECT_FALSE(coordinates[0].start.has_value());
  ASSERT_TRUE(coordinates[0].limits.has_value());
  EXPECT_DOUBLE_EQ((*coordinates[0].limits)[0], -std::numbers::pi / 9);
  EXPECT_EQ(coordinates[1].zero, 0.0);
  EXPECT_EQ(coordinates[1].start, std::vector<double>{0.005});
  EXPECT_FALSE(coordinates[1].limits.has_value());
}

TEST(Joint, has_a_normalised_quaternion_to_start_with) {
  SceneReader reader;
  const Scene scene = reader.good(
      "schema = 1\n[[body]]\nname = 'a'\n[[joint]]\nname = 'b'\ntype = 'spherical'\nbetween = ['ground', 'a']\n"
      "start = { rotation = [3, 0, 4, 0] }\n");
  const auto& start = scene.joints.at(0).coordinates.at(0).start;
  ASSERT_TRUE(start.has_value());
  ASSERT_EQ(start->size(), 4u);
  EXPECT_DOUBLE_EQ((*start)[0], 0.6);
  EXPECT_DOUBLE_EQ((*start)[2], 0.8);
}

TEST(Constraint, has_frames_or_coordinates) {
  SceneReader reader;
  const Scene scene = reader.good(
      chain +
      "[[constraint]]\nname = 'rod'\ntype = 'distance'\nfrom = {on = 'ground', at = [1, 0, 0]}\nto = 'c'\ndistance = "
      "2\n"
      "[[constraint]]\nname = 'gear'\ntype = 'coupling'\ncoordinates = ['first.angle', 'second.displacement']\n"
      "factors = [1, '2/3']\n");
  ASSERT_EQ(scene.constraints.size(), 2u);
  const ConstraintDescription& rod = scene.constraints[0];
  ASSERT_EQ(rod.frames.size(), 2u);
  EXPECT_EQ(rod.frames[0].body, ground);
  EXPECT_EQ(rod.frames[0].pose.position, Vector3(1, 0, 0));
  EXPECT_EQ(rod.frames[1].body, BodyId{3});
  const ConstraintDescription& gear = scene.constraints[1];
  ASSERT_EQ(gear.coordinates.size(), 2u);
  EXPECT_EQ(gear.coordinates[1].joint, JointId{1});
  EXPECT_EQ(gear.coordinates[1].block, 1u);
  EXPECT_EQ(value_of(gear.type->parameters, gear.values, "coordinates").count, 2u);
  EXPECT_EQ(value_of(gear.type->parameters, gear.values, "factors").numbers, (std::vector<double>{1.0, 2.0 / 3.0}));
}

TEST(Joint, has_rates_to_start_with) {
  SceneReader reader;
  const Scene scene = reader.good(chain +
                                  "[[joint]]\nname = 'more'\ntype = 'free'\nbetween = ['ground', 'd']\n"
                                  "start_rate = { rotation = [1, '90 deg', 3], y = '2 mm' }\n[[body]]\nname = 'd'\n");
  const auto& coordinates = scene.joints.at(3).coordinates;
  EXPECT_EQ(coordinates.at(0).start_rate, (std::vector<double>{1, std::numbers::pi / 2, 3}));
  EXPECT_FALSE(coordinates.at(1).start_rate.has_value());
  EXPECT_EQ(coordinates.at(2).start_rate, std::vector<double>{0.002});
  EXPECT_FALSE(coordinates.at(2).start.has_value());
}

TEST(Force, acts_on_frames_or_coordinates) {
  SceneReader reader;
  const Scene scene =
      reader.good(chain +
                  "[[force]]\nname = 'pull'\ntype = 'spring'\nfrom = 'ground'\nto = {on = 'c', at = [1, 0, 0]}\n"
                  "stiffness = 5\ntable = [[0, 0], ['1 mm', 2]]\n"
                  "[[force]]\nname = 'wind'\ntype = 'wrench'\non = 'b'\naxes = 'world'\nforce = [1, 2, 3]\n"
                  "[[force]]\nname = 'turn'\ntype = 'coordinate_spring'\nof = 'second.displacement'\nfree = '3 mm'\n");
  ASSERT_EQ(scene.forces.size(), 3u);
  const ForceDescription& pull = scene.forces[0];
  EXPECT_EQ(pull.name, "pull");
  ASSERT_EQ(pull.frames.size(), 2u);
  EXPECT_EQ(pull.frames[0].body, ground);
  EXPECT_EQ(pull.frames[1].body, BodyId{3});
  EXPECT_EQ(value_of(pull.type->parameters, pull.values, "table").numbers, (std::vector<double>{0, 0, 0.001, 2}));
  const ForceDescription& wind = scene.forces[1];
  ASSERT_EQ(wind.frames.size(), 1u);
  EXPECT_EQ(wind.frames[0].body, BodyId{2});
  EXPECT_EQ(value_of(wind.type->parameters, wind.values, "against").count, 0u);
  EXPECT_EQ(value_of(wind.type->parameters, wind.values, "axes").text, "world");
  const ForceDescription& turn = scene.forces[2];
  EXPECT_TRUE(turn.frames.empty());
  ASSERT_EQ(turn.coordinates.size(), 1u);
  EXPECT_EQ(turn.coordinates[0].joint, JointId{1});
  EXPECT_EQ(turn.coordinates[0].block, 1u);
  EXPECT_EQ(value_of(turn.type->parameters, turn.values, "free").numbers, std::vector<double>{0.003});
}

TEST(Simulation, chooses_for_itself_unless_it_is_told) {
  SceneReader reader;
  const SimulationDescription silent = reader.good("schema = 1\n").simulation;
  EXPECT_FALSE(silent.tolerance.has_value());
  EXPECT_FALSE(silent.step.has_value());
  const SimulationDescription told =
      reader.good("schema = 1\n[simulation]\ntolerance = 1e-6\nstep = '2 ms'\n").simulation;
  EXPECT_EQ(told.tolerance, 1e-6);
  EXPECT_EQ(told.step, 0.002);
  EXPECT_EQ(told.integrator, "");
  EXPECT_EQ(reader.good("schema = 1\n[simulation]\nintegrator = 'dop853'\n").simulation.integrator, "dop853");
}

TEST(Drive, is_named_like_its_coordinate) {
  SceneReader reader;
  const Scene scene =
      reader.good(chain +
                  "[[drive]]\nof = 'second.displacement'\ntype = 'table'\npoints = [[0, 0], ['1 s', 2]]\n"
                  "[[drive]]\nname = 'motor'\nof = 'first.angle'\ntype = 'constant'\nvalue = '1 deg'\n");
  ASSERT_EQ(scene.drives.size(), 2u);
  EXPECT_EQ(scene.drives[0].name, "second.displacement");
  EXPECT_EQ(scene.drives[0].of.joint, JointId{1});
  EXPECT_EQ(scene.drives[0].of.block, 1u);
  EXPECT_EQ(scene.drives[0].values.at(0).numbers, (std::vector<double>{0, 0, 1, 2}));
  EXPECT_EQ(scene.drives[1].name, "motor");
}

TEST(Record, is_of_coordinates_joints_and_frames) {
  SceneReader reader;
  const Scene scene = reader.good(chain +
                                  "[[record]]\nof = 'second.displacement'\nquantity = 'rate'\n"
                                  "[[record]]\nof = 'ball'\nquantity = 'cardan'\n"
                                  "[[record]]\nof = 'c'\n"
                                  "[[record]]\nname = 'tip'\nof = { on = 'c', at = [0, 0, 1] }\nquantity = 'velocity'\n"
                                  "[[record]]\nof = 'ball.rotation'\n");
  ASSERT_EQ(scene.records.size(), 5u);
  EXPECT_EQ(scene.records[0].name, "second.displacement.rate");
  EXPECT_EQ(scene.records[0].subject, RecordSubject::coordinate);
  EXPECT_EQ(scene.records[0].quantity, Quantity::rate);
  EXPECT_EQ(scene.records[0].joint, JointId{1});
  EXPECT_EQ(scene.records[0].block, 1u);
  EXPECT_EQ(scene.records[1].subject, RecordSubject::joint_cardan);
  EXPECT_EQ(scene.records[1].joint, JointId{2});
  EXPECT_EQ(scene.records[2].name, "c");
  EXPECT_EQ(scene.records[2].subject, RecordSubject::frame);
  EXPECT_EQ(scene.records[2].quantity, Quantity::position);
  EXPECT_EQ(scene.records[2].frame.body, BodyId{3});
  EXPECT_EQ(scene.records[3].name, "tip");
  EXPECT_EQ(scene.records[3].quantity, Quantity::velocity);
  EXPECT_EQ(scene.records[3].frame.pose.position, Vector3(0, 0, 1));
  EXPECT_EQ(scene.records[4].quantity, Quantity::value);
}

TEST(Record, by_a_driven_coordinate_is_named_after_it) {
  SceneReader reader;
  const Scene scene = reader.good(chain +
                                  "[[drive]]\nof = 'first.angle'\ntype = 'constant'\nvalue = 1\n"
                                  "[[record]]\nof = 'second.angle'\nquantity = 'rate'\nby = 'first.angle'\n"
                                  "[[record]]\nof = 'second.angle'\nquantity = 'rate'\n");
  ASSERT_EQ(scene.records.size(), 2u);
  EXPECT_EQ(scene.records[0].name, "second.angle.rate/first.angle");
  EXPECT_EQ(scene.records[0].by, (CoordinateReference{JointId{0}, 0}));
  EXPECT_EQ(scene.records[1].name, "second.angle.rate");
  EXPECT_FALSE(scene.records[1].by.has_value());
}

TEST(Record, of_an_axode_is_against_the_world_or_a_frame) {
  SceneReader reader;
  const Scene scene = reader.good(chain +
                                  "[[record]]\nof = 'c'\nquantity = 'fixed_axode'\n"
                                  "[[record]]\nof = 'c'\nquantity = 'moving_axode'\nagainst = 'a'\n");
  ASSERT_EQ(scene.records.size(), 2u);
  EXPECT_EQ(scene.records[0].quantity, Quantity::fixed_axode);
  EXPECT_FALSE(scene.records[0].against.has_value());
  EXPECT_EQ(scene.records[1].quantity, Quantity::moving_axode);
  ASSERT_TRUE(scene.records[1].against.has_value());
  EXPECT_EQ(scene.records[1].against->body, BodyId{1});
}

TEST(Record, of_cardan_angles_is_of_the_joint_if_body_and_joint_have_one_name) {
  SceneReader reader;
  const Scene scene = reader.good(
      "schema = 1\n[[body]]\nname = 'a'\n[[joint]]\nname = 'a'\ntype = 'spherical'\nbetween = ['ground', 'a']\n"
      "[[record]]\nof = 'a'\nquantity = 'cardan'\n[[record]]\nof = 'a'\n");
  EXPECT_EQ(scene.records.at(0).subject, RecordSubject::joint_cardan);
  EXPECT_EQ(scene.records.at(1).subject, RecordSubject::frame);
}

TEST(Record, of_all_coordinates_where_the_scene_has_none) {
  SceneReader reader;
  const Scene scene = reader.good(chain);
  std::vector<std::string> names;
  for (const RecordDescription& record : scene.records) names.push_back(record.name);
  EXPECT_EQ(names, (std::vector<std::string>{"first.angle", "second.angle", "second.displacement", "ball.rotation"}));
}

TEST(Floating_bodies, get_one_free_joint_for_each_component) {
  SceneReader reader;
  const Scene scene = reader.good(
      "schema = 1\n[[body]]\nname = 'fixed'\n[[body]]\nname = 'b'\nat = [1, 2, 3]\n[[body]]\nname = 'c'\n"
      "[[body]]\nname = 'd'\n"
      "[[joint]]\nname = 'j'\ntype = 'weld'\nbetween = ['fixed', 'ground']\n"
      "[[joint]]\nname = 'k'\ntype = 'weld'\nbetween = ['c', 'b']\n");
  ASSERT_EQ(scene.joints.size(), 4u);
  const JointDescription& free = scene.joints[2];
  EXPECT_EQ(free.name, "b.free");
  EXPECT_EQ(free.type->name, "free");
  EXPECT_EQ(free.inlet.body, ground);
  EXPECT_EQ(free.inlet.pose.position, Vector3(1, 2, 3));
  EXPECT_EQ(free.outlet.body, BodyId{2});
  EXPECT_EQ(free.outlet.pose.position, Vector3::Zero());
  EXPECT_EQ(scene.joints[3].name, "d.free");
  const auto notes = reader.of(Severity::note);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].code, Code::free_joint_added);
  EXPECT_EQ(notes[0].source.line, 4);
}

}  // namespace
}  // namespace koppel

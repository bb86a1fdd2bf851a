// Recorded outputs that are not there by themselves: transfer functions and screw axes.
#include "closure/recording.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "closed.hpp"
#include "spatial/quaternion.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double degree = 0.017453292519943295;

std::string record(const std::string& of, const std::string& quantity, const std::string& more = "") {
  return "[[record]]\nof = '" + of + "'\nquantity = '" + quantity + "'\n" + more;
}

/// A shipped scene with other records than its own, in motion.
struct Recorded : Closed {
  Recorded(const std::string& scene, const std::string& records, const Replacements& replacements = {})
      : Closed(without_records(shipped(scene, replacements)) + records), values(built->record_columns.size()) {}

  static std::string without_records(const std::string& text) {
    const std::size_t first = text.find("[[record]]");
    return first == std::string::npos ? text : text.substr(0, first);
  }
  koppel_status take() { return evaluate_recording(work, state, nullptr, values.data()); }
  double operator[](const std::string& column) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (built->record_columns[i].name == column) return values[i];
    }
    throw std::runtime_error("no column " + column);
  }
  Vector3 vector(const std::string& name, const char* const (&suffixes)[3]) const {
    return {(*this)[name + suffixes[0]], (*this)[name + suffixes[1]], (*this)[name + suffixes[2]]};
  }
  Vector3 vector(const std::string& name) const { return vector(name, {".x", ".y", ".z"}); }
  Vector3 direction(const std::string& name) const { return vector(name, {".ux", ".uy", ".uz"}); }
  std::string unit(const std::string& column) const {
    for (const RecordColumn& c : built->record_columns) {
      if (c.name == column) return c.unit;
    }
    return "none";
  }

  std::vector<double> values;
};

/// The joints of a scene with one drive: what they do by it, and by time.
struct DrivenScene {
  const char* scene;
  const char* drive;
  std::vector<const char*> angles;
};

class TransferFunctions : public testing::TestWithParam<DrivenScene> {};

TEST_P(TransferFunctions, TimesTheSpeedOfTheDriveAreRates) {
  const std::string by = "by = '" + std::string(GetParam().drive) + "'\n";
  std::string records = record(GetParam().drive, "rate") + record(GetParam().drive, "acceleration");
  for (const std::string angle : GetParam().angles) {
    for (const std::string quantity : {"rate", "acceleration"}) {
      records += record(angle, quantity) + record(angle, quantity, by);
    }
  }
  Recorded scene(GetParam().scene, records);
  const std::string drive = GetParam().drive;
  for (const double time : {0.0, 0.02, 0.04, 0.06, 0.08}) {
    ASSERT_GE(scene.move(time), 0);
    ASSERT_EQ(scene.take(), KOPPEL_OK);
    const double speed = scene[drive + ".rate"], change = scene[drive + ".acceleration"];
    for (const std::string angle : GetParam().angles) {
      const double first = scene[angle + ".rate/" + drive], second = scene[angle + ".acceleration/" + drive];
      // Both solve with the same factorisation: rounding times its condition, and of rates that others cancel.
      const double rounding = 100.0 * eps * std::max(10.0, scene.report.condition);
      const double most = std::max(1.0, std::abs(first));
      EXPECT_NEAR(first * speed, scene[angle + ".rate"], rounding * most * std::abs(speed)) << angle;
      EXPECT_NEAR(second * speed * speed + first * change, scene[angle + ".acceleration"],
                  10.0 * rounding * std::max(1.0, std::abs(second)) * (speed * speed + std::abs(change)))
          << angle;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, TransferFunctions,
                         testing::Values(DrivenScene{"4bar", "crank.angle", {"rocker.angle", "crank_pin.angle"}},
                                         DrivenScene{"rstr", "crank.angle", {"rocker.angle", "cardan.angle1"}},
                                         DrivenScene{"rccc", "crank.angle", {"joint2.angle", "joint4.displacement"}},
                                         DrivenScene{"slidercrank", "crank.angle", {"slider.displacement"}}),
                         [](const auto& tested) { return std::string("scene_") + tested.param.scene; });

// X-RSTR at 30 degrees: the worked example's numbers. The drive stands still: they do not need its speed.
TEST(TransferFunction, OfTheSpatialFourBarIsThatOfTheBookAtAnySpeed) {
  const std::string by = "by = 'crank.angle'\n";
  Recorded scene("rstr", record("rocker.angle", "rate", by) + record("rocker.angle", "acceleration", by));
  scene.state.input[0] = 30.0 * degree;
  scene.state.input_rate[0] = 0.0;
  ASSERT_GE(scene.close(), 0);
  ASSERT_EQ(scene.take(), KOPPEL_OK);
  EXPECT_NEAR(scene["rocker.angle.rate/crank.angle"], 0.187424547, 0.5e-9);
  EXPECT_NEAR(scene["rocker.angle.acceleration/crank.angle"], 0.606387222, 0.5e-9);
  EXPECT_EQ(scene.unit("rocker.angle.rate/crank.angle"), "rad/rad");
  EXPECT_EQ(scene.unit("rocker.angle.acceleration/crank.angle"), "rad/rad^2");
}

TEST(TransferFunction, LeavesTheStateAsItIs) {
  Recorded scene("4bar", record("rocker.angle", "rate", "by = 'crank.angle'\n"));
  ASSERT_GE(scene.move(0.125), 0);
  const State before = scene.state;
  ASSERT_EQ(scene.take(), KOPPEL_OK);
  EXPECT_TRUE(same_bits(before, scene.state));
}

// The crank and the rod in line: the slider stands at its end, and no speed of it is possible.
TEST(TransferFunction, ByADriveAtADeadCentreIsNotANumber) {
  const std::string text =
      "[scene]\nlength = 1\n[[body]]\nname = 'crank'\n[[body]]\nname = 'rod'\n[[body]]\nname = 'slider'\n"
      "[[joint]]\nname = 'crank'\ntype = 'revolute'\nbetween = ['ground', 'crank']\nat = [0, 0, 0]\n"
      "[[joint]]\nname = 'pin'\ntype = 'revolute'\nbetween = ['crank', 'rod']\nat = [1, 0, 0]\n"
      "[[joint]]\nname = 'wrist'\ntype = 'revolute'\nbetween = ['rod', 'slider']\nat = [4, 0, 0]\n"
      "[[joint]]\nname = 'guide'\ntype = 'prismatic'\nbetween = ['ground', 'slider']\nat = [4, 0, 0]\naxis = [1, 0, "
      "0]\n"
      "[[drive]]\nof = 'guide.displacement'\ntype = 'constant'\nvalue = 0\n" +
      record("crank.angle", "rate", "by = 'guide.displacement'\n") + record("crank.angle", "value");
  Closed scene(text);
  ASSERT_GE(scene.close(), 0);
  std::vector<double> values(2, 0.0);
  ASSERT_EQ(evaluate_recording(scene.work, scene.state, nullptr, values.data()), KOPPEL_OK);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_NEAR(values[1], 0.0, 1e-7);
}

TEST(TransferFunction, NeedsAClosedState) {
  Recorded scene("4bar", record("rocker.angle", "rate", "by = 'crank.angle'\n"));
  EXPECT_EQ(scene.take(), KOPPEL_INVALID_ARGUMENT);
}

// X-4BAR at 60 degrees.
TEST(Axode, OfTheCouplerPassesThroughThePoleOfTheBook) {
  Recorded scene("4bar", record("coupler", "fixed_axode"));
  scene.state.input[0] = 60.0 * degree;
  scene.state.input_rate[0] = -1.0;
  ASSERT_GE(scene.close(), 0);
  ASSERT_EQ(velocities(scene.work, scene.state), KOPPEL_OK);
  ASSERT_EQ(scene.take(), KOPPEL_OK);
  EXPECT_LE((scene.vector("coupler.fixed_axode") - Vector3(0.347939080, 0.602648164, 0.0)).norm(), 1e-9);
  // The coupler turns against the crank: -0.208 times its speed.
  EXPECT_LE((scene.direction("coupler.fixed_axode") - Vector3::UnitZ()).norm(), 8.0 * eps);
  EXPECT_NEAR(scene["coupler.fixed_axode.pitch"], 0.0, 1e-15);
  EXPECT_EQ(scene.unit("coupler.fixed_axode.uz"), "1");
  EXPECT_EQ(scene.unit("coupler.fixed_axode.pitch"), "m/rad");
}

// Kennedy, Aronhold: the poles of three bodies against each other lie on one line.
TEST(Axode, ThreePolesLieOnALine) {
  Recorded scene("4bar",
                 record("coupler", "fixed_axode") + record("rocker", "fixed_axode") +
                     "[[record]]\nname = 'between'\nof = 'coupler'\nquantity = 'fixed_axode'\nagainst = 'rocker'\n" +
                     record("rocker", "position") + record("rocker", "quaternion"));
  for (const double time : {0.05, 0.1, 0.3, 0.7}) {
    ASSERT_GE(scene.move(time), 0);
    ASSERT_EQ(scene.take(), KOPPEL_OK);
    const Vector3 a = scene.vector("coupler.fixed_axode"), b = scene.vector("rocker.fixed_axode");
    const Vector4 q(scene["rocker.quaternion.w"], scene["rocker.quaternion.x"], scene["rocker.quaternion.y"],
                    scene["rocker.quaternion.z"]);
    const Vector3 c = scene.vector("rocker.position") + rotation_of_quaternion<double>(q) * scene.vector("between");
    const double apart = (b - a).norm();
    EXPECT_LE((b - a).cross(c - a).norm(), 1e3 * eps * std::max(1.0, apart * apart)) << time;
  }
}

// Where points of the body go along the axis, with pitch times angular velocity; and from the body it is the same line.
TEST(Axode, OfASpatialCouplerIsTheLineAlongWhichItsPointsMove) {
  Recorded scene("rstr", record("coupler", "fixed_axode") + record("coupler", "moving_axode") +
                             record("coupler", "position") + record("coupler", "quaternion") +
                             record("coupler", "velocity") + record("coupler", "angular_velocity"));
  for (const double time : {0.0, 0.1, 0.25, 0.6}) {
    ASSERT_GE(scene.move(time), 0);
    ASSERT_EQ(scene.take(), KOPPEL_OK);
    const Vector3 point = scene.vector("coupler.fixed_axode"), along = scene.direction("coupler.fixed_axode");
    const Vector3 origin = scene.vector("coupler.position"), omega = scene.vector("coupler.angular_velocity");
    const double far = 1.0 + (point - origin).norm(), rounding = 100.0 * eps * far;
    const Vector3 velocity = scene.vector("coupler.velocity") + omega.cross(point - origin);
    EXPECT_LE((velocity - scene["coupler.fixed_axode.pitch"] * omega).norm(), rounding * omega.norm());
    EXPECT_LE((along - omega.normalized()).norm(), 8.0 * eps);
    EXPECT_NEAR(point.dot(along), 0.0, rounding);
    const Vector4 q(scene["coupler.quaternion.w"], scene["coupler.quaternion.x"], scene["coupler.quaternion.y"],
                    scene["coupler.quaternion.z"]);
    const Matrix3 r = rotation_of_quaternion<double>(q);
    EXPECT_LE((r * scene.direction("coupler.moving_axode") - along).norm(), 16.0 * eps);
    const Vector3 seen = origin + r * scene.vector("coupler.moving_axode");
    EXPECT_LE((seen - point).cross(along).norm(), rounding);
    EXPECT_NEAR(scene["coupler.moving_axode.pitch"], scene["coupler.fixed_axode.pitch"], rounding);
  }
}

TEST(Axode, IsNowhereAtRestAndFarInATranslation) {
  Recorded scene("slidercrank", record("slider", "fixed_axode"));
  ASSERT_GE(scene.move(0.1), 0);
  ASSERT_EQ(scene.take(), KOPPEL_OK);
  EXPECT_TRUE(std::isnan(scene["slider.fixed_axode.x"]));
  EXPECT_NEAR(scene.direction("slider.fixed_axode").norm(), 1.0, 4.0 * eps);
  EXPECT_TRUE(std::isinf(scene["slider.fixed_axode.pitch"]));
  scene.state.input_rate.setZero();
  ASSERT_EQ(velocities(scene.work, scene.state), KOPPEL_OK);
  ASSERT_EQ(scene.take(), KOPPEL_OK);
  for (const double value : scene.values) EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace koppel::test

// Linear equations of motion, eigenvalues and modes against closed forms; the errors told bound the true ones.
#include "dynamics/linearisation.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "folders.hpp"
#include "four_bar.hpp"
#include "resting.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

std::string scene(const std::string& name) {
  std::ifstream file(scenes_folder() + "/dynamics/" + name + ".toml");
  EXPECT_TRUE(file) << name;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The eigenvalue is there within the error told, which is small.
void expect_eigenvalue(const Linearisation& linear, std::size_t i, const Complex& known, double small = 1e-9) {
  ASSERT_LT(i, linear.modes.size());
  const NaturalMode& mode = linear.modes[i];
  EXPECT_LE(std::abs(mode.eigenvalue - known), mode.error + 4 * eps * std::abs(known)) << mode.eigenvalue;
  EXPECT_LT(mode.error, small * std::abs(known));
}

/// Pairs of undamped frequencies [rad/s], ascending.
void expect_frequencies(const Linearisation& linear, const std::vector<double>& known) {
  ASSERT_EQ(linear.modes.size(), 2 * known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    expect_eigenvalue(linear, 2 * i, {0.0, known[i]});
    expect_eigenvalue(linear, 2 * i + 1, {0.0, -known[i]});
  }
}

TEST(Linearisation, PendulumSwingsAndFalls) {
  const double rate = std::sqrt(9.81 / 0.5);
  const Linearisation hanging = Started(pendulum("'-90 deg'")).linear();
  EXPECT_EQ(hanging.course, Course::resting);
  expect_frequencies(hanging, {rate});
  EXPECT_NEAR(hanging.mass(0, 0), 0.5, 4 * eps);
  EXPECT_NEAR(hanging.stiffness.value(0, 0), 9.81, hanging.stiffness.error(0, 0));
  EXPECT_LT(hanging.stiffness.error(0, 0), 1e-10);

  const Linearisation upright = Started(pendulum("'90 deg'")).linear();
  EXPECT_EQ(upright.course, Course::resting);
  ASSERT_EQ(upright.modes.size(), 2u);
  double sum = 0.0;
  for (const NaturalMode& mode : upright.modes) {
    sum += mode.eigenvalue.real();
    EXPECT_NEAR(std::abs(mode.eigenvalue.real()), rate, mode.error + 4 * eps * rate);
    EXPECT_EQ(mode.eigenvalue.imag(), 0.0);
  }
  EXPECT_NEAR(sum, 0.0, 2 * upright.modes[0].error);

  const Linearisation tilted = Started(pendulum("0.0")).linear();
  EXPECT_EQ(tilted.course, Course::unsteady);
  EXPECT_NEAR(tilted.drift, 9.81 / 0.5, 1e2 * eps);
}

TEST(Linearisation, DoublePendulum) {
  Started pendulums(scene("double_pendulum"));
  pendulums.take(pendulums.found());
  const Linearisation linear = pendulums.linear();
  const double square = std::sqrt(2.0);
  expect_frequencies(linear, {std::sqrt(9.81 * (2.0 - square)), std::sqrt(9.81 * (2.0 + square))});
  // The lower one swings out by the root of two, with or against the upper one; its joint counts from the upper.
  const std::uint32_t first = pendulums.v("first.angle"), second = pendulums.v("second.angle");
  for (const auto& [mode, ratio] : {std::pair{0u, square - 1.0}, std::pair{2u, -square - 1.0}}) {
    const Eigen::VectorXcd& shape = linear.modes[mode].shape;
    EXPECT_NEAR(std::abs(shape[second] / shape[first] - ratio), 0.0, 1e-9);
  }
}

std::string chain(int n) {
  std::string text = "[scene]\nlength = 1\ngravity = [0, 0, 0]\n";
  for (int i = 1; i <= n; ++i) {
    const std::string here = std::to_string(i), before = i == 1 ? "ground" : std::string("m") + std::to_string(i - 1);
    text += std::string("[[body]]\nname = 'm") + here + "'\nmass = 2\n[[joint]]\nname = 'j" + here +
            "'\ntype = 'prismatic'\ninlet = { on = 'ground', axis = [1, 0, 0], at = [" + here +
            ", 0, 0] }\noutlet = { on = 'm" + here + "', axis = [1, 0, 0] }\n[[force]]\nname = 's" + here +
            "'\ntype = 'spring'\nfrom = '" + before + "'\nto = 'm" + here + "'\nstiffness = 50\nlength = 1\n";
  }
  return text + "[[force]]\nname = 'last'\ntype = 'spring'\nfrom = 'm" + std::to_string(n) +
         "'\nto = { on = 'ground', at = [" + std::to_string(n + 1) + ", 0, 0] }\nstiffness = 50\nlength = 1\n";
}

TEST(Linearisation, ChainOfMassesBetweenWalls) {
  constexpr int n = 6;
  std::vector<double> known;
  for (int k = 1; k <= n; ++k) known.push_back(2.0 * std::sqrt(50.0 / 2.0) * std::sin(k * pi / (2.0 * (n + 1))));
  expect_frequencies(Started(chain(n)).linear(), known);
}

TEST(Linearisation, FourBarSwingsByItsPotentialAndMass) {
  Started bar(FourBar::scene());
  bar.take(bar.found());
  const Linearisation linear = bar.linear();
  const FourBar exact(bar.state.q[bar.q("crank.angle")]);
  EXPECT_EQ(linear.course, Course::resting);
  expect_frequencies(linear, {std::sqrt(exact.potential().second / exact.mass())});
  const Eigen::VectorXcd& shape = linear.modes[0].shape;
  EXPECT_NEAR(std::abs(shape[bar.v("rocker.angle")] / shape[bar.v("crank.angle")] - exact.rocker_rate()), 0.0,
              64 * eps);
}

TEST(Linearisation, EffortsActThroughLoopsWhereverTheyAreCut) {
  for (const std::vector<std::string>& order :
       {std::vector<std::string>{"crank", "a", "b", "rocker"}, {"rocker", "b", "a", "crank"}}) {
    Started bar(FourBar::scene(order));
    bar.take(bar.found());
    LinearisationOptions options;
    options.efforts = {bar.v("crank.angle"), bar.v("rocker.angle")};
    const Linearisation linear = bar.linear(options);
    const FourBar exact(bar.state.q[bar.q("crank.angle")]);
    const Eigen::VectorXcd& shape = linear.modes[0].shape;
    const double lever = (shape[linear.independent[0]] / shape[bar.v("crank.angle")]).real();
    for (const auto& [column, ratio] : {std::pair{0, 1.0}, std::pair{1, exact.rocker_rate()}}) {
      const double known = ratio / exact.mass() * lever;
      EXPECT_NEAR(linear.b.value(1, column), known, linear.b.error(1, column) + 1e3 * eps * std::abs(known));
      EXPECT_LT(linear.b.error(1, column), 1e-9 * std::abs(known));
      EXPECT_NEAR(linear.b.value(0, column), 0.0, linear.b.error(0, column));
    }
  }
}

/// Wheel of 40 kg on a tyre of 200 kN/m, body of 300 kg above on 20 kN/m with a damper of 1500 N s/m; the road is
/// driven.
const char* const quarter_car =
    "[scene]\nlength = 1\n[[body]]\nname = 'road'\n[[body]]\nname = 'wheel'\nmass = 40\n[[body]]\nname = 'car'\nmass = "
    "300\n"
    "[[joint]]\nname = 'road'\ntype = 'prismatic'\ninlet = 'ground'\noutlet = 'road'\n"
    "[[joint]]\nname = 'wheel'\ntype = 'prismatic'\ninlet = 'ground'\noutlet = 'wheel'\nstart = { displacement = 0.3 "
    "}\n"
    "[[joint]]\nname = 'car'\ntype = 'prismatic'\ninlet = 'ground'\noutlet = 'car'\nstart = { displacement = 0.8 }\n"
    "[[force]]\nname = 'tyre'\ntype = 'spring'\nfrom = 'road'\nto = 'wheel'\nstiffness = 2e5\nlength = 0.3\n"
    "[[force]]\nname = 'strut'\ntype = 'spring'\nfrom = 'wheel'\nto = 'car'\nstiffness = 2e4\ndamping = 1500\nlength = "
    "0.5\n"
    "[[drive]]\nof = 'road.displacement'\ntype = 'constant'\nvalue = 0\n"
    "[[record]]\nof = 'car.displacement'\nquantity = 'acceleration'\n[[record]]\nof = 'wheel.displacement'\n";

TEST(Linearisation, QuarterCar) {
  Started car(quarter_car);
  car.take(car.found());
  LinearisationOptions options;
  options.efforts = {car.v("car.displacement")};
  const Linearisation linear = car.linear(options);
  constexpr double m = 40, M = 300, tyre = 2e5, k = 2e4, d = 1500;
  ASSERT_EQ(linear.modes.size(), 4u);
  for (const NaturalMode& mode : linear.modes) {
    const Complex s = mode.eigenvalue, strut = k + d * s;
    const Complex polynomial = (m * s * s + strut + tyre) * (M * s * s + strut) - strut * strut;
    const Complex slope =
        (2.0 * m * s + d) * (M * s * s + strut) + (m * s * s + strut + tyre) * (2.0 * M * s + d) - 2.0 * d * strut;
    EXPECT_LE(std::abs(polynomial / slope), mode.error);
    EXPECT_LT(mode.error, 1e-9 * std::abs(s));
    EXPECT_LT(s.real(), 0.0);
  }
  // u: value, rate and acceleration of the road, effort on the car; y: acceleration of the car, place of the wheel.
  ASSERT_EQ(linear.inputs.size(), 4u);
  ASSERT_EQ(linear.states.size(), 4u);
  EXPECT_EQ(linear.states[0].name, "wheel.displacement");
  EXPECT_EQ(linear.inputs[3].name, "car.displacement effort");
  EXPECT_EQ(linear.inputs[3].unit, "N");
  Eigen::Matrix4d b = Eigen::Matrix4d::Zero();
  b(2, 0) = tyre / m;
  b(3, 3) = 1.0 / M;
  Eigen::Matrix<double, 2, 4> c, through;
  c << k / M, -k / M, d / M, -d / M, 1, 0, 0, 0;
  through << 0, 0, 0, 1.0 / M, 0, 0, 0, 0;
  const auto expect = [](const Derivative& found, const Eigen::MatrixXd& known) {
    EXPECT_TRUE(((found.value - known).cwiseAbs().array() <= found.error.array() + 4 * eps * known.norm()).all())
        << found.value;
    EXPECT_LT(found.error.maxCoeff(), 1e-9 * known.norm());
  };
  expect(linear.b, b);
  expect(linear.c, c);
  expect(linear.d, through);
  Eigen::Matrix2d damping;
  damping << d, -d, -d, d;
  expect(linear.damping, damping);
}

TEST(Linearisation, BodyOnSpringsHasSixModes) {
  const std::string text =
      "[scene]\ngravity = [0, 0, 0]\nlength = 1\n[[body]]\nname = 'block'\nmass = 2\ninertia = [1, 2, 3, 0, 0, 0]\n"
      "[[joint]]\nname = 'block'\ntype = 'free'\ninlet = 'ground'\noutlet = 'block'\n"
      "[[force]]\nname = 'mount'\ntype = 'bushing'\nfrom = 'ground'\nto = 'block'\nstiffness = [100, 200, 300]\n"
      "rotational_stiffness = [10, 40, 90]\n";
  expect_frequencies(Started(text).linear(),
                     {std::sqrt(10.0), std::sqrt(20.0), std::sqrt(30.0), std::sqrt(50.0), 10.0, std::sqrt(150.0)});
}

/// Takes over the rates that the scene asks for.
void spin(Started& started) {
  for (const StateBlock& block : started.built->blocks) {
    const auto& rate = started.built->joints[block.joint.index()].blocks[block.block].described.start_rate;
    if (rate) std::copy(rate->begin(), rate->end(), started.state.v.data() + block.v);
  }
  started.state.stage = Stage::velocities;
}

TEST(Linearisation, GyroscopeNodsAboutItsSteadyPrecession) {
  Started gyroscope(scene("gyroscope"));
  spin(gyroscope);
  const Linearisation linear = gyroscope.linear();
  EXPECT_EQ(linear.course, Course::steady);
  constexpr double axial = 0.002, across = 0.005, spin_rate = 200.0, tilt = pi / 6;
  const double precession = gyroscope.state.v[gyroscope.v("precession.angle")];
  const double nod =
      std::hypot(precession * std::sin(tilt), axial * spin_rate / across - 2.0 * precession * std::cos(tilt));
  ASSERT_EQ(linear.modes.size(), 6u);
  expect_eigenvalue(linear, 4, {0.0, nod});
  // Turns about the vertical and about the rotor's axis, at any rates: four eigenvalues are zero.
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(std::abs(linear.modes[i].eigenvalue), linear.modes[i].error);
}

TEST(Linearisation, FreeFlightHasNoEigenvaluesButZero) {
  const Linearisation linear = Started(
                                   "[scene]\ngravity = [0, 0, 0]\nlength = 1\n[[body]]\nname = 'stone'\nmass = 1\n"
                                   "inertia = [1, 1, 2, 0, 0, 0]\n")
                                   .linear();
  EXPECT_EQ(linear.course, Course::resting);
  ASSERT_EQ(linear.modes.size(), 12u);
  for (const NaturalMode& mode : linear.modes) EXPECT_LE(std::abs(mode.eigenvalue), mode.error);
}

TEST(Linearisation, StopThatIsJustTouchedHasACorner) {
  const Linearisation linear =
      Started(pendulum("'-90 deg'",
                       "[[force]]\nname = 'stop'\ntype = 'stop'\nof = 'pivot.angle'\nupper = '-90 deg'\n"
                       "stiffness = 100\n"))
          .linear();
  EXPECT_GE(linear.stiffness.error(0, 0), 0.9 * 50.0);
}

TEST(Linearisation, WhatHasNoMassIsNamed) {
  const Started ghost(
      "[scene]\nlength = 1\n[[body]]\nname = 'ghost'\n[[joint]]\nname = 'pin'\ntype = 'revolute'\n"
      "inlet = 'ground'\noutlet = 'ghost'\n");
  const auto result = linearise(ghost.built.mechanism, ghost.state, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::massless);
  EXPECT_NE(result.error().element.find("pin.angle"), std::string::npos);
}

TEST(Linearisation, StatesOfForcesAreStates) {
  Started servo(pendulum("0.2",
                         "[[force]]\nname = 'servo'\ntype = 'controller'\nof = 'pivot.angle'\nsetpoint = 0.5\n"
                         "proportional = 30\nintegral = 4\nderivative = 1\n"));
  const Linearisation linear = servo.linear();
  ASSERT_EQ(linear.states.size(), 3u);
  EXPECT_EQ(linear.states[2].name, "servo.integral");
  EXPECT_NEAR(linear.a.value(1, 2), 4.0 / 0.5, linear.a.error(1, 2));
  EXPECT_NEAR(linear.a.value(2, 0), -1.0, linear.a.error(2, 0));
}

}  // namespace
}  // namespace koppel::test

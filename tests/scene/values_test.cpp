// Numbers, quantities, expressions and parameters.
#include <cmath>
#include <numbers>
#include <sstream>

#include "scene_reader.hpp"

namespace koppel {
namespace {

constexpr double pi = std::numbers::pi;

/// The value of an expression where a scene takes any number: x of gravity.
double value_of(const std::string& expression, const std::string& parameters = "") {
  SceneReader reader;
  return reader.good("schema = 1\n[scene]\ngravity = [\"" + expression + "\", 0, 0]\n[parameters]\n" + parameters)
      .gravity.x();
}

TEST(Quantities, are_converted_to_SI) {
  EXPECT_DOUBLE_EQ(value_of("30 deg"), pi / 6);
  EXPECT_EQ(value_of("180 deg"), pi);
  EXPECT_EQ(value_of("1.5 rad"), 1.5);
  EXPECT_EQ(value_of("2 rev"), 4 * pi);
  EXPECT_EQ(value_of("2 m"), 2.0);
  EXPECT_EQ(value_of("12 cm"), 0.12);
  EXPECT_EQ(value_of("120 mm"), 0.12);
  EXPECT_EQ(value_of("3 s"), 3.0);
  EXPECT_EQ(value_of("30 ms"), 0.03);
  EXPECT_EQ(value_of("4 kg"), 4.0);
  EXPECT_EQ(value_of("250 g"), 0.25);
  EXPECT_DOUBLE_EQ(value_of("-20deg"), -pi / 9);
  EXPECT_EQ(value_of("1e-3 m"), 0.001);
}

TEST(Quantities, stand_for_the_numerator_of_a_unit) {
  SceneReader reader;
  const Scene scene = reader.good(
      "schema = 1\n[[body]]\nname = 'b'\n"
      "[[joint]]\nname = 'j'\ntype = 'helical'\nbetween = ['ground', 'b']\npitch = '5 mm'\n");
  EXPECT_EQ(scene.joints.at(0).values.at(0).numbers, std::vector<double>{0.005});
}

TEST(Lengths, reach_as_far_as_any_mechanism) {
  SceneReader reader;
  EXPECT_EQ(reader.good("schema = 1\n[scene]\nlength = 1e9\n").length, 1e9);
  EXPECT_FALSE(reader.read("schema = 1\n[scene]\nlength = 1.001e9\n"));
}

TEST(Expressions, follow_the_rules_of_arithmetic) {
  EXPECT_EQ(value_of("2 + 3*4"), 14.0);
  EXPECT_EQ(value_of("(2 + 3)*4"), 20.0);
  EXPECT_EQ(value_of("2^3^2"), 512.0);
  EXPECT_EQ(value_of("-2^2"), -4.0);
  EXPECT_EQ(value_of("7/2/2"), 1.75);
  EXPECT_EQ(value_of("1 < 2 ? 10 : 20"), 10.0);
  EXPECT_EQ(value_of("2 == 3 ? 10 : 20"), 20.0);
  EXPECT_EQ(value_of("pi"), pi);
}

TEST(Expressions, bind_units_to_the_number_before_them) {
  EXPECT_EQ(value_of("100 mm / 20 ms"), 5.0);
  EXPECT_DOUBLE_EQ(value_of("2*sin(30 deg)"), 1.0);
  EXPECT_DOUBLE_EQ(value_of("(1/2) deg"), pi / 360);
}

TEST(Expressions, know_the_functions) {
  EXPECT_EQ(value_of("sin(1)"), std::sin(1.0));
  EXPECT_EQ(value_of("cos(1)"), std::cos(1.0));
  EXPECT_EQ(value_of("tan(1)"), std::tan(1.0));
  EXPECT_EQ(value_of("asin(0.5)"), std::asin(0.5));
  EXPECT_EQ(value_of("acos(0.5)"), std::acos(0.5));
  EXPECT_EQ(value_of("atan(2)"), std::atan(2.0));
  EXPECT_EQ(value_of("atan2(1, -1)"), std::atan2(1.0, -1.0));
  EXPECT_EQ(value_of("sinh(1)"), std::sinh(1.0));
  EXPECT_EQ(value_of("cosh(1)"), std::cosh(1.0));
  EXPECT_EQ(value_of("tanh(1)"), std::tanh(1.0));
  EXPECT_EQ(value_of("sqrt(2)"), std::sqrt(2.0));
  EXPECT_EQ(value_of("exp(1)"), std::exp(1.0));
  EXPECT_EQ(value_of("log(2)"), std::log(2.0));
  EXPECT_EQ(value_of("abs(-2)"), 2.0);
  EXPECT_EQ(value_of("sign(-2)"), -1.0);
  EXPECT_EQ(value_of("min(3, 1, 2)"), 1.0);
  EXPECT_EQ(value_of("max(3, 1, 2)"), 3.0);
}

TEST(Expressions, cannot_set_anything) {
  SceneReader reader;
  EXPECT_FALSE(reader.read("schema = 1\n[parameters]\na = 1\n[scene]\nlength = 'a = 2'\n"));
}

TEST(Parameters, refer_to_each_other_in_any_order) {
  EXPECT_EQ(value_of("d", "d = 'b + c'\nc = '2*b'\nb = '3*a'\na = 2\n"), 18.0);
}

TEST(Parameters, may_be_named_like_the_exponent_of_a_number) { EXPECT_EQ(value_of("1e3 + e3", "e3 = 7\n"), 1007.0); }

TEST(Parameters, make_long_chains) {
  std::ostringstream chain("p0 = 1\n", std::ios::ate);
  for (int i = 1; i < 3000; ++i) chain << 'p' << i << " = 'p" << i - 1 << " + 1'\n";
  EXPECT_EQ(value_of("p2999", chain.str()), 3000.0);
}

TEST(Expressions, fail_where_the_caret_stands) {
  const auto caret = [](const std::string& expression) {
    SceneReader reader;
    EXPECT_FALSE(reader.read("schema = 1\n[scene]\nlength = \"" + expression + "\"\n")) << expression;
    return reader.diagnostics.first_error().source.column - 11;  // the expression begins in column 11
  };
  EXPECT_EQ(caret("1 + lenght"), 4);
  EXPECT_EQ(caret("1 + * 2"), 4);
  EXPECT_EQ(caret("1 + 2)"), 5);
  EXPECT_EQ(caret("sin(1, 2)"), 8);
}

TEST(Header, has_sensible_defaults) {
  SceneReader reader;
  const Scene scene = reader.good("schema = 1\n");
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.gravity, Vector3(0, 0, -9.81));
  EXPECT_FALSE(scene.length.has_value());
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].name, "ground");
  EXPECT_EQ(scene.bodies[0].type, nullptr);
}

TEST(Header, is_taken_as_written) {
  SceneReader reader;
  const Scene scene = reader.good(
      "schema = 1\n[scene]\nname = 'four-bar_1'\ntitle = 'A title'\ngravity = [0, -9.81, 0]\n"
      "length = '400 mm'\nduration = 2\nsteps = 360\n");
  EXPECT_EQ(scene.name, "four-bar_1");
  EXPECT_EQ(scene.title, "A title");
  EXPECT_EQ(scene.gravity, Vector3(0, -9.81, 0));
  EXPECT_EQ(scene.length, 0.4);
  EXPECT_EQ(scene.duration, 2.0);
  EXPECT_EQ(scene.steps, 360u);
}

}  // namespace
}  // namespace koppel

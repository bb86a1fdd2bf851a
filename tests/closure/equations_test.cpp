// The Jacobian of every kind of relation is the derivative of its residuals, closed or not.
#include "closure/equations.hpp"

#include <gtest/gtest.h>

#include "../mechanism/tree.hpp"
#include "../plugin/curve.hpp"
#include "closed.hpp"
#include "wave.hpp"

namespace koppel::test {
namespace {

std::shared_ptr<Registry> types_with_wave() {
  auto registry = Built::types();
  EXPECT_TRUE(registry->add(wave_plugin));
  return registry;
}

// Two arms from the ground: a body that moves freely but for a driven coordinate, which keeps its joint in the tree,
// and a chain of two screws, which nothing can cut. What is added below closes a loop between their ends.
const char* const two_arms =
    "[scene]\nlength = 0.7\n[[body]]\nname = 'free'\n[[body]]\nname = 'middle'\n[[body]]\nname = 'end'\n"
    "[[joint]]\nname = 'free'\ntype = 'free'\ninlet = 'ground'\noutlet = { on = 'free', at = [0.1, 0.2, 0.3] }\n"
    "[[joint]]\nname = 'one'\ntype = 'helical'\npitch = 0.2\ninlet = { on = 'ground', at = [0.3, 0, 0.1] }\n"
    "outlet = { on = 'middle', rotate = [['x', 1.0]] }\n"
    "[[joint]]\nname = 'two'\ntype = 'helical'\npitch = -0.1\ninlet = { on = 'end', at = [0.3, 0, 0.1] }\n"
    "outlet = { on = 'middle', rotate = [['y', -0.4]], at = [0, 0.5, 0] }\n"
    "[[drive]]\nof = 'free.x'\ntype = 'constant'\nvalue = 0\n";

std::string loop(const std::string& joint) {
  return two_arms + std::string("[[joint]]\nname = 'chord'\ninlet = { on = 'end', at = [0.1, 0, 0.2] }\n") +
         "outlet = { on = 'free', rotate = [['z', 0.3]], at = [0, 0.2, 0] }\n" + joint + "\n";
}

/// Greatest difference of the Jacobian from the rates of the residuals; the residuals change over about a radian.
double jacobian_error(const Built& built, const Eigen::VectorXd& q, double time) {
  Equations here(*built), there(*built);
  EXPECT_TRUE(here.evaluate(q, time));
  here.evaluate_jacobian();
  double worst = 0;
  for (std::uint32_t column = 0; column < built->columns; ++column) {
    const std::uint32_t rate = built->rate_of_column[column];
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(built->nv), moved = q;
    unit[rate] = built->rate_scale[rate];
    for (Eigen::Index row = 0; row < here.residual.size(); ++row) {
      const double expected = derivative(
          [&](double t) {
            integrate(*built, q, t * unit, moved);
            EXPECT_TRUE(there.evaluate(moved, time));
            return there.residual[row];
          },
          2e-3);
      worst = std::max(worst, std::abs(here.jacobian.coeff(row, column) - expected));
    }
  }
  return worst;
}

void expect_right_jacobian(const Built& built, double accuracy) {
  Random random(31);
  for (int trial = 0; trial < 20; ++trial) {
    EXPECT_LE(jacobian_error(built, random_position(*built, random, 0.6), 0.7), accuracy) << "trial " << trial;
  }
}

class Chord : public testing::TestWithParam<JointCase> {};
std::string case_name(const testing::TestParamInfo<JointCase>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Of, Chord, testing::ValuesIn([] {
                           std::vector<JointCase> joints = all_joints();
                           // The stranger's screw has residuals within its reach only: its face has a test of its own.
                           std::erase_if(joints, [](const JointCase& j) { return j.name == "varying_screw"; });
                           return joints;
                         }()),
                         case_name);

TEST_P(Chord, JacobianIsTheDerivativeOfTheResiduals) {
  const Built built(loop(GetParam().text));
  ASSERT_EQ(built->loops, 1u);
  expect_right_jacobian(built, 1e-9);
}

TEST(CutBody, JacobianIsTheDerivativeOfTheResiduals) {
  const Built built(loop("type = 'helical'\npitch = 0.3"));
  ASSERT_EQ(built->relations[0].kind, RelationKind::cut_body);
  expect_right_jacobian(built, 1e-9);
}

TEST(Constraint, DistanceHasTheRightJacobian) {
  expect_right_jacobian(Built(two_arms + std::string("[[constraint]]\nname = 'rod'\ntype = 'distance'\ndistance = 0.4\n"
                                                     "from = { on = 'end', at = [0.1, 0, 0.2] }\n"
                                                     "to = { on = 'free', at = [0, 0.2, 0] }\n")),
                        1e-9);
}

TEST(Constraint, CouplingHasTheRightJacobian) {
  expect_right_jacobian(Built(two_arms + std::string("[[constraint]]\nname = 'gear'\ntype = 'coupling'\noffset = 0.1\n"
                                                     "coordinates = ['one.angle', 'free.y', 'free.x']\n"
                                                     "factors = [1, -2, 3]\n")),
                        1e-11);
}

TEST(Constraint, OfFramesCoordinatesAndTimeHasTheRightJacobian) {
  const Built built(two_arms + std::string("[[constraint]]\nname = 'sphere'\ntype = 'wave.growing_sphere'\n"
                                           "from = { on = 'end', at = [0.1, 0, 0.2] }\n"
                                           "to = { on = 'free', at = [0, 0.2, 0] }\ncoordinate = ['one.angle']\n"),
                    types_with_wave());
  EXPECT_TRUE(built->explicit_time);
  expect_right_jacobian(built, 1e-9);
  Equations here(*built), there(*built);
  Eigen::VectorXd rate(built->rows);
  const Eigen::VectorXd q = State(*built).q;
  ASSERT_TRUE(here.evaluate(q, 0.7));
  ASSERT_TRUE(here.time_rate(rate));
  EXPECT_NEAR(rate[0], derivative([&](double t) {
                EXPECT_TRUE(there.evaluate(q, 0.7 + t));
                return there.residual[0];
              }),
              1e-13);
}

// The second-order terms: r'' along a motion with given rates and accelerations is J a + bias.
TEST(Equations, BiasIsWhatTheSecondDerivativeHasBeyondTheAccelerations) {
  const Built built(two_arms + std::string("[[constraint]]\nname = 'sphere'\ntype = 'wave.growing_sphere'\n"
                                           "from = { on = 'end', at = [0.1, 0, 0.2] }\n"
                                           "to = { on = 'free', at = [0, 0.2, 0] }\ncoordinate = ['one.angle']\n"
                                           "[[constraint]]\nname = 'rod'\ntype = 'distance'\ndistance = 0.4\n"
                                           "from = { on = 'middle', at = [0.1, 0, 0.2] }\n"
                                           "to = { on = 'free', at = [0, 0.2, 0] }\n"),
                    types_with_wave());
  Random random(32);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd q = random_position(*built, random, 0.6);
    const Eigen::VectorXd v = 0.3 * random_rates(built->nv, random), a = 0.3 * random_rates(built->nv, random);
    Equations here(*built), there(*built);
    ASSERT_TRUE(here.evaluate(q, 0.7));
    here.evaluate_jacobian();
    ASSERT_TRUE(here.motion(q, v, Eigen::VectorXd::Zero(built->nv)));
    Eigen::VectorXd bias(built->rows), moved = q, columns(built->columns);
    ASSERT_TRUE(here.bias(q, v, bias));
    for (std::uint32_t i = 0; i < built->columns; ++i) {
      columns[i] = a[built->rate_of_column[i]] / built->rate_scale[built->rate_of_column[i]];
    }
    const Eigen::VectorXd expected = Eigen::VectorXd::NullaryExpr(built->rows, [&](Eigen::Index row) {
      return second_derivative([&](double t) {
        integrate(*built, q, t * v + t * t / 2 * a, moved);
        EXPECT_TRUE(there.evaluate(moved, 0.7 + t));
        return there.residual[row];
      });
    });
    EXPECT_LE((here.jacobian * columns + bias - expected).cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace koppel::test

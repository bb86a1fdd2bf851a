// Velocities and accelerations of closed mechanisms: derivatives of positions; what they are where freedoms are left
// over, and that they are refused where the drives ask for the impossible.
#include <gtest/gtest.h>

#include "closure/decompositions.hpp"
#include "passage.hpp"
#include "wave.hpp"

namespace koppel::test {
namespace {

struct Moving {
  std::string scene;
  double time;
  double h;  ///< about a hundredth of the time in which the motion changes
};

void PrintTo(const Moving& moving, std::ostream* out) { *out << moving.scene; }

class Rates : public testing::TestWithParam<Moving> {};
INSTANTIATE_TEST_SUITE_P(Of, Rates,
                         testing::Values(Moving{"4bar", 0.2, 5e-4}, Moving{"rstr", 0.1, 5e-4},
                                         Moving{"rscr", 0.1, 5e-4}, Moving{"rccc", 0.1, 5e-4}, Moving{"7h", 0.02, 5e-4},
                                         Moving{"bennett", 0.1, 5e-4}, Moving{"5link", 0.3, 5e-3},
                                         Moving{"multilink", 0.3, 5e-3}, Moving{"stewart", 0.2, 1e-3},
                                         Moving{"wishbone", 0.3, 1e-3}, Moving{"slidercrank", 0.1, 5e-4}));

// Truncation (h w)^6 / 140 and rounding eps / h are below 1e-11 of the speeds, which are up to 30 rad/s.
TEST_P(Rates, AreDerivativesOfPositions) {
  Closed closed(shipped(GetParam().scene));
  const Passage passage = Passage::around(closed, GetParam().time, GetParam().h);
  const double speed = 1 + passage.now().v.lpNorm<Eigen::Infinity>();
  EXPECT_LE(passage.velocity_error(*closed.built), 1e-9 * speed);
  EXPECT_LE(passage.acceleration_error(), 1e-9 * speed * speed * 10);
}

std::shared_ptr<Registry> types_with_wave() {
  auto registry = Built::types();
  EXPECT_TRUE(registry->add(wave_plugin));
  return registry;
}

// A body in the plane: its angle and y are driven, x follows from the sphere that grows with time and angle.
const char* const on_a_growing_sphere =
    "[scene]\nlength = 1\n[[body]]\nname = 'b'\n[[joint]]\nname = 'j'\ntype = 'planar'\ninlet = 'ground'\noutlet = "
    "'b'\n"
    "start = { x = 1 }\n"
    "[[constraint]]\nname = 'sphere'\ntype = 'wave.growing_sphere'\nfrom = { on = 'ground', at = [0, 0, 0.1] }\n"
    "to = { on = 'b', at = [0.1, 0.2, 0.1] }\ncoordinate = ['j.angle']\n"
    "[[drive]]\nof = 'j.angle'\ntype = 'ramp'\nstart = 0.3\nslope = 0.5\n"
    "[[drive]]\nof = 'j.y'\ntype = 'sine'\namplitude = 0.2\nfrequency = 0.3\n";

TEST(TimeDependentConstraint, MovesTheMechanismAsItsDerivativesSay) {
  Closed closed(on_a_growing_sphere, types_with_wave());
  const Passage passage = Passage::around(closed, 0.5, 0.01);
  EXPECT_LE(closed.residual(), 1e-14);
  EXPECT_LE(passage.velocity_error(*closed.built), 1e-11);
  EXPECT_LE(passage.acceleration_error(), 1e-10);
}

TEST(TimeDependentConstraint, ClosedAgainAtTheSameTimeChangesNoBit) {
  Closed closed(on_a_growing_sphere, types_with_wave());
  CloseOptions loosely;
  loosely.tolerance = 1e-11;  // a second closure would find something to gain
  for (const double time : {0.1, 0.2, 0.3, 0.4}) {
    ASSERT_EQ(set_time(*closed.built, time, closed.state), nullptr);
    ASSERT_GE(closed.close(loosely), 0);
    const Eigen::VectorXd q = closed.state.q;
    ASSERT_GE(closed.close(), 0);
    EXPECT_TRUE(same_bits(closed.state.q, q));
  }
}

/// Crank of 0.1 and rod of 0.3, stretched out along x; the slider is driven.
const char* const stretched_out =
    "[[body]]\nname = 'crank'\n[[body]]\nname = 'rod'\n[[body]]\nname = 'slider'\n"
    "[[joint]]\nname = 'crank'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'crank'\n"
    "[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = { on = 'crank', at = [0.1, 0, 0] }\noutlet = 'rod'\n"
    "[[joint]]\nname = 'slider'\ntype = 'prismatic'\ninlet = { on = 'ground', rotate = [['y', '90 deg']] }\n"
    "outlet = { on = 'slider', rotate = [['y', '90 deg']] }\n"
    "[[joint]]\nname = 'wrist'\ntype = 'revolute'\ninlet = { on = 'rod', at = [0.3, 0, 0] }\noutlet = 'slider'\n"
    "[[drive]]\nof = 'slider.displacement'\ntype = 'ramp'\nstart = 0.4\n";

TEST(DeadCentre, RefusesASpeedThatItCannotTake) {
  Closed closed(stretched_out + std::string("slope = -0.1\n"));
  ASSERT_GE(closed.close(), 0);
  const State before = closed.state;
  EXPECT_EQ(velocities(closed.work, closed.state), KOPPEL_SINGULAR);
  EXPECT_TRUE(same_bits(closed.state, before));
  EXPECT_EQ(closed.move(0.0), KOPPEL_SINGULAR);
}

TEST(DeadCentre, IsNoTroubleAtRest) {
  Closed closed(stretched_out + std::string("slope = 0\n"));
  EXPECT_GE(closed.move(0.0), 0);
  EXPECT_EQ(closed.state.v.lpNorm<Eigen::Infinity>(), 0);
}

TEST(Rates, AreRefusedOfAStateThatIsNotClosed) {
  Closed closed(shipped("rstr"));
  EXPECT_EQ(velocities(closed.work, closed.state), KOPPEL_INVALID_ARGUMENT);
  ASSERT_GE(closed.close(), 0);
  EXPECT_EQ(accelerations(closed.work, closed.state), KOPPEL_INVALID_ARGUMENT);
  closed.state.input[0] += 0.1;
  EXPECT_EQ(velocities(closed.work, closed.state), KOPPEL_INVALID_ARGUMENT);
}

// A coupler between two balls spins freely about its own line: of all its rates the least are taken.
TEST(IsolatedFreedom, GetsTheRateOfLeastNorm) {
  Closed closed(shipped("rstr", {{"type = \"universal\"", "type = \"spherical\""},
                                 {"axis2 = [0, -1, 0]\n", ""},
                                 {"start = { angle1 = \"154.2 deg\", angle2 = \"-32.8 deg\" }\n", ""},
                                 {"[[record]]\nof = \"cardan.angle1\"\n", ""},
                                 {"[[record]]\nof = \"cardan.angle2\"\n", ""}}));
  ASSERT_EQ(closed.move(0.1), KOPPEL_OK);
  ASSERT_EQ(closed.built->unknowns, closed.report.rank + 1);
  Equations equations(*closed.built);
  ASSERT_TRUE(equations.evaluate(closed.state.q, closed.state.time));
  equations.evaluate_jacobian();
  const Eigen::MatrixXd unknown = equations.jacobian.leftCols(closed.built->unknowns);
  const Eigen::MatrixXd spin = Eigen::FullPivLU<Eigen::MatrixXd>(unknown).kernel();
  ASSERT_EQ(spin.cols(), 1);
  Eigen::VectorXd v(closed.built->unknowns), a(closed.built->unknowns);
  for (std::uint32_t i = 0; i < closed.built->unknowns; ++i) {
    const std::uint32_t rate = closed.built->rate_of_column[i];
    v[i] = closed.state.v[rate] / closed.built->rate_scale[rate];
    a[i] = closed.state.a[rate] / closed.built->rate_scale[rate];
  }
  EXPECT_GT(v.norm(), 0.1);
  EXPECT_LE(std::abs(spin.col(0).normalized().dot(v)), 1e-13 * v.norm());
  EXPECT_LE(std::abs(spin.col(0).normalized().dot(a)), 1e-13 * a.norm());
}

// A position may be kept while its rates are not: the drive has taken another speed.
TEST(ClosedAgain, WithOtherRatesOfTheInputsKeepsThePositionAndAsksForVelocities) {
  Closed closed(shipped("4bar"));
  ASSERT_GE(closed.move(0.1), 0);
  const Eigen::VectorXd q = closed.state.q;
  ASSERT_GE(closed.close(), 0);
  EXPECT_EQ(closed.state.stage, Stage::accelerations);
  closed.state.input_rate[0] += 1.0;
  ASSERT_GE(closed.close(), 0);
  EXPECT_TRUE(same_bits(closed.state.q, q));
  EXPECT_EQ(accelerations(closed.work, closed.state), KOPPEL_INVALID_ARGUMENT);
  EXPECT_EQ(velocities(closed.work, closed.state), KOPPEL_OK);
  EXPECT_EQ(accelerations(closed.work, closed.state), KOPPEL_OK);
}

}  // namespace
}  // namespace koppel::test

// Assembly from far away. Measured with these seeds: 100 of 100 starts close, of the platform's from +-1 m and rad 92;
// the floors are that less a margin for other compilers. No start may end in a position that is called closed and is
// not.
#include <gtest/gtest.h>

#include "closed.hpp"

namespace koppel::test {
namespace {

struct Assembly {
  std::string scene;
  double size;  ///< of the random start: angles [rad] and lengths [m] up to this, added to the scene's own
  int floor;    ///< of 100 starts
};

void PrintTo(const Assembly& assembly, std::ostream* out) { *out << assembly.scene << " " << assembly.size; }

class FromFarAway : public testing::TestWithParam<Assembly> {};
INSTANTIATE_TEST_SUITE_P(Of, FromFarAway,
                         testing::Values(Assembly{"4bar", 3.1, 98}, Assembly{"rstr", 3.1, 98},
                                         Assembly{"stewart", 0.3, 95}, Assembly{"stewart", 1.0, 85},
                                         Assembly{"5link", 0.3, 95}, Assembly{"5link", 1.0, 95}));

TEST_P(FromFarAway, ClosesMostlyAndNeverFalsely) {
  Closed closed(shipped(GetParam().scene));
  const State start = closed.state;
  Random random(51);
  int closed_count = 0;
  for (int trial = 0; trial < 100; ++trial) {
    closed.state = start;
    Eigen::VectorXd delta = GetParam().size * random_rates(closed.built->nv, random);
    integrate(*closed.built, start.q, delta, closed.state.q);
    const State before = closed.state;
    const koppel_status status = closed.close();
    if (status < 0) {
      EXPECT_EQ(status, KOPPEL_NOT_CLOSED);
      EXPECT_GT(closed.report.residual, 1e-10);
      EXPECT_TRUE(same_bits(closed.state, before));
      continue;
    }
    ++closed_count;
    EXPECT_LE(closed.residual(), 1e-13);
    EXPECT_LE(closed.report.residual, 1e-13);
    for (const Input& input : closed.built->inputs) {
      EXPECT_EQ(closed.state.q[input.q], closed.state.input[&input - closed.built->inputs.data()]);
    }
  }
  RecordProperty("closed", closed_count);
  EXPECT_GE(closed_count, GetParam().floor);
}

TEST(Unreachable, DriveIsReportedAsSuch) {
  // With the long crank there is a position at 100 deg, and none at 200 deg (both ends of the range are in the scene).
  for (const auto& [angle, status] :
       {std::pair<std::string, koppel_status>{"100 deg", KOPPEL_OK}, {"200 deg", KOPPEL_NOT_CLOSED}}) {
    Closed closed(shipped("rstr", {{"crank = 0.10", "crank = 0.30"},
                                   {"slope = \"360 deg\"", "start = \"" + angle + "\"\nslope = \"10 deg\""}}));
    const State before = closed.state;
    EXPECT_EQ(closed.close(), status) << angle;
    EXPECT_EQ(closed.report.verdict, status == KOPPEL_OK ? Verdict::closed : Verdict::unreachable);
    EXPECT_EQ(same_bits(closed.state, before), status != KOPPEL_OK);
  }
}

TEST(Assembly, OfAClosedStateChangesNoBit) {
  for (const std::string scene : {"rstr", "4bar", "multilink", "stewart"}) {
    Closed closed(shipped(scene));
    ASSERT_GE(closed.close(), 0);
    const Eigen::VectorXd q = closed.state.q;
    ASSERT_GE(closed.close(), 0);
    EXPECT_TRUE(same_bits(closed.state.q, q)) << scene;
    Closed again(shipped(scene));
    again.state.q = q;  // a new state that knows nothing of having been closed
    ASSERT_GE(again.close(), 0);
    EXPECT_TRUE(same_bits(again.state.q, q)) << scene;
  }
}

TEST(Assembly, SaysTheSameWhicheverSolverIsAsked) {
  Closed by_newton(shipped("rstr")), by_ceres(shipped("rstr"));
  CloseOptions options;
  options.method = Method::newton;
  ASSERT_EQ(by_newton.close(options), KOPPEL_OK);
  EXPECT_EQ(by_newton.report.solver, SolverUsed::newton);
  options.method = Method::ceres;
  ASSERT_EQ(by_ceres.close(options), KOPPEL_OK);
  EXPECT_EQ(by_ceres.report.solver, SolverUsed::ceres);
  EXPECT_LE((by_newton.state.q - by_ceres.state.q).norm(), 1e-12);
}

}  // namespace
}  // namespace koppel::test

// Where a motion starts, from wishes that do not fit each other: what is fixed holds, the rest gives way.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "closure/equations.hpp"
#include "simulated.hpp"

namespace koppel::test {
namespace {

/// The four-bar in another position than it is written for; `more` goes into the table of the crank.
std::string wished(const std::string& more, const std::string& of_pin = "") {
  std::string text = replaced(scene("fourbar_free"), "start = { angle = 0.7 }", "start = { angle = 0.9 }\n" + more);
  return of_pin.empty() ? text : replaced(text, "start = { angle = -0.043930530407389899 }", of_pin);
}

double opening(const Simulated& run) {
  Equations equations(*run.built);
  EXPECT_TRUE(equations.evaluate(run.state.q, 0.0));
  return equations.error();
}

TEST(Start, PreferredValuesGiveWayToEachOther) {
  const Simulated run(wished(""), within(1e-8, 1.0));
  EXPECT_LT(opening(run), 1e-13);
  EXPECT_GT(std::abs(run.q("crank.angle") - 0.9), 0.01);
}

TEST(Start, FixedValuesHold) {
  Simulated run(wished("fixed = ['angle']"), within(1e-8, 1.0));
  EXPECT_LT(opening(run), 1e-13);
  EXPECT_EQ(run.q("crank.angle"), 0.9);
  run.to(0.0);
  EXPECT_NEAR(run.v("crank.angle"), 0.5, 1e-10);  // its start rate
  EXPECT_EQ(run.state.a.allFinite(), true);
  EXPECT_GT(run.simulation->summary().start_change, 0.01) << "those of the others belong to another position";
}

/// Whichever joint says it: that of a cut loop, too.
TEST(Start, ValuesOfAnyJointHold) {
  for (const std::string name : {"crank", "crank_pin", "rocker", "rocker_pin"}) {
    SCOPED_TRACE(name);
    const std::string table = "name = \"" + name + "\"\ntype = \"revolute\"\n";
    Simulated before(scene("fourbar_free"), within(1e-8, 1.0));
    const double wanted = before.q(name + ".angle") + 0.1;
    const std::string given = "start = { angle = " + std::to_string(wanted) + " }\nfixed = ['angle']\n";
    std::string text = scene("fourbar_free");
    const std::size_t joint = text.find(table), start = text.find("start = ", joint);
    ASSERT_NE(joint, std::string::npos);
    if (start != std::string::npos && start < text.find("[[", joint))
      text.erase(start, text.find('\n', start) + 1 - start);
    const Simulated run(replaced(text, table, table + given), within(1e-8, 1.0));
    EXPECT_LT(opening(run), 1e-13);
    EXPECT_NEAR(run.q(name + ".angle"), std::stod(std::to_string(wanted)), 1e-13);
  }
}

/// Of a fixed rate nothing is lost to the others, which come as near as the loops allow.
TEST(Start, FixedRatesHold) {
  const std::string text =
      replaced(scene("fourbar_free"), "start_rate = { angle = 0.5 }", "start_rate = { angle = 2 }\nfixed = ['angle']");
  Simulated fixed(text, within(1e-8, 1.0)), preferred(replaced(text, "\nfixed = ['angle']", ""), within(1e-8, 1.0));
  fixed.to(0.0);
  preferred.to(0.0);
  EXPECT_NEAR(fixed.v("crank.angle"), 2.0, 1e-10);
  EXPECT_LT(preferred.v("crank.angle"), 1.5) << "a compromise";
}

TEST(Start, RatesThatExcludeEachOtherAreToldByName) {
  const Simulated run(
      replaced(replaced(scene("fourbar_free"), "start_rate = { angle = 0.5 }",
                        "start_rate = { angle = 2 }\nfixed = ['angle']"),
               "start_rate = { angle = -0.66238872274967872 }", "start_rate = { angle = 5 }\nfixed = ['angle']"),
      within(1e-8, 1.0));
  ASSERT_FALSE(run.started);
  EXPECT_EQ(run.started.error().code, Code::inputs_inconsistent);
  EXPECT_NE(run.started.error().element.find("angle"), std::string::npos);
}

TEST(Start, ValuesThatNoPositionHasAreCertifiedAndChangeNothing) {
  const Built built(wished("fixed = ['angle']", "start = { angle = 2.5 }\nfixed = ['angle']"));
  Work work(built.mechanism);
  State state(*built);
  const Eigen::VectorXd before = state.q;
  Report report;
  EXPECT_EQ(close(work, state, {}, report), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(report.verdict, Verdict::unreachable);
  EXPECT_EQ(state.q, before);
}

/// What a caller puts in the place of the start holds likewise.
TEST(Start, ValuesThatAreSetLaterHold) {
  const Built built(wished("fixed = ['angle']"));
  Work work(built.mechanism);
  State state(*built);
  state.q[built.coordinate("crank.angle")] = 1.1;
  Report report;
  ASSERT_GE(close(work, state, {}, report), 0);
  EXPECT_EQ(state.q[built.coordinate("crank.angle")], 1.1);
}

}  // namespace
}  // namespace koppel::test

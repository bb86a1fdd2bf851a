// Following a mechanism by its flow: the same motion as Newton's method finds on other equations, to rounding.
#include "closure/flow_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "closed.hpp"
#include "closure/modes.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A scene that moves by Newton's method, and its tracker, which starts where that stands.
struct Tracked : Closed {
  explicit Tracked(const std::string& text) : Closed(text), flow(plan_flow(*built.mechanism)) {
    tracker = FlowTracker::of(*built.mechanism, flow);
    EXPECT_GE(move_by_newton(0.0), 0);
  }
  koppel_status move_by_newton(double time) {
    EXPECT_EQ(set_time(*built.mechanism, time, state), nullptr);
    CloseOptions options;
    options.method = Method::newton;
    for (const koppel_status status :
         {koppel::close(work, state, options, report), velocities(work, state), accelerations(work, state)}) {
      if (status < 0) return status;
    }
    return KOPPEL_OK;
  }
  /// From the present state to a time, along velocities and accelerations and by the flow.
  bool follow(double time, State& to) {
    const double h = time - state.time;
    to = state;
    EXPECT_EQ(set_time(*built.mechanism, time, to), nullptr);
    const Eigen::VectorXd delta = h * state.v + h * h / 2.0 * state.a;
    integrate(*built.mechanism, state.q, delta, to.q);
    for (std::size_t i = 0; i < built->inputs.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      to.q[built->inputs[i].q] = to.input[k];
      to.v[built->inputs[i].v] = to.input_rate[k];
      to.a[built->inputs[i].v] = to.input_acceleration[k];
    }
    tracker->find_sides(state.q, sides);
    return tracker->follow(to.q, to.v, to.a, sides, accuracy);
  }
  Flow flow;
  std::optional<FlowTracker> tracker;
  FlowTracker::Sides sides = FlowTracker::Sides(built->nv + 1);
  TrackedAccuracy accuracy;
};

/// Those in closed form, and with blocks.
std::vector<const char*> tracked_scenes() {
  std::vector<const char*> scenes(closed_form_scenes.begin(), closed_form_scenes.end());
  scenes.insert(scenes.end(), {"5link", "stewart"});
  return scenes;
}

class TrackedScene : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(FlowTracker, TrackedScene, testing::ValuesIn(tracked_scenes()),
                         [](const auto& test) { return std::string("scene_") + test.param; });

/// Whether a state is where Newton's method came to. Both are off by rounding times their condition numbers; rates by
/// that once more for each differentiation.
void expect_there(const Tracked& by_newton, const State& by_flow, double condition_of_flow) {
  const Mechanism& mechanism = *by_newton.built;
  const State& there = by_newton.state;
  Eigen::VectorXd delta(mechanism.nv);
  difference(mechanism, there.q, by_flow.q, delta);
  const double condition = std::max(by_newton.report.condition, condition_of_flow);
  const double allowed = 64.0 * eps * condition * static_cast<double>(mechanism.nv);
  const double speed = 1.0 + there.v.lpNorm<Eigen::Infinity>();
  const double pull = speed * speed + there.a.lpNorm<Eigen::Infinity>();
  EXPECT_LE(delta.lpNorm<Eigen::Infinity>(), allowed);
  EXPECT_LE((by_flow.v - there.v).lpNorm<Eigen::Infinity>(), allowed * condition * speed);
  EXPECT_LE((by_flow.a - there.a).lpNorm<Eigen::Infinity>(), allowed * condition * condition * pull);
}

constexpr int steps = 360;

TEST_P(TrackedScene, MovesAsByNewtonsMethod) {
  Tracked tracked(shipped(GetParam()));
  ASSERT_TRUE(tracked.tracker);
  int followed = 0;
  for (int i = 1; i <= steps; ++i) {
    const double time = tracked.built->duration * i / steps;
    SCOPED_TRACE(time);
    State by_flow = tracked.state;
    const bool fine = tracked.follow(time, by_flow);
    ASSERT_GE(tracked.move_by_newton(time), 0);
    if (!fine) continue;
    ++followed;
    expect_there(tracked, by_flow, tracked.accuracy.condition);
    EXPECT_LE(tracked.accuracy.residual, 1e-14);
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_EQ(followed, steps) << "nothing here is near a singular position";
}

/// Who sets inputs and closes gets the same, rates and accelerations included.
TEST_P(TrackedScene, ClosesForNewInputsAsByNewtonsMethod) {
  Tracked tracked(shipped(GetParam()));
  Closed closed(shipped(GetParam()));
  closed.state.input = tracked.state.input;
  ASSERT_GE(closed.close(), 0);
  int followed = 0;
  for (int i = 1; i <= steps; ++i) {
    SCOPED_TRACE(i);
    ASSERT_GE(tracked.move_by_newton(tracked.built->duration * i / steps), 0);
    closed.state.input = tracked.state.input;
    closed.state.input_rate = tracked.state.input_rate;
    closed.state.input_acceleration = tracked.state.input_acceleration;
    ASSERT_GE(closed.close(), 0);
    if (closed.report.solver == SolverUsed::flow) ++followed;
    ASSERT_EQ(velocities(closed.work, closed.state), KOPPEL_OK);
    ASSERT_EQ(accelerations(closed.work, closed.state), KOPPEL_OK);
    expect_there(tracked, closed.state, closed.report.condition);
    EXPECT_LE(closed.residual(), 1e-13) << "to which the tracker closes";
    if (::testing::Test::HasFailure()) return;
  }
  // By Newton's method where the start is far from the last rates: at first, or where drives of several go their ways.
  EXPECT_GE(followed, steps * 98 / 100);
}

/// A wheel lifted by a centimetre at a time: the last rates tell where it will be, well enough for every step.
TEST(FlowTracker, GoesOnAlongTheMotionWhereOnlyInputsAreSet) {
  Closed closed(shipped("multilink"));
  ASSERT_GE(closed.move(0.0), 0);
  const auto& inputs = closed.built->inputs;
  const auto lifted = static_cast<Eigen::Index>(
      std::find_if(inputs.begin(), inputs.end(),
                   [&](const Input& input) { return input.q == closed.built.coordinate("wheel.z"); }) -
      inputs.begin());
  ASSERT_LT(lifted, closed.state.input.size());
  closed.state.input_rate.setZero();
  closed.state.input_acceleration.setZero();
  closed.state.input_rate[lifted] = 0.1;
  ASSERT_EQ(velocities(closed.work, closed.state), KOPPEL_OK);
  ASSERT_EQ(accelerations(closed.work, closed.state), KOPPEL_OK);
  for (int i = 1; i <= 8; ++i) {
    closed.state.input[lifted] += 0.01;
    ASSERT_EQ(closed.close() & ~KOPPEL_REDUNDANT, KOPPEL_OK) << i;
    EXPECT_EQ(closed.report.solver, SolverUsed::flow) << i;
    EXPECT_LE(closed.residual(), 1e-14) << i;
  }
}

/// What it says of its error is no less than what it is off by, and not much more.
TEST_P(TrackedScene, KnowsItsError) {
  Tracked tracked(shipped(GetParam()));
  for (int i = 1; i <= 90; ++i) {
    const double time = tracked.built->duration * i / 360;
    State by_flow = tracked.state;
    ASSERT_TRUE(tracked.follow(time, by_flow));
    ASSERT_GE(tracked.move_by_newton(time), 0);
    Eigen::VectorXd delta(tracked.built->nv);
    difference(*tracked.built, tracked.state.q, by_flow.q, delta);
    double off = 0.0;
    for (Eigen::Index k = 0; k < delta.size(); ++k) {
      off = std::max(off, std::abs(delta[k]) / tracked.built->rate_scale[static_cast<std::size_t>(k)]);
    }
    EXPECT_LE(off, tracked.accuracy.coordinate_error + tracked.report.coordinate_error) << "at " << time;
    EXPECT_LE(tracked.accuracy.coordinate_error, 1e-10);
  }
}

/// With a longer crank the spatial four-bar has limits, one of them where the crank stands at 40.333054067 degrees.
TEST(FlowTracker, LeavesLimitPositionsToOthers) {
  constexpr double degree = std::numbers::pi / 180.0, limit = 40.333054067 * degree;
  Closed closed(shipped("rstr", {{"crank = 0.10 ", "crank = 0.30 "}}));
  const Mechanism& mechanism = *closed.built.mechanism;
  auto tracker = FlowTracker::of(mechanism, plan_flow(mechanism));
  ASSERT_TRUE(tracker);
  const auto at = [&](double angle) {
    State state(mechanism);
    state.input[0] = angle;
    Modes modes;
    EXPECT_TRUE(find_modes(closed.work, state, {}, modes));
    return modes;
  };
  EXPECT_EQ(at(limit - 1e-6).modes.size(), 0u);
  ASSERT_GT(at(limit + 1e-6).modes.size(), 0u);
  const auto follows = [&](double from, double to) {
    Eigen::VectorXd q = at(from).modes.front().q, v = Eigen::VectorXd::Zero(mechanism.nv), a = v;
    FlowTracker::Sides sides(mechanism.nv + 1);
    tracker->find_sides(q, sides);
    q[closed.built.coordinate("crank.angle")] = to;
    TrackedAccuracy accuracy;
    return tracker->follow(q, v, a, sides, accuracy);
  };
  EXPECT_TRUE(follows(60 * degree, 59.9 * degree));
  EXPECT_FALSE(follows(limit + 1e-6, limit + 2e-6)) << "both solutions are near";
  EXPECT_FALSE(follows(limit + 1e-2, limit - 1e-6)) << "there is none";
}

TEST(FlowTracker, HasNoneWhereAChoiceIsLeft) {
  for (const char* scene : {"dwb", "wishbone", "7r", "7h"}) {
    const Closed closed(shipped(scene));
    EXPECT_FALSE(FlowTracker::of(*closed.built.mechanism, plan_flow(*closed.built.mechanism))) << scene;
  }
}

TEST(FlowTracker, DoesNotFollowBlindly) {
  Tracked tracked(shipped("4bar"));
  Eigen::VectorXd q = tracked.state.q, v = tracked.state.v, a = tracked.state.a;
  tracked.tracker->find_sides(q, tracked.sides);
  q[tracked.built.coordinate("crank.angle")] += std::numbers::pi;
  EXPECT_FALSE(tracked.tracker->follow(q, v, a, tracked.sides, tracked.accuracy)) << "half a turn at once";
}

}  // namespace
}  // namespace koppel::test

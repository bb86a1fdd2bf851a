// A short passage through one time, and whether its rates are the derivatives of its positions.
#pragma once

#include <array>

#include "closed.hpp"

namespace koppel::test {

/// States at t - 3h, ..., t + 3h, reached one after another.
struct Passage {
  std::array<State, 7> states;
  double h;

  static Passage around(Closed& closed, double t, double h) {
    const auto at = [&](int k) {
      EXPECT_GE(closed.move(t + k * h), 0) << "at " << t + k * h;
      return closed.state;
    };
    return {{at(-3), at(-2), at(-1), at(0), at(1), at(2), at(3)}, h};
  }
  const State& now() const { return states[3]; }

  /// Sixth-order derivative at the middle of f(state).
  template <typename Function>
  Eigen::VectorXd derivative(const Function& f) const {
    return (45 * (f(states[4]) - f(states[2])) - 9 * (f(states[5]) - f(states[1])) + (f(states[6]) - f(states[0]))) /
           (60 * h);
  }
  double velocity_error(const Mechanism& mechanism) const {
    const Eigen::VectorXd v = derivative([&](const State& state) {
      Eigen::VectorXd delta(mechanism.nv);
      difference(mechanism, now().q, state.q, delta);
      return delta;
    });
    return (v - now().v).lpNorm<Eigen::Infinity>();
  }
  double acceleration_error() const {
    const Eigen::VectorXd a = derivative([](const State& state) { return state.v; });
    return (a - now().a).lpNorm<Eigen::Infinity>();
  }
};

}  // namespace koppel::test

// What the dynamics of open trees is timed on.
#pragma once

#include <vector>

#include "dynamics/energy.hpp"
#include "dynamics/forward_dynamics.hpp"
#include "dynamics/inverse_dynamics.hpp"
#include "dynamics/mass_matrix.hpp"
#include "dynamics/tree_derivatives.hpp"
#include "dynamics/tree_dynamics.hpp"
#include "trees.hpp"

namespace koppel::bench {

/// One evaluation after another of what is timed; everything that it needs.
struct Evaluation {
  explicit Evaluation(const Tree& of)
      : tree(of),
        mechanism(*of.mechanism),
        layout(mechanism),
        kinematics(mechanism),
        rest(Eigen::VectorXd::Zero(mechanism.nv)),
        result(rest),
        carried(mechanism.nodes),
        matrix(layout),
        mass_matrix(layout, tree.inertias),
        articulated(layout, tree.inertias),
        factored(layout, tree.inertias),
        derivatives(layout, tree.inertias),
        by_q(RowMatrix::Zero(mechanism.nv, mechanism.nv)),
        by_v(by_q),
        dynamics(of.mechanism, of.inertias) {}

  void position(const TreeState& state) { fine &= forward_position(mechanism, state.q.data(), kinematics); }
  void motion(const TreeState& state, const Eigen::VectorXd& a) {
    position(state);
    fine &= forward_motion(mechanism, state.q.data(), state.v.data(), a.data(), kinematics);
  }
  void efforts(const TreeState& state) {
    motion(state, state.a);
    inverse_dynamics(mechanism, tree.inertias, kinematics, mechanism.gravity, {}, carried, result);
  }
  void mass(const TreeState& state) {
    position(state);
    mass_matrix.evaluate(kinematics, matrix);
  }
  void by_bodies(const TreeState& state) {
    motion(state, rest);
    fine &= articulated.evaluate(kinematics, mechanism.gravity, {}, state.efforts, result);
  }
  void by_factors(const TreeState& state) {
    motion(state, rest);
    fine &= factored.evaluate(kinematics, mechanism.gravity, {}, state.efforts, result);
  }
  void efforts_by(const TreeState& state) {
    position(state);
    fine &=
        derivatives.evaluate(kinematics, mechanism.gravity, state.q.data(), state.v.data(), state.a.data(), by_q, by_v);
  }
  /// What the same takes by central differences of the efforts; good for some ten digits.
  void efforts_by_differences(const TreeState& state) {
    constexpr double step = 6e-6;  // the cube root of rounding
    TreeState ahead = state, behind = state;
    for (std::uint32_t j = 0; j < mechanism.nv; ++j) {
      rest[j] = step;
      integrate(mechanism, state.q, rest, ahead.q);
      integrate(mechanism, state.q, -rest, behind.q);
      rest[j] = 0.0;
      difference(ahead, behind, step, by_q.col(j));
    }
    ahead.q = behind.q = state.q;
    for (std::uint32_t j = 0; j < mechanism.nv; ++j) {
      ahead.v[j] = state.v[j] + step;
      behind.v[j] = state.v[j] - step;
      difference(ahead, behind, step, by_v.col(j));
      ahead.v[j] = behind.v[j] = state.v[j];
    }
  }
  void difference(const TreeState& ahead, const TreeState& behind, double step,
                  Eigen::Ref<Eigen::VectorXd, 0, Eigen::InnerStride<>> column) {
    efforts(ahead);
    column = result;
    efforts(behind);
    column = (column - result) / (2 * step);
  }
  void accelerations_by(const TreeState& state) {
    fine &= !dynamics.forward_derivatives(state.q.data(), state.v.data(), state.efforts.data());
  }
  void energy(const TreeState& state) {
    motion(state, rest);
    result[0] = mechanical_state(tree.inertias, kinematics, mechanism.gravity).kinetic;
  }

  const Tree& tree;
  const Mechanism& mechanism;
  TreeLayout layout;
  Kinematics kinematics;
  Eigen::VectorXd rest, result;
  std::vector<Wrench> carried;
  TreeMatrix matrix;
  MassMatrix mass_matrix;
  ArticulatedBodies articulated;
  FactoredDynamics factored;
  TreeDerivatives derivatives;
  RowMatrix by_q, by_v;
  TreeDynamics dynamics;
  bool fine = true;
};

}  // namespace koppel::bench

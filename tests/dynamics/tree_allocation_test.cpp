// Dynamics of trees allocates nothing from state to state: shown by counting what this thread asks of malloc.
#include <gtest/gtest.h>

#include "../allocations.hpp"
#include "dynamics/tree_dynamics.hpp"
#include "moving_tree.hpp"

namespace koppel::test {
namespace {

/// Products of motions and callbacks, walked either way.
TEST(Allocation, DoesNotHappenInDynamicsOfTrees) {
  MovingTree tree(resisting_tree(20, 20), 7);
  TreeDynamics dynamics(tree.built.mechanism, tree.inertias);
  const double *q = tree.q.data(), *v = tree.v.data(), *a = tree.a.data();
  bool fine = false;
  const int count = allocations_of([&] {
    fine = !dynamics.inverse(q, v, a) && !dynamics.forward(q, v, a) && !dynamics.mass(q) && !dynamics.energy(q, v) &&
           !dynamics.inverse_derivatives(q, v, a) && !dynamics.forward_derivatives(q, v, a);
  });
  EXPECT_TRUE(fine);
  EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace koppel::test

// Dynamics of random trees: inverse dynamics, mass matrix, forward dynamics, energy and momentum belong together.
#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "../plugin/curve.hpp"
#include "closure/decompositions.hpp"
#include "moving_tree.hpp"
#include "spatial_reference.hpp"

namespace koppel::test {
namespace {

/// What a tree is made of; trees grow about as deep as the logarithm of their number, chains as deep as theirs.
struct Kind {
  std::string name;
  std::string text;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

std::vector<Kind> trees(const std::vector<unsigned>& sizes) {
  std::vector<Kind> result;
  for (const unsigned n : sizes) result.push_back({numbered("tree_", n), resisting_tree(n, n)});
  return result;
}

std::vector<Kind> trees_and_chains(const std::vector<unsigned>& sizes, const std::vector<unsigned>& lengths) {
  std::vector<Kind> result = trees(sizes);
  for (const unsigned n : lengths) result.push_back({numbered("chain_", n), chain_text(n, n)});
  return result;
}

void expect_within(const Eigen::VectorXd& difference, const Eigen::VectorXd& tolerance) {
  for (Eigen::Index i = 0; i < difference.size(); ++i) EXPECT_LE(std::abs(difference[i]), tolerance[i]) << i;
}

class TreeDynamics : public testing::TestWithParam<Kind>, public MovingTree {
 protected:
  TreeDynamics() : MovingTree(GetParam().text, 7) {}
};

INSTANTIATE_TEST_SUITE_P(
    Of, TreeDynamics,
    testing::ValuesIn(trees_and_chains({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18, 20, 100, 1000}, {7, 30, 200})),
    [](const auto& kind) { return kind.param.name; });

TEST_P(TreeDynamics, EffortsAreMassTimesAccelerationAndWhatRemains) {
  const Eigen::VectorXd all = efforts(a), remaining = efforts(zero());
  Eigen::VectorXd accelerating(mechanism.nv);
  mass_matrix().multiply(a.data(), accelerating.data());
  expect_within(accelerating + remaining - all, 2 * (rounding(a) + rounding(zero())));
}

TEST_P(TreeDynamics, ArticulatedBodiesInvertInverseDynamics) {
  const Eigen::VectorXd all = efforts(a);
  Eigen::VectorXd found(mechanism.nv);
  ArticulatedBodies articulated(layout, inertias);
  ASSERT_TRUE(articulated.evaluate(move(q, v, zero()), gravity, on_nodes, all, found));
  expect_within(efforts(found) - all, 2 * (rounding(found) + rounding(zero())));
}

TEST_P(TreeDynamics, FactorsInvertInverseDynamics) {
  const Eigen::VectorXd all = efforts(a);
  Eigen::VectorXd found(mechanism.nv);
  FactoredDynamics factored(layout, inertias);
  ASSERT_TRUE(factored.evaluate(move(q, v, zero()), gravity, on_nodes, all, found));
  expect_within(efforts(found) - all, 2 * (rounding(found) + rounding(zero())));
}

// Accelerations, scaled so that the mass matrix has ones on its diagonal, are off by the rounding of efforts, scaled
// as well, over the least eigenvalue.
TEST_P(TreeDynamics, BothGiveTheAccelerationsToRoundingTimesCondition) {
  if (mechanism.nv > 300) GTEST_SKIP() << "eigenvalues of a great matrix";
  const Eigen::VectorXd all = efforts(a);
  Eigen::VectorXd by_bodies(mechanism.nv), by_factors(mechanism.nv);
  ArticulatedBodies articulated(layout, inertias);
  FactoredDynamics factored(layout, inertias);
  ASSERT_TRUE(articulated.evaluate(move(q, v, zero()), gravity, on_nodes, all, by_bodies));
  ASSERT_TRUE(factored.evaluate(kinematics, gravity, on_nodes, all, by_factors));
  Eigen::MatrixXd m;
  mass_matrix().dense(m);
  if (m.size() == 0) return;
  const Eigen::VectorXd root = m.diagonal().cwiseSqrt(), inverse = root.cwiseInverse();
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * m * inverse.asDiagonal();
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues()[0];
  const double off = 2 * (rounding(a) + rounding(zero())).cwiseProduct(inverse).norm() / least;
  EXPECT_LE((by_bodies - a).cwiseProduct(root).norm(), off);
  EXPECT_LE((by_factors - a).cwiseProduct(root).norm(), off);
}

TEST_P(TreeDynamics, MassMatrixIsTheHessianOfKineticEnergy) {
  if (mechanism.nv > 60) GTEST_SKIP() << "all pairs of rates";
  Eigen::MatrixXd m;
  mass_matrix().dense(m);
  const auto energy = [&](const Eigen::VectorXd& rates) { return kinetic_energy(inertias, move(q, rates, zero())); };
  for (std::uint32_t i = 0; i < mechanism.nv; ++i) {
    const Eigen::VectorXd one = Eigen::VectorXd::Unit(mechanism.nv, i);
    for (std::uint32_t j = 0; j <= i; ++j) {
      const Eigen::VectorXd other = Eigen::VectorXd::Unit(mechanism.nv, j);
      const double together = energy(one + other), each = energy(one) + energy(other);
      EXPECT_NEAR(m(i, j), i == j ? 2 * energy(one) : together - each,
                  16 * eps * static_cast<double>(mechanism.nodes) * (together + each));
      EXPECT_EQ(m(i, j), m(j, i));
    }
  }
}

TEST_P(TreeDynamics, FactorsMultiplyToTheMassMatrix) {
  const TreeMatrix m = mass_matrix();
  TreeFactors factors(layout);
  ASSERT_TRUE(factors.factorise_copy(m));
  Eigen::VectorXd product(mechanism.nv), solved = a, half = a;
  factors.solve(solved.data());
  m.multiply(solved.data(), product.data());
  // Backward stable: as if every entry had been off by as many roundings as terms were subtracted from it.
  const Eigen::VectorXd size = solved.cwiseAbs();
  // Entries of L^T D L are bounded by the roots of their diagonals.
  double sum = 0.0;
  for (std::uint32_t p = 0; p < layout.rates(); ++p) {
    sum += std::sqrt(m.row(p)[layout.depth(p) - 1]) * size[layout.rate(p)];
  }
  for (std::uint32_t p = 0; p < layout.rates(); ++p) {
    const std::uint32_t k = layout.rate(p);
    const double entry = std::sqrt(m.row(p)[layout.depth(p) - 1]);
    EXPECT_LE(std::abs(product[k] - a[k]), 4 * eps * static_cast<double>(layout.rates() + 4) * entry * sum) << k;
  }
  factors.half_solve(half.data());
  EXPECT_NEAR(half.squaredNorm(), a.dot(solved), 1e3 * eps * half.squaredNorm());
  factors.other_half_solve(half.data());
  EXPECT_LE((half - solved).norm(), 1e3 * eps * solved.norm());
}

TEST_P(TreeDynamics, DeterminantIsThatOfTheMassMatrix) {
  if (mechanism.nv > 300) GTEST_SKIP() << "a great matrix";
  const TreeMatrix m = mass_matrix();
  TreeFactors factors(layout);
  ASSERT_TRUE(factors.factorise_copy(m));
  Eigen::MatrixXd dense;
  m.dense(dense);
  if (dense.size() == 0) return;
  const Eigen::MatrixXd l = dense.llt().matrixL();
  EXPECT_NEAR(factors.log_determinant(), 2 * l.diagonal().array().log().sum(), 1e-9);
}

TEST_P(TreeDynamics, PowerOfEffortsAndWrenchesIsTheRateOfEnergy) {
  if (mechanism.nodes > 30) GTEST_SKIP() << "moves too fast for differences";
  v /= mechanism.nodes, a /= mechanism.nodes;
  const Eigen::VectorXd all = efforts(a);
  double power = all.dot(v);
  for (Node node = 1; node < mechanism.nodes; ++node) {
    power += on_nodes[node].moment.dot(kinematics.motions[node].angular_velocity) +
             on_nodes[node].force.dot(kinematics.motions[node].velocity);
  }
  double size = 0.0;
  const double rate = derivative([&](double t) {
    Eigen::VectorXd moved = q;
    integrate(mechanism, q, t * v + t * t / 2 * a, moved);
    const MechanicalState state = mechanical_state(inertias, move(moved, v + t * a, zero()), gravity);
    size = std::max(size, std::abs(state.kinetic) + state.mass * gravity.norm() * mechanism.nodes);
    return state.kinetic + state.potential;
  });
  // As for the kinematics: 1e-12 of what changes within a second.
  EXPECT_NEAR(power, rate, 1e-11 * size);
}

TEST_P(TreeDynamics, GroundTakesTheRateOfMomentum) {
  if (mechanism.nodes > 30) GTEST_SKIP() << "moves too fast for differences";
  v /= mechanism.nodes, a /= mechanism.nodes;
  efforts(v, a, Vector3::Zero(), {});
  const Wrench on_ground = carried[0];  // what the ground must put on the first bodies
  double size = 1.0;
  const auto momentum = [&](double t, int part) {
    Eigen::VectorXd moved = q;
    integrate(mechanism, q, t * v + t * t / 2 * a, moved);
    const MechanicalState state = mechanical_state(inertias, move(moved, v + t * a, zero()), gravity);
    size = std::max(size, state.mass * mechanism.nodes);
    const Vector3 about_origin = state.angular_momentum + state.centre.cross(state.momentum);
    return part < 3 ? about_origin[part] : state.momentum[part - 3];
  };
  for (int part = 0; part < 6; ++part) {
    const double rate = derivative([&](double t) { return momentum(t, part); });
    EXPECT_NEAR(rate, part < 3 ? on_ground.moment[part] : on_ground.force[part - 3], 1e-11 * size) << part;
  }
}

TEST_P(TreeDynamics, EffortsArePartsOfTheJointsWrenches) {
  const Eigen::VectorXd all = efforts(a);
  const Eigen::VectorXd tolerance = rounding(a);
  std::vector<Wrench> of_steps(mechanism.steps.size());
  joint_wrenches(mechanism, kinematics, carried, of_steps);
  for (std::size_t i = 0; i < mechanism.steps.size(); ++i) {
    const TreeStep& step = mechanism.steps[i];
    const Joint& joint = mechanism.joints[step.joint.index()];
    const Pose& outlet = step.reversed ? kinematics.near[i] : kinematics.far[i];
    Subspace s(6, joint.nv);
    ASSERT_TRUE(joint.subspace(q.data() + joint.q, s));
    for (std::uint32_t k = 0; k < joint.nv; ++k) {
      const Vector3 turn = outlet.rotation * s.col(k).head<3>(), slide = outlet.rotation * s.col(k).tail<3>();
      const double effort = turn.dot(of_steps[i].moment) + slide.dot(of_steps[i].force);
      EXPECT_NEAR(effort, all[joint.v + k], tolerance[joint.v + k]) << joint.name;
    }
  }
}

/// Only joints that the reference knows.
class ProductTree : public TreeDynamics {};

std::string of_products(std::string text) {
  for (const char* callback : {"acme.varying_screw", "acme.bare_screw"}) {
    for (std::size_t at; (at = text.find(callback)) != std::string::npos;) {
      const std::size_t end = text.find("\ninlet", at);
      text.replace(at, end - at, "spherical'");
    }
  }
  return text;
}

std::vector<Kind> product_trees() {
  std::vector<Kind> result = trees_and_chains({1, 2, 3, 5, 8, 13, 20, 100}, {7, 30, 200});
  for (Kind& kind : result) kind.text = of_products(kind.text);
  return result;
}

INSTANTIATE_TEST_SUITE_P(Of, ProductTree, testing::ValuesIn(product_trees()),
                         [](const auto& kind) { return kind.param.name; });

TEST_P(ProductTree, EffortsAreThoseOfTheReference) {
  SpatialReference<long double> reference(mechanism, inertias);
  const auto exact = reference.efforts(q, v, a, gravity);
  std::fill(on_nodes.begin(), on_nodes.end(), Wrench{});
  const Eigen::VectorXd found = efforts(a);
  expect_within((found.cast<long double>() - exact).cast<double>(), rounding(a));
}

TEST_P(ProductTree, MassMatrixIsThatOfTheReference) {
  SpatialReference<long double> reference(mechanism, inertias);
  const auto exact = reference.mass(q);
  const TreeMatrix m = mass_matrix();
  Eigen::MatrixXd dense;
  m.dense(dense);
  for (std::uint32_t p = 0; p < layout.rates(); ++p) {
    const std::uint32_t k = layout.rate(p);
    for (std::uint32_t i = 0; i < mechanism.nv; ++i) {
      // Of each other's sizes; more than rounding of positions that are sums along the way.
      const double size = std::sqrt(m.size(p) * m.size(layout.number(i)));
      EXPECT_LE(std::abs(static_cast<double>(dense(k, i) - exact(k, i))), 8 * eps * layout.depth(p) * size)
          << k << " " << i;
    }
  }
}

}  // namespace
}  // namespace koppel::test

// First derivatives of the dynamics of trees: those that dual numbers carry through the textbook's formulas,
// differences where the textbook has none, and what holds of them whatever the tree.
#include "dynamics/tree_derivatives.hpp"

#include <gtest/gtest.h>

#include "dynamics/tree_dynamics.hpp"
#include "moving_tree.hpp"
#include "spatial_reference.hpp"

namespace koppel::test {
namespace {

struct Kind {
  std::string name;
  std::string text;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

/// Two bodies that move alike, the joint of a kind between them, and a third beyond: something before and beyond it.
std::string between_others(const JointCase& kind, bool reversed) {
  Random random(11);
  std::string text = "[scene]\nlength = 1\n[[body]]\nname = 'b1'\n[[body]]\nname = 'b2'\n[[body]]\nname = 'b3'\n";
  text += "[[joint]]\nname = 'before'\ntype = 'universal'\ninlet = " + random_place(random, "ground") +
          "\noutlet = " + random_place(random, "b1") + "\n";
  text += "[[joint]]\nname = 'joint'\n" + kind.text + "\ninlet = " + random_place(random, reversed ? "b2" : "b1") +
          "\noutlet = " + random_place(random, reversed ? "b1" : "b2") + "\n";
  text += "[[joint]]\nname = 'beyond'\ntype = 'cylindrical'\ninlet = " + random_place(random, "b2") +
          "\noutlet = " + random_place(random, "b3") + "\n";
  return text;
}

bool is_product(const JointCase& kind) {
  return kind.name != "pointing" && kind.name != "cam" && kind.name != "varying_screw" && kind.name != "bare_screw";
}

std::vector<Kind> joints(bool products) {
  std::vector<Kind> result;
  std::vector<JointCase> kinds = all_joints();
  kinds.push_back({"cam", "type = 'odd.cam'", 1e-10});
  for (const JointCase& kind : kinds) {
    if (is_product(kind) != products) continue;
    result.push_back({kind.name, between_others(kind, false)});
    result.push_back({kind.name + "_reversed", between_others(kind, true)});
  }
  return result;
}

std::string of_products(std::string text) {
  for (const char* callback : {"acme.varying_screw", "acme.bare_screw"}) {
    for (std::size_t at; (at = text.find(callback)) != std::string::npos;) {
      text.replace(at, text.find("\ninlet", at) - at, "spherical'");
    }
  }
  return text;
}

/// Trees that the reference knows.
std::vector<Kind> products() {
  std::vector<Kind> result = joints(true);
  for (const unsigned n : {1, 2, 3, 5, 8, 13, 20, 40}) {
    result.push_back({numbered("tree_", n), of_products(random_tree(n, n))});
  }
  for (const unsigned n : {7, 30}) result.push_back({numbered("chain_", n), chain_text(n, n)});
  return result;
}

/// All kinds of joints, also those that core knows by callbacks only.
std::vector<Kind> all() {
  std::vector<Kind> result = joints(true), callbacks = joints(false);
  result.insert(result.end(), callbacks.begin(), callbacks.end());
  for (const unsigned n : {3, 8, 20}) result.push_back({numbered("tree_", n), resisting_tree(n, n)});
  return result;
}

struct Derivatives {
  RowMatrix by_q, by_v;
};

constexpr double step = 1e-2;
/// What central differences of sixth order with this step make of rounding.
constexpr double enlargement = 2 * (45 + 9 + 1) / 60.0 / step;

class DerivativesOf : public testing::TestWithParam<Kind>, public MovingTree {
 protected:
  DerivativesOf() : DerivativesOf(GetParam().text) {}
  explicit DerivativesOf(const std::string& text) : MovingTree(text, 7) {
    std::fill(on_nodes.begin(), on_nodes.end(), Wrench{});
  }

  Derivatives derivatives(const Eigen::VectorXd& rates, const Eigen::VectorXd& accelerations) {
    Derivatives result{RowMatrix::Zero(mechanism.nv, mechanism.nv), RowMatrix::Zero(mechanism.nv, mechanism.nv)};
    EXPECT_TRUE(forward_position(mechanism, q.data(), kinematics));
    EXPECT_TRUE(
        TreeDerivatives(layout, inertias)
            .evaluate(kinematics, gravity, q.data(), rates.data(), accelerations.data(), result.by_q, result.by_v));
    return result;
  }

  /// What rounding may change of a row of derivatives. They are made of the terms that efforts are made of, with a rate
  /// of one in the place of the one that they are taken by; displacements by a radian or a metre change arms, of about
  /// a metre, by no more than these are long. Products of two change twice.
  Eigen::VectorXd row_rounding() {
    const Eigen::VectorXd kept = v;
    v.setOnes();
    Eigen::VectorXd result = 4.0 * rounding(a);
    v = kept;
    return result;
  }

  bool has(const char* type) const { return GetParam().text.find(type) != std::string::npos; }
  /// How often the bias of a joint is a difference of differences.
  int layers() const { return has("bare_screw") || has("pointing") || has("odd.cam") ? 2 : 0; }
  bool has_callbacks() const { return layers() > 0 || has("varying_screw"); }
};

class Products : public DerivativesOf {};

INSTANTIATE_TEST_SUITE_P(Of, Products, testing::ValuesIn(products()), [](const auto& kind) { return kind.param.name; });

TEST_P(Products, AreThoseOfTheReferenceInDualNumbers) {
  using Number = Dual<long double>;
  SpatialReference<Number> reference(mechanism, inertias);
  const Derivatives found = derivatives(v, a);
  const Eigen::VectorXd tolerance = row_rounding();
  for (std::uint32_t j = 0; j < mechanism.nv; ++j) {
    Eigen::Matrix<Number, Eigen::Dynamic, 1> faster = v.cast<Number>();
    faster[j].dual = 1;
    const auto by_q = reference.efforts(displaced(mechanism, q, j), v, a, gravity);
    const auto by_v = reference.efforts(q, faster, a, gravity);
    for (std::uint32_t k = 0; k < mechanism.nv; ++k) {
      EXPECT_NEAR(found.by_q(k, j), static_cast<double>(by_q[k].dual), tolerance[k]) << k << " " << j;
      EXPECT_NEAR(found.by_v(k, j), static_cast<double>(by_v[k].dual), tolerance[k]) << k << " " << j;
    }
  }
}

class AnyJoints : public DerivativesOf {
 protected:
  /// Of the efforts at a displacement and a change of rates, each t times one.
  template <typename Change>
  Eigen::VectorXd slope(const Change& change) {
    const Eigen::VectorXd q_here = q, v_here = v;
    const auto at = [&](double t) {
      change(t);
      Eigen::VectorXd result = efforts(a);
      q = q_here, v = v_here;
      return result;
    };
    const auto odd = [&](double t) { return Eigen::VectorXd(at(t) - at(-t)); };
    return (45 * odd(step) - 9 * odd(2 * step) + odd(3 * step)) / (60 * step);
  }
};

INSTANTIATE_TEST_SUITE_P(Of, AnyJoints, testing::ValuesIn(all()), [](const auto& kind) { return kind.param.name; });

// Efforts are polynomials of fourth degree at most in sines and cosines of an angle: what a difference leaves out is
// below step^6 / 140 of 4^7 times them. Rounding in it is enlarged once, and once more for each difference inside.
TEST_P(AnyJoints, AreTheSlopesOfTheEfforts) {
  const Derivatives found = derivatives(v, a);
  const Eigen::VectorXd noise = row_rounding();
  const double truncation = std::pow(step, 6) / 140 * std::pow(4, 7) / (8 * eps);  // noise is some 8 eps of the size
  const double tolerance = truncation + std::pow(enlargement, layers() + 1);
  for (std::uint32_t j = 0; j < mechanism.nv; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(mechanism.nv, j);
    const Eigen::VectorXd by_q = slope([&](double t) { integrate(mechanism, Eigen::VectorXd(q), t * unit, q); });
    const Eigen::VectorXd by_v = slope([&](double t) { v += t * unit; });
    for (std::uint32_t k = 0; k < mechanism.nv; ++k) {
      EXPECT_NEAR(found.by_q(k, j), by_q[k], tolerance * noise[k]) << k << " " << j;
      EXPECT_NEAR(found.by_v(k, j), by_v[k], tolerance * noise[k]) << k << " " << j;
    }
  }
}

TEST_P(AnyJoints, ByRatesVanishAtRest) { EXPECT_TRUE(derivatives(zero(), a).by_v.isZero(0.0)); }

// What rates cost is quadratic in them: v . d/dv is twice that (Euler).
TEST_P(AnyJoints, ByRatesAlongTheRatesAreTwiceWhatTheRatesCost) {
  const Eigen::VectorXd along = derivatives(v, a).by_v * v;
  const Eigen::VectorXd cost = efforts(v, zero(), Vector3::Zero(), {});
  const double tolerance = std::pow(enlargement, layers()) * (2 + v.lpNorm<1>());
  const Eigen::VectorXd noise = row_rounding();
  for (std::uint32_t k = 0; k < mechanism.nv; ++k) EXPECT_NEAR(along[k], 2 * cost[k], tolerance * noise[k]) << k;
}

/// Trees on a table that turns about the vertical, and slides along some direction.
class OnATable : public DerivativesOf {
 protected:
  OnATable() : DerivativesOf(on_table(GetParam().text)) { gravity = {0, 0, -9.81}; }

  static std::string on_table(const std::string& text) {
    std::string result = text;
    const std::string ground = "on = 'ground'";
    for (std::size_t at; (at = result.find(ground)) != std::string::npos;) {
      result.replace(at, ground.size(), "on = 'table'");
    }
    const std::string end = "\noutlet = '";
    return result +
           "[[body]]\nname = 'slide'\n[[body]]\nname = 'table'\n[[joint]]\nname = 'sliding'\ntype = "
           "'prismatic'\ninlet = { on = 'ground', rotate = [['x', 0.7]] }" +
           end + "slide'\n[[joint]]\nname = 'turning'\ntype = 'revolute'\ninlet = { on = 'slide', rotate = [['x', " +
           "-0.7]] }" + end + "table'\n";
  }

  std::uint32_t rate(const std::string& joint) const { return built.joint(joint).v; }
};

INSTANTIATE_TEST_SUITE_P(Of, OnATable, testing::ValuesIn(all()), [](const auto& kind) { return kind.param.name; });

// Sliding at a constant velocity, it stands in an inertial frame.
TEST_P(OnATable, NothingDependsOnWhereItStands) {
  a[rate("sliding")] = 0.0;
  const Derivatives found = derivatives(v, a);
  const Eigen::VectorXd tolerance = row_rounding();
  for (std::uint32_t k = 0; k < mechanism.nv; ++k) {
    EXPECT_NEAR(found.by_q(k, rate("sliding")), 0.0, tolerance[k]) << k;
    EXPECT_NEAR(found.by_v(k, rate("sliding")), 0.0, tolerance[k]) << k;
    if (k == rate("sliding")) continue;  // its effort has a direction that does not turn
    EXPECT_NEAR(found.by_q(k, rate("turning")), 0.0, tolerance[k]) << k;
  }
}

TEST(Chains, AtRestHaveASymmetricStiffnessOfGravity) {
  for (const unsigned n : {2u, 7u, 30u}) {
    MovingTree tree(chain_text(n, n), 7);
    RowMatrix by_q(n, n), by_v(n, n);
    const Eigen::VectorXd rest = tree.zero();
    tree.v.setOnes();  // for the size of rounding only
    const Eigen::VectorXd tolerance = 4 * tree.rounding(rest);
    ASSERT_TRUE(TreeDerivatives(tree.layout, tree.inertias)
                    .evaluate(tree.move(tree.q, rest, rest), tree.gravity, tree.q.data(), rest.data(), rest.data(),
                              by_q, by_v));
    for (Eigen::Index i = 0; i < by_q.rows(); ++i) {
      for (Eigen::Index j = 0; j < i; ++j) EXPECT_NEAR(by_q(i, j), by_q(j, i), std::max(tolerance[i], tolerance[j]));
    }
  }
}

// Rounding of positions grows with their distance, and with it that of arms; but no moment is taken about a far point.
TEST(Chains, FarAwayHaveTheSameDerivatives) {
  constexpr Eigen::Index n = 7;
  constexpr double distance = 1e6;
  const std::string text = chain_text(n, n);
  std::string moved = replaced(text, "on = 'ground'", "on = 'far'");
  moved +=
      "[[body]]\nname = 'far'\n[[joint]]\nname = 'away'\ntype = 'weld'\noutlet = 'far'\n"
      "inlet = { on = 'ground', at = [1e6, 0, 0] }\n";
  MovingTree near(text, 7);
  const Built built(moved);
  Inertias inertias = near.inertias;
  inertias.of_node.emplace_back();
  inertias.has_mass.push_back(false);
  TreeDynamics here(near.built.mechanism, near.inertias), there(built.mechanism, inertias);
  ASSERT_FALSE(here.inverse_derivatives(near.q.data(), near.v.data(), near.a.data()));
  ASSERT_FALSE(there.inverse_derivatives(near.q.data(), near.v.data(), near.a.data()));
  near.v.setOnes();  // for the size of rounding
  const Eigen::VectorXd tolerance = 4 * distance * near.rounding(near.a);
  for (Eigen::Index k = 0; k < n; ++k) {
    EXPECT_LE((here.by_q() - there.by_q()).row(k).lpNorm<Eigen::Infinity>(), tolerance[k]) << k;
    EXPECT_LE((here.by_v() - there.by_v()).row(k).lpNorm<Eigen::Infinity>(), tolerance[k]) << k;
  }
}

class Forward : public DerivativesOf {};

INSTANTIATE_TEST_SUITE_P(Of, Forward, testing::ValuesIn([] {
                           std::vector<Kind> result;
                           for (const unsigned n : {1, 2, 5, 13, 40}) {
                             result.push_back({numbered("tree_", n), resisting_tree(n, n)});
                           }
                           result.push_back({"chain_7", chain_text(7, 7)});
                           return result;
                         }()),
                         [](const auto& kind) { return kind.param.name; });

// Efforts stay as they are when accelerations give way: mass x d(acceleration) = - d(effort). As backward stable as the
// factors are: as if every entry of the mass matrix had been off by as many roundings as terms are subtracted from it.
TEST_P(Forward, TimesMassIsMinusInverse) {
  TreeDynamics dynamics(built.mechanism, inertias);
  const Eigen::VectorXd given = a;
  ASSERT_FALSE(dynamics.forward_derivatives(q.data(), v.data(), given.data()));
  const Eigen::MatrixXd by_q = dynamics.by_q(), by_v = dynamics.by_v(), by_effort = dynamics.by_effort();
  const Eigen::VectorXd accelerations = dynamics.accelerations();
  ASSERT_FALSE(dynamics.inverse_derivatives(q.data(), v.data(), accelerations.data()));
  ASSERT_FALSE(dynamics.mass(q.data()));
  const Eigen::MatrixXd& mass = dynamics.mass_matrix();
  const Eigen::VectorXd root = mass.diagonal().cwiseSqrt();
  const double each = 4 * eps * static_cast<double>(mechanism.nv + 4);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(mechanism.nv, mechanism.nv);
  const auto expect_solved = [&](const Eigen::MatrixXd& x, const Eigen::MatrixXd& right) {
    const Eigen::MatrixXd off = mass * x - right, tolerance = each * root * (root.transpose() * x.cwiseAbs());
    EXPECT_TRUE((off.cwiseAbs().array() <= tolerance.array()).all()) << off;
  };
  expect_solved(by_q, -Eigen::MatrixXd(dynamics.by_q()));
  expect_solved(by_v, -Eigen::MatrixXd(dynamics.by_v()));
  expect_solved(by_effort, one);
}

TEST_P(Forward, AccelerationsAreThoseOfArticulatedBodies) {
  TreeDynamics dynamics(built.mechanism, inertias);
  ASSERT_FALSE(dynamics.forward(q.data(), v.data(), a.data()));
  const Eigen::VectorXd by_bodies = dynamics.accelerations();
  ASSERT_FALSE(dynamics.inverse(q.data(), v.data(), by_bodies.data()));
  const Eigen::VectorXd found = dynamics.efforts(), tolerance = 2 * (rounding(by_bodies) + rounding(zero()));
  for (std::uint32_t k = 0; k < mechanism.nv; ++k) EXPECT_NEAR(found[k], a[k], tolerance[k]) << k;
}

constexpr const char* pendulum =
    "[scene]\nlength = 1\ngravity = [0, -9.81, 0]\n[[body]]\nname = 'bob'\ntype = 'point_mass'\nmass = 2\n"
    "at = [0, -0.5, 0]\n[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'bob'\n";

TEST(Pendulum, IsThatOfTheTextbook) {
  const Built built(pendulum);
  TreeDynamics dynamics(built.mechanism, *inertias(*built));
  const double q = 0.7, v = 1.3, effort = 0.4, mass = 2.0, length = 0.5, g = 9.81;
  ASSERT_FALSE(dynamics.forward_derivatives(&q, &v, &effort));
  const double inertia = mass * length * length;
  EXPECT_NEAR(dynamics.accelerations()[0], effort / inertia - g / length * std::sin(q), 32 * eps * g / length);
  EXPECT_NEAR(dynamics.by_q()(0, 0), -g / length * std::cos(q), 32 * eps * g / length);
  EXPECT_NEAR(dynamics.by_v()(0, 0), 0.0, 32 * eps);
  EXPECT_NEAR(dynamics.by_effort()(0, 0), 1 / inertia, 8 * eps / inertia);
}

TEST(TreeDynamics, NamesWhatMovesWithoutMass) {
  const Built built(replaced(pendulum, "type = 'point_mass'\nmass = 2\nat = [0, -0.5, 0]\n", ""));
  TreeDynamics dynamics(built.mechanism, *inertias(*built));
  const double q = 0.0;
  for (const auto& obstacle :
       {dynamics.forward(&q, nullptr, nullptr), dynamics.forward_derivatives(&q, nullptr, nullptr)}) {
    ASSERT_TRUE(obstacle);
    EXPECT_EQ(obstacle->code, Code::massless);
    EXPECT_EQ(obstacle->element, "coordinate pin.angle");
  }
  EXPECT_FALSE(dynamics.inverse_derivatives(&q, nullptr, nullptr));
}

TEST(TreeDynamics, NormalisesQuaternions) {
  MovingTree tree(resisting_tree(8, 8), 7);
  TreeDynamics dynamics(tree.built.mechanism, tree.inertias);
  ASSERT_FALSE(dynamics.inverse(tree.q.data(), tree.v.data(), tree.a.data()));
  const Eigen::VectorXd efforts = dynamics.efforts();
  for (const StateBlock& block : tree.mechanism.blocks) {
    if (block.kind == BlockKind::quaternion) tree.q.segment<4>(block.q) *= 4.0;
  }
  ASSERT_FALSE(dynamics.inverse(tree.q.data(), tree.v.data(), tree.a.data()));
  EXPECT_EQ(dynamics.efforts(), efforts);
}

}  // namespace
}  // namespace koppel::test

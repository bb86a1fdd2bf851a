// Dynamics of spanning trees through the C ABI: batches, what may be NULL, what is refused and named.
#include <cmath>
#include <limits>

#include "folders.hpp"
#include "host.hpp"

namespace koppel::test {
namespace {

constexpr koppel_status refused = KOPPEL_INVALID_ARGUMENT;
constexpr double untouched = -7.0;

Tree make_tree(const Mechanism& mechanism) {
  koppel_tree* tree = nullptr;
  EXPECT_EQ(koppel_tree_create(mechanism.get(), &tree, nullptr), KOPPEL_OK);
  return Tree(tree);
}

/// The six results that are arrays by rates, or matrices.
struct Results {
  Results(std::size_t count, std::size_t nv)
      : efforts(count * nv, untouched),
        accelerations(efforts),
        mass(count * nv * nv, untouched),
        by_q(mass),
        by_v(mass),
        a_by_q(mass),
        a_by_v(mass),
        a_by_effort(mass),
        kinetic(count, untouched),
        potential(kinetic),
        masses(kinetic),
        centre(3 * count, untouched),
        momentum(centre),
        angular_momentum(centre) {}

  bool operator==(const Results&) const = default;

  std::vector<double> efforts, accelerations, mass, by_q, by_v, a_by_q, a_by_v, a_by_effort, kinetic, potential, masses,
      centre, momentum, angular_momentum;
};

/// Everything, of `count` states from q, v and a on; results go `first` states into theirs. Efforts are a.
koppel_status evaluate(koppel_tree* tree, std::size_t count, const double* q, const double* v, const double* a,
                       std::size_t nv, Results& out, std::size_t first) {
  const auto at = [first](std::vector<double>& numbers, std::size_t width) { return numbers.data() + first * width; };
  const std::size_t square = nv * nv;
  return std::min(
      {koppel_tree_inverse_dynamics(tree, count, q, v, a, at(out.efforts, nv), nullptr),
       koppel_tree_forward_dynamics(tree, count, q, v, a, at(out.accelerations, nv), nullptr),
       koppel_tree_mass_matrix(tree, count, q, at(out.mass, square), nullptr),
       koppel_tree_energy(tree, count, q, v, at(out.kinetic, 1), at(out.potential, 1), nullptr),
       koppel_tree_momentum(tree, count, q, v, at(out.masses, 1), at(out.centre, 3), at(out.momentum, 3),
                            at(out.angular_momentum, 3), nullptr),
       koppel_tree_inverse_dynamics_derivatives(tree, count, q, v, a, at(out.by_q, square), at(out.by_v, square),
                                                nullptr),
       koppel_tree_forward_dynamics_derivatives(tree, count, q, v, a, at(out.a_by_q, square), at(out.a_by_v, square),
                                                at(out.a_by_effort, square), nullptr)});
}

class Trees : public ::testing::Test {
 protected:
  Trees() {
    const Reading start = read(host);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < nq; ++k) q.push_back(start.q[k] + 0.1 * static_cast<double>(i * k));
      for (std::size_t k = 0; k < nv; ++k) {
        v.push_back(std::cos(static_cast<double>(i + 3 * k)));
        a.push_back(std::sin(static_cast<double>(2 * i + k)));
      }
    }
  }

  static constexpr std::size_t count = 5;
  Host host{scenes_folder() + "/dynamics/double_pendulum.toml"};
  Tree tree = make_tree(host.mechanism);
  const std::size_t nq = host.sizes.coordinates, nv = host.sizes.rates;
  std::vector<double> q, v, a;
  koppel_error error = sized<koppel_error>();
};

TEST_F(Trees, OfABatchGiveWhatTheirStatesGiveOneByOne) {
  Results together(count, nv), one_by_one(count, nv);
  ASSERT_EQ(evaluate(tree.get(), count, q.data(), v.data(), a.data(), nv, together, 0), KOPPEL_OK);
  for (std::size_t i = count; i-- > 0;) {
    ASSERT_EQ(evaluate(tree.get(), 1, &q[i * nq], &v[i * nv], &a[i * nv], nv, one_by_one, i), KOPPEL_OK);
  }
  EXPECT_TRUE(together == one_by_one);
}

TEST_F(Trees, TakeNullForZero) {
  const std::vector<double> zero(count * nv);
  std::vector<double> by_null(count * nv), by_zero(count * nv);
  for (const double* rates : {static_cast<const double*>(nullptr), static_cast<const double*>(v.data())}) {
    const double* given = rates == nullptr ? zero.data() : rates;
    EXPECT_EQ(koppel_tree_inverse_dynamics(tree.get(), count, q.data(), rates, nullptr, by_null.data(), &error),
              KOPPEL_OK);
    EXPECT_EQ(koppel_tree_inverse_dynamics(tree.get(), count, q.data(), given, zero.data(), by_zero.data(), &error),
              KOPPEL_OK);
    EXPECT_EQ(by_null, by_zero);
    EXPECT_EQ(koppel_tree_forward_dynamics(tree.get(), count, q.data(), rates, nullptr, by_null.data(), &error),
              KOPPEL_OK);
    EXPECT_EQ(koppel_tree_forward_dynamics(tree.get(), count, q.data(), given, zero.data(), by_zero.data(), &error),
              KOPPEL_OK);
    EXPECT_EQ(by_null, by_zero);
  }
}

TEST_F(Trees, WriteOnlyWhatIsAskedFor) {
  Results all(count, nv), some(count, nv);
  ASSERT_EQ(evaluate(tree.get(), count, q.data(), v.data(), a.data(), nv, all, 0), KOPPEL_OK);
  EXPECT_EQ(koppel_tree_energy(tree.get(), count, q.data(), v.data(), nullptr, some.potential.data(), nullptr),
            KOPPEL_OK);
  EXPECT_EQ(some.potential, all.potential);
  EXPECT_EQ(koppel_tree_momentum(tree.get(), count, q.data(), v.data(), nullptr, some.centre.data(), nullptr, nullptr,
                                 nullptr),
            KOPPEL_OK);
  EXPECT_EQ(some.centre, all.centre);
  EXPECT_EQ(koppel_tree_inverse_dynamics_derivatives(tree.get(), count, q.data(), v.data(), a.data(), nullptr,
                                                     some.by_v.data(), nullptr),
            KOPPEL_OK);
  EXPECT_EQ(some.by_v, all.by_v);
  EXPECT_EQ(koppel_tree_forward_dynamics_derivatives(tree.get(), count, q.data(), v.data(), a.data(), nullptr, nullptr,
                                                     some.a_by_effort.data(), nullptr),
            KOPPEL_OK);
  EXPECT_EQ(some.a_by_effort, all.a_by_effort);
}

TEST_F(Trees, NeedAHandleAndTheirArrays) {
  Results out(count, nv);
  const Results before = out;
  Output<koppel_tree*> made;
  EXPECT_EQ(koppel_tree_create(nullptr, &made, &error), refused);
  EXPECT_EQ(koppel_tree_create(host.mechanism.get(), nullptr, &error), refused);
  EXPECT_TRUE(made.untouched());
  EXPECT_EQ(evaluate(nullptr, count, q.data(), v.data(), a.data(), nv, out, 0), refused);
  EXPECT_EQ(koppel_tree_energy(nullptr, count, q.data(), v.data(), nullptr, nullptr, &error), refused);
  EXPECT_EQ(koppel_tree_inverse_dynamics(tree.get(), count, nullptr, v.data(), a.data(), out.efforts.data(), &error),
            refused);
  EXPECT_STREQ(error.message, "q is NULL");
  EXPECT_EQ(koppel_tree_inverse_dynamics(tree.get(), count, q.data(), v.data(), a.data(), nullptr, &error), refused);
  EXPECT_STREQ(error.message, "efforts is NULL");
  EXPECT_EQ(koppel_tree_forward_dynamics(tree.get(), count, q.data(), v.data(), a.data(), nullptr, &error), refused);
  EXPECT_EQ(koppel_tree_mass_matrix(tree.get(), count, q.data(), nullptr, &error), refused);
  EXPECT_TRUE(out == before);
}

TEST_F(Trees, OfNoStatesAreFine) {
  Results out(0, nv);
  EXPECT_EQ(evaluate(tree.get(), 0, nullptr, nullptr, nullptr, nv, out, 0), KOPPEL_OK);
  EXPECT_EQ(koppel_tree_inverse_dynamics(tree.get(), 0, nullptr, nullptr, nullptr, nullptr, nullptr), KOPPEL_OK);
}

TEST_F(Trees, NameTheNumberThatIsNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (std::vector<double>* numbers : {&q, &v, &a}) {
      const double kept = numbers->back();
      numbers->back() = bad;
      Results out(count, nv);
      EXPECT_EQ(
          koppel_tree_inverse_dynamics(tree.get(), count, q.data(), v.data(), a.data(), out.efforts.data(), &error),
          refused);
      EXPECT_NE(std::string(error.message).find("state 4 of the batch"), std::string::npos) << error.message;
      EXPECT_TRUE(out == Results(count, nv));
      numbers->back() = kept;
    }
  }
}

/// A scene from a text, compiled.
Mechanism from_text(const Engine& engine, const std::string& text) {
  koppel_scene* scene = nullptr;
  EXPECT_EQ(koppel_scene_from_text(engine.get(), text.data(), text.size(), nullptr, nullptr, &scene, nullptr),
            KOPPEL_OK);
  const Scene owned(scene);
  return compile(scene);
}

TEST(Tree, NamesWhatMovesWithoutMass) {
  const Engine engine = make_engine();
  const Mechanism mechanism =
      from_text(engine,
                "schema = 1\n[[body]]\nname = 'bar'\n[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = 'ground'\n"
                "outlet = 'bar'\n");
  const Tree tree = make_tree(mechanism);
  auto error = sized<koppel_error>();
  const double q = 0.0;
  double a = untouched, by_q = untouched;
  EXPECT_EQ(koppel_tree_forward_dynamics(tree.get(), 1, &q, nullptr, nullptr, &a, &error), KOPPEL_SINGULAR);
  EXPECT_STREQ(error.element, "coordinate pin.angle");
  EXPECT_NE(std::string(error.message).find("state 0 of the batch"), std::string::npos) << error.message;
  EXPECT_EQ(
      koppel_tree_forward_dynamics_derivatives(tree.get(), 1, &q, nullptr, nullptr, &by_q, nullptr, nullptr, &error),
      KOPPEL_SINGULAR);
  EXPECT_EQ(a, untouched);
  EXPECT_EQ(by_q, untouched);
}

TEST(Tree, OfALoopIsOpenWhereItIsCut) {
  const Host host(scenes_folder() + "/dynamics/fourbar_free.toml");
  const Tree tree = make_tree(host.mechanism);
  const std::size_t nv = host.sizes.rates;
  auto cut = sized<koppel_closure>();
  ASSERT_EQ(koppel_mechanism_closure(host.mechanism.get(), 0, &cut, nullptr, 0), KOPPEL_OK);
  ASSERT_EQ(cut.kind, KOPPEL_CUT_JOINT);
  const auto at = static_cast<std::size_t>(cut.joint);  // every joint of this scene has one rate
  ASSERT_EQ(nv, host.sizes.joints);
  const std::vector<double> q = read(host).q, v(nv, 1.0);
  Results out(1, nv);
  ASSERT_EQ(evaluate(tree.get(), 1, q.data(), v.data(), v.data(), nv, out, 0), KOPPEL_OK);
  EXPECT_EQ(out.efforts[at], 0.0);
  EXPECT_EQ(out.accelerations[at], 0.0);
  for (const auto* matrix : {&out.mass, &out.by_q, &out.by_v, &out.a_by_q, &out.a_by_v, &out.a_by_effort}) {
    for (std::size_t k = 0; k < nv; ++k) {
      EXPECT_EQ((*matrix)[at * nv + k], 0.0);
      EXPECT_EQ((*matrix)[k * nv + at], 0.0);
    }
  }
}

TEST(Tree, OutlivesItsMechanism) {
  Tree tree;
  {
    const Host host(scenes_folder() + "/dynamics/double_pendulum.toml");
    tree = make_tree(host.mechanism);
  }
  const std::vector<double> q(2, 0.3);
  std::vector<double> efforts(2, untouched);
  EXPECT_EQ(koppel_tree_inverse_dynamics(tree.get(), 1, q.data(), nullptr, nullptr, efforts.data(), nullptr),
            KOPPEL_OK);
  EXPECT_NE(efforts[0], untouched);
  koppel_tree_destroy(nullptr);
}

}  // namespace
}  // namespace koppel::test

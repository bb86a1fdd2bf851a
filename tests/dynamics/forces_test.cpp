// Forces where they act: on nodes and rates of whole mechanisms. They answer each other, do not care where the world
// lies, lose what they say to lose, and are told by name when they fail.
#include "dynamics/forces.hpp"

#include <gtest/gtest.h>

#include "../mechanism/tree.hpp"
#include "../plugin/curve.hpp"
#include "folders.hpp"
#include "spatial/quaternion.hpp"
#include "spatial/rotation.hpp"

namespace koppel::test {
namespace {

/// Evaluates the forces of a mechanism at a position and rates.
struct Acting {
  explicit Acting(const Mechanism& m)
      : mechanism(m),
        kinematics(m),
        forces(m),
        states(m.internal_start.begin(), m.internal_start.end()),
        state_rates(states.size(), 0.0),
        switches(forces.switch_count()) {}

  void stand(const Eigen::VectorXd& where) {
    q = where;
    ASSERT_TRUE(forward_position(mechanism, q.data(), kinematics));
  }
  void move(const Eigen::VectorXd& rates) {
    v = rates;
    const Eigen::VectorXd a = Eigen::VectorXd::Zero(mechanism.nv);
    ASSERT_TRUE(forward_motion(mechanism, q.data(), v.data(), a.data(), kinematics));
  }
  bool act(double time = 0.0) {
    on_nodes.assign(mechanism.nodes, Wrench());
    efforts = Eigen::VectorXd::Zero(mechanism.nv);
    return forces.evaluate(kinematics, q.data(), v.data(), time, states.data(), on_nodes, efforts, state_rates.data());
  }
  double energy(const Eigen::VectorXd& where) {
    stand(where);
    double potential = std::nan("");
    EXPECT_TRUE(forces.energy(kinematics, q.data(), 0.0, states.data(), potential));
    return potential;
  }
  /// What wrenches and efforts deliver at the rates.
  double delivered() const {
    double power = efforts.dot(v);
    for (Node node = 1; node < mechanism.nodes; ++node) {
      const FrameMotion& motion = kinematics.motions[node];
      power += on_nodes[node].moment.dot(motion.angular_velocity) + on_nodes[node].force.dot(motion.velocity);
    }
    return power;
  }

  const Mechanism& mechanism;
  Kinematics kinematics;
  Forces forces;
  Eigen::VectorXd q, v, efforts;
  std::vector<double> states, state_rates, switches;
  std::vector<Wrench> on_nodes;
};

const std::vector<std::string> pair_forces = {
    "type = 'spring'\nstiffness = 3\nlength = 0.7\ndamping = 0.4\ntable = [[0, 0], [0.5, 1], [1, 5]]\n",
    "type = 'bushing'\nstiffness = [1, 2, 3]\nrotational_stiffness = [0.3, 0.2, 0.1]\ndamping = [0.1, 0.2, 0.3]\n"
    "rotational_damping = [0.03, 0.02, 0.01]\n"};

/// A force between places on two bodies at random; body 0 is the ground.
std::string between(const std::string& name, const std::string& type, const std::string& a, const std::string& b,
                    Random& random) {
  const bool is_wrench = type.find("'wrench'") != std::string::npos;
  return "[[force]]\nname = '" + name + "'\n" + type + (is_wrench ? "against = " : "from = ") +
         random_place(random, a) + (is_wrench ? "\non = " : "\nto = ") + random_place(random, b) + "\n";
}

class OnATree : public testing::TestWithParam<unsigned> {
 protected:
  Random random{GetParam() + 100};
};
INSTANTIATE_TEST_SUITE_P(Random, OnATree, testing::Range(0u, 20u));

// A wrench of size F with levers up to r is rounded to a few eps F r, as it is carried to either node.
TEST_P(OnATree, TwoFramesAnswerEachOther) {
  std::string text = random_tree(5, GetParam());
  text += between("s", pair_forces[0], "b2", "b5", random) + between("b", pair_forces[1], "b4", "b1", random) +
          between("g", pair_forces[0], "ground", "b3", random) +
          between("w", "type = 'wrench'\nforce = [1, -2, 3]\nmoment = [0.4, 0.5, -0.6]\n", "b3", "b5", random);
  const Built built(text);
  Acting acting(*built);
  acting.stand(random_position(*built, random));
  acting.move(random_rates(built->nv, random));
  ASSERT_TRUE(acting.act());
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  double size = 0.0, reach = 1.0;
  for (Node node = 0; node < built->nodes; ++node) {
    const Wrench& wrench = acting.on_nodes[node];
    const Vector3& at = acting.kinematics.poses[node].position;
    force += wrench.force;
    moment += wrench.moment + at.cross(wrench.force);
    size += wrench.force.norm() + wrench.moment.norm();
    reach = std::max(reach, at.norm() + 2);
  }
  EXPECT_GT(size, 1.0);
  constexpr double eps = std::numeric_limits<double>::epsilon();
  EXPECT_LT(force.norm(), 10 * eps * size);
  EXPECT_LT(moment.norm(), 10 * eps * size * reach);
}

std::string with_all_stores(unsigned seed, Random& random) {
  return random_tree(4, seed) +
         "[[body]]\nname = 'c'\n[[joint]]\nname = 'turn'\ntype = 'cylindrical'\ninlet = 'b2'\noutlet = 'c'\n" +
         between("s", "type = 'spring'\nstiffness = 3\nlength = 0.1\ndamping = 0.4\n", "b2", "c", random) +
         between("b", pair_forces[1], "b4", "b1", random) +
         "[[force]]\nname = 'angle'\ntype = 'coordinate_spring'\nof = 'turn.angle'\nstiffness = 2\ndamping = 0.3\n"
         "[[force]]\nname = 'line'\ntype = 'coordinate_spring'\nof = 'turn.displacement'\nfree = 0.3\nstiffness = 5\n"
         "[[force]]\nname = 'rub'\ntype = 'friction'\nof = 'turn.angle'\ncoulomb = 0.5\nspeed = 0.1\n"
         "[[force]]\nname = 'drill'\ntype = 'motor'\nof = 'turn.angle'\neffort = 0.7\n"
         "[[force]]\nname = 'wind'\ntype = 'wrench'\naxes = 'world'\nforce = [1, 2, 3]\non = " +
         random_place(random, "b3") + "\n";
}

// Along constant rates energies E of about 10 J change in times of about T = 0.3 s: the sixth-order formula with steps
// of h = 1 ms leaves 7! (h/T)^6 / 140 E/T of their rate, 2e-12 W, and rounding, of long chains with levers of 10 m, a
// few 10 eps E/h.
TEST_P(OnATree, DeliverWhatTheyDoNotStoreOrLose) {
  const Built built(with_all_stores(GetParam(), random));
  Acting acting(*built);
  const Eigen::VectorXd q = random_position(*built, random, 0.5), v = 0.5 * random_rates(built->nv, random);
  Eigen::VectorXd moved(built->nq);
  const double gain = derivative(
      [&](double t) {
        integrate(*built, q, t * v, moved);
        return acting.energy(moved);
      },
      1e-3);
  acting.stand(q);
  acting.move(v);
  ASSERT_TRUE(acting.act());
  double dissipated = 0.0, external = 0.0;
  ASSERT_TRUE(
      acting.forces.power(acting.kinematics, q.data(), v.data(), 0.0, acting.states.data(), dissipated, external));
  EXPECT_GT(dissipated, 0.0);
  EXPECT_NEAR(acting.delivered(), external - gain - dissipated, 1e-10);
  // What motor and wind deliver, by hand.
  const Force& wind = built->forces.back();
  const FrameMotion at_wind = motion_of(acting.kinematics, wind.node_b, wind.pose_b.position);
  const double by_hand = 0.7 * v[built.joint("turn").v] + Vector3(1, 2, 3).dot(at_wind.velocity);
  EXPECT_NEAR(external, by_hand, 1e-13);
}

const char* const floating =
    "[scene]\nlength = 1\n[[body]]\nname = 'base'\n[[body]]\nname = 'arm'\n[[body]]\nname = 'hand'\n"
    "[[joint]]\nname = 'root'\ntype = 'free'\ninlet = 'ground'\noutlet = 'base'\n"
    "[[joint]]\nname = 'a'\ntype = 'universal'\ninlet = { on = 'base', at = [0.1, 0.2, 0.3] }\noutlet = 'arm'\n"
    "[[joint]]\nname = 'b'\ntype = 'cylindrical'\ninlet = { on = 'arm', at = [0.5, 0, 0] }\noutlet = 'hand'\n"
    "[[force]]\nname = 'turn'\ntype = 'coordinate_spring'\nof = 'b.angle'\nstiffness = 2\ndamping = 0.1\n";

// A kilometre away, positions are rounded to 1e-13 m each; stiffness and levers are below 10.
TEST(Forces, DoNotCareWhereTheWorldLies) {
  Random random(3);
  const Built built(floating + between("s", pair_forces[0], "hand", "base", random) +
                    between("b", pair_forces[1], "base", "hand", random));
  Eigen::VectorXd q = random_position(*built, random), v = random_rates(built->nv, random);
  Acting here(*built), there(*built);
  here.stand(q);
  here.move(v);
  ASSERT_TRUE(here.act());
  const Matrix3 turn = random.rotation();
  const Vector4 turned = quaternion_of_rotation<double>(turn * rotation_of_quaternion<double>(Vector4(q.head<4>())));
  q.head<4>() = turned;
  q.segment<3>(4) = (turn * q.segment<3>(4) + 1000 * random.direction()).eval();
  v.segment<3>(3) = (turn * v.segment<3>(3)).eval();
  there.stand(q);
  there.move(v);
  ASSERT_TRUE(there.act());
  EXPECT_GT(here.on_nodes[1].force.norm(), 0.1);
  for (Node node = 1; node < built->nodes; ++node) {
    EXPECT_LT((there.on_nodes[node].force - turn * here.on_nodes[node].force).norm(), 1e-11);
    EXPECT_LT((there.on_nodes[node].moment - turn * here.on_nodes[node].moment).norm(), 1e-11);
  }
  EXPECT_EQ(there.efforts, here.efforts);
}

TEST(Forces, ActOnTheFirstHalfOfABodyThatIsCut) {
  // Every joint has a coordinate that is used, so that the loop can only be opened by cutting a body.
  std::string text = "[scene]\nlength = 1\n";
  for (const std::string name : {"a", "b", "c"}) {
    text += "[[body]]\nname = '" + name + "'\n[[force]]\nname = 'on_" + name +
            "'\ntype = 'wrench'\nforce = [0, 0, 1]\non = '" + name + "'\n";
  }
  const char* const joints[][3] = {{"j", "ground", "a"}, {"k", "a", "b"}, {"l", "b", "c"}, {"m", "c", "ground"}};
  for (const auto& [name, inlet, outlet] : joints) {
    text += std::string("[[joint]]\nname = '") + name + "'\ntype = 'revolute'\nbetween = ['" + inlet + "', '" + outlet +
            "']\n[[force]]\nname = 'spring_" + name + "'\ntype = 'coordinate_spring'\nof = '" + name +
            ".angle'\nstiffness = 1\n";
  }
  const Built built(text);
  ASSERT_GT(built->nodes, built->bodies.size());
  Acting acting(*built);
  acting.stand(State(*built).q);
  acting.move(Eigen::VectorXd::Zero(built->nv));
  ASSERT_TRUE(acting.act());
  for (Node node = 1; node < built->nodes; ++node) {
    EXPECT_EQ(acting.on_nodes[node].force.z(), node < built->bodies.size() ? 1.0 : 0.0);
  }
}

TEST(Forces, HaveInternalStatesOneAfterAnother) {
  const Built built(
      std::string(floating) +
      "[[force]]\nname = 'first'\ntype = 'controller'\nof = 'b.angle'\nsetpoint = 1\nintegral = 2\n"
      "[[force]]\nname = 'second'\ntype = 'controller'\nof = 'b.displacement'\nsetpoint = 3\nintegral = 1\n");
  EXPECT_EQ(State(*built).internal, Eigen::Vector2d(0, 0));
  Acting acting(*built);
  EXPECT_EQ(acting.states, (std::vector<double>{0, 0}));
  acting.states = {5, 11};
  acting.stand(State(*built).q);
  acting.move(Eigen::VectorXd::Zero(built->nv));
  ASSERT_TRUE(acting.act());
  EXPECT_EQ(acting.state_rates, (std::vector<double>{1, 3}));
  EXPECT_EQ(acting.efforts[built.joint("b").v], 10.0);
  EXPECT_EQ(acting.efforts[built.joint("b").v + 1], 11.0);
}

TEST(Forces, TellTheirSwitchesOneAfterAnother) {
  const Built built(std::string(floating) +
                    "[[force]]\nname = 'low'\ntype = 'stop'\nof = 'b.angle'\nlower = -1\nstiffness = 2\n"
                    "[[force]]\nname = 'high'\ntype = 'stop'\nof = 'b.displacement'\nupper = 3\nstiffness = 2\n");
  Acting acting(*built);
  acting.stand(State(*built).q);
  acting.move(Eigen::VectorXd::Zero(built->nv));
  ASSERT_EQ(acting.switches.size(), 4u);
  ASSERT_TRUE(acting.forces.switches(acting.kinematics, acting.q.data(), acting.v.data(), 0.0, acting.states.data(),
                                     acting.switches.data()));
  EXPECT_EQ(acting.switches, (std::vector<double>{1, 1, 1, 3}));
}

TEST(StartRates, AreThoseOfTheSceneButOfDrivenCoordinates) {
  const Built built(
      "[[body]]\nname = 'a'\n[[body]]\nname = 'b'\n"
      "[[joint]]\nname = 'f'\ntype = 'free'\nbetween = ['ground', 'a']\n"
      "start_rate = { rotation = [1, 2, 3], y = 4 }\n"
      "[[joint]]\nname = 'c'\ntype = 'cylindrical'\nbetween = ['a', 'b']\nstart_rate = { angle = 5, displacement = 6 "
      "}\n"
      "[[drive]]\nof = 'c.angle'\ntype = 'constant'\nvalue = 1\n");
  const State state(*built);
  EXPECT_EQ(state.v, (Eigen::VectorXd(8) << 1, 2, 3, 0, 4, 0, 0, 6).finished());
  EXPECT_EQ(state.stage, Stage::assigned);
}

/// A force of a plugin that is loaded without complaint.
std::string bad_force(const std::string& file) {
  return std::string(floating) + "[[force]]\nname = 'odd'\ntype = 'bad.force'\nplugin = '" + test_plugins_folder() +
         "/bad/" + file + ".so'\non = 'hand'\nof = 'b.angle'\n";
}

struct Misdeed {
  std::string file, where;
};
void PrintTo(const Misdeed& misdeed, std::ostream* out) { *out << misdeed.file; }

class BadForce : public testing::TestWithParam<Misdeed> {};
INSTANTIATE_TEST_SUITE_P(Of, BadForce,
                         testing::Values(Misdeed{"act_fails", "evaluate"}, Misdeed{"act_nan", "evaluate"},
                                         Misdeed{"act_writes_nothing", "evaluate"}, Misdeed{"energy_nan", "energy"},
                                         Misdeed{"energy_fails", "energy"}, Misdeed{"dissipation_nan", "power"},
                                         Misdeed{"switches_nan", "switches"}, Misdeed{"good", ""}),
                         [](const auto& each) { return each.param.file; });

TEST_P(BadForce, IsToldByName) {
  const Built built(bad_force(GetParam().file));
  Acting acting(*built);
  ASSERT_EQ(acting.states.size(), 2u);
  acting.stand(State(*built).q);
  acting.move(Eigen::VectorXd::Zero(built->nv));
  const auto check = [&](const std::string& what, bool fine) {
    EXPECT_EQ(fine, GetParam().where.find(what) == std::string::npos) << what;
    if (fine) return;
    EXPECT_EQ(acting.forces.culprit(),
              "force odd of type bad.force (" + test_plugins_folder() + "/bad/" + GetParam().file + ".so)");
  };
  double number = 0.0, other = 0.0;
  const double *q = acting.q.data(), *v = acting.v.data(), *states = acting.states.data();
  check("evaluate", acting.act());
  check("energy", acting.forces.energy(acting.kinematics, q, 0.0, states, number));
  check("power", acting.forces.power(acting.kinematics, q, v, 0.0, states, number, other));
  check("switches", acting.forces.switches(acting.kinematics, q, v, 0.0, states, acting.switches.data()));
}

TEST(Forces, WithoutFiniteStatesToStartFromStopTheCompiler) {
  try {
    const Built built(bad_force("initial_nan"));
    FAIL() << "compiled";
  } catch (const std::runtime_error& refused) {
    const std::string told = refused.what();
    EXPECT_NE(told.find("force odd"), std::string::npos) << told;
    EXPECT_NE(told.find("bad.force"), std::string::npos) << told;
  }
}

TEST(Forces, OfParametersThatATypeRefusesStopTheCompiler) {
  try {
    const Built built(std::string(floating) +
                      "[[force]]\nname = 'load'\ntype = 'wrench'\non = 'hand'\naxes = 'mine'\nforce = [1, 0, 0]\n");
    FAIL() << "compiled";
  } catch (const std::runtime_error& refused) {
    const std::string told = refused.what();
    EXPECT_NE(told.find("force load"), std::string::npos) << told;
    EXPECT_NE(told.find("axes"), std::string::npos) << told;
  }
}

}  // namespace
}  // namespace koppel::test

// What joints and drives bear, against textbook formulas, the balance of every body, virtual work, and itself with the
// loops cut elsewhere.
#include "dynamics/reactions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "../closure/closed.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/inverse_dynamics.hpp"
#include "dynamics/simulation.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A scene at a time, moved by its drives or by its forces, and what its joints bear there.
struct Bearing : Closed {
  explicit Bearing(const std::string& text, double time = 0.0) : Closed(text) {
    EXPECT_GE(close(), 0);
    SimulationOptions options;
    options.end = time;
    auto simulation = Simulation::of(built.mechanism, options);
    if (!simulation) throw std::runtime_error(koppel::render(simulation.error()));
    if (const auto started = (*simulation)->start(state); !started) {
      throw std::runtime_error(koppel::render(started.error()));
    }
    if (const auto shown = (*simulation)->advance(time, state); !shown) {
      throw std::runtime_error(koppel::render(shown.error()));
    }
    auto bodies = inertias(*built);
    if (!bodies) throw std::runtime_error(koppel::render(bodies.error()));
    reactions = std::make_unique<Reactions>(built.mechanism, *bodies);
    EXPECT_TRUE(reactions->evaluate(state)) << reactions->culprit();
  }

  const Wrench& load(const std::string& joint) const { return reactions->loads().joints[index(joint)]; }
  double effort(const std::string& joint) const { return reactions->loads().efforts[built.joint(joint).v]; }
  std::size_t index(const std::string& joint) const {
    return static_cast<std::size_t>(&built.joint(joint) - built->joints.data());
  }
  /// The greatest load, forces taken over the mechanism's length.
  double greatest() const {
    double result = 0.0;
    for (const Wrench& joint : reactions->loads().joints) {
      result = std::max({result, joint.moment.norm(), built->length * joint.force.norm()});
    }
    return result;
  }

  std::unique_ptr<Reactions> reactions;
};

constexpr const char* crane =
    "[scene]\nlength = 1\ngravity = [0, -10, 0]\n"
    "[[body]]\nname = 'arm'\nmass = 3\ncentre_of_mass = [0.5, 0, 0]\ninertia = [0.1, 0.2, 0.3, 0, 0, 0]\n"
    "[[joint]]\nname = 'pin'\ntype = 'revolute'\nbetween = ['ground', 'arm']\n"
    "[[drive]]\nof = 'pin.angle'\ntype = 'ramp'\n";

TEST(Reactions, OfAnArmThatIsHeldAreItsWeightAndMoment) {
  const Bearing arm(std::string(crane) + "slope = 0\n");
  EXPECT_NEAR(arm.effort("pin"), 15.0, 16 * eps * 30);
  EXPECT_LE((arm.load("pin").force - Vector3(0, 30, 0)).norm(), 16 * eps * 30);
  EXPECT_LE((arm.load("pin").moment - Vector3(0, 0, 15)).norm(), 16 * eps * 30);
}

TEST(Reactions, OfAnArmThatTurnsAddTheCentripetalForce) {
  const Bearing arm(std::string(crane) + "slope = 4\n");
  // In the arm's axes, which at t = 0 are those of the world: m r omega^2 towards the pin.
  EXPECT_LE((arm.load("pin").force - Vector3(-3 * 0.5 * 16, 30, 0)).norm(), 64 * eps * 30);
  EXPECT_NEAR(arm.effort("pin"), 15.0, 64 * eps * 30);
}

TEST(Reactions, OfASliderCrankFollowFromVirtualWork) {
  // Without masses a force on the slider asks for the moment force times dx/dphi, x = r cos phi + sqrt(l^2 - r^2 sin^2
  // phi), against it.
  const double r = 0.05, l = 0.2, phi = 0.7, force = 400.0;
  const std::string text =
      "[scene]\ngravity = [0, 0, 0]\n[[body]]\nname = 'crank'\n[[body]]\nname = 'rod'\n[[body]]\nname = 'slider'\n"
      "[[joint]]\nname = 'crank'\ntype = 'revolute'\nbetween = ['ground', 'crank']\n"
      "[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = { on = 'crank', at = [0.05, 0, 0] }\noutlet = 'rod'\n"
      "start = { angle = -0.9 }\n"
      "[[joint]]\nname = 'guide'\ntype = 'prismatic'\naxis = [1, 0, 0]\nbetween = ['ground', 'slider']\nstart = { "
      "displacement "
      "= 0.23 }\n"
      "[[joint]]\nname = 'wrist'\ntype = 'revolute'\ninlet = { on = 'rod', at = [0.2, 0, 0] }\noutlet = 'slider'\n"
      "[[drive]]\nof = 'crank.angle'\ntype = 'constant'\nvalue = 0.7\n"
      "[[force]]\nname = 'gas'\ntype = 'wrench'\non = 'slider'\nforce = [-400, 0, 0]\n";
  const Bearing machine(text);
  const double slant = std::sqrt(l * l - r * r * std::sin(phi) * std::sin(phi));
  const double lever = -r * std::sin(phi) - r * r * std::sin(phi) * std::cos(phi) / slant;
  EXPECT_NEAR(machine.effort("crank"), force * lever, 256 * eps * force * l);
  // The rod is a strut: its force points along it, and has the slider's part along x.
  const double side = force * r * std::sin(phi) / slant;
  EXPECT_NEAR(machine.load("pin").force.norm(), std::hypot(force, side), 256 * eps * force);
  // The guide slides along z of its frames; across it stands what the rod pushes aside.
  EXPECT_NEAR(machine.load("guide").force.head<2>().norm(), side, 256 * eps * force);
}

/// Scenes whose bodies have masses, with a time at which they have left their start.
const std::vector<std::pair<std::string, double>> massive = {
    {"andrews", 0.01},  {"bricard", 0.3},         {"car_axis", 0.2},  {"fivelink_free", 0.2}, {"fourbar_free", 0.3},
    {"governor", 0.2},  {"heavy_top", 0.1},       {"nfourbar", 0.1},  {"rsur_free", 0.2},     {"stewart_free", 0.05},
    {"satellite", 0.5}, {"triple_pendulum", 0.2}, {"gyroscope", 0.1}, {"free_body", 0.1},     {"double_pendulum", 0.2},
};

class Massive : public testing::TestWithParam<std::pair<std::string, double>> {
 protected:
  Bearing bearing() const { return Bearing(shipped("dynamics/" + GetParam().first), GetParam().second); }
};
INSTANTIATE_TEST_SUITE_P(Scenes, Massive, testing::ValuesIn(massive),
                         [](const auto& each) { return each.param.first; });

/// Loads are sums along the tree of the multipliers' wrenches: an error of rounding for every step, times what the
/// loops' levers make of it.
double rounding(const Bearing& scene) {
  return 1e3 * eps * static_cast<double>(scene.built->steps.size()) * std::max(1.0, scene.greatest());
}

// Newton and Euler for each body by itself: what its joints put on it, the forces, and what its motion costs.
TEST_P(Massive, BodiesAreInBalance) {
  const Bearing scene = bearing();
  const Mechanism& m = *scene.built;
  Kinematics kinematics(m);
  ASSERT_TRUE(forward_position(m, scene.state.q.data(), kinematics));
  ASSERT_TRUE(forward_motion(m, scene.state.q.data(), scene.state.v.data(), scene.state.a.data(), kinematics));
  Forces forces(m);
  std::vector<Wrench> on(m.nodes);
  Eigen::VectorXd efforts = Eigen::VectorXd::Zero(m.nv), rates = scene.state.internal;
  ASSERT_TRUE(forces.evaluate(kinematics, scene.state.q.data(), scene.state.v.data(), scene.state.time,
                              scene.state.internal.data(), on, efforts, rates.data()));
  const Inertias bodies = *inertias(m);
  const auto add = [&](std::size_t body, const Pose& frame, const Wrench& wrench) {
    const Wrench in_world{frame.rotation * wrench.moment, frame.rotation * wrench.force};
    on[body] = on[body] + shifted(in_world, Vector3(kinematics.poses[body].position - frame.position));
  };
  for (std::size_t j = 0; j < m.joints.size(); ++j) {
    const Joint& joint = m.joints[j];
    const Wrench& load = scene.reactions->loads().joints[j];
    const Pose outlet = pose_of(kinematics, joint.outlet.body.value, joint.outlet.pose);
    add(joint.outlet.body.value, outlet, load);
    add(joint.inlet.body.value, outlet, -load);
  }
  for (std::size_t body = 1; body < m.bodies.size(); ++body) {
    Wrench cost;
    if (bodies.has_mass[body]) {
      cost =
          inertial_wrench(bodies.of_node[body], kinematics.poses[body].rotation, kinematics.motions[body], m.gravity);
    }
    const Wrench rest = on[body] - cost;
    EXPECT_LE(rest.moment.norm(), rounding(scene) * std::max(1.0, m.length)) << m.bodies[body].name;
    EXPECT_LE(m.length * rest.force.norm(), rounding(scene) * std::max(1.0, m.length)) << m.bodies[body].name;
  }
}

// A joint that nothing drives and no force acts on bears nothing along its freedoms, wherever the loops are cut.
TEST_P(Massive, JointsGiveWayAlongTheirFreedoms) {
  const Bearing scene = bearing();
  const Mechanism& m = *scene.built;
  std::vector<bool> loaded(m.nv, false);
  for (const Input& input : m.inputs) loaded[input.v] = true;
  for (const Force& force : m.forces) {
    for (const std::uint32_t v : force.v) loaded[v] = true;
  }
  for (std::size_t j = 0; j < m.joints.size(); ++j) {
    const Joint& joint = m.joints[j];
    Subspace s(6, joint.nv);
    ASSERT_TRUE(joint.subspace(scene.state.q.data() + joint.q, s));
    const Eigen::VectorXd along = s.transpose() * scene.reactions->loads().joints[j].vector();
    for (Eigen::Index k = 0; k < along.size(); ++k) {
      if (loaded[joint.v + static_cast<std::size_t>(k)]) continue;
      EXPECT_NEAR(m.rate_scale[joint.v + static_cast<std::size_t>(k)] * along[k], 0.0, rounding(scene)) << joint.name;
    }
  }
}

TEST_P(Massive, NothingIsMissingWhereForcesMakeTheMotion) {
  const Bearing scene = bearing();
  Eigen::VectorXd efforts = scene.reactions->loads().efforts;
  for (const Input& input : scene.built->inputs) efforts[input.v] = 0.0;
  for (Eigen::Index v = 0; v < efforts.size(); ++v) {
    EXPECT_NEAR(scene.built->rate_scale[static_cast<std::size_t>(v)] * efforts[v], 0.0, rounding(scene))
        << scene.built->rate_names[static_cast<std::size_t>(v)].name;
  }
}

/// A scene with its joints listed backwards: loops are cut elsewhere.
std::string backwards(const std::string& text) {
  std::vector<std::string> joints;
  std::string rest = "\n" + text;
  for (std::size_t at = rest.find("\n[[joint]]"); at != std::string::npos; at = rest.find("\n[[joint]]")) {
    const std::size_t next = rest.find("\n[", at + 3);
    joints.push_back(rest.substr(at, next - at));
    rest.erase(at, next == std::string::npos ? next : next - at);
  }
  std::reverse(joints.begin(), joints.end());
  for (const std::string& joint : joints) rest += joint + "\n";
  return rest.substr(1);
}

TEST_P(Massive, LoadsDoNotDependOnWhereLoopsAreCut) {
  const Bearing scene = bearing();
  const Bearing other(backwards(shipped("dynamics/" + GetParam().first)), GetParam().second);
  // The two runs are different integrations: their states, and so the loads, agree within a few tolerances.
  const double within = 1e3 * SimulationOptions().tolerance * std::max(1.0, scene.greatest());
  for (const Joint& joint : scene.built->joints) {
    const Wrench &here = scene.load(joint.name), &there = other.load(joint.name);
    EXPECT_LE((here.moment - there.moment).norm(), within) << joint.name;
    EXPECT_LE(scene.built->length * (here.force - there.force).norm(), within) << joint.name;
    const auto first = scene.reactions->determined().joints[scene.index(joint.name)];
    EXPECT_EQ(first, other.reactions->determined().joints[other.index(joint.name)]) << joint.name;
  }
}

TEST(Reactions, OfPlanarFourBarsAreDeterminedInThePlaneOnly) {
  const Bearing scene(shipped("dynamics/fourbar_free"), 0.3);
  const auto determined = scene.reactions->determined();
  for (const auto& joint : determined.joints) {
    EXPECT_EQ(joint, (std::array<bool, 6>{false, false, true, true, true, false}));
  }
  // Nothing presses across the plane, so the least loads have nothing there.
  for (const Wrench& load : scene.reactions->loads().joints) {
    EXPECT_NEAR(load.force.z(), 0.0, rounding(scene));
    EXPECT_NEAR(load.moment.x(), 0.0, rounding(scene));
    EXPECT_NEAR(load.moment.y(), 0.0, rounding(scene));
  }
}

TEST(Reactions, OfDrivesThatHoldALoopTwiceAreNotDetermined) {
  // Two bars of a parallelogram, each with a drive of its own: only the sum of their moments is determined.
  const std::string bars = shipped("dynamics/nfourbar");
  const auto drive = [](const std::string& bar) {
    return "\n[[drive]]\nof = '" + bar + ".angle'\ntype = 'constant'\nvalue = 0.5\n";
  };
  const Bearing once(bars + drive("bar0")), twice(bars + drive("bar0") + drive("bar1"));
  const auto determined = [](const Bearing& scene, const std::string& bar) -> bool {
    return scene.reactions->determined().efforts[scene.built.joint(bar).v];
  };
  EXPECT_TRUE(determined(once, "bar0"));
  EXPECT_FALSE(determined(twice, "bar0"));
  EXPECT_FALSE(determined(twice, "bar1"));
  EXPECT_NEAR(twice.effort("bar0") + twice.effort("bar1"), once.effort("bar0"), rounding(once));
  // Five bars of 1 kg whose centres go up together by the tips' half, the couplers' by all of it.
  EXPECT_NEAR(once.effort("bar0"), -(3 * 0.5 + 2 * 1.0) * 9.81 * std::sin(0.5), rounding(once));
}

TEST(Reactions, HaveThePowerThatChangesTheEnergy) {
  // A crank at constant speed turns a four-bar with masses: its power is the rate of kinetic and potential energy, here
  // by differences of eighth order.
  const std::string text = replaced(replaced(shipped("4bar"), "[[body]]\n",
                                             "[[body]]\nmass = 2\ncentre_of_mass = [0.1, 0.02, 0.03]\n"
                                             "inertia = [0.03, 0.04, 0.05, 0.001, 0.002, 0.003]\n"),
                                    "title =", "gravity = [1, -9, 2]\ntitle =");
  Closed scene(text);
  ASSERT_GE(scene.close(), 0);
  const Inertias bodies = *inertias(*scene.built);
  Reactions reactions(scene.built.mechanism, bodies);
  const auto energy = [&](double time) {
    EXPECT_GE(scene.move(time), 0);
    Kinematics kinematics(*scene.built);
    EXPECT_TRUE(forward_position(*scene.built, scene.state.q.data(), kinematics));
    EXPECT_TRUE(
        forward_motion(*scene.built, scene.state.q.data(), scene.state.v.data(), scene.state.a.data(), kinematics));
    return kinetic_energy(bodies, kinematics) + potential_energy(bodies, kinematics, scene.built->gravity);
  };
  const Joint& crank = scene.built.joint("crank");
  for (const double time : {0.1, 0.33, 0.62, 0.9}) {
    // Truncation (omega h)^8 / 630 of the energy, rounding eps / h of it.
    const double h = 5e-3;
    const double rate =
        (672 * (energy(time + h) - energy(time - h)) - 168 * (energy(time + 2 * h) - energy(time - 2 * h)) +
         32 * (energy(time + 3 * h) - energy(time - 3 * h)) - 3 * (energy(time + 4 * h) - energy(time - 4 * h))) /
        (840 * h);
    const double size = std::abs(energy(time)) + 10.0;
    ASSERT_TRUE(reactions.evaluate(scene.state));
    const double power = reactions.loads().efforts[crank.v] * scene.state.v[crank.v];
    EXPECT_NEAR(power, rate, size * (100 * std::pow(6 * 6.3 * h, 8) + 100 * eps / h)) << time;
  }
}

}  // namespace
}  // namespace koppel::test

// DART: skeletons of body nodes that a World moves by its own steps, loops closed by joint constraints between bodies
// that are assembled; a hinge that closes a loop is one more joint whose body is welded. Nothing collides.
#include <chrono>
#include <memory>

#include <dart/config.hpp>
#include <dart/constraint/BallJointConstraint.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/constraint/JointConstraint.hpp>
#include <dart/constraint/WeldJointConstraint.hpp>
#include <dart/dynamics/BallJoint.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>

#include "peer.hpp"

namespace {

using dart::dynamics::BallJoint;
using dart::dynamics::BodyNode;
using dart::dynamics::Inertia;
using dart::dynamics::RevoluteJoint;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using koppel::peer::End;

constexpr double pi = 3.14159265358979323846;

/// inertia: about the centre of mass, diagonal.
Inertia rigid(double mass, const Vector3d& centre, const Vector3d& inertia) {
  Inertia made(mass, centre);
  made.setMoment(inertia.asDiagonal());
  return made;
}
const Vector3d none = Vector3d::Constant(1e-12);  // a point's inertia: DART warns of zero

/// A spring between a point of the world and one of a body.
struct Spring {
  BodyNode* body;
  Vector3d fixed, on_body;
  double stiffness, length;
};

/// A mechanism in the making; the bodies are those of the scene of the same name.
class Mechanism {
 public:
  explicit Mechanism(const Vector3d& gravity)
      : world(dart::simulation::World::create()), skeleton(dart::dynamics::Skeleton::create()) {
    world->setGravity(gravity);
    world->addSkeleton(skeleton);
  }

  /// A revolute joint at a place of the parent, null for the ground; about z unless said.
  BodyNode* pin(BodyNode* parent, const Vector3d& at, const Inertia& inertia, const char* name, double angle = 0.0,
                double rate = 0.0) {
    Isometry3d inlet = Isometry3d::Identity();
    inlet.translation() = at;
    return hinge(parent, inlet, Vector3d::UnitZ(), Isometry3d::Identity(), inertia, name, angle, rate);
  }
  BodyNode* hinge(BodyNode* parent, const Isometry3d& inlet, const Vector3d& axis, const Isometry3d& outlet,
                  const Inertia& inertia, const char* name, double angle = 0.0, double rate = 0.0) {
    RevoluteJoint::Properties joint;
    joint.mName = name;
    joint.mAxis = axis;
    joint.mT_ParentBodyToJoint = inlet;
    joint.mT_ChildBodyToJoint = outlet;
    const BodyNode::AspectProperties body(name);  // bodies of one name it renames, and says so on standard output
    const auto made = skeleton->createJointAndBodyNodePair<RevoluteJoint>(parent, joint, body);
    made.second->setInertia(inertia);
    made.first->setPosition(0, angle);
    made.first->setVelocity(0, rate);
    return made.second;
  }

  /// A point of one body on another that it meets where the mechanism stands now.
  void join(BodyNode* a, const Vector3d& on_a, BodyNode* b) {
    world->getConstraintSolver()->addConstraint(
        std::make_shared<dart::constraint::BallJointConstraint>(a, b, a->getTransform() * on_a));
  }

  dart::simulation::WorldPtr world;
  dart::dynamics::SkeletonPtr skeleton;
  std::vector<Spring> springs;
  RevoluteJoint* driven = nullptr;
  double torque = 0.0;
  const BodyNode* top = nullptr;
};

using Made = std::unique_ptr<Mechanism>;

Made pendulum() {
  auto made = std::make_unique<Mechanism>(Vector3d(0, -9.81, 0));
  made->pin(nullptr, Vector3d::Zero(), rigid(1, {0, -1, 0}, none), "pivot.angle", -pi / 2);
  return made;
}

Made double_pendulum() {
  auto made = std::make_unique<Mechanism>(Vector3d(0, -9.81, 0));
  const Inertia bob = rigid(1, {0, -1, 0}, none);
  BodyNode* const first = made->pin(nullptr, Vector3d::Zero(), bob, "first.angle", pi / 2);
  made->pin(first, {0, -1, 0}, bob, "second.angle");
  return made;
}

Made fourbar_free() {
  auto made = std::make_unique<Mechanism>(Vector3d(0, -9.81, 0));
  const auto rod = [](double l) { return rigid(1, {l / 2, 0, 0}, {1e-3, l * l / 12, l * l / 12}); };
  BodyNode* const crank = made->pin(nullptr, Vector3d::Zero(), rod(1), "crank.angle", 0.7, 0.5);
  BodyNode* const coupler =
      made->pin(crank, {1, 0, 0}, rod(3), "crank_pin.angle", -0.043930530407389899, -0.66238872274967872);
  BodyNode* const rocker =
      made->pin(nullptr, {3.5, 0, 0}, rod(2.5), "rocker.angle", 1.7144781170266551, 0.010077464479594678);
  made->join(coupler, {3, 0, 0}, rocker);
  return made;
}

Made andrews() {
  auto made = std::make_unique<Mechanism>(Vector3d::Zero());
  const auto plate = [](double mass, const Vector3d& centre, double inertia) {
    return rigid(mass, centre, Vector3d::Constant(inertia));
  };
  const Vector3d a(-0.06934, -0.00227, 0);
  BodyNode* const of = made->pin(nullptr, Vector3d::Zero(), plate(0.04325, {0.00092, 0, 0}, 2.194e-6), "beta.angle",
                                 -0.0617138900142764496);
  BodyNode* const fe = made->pin(of, {0.007, 0, 0}, plate(0.00365, {-0.0115, 0, 0}, 4.410e-7), "theta.angle");
  BodyNode* const bde = made->pin(nullptr, {-0.03635, 0.03273, 0}, plate(0.02373, {0.01043, -0.01874, 0}, 5.255e-6),
                                  "gamma.angle", 0.455279819163070380);
  BodyNode* const ag =
      made->pin(nullptr, a, plate(0.07050, {0.02308, 0.00916, 0}, 1.169e-5), "delta.angle", 0.487364979543842550);
  BodyNode* const eg =
      made->pin(ag, {0.04, 0, 0}, plate(0.00706, {0, -0.00579, 0}, 5.667e-7), "phi.angle", 0.222668390165885884);
  BodyNode* const ah =
      made->pin(nullptr, a, plate(0.05498, {-0.00449, -0.01228, 0}, 1.912e-5), "epsilon.angle", 1.23054744454982119);
  BodyNode* const he =
      made->pin(ah, {0, -0.04, 0}, plate(0.00706, {0.00579, 0, 0}, 5.667e-7), "omega.angle", -0.222668390165885884);
  for (BodyNode* const other : {bde, eg, he}) made->join(fe, {-0.028, 0, 0}, other);
  made->springs.push_back({bde, {0.014, 0.072, 0}, {0.02, -0.018, 0}, 4530, 0.07785});
  made->driven = dynamic_cast<RevoluteJoint*>(of->getParentJoint());
  made->torque = 0.033;
  return made;
}

Made bricard() {
  auto made = std::make_unique<Mechanism>(Vector3d(0, -9.81, 0));
  struct Bar {
    const char* name;
    Vector3d joint, centre;
    int about, along;
  };
  // Frames of bodies are those of the world at the start.
  const Bar bars[] = {{"p0.angle", {0, 0, 0}, {0.5, 0, 0}, 1, 0},
                      {"p1.angle", {1, 0, 0}, {1, -0.5, 0}, 2, 1},
                      {"p2.angle", {1, -1, 0}, {1, -1, 0.5}, 0, 2},
                      {"p3.angle", {1, -1, 1}, {0.5, -1, 1}, 1, 0},
                      {"p4.angle", {0, -1, 1}, {0, -0.5, 1}, 2, 1}};
  BodyNode* last = nullptr;
  const auto add = [&](const char* name, const Vector3d& place, int about, const Inertia& inertia) {
    Isometry3d frame = Isometry3d::Identity();
    frame.translation() = place;
    last = made->hinge(last, frame, Vector3d::Unit(about), frame, inertia, name);
  };
  for (const Bar& bar : bars) {
    Vector3d inertia = Vector3d::Constant(1.01 / 12);
    inertia[bar.along] = 1.0 / 600;
    add(bar.name, bar.joint, bar.about, rigid(1, bar.centre, inertia));
  }
  add("p5.angle", {0, 0, 1}, 0, rigid(1e-6, {0, 0, 1}, Vector3d::Constant(1e-6)));
  made->world->getConstraintSolver()->addConstraint(std::make_shared<dart::constraint::WeldJointConstraint>(last));
  return made;
}

Made heavy_top() {
  auto made = std::make_unique<Mechanism>(Vector3d(0, 0, -9.81));
  const auto pair = made->skeleton->createJointAndBodyNodePair<BallJoint>();
  pair.second->setInertia(rigid(15, {0, 1, 0}, {0.234375, 0.46875, 0.234375}));
  pair.first->setVelocities(Vector3d(0, 150, -4.61538));
  made->top = pair.second;
  return made;
}

struct Problem {
  const char* name;
  Made (*make)();
};

constexpr Problem problems[] = {{"pendulum", pendulum},   {"double_pendulum", double_pendulum},
                                {"andrews", andrews},     {"bricard", bricard},
                                {"heavy_top", heavy_top}, {"fourbar_free", fourbar_free}};

/// A step of the world forgets the forces of the step before.
void apply_forces(const Mechanism& mechanism) {
  for (const Spring& spring : mechanism.springs) {
    const Vector3d way = spring.fixed - spring.body->getTransform() * spring.on_body;
    spring.body->addExtForce(spring.stiffness * (1.0 - spring.length / way.norm()) * way, spring.on_body, false, true);
  }
  if (mechanism.driven) mechanism.driven->setForce(0, mechanism.torque);
}

End simulate(const Mechanism& mechanism, double end, double wanted) {
  const auto steps = static_cast<long>(std::ceil(end / wanted - 1e-9));
  mechanism.world->setTimeStep(end / static_cast<double>(steps));
  const auto begin = std::chrono::steady_clock::now();
  for (long i = 0; i < steps; ++i) {
    apply_forces(mechanism);
    mechanism.world->step();
  }
  End result{std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), {}};
  for (std::size_t i = 0; i < mechanism.skeleton->getNumJoints(); ++i) {
    const dart::dynamics::Joint* const joint = mechanism.skeleton->getJoint(i);
    if (joint->getNumDofs() == 1) result.values.push_back({joint->getName(), joint->getPosition(0)});
  }
  if (mechanism.top) {
    // Of the two that are the same rotation the one with w above 0, as the reference.
    Eigen::Quaterniond q(mechanism.top->getTransform().linear());
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    result.values.push_back({"point.rotation.w", q.w()});
    result.values.push_back({"point.rotation.x", q.x()});
    result.values.push_back({"point.rotation.y", q.y()});
    result.values.push_back({"point.rotation.z", q.z()});
  }
  return result;
}

End run(const std::string& name, double end, const std::string& /*method*/, double setting) {
  for (const Problem& problem : problems) {
    // Steps are parts of the time in which the mechanism moves.
    if (name == problem.name) return simulate(*problem.make(), end, end * setting);
  }
  throw std::runtime_error("no such problem");
}

}  // namespace

int main(int count, char** arguments) {
  koppel::peer::Peer peer;
  peer.engine = "DART " DART_VERSION;
  peer.methods = {{"time stepping", "step over time", {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}}};
  for (const Problem& problem : problems) peer.problems.emplace_back(problem.name);
  peer.run = run;
  return koppel::peer::main_of(peer, count, arguments);
}

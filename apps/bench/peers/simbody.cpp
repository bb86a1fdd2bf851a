// Simbody: trees of mobilized bodies, loops closed by constraints without redundant equations where the loop is plane,
// integration with error control and projection, as its guides propose. Debian's library is built without NDEBUG, and
// so must be what uses it.
#include <chrono>
#include <memory>

#include <Simbody.h>

#include "peer.hpp"

namespace {

using koppel::peer::End;
using SimTK::MobilizedBody;
using SimTK::Real;
using SimTK::Transform;
using SimTK::UnitVec3;
using SimTK::Vec3;

/// A mechanism in the making; the bodies are those of the scene of the same name.
class Mechanism {
 public:
  explicit Mechanism(const Vec3& gravity) : matter(system), forces(system) {
    if (gravity.norm() > 0.0) const SimTK::Force::Gravity weight(forces, matter, gravity);
  }

  /// inertia: about the centre of mass, diagonal.
  static SimTK::Body::Rigid body(Real mass, const Vec3& centre, const Vec3& inertia) {
    const SimTK::Inertia central(inertia[0], inertia[1], inertia[2]);
    return SimTK::Body::Rigid(SimTK::MassProperties(mass, centre, central.shiftFromMassCenter(-centre, mass)));
  }

  /// A revolute joint at a place of the parent, about z.
  MobilizedBody pin(MobilizedBody parent, const Vec3& at, const SimTK::Body& body, const char* name, Real angle = 0.0,
                    Real rate = 0.0) {
    return hinge(parent, Transform(at), body, Transform(), name, angle, rate);
  }
  MobilizedBody hinge(MobilizedBody parent, const Transform& inlet, const SimTK::Body& body, const Transform& outlet,
                      const char* name, Real angle = 0.0, Real rate = 0.0) {
    MobilizedBody::Pin joint(parent, inlet, body, outlet);
    starts.push_back({joint, name, angle, rate});
    return joint;
  }

  /// Two points in one plane.
  void join(MobilizedBody a, const Vec3& on_a, MobilizedBody b, const Vec3& on_b) {
    const SimTK::Constraint::PointInPlane along_x(a, UnitVec3(1, 0, 0), on_a[0], b, on_b);
    const SimTK::Constraint::PointInPlane along_y(a, UnitVec3(0, 1, 0), on_a[1], b, on_b);
  }

  struct Start {
    MobilizedBody::Pin joint;
    const char* name;
    Real angle, rate;
  };

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  SimTK::GeneralForceSubsystem forces;
  std::vector<Start> starts;
  std::unique_ptr<MobilizedBody::Ball> ball;  ///< of a top, its rates in `spin`
  Vec3 spin = Vec3(0);
};

using Made = std::unique_ptr<Mechanism>;

Made pendulum() {
  Made made(new Mechanism(Vec3(0, -9.81, 0)));
  made->pin(made->matter.Ground(), Vec3(0), Mechanism::body(1, Vec3(0, -1, 0), Vec3(0)), "pivot.angle", -SimTK::Pi / 2);
  return made;
}

Made double_pendulum() {
  Made made(new Mechanism(Vec3(0, -9.81, 0)));
  const auto bob = Mechanism::body(1, Vec3(0, -1, 0), Vec3(0));
  const auto first = made->pin(made->matter.Ground(), Vec3(0), bob, "first.angle", SimTK::Pi / 2);
  made->pin(first, Vec3(0, -1, 0), bob, "second.angle");
  return made;
}

Made fourbar_free() {
  Made made(new Mechanism(Vec3(0, -9.81, 0)));
  const auto rod = [](Real l) { return Mechanism::body(1, Vec3(l / 2, 0, 0), Vec3(1e-3, l * l / 12, l * l / 12)); };
  const auto crank = made->pin(made->matter.Ground(), Vec3(0), rod(1), "crank.angle", 0.7, 0.5);
  const auto coupler =
      made->pin(crank, Vec3(1, 0, 0), rod(3), "crank_pin.angle", -0.043930530407389899, -0.66238872274967872);
  const auto rocker = made->pin(made->matter.Ground(), Vec3(3.5, 0, 0), rod(2.5), "rocker.angle", 1.7144781170266551,
                                0.010077464479594678);
  made->join(rocker, Vec3(2.5, 0, 0), coupler, Vec3(3, 0, 0));
  return made;
}

Made andrews() {
  Made made(new Mechanism(Vec3(0)));
  const auto plate = [](Real mass, const Vec3& centre, Real inertia) {
    return Mechanism::body(mass, centre, Vec3(inertia, inertia, inertia));
  };
  const Vec3 a(-0.06934, -0.00227, 0);
  const auto ground = made->matter.Ground();
  const auto of =
      made->pin(ground, Vec3(0), plate(0.04325, Vec3(0.00092, 0, 0), 2.194e-6), "beta.angle", -0.0617138900142764496);
  const auto fe = made->pin(of, Vec3(0.007, 0, 0), plate(0.00365, Vec3(-0.0115, 0, 0), 4.410e-7), "theta.angle");
  const auto bde = made->pin(ground, Vec3(-0.03635, 0.03273, 0), plate(0.02373, Vec3(0.01043, -0.01874, 0), 5.255e-6),
                             "gamma.angle", 0.455279819163070380);
  const auto ag =
      made->pin(ground, a, plate(0.07050, Vec3(0.02308, 0.00916, 0), 1.169e-5), "delta.angle", 0.487364979543842550);
  const auto eg = made->pin(ag, Vec3(0.04, 0, 0), plate(0.00706, Vec3(0, -0.00579, 0), 5.667e-7), "phi.angle",
                            0.222668390165885884);
  const auto ah =
      made->pin(ground, a, plate(0.05498, Vec3(-0.00449, -0.01228, 0), 1.912e-5), "epsilon.angle", 1.23054744454982119);
  const auto he = made->pin(ah, Vec3(0, -0.04, 0), plate(0.00706, Vec3(0.00579, 0, 0), 5.667e-7), "omega.angle",
                            -0.222668390165885884);
  const Vec3 e(-0.028, 0, 0);
  made->join(fe, e, bde, Vec3(0, -0.035, 0));
  made->join(fe, e, eg, Vec3(0, -0.02, 0));
  made->join(fe, e, he, Vec3(0.02, 0, 0));
  const SimTK::Force::TwoPointLinearSpring spring(made->forces, ground, Vec3(0.014, 0.072, 0), bde,
                                                  Vec3(0.02, -0.018, 0), 4530, 0.07785);
  const SimTK::Force::MobilityConstantForce torque(made->forces, of, SimTK::MobilizerUIndex(0), 0.033);
  return made;
}

Made bricard() {
  Made made(new Mechanism(Vec3(0, -9.81, 0)));
  const Real across = 1.01 / 12, along = 1.0 / 600;
  const auto bar = [&](const Vec3& centre, int axis) {
    Vec3 inertia(across);
    inertia[axis] = along;
    return Mechanism::body(1, centre, inertia);
  };
  // Frames are those of the world at the start.
  const auto at = [](const Vec3& place, int axis) {
    Vec3 z(0);
    z[axis] = 1;
    return Transform(SimTK::Rotation(UnitVec3(z), SimTK::ZAxis), place);
  };
  struct Bar {
    const char* name;
    Vec3 joint, centre;
    int about, along;
  };
  const Bar bars[] = {{"p0.angle", Vec3(0, 0, 0), Vec3(0.5, 0, 0), 1, 0},
                      {"p1.angle", Vec3(1, 0, 0), Vec3(1, -0.5, 0), 2, 1},
                      {"p2.angle", Vec3(1, -1, 0), Vec3(1, -1, 0.5), 0, 2},
                      {"p3.angle", Vec3(1, -1, 1), Vec3(0.5, -1, 1), 1, 0},
                      {"p4.angle", Vec3(0, -1, 1), Vec3(0, -0.5, 1), 2, 1}};
  MobilizedBody last = made->matter.Ground();
  for (const Bar& b : bars) {
    const Transform frame = at(b.joint, b.about);
    last = made->hinge(last, frame, bar(b.centre, b.along), frame, b.name);
  }
  const SimTK::Constraint::Ball centre(made->matter.Ground(), Vec3(0, 0, 1), last, Vec3(0, 0, 1));
  for (const UnitVec3& side : {UnitVec3(0, 1, 0), UnitVec3(0, 0, 1)}) {
    const SimTK::Constraint::ConstantAngle upright(made->matter.Ground(), UnitVec3(1, 0, 0), last, side);
  }
  return made;
}

Made heavy_top() {
  Made made(new Mechanism(Vec3(0, 0, -9.81)));
  const auto top = Mechanism::body(15, Vec3(0, 1, 0), Vec3(0.234375, 0.46875, 0.234375));
  made->ball = std::make_unique<MobilizedBody::Ball>(made->matter.Ground(), Transform(), top, Transform());
  made->spin = Vec3(0, 150, -4.61538);
  return made;
}

struct Problem {
  const char* name;
  Made (*make)();
};

constexpr Problem problems[] = {{"pendulum", pendulum},   {"double_pendulum", double_pendulum},
                                {"andrews", andrews},     {"bricard", bricard},
                                {"heavy_top", heavy_top}, {"fourbar_free", fourbar_free}};

SimTK::State start_of(Mechanism& mechanism) {
  SimTK::State state = mechanism.system.realizeTopology();
  for (Mechanism::Start& start : mechanism.starts) {
    start.joint.setAngle(state, start.angle);
    start.joint.setRate(state, start.rate);
  }
  if (mechanism.ball) mechanism.ball->setU(state, mechanism.spin);
  return state;
}

/// Of joints that are hinges.
End accelerate(Mechanism& mechanism) {
  SimTK::State state = start_of(mechanism);
  const SimTK::Vector q = state.getQ(), u = state.getU();
  End result{koppel::peer::least_seconds([&] {
               state.updQ() = q;
               state.updU() = u;
               mechanism.system.realize(state, SimTK::Stage::Acceleration);
             }),
             {}};
  for (const Mechanism::Start& start : mechanism.starts)
    result.values.push_back({start.name, start.joint.getOneUDot(state, 0)});
  return result;
}

End simulate(Mechanism& mechanism, double end, const std::string& method, double accuracy) {
  SimTK::State state = start_of(mechanism);
  std::unique_ptr<SimTK::Integrator> integrator;
  if (method == "cpodes") {
    integrator = std::make_unique<SimTK::CPodesIntegrator>(mechanism.system, SimTK::CPodes::BDF);
  } else {
    integrator = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(mechanism.system);
  }
  integrator->setAccuracy(accuracy);
  integrator->setFinalTime(end);
  SimTK::TimeStepper stepper(mechanism.system, *integrator);
  const auto begin = std::chrono::steady_clock::now();
  stepper.initialize(state);
  stepper.stepTo(end);
  End result{std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), {}};
  const SimTK::State& reached = stepper.getState();
  for (const Mechanism::Start& start : mechanism.starts)
    result.values.push_back({start.name, start.joint.getAngle(reached)});
  if (mechanism.ball) {
    const SimTK::Quaternion q(mechanism.ball->getQ(reached), true);
    const char* const names[] = {"point.rotation.w", "point.rotation.x", "point.rotation.y", "point.rotation.z"};
    for (int i = 0; i < 4; ++i) result.values.push_back({names[i], q[i]});
  }
  return result;
}

Made make(const std::string& name) {
  for (const Problem& problem : problems) {
    if (name == problem.name) return problem.make();
  }
  throw std::runtime_error("no such problem");
}

}  // namespace

int main(int count, char** arguments) {
  koppel::peer::Peer peer;
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  peer.engine = std::string("Simbody ") + std::to_string(major) + '.' + std::to_string(minor);
  const std::vector<double> accuracies = {1e-3, 1e-5, 1e-7, 1e-9, 1e-11};
  peer.methods = {{"runge-kutta-merson", "accuracy", accuracies}, {"cpodes", "accuracy", accuracies}};
  for (const Problem& problem : problems) peer.problems.emplace_back(problem.name);
  peer.run = [](const std::string& name, double end, const std::string& method, double accuracy) {
    return simulate(*make(name), end, method, accuracy);
  };
  peer.accelerate = [](const std::string& name) { return accelerate(*make(name)); };
  return koppel::peer::main_of(peer, count, arguments);
}

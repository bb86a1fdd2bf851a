// MuJoCo: trees of bodies, loops closed by "connect" constraints as stiff as its guide allows at the time step (solref
// of two steps, solimp near 1), the classical Runge-Kutta method, Newton's solver to 1e-10. Contacts are off. Angles
// of bodies at the start stand in their poses, since a connect is made where the mechanism is assembled.
#include <chrono>
#include <memory>
#include <sstream>

#include "mujoco_model.hpp"
#include "peer.hpp"

namespace {

using koppel::peer::End;

/// The angle that a joint has where its coordinate is zero, its rate, and its torque.
struct Joint {
  std::string name;
  double angle, rate, torque;
};

/// A mechanism as MJCF, and what that does not say.
class Mechanism {
 public:
  explicit Mechanism(const char* gravity) : gravity_(gravity) { body_.precision(17); }

  /// Opens a body that a hinge about an axis carries, at a place of the one that is open; inertia about its centre.
  Mechanism& open(const char* body, const char* joint, const char* place, double angle, double rate, double mass,
                  const char* centre, const char* inertia, const char* axis = "0 0 1", const char* anchor = "0 0 0") {
    body_ << "<body name=\"" << body << "\" pos=\"" << place << "\" axisangle=\"0 0 1 " << angle << "\"><joint name=\""
          << joint << "\" type=\"hinge\" axis=\"" << axis << "\" pos=\"" << anchor << "\"/><inertial mass=\"" << mass
          << "\" pos=\"" << centre << "\" diaginertia=\"" << inertia << "\"/>";
    joints.push_back({joint, angle, rate, 0.0});
    return *this;
  }
  Mechanism& site(const char* name, const char* place) {
    body_ << "<site name=\"" << name << "\" pos=\"" << place << "\"/>";
    return *this;
  }
  Mechanism& ball(const char* body, const char* joint, double mass, const char* centre, const char* inertia) {
    body_ << "<body name=\"" << body << "\"><joint name=\"" << joint << "\" type=\"ball\"/><inertial mass=\"" << mass
          << "\" pos=\"" << centre << "\" diaginertia=\"" << inertia << "\"/>";
    return *this;
  }
  Mechanism& close() {
    body_ << "</body>";
    return *this;
  }
  /// anchor: in the frame of the first.
  void join(const char* a, const char* b, const char* anchor) {
    loops_ << "<connect body1=\"" << a << "\" body2=\"" << b << "\" anchor=\"" << anchor << "\"/>";
  }
  void spring(const char* from, const char* to, const char* stiffness, const char* length) {
    springs_ << "<spatial stiffness=\"" << stiffness << "\" springlength=\"" << length << "\"><site site=\"" << from
             << "\"/><site site=\"" << to << "\"/></spatial>";
  }

  std::string text(double step) const {
    std::ostringstream out;
    out.precision(17);
    out << "<mujoco><compiler angle=\"radian\" balanceinertia=\"false\"/><option gravity=\"" << gravity_
        << "\" timestep=\"" << step << "\" integrator=\"RK4\" solver=\"Newton\" iterations=\"100\" tolerance=\"1e-10\">"
        << "<flag contact=\"disable\" warmstart=\"enable\"/></option><default><equality solref=\"" << 2 * step
        << " 1\" solimp=\"0.9999 0.9999 0.001\"/></default><worldbody>" << body_.str() << "</worldbody><equality>"
        << loops_.str() << "</equality><tendon>" << springs_.str() << "</tendon></mujoco>";
    return out.str();
  }

  std::vector<Joint> joints;
  std::string top;  ///< a ball joint, and its rates
  std::vector<double> spin;

 private:
  std::string gravity_;
  std::ostringstream body_, loops_, springs_;
};

using Made = std::unique_ptr<Mechanism>;
constexpr double pi = 3.14159265358979323846;
constexpr const char* none = "1e-15 1e-15 1e-15";  // a point's inertia: MuJoCo refuses zero

Made pendulum() {
  auto made = std::make_unique<Mechanism>("0 -9.81 0");
  made->open("bob", "pivot.angle", "0 0 0", -pi / 2, 0, 1, "0 -1 0", none).close();
  return made;
}

Made double_pendulum() {
  auto made = std::make_unique<Mechanism>("0 -9.81 0");
  made->open("upper", "first.angle", "0 0 0", pi / 2, 0, 1, "0 -1 0", none);
  made->open("lower", "second.angle", "0 -1 0", 0, 0, 1, "0 -1 0", none).close().close();
  return made;
}

Made fourbar_free() {
  auto made = std::make_unique<Mechanism>("0 -9.81 0");
  made->open("crank", "crank.angle", "0 0 0", 0.7, 0.5, 1, "0.5 0 0",
             "0.001 0.083333333333333333 0.083333333333333333");
  made->open("coupler", "crank_pin.angle", "1 0 0", -0.043930530407389899, -0.66238872274967872, 1, "1.5 0 0",
             "0.001 0.75 0.75");
  made->close().close();
  made->open("rocker", "rocker.angle", "3.5 0 0", 1.7144781170266551, 0.010077464479594678, 1, "1.25 0 0",
             "0.001 0.52083333333333333 0.52083333333333333");
  made->close();
  made->join("coupler", "rocker", "3 0 0");
  return made;
}

Made andrews() {
  auto made = std::make_unique<Mechanism>("0 0 0");
  constexpr const char* a = "-0.06934 -0.00227 0";
  made->site("c", "0.014 0.072 0");
  made->open("of", "beta.angle", "0 0 0", -0.0617138900142764496, 0, 0.04325, "0.00092 0 0",
             "2.194e-6 2.194e-6 2.194e-6");
  made->joints.back().torque = 0.033;
  made->open("fe", "theta.angle", "0.007 0 0", 0, 0, 0.00365, "-0.0115 0 0", "4.41e-7 4.41e-7 4.41e-7").close().close();
  made->open("bde", "gamma.angle", "-0.03635 0.03273 0", 0.455279819163070380, 0, 0.02373, "0.01043 -0.01874 0",
             "5.255e-6 5.255e-6 5.255e-6");
  made->site("d", "0.02 -0.018 0").close();
  made->open("ag", "delta.angle", a, 0.487364979543842550, 0, 0.07050, "0.02308 0.00916 0",
             "1.169e-5 1.169e-5 1.169e-5");
  made->open("eg", "phi.angle", "0.04 0 0", 0.222668390165885884, 0, 0.00706, "0 -0.00579 0",
             "5.667e-7 5.667e-7 5.667e-7");
  made->close().close();
  made->open("ah", "epsilon.angle", a, 1.23054744454982119, 0, 0.05498, "-0.00449 -0.01228 0",
             "1.912e-5 1.912e-5 1.912e-5");
  made->open("he", "omega.angle", "0 -0.04 0", -0.222668390165885884, 0, 0.00706, "0.00579 0 0",
             "5.667e-7 5.667e-7 5.667e-7");
  made->close().close();
  for (const char* other : {"bde", "eg", "he"}) made->join("fe", other, "-0.028 0 0");
  made->spring("c", "d", "4530", "0.07785");
  return made;
}

Made heavy_top() {
  auto made = std::make_unique<Mechanism>("0 0 -9.81");
  made->ball("top", "point", 15, "0 1 0", "0.234375 0.46875 0.234375").close();
  made->top = "point.rotation";
  made->spin = {0, 150, -4.61538};
  return made;
}

struct Problem {
  const char* name;
  Made (*make)();
};

constexpr Problem problems[] = {{"pendulum", pendulum},
                                {"double_pendulum", double_pendulum},
                                {"andrews", andrews},
                                {"heavy_top", heavy_top},
                                {"fourbar_free", fourbar_free}};

/// A model and where it starts.
struct Moving {
  Moving(const Mechanism& mechanism, double step)
      : model(koppel::peer::compile(mechanism.text(step))), data(mj_makeData(model.get())) {
    for (const Joint& joint : mechanism.joints) {
      const int rate = rate_of(joint);
      data->qvel[rate] = joint.rate;
      data->qfrc_applied[rate] = joint.torque;
    }
    for (std::size_t i = 0; i < mechanism.spin.size(); ++i) data->qvel[i] = mechanism.spin[i];
  }
  int rate_of(const Joint& joint) const {
    return model->jnt_dofadr[mj_name2id(model.get(), mjOBJ_JOINT, joint.name.c_str())];
  }

  koppel::peer::Model model;
  koppel::peer::Data data;
};

/// As at a step that is as short as makes sense; of joints that are hinges.
End accelerate(const Mechanism& mechanism) {
  const Moving moving(mechanism, 1e-5);
  End result{koppel::peer::least_seconds([&] {
               mju_zero(moving.data->qacc_warmstart, moving.model->nv);
               mj_forward(moving.model.get(), moving.data.get());
             }),
             {}};
  for (const Joint& joint : mechanism.joints)
    result.values.push_back({joint.name, moving.data->qacc[moving.rate_of(joint)]});
  return result;
}

End simulate(const Mechanism& mechanism, double end, double wanted) {
  const auto steps = static_cast<long>(std::ceil(end / wanted - 1e-9));
  const double step = end / static_cast<double>(steps);
  const Moving moving(mechanism, step);
  const mjModel* const model = moving.model.get();
  mjData* const data = moving.data.get();
  const auto begin = std::chrono::steady_clock::now();
  for (long i = 0; i < steps; ++i) mj_step(model, data);
  End result{std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), {}};
  for (const Joint& joint : mechanism.joints) {
    const int place = model->jnt_qposadr[mj_name2id(model, mjOBJ_JOINT, joint.name.c_str())];
    result.values.push_back({joint.name, joint.angle + data->qpos[place]});
  }
  const char* const parts[] = {".w", ".x", ".y", ".z"};
  for (int i = 0; i < 4 && !mechanism.top.empty(); ++i)
    result.values.push_back({mechanism.top + parts[i], data->qpos[i]});
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
  mju_user_warning = [](const char*) {};  // by itself it writes them into a file of the folder it is started in
  koppel::peer::Peer peer;
  peer.engine = std::string("MuJoCo ") + mj_versionString();
  peer.methods = {{"runge-kutta-4", "step over time", {1e-2, 1e-3, 1e-4, 1e-5}}};
  for (const Problem& problem : problems) peer.problems.emplace_back(problem.name);
  peer.run = [](const std::string& name, double end, const std::string& /*method*/, double setting) {
    return simulate(*make(name), end, end * setting);  // steps are parts of the time in which the mechanism moves
  };
  peer.accelerate = [](const std::string& name) { return accelerate(*make(name)); };
  return koppel::peer::main_of(peer, count, arguments);
}

// Simbody on open trees: its stages tell what is to be computed anew; efforts are forces of the system for the motion
// that they cause, and what is left over for a motion that is given.
#include <memory>

#include <Simbody.h>

#include "trees.hpp"

namespace koppel::peer {
namespace {

using SimTK::MobilizedBody;
using SimTK::Stage;
using SimTK::Vec3;
using SimTK::Vector;

class SimbodyTree final : public TreeEngine {
 public:
  explicit SimbodyTree(const Tree& tree)
      : matter_(system_),
        forces_(system_),
        gravity_(forces_, matter_, vector(tree.gravity)),
        efforts_(forces_, matter_) {
    for (const Link& link : tree.links) add(link);
    state_ = system_.realizeTopology();
    none_ = Vector(state_.getNU(), 0.0);
    for (const TreeState& state : tree.states)
      states_.push_back({own(state.q), own(state.v), own(state.a), own(state.efforts)});
  }

  void evaluate(Algorithm algorithm, std::size_t number) override {
    const Given& given = states_[number];
    state_.updQ() = given.q;
    switch (algorithm) {
      case Algorithm::position: system_.realize(state_, Stage::Position); break;
      case Algorithm::inverse_dynamics:
        state_.updU() = given.v;
        system_.realize(state_, Stage::Dynamics);
        matter_.calcResidualForceIgnoringConstraints(state_, none_, system_.getRigidBodyForces(state_, Stage::Dynamics),
                                                     given.a, residual_);
        break;
      case Algorithm::mass_matrix:
        system_.realize(state_, Stage::Position);
        matter_.calcM(state_, mass_);
        break;
      case Algorithm::forward_dynamics:
        state_.updU() = given.v;
        efforts_.setAllMobilityForces(state_, given.efforts);
        system_.realize(state_, Stage::Acceleration);
        break;
    }
  }

  std::vector<double> result(Algorithm algorithm) override {
    std::vector<double> numbers;
    const auto take = [&numbers](const auto& values) {
      for (int i = 0; i < values.size(); ++i) numbers.push_back(values[i]);
    };
    switch (algorithm) {
      case Algorithm::position:
        for (const MobilizedBody& body : bodies_) take(body.getBodyOriginLocation(state_));
        break;
      case Algorithm::inverse_dynamics: take(residual_); break;
      case Algorithm::mass_matrix:
        for (int i = 0; i < mass_.nrow(); ++i) take(mass_[i]);
        break;
      case Algorithm::forward_dynamics: take(state_.getUDot()); break;
    }
    return numbers;
  }

 private:
  struct Given {
    Vector q, v, a, efforts;
  };

  static Vec3 vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
  static Vector own(const std::vector<double>& values) {
    return Vector(static_cast<int>(values.size()), values.data());
  }

  void add(const Link& link) {
    const auto& i = link.inertia;
    const Vec3 centre = vector(link.centre);
    const SimTK::Inertia central(i[0], i[1], i[2], i[3], i[4], i[5]);
    const SimTK::Body::Rigid body(
        SimTK::MassProperties(link.mass, centre, central.shiftFromMassCenter(-centre, link.mass)));
    const SimTK::Quaternion turn(link.turn[0], link.turn[1], link.turn[2], link.turn[3]);
    MobilizedBody parent = link.parent < 0 ? matter_.Ground() : bodies_[static_cast<std::size_t>(link.parent)];
    const SimTK::Transform inlet(SimTK::Rotation(turn), vector(link.place));
    bodies_.push_back(MobilizedBody::Pin(parent, inlet, body, SimTK::Transform()));
  }

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::Gravity gravity_;
  SimTK::Force::DiscreteForces efforts_;
  std::vector<MobilizedBody> bodies_;
  SimTK::State state_;
  SimTK::Matrix mass_;
  Vector none_, residual_;
  std::vector<Given> states_;
};

}  // namespace

std::unique_ptr<TreeEngine> make_tree(const Tree& tree) { return std::make_unique<SimbodyTree>(tree); }

}  // namespace koppel::peer

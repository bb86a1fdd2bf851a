// DART on open trees: one skeleton, whose caches tell what is to be computed anew.
#include <memory>

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>

#include "trees.hpp"

namespace koppel::peer {
namespace {

using dart::dynamics::BodyNode;
using dart::dynamics::RevoluteJoint;
using Eigen::VectorXd;

class DartTree final : public TreeEngine {
 public:
  explicit DartTree(const Tree& tree) : skeleton_(dart::dynamics::Skeleton::create()) {
    skeleton_->setGravity(Eigen::Vector3d(tree.gravity.data()));
    for (std::size_t i = 0; i < tree.links.size(); ++i) add(tree.links[i], std::to_string(i));
    for (const TreeState& state : tree.states)
      states_.push_back({own(state.q), own(state.v), own(state.a), own(state.efforts)});
  }

  void evaluate(Algorithm algorithm, std::size_t number) override {
    const State& state = states_[number];
    skeleton_->setPositions(state.q);
    switch (algorithm) {
      case Algorithm::position:
        for (const BodyNode* const body : bodies_) body->getWorldTransform();
        break;
      case Algorithm::inverse_dynamics:
        skeleton_->setVelocities(state.v);
        skeleton_->setAccelerations(state.a);
        skeleton_->computeInverseDynamics();
        break;
      case Algorithm::mass_matrix: skeleton_->getMassMatrix(); break;
      case Algorithm::forward_dynamics:
        skeleton_->setVelocities(state.v);
        skeleton_->setForces(state.efforts);
        skeleton_->computeForwardDynamics();
        break;
    }
  }

  std::vector<double> result(Algorithm algorithm) override {
    std::vector<double> numbers;
    const auto take = [&numbers](const auto& values) {
      for (Eigen::Index i = 0; i < values.size(); ++i) numbers.push_back(values.data()[i]);
    };
    if (algorithm == Algorithm::position) {
      for (const BodyNode* const body : bodies_) take(Eigen::Vector3d(body->getWorldTransform().translation()));
    } else if (algorithm == Algorithm::mass_matrix) {
      take(skeleton_->getMassMatrix());
    } else {
      take(algorithm == Algorithm::inverse_dynamics ? skeleton_->getForces() : skeleton_->getAccelerations());
    }
    return numbers;
  }

 private:
  struct State {
    VectorXd q, v, a, efforts;
  };

  static VectorXd own(const std::vector<double>& values) {
    return VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  void add(const Link& link, const std::string& name) {
    RevoluteJoint::Properties joint;
    joint.mName = name;
    joint.mAxis = Eigen::Vector3d::UnitZ();
    joint.mT_ParentBodyToJoint.translation() = Eigen::Vector3d(link.place.data());
    joint.mT_ParentBodyToJoint.linear() =
        Eigen::Quaterniond(link.turn[0], link.turn[1], link.turn[2], link.turn[3]).toRotationMatrix();
    BodyNode* const parent = link.parent < 0 ? nullptr : bodies_[static_cast<std::size_t>(link.parent)];
    BodyNode* const body =
        skeleton_->createJointAndBodyNodePair<RevoluteJoint>(parent, joint, BodyNode::AspectProperties(name)).second;
    const auto& i = link.inertia;
    body->setInertia(dart::dynamics::Inertia(link.mass, link.centre[0], link.centre[1], link.centre[2], i[0], i[1],
                                             i[2], i[3], i[4], i[5]));
    bodies_.push_back(body);
  }

  dart::dynamics::SkeletonPtr skeleton_;
  std::vector<BodyNode*> bodies_;
  std::vector<State> states_;
};

}  // namespace

std::unique_ptr<TreeEngine> make_tree(const Tree& tree) { return std::make_unique<DartTree>(tree); }

}  // namespace koppel::peer

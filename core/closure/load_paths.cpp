#include "closure/load_paths.hpp"

namespace koppel {

LoadPaths::LoadPaths(const Mechanism& mechanism)
    : mechanism_(mechanism), step_to_(mechanism.nodes, 0), depth_(mechanism.nodes, 0) {
  for (std::uint32_t i = 0; i < mechanism.steps.size(); ++i) {
    const TreeStep& step = mechanism.steps[i];
    step_to_[step.child] = i;
    depth_[step.child] = depth_[step.parent] + 1;
  }
}

/// Calls visit(step, +1 if frame b lies beyond it, else -1).
template <typename Visit>
void LoadPaths::for_each_step(const Relation& relation, const Visit& visit) const {
  Node a = relation.node_a, b = relation.node_b;
  while (a != b) {
    const bool on_way_to_b = depth_[b] >= depth_[a];
    Node& beyond = on_way_to_b ? b : a;
    const TreeStep& step = mechanism_.steps[step_to_[beyond]];
    visit(step, on_way_to_b ? 1.0 : -1.0);
    beyond = step.parent;
  }
}

void LoadPaths::outlets(const Equations& equations, std::vector<Pose>& frames) const {
  const Kinematics& kinematics = equations.kinematics;
  for (std::size_t i = 0; i < mechanism_.steps.size(); ++i) {
    const TreeStep& step = mechanism_.steps[i];
    frames[step.joint.index()] = step.reversed ? kinematics.near[i] : kinematics.far[i];
  }
  for (std::size_t i = 0; i < mechanism_.loops; ++i) {
    const Relation& loop = mechanism_.relations[i];
    if (loop.kind == RelationKind::cut_joint) frames[loop.joint.index()] = equations.frame_b(i);
  }
}

void LoadPaths::add(const Equations& equations, const Eigen::VectorXd& multipliers, const std::vector<Pose>& outlets,
                    std::vector<Wrench>& of_joints) const {
  for (std::size_t i = 0; i < mechanism_.relations.size(); ++i) {
    const Relation& relation = mechanism_.relations[i];
    if (!relation.has_frames || multipliers.segment(relation.first_row, relation.rows).isZero(0.0)) continue;
    const Wrench on_b = equations.reaction(i, multipliers);
    const Vector3& b = equations.frame_b(i).position;
    if (relation.kind == RelationKind::cut_joint) {
      of_joints[relation.joint.index()] = of_joints[relation.joint.index()] + on_b;
    }
    // Joints on the way to b hold it against its wrench, those on the way to a hold a against the opposite.
    for_each_step(relation, [&](const TreeStep& step, double to_b) {
      const std::size_t joint = step.joint.index();
      const double sign = step.reversed ? to_b : -to_b;
      of_joints[joint] = of_joints[joint] + sign * shifted(on_b, Vector3(outlets[joint].position - b));
    });
  }
}

}  // namespace koppel

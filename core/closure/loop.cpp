#include "closure/loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "closure/cycle_basis.hpp"
#include "spatial/vector.hpp"

namespace koppel {
namespace {

/// A frame whose z axis is that of the motion, and its opposite for a motion that is passed backwards: then the
/// coordinate counts as it does forwards. The two differ by half a turn about x.
Pose frame_of(const ElementaryMotion& motion, bool reversed) {
  Pose frame;
  frame.position = motion.point;
  if (motion.kind != ElementaryMotionKind::free_rotation) {
    frame.rotation << tangents<double>(motion.axis), motion.axis;
    if (reversed) frame.rotation.rightCols<2>() *= -1.0;
  }
  return frame;
}

/// What a motion does at the coordinate -zero.
Pose back_to_zero(const ElementaryMotion& motion) {
  Pose back;
  if (motion.kind == ElementaryMotionKind::rotation || motion.kind == ElementaryMotionKind::screw) {
    const double c = std::cos(motion.zero), s = std::sin(motion.zero);
    back.rotation << c, s, 0, -s, c, 0, 0, 0, 1;
  } else if (motion.kind == ElementaryMotionKind::translation) {
    back.position.z() = -motion.zero;
  }
  return back;
}

VariableKind kind_of(const ElementaryMotion& motion) {
  switch (motion.kind) {
    case ElementaryMotionKind::translation: return VariableKind::slide;
    case ElementaryMotionKind::free_rotation: return VariableKind::ball;
    case ElementaryMotionKind::rotation:
    case ElementaryMotionKind::screw: return VariableKind::turn;
  }
  return VariableKind::turn;
}

bool has_pitch(const Joint& joint) {
  return std::any_of(joint.motions().begin(), joint.motions().end(), [](const ElementaryMotion& motion) {
    return motion.kind == ElementaryMotionKind::screw && motion.pitch != 0.0;
  });
}

/// Collects the motions of a walk through joints; constants are carried over to the next motion.
class Walk {
 public:
  Walk(const Mechanism& mechanism, const std::vector<std::uint32_t>& first_variable)
      : mechanism_(mechanism), first_variable_(first_variable) {}

  void pass(JointId id, bool reversed) {
    const Joint& joint = mechanism_.joints[id.index()];
    const auto& motions = joint.motions();
    constant_ = constant_ * (reversed ? joint.outlet.pose : joint.inlet.pose);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const std::size_t k = reversed ? motions.size() - 1 - i : i;
      add(first_variable_[id.index()] + static_cast<std::uint32_t>(k), motions[k], reversed);
    }
    constant_ = constant_ * (reversed ? joint.inlet.pose : joint.outlet.pose).inverse();
    loop_.joints.push_back(id);
  }

  /// Three slides along the axes of the body that the walk comes from, or of the one it goes to, and a ball.
  void pass_imaginary(JointId id, std::uint32_t first_variable, bool reversed) {
    const std::array axes{Vector3::UnitX().eval(), Vector3::UnitY().eval(), Vector3::UnitZ().eval()};
    const auto slide = [&](std::uint32_t k) {
      const ElementaryMotion motion{ElementaryMotionKind::translation, k, k, 0.0, axes[k], Vector3::Zero(), 0.0};
      add(first_variable + k, motion, reversed);
    };
    const ElementaryMotion ball{ElementaryMotionKind::free_rotation, 3, 3, 0.0, axes[2], Vector3::Zero(), 0.0};
    if (reversed) {
      add(first_variable + 3, ball, true);
      for (std::uint32_t k = 3; k-- > 0;) slide(k);
    } else {
      for (std::uint32_t k = 0; k < 3; ++k) slide(k);
      add(first_variable + 3, ball, false);
    }
    loop_.joints.push_back(id);
  }

  Loop close() {
    if (!loop_.motions.empty()) loop_.motions.front().to = constant_ * loop_.motions.front().to;
    return std::move(loop_);
  }

 private:
  void add(std::uint32_t variable, const ElementaryMotion& motion, bool reversed) {
    const Pose frame = frame_of(motion, reversed);
    loop_.motions.push_back({variable, constant_ * frame, reversed});
    constant_ = back_to_zero(motion) * frame.inverse();
  }

  const Mechanism& mechanism_;
  const std::vector<std::uint32_t>& first_variable_;
  Loop loop_;
  Pose constant_;
};

std::string obstacle_of(const Mechanism& mechanism) {
  for (const Joint& joint : mechanism.joints) {
    if (!joint.is_product()) return "joint " + joint.name + " is no product of turns and slides";
    if (has_pitch(joint)) return "joint " + joint.name + " is a screw with a pitch";
  }
  if (!mechanism.constraints.empty()) return "constraint " + mechanism.constraints.front().name;
  return {};
}

}  // namespace

LoopsOrObstacle find_loops(const Mechanism& mechanism, const LoopChoice& choice) {
  LoopsOrObstacle result;
  result.obstacle = obstacle_of(mechanism);
  if (!result.obstacle.empty()) return result;
  Loops& loops = result.loops;
  std::vector<std::uint32_t> first_variable;
  std::vector<WeightedEdge> edges;
  for (std::uint32_t i = 0; i < mechanism.joints.size(); ++i) {
    const Joint& joint = mechanism.joints[i];
    first_variable.push_back(static_cast<std::uint32_t>(loops.variables.size()));
    for (const ElementaryMotion& motion : joint.motions()) {
      loops.variables.push_back({kind_of(motion), joint.q + motion.q, joint.v + motion.v, {i}});
    }
    const bool counts = !choice.favoured || choice.favoured->value != i;
    edges.push_back({joint.inlet.body.value, joint.outlet.body.value, counts ? joint.nv : 0});
  }
  if (choice.imaginary) {
    const auto id = static_cast<std::uint32_t>(mechanism.joints.size());
    first_variable.push_back(static_cast<std::uint32_t>(loops.variables.size()));
    for (std::uint32_t k = 0; k < 4; ++k) {
      const VariableKind kind = k < 3 ? VariableKind::slide : VariableKind::ball;
      loops.variables.push_back({kind, mechanism.nq + k, mechanism.nv + k, {id}});
    }
    loops.imaginary.push_back(*choice.imaginary);
    edges.push_back({choice.imaginary->a.value, choice.imaginary->b.value, 0});
  }
  for (const std::vector<EdgeStep>& cycle : cycle_basis(mechanism.bodies.size(), edges)) {
    Walk walk(mechanism, first_variable);
    for (const EdgeStep& step : cycle) {
      if (step.edge < mechanism.joints.size()) {
        walk.pass({step.edge}, step.reversed);
      } else {
        walk.pass_imaginary({step.edge}, first_variable[step.edge], step.reversed);
      }
    }
    loops.loops.push_back(walk.close());
  }
  return result;
}

}  // namespace koppel

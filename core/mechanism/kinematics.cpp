#include "mechanism/kinematics.hpp"

#include <array>

#include "mechanism/elementary_motion.hpp"

namespace koppel {

Kinematics::Kinematics(const Mechanism& mechanism)
    : poses(mechanism.nodes),
      near(mechanism.steps.size()),
      far(mechanism.steps.size()),
      columns(mechanism.nv, Column{Vector3::Zero(), Vector3::Zero(), Vector3::Zero()}),
      motions(mechanism.nodes) {}

bool forward_position(const Mechanism& mechanism, const double* q, Kinematics& kinematics) {
  for (std::size_t i = 0; i < mechanism.steps.size(); ++i) {
    const TreeStep& step = mechanism.steps[i];
    const Joint& joint = mechanism.joints[step.joint.index()];
    Column* const columns = kinematics.columns.data() + joint.v;
    PlainPose frame(kinematics.poses[step.parent]);
    if (!step.near_is_parent) frame = frame.times(step.to_near);
    frame.store(kinematics.near[i]);
    // Joints of one motion, which most are, without a call.
    if (joint.motions().size() == 1) {
      step_one(joint.motions().front(), q + joint.q, step.reversed, frame, columns);
      frame.store(kinematics.far[i]);
    } else {
      kinematics.far[i] = kinematics.near[i];
      if (!joint.step(q + joint.q, step.reversed, kinematics.far[i], columns)) {
        kinematics.culprit = step.joint;
        return false;
      }
      frame = PlainPose(kinematics.far[i]);
    }
    if (!step.far_is_child) frame = frame.times(step.from_far);
    frame.store(kinematics.poses[step.child]);
  }
  return true;
}

bool forward_motion(const Mechanism& mechanism, const double* q, const double* v, const double* a,
                    Kinematics& kinematics) {
  for (std::size_t i = 0; i < mechanism.steps.size(); ++i) {
    const TreeStep& step = mechanism.steps[i];
    const Joint& joint = mechanism.joints[step.joint.index()];
    const Column* const columns = kinematics.columns.data() + joint.v;
    FrameMotion& child = kinematics.motions[step.child];
    PlainMotion motion(kinematics.motions[step.parent]);
    if (joint.motions().size() == 1) {
      step_motion_one(joint.motions().front(), v + joint.v, a + joint.v, columns, motion);
    } else {
      child = kinematics.motions[step.parent];
      if (!joint.step_motion(q + joint.q, v + joint.v, a + joint.v, step.reversed, kinematics.near[i],
                             kinematics.far[i], columns, child)) {
        kinematics.culprit = step.joint;
        return false;
      }
      motion = PlainMotion(child);
    }
    motion.shift(Plain3(kinematics.poses[step.child].position));
    motion.store(child);
  }
  return true;
}

RelativeTwist relative_twist(const Pose& a, const FrameMotion& motion_a, const Pose& b, const FrameMotion& motion_b) {
  const Vector3 d = b.position - a.position;
  const Vector3& wa = motion_a.angular_velocity;
  const Vector3& wb = motion_b.angular_velocity;
  const Vector3 apart = motion_b.velocity - motion_a.velocity;
  const Vector3 slide = apart - wa.cross(d);
  const Vector3 slide_rate = motion_b.acceleration - motion_a.acceleration - motion_a.angular_acceleration.cross(d) -
                             wa.cross(apart) - wb.cross(slide);
  const Vector3 turn_rate = motion_b.angular_acceleration - motion_a.angular_acceleration + wb.cross(wa);
  const Matrix3 to_b = b.rotation.transpose();
  RelativeTwist result;
  result.twist << to_b * (wb - wa), to_b * slide;
  result.rate << to_b * turn_rate, to_b * slide_rate;
  return result;
}

namespace {

/// Calls `visit(step number)` for every step from a node back to the ground; stops when it returns false.
template <typename Visit>
bool walk_to_ground(const Mechanism& mechanism, Node node, const Visit& visit) {
  for (std::size_t i = mechanism.steps.size(); i-- > 0;) {
    if (mechanism.steps[i].child != node) continue;
    if (!visit(i)) return false;
    node = mechanism.steps[i].parent;
  }
  return true;
}

}  // namespace

void frame_jacobian(const Mechanism& mechanism, const Kinematics& kinematics, Node node, const Vector3& in_node,
                    Jacobian& jacobian) {
  jacobian.setZero(6, mechanism.nv);
  const Vector3 at = kinematics.poses[node] * in_node;
  walk_to_ground(mechanism, node, [&](std::size_t i) {
    const Joint& joint = mechanism.joints[mechanism.steps[i].joint.index()];
    for (std::uint32_t k = joint.v; k < joint.v + joint.nv; ++k) {
      const Column& c = kinematics.columns[k];
      jacobian.col(k) << c.angular, c.linear + c.angular.cross(at - c.point);
    }
    return true;
  });
}

bool frame_jacobian_rate(const Mechanism& mechanism, const double* q, const double* v, Kinematics& kinematics,
                         Node node, const Vector3& in_node, Jacobian& rate) {
  rate.setZero(6, mechanism.nv);
  const FrameMotion frame = motion_of(kinematics, node, in_node);
  return walk_to_ground(mechanism, node, [&](std::size_t i) {
    const TreeStep& step = mechanism.steps[i];
    const Joint& joint = mechanism.joints[step.joint.index()];
    const Column* columns = kinematics.columns.data() + joint.v;
    std::array<ColumnRate, max_joint_rates> rates;
    if (!joint.column_rates(q + joint.q, v + joint.v, step.reversed, kinematics.near[i], kinematics.far[i], columns,
                            kinematics.motions[step.parent], rates.data())) {
      kinematics.culprit = step.joint;
      return false;
    }
    for (std::uint32_t k = 0; k < joint.nv; ++k) {
      const Column& c = columns[k];
      rate.col(joint.v + k) << rates[k].angular, rates[k].linear + rates[k].angular.cross(frame.at - c.point) +
                                                     c.angular.cross(frame.velocity - rates[k].point);
    }
    return true;
  });
}

}  // namespace koppel

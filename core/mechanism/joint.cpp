#include "mechanism/joint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mechanism/coordinates.hpp"
#include "mechanism/elementary_motion.hpp"
#include "plugin/motion.hpp"

namespace koppel {
namespace {

ElementaryMotion compiled(const koppel_motion& from, const JointBlock& block) {
  ElementaryMotion motion;
  switch (from.kind) {
    case KOPPEL_MOTION_ROTATION: motion.kind = ElementaryMotionKind::rotation; break;
    case KOPPEL_MOTION_TRANSLATION: motion.kind = ElementaryMotionKind::translation; break;
    case KOPPEL_MOTION_SCREW: motion.kind = ElementaryMotionKind::screw; break;
    default: motion.kind = ElementaryMotionKind::free_rotation; break;
  }
  motion.q = block.q;
  motion.v = block.v;
  motion.zero = block.described.zero;
  motion.axis = Vector3(from.axis[0], from.axis[1], from.axis[2]);
  if (motion.kind != ElementaryMotionKind::translation)
    motion.point = Vector3(from.point[0], from.point[1], from.point[2]);
  if (motion.kind == ElementaryMotionKind::screw) motion.pitch = from.pitch;
  return motion;
}

}  // namespace

Result<Joint> Joint::build(const JointDescription& description) {
  Joint joint;
  joint.name = description.name;
  joint.type = description.type;
  joint.inlet = description.inlet;
  joint.outlet = description.outlet;
  for (std::size_t i = 0; i < joint.type->blocks.size(); ++i) {
    const BlockKind kind = joint.type->blocks[i].kind;
    joint.blocks.push_back({kind, joint.nq, joint.nv, description.coordinates[i]});
    joint.nq += static_cast<std::uint32_t>(coordinate_count(kind));
    joint.nv += static_cast<std::uint32_t>(rate_count(kind));
  }
  const auto located = [&](Error error) {
    error.source = description.source;
    error.element = "joint " + description.name;
    return error;
  };
  auto instance = joint.type->create(description.values);
  if (!instance) return tl::make_unexpected(located(std::move(instance).error()));
  joint.instance_ = std::move(*instance);
  if (joint.is_product() && joint.nv > 0) {
    auto motions = joint_motions(*joint.type, joint.instance_);
    if (!motions) return tl::make_unexpected(located(std::move(motions).error()));
    for (const koppel_motion& m : *motions) joint.motions_.push_back(compiled(m, joint.blocks[m.coordinate]));
  }
  return joint;
}

std::vector<std::string> Joint::numerical_parts() const {
  std::vector<std::string> parts;
  if (is_product()) return parts;
  if (type->calls.subspace == nullptr) parts.emplace_back("subspace");
  if (type->calls.bias == nullptr) parts.emplace_back("bias");
  return parts;
}

bool Joint::step(const double* joint_q, bool reversed, Pose& frame, Column* columns) const {
  if (is_product()) {
    const std::size_t n = motions_.size();
    PlainPose moved(frame);
    for (std::size_t i = 0; i < n; ++i) {
      const ElementaryMotion& motion = motions_[reversed ? n - 1 - i : i];
      step_one(motion, joint_q + motion.q, reversed, moved, columns + motion.v);
    }
    moved.store(frame);
    return true;
  }
  Pose relative;
  Subspace s(6, nv);
  if (!callback_pose(joint_q, relative) || !callback_subspace(joint_q, s)) return false;
  const Pose near = frame;
  frame = near * (reversed ? relative.inverse() : relative);
  const Pose& at_outlet = reversed ? near : frame;
  const double sign = reversed ? -1.0 : 1.0;
  for (std::uint32_t i = 0; i < nv; ++i) {
    columns[i] = {sign * (at_outlet.rotation * s.col(i).head<3>()), sign * (at_outlet.rotation * s.col(i).tail<3>()),
                  at_outlet.position};
  }
  return true;
}

bool Joint::step_motion(const double* joint_q, const double* joint_v, const double* joint_a, bool reversed,
                        const Pose& near, const Pose& far, const Column* columns, FrameMotion& motion) const {
  if (is_product()) {
    const std::size_t n = motions_.size();
    PlainMotion moved(motion);
    for (std::size_t i = 0; i < n; ++i) {
      const ElementaryMotion& m = motions_[reversed ? n - 1 - i : i];
      step_motion_one(m, joint_v + m.v, joint_a + m.v, columns + m.v, moved);
    }
    moved.shift(Plain3(far.position));
    moved.store(motion);
    return true;
  }
  Vector6 relative_bias;
  if (!callback_bias(joint_q, joint_v, joint_v, relative_bias)) return false;
  // Relative velocity and its rate in outlet axes, turned into world axes; of the outlet against the inlet.
  const Matrix3& axes = reversed ? near.rotation : far.rotation;
  Vector3 turn = Vector3::Zero(), slide = Vector3::Zero();
  Vector3 turn_rate = axes * relative_bias.head<3>(), slide_rate = axes * relative_bias.tail<3>();
  const double sign = reversed ? -1.0 : 1.0;
  for (std::uint32_t i = 0; i < nv; ++i) {
    turn += sign * joint_v[i] * columns[i].angular;
    slide += sign * joint_v[i] * columns[i].linear;
    turn_rate += sign * joint_a[i] * columns[i].angular;
    slide_rate += sign * joint_a[i] * columns[i].linear;
  }
  if (!reversed) {
    motion.shift(far.position);  // the inlet's motion, at the outlet's place
    const Vector3 before = motion.angular_velocity;
    motion.acceleration += 2.0 * before.cross(slide) + turn.cross(slide) + slide_rate;
    motion.angular_acceleration += before.cross(turn) + turn_rate;
    motion.velocity += slide;
    motion.angular_velocity += turn;
    return true;
  }
  // Backwards: motion is the outlet's; solve the same relations for the inlet's.
  motion.shift(near.position);
  const Vector3 outlet_turn = motion.angular_velocity, outlet_alpha = motion.angular_acceleration;
  motion.angular_velocity = outlet_turn - turn;
  motion.angular_acceleration = outlet_alpha - motion.angular_velocity.cross(turn) - turn_rate;
  // At the outlet's place the inlet's field has these values; then move it home.
  motion.velocity -= slide;
  motion.acceleration -= 2.0 * motion.angular_velocity.cross(slide) + turn.cross(slide) + slide_rate;
  motion.shift(far.position);
  return true;
}

bool Joint::column_rates(const double* joint_q, const double* joint_v, bool reversed, const Pose& near, const Pose& far,
                         const Column* columns, FrameMotion motion, ColumnRate* rates) const {
  const std::array<double, max_joint_rates> rest{};
  if (is_product()) {
    const std::size_t n = motions_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const ElementaryMotion& m = motions_[reversed ? n - 1 - i : i];
      const bool turns_with_far_side = m.kind == ElementaryMotionKind::free_rotation && !reversed;
      motion.shift(columns[m.v].point);
      const FrameMotion before = motion;
      PlainMotion moved(motion);
      step_motion_one(m, joint_v + m.v, rest.data(), columns + m.v, moved);
      moved.store(motion);
      const Vector3 turning = turns_with_far_side ? motion.angular_velocity : before.angular_velocity;
      for (std::uint32_t k = m.v; k < m.v + (m.kind == ElementaryMotionKind::free_rotation ? 3u : 1u); ++k) {
        rates[k] = {turning.cross(columns[k].angular), turning.cross(columns[k].linear), before.velocity};
      }
    }
    return true;
  }
  // The columns are components in outlet axes: they turn with the outlet, and change with S.
  if (!reversed && !step_motion(joint_q, joint_v, rest.data(), false, near, far, columns, motion)) return false;
  const Pose& at_outlet = reversed ? near : far;
  motion.shift(at_outlet.position);
  const double sign = reversed ? -1.0 : 1.0;
  for (std::uint32_t k = 0; k < nv; ++k) {
    std::array<double, max_joint_rates> unit{};
    unit[k] = 1.0;
    Vector6 s_rate;
    if (!callback_bias(joint_q, joint_v, unit.data(), s_rate)) return false;
    rates[k] = {motion.angular_velocity.cross(columns[k].angular) + sign * (at_outlet.rotation * s_rate.head<3>()),
                motion.angular_velocity.cross(columns[k].linear) + sign * (at_outlet.rotation * s_rate.tail<3>()),
                motion.velocity};
  }
  return true;
}

bool Joint::pose(const double* joint_q, Pose& result) const {
  if (!is_product()) return callback_pose(joint_q, result);
  std::array<Column, max_joint_rates> columns;
  result = Pose{};
  return step(joint_q, false, result, columns.data());
}

bool Joint::subspace(const double* joint_q, Subspace& s) const {
  s.resize(6, nv);
  if (!is_product()) return callback_subspace(joint_q, s);
  std::array<Column, max_joint_rates> columns;
  Pose far;
  step(joint_q, false, far, columns.data());
  for (std::uint32_t i = 0; i < nv; ++i) {
    const Column& c = columns[i];
    s.col(i) << far.rotation.transpose() * c.angular,
        far.rotation.transpose() * (c.linear + c.angular.cross(far.position - c.point));
  }
  return true;
}

bool Joint::bias(const double* joint_q, const double* joint_v, Vector6& result) const {
  if (!is_product()) return callback_bias(joint_q, joint_v, joint_v, result);
  std::array<Column, max_joint_rates> columns;
  Pose far;
  step(joint_q, false, far, columns.data());
  FrameMotion motion;
  const std::array<double, max_joint_rates> rest{};
  step_motion(joint_q, joint_v, rest.data(), false, Pose{}, far, columns.data(), motion);
  // Components in outlet axes: their rates lack the turning of the axes.
  const Vector3 rate = motion.acceleration - motion.angular_velocity.cross(motion.velocity);
  result << far.rotation.transpose() * motion.angular_acceleration, far.rotation.transpose() * rate;
  return true;
}

void Joint::integrate(const double* joint_q, const double* delta, double* result) const {
  for (const JointBlock& block : blocks) {
    integrate_block(block.kind, joint_q + block.q, delta + block.v, result + block.q);
  }
}

}  // namespace koppel

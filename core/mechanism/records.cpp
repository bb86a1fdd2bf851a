#include "mechanism/records.hpp"

#include <algorithm>
#include <limits>

#include "spatial/angle_sequence.hpp"
#include "spatial/screw_axis.hpp"

namespace koppel {
namespace {

template <typename Vector>
void append(const Vector& from, double* to) {
  std::copy(from.data(), from.data() + from.size(), to);
}

void coordinate(const Mechanism& mechanism, const State& state, const Loads* loads, const RecordDescription& record,
                double* to) {
  const Joint& joint = mechanism.joints[record.joint.index()];
  const JointBlock& block = joint.blocks[record.block];
  const auto n = static_cast<Eigen::Index>(rate_count(block.kind));
  if (record.quantity == Quantity::rate) return append(state.v.segment(joint.v + block.v, n), to);
  if (record.quantity == Quantity::acceleration) return append(state.a.segment(joint.v + block.v, n), to);
  if (record.quantity == Quantity::effort) return append(loads->efforts.segment(joint.v + block.v, n), to);
  append(state.q.segment(joint.q + block.q, static_cast<Eigen::Index>(coordinate_count(block.kind))), to);
}

void joint_cardan(const Mechanism& mechanism, const State& state, const RecordDescription& record, double* to) {
  const Joint& joint = mechanism.joints[record.joint.index()];
  const Vector4 q = state.q.segment<4>(joint.q + joint.blocks[record.block].q);
  append(CardanAngles::of_quaternion<double>(q).coordinates, to);
}

void joint_load(const Loads& loads, const RecordDescription& record, double* to) {
  const Wrench& load = loads.joints[record.joint.index()];
  append(record.quantity == Quantity::force ? load.force : load.moment, to);
}

MotionSample sample(const Attachment& frame, const Kinematics& kinematics) {
  const FrameMotion& motion = kinematics.motions[frame.body.value];
  return {pose_of(kinematics, frame.body.value, frame.pose),
          shifted(Twist{motion.angular_velocity, motion.velocity}, Vector3(-motion.at))};
}

/// Point, direction and pitch of the instantaneous screw axis (K-II-1.2.1c).
void axode(const Mechanism& mechanism, const RecordDescription& record, const Kinematics& kinematics, double* to) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const MotionSample fixed = record.against ? sample(*record.against, kinematics) : MotionSample{};
  const MotionSample motion = relative_sample(fixed, sample(record.frame, kinematics));
  ScrewAxis axis = screw_axis<double>(motion.twist, mechanism.length);
  if (record.quantity == Quantity::moving_axode) axis = transformed<double>(motion.x_01.inverse(), axis);
  const bool rests = axis.kind == MotionKind::rest;
  const bool far = rests || axis.kind == MotionKind::translation;
  append(far ? Vector3(Vector3::Constant(none)) : axis.point(), to);
  append(rests ? Vector3(Vector3::Constant(none)) : axis.line.direction, to + 3);
  to[6] = rests ? none : axis.pitch;
}

void frame(const Mechanism& mechanism, const RecordDescription& record, const Kinematics& kinematics, double* to) {
  const Pose pose = pose_of(kinematics, record.frame.body.value, record.frame.pose);
  const FrameMotion motion = motion_of(kinematics, record.frame.body.value, record.frame.pose.position);
  switch (record.quantity) {
    case Quantity::quaternion: return append(quaternion_of_rotation<double>(pose.rotation), to);
    case Quantity::cardan: return append(extracted<CardanAngles, double>(pose.rotation).coordinates, to);
    case Quantity::velocity: return append(motion.velocity, to);
    case Quantity::angular_velocity: return append(motion.angular_velocity, to);
    case Quantity::linear_acceleration: return append(motion.acceleration, to);
    case Quantity::angular_acceleration: return append(motion.angular_acceleration, to);
    case Quantity::fixed_axode:
    case Quantity::moving_axode: return axode(mechanism, record, kinematics, to);
    case Quantity::value:
    case Quantity::rate:
    case Quantity::acceleration:
    case Quantity::effort:
    case Quantity::force:
    case Quantity::moment:
    case Quantity::position: return append(pose.position, to);
  }
}

}  // namespace

void evaluate_records(const Mechanism& mechanism, const State& state, const Kinematics& kinematics, const Loads* loads,
                      const std::optional<CoordinateReference>& by, double* values) {
  for (const RecordColumn& column : mechanism.record_columns) {
    double* const to = values++;
    const RecordDescription& record = mechanism.records[column.record];
    if (column.component != 0 || record.by != by) continue;
    switch (record.subject) {
      case RecordSubject::coordinate: coordinate(mechanism, state, loads, record, to); break;
      case RecordSubject::joint_cardan: joint_cardan(mechanism, state, record, to); break;
      case RecordSubject::joint_load: joint_load(*loads, record, to); break;
      case RecordSubject::frame: frame(mechanism, record, kinematics, to); break;
    }
  }
}

}  // namespace koppel

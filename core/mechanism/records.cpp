#include "mechanism/records.hpp"

#include <algorithm>

#include "spatial/angle_sequence.hpp"

namespace koppel {
namespace {

template <typename Vector>
double* append(const Vector& from, double* to) {
  return std::copy(from.data(), from.data() + from.size(), to);
}

double* coordinate(const Mechanism& mechanism, const State& state, const Loads* loads, const RecordDescription& record,
                   double* to) {
  const Joint& joint = mechanism.joints[record.joint.index()];
  const JointBlock& block = joint.blocks[record.block];
  const auto n = static_cast<Eigen::Index>(rate_count(block.kind));
  if (record.quantity == Quantity::rate) return append(state.v.segment(joint.v + block.v, n), to);
  if (record.quantity == Quantity::acceleration) return append(state.a.segment(joint.v + block.v, n), to);
  if (record.quantity == Quantity::effort) return append(loads->efforts.segment(joint.v + block.v, n), to);
  return append(state.q.segment(joint.q + block.q, static_cast<Eigen::Index>(coordinate_count(block.kind))), to);
}

double* joint_cardan(const Mechanism& mechanism, const State& state, const RecordDescription& record, double* to) {
  const Joint& joint = mechanism.joints[record.joint.index()];
  const Vector4 q = state.q.segment<4>(joint.q + joint.blocks[record.block].q);
  return append(CardanAngles::of_quaternion<double>(q).coordinates, to);
}

double* joint_load(const Loads& loads, const RecordDescription& record, double* to) {
  const Wrench& load = loads.joints[record.joint.index()];
  return append(record.quantity == Quantity::force ? load.force : load.moment, to);
}

double* frame(const RecordDescription& record, const Kinematics& kinematics, double* to) {
  const Pose pose = pose_of(kinematics, record.frame.body.value, record.frame.pose);
  const FrameMotion motion = motion_of(kinematics, record.frame.body.value, record.frame.pose.position);
  switch (record.quantity) {
    case Quantity::quaternion: return append(quaternion_of_rotation<double>(pose.rotation), to);
    case Quantity::cardan: return append(extracted<CardanAngles, double>(pose.rotation).coordinates, to);
    case Quantity::velocity: return append(motion.velocity, to);
    case Quantity::angular_velocity: return append(motion.angular_velocity, to);
    case Quantity::linear_acceleration: return append(motion.acceleration, to);
    case Quantity::angular_acceleration: return append(motion.angular_acceleration, to);
    case Quantity::value:
    case Quantity::rate:
    case Quantity::acceleration:
    case Quantity::effort:
    case Quantity::force:
    case Quantity::moment:
    case Quantity::position: return append(pose.position, to);
  }
  return to;
}

}  // namespace

void evaluate_records(const Mechanism& mechanism, const State& state, const Kinematics& kinematics, const Loads* loads,
                      double* values) {
  for (const RecordDescription& record : mechanism.records) {
    switch (record.subject) {
      case RecordSubject::coordinate: values = coordinate(mechanism, state, loads, record, values); break;
      case RecordSubject::joint_cardan: values = joint_cardan(mechanism, state, record, values); break;
      case RecordSubject::joint_load: values = joint_load(*loads, record, values); break;
      case RecordSubject::frame: values = frame(record, kinematics, values); break;
    }
  }
}

}  // namespace koppel

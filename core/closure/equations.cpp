#include "closure/equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/QR>

#include "spatial/rotation_vector.hpp"

namespace koppel {
namespace {

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

std::string joint_text(const Mechanism& mechanism, std::uint32_t i) {
  const Joint& joint = mechanism.joints[i];
  return "joint " + joint.name + " of type " + joint.type->name + " (" + joint.type->origin + ")";
}

std::string constraint_text(const Mechanism& mechanism, std::uint32_t i) {
  const Constraint& constraint = mechanism.constraints[i];
  return "constraint " + constraint.name + " of type " + constraint.type->name + " (" + constraint.type->origin + ")";
}

std::string input_text(const Mechanism& mechanism, std::uint32_t i) {
  const Input& input = mechanism.inputs[i];
  return "drive " + input.name + " of type " + input.type->name + " (" + input.type->origin + ")";
}

/// Rates whose twist S rates is nearest to the given one. Columns across each other, as most joints have them, need no
/// factorisation.
void rates_of_twist(const Subspace& s, const Vector6& twist, double* rates) {
  constexpr double across = 4.0 * std::numeric_limits<double>::epsilon();
  const Eigen::Index n = s.cols();
  std::array<double, 6> square{};
  bool orthogonal = true;
  for (Eigen::Index i = 0; i < n && orthogonal; ++i) {
    square[static_cast<std::size_t>(i)] = s.col(i).squaredNorm();
    orthogonal = square[static_cast<std::size_t>(i)] > 0.0;
    for (Eigen::Index j = 0; j < i && orthogonal; ++j) {
      const double sizes = square[static_cast<std::size_t>(i)] * square[static_cast<std::size_t>(j)];
      const double product = s.col(i).dot(s.col(j));
      orthogonal = product * product <= across * across * sizes;
    }
  }
  if (orthogonal) {
    for (Eigen::Index i = 0; i < n; ++i) rates[i] = s.col(i).dot(twist) / square[static_cast<std::size_t>(i)];
    return;
  }
  const Eigen::ColPivHouseholderQR<Subspace> qr(s);
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>>(rates, n) = qr.solve(twist);
}

}  // namespace

Equations::Equations(const Mechanism& m)
    : mechanism(m),
      kinematics(m),
      residual(Eigen::VectorXd::Zero(m.rows)),
      jacobian(m.rows, m.columns),
      locals_(m.relations.size()) {
  for (std::size_t i = 0; i < m.relations.size(); ++i) {
    const Relation& relation = m.relations[i];
    locals_[i].by_twist.assign(std::size_t{6} * relation.rows, 0.0);
    locals_[i].by_rate.assign(relation.coupled.size() * relation.rows, 0.0);
    locals_[i].q.assign(relation.coupled.size(), 0.0);
    locals_[i].v.assign(relation.coupled.size(), 0.0);
    locals_[i].out.assign(relation.rows, 0.0);
    block_.resize(std::max(block_.size(), relation.rows * (relation.path.size() + relation.coupled.size())));
  }
  lay_out_jacobian();
}

void Equations::lay_out_jacobian() {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Relation& relation : mechanism.relations) {
    for_each_entry(relation, [&entries](std::uint32_t row, const PathRate& rate) {
      entries.emplace_back(static_cast<int>(row), static_cast<int>(rate.column), 0.0);
    });
  }
  jacobian.setFromTriplets(entries.begin(), entries.end());
  for (const auto& entry : entries)
    order_.push_back(&jacobian.coeffRef(entry.row(), entry.col()) - jacobian.valuePtr());
}

bool Equations::joint_failed(JointId joint) {
  culprit_kind_ = joint_text;
  culprit_index_ = joint.value;
  return false;
}

bool Equations::constraint_failed(std::uint32_t constraint) {
  culprit_kind_ = constraint_text;
  culprit_index_ = constraint;
  return false;
}

void Equations::blame(const Input& input) {
  culprit_kind_ = input_text;
  culprit_index_ = static_cast<std::uint32_t>(&input - mechanism.inputs.data());
}

std::string Equations::culprit() const {
  return culprit_kind_ == nullptr ? std::string("a plugin") : culprit_kind_(mechanism, culprit_index_);
}

bool Equations::evaluate(const Eigen::VectorXd& q, double time) {
  time_ = time;
  if (!forward_position(mechanism, q.data(), kinematics)) return joint_failed(kinematics.culprit);
  for (std::size_t i = 0; i < mechanism.relations.size(); ++i) {
    const Relation& relation = mechanism.relations[i];
    if (!evaluate_relation(relation, locals_[i], q)) return false;
    for (std::uint32_t k = 0; k < relation.rows; ++k) {
      const std::uint32_t row = relation.first_row + k;
      residual[row] = mechanism.row_scale[row] * locals_[i].out[k];
    }
  }
  return true;
}

bool Equations::evaluate_relation(const Relation& relation, Local& local, const Eigen::VectorXd& q) {
  if (relation.has_frames) {
    local.a = pose_of(kinematics, relation.node_a, relation.pose_a);
    local.b = pose_of(kinematics, relation.node_b, relation.pose_b);
    local.relative = relative_pose(local.a, local.b);
  }
  switch (relation.kind) {
    case RelationKind::cut_joint: {
      const Joint& joint = mechanism.joints[relation.joint.index()];
      return relation.face->evaluate(joint, local.relative, local.out.data(), local.by_twist.data()) ||
             joint_failed(relation.joint);
    }
    case RelationKind::cut_body: {
      const Vector3 phi = rotation_vector_of_rotation<double>(local.relative.rotation);
      Eigen::Map<Vector6>(local.out.data()) << phi, local.relative.position;
      Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> jacobian_of_twist(local.by_twist.data());
      jacobian_of_twist.topLeftCorner<3, 3>() = right_jacobian_inverse<double>(phi);
      jacobian_of_twist.bottomRightCorner<3, 3>() = local.relative.rotation;
      return true;
    }
    case RelationKind::constraint: {
      const Constraint& constraint = mechanism.constraints[relation.constraint];
      for (std::size_t k = 0; k < local.q.size(); ++k) local.q[k] = q[constraint.q[k]];
      return evaluate_constraint(relation, local);
    }
  }
  return true;
}

koppel_configuration Equations::configuration(const Relation& relation, const Local& local, bool with_rates) {
  koppel_configuration at{};
  at.struct_size = sizeof(at);
  at.time = time_;
  at.coordinates = local.q.size();
  at.q = local.q.data();
  if (with_rates) at.v = local.v.data();
  if (relation.has_frames) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose_array_.data()) = local.relative.rotation;
    Eigen::Map<Vector3>(pose_array_.data() + 9) = local.relative.position;
    at.pose = pose_array_.data();
    if (with_rates) at.twist = twist_array_.data();
  }
  return at;
}

bool Equations::evaluate_constraint(const Relation& relation, Local& local) {
  const Constraint& constraint = mechanism.constraints[relation.constraint];
  const void* instance = constraint.instance.get();
  const koppel_configuration at = configuration(relation, local, false);
  std::fill(local.out.begin(), local.out.end(), std::nan(""));
  if (relation.has_frames) std::fill(local.by_twist.begin(), local.by_twist.end(), std::nan(""));
  std::fill(local.by_rate.begin(), local.by_rate.end(), std::nan(""));
  if (constraint.type->calls.residual(1, &instance, &at, local.out.data()) < 0 || !all_finite(local.out) ||
      constraint.type->calls.jacobian(1, &instance, &at, relation.has_frames ? local.by_twist.data() : nullptr,
                                      local.by_rate.empty() ? nullptr : local.by_rate.data()) < 0 ||
      !all_finite(local.by_twist) || !all_finite(local.by_rate)) {
    return constraint_failed(relation.constraint);
  }
  return true;
}

void Equations::relation_jacobian(std::size_t index, double* block) const {
  const Relation& relation = mechanism.relations[index];
  const Local& local = locals_[index];
  const std::size_t count = relation.coupled.size(), stride = relation.path.size() + count;
  const Matrix3 to_b = local.b.rotation.transpose();
  double* column = block;
  for (const PathRate& path : relation.path) {
    const Column& c = kinematics.columns[path.rate];
    const Vector3 angular = path.sign * (to_b * c.angular);
    const Vector3 linear = path.sign * (to_b * (c.linear + c.angular.cross(local.b.position - c.point)));
    for (std::uint32_t k = 0; k < relation.rows; ++k) {
      const double* row = local.by_twist.data() + std::size_t{6} * k;
      column[k * stride] = mechanism.row_scale[relation.first_row + k] *
                           (row[0] * angular[0] + row[1] * angular[1] + row[2] * angular[2] + row[3] * linear[0] +
                            row[4] * linear[1] + row[5] * linear[2]);
    }
    ++column;
  }
  for (std::uint32_t k = 0; k < relation.rows; ++k) {
    const double scale = mechanism.row_scale[relation.first_row + k];
    for (std::size_t j = 0; j < count; ++j) column[k * stride + j] = scale * local.by_rate[k * count + j];
  }
}

void Equations::evaluate_jacobian() {
  jacobian.coeffs().setZero();
  const Eigen::Index* place = order_.data();
  double* values = jacobian.valuePtr();
  for (std::size_t i = 0; i < mechanism.relations.size(); ++i) {
    relation_jacobian(i, block_.data());
    const double* entry = block_.data();
    // A constraint's coordinate may lie on its path too: its entries add up.
    for_each_entry(mechanism.relations[i], [&](std::uint32_t, const PathRate& rate) {
      values[*place++] += mechanism.rate_scale[rate.rate] * *entry++;
    });
  }
}

Wrench Equations::reaction(std::size_t index, const Eigen::VectorXd& multipliers) const {
  const Relation& relation = mechanism.relations[index];
  const Local& local = locals_[index];
  Vector6 at_b = Vector6::Zero();
  for (std::uint32_t k = 0; k < relation.rows; ++k) {
    const std::uint32_t row = relation.first_row + k;
    const Eigen::Map<const Vector6> by_twist(local.by_twist.data() + std::size_t{6} * k);
    at_b += multipliers[row] * mechanism.row_scale[row] * by_twist;
  }
  return {local.b.rotation * at_b.head<3>(), local.b.rotation * at_b.tail<3>()};
}

bool Equations::cut_coordinates(Eigen::VectorXd& q) {
  for (std::uint32_t i = 0; i < mechanism.loops; ++i) {
    const Relation& loop = mechanism.relations[i];
    if (loop.kind != RelationKind::cut_joint) continue;
    const Joint& joint = mechanism.joints[loop.joint.index()];
    if (!loop.face->coordinates(joint, locals_[i].relative, q.data() + joint.q)) return joint_failed(loop.joint);
  }
  return true;
}

bool Equations::time_rate(Eigen::VectorXd& rate) {
  rate.setZero();
  for (std::size_t i = mechanism.loops; i < mechanism.relations.size(); ++i) {
    const Relation& relation = mechanism.relations[i];
    const Constraint& constraint = mechanism.constraints[relation.constraint];
    if (constraint.type->calls.time_rate == nullptr) continue;
    Local& local = locals_[i];
    const void* instance = constraint.instance.get();
    const koppel_configuration at = configuration(relation, local, false);
    std::fill(local.out.begin(), local.out.end(), std::nan(""));
    if (constraint.type->calls.time_rate(1, &instance, &at, local.out.data()) < 0 || !all_finite(local.out)) {
      return constraint_failed(relation.constraint);
    }
    for (std::uint32_t k = 0; k < relation.rows; ++k) {
      rate[relation.first_row + k] = mechanism.row_scale[relation.first_row + k] * local.out[k];
    }
  }
  return true;
}

bool Equations::motion(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  return forward_motion(mechanism, q.data(), v.data(), a.data(), kinematics) || joint_failed(kinematics.culprit);
}

RelativeTwist Equations::relation_motion(const Relation& relation, const Local& local) const {
  return relative_twist(local.a, motion_of(kinematics, relation.node_a, relation.pose_a.position), local.b,
                        motion_of(kinematics, relation.node_b, relation.pose_b.position));
}

bool Equations::cut_rates(const Eigen::VectorXd& q, Eigen::VectorXd& v) {
  for (std::uint32_t i = 0; i < mechanism.loops; ++i) {
    const Relation& loop = mechanism.relations[i];
    if (loop.kind != RelationKind::cut_joint) continue;
    const Joint& joint = mechanism.joints[loop.joint.index()];
    Subspace s(6, joint.nv);
    if (!joint.subspace(q.data() + joint.q, s)) return joint_failed(loop.joint);
    rates_of_twist(s, relation_motion(loop, locals_[i]).twist, v.data() + joint.v);
  }
  return true;
}

bool Equations::bias(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& result) {
  for (std::size_t i = 0; i < mechanism.relations.size(); ++i) {
    const Relation& relation = mechanism.relations[i];
    Local& local = locals_[i];
    std::fill(local.out.begin(), local.out.end(), 0.0);
    Vector6 rate = Vector6::Zero();
    if (relation.has_frames) {
      const RelativeTwist relative = relation_motion(relation, local);
      rate = relative.rate;
      Eigen::Map<Vector6>(twist_array_.data()) = relative.twist;
    }
    if (relation.kind == RelationKind::cut_joint) {
      // Along the joint's own motion the rows vanish identically, so what they add is minus what S_dot v adds.
      const Joint& joint = mechanism.joints[relation.joint.index()];
      Vector6 own;
      if (!joint.bias(q.data() + joint.q, v.data() + joint.v, own)) return joint_failed(relation.joint);
      rate -= own;
    } else if (relation.kind == RelationKind::constraint) {
      const Constraint& constraint = mechanism.constraints[relation.constraint];
      for (std::size_t k = 0; k < local.v.size(); ++k) local.v[k] = v[constraint.v[k]];
      const void* instance = constraint.instance.get();
      const koppel_configuration at = configuration(relation, local, true);
      std::fill(local.out.begin(), local.out.end(), std::nan(""));
      if (constraint.type->calls.second_order(1, &instance, &at, local.out.data()) < 0 || !all_finite(local.out)) {
        return constraint_failed(relation.constraint);
      }
    }
    for (std::uint32_t k = 0; k < relation.rows; ++k) {
      const Eigen::Map<const Vector6> row(local.by_twist.data() + std::size_t{6} * k);
      result[relation.first_row + k] = mechanism.row_scale[relation.first_row + k] * (local.out[k] + row.dot(rate));
    }
  }
  return true;
}

bool Equations::cut_accelerations(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& a) {
  for (std::uint32_t i = 0; i < mechanism.loops; ++i) {
    const Relation& loop = mechanism.relations[i];
    if (loop.kind != RelationKind::cut_joint) continue;
    const Joint& joint = mechanism.joints[loop.joint.index()];
    Subspace s(6, joint.nv);
    Vector6 own;
    if (!joint.subspace(q.data() + joint.q, s) || !joint.bias(q.data() + joint.q, v.data() + joint.v, own)) {
      return joint_failed(loop.joint);
    }
    rates_of_twist(s, relation_motion(loop, locals_[i]).rate - own, a.data() + joint.v);
  }
  return true;
}

}  // namespace koppel

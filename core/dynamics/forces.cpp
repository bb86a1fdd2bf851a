#include "dynamics/forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace koppel {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

/// `count` numbers that a plugin must have overwritten to pass as finite; null if there are none.
double* to_fill(double* first, std::size_t count) {
  std::fill_n(first, count, nan);
  return count == 0 ? nullptr : first;
}

}  // namespace

Forces::Forces(const Mechanism& mechanism) : mechanism_(mechanism) {
  std::size_t coordinates = 0, states = 0;
  for (const Force& force : mechanism.forces) {
    coordinates = std::max(coordinates, force.q.size());
    states = std::max(states, force.type->states.size());
    switch_count_ += force.type->calls.switch_count;
  }
  for (auto* scratch : {&q_, &v_, &effort_}) scratch->assign(coordinates, 0.0);
  unused_rates_.assign(states, 0.0);
}

std::string Forces::culprit() const {
  if (culprit_ == nullptr) return "a force";
  return "force " + culprit_->name + " of type " + culprit_->type->name + " (" + culprit_->type->origin + ")";
}

bool Forces::failed(const Force& force) {
  culprit_ = &force;
  return false;
}

koppel_configuration Forces::at(const Kinematics& kinematics, const Force& force, double time, const double* q,
                                const double* v) {
  koppel_configuration at{};
  at.struct_size = sizeof(at);
  at.time = time;
  at.coordinates = force.q.size();
  for (std::size_t i = 0; i < force.q.size(); ++i) {
    q_[i] = q[force.q[i]];
    if (v != nullptr) v_[i] = v[force.v[i]];
  }
  at.q = q_.data();
  if (v != nullptr) at.v = v_.data();
  if (!force.has_frames) return at;
  a_ = pose_of(kinematics, force.node_a, force.pose_a);
  b_ = pose_of(kinematics, force.node_b, force.pose_b);
  const Pose relative = relative_pose(a_, b_);
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose_.data()) = relative.rotation;
  Eigen::Map<Vector3>(pose_.data() + 9) = relative.position;
  at.pose = pose_.data();
  if (v == nullptr) return at;
  Eigen::Map<Vector6>(twist_.data()) = relative_twist(a_, motion_of(kinematics, force.node_a, force.pose_a.position),
                                                      b_, motion_of(kinematics, force.node_b, force.pose_b.position))
                                           .twist;
  at.twist = twist_.data();
  return at;
}

const double* Forces::states_of(const Force& force, const double* states) const {
  return force.type->states.empty() ? nullptr : states + force.first_state;
}

bool Forces::call(const Force& force, const koppel_configuration& configuration, const double* states,
                  double* state_rates) {
  const void* instance = force.instance.get();
  double* wrench = to_fill(wrench_.data(), force.has_frames ? wrench_.size() : 0);
  double* effort = to_fill(effort_.data(), force.q.size());
  const std::size_t rates = force.type->states.size();
  double* own_rates = to_fill(state_rates, rates);
  const koppel_status status =
      force.type->calls.evaluate(1, &instance, &configuration, states, wrench, effort, own_rates);
  if (status < 0 || (force.has_frames && !all_finite(wrench_)) || !all_finite({effort_.data(), force.q.size()}) ||
      !all_finite({state_rates, rates})) {
    return failed(force);
  }
  return true;
}

/// Levers are vectors within the bodies and between the two frames, never positions in the world, which may be far
/// longer.
void Forces::add(const Kinematics& kinematics, const Force& force, std::vector<Wrench>& on_nodes) const {
  const Matrix3& to_world = b_.rotation;
  const Wrench at_b{to_world * Eigen::Map<const Vector3>(wrench_.data()),
                    to_world * Eigen::Map<const Vector3>(wrench_.data() + 3)};
  const auto act = [&](Node node, const Vector3& lever, const Wrench& wrench) {
    on_nodes[node].moment += wrench.moment + lever.cross(wrench.force);
    on_nodes[node].force += wrench.force;
  };
  act(force.node_b, kinematics.poses[force.node_b].rotation * force.pose_b.position, at_b);
  const Vector3 to_a = kinematics.poses[force.node_a].rotation * force.pose_a.position;
  act(force.node_a, to_a + (b_.position - a_.position), -at_b);
}

bool Forces::evaluate(const Kinematics& kinematics, const double* q, const double* v, double time, const double* states,
                      std::vector<Wrench>& on_nodes, Eigen::VectorXd& efforts, double* state_rates) {
  for (const Force& force : mechanism_.forces) {
    const koppel_configuration configuration = at(kinematics, force, time, q, v);
    double* rates = force.type->states.empty() ? nullptr : state_rates + force.first_state;
    if (!call(force, configuration, states_of(force, states), rates)) return false;
    if (force.has_frames) add(kinematics, force, on_nodes);
    for (std::size_t i = 0; i < force.v.size(); ++i) efforts[force.v[i]] += effort_[i];
  }
  return true;
}

bool Forces::energy(const Kinematics& kinematics, const double* q, double time, const double* states,
                    double& potential) {
  potential = 0.0;
  for (const Force& force : mechanism_.forces) {
    if (force.type->calls.energy == nullptr) continue;
    const koppel_configuration configuration = at(kinematics, force, time, q, nullptr);
    const void* instance = force.instance.get();
    double own = nan;
    if (force.type->calls.energy(1, &instance, &configuration, states_of(force, states), &own) < 0 ||
        !std::isfinite(own)) {
      return failed(force);
    }
    potential += own;
  }
  return true;
}

double Forces::delivered(const Force& force) const {
  double power = 0.0;
  if (force.has_frames) power = Eigen::Map<const Vector6>(wrench_.data()).dot(Eigen::Map<const Vector6>(twist_.data()));
  for (std::size_t i = 0; i < force.v.size(); ++i) power += effort_[i] * v_[i];
  return power;
}

bool Forces::power(const Kinematics& kinematics, const double* q, const double* v, double time, const double* states,
                   double& dissipated, double& external) {
  dissipated = external = 0.0;
  for (const Force& force : mechanism_.forces) {
    const koppel_force_type& calls = force.type->calls;
    if (calls.energy != nullptr && calls.dissipation == nullptr) continue;
    const koppel_configuration configuration = at(kinematics, force, time, q, v);
    const double* own_states = states_of(force, states);
    if (calls.energy == nullptr) {
      if (!call(force, configuration, own_states, unused_rates_.data())) return false;
      external += delivered(force);
      continue;
    }
    const void* instance = force.instance.get();
    double own = nan;
    if (calls.dissipation(1, &instance, &configuration, own_states, &own) < 0 || !std::isfinite(own)) {
      return failed(force);
    }
    dissipated += own;
  }
  return true;
}

bool Forces::switches(const Kinematics& kinematics, const double* q, const double* v, double time, const double* states,
                      double* values) {
  for (const Force& force : mechanism_.forces) {
    const std::size_t count = force.type->calls.switch_count;
    if (count == 0) continue;
    const koppel_configuration configuration = at(kinematics, force, time, q, v);
    const void* instance = force.instance.get();
    if (force.type->calls.switches(1, &instance, &configuration, states_of(force, states), to_fill(values, count)) <
            0 ||
        !all_finite({values, count})) {
      return failed(force);
    }
    values += count;
  }
  return true;
}

}  // namespace koppel

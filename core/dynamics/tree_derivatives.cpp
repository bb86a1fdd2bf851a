#include "dynamics/tree_derivatives.hpp"

#include <algorithm>
#include <array>

namespace koppel {
namespace {

std::uint32_t rate_count(const ElementaryMotion& motion) {
  return motion.kind == ElementaryMotionKind::free_rotation ? 3 : 1;
}

std::uint8_t bits(std::uint32_t first, std::uint32_t count) {
  return static_cast<std::uint8_t>(((1u << count) - 1u) << first);
}

/// For each rate of a joint those that carry its column along: all of motions before its own, and of a free rotation,
/// whose columns are fixed in the outlet, its own where the outlet comes last. Columns of callbacks are fixed there
/// too.
void find_carriers(const Joint& joint, bool reversed, std::uint8_t* carriers) {
  if (!joint.is_product()) {
    std::fill(carriers, carriers + joint.nv, reversed ? std::uint8_t{0} : bits(0, joint.nv));
    return;
  }
  std::uint8_t before = 0;
  const std::size_t n = joint.motions().size();
  for (std::size_t i = 0; i < n; ++i) {
    const ElementaryMotion& motion = joint.motions()[reversed ? n - 1 - i : i];
    const std::uint8_t own = bits(motion.v, rate_count(motion));
    const bool with_own = motion.kind == ElementaryMotionKind::free_rotation && !reversed;
    const auto carried_by = static_cast<std::uint8_t>(with_own ? before | own : before);
    std::fill(carriers + motion.v, carriers + motion.v + rate_count(motion), carried_by);
    before = static_cast<std::uint8_t>(before | own);
  }
}

/// How the components of a rate are spread, three numbers for each vector.
enum Part : std::size_t {
  column_linear = 0,
  column_angular = 3,
  acceleration_by_v = 6,
  velocity_by_q_angular = 12,
  acceleration_by_q = 15,
  spread_components = 21
};

/// out = the sum of as many neighbouring components as there are factors, for `size` rates; components lie n apart.
template <std::size_t count>
inline void combine(const double* x, std::size_t n, const std::array<double, count>& factors, std::uint32_t size,
                    double* __restrict out) {
  for (std::uint32_t k = 0; k < size; ++k) {
    double sum = factors[0] * x[k];
    for (std::size_t c = 1; c < count; ++c) sum += factors[c] * x[c * n + k];
    out[k] = sum;
  }
}

}  // namespace

TreeDerivatives::TreeDerivatives(const TreeLayout& layout, const Inertias& inertias)
    : layout_(layout),
      inertias_(inertias),
      bodies_(layout.mechanism().nodes),
      rates_(layout.rates()),
      carriers_(layout.rates()),
      spread_(spread_components * layout.rates()) {
  const Mechanism& mechanism = layout.mechanism();
  std::uint32_t slopes = 0;
  for (std::size_t i = 0; i < layout.steps().size(); ++i) {
    const Joint& joint = mechanism.joints[mechanism.steps[i].joint.index()];
    find_carriers(joint, mechanism.steps[i].reversed, carriers_.data() + layout.steps()[i].first);
    first_slope_.push_back(slopes);
    if (!joint.is_product()) slopes += joint.nv * joint.nv;
  }
  slopes_.resize(slopes);
  std::uint32_t deepest = 0;
  for (std::uint32_t p = 0; p < layout.rates(); ++p) deepest = std::max(deepest, layout.depth(p));
  for (std::vector<double>* part : {&row_q_, &row_v_, &column_q_, &column_v_}) part->resize(deepest);
}

bool TreeDerivatives::evaluate(const Kinematics& kinematics, const Vector3& gravity, const double* q, const double* v,
                               const double* a, RowMatrix& by_q, RowMatrix& by_v) {
  choose_origin(kinematics);
  bodies_[0] = {};
  bodies_[0].acceleration.linear = -Plain3(gravity);
  if (!outwards(kinematics, {q, v, a})) return false;
  by_q.setZero();
  by_v.setZero();
  inwards(by_q, by_v);
  return true;
}

/// The force that a displacement costs beyond, seen from what it carries along.
inline PlainWrench TreeDerivatives::left_behind(const Body& body, const Rate& rate) {
  return body.inertia(rate.acceleration_by_q.angular, rate.acceleration_by_q.linear) +
         body.coriolis(rate.velocity_by_q.angular);
}

inline PlainWrench TreeDerivatives::by_rate(const Body& body, const Rate& rate) {
  return body.inertia(rate.acceleration_by_v.angular, rate.acceleration_by_v.linear) +
         body.coriolis(rate.column.angular);
}

void TreeDerivatives::choose_origin(const Kinematics& kinematics) {
  origin_ = {};
  for (const TreeLayout::Step& step : layout_.steps()) origin_ += Plain3(kinematics.poses[step.child].position);
  if (!layout_.steps().empty()) origin_ = (1.0 / static_cast<double>(layout_.steps().size())) * origin_;
}

bool TreeDerivatives::outwards(const Kinematics& kinematics, const Given& given) {
  const Mechanism& mechanism = layout_.mechanism();
  for (std::size_t i = 0; i < layout_.steps().size(); ++i) {
    const TreeLayout::Step& step = layout_.steps()[i];
    const TreeStep& walked = mechanism.steps[i];
    const Joint& joint = mechanism.joints[walked.joint.index()];
    const Passage passage{step,
                          joint,
                          walked.reversed,
                          walked.reversed ? kinematics.near[i] : kinematics.far[i],
                          rates_.data() + step.first,
                          {given.q + joint.q, given.v + joint.v, given.a + joint.v}};
    for (std::uint32_t k = 0; k < step.rates; ++k) {
      const Column& column = kinematics.columns[joint.v + k];
      const Plain3 angular(column.angular);
      passage.rates[k].column = {angular, Plain3(column.linear) + angular.cross(origin_ - Plain3(column.point))};
    }
    PlainTwist velocity = bodies_[step.parent].velocity, acceleration = bodies_[step.parent].acceleration;
    if (joint.is_product()) {
      pass_product(passage, velocity, acceleration);
    } else if (!pass_callbacks(passage, velocity, acceleration, slopes_.data() + first_slope_[i])) {
      culprit_ = walked.joint;
      return false;
    }
    for (std::uint32_t k = 0; k < step.rates; ++k) spread(step.first + k);
    bodies_[step.child].velocity = velocity;
    bodies_[step.child].acceleration = acceleration;
    place_body(kinematics, step.child);
  }
  return true;
}

/// Each motion is a joint of its own, with a body without mass before the next. The frame that its columns are fixed in
/// moves with v and its field changes with a; a displacement along column s leaves behind v x s in velocities beyond,
/// and a x s + v x (v x s) in accelerations.
void TreeDerivatives::pass_product(const Passage& passage, PlainTwist& velocity, PlainTwist& acceleration) const {
  const std::vector<ElementaryMotion>& motions = passage.joint.motions();
  const std::size_t n = motions.size();
  for (std::size_t i = 0; i < n; ++i) {
    const ElementaryMotion& motion = motions[passage.reversed ? n - 1 - i : i];
    PlainTwist relative, relative_rate;
    for (std::uint32_t k = motion.v; k < motion.v + rate_count(motion); ++k) {
      relative += passage.given.v[k] * passage.rates[k].column;
      relative_rate += passage.given.a[k] * passage.rates[k].column;
    }
    const PlainTwist before = velocity, acceleration_before = acceleration;
    velocity += relative;
    acceleration += relative_rate + before.cross(relative);
    const bool fixed_behind = motion.kind == ElementaryMotionKind::free_rotation && passage.reversed;
    const PlainTwist& carrier = fixed_behind ? velocity : before;
    const PlainTwist& carrier_rate = fixed_behind ? acceleration : acceleration_before;
    for (std::uint32_t k = motion.v; k < motion.v + rate_count(motion); ++k) {
      Rate& rate = passage.rates[k];
      rate.velocity_by_q = carrier.cross(rate.column);
      rate.acceleration_by_q = carrier_rate.cross(rate.column) + carrier.cross(rate.velocity_by_q);
      rate.acceleration_by_v = (before + velocity).cross(rate.column);
    }
  }
}

PlainTwist TreeDerivatives::from_outlet(const Passage& passage, const Vector6& twist) const {
  const PlainMatrix3 axes(passage.outlet.rotation);
  const Plain3 angular = axes * Plain3(twist[0], twist[1], twist[2]);
  const Plain3 linear =
      axes * Plain3(twist[3], twist[4], twist[5]) + angular.cross(origin_ - Plain3(passage.outlet.position));
  return (passage.reversed ? -1.0 : 1.0) * PlainTwist{angular, linear};
}

/// The joint's twist is S v with S in outlet axes: a displacement along s carries it along where the outlet comes last,
/// and S changes besides.
bool TreeDerivatives::pass_callbacks(const Passage& passage, PlainTwist& velocity, PlainTwist& acceleration,
                                     PlainTwist* slopes) const {
  const Joint& joint = passage.joint;
  const auto& [q, v, a] = passage.given;
  PlainTwist relative, relative_rate;
  for (std::uint32_t k = 0; k < joint.nv; ++k) {
    relative += v[k] * passage.rates[k].column;
    relative_rate += a[k] * passage.rates[k].column;
  }
  Vector6 bias;
  Subspace bias_slope(6, joint.nv);
  if (!joint.subspace_rate(q, v, v, bias) || !joint.bias_by_q(q, v, bias_slope)) return false;
  const PlainTwist before = velocity, own_bias = from_outlet(passage, bias);
  velocity += relative;
  acceleration += relative_rate + before.cross(relative) + own_bias;
  for (std::uint32_t j = 0; j < joint.nv; ++j) {
    Rate& rate = passage.rates[j];
    std::array<double, max_joint_rates> unit{};
    unit[j] = 1.0;
    Vector6 with_v, with_a, of_column;
    if (!joint.subspace_rate(q, unit.data(), v, with_v) || !joint.subspace_rate(q, unit.data(), a, with_a) ||
        !joint.subspace_rate(q, v, unit.data(), of_column)) {
      return false;
    }
    const PlainTwist slope_v = from_outlet(passage, with_v);
    const PlainTwist carrier = passage.reversed ? PlainTwist{} : rate.column;
    const PlainTwist relative_by_q = carrier.cross(relative) + slope_v;
    const PlainTwist acceleration_by_q = carrier.cross(relative_rate) + from_outlet(passage, with_a) +
                                         before.cross(relative_by_q) + carrier.cross(own_bias) +
                                         from_outlet(passage, bias_slope.col(j));
    rate.velocity_by_q = relative_by_q + velocity.cross(rate.column);
    rate.acceleration_by_q = acceleration_by_q + acceleration.cross(rate.column) + velocity.cross(rate.velocity_by_q);
    rate.acceleration_by_v = (before + velocity).cross(rate.column) + slope_v + from_outlet(passage, of_column);
    for (std::uint32_t k = 0; k < joint.nv; ++k) {
      std::array<double, max_joint_rates> other{};
      other[k] = 1.0;
      Vector6 slope;
      if (!joint.subspace_rate(q, unit.data(), other.data(), slope)) return false;
      slopes[j * joint.nv + k] = from_outlet(passage, slope);
    }
  }
  return true;
}

void TreeDerivatives::place_body(const Kinematics& kinematics, Node node) {
  Body& body = bodies_[node];
  body.inertia = {};
  body.coriolis = {};
  body.force = {};
  if (!inertias_.has_mass[node]) return;
  const Pose& pose = kinematics.poses[node];
  const PlainMatrix3 axes(pose.rotation);
  body.inertia.add(CompositeInertia::of(inertias_.of_node[node], axes), Plain3(pose.position) - origin_);
  body.coriolis = CoriolisInertia::of(body.inertia, body.velocity);
  const PlainWrench momentum = body.inertia(body.velocity.angular, body.velocity.linear);
  body.force = body.inertia(body.acceleration.angular, body.acceleration.linear);
  body.force += body.velocity.cross(momentum);
}

void TreeDerivatives::spread(std::uint32_t p) {
  const Rate& rate = rates_[p];
  double* to = spread_.data() + p;
  for (const Plain3* part :
       {&rate.column.linear, &rate.column.angular, &rate.acceleration_by_v.angular, &rate.acceleration_by_v.linear,
        &rate.velocity_by_q.angular, &rate.acceleration_by_q.angular, &rate.acceleration_by_q.linear}) {
    for (const double x : {part->x, part->y, part->z}) *to = x, to += layout_.rates();
  }
}

void TreeDerivatives::inwards(RowMatrix& by_q, RowMatrix& by_v) {
  for (std::size_t i = layout_.steps().size(); i-- > 0;) {
    const TreeLayout::Step& step = layout_.steps()[i];
    const Body& body = bodies_[step.child];
    for (std::uint32_t p = step.first; p < step.first + step.rates; ++p) fill_ancestors(p, body, by_q, by_v);
    fill_own(i, body, by_q, by_v);
    if (step.parent == 0) continue;
    Body& parent = bodies_[step.parent];
    parent.inertia.mass += body.inertia.mass;
    parent.inertia.first_moment += body.inertia.first_moment;
    parent.inertia.tensor += body.inertia.tensor;
    parent.coriolis += body.coriolis;
    parent.force += body.force;
  }
}

/// What the rates before do in this one, and this one in them. Before: only forces at the joint change, with what the
/// rates leave behind in the motions beyond. After: all that is carried beyond changes its force besides.
void TreeDerivatives::fill_ancestors(std::uint32_t p, const Body& body, RowMatrix& by_q, RowMatrix& by_v) {
  const Rate& rate = rates_[p];
  const std::size_t n = layout_.rates();
  const PlainWrench r = body.inertia(rate.column.angular, rate.column.linear);
  const Plain3 c = body.coriolis.transposed(rate.column);
  const std::array row{c.x, c.y, c.z, r.moment.x, r.moment.y, r.moment.z, r.force.x, r.force.y, r.force.z};
  const PlainWrench u = left_behind(body, rate) + rate.column.cross(body.force), w = by_rate(body, rate);
  const std::array displaced{u.force.x, u.force.y, u.force.z, u.moment.x, u.moment.y, u.moment.z};
  const std::array faster{w.force.x, w.force.y, w.force.z, w.moment.x, w.moment.y, w.moment.z};
  const std::uint32_t own = layout_.rate(p);
  for (const TreeLayout::Run& run : layout_.ancestors(p)) {
    const double* const x = spread_.data() + run.first;
    combine(x + velocity_by_q_angular * n, n, row, run.count, row_q_.data());
    combine(x + column_angular * n, n, row, run.count, row_v_.data());
    combine(x + column_linear * n, n, displaced, run.count, column_q_.data());
    combine(x + column_linear * n, n, faster, run.count, column_v_.data());
    for (std::uint32_t k = 0; k < run.count; ++k) {
      const std::uint32_t before = layout_.rate(run.first + k);
      by_q(own, before) = row_q_[k];
      by_v(own, before) = row_v_[k];
      by_q(before, own) = column_q_[k];
      by_v(before, own) = column_v_[k];
    }
  }
}

/// The rates of one joint among each other, which all have the same bodies beyond.
void TreeDerivatives::fill_own(std::size_t i, const Body& body, RowMatrix& by_q, RowMatrix& by_v) const {
  const TreeLayout::Step& step = layout_.steps()[i];
  for (std::uint32_t j = 0; j < step.rates; ++j) {
    const Rate& rate = rates_[step.first + j];
    const PlainWrench left = left_behind(body, rate), all = left + rate.column.cross(body.force);
    const PlainWrench faster = by_rate(body, rate);
    for (std::uint32_t k = 0; k < step.rates; ++k) {
      const PlainTwist& column = rates_[step.first + k].column;
      const bool carried = (carriers_[step.first + k] >> j & 1u) != 0;
      double effort = column.power(carried ? left : all);
      if (!step.is_product) effort += slopes_[first_slope_[i] + j * step.rates + k].power(body.force);
      by_q(layout_.rate(step.first + k), layout_.rate(step.first + j)) = effort;
      by_v(layout_.rate(step.first + k), layout_.rate(step.first + j)) = column.power(faster);
    }
  }
}

}  // namespace koppel

#include "closure/freedoms.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "closure/decompositions.hpp"
#include "closure/load_paths.hpp"
#include "closure/loop_kind.hpp"
#include "closure/newton.hpp"
#include "closure/rank.hpp"
#include "spatial/vector.hpp"

namespace koppel {
namespace {

constexpr double nearby = 1e-3;           // [rad] or lengths of the mechanism
constexpr double stayed = 1e-2 * nearby;  // who comes back closer than this has not moved
constexpr int attempts = 3;
constexpr double negligible = 1e-8;    // half the digits: of a velocity, or a load, beside others
constexpr double alone = 1.0 - 1e-12;  // all others move less than a millionth of what the body does

/// Rates of the state from scaled rates of the columns.
Eigen::VectorXd rates_of(const Mechanism& mechanism, const Eigen::VectorXd& scaled) {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(mechanism.nv);
  for (Eigen::Index i = 0; i < scaled.size(); ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[static_cast<std::size_t>(i)];
    v[rate] = mechanism.rate_scale[rate] * scaled[i];
  }
  return v;
}

bool evaluate(Work& work, const Eigen::VectorXd& q, double time) {
  work.factorised = false;
  if (!work.equations.evaluate(q, time)) return false;
  work.equations.evaluate_jacobian();
  return true;
}

/// The joint that has this rate.
JointId joint_of_rate(const Mechanism& mechanism, std::uint32_t rate) {
  const auto after = std::upper_bound(mechanism.blocks.begin(), mechanism.blocks.end(), rate,
                                      [](std::uint32_t r, const StateBlock& block) { return r < block.v; });
  return std::prev(after)->joint;
}

/// Motions of all joints of a loop, in the world. A joint that is no product of elementary motions has none that last:
/// false.
bool loop_motions(const Work& work, const Eigen::VectorXd& q, std::size_t index, std::vector<Column>& motions) {
  const Mechanism& mechanism = *work.mechanism;
  const Relation& relation = mechanism.relations[index];
  motions.clear();
  for (const PathRate& path : relation.path) {
    if (!mechanism.joints[joint_of_rate(mechanism, path.rate).index()].is_product()) return false;
    motions.push_back(work.equations.kinematics.columns[path.rate]);
  }
  if (relation.kind != RelationKind::cut_joint) return true;
  const Joint& joint = mechanism.joints[relation.joint.index()];
  if (!joint.is_product()) return false;
  std::array<Column, max_joint_rates> columns;
  Pose frame = work.equations.frame_a(index);
  if (!joint.step(q.data() + joint.q, false, frame, columns.data())) return false;
  motions.insert(motions.end(), columns.begin(), columns.begin() + joint.nv);
  return true;
}

void find_kinds(const Work& work, const Eigen::VectorXd& q, Freedoms& freedoms) {
  const Mechanism& mechanism = *work.mechanism;
  freedoms.mobility_by_kind = mechanism.mobility_count;
  std::vector<Column> motions;
  for (std::size_t i = 0; i < mechanism.loops; ++i) {
    const bool lasting = loop_motions(work, q, i, motions);
    freedoms.loops.push_back(lasting ? loop_kind(motions, mechanism.length) : LoopFreedoms{});
    freedoms.mobility_by_kind += 6 - freedoms.loops.back().conditions;
  }
}

/// Ranks at some closed positions around this one.
void look_nearby(Work& work, const State& state, const NullSpaces& here, Freedoms& freedoms) {
  const Mechanism& mechanism = *work.mechanism;
  Eigen::Index greatest = here.rank;
  // What is rigid, or has no loops, is the same everywhere.
  const bool same = here.motions.cols() == 0 || mechanism.rows == 0;
  bool moved = same;
  for (int attempt = 0; attempt < attempts && !same; ++attempt) {
    // Some combination of all motions, the same in every run.
    const Eigen::VectorXd weights = Eigen::VectorXd::NullaryExpr(here.motions.cols(), [attempt](Eigen::Index i) {
      return std::cos(1.0 + static_cast<double>(attempt) + 2.7 * static_cast<double>(i));
    });
    const Eigen::VectorXd way = here.motions * weights;
    work.delta = rates_of(mechanism, nearby / way.lpNorm<Eigen::Infinity>() * way);
    integrate(mechanism, state.q, work.delta, work.q);
    NewtonOptions options;
    options.inputs = InputsAre::free;
    const NewtonResult result = newton(work, state.time, options);
    // A plugin need not answer beside the position where it does.
    if (result.plugin_failed || !result.converged) continue;
    difference(mechanism, state.q, work.q, work.delta);
    double most = 0.0;
    for (const std::uint32_t rate : mechanism.rate_of_column) {
      most = std::max(most, std::abs(work.delta[rate]) / mechanism.rate_scale[rate]);
    }
    if (most < stayed) continue;
    moved = true;
    work.equations.evaluate_jacobian();
    greatest = std::max(greatest, rank_of(work.equations.jacobian).rank);
  }
  const auto columns = static_cast<std::int32_t>(mechanism.columns);
  freedoms.mobility_here = columns - static_cast<std::int32_t>(here.rank);
  freedoms.mobility_nearby = columns - static_cast<std::int32_t>(greatest);
  freedoms.redundant_here = mechanism.rows - static_cast<std::uint32_t>(here.rank);
  freedoms.redundant_nearby = mechanism.rows - static_cast<std::uint32_t>(greatest);
  freedoms.shaky = !moved;
}

/// Between how many other bodies each body is held, by joints and constraints.
std::vector<std::size_t> neighbours(const Mechanism& mechanism) {
  std::vector<std::set<std::size_t>> others(mechanism.bodies.size());
  const auto join = [&others](std::size_t a, std::size_t b) {
    if (std::max(a, b) >= others.size()) return;
    others[a].insert(b);
    others[b].insert(a);
  };
  for (const Joint& joint : mechanism.joints) join(joint.inlet.body.index(), joint.outlet.body.index());
  for (const Relation& relation : mechanism.relations) {
    if (relation.kind == RelationKind::constraint && relation.has_frames) join(relation.node_a, relation.node_b);
  }
  std::vector<std::size_t> count(others.size());
  std::transform(others.begin(), others.end(), count.begin(), [](const auto& bodies) { return bodies.size(); });
  return count;
}

Twist twist_of(const Kinematics& kinematics, Node node) {
  const FrameMotion& motion = kinematics.motions[node];
  return shifted(Twist{motion.angular_velocity, motion.velocity}, Vector3(-motion.at));
}

/// The axis of a twist in which what is rounding beside the greatest velocity [m/s] of all is nothing.
ScrewAxis axis_of(Twist twist, double length, double greatest) {
  const double least = negligible * greatest;
  if (twist.angular.norm() * length <= least) twist.angular.setZero();
  if (twist.linear.norm() <= least) twist.linear.setZero();
  if (const auto axis = normalised<double>(twist.angular)) {
    const double along = axis->dot(twist.linear);
    if (std::abs(along) <= least) twist.linear -= along * *axis;
  }
  return screw_axis(twist, length);
}

double greatest_velocity(const Mechanism& mechanism, const Kinematics& kinematics) {
  double greatest = 0.0;
  for (Node body = 0; body < mechanism.bodies.size(); ++body) {
    const Twist twist = twist_of(kinematics, body);
    greatest = std::max({greatest, twist.angular.norm() * mechanism.length, twist.linear.norm()});
  }
  return greatest;
}

void find_axes(const Work& work, Freedoms& freedoms) {
  const Mechanism& mechanism = *work.mechanism;
  const Kinematics& kinematics = work.equations.kinematics;
  const double greatest = greatest_velocity(mechanism, kinematics);
  for (Node body = 0; body < mechanism.bodies.size(); ++body) {
    freedoms.axes.push_back(axis_of(twist_of(kinematics, body), mechanism.length, greatest));
  }
}

/// Bodies that move in some combination of the motions while no other does.
bool find_isolated(Work& work, const State& state, const NullSpaces& here, Freedoms& freedoms) {
  const Mechanism& mechanism = *work.mechanism;
  const Eigen::Index count = here.motions.cols();
  const auto bodies = static_cast<Eigen::Index>(mechanism.bodies.size());
  if (count == 0 || mechanism.rows == 0) return true;
  // Twists of all bodies, angular above linear over the length, for each motion.
  Eigen::MatrixXd twists(6 * bodies, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    work.delta = rates_of(mechanism, here.motions.col(k));
    if (!work.equations.motion(state.q, work.delta, work.rest)) return false;
    for (Eigen::Index body = 0; body < bodies; ++body) {
      const FrameMotion& motion = work.equations.kinematics.motions[static_cast<std::size_t>(body)];
      twists.col(k).segment<6>(6 * body) << motion.angular_velocity, motion.velocity / mechanism.length;
    }
  }
  // In combinations of the motions in which all bodies together have the velocity one, a body that has it alone is
  // isolated.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(twists);
  const auto r = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  const std::vector<std::size_t> held = neighbours(mechanism);
  for (Eigen::Index body = 1; body < bodies; ++body) {
    if (held[static_cast<std::size_t>(body)] < 2) continue;
    const Eigen::MatrixXd own = r.transpose().solve(twists.middleRows<6>(6 * body).transpose()).transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(own, Eigen::ComputeThinV);
    for (Eigen::Index k = 0; k < svd.singularValues().size() && svd.singularValues()[k] > alone; ++k) {
      work.delta = rates_of(mechanism, here.motions * r.solve(svd.matrixV().col(k)));
      if (!work.equations.motion(state.q, work.delta, work.rest)) return false;
      const Twist twist = twist_of(work.equations.kinematics, static_cast<Node>(body));
      const double greatest = greatest_velocity(mechanism, work.equations.kinematics);
      freedoms.isolated.push_back({{static_cast<std::uint32_t>(body)}, axis_of(twist, mechanism.length, greatest)});
    }
  }
  return true;
}

std::vector<Pose> inlets(const Work& work) {
  const Mechanism& mechanism = *work.mechanism;
  std::vector<Pose> poses(mechanism.joints.size());
  for (std::size_t i = 0; i < mechanism.steps.size(); ++i) {
    const TreeStep& step = mechanism.steps[i];
    const Kinematics& kinematics = work.equations.kinematics;
    poses[step.joint.index()] = step.reversed ? kinematics.far[i] : kinematics.near[i];
  }
  for (std::size_t i = 0; i < mechanism.loops; ++i) {
    if (mechanism.relations[i].kind == RelationKind::cut_joint) {
      poses[mechanism.relations[i].joint.index()] = work.equations.frame_a(i);
    }
  }
  return poses;
}

void find_indeterminate(const Work& work, const NullSpaces& here, Freedoms& freedoms) {
  const Mechanism& mechanism = *work.mechanism;
  const LoadPaths paths(mechanism);
  const std::vector<Pose> frames = inlets(work);
  std::vector<Pose> outlets(mechanism.joints.size());
  paths.outlets(work.equations, outlets);
  std::vector<IndeterminateReaction> reactions(mechanism.joints.size());
  std::vector<Wrench> wrenches(mechanism.joints.size());
  for (Eigen::Index k = 0; k < here.stresses.cols(); ++k) {
    // Multipliers of length one make moments of that size, and forces over the length.
    std::fill(wrenches.begin(), wrenches.end(), Wrench{});
    paths.add(work.equations, here.stresses.col(k), outlets, wrenches);
    for (std::size_t j = 0; j < wrenches.size(); ++j) {
      if (wrenches[j].moment.isZero(0.0) && wrenches[j].force.isZero(0.0)) continue;
      const Pose in_inlet = relative_pose(frames[j], Pose{Matrix3::Identity(), outlets[j].position});
      const Wrench wrench = transformed(in_inlet, wrenches[j]);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        reactions[j].moment[a] |= std::abs(wrench.moment[axis]) > negligible;
        reactions[j].force[a] |= std::abs(wrench.force[axis]) * mechanism.length > negligible;
      }
    }
  }
  for (std::size_t j = 0; j < reactions.size(); ++j) {
    const auto any = [](const std::array<bool, 3>& axes) { return axes[0] || axes[1] || axes[2]; };
    reactions[j].joint = {static_cast<std::uint32_t>(j)};
    if (any(reactions[j].moment) || any(reactions[j].force)) freedoms.indeterminate.push_back(reactions[j]);
  }
}

}  // namespace

bool find_freedoms(Work& work, const State& state, Freedoms& freedoms) {
  freedoms = Freedoms{};
  if (!evaluate(work, state.q, state.time)) return false;
  const NullSpaces here = null_spaces_of(work.equations.jacobian);
  find_kinds(work, state.q, freedoms);
  find_indeterminate(work, here, freedoms);
  if (!find_isolated(work, state, here, freedoms)) return false;
  if (state.stage >= Stage::velocities) {
    if (!work.equations.motion(state.q, state.v, work.rest)) return false;
    find_axes(work, freedoms);
  }
  look_nearby(work, state, here, freedoms);
  return true;
}

}  // namespace koppel

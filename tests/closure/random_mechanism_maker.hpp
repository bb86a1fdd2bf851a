// Mechanisms at random - which bodies are joined, by what joints, with what measures - built so that one closed
// position is known: all joints get a position, the bodies follow from it along a tree, and the outlet of every joint
// that closes a loop is put where its position asks for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "closure/decompositions.hpp"
#include "random_mechanism.hpp"

namespace koppel::test {

/// Draws mechanisms; equal seeds, equal mechanisms.
class MechanismMaker {
 public:
  explicit MechanismMaker(unsigned seed) : random_(seed) {}

  RandomMechanism make() {
    choose_special();
    choose_bodies_and_loops();
    for (std::size_t i = 0; i < result_.joints.size(); ++i) choose_joint(i);
    give_enough_freedoms();
    for (RandomJoint& joint : result_.joints) place(joint);
    choose_position();
    if (result_.special == Special::too_long) stretch();
    return std::move(result_);
  }

 private:
  std::size_t one_of(std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(random_.between(0, static_cast<double>(count))));
  }
  bool happens(double probability) { return random_.between(0, 1) < probability; }
  double decade(double low, double high) { return std::pow(10.0, random_.between(low, high)); }

  void choose_special() {
    if (happens(0.6)) result_.special = static_cast<Special>(1 + one_of(special_names.size() - 1));
    offset_ = result_.special == Special::far_off ? Vector3(decade(2, 5) * random_.direction()) : Vector3::Zero();
    world_ = random_.rotation();
  }

  void choose_bodies_and_loops() {
    const std::size_t loops = 1 + one_of(6);
    result_.bodies = std::min<std::size_t>(14, loops + 1 + one_of(2 * loops + 3));
    std::vector<int> joints_at(result_.bodies + 1, 0);
    const auto join = [&](std::size_t a, std::size_t b) {
      if (happens(0.5)) std::swap(a, b);
      result_.joints.push_back({a, b, {"", "", 1}, {}, {}});
      ++joints_at[a], ++joints_at[b];
    };
    for (std::size_t i = 1; i <= result_.bodies; ++i) join(happens(0.6) ? i - 1 : one_of(i), i);
    for (std::size_t i = 0; i < loops; ++i) {
      std::size_t a = 0, b = 0;
      // Ends of the tree first, and mostly to the ground or far away.
      for (int attempt = 0; attempt < 20; ++attempt) {
        a = 1 + one_of(result_.bodies), b = happens(0.4) ? 0 : one_of(result_.bodies + 1);
        if (a != b && (joints_at[a] == 1 || attempt > 10) && !(joined(a, b) && attempt < 18)) break;
      }
      if (a == b) b = 0;
      join(a, b);
    }
    size_.assign(result_.bodies + 1, 0.5);
    if (result_.special == Special::many_scales) {
      for (double& size : size_) size = decade(-3, 3);
    }
    first_frame_.assign(result_.bodies + 1, std::nullopt);
  }

  bool joined(std::size_t a, std::size_t b) const {
    for (const RandomJoint& joint : result_.joints) {
      if ((joint.inlet == a && joint.outlet == b) || (joint.inlet == b && joint.outlet == a)) return true;
    }
    return false;
  }

  void choose_joint(std::size_t i) {
    const std::vector<JointKind> choice = choice_of_joints(result_.special);
    RandomJoint& joint = result_.joints[i];
    // Free and welded bodies are rare.
    JointKind kind = choice[one_of(choice.size())];
    while ((kind.freedoms == 0 || kind.freedoms == 6) && happens(0.8)) kind = choice[one_of(choice.size())];
    if (const std::size_t at = kind.parameters.find('?'); at != std::string::npos) {
      std::ostringstream pitch;
      pitch << std::setprecision(17) << random_.between(-0.2, 0.2) * size_[joint.inlet];
      kind.parameters.replace(at, 1, pitch.str());
    }
    joint.kind = std::move(kind);
  }

  /// Most mechanisms move; some are rigid, or more than that.
  void give_enough_freedoms() {
    if (happens(0.1)) return;
    const bool three = result_.special == Special::planar || result_.special == Special::spherical;
    const int wanted = static_cast<int>(result_.loops()) * (three ? 3 : 6) + static_cast<int>(one_of(3));
    int freedoms = 0;
    for (const RandomJoint& joint : result_.joints) freedoms += joint.kind.freedoms;
    for (int attempt = 0; attempt < 400 && freedoms < wanted; ++attempt) {
      const std::size_t i = one_of(result_.joints.size());
      const RandomJoint before = result_.joints[i];
      choose_joint(i);
      if (result_.joints[i].kind.freedoms < before.kind.freedoms) result_.joints[i] = before;
      freedoms += result_.joints[i].kind.freedoms - before.kind.freedoms;
    }
  }

  void place(RandomJoint& joint) {
    const bool slides = joint.kind.type == "prismatic";
    joint.at_inlet = frame_on(joint.inlet, slides);
    joint.at_outlet = frame_on(joint.outlet, slides);
  }

  Pose frame_on(std::size_t body, bool slides) {
    Pose frame = special_frame(body, slides);
    if (!first_frame_[body]) first_frame_[body] = frame;
    if (body == 0) frame = {world_ * frame.rotation, world_ * (offset_ + frame.position)};
    return frame;
  }

  Pose special_frame(std::size_t body, bool slides) {
    const double size = size_[body];
    Pose frame{rotation_of_quaternion<double>(random_.quaternion()), size * random_.vector()};
    const std::optional<Pose>& first = first_frame_[body];
    if (result_.special == Special::planar) {
      frame.rotation = rotation_about<double>(Vector3::UnitZ(), random_.between(-3, 3));
      if (slides) frame.rotation = frame.rotation * rotation_about<double>(Vector3::UnitY(), std::numbers::pi / 2);
    }
    if (result_.special == Special::spherical) frame.position.setZero();
    if (!first || happens(0.4)) return frame;
    if (result_.special == Special::nearly_parallel) {
      frame.rotation = first->rotation * rotation_about<double>(random_.direction(), decade(-9, -2));
    } else if (result_.special == Special::coaxial) {
      frame.rotation = first->rotation * rotation_about<double>(Vector3::UnitZ(), random_.between(-3, 3));
      frame.position = first->position + size * random_.between(-1, 1) * first->rotation.col(2);
    } else if (result_.special == Special::zero_length) {
      frame.position = first->position;
    }
    return frame;
  }

  /// A position of all joints; the outlets of those that close loops are put where it asks for them.
  void choose_position() {
    const Built open(result_.text(), types_of_random_mechanisms());
    result_.known = State(*open).q;
    Eigen::VectorXd delta(open->nv);
    for (const StateBlock& block : open->blocks) {
      const double size = size_[result_.joints[block.joint.index()].outlet];
      const double most = block.kind == BlockKind::line ? size : block.kind == BlockKind::unit_vector ? 1.0 : 3.0;
      for (std::size_t i = 0; i < rate_count(block.kind); ++i)
        delta[static_cast<Eigen::Index>(block.v + i)] = random_.between(-most, most);
    }
    integrate(*open, result_.known, delta, result_.known);
    std::vector<Pose> poses(result_.bodies + 1);
    for (std::size_t i = 0; i < result_.joints.size(); ++i) {
      const Joint& joint = open->joints[i];
      RandomJoint& drawn = result_.joints[i];
      Pose moved;
      EXPECT_TRUE(joint.pose(result_.known.data() + joint.q, moved));
      const Pose across = joint.inlet.pose * moved;
      if (i >= result_.bodies) {
        drawn.at_outlet = relative_pose(poses[drawn.outlet], poses[drawn.inlet] * across);
      } else if (drawn.outlet == i + 1) {
        poses[i + 1] = poses[drawn.inlet] * across * joint.outlet.pose.inverse();
      } else {
        poses[i + 1] = poses[drawn.outlet] * joint.outlet.pose * across.inverse();
      }
    }
    choose_drives();
  }

  /// Holds coordinates, one after another, as long as what remains can still close by itself to first order.
  void choose_drives() {
    const Built built(result_.text(), types_of_random_mechanisms());
    Equations equations(*built);
    EXPECT_TRUE(equations.evaluate(result_.known, 0.0));
    equations.evaluate_jacobian();
    Eigen::MatrixXd jacobian = equations.jacobian;
    const Eigen::Index rank = rank_of(jacobian);
    Eigen::Index free = jacobian.cols() - rank;
    const bool all = result_.special == Special::overdriven || happens(0.7);
    const Eigen::Index left = all ? 0 : static_cast<Eigen::Index>(one_of(static_cast<std::size_t>(free) + 1));
    std::vector<const StateBlock*> others;
    for (const StateBlock* block : shuffled_scalars(*built)) {
      const Eigen::VectorXd column = jacobian.col(built->column_of_rate[block->v]);
      jacobian.col(built->column_of_rate[block->v]).setZero();
      if (free > left && rank_of(jacobian) == rank) {
        hold(*built, *block);
        --free;
      } else {
        jacobian.col(built->column_of_rate[block->v]) = column;
        others.push_back(block);
      }
    }
    if (result_.special == Special::overdriven && !others.empty()) hold(*built, *others.front());
    result_.all_driven = free == 0;
  }

  void hold(const Mechanism& mechanism, const StateBlock& block) {
    result_.drives.emplace_back(mechanism.coordinate_names[block.q].name, result_.known[block.q]);
  }

  /// Scalar coordinates of joints at which no loop is cut.
  std::vector<const StateBlock*> shuffled_scalars(const Mechanism& mechanism) {
    std::vector<const StateBlock*> result;
    for (const StateBlock& block : mechanism.blocks) {
      if (is_scalar(block.kind) && mechanism.column_of_rate[block.v] >= 0) result.push_back(&block);
    }
    for (std::size_t i = result.size(); i > 1; --i) std::swap(result[i - 1], result[one_of(i)]);
    return result;
  }

  static Eigen::Index rank_of(const Eigen::MatrixXd& jacobian) {
    if (jacobian.size() == 0) return 0;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
    qr.setThreshold(1e-9);
    return qr.rank();
  }

  /// One link of a loop becomes longer than all its others together.
  void stretch() {
    RandomJoint& closing = result_.joints[result_.bodies + one_of(result_.loops())];
    std::vector<std::vector<Vector3>> ends(result_.bodies + 1);
    for (const RandomJoint* joint : loop_of(closing)) {
      ends[joint->inlet].push_back(joint->at_inlet.position);
      ends[joint->outlet].push_back(joint->at_outlet.position);
    }
    std::vector<Vector3>& own = ends[closing.outlet];
    const Vector3 other_end = own[0] == closing.at_outlet.position ? own[1] : own[0];
    double others = 0.0;
    for (const std::vector<Vector3>& link : ends) {
      if (!link.empty() && &link != &own) others += (link[1] - link[0]).norm();
    }
    const double longer = (1.0 + decade(-4, 0.5)) * others;
    closing.at_outlet.position = other_end + longer * (closing.at_outlet.position - other_end).normalized();
  }

  /// The joints of the loop that one closes with the tree: those on one way to the ground, but not on both.
  std::vector<const RandomJoint*> loop_of(const RandomJoint& closing) const {
    std::vector<bool> inside(result_.bodies, false);
    for (std::size_t body : {closing.inlet, closing.outlet}) {
      while (body != 0) {
        inside[body - 1] = !inside[body - 1];
        const RandomJoint& joint = result_.joints[body - 1];
        body = joint.outlet == body ? joint.inlet : joint.outlet;
      }
    }
    std::vector<const RandomJoint*> loop{&closing};
    for (std::size_t i = 0; i < inside.size(); ++i) {
      if (inside[i]) loop.push_back(&result_.joints[i]);
    }
    return loop;
  }

  Random random_;
  RandomMechanism result_;
  Matrix3 world_;
  Vector3 offset_;
  std::vector<double> size_;                      ///< of bodies
  std::vector<std::optional<Pose>> first_frame_;  ///< of bodies: where their first joint sits
};

}  // namespace koppel::test

// A loop cut open at two joints, or at one, and the conditions that are left between its halves (K-II-3.2.3, K-II-3.3).
// Evaluated for real coordinates, and for complex ones where all solutions are sought.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "closure/closure_condition.hpp"
#include "closure/cut_joint.hpp"
#include "closure/loop.hpp"
#include "spatial/quaternion.hpp"

namespace koppel {

/// Where a variable stands: cosine and sine of a turn, the displacement of a slide, the quaternion of a ball.
template <typename T>
using Place = std::array<T, 4>;

/// The places of all variables at the coordinates q of a state.
std::vector<Place<double>> places(std::span<const Variable> variables, const double* q);
Place<double> place(const Variable& variable, const double* q);

/// A loop, the joints at which it is cut, and the conditions between them.
struct LoopCut {
  std::uint32_t loop = 0;
  CutJoint a;
  std::optional<CutJoint> b;  ///< nothing: cut at one joint; the conditions are between its two frames
  std::vector<ClosureCondition> conditions;

  bool hides(std::size_t motion, std::size_t motions) const {
    const auto in = [&](const CutJoint& joint) { return (motion + motions - joint.first) % motions < joint.count; };
    return in(a) || (b && in(*b));
  }
};

/// frame = frame * (what the motion does).
template <typename T>
void apply(VariableKind kind, const Place<T>& at, bool inverse, PoseT<T>& frame) {
  switch (kind) {
    case VariableKind::turn: {
      const Vector3T<T> x = frame.rotation.col(0), y = frame.rotation.col(1);
      const T s = inverse ? T(-at[1]) : at[1];
      frame.rotation.col(0) = at[0] * x + s * y;
      frame.rotation.col(1) = at[0] * y - s * x;
      break;
    }
    case VariableKind::slide: frame.position += (inverse ? T(-at[0]) : at[0]) * frame.rotation.col(2); break;
    case VariableKind::ball: {
      const T sign = inverse ? T(-1) : T(1);
      const Vector4T<T> q{at[0], sign * at[1], sign * at[2], sign * at[3]};
      frame.rotation = (frame.rotation * rotation_of_quaternion<T>(q)).eval();
      break;
    }
  }
}

/// A constant pose in the number type of a walk.
template <typename T>
PoseT<T> as(const Pose& pose) {
  return {pose.rotation.template cast<T>(), pose.position.template cast<T>()};
}

/// One variable's screw on a walk, in the axes of its start: the origin r of the walk's end moves with the velocity
/// along + angular x (r - point) for one of the variable's rate.
template <typename T>
struct WalkColumn {
  std::uint32_t variable = 0;
  std::uint8_t rate = 0;  ///< of a ball: about its x, y, z
  Vector3T<T> angular, along, point;
};

/// The pose of frame a in frame b by either of the two ways from b to a. Columns are appended if wanted.
template <typename T>
class CutWalk {
 public:
  CutWalk(const Loop& loop, std::span<const Variable> variables, std::span<const Place<T>> at)
      : loop_(loop), variables_(variables), at_(at) {}

  /// Forwards from behind b to before a; at a single joint all the way round.
  PoseT<T> lower(const LoopCut& cut, std::vector<WalkColumn<T>>* columns = nullptr) const {
    const CutJoint& start = cut.b ? *cut.b : cut.a;
    const std::size_t n = loop_.motions.size(), first = start.first + start.count;
    const std::size_t count = (cut.a.first + 2 * n - first) % n;
    PoseT<T> frame = as<T>(start.after.inverse());
    for (std::size_t i = 0; i < count; ++i) {
      const LoopMotion& motion = loop_.motions[(first + i) % n];
      frame = frame * as<T>(motion.to);
      pass(motion, false, frame, columns);
    }
    return frame * as<T>(cut.a.before);
  }

  /// Backwards from before b to behind a; at a single joint there is nothing on the way, and the frames coincide.
  PoseT<T> upper(const LoopCut& cut, std::vector<WalkColumn<T>>* columns = nullptr) const {
    if (!cut.b) return {};
    const std::size_t n = loop_.motions.size(), first = cut.a.first + cut.a.count;
    const std::size_t count = (cut.b->first + 2 * n - first) % n;
    PoseT<T> frame = as<T>(cut.b->before.inverse());
    for (std::size_t i = count; i-- > 0;) {
      const LoopMotion& motion = loop_.motions[(first + i) % n];
      pass(motion, true, frame, columns);
      frame = frame * as<T>(motion.to.inverse());
    }
    return frame * as<T>(cut.a.after);
  }

  /// Once round, from before the first motion to behind the last.
  PoseT<T> round(std::vector<WalkColumn<T>>* columns = nullptr) const {
    PoseT<T> frame;
    for (const LoopMotion& motion : loop_.motions) {
      frame = frame * as<T>(motion.to);
      pass(motion, false, frame, columns);
    }
    return frame;
  }

 private:
  void pass(const LoopMotion& motion, bool backwards, PoseT<T>& frame, std::vector<WalkColumn<T>>* columns) const {
    const VariableKind kind = variables_[motion.variable].kind;
    const bool inverse = (kind == VariableKind::ball && motion.inverse) != backwards;
    const Matrix3T<T> before = frame.rotation;
    apply(kind, at_[motion.variable], inverse, frame);
    if (columns == nullptr) return;
    const T sign = inverse ? T(-1) : T(1);
    if (kind == VariableKind::ball) {
      // Rates of a ball are about axes of its far side.
      const Matrix3T<T>& axes = inverse ? before : frame.rotation;
      for (std::uint8_t k = 0; k < 3; ++k) {
        columns->push_back({motion.variable, k, sign * axes.col(k), Vector3T<T>::Zero(), frame.position});
      }
    } else {
      const Vector3T<T> axis = sign * frame.rotation.col(2);
      const bool turn = kind == VariableKind::turn;
      columns->push_back(
          {motion.variable, 0, turn ? axis : Vector3T<T>::Zero(), turn ? Vector3T<T>::Zero() : axis, frame.position});
    }
  }

  const Loop& loop_;
  std::span<const Variable> variables_;
  std::span<const Place<T>> at_;
};

}  // namespace koppel

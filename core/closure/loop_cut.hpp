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

/// The place of a turn or slide with the coordinate x.
Place<double> place_at(VariableKind kind, double x);
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

/// One variable's screw on a way, in the axes of its start: for one of the variable's rate the origin r of the way's
/// end moves with the velocity along + angular x (r - point).
template <typename T>
struct WayColumn {
  std::uint32_t variable = 0;
  std::uint8_t rate = 0;  ///< of a ball: about its x, y, z
  Vector3T<T> angular, along, point;

  Vector3T<T> velocity(const Vector3T<T>& r) const { return along + cross<T>(angular, r - point); }
};

/// A motion on a way, and the constant transformation before it.
struct Leg {
  std::uint32_t variable = 0;
  VariableKind kind = VariableKind::turn;
  bool inverse = false;  ///< the way passes the motion backwards
  Pose to;
};

/// A way through a loop, from one frame to another.
struct Way {
  std::vector<Leg> legs;
  Pose last;  ///< behind the last leg
};

/// The two ways from frame b of a cut to its frame a: forwards from behind b to before a, at a single joint all the way
/// round; and backwards from before b to behind a, at a single joint nothing, as the frames coincide.
Way lower_way(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut);
Way upper_way(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut);
/// Once round, from before the first motion to behind the last.
Way round_way(const Loop& loop, std::span<const Variable> variables);

/// frame = frame * (what the leg's motion does, without the transformation before it). Columns are appended if wanted.
template <typename T>
void pass(const Leg& leg, const Place<T>& at, PoseT<T>& frame, std::vector<WayColumn<T>>* columns) {
  const Matrix3T<T> before = frame.rotation;
  apply(leg.kind, at, leg.inverse, frame);
  if (columns == nullptr) return;
  const T sign = leg.inverse ? T(-1) : T(1);
  if (leg.kind == VariableKind::ball) {
    // Rates of a ball are about axes of its far side.
    const Matrix3T<T>& axes = leg.inverse ? before : frame.rotation;
    for (std::uint8_t k = 0; k < 3; ++k) {
      columns->push_back({leg.variable, k, sign * axes.col(k), Vector3T<T>::Zero(), frame.position});
    }
  } else {
    const Vector3T<T> axis = sign * frame.rotation.col(2), none = Vector3T<T>::Zero();
    const bool turn = leg.kind == VariableKind::turn;
    columns->push_back({leg.variable, 0, turn ? axis : none, turn ? none : axis, frame.position});
  }
}

/// The end of a way in its start.
template <typename T>
PoseT<T> walk(const Way& way, std::span<const Place<T>> at, std::vector<WayColumn<T>>* columns = nullptr) {
  PoseT<T> frame;
  for (const Leg& leg : way.legs) {
    frame = frame * as<T>(leg.to);
    pass(leg, at[leg.variable], frame, columns);
  }
  return frame * as<T>(way.last);
}

/// By how much a condition is open: its value on the lower way less that on the upper one, over its size. Zero where
/// the loop is closed.
double openness(const ClosureCondition& condition, const Way& lower, const Way& upper,
                std::span<const Place<double>> at, double length);

}  // namespace koppel

// A way through a loop whose motions have rates and accelerations: how the frame at its end moves against its start
// (K-II-2.1). Nothing is allocated.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "closure/loop_cut.hpp"

namespace koppel {

/// Where a variable stands and how it moves.
struct MovingPlace {
  Place<double> at{};              ///< as Place
  Vector3 rate = Vector3::Zero();  ///< of turns and slides the first component
  Vector3 acceleration = Vector3::Zero();
};

/// A pose and its motion, in the axes of the walk's start; velocity and acceleration are of the origin.
struct MovingPose {
  Pose pose;
  Vector3 angular_velocity = Vector3::Zero(), velocity = Vector3::Zero();
  Vector3 angular_acceleration = Vector3::Zero(), acceleration = Vector3::Zero();
};

/// A transformation that stands still.
struct Standstill {
  Pose pose;
  bool turns = false, moves = false;

  void carry(Pose& at) const {
    if (moves) at.position += at.rotation * pose.position;
    if (turns) at.rotation = (at.rotation * pose.rotation).eval();
  }
};

/// A way made ready for being walked again and again: slides lie along any axis, so that no constant only turns there
/// and back.
class MovingWay {
 public:
  MovingWay() = default;
  explicit MovingWay(const Way& way);

  std::size_t size() const { return legs_.size(); }

  /// The end in the start. visit(column) is called with each variable's screws.
  template <typename Visit>
  Pose walk(std::span<const MovingPlace> places, const Visit& visit) const {
    Pose at;
    for (const MovingLeg& leg : legs_) {
      const Place<double>& place = places[leg.variable].at;
      const double sign = leg.inverse ? -1.0 : 1.0;
      switch (leg.kind) {
        case VariableKind::slide: {
          const Vector3 axis = at.rotation * leg.axis;
          leg.to.carry(at);
          at.position += place[0] * axis;
          visit(WayColumn<double>{leg.variable, 0, Vector3::Zero(), axis, at.position});
          break;
        }
        case VariableKind::turn:
          leg.to.carry(at);
          apply(leg.kind, place, leg.inverse, at);
          visit(WayColumn<double>{leg.variable, 0, sign * at.rotation.col(2), Vector3::Zero(), at.position});
          break;
        case VariableKind::ball: {
          leg.to.carry(at);
          const Matrix3 before = at.rotation;
          apply(leg.kind, place, leg.inverse, at);
          // Rates of a ball are about axes of its far side.
          const Matrix3& axes = leg.inverse ? before : at.rotation;
          for (std::uint8_t k = 0; k < 3; ++k) {
            visit(WayColumn<double>{leg.variable, k, sign * axes.col(k), Vector3::Zero(), at.position});
          }
          break;
        }
      }
    }
    last_.carry(at);
    return at;
  }

  /// And how it moves.
  MovingPose end(std::span<const MovingPlace> places) const;

 private:
  struct MovingLeg {
    std::uint32_t variable = 0;
    VariableKind kind = VariableKind::turn;
    bool inverse = false;
    Standstill to;                   ///< of a slide it does not turn
    Vector3 axis = Vector3::Zero();  ///< of a slide, as the way passes it
  };
  std::vector<MovingLeg> legs_;
  Standstill last_;
};

/// The end of a way, and how it changes with the rate of one scalar variable (zero if the way does not pass it).
struct WaySlope {
  Pose pose;
  Vector3 angular = Vector3::Zero(), linear = Vector3::Zero();
};
WaySlope slope(const MovingWay& way, std::span<const MovingPlace> places, std::uint32_t variable);

}  // namespace koppel

// The description of a mechanism as checked data. A Scene can only come from read_scene(): every name in it is
// resolved, every number finite and in range, every parameter as its plugin's schema asks.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/id.hpp"
#include "plugin/registry.hpp"
#include "plugin/type.hpp"
#include "spatial/pose.hpp"

namespace koppel {

/// A frame fixed on a body: its pose in the body frame.
struct Attachment {
  BodyId body;
  Pose pose;
};

struct BodyDescription {
  std::string name;
  const BodyType* type = nullptr;  ///< null for the ground
  std::vector<Value> values;
  Pose design;  ///< pose of the body frame in the world at the design position
  Source source;
};

struct FrameDescription {
  std::string name;
  Attachment on;
  Source source;
};

/// What a scene says of one coordinate block; `start` has as many numbers as the block, `start_rate` as it has rates.
struct CoordinateDescription {
  double zero = 0.0;                              ///< value at which inlet and outlet coincide (scalars only)
  std::optional<std::vector<double>> start;       ///< where the first closure starts
  std::optional<std::array<double, 2>> limits;    ///< scalars only
  std::optional<std::vector<double>> start_rate;  ///< with which a simulation starts
  bool fixed = false;                             ///< start and start_rate, where given, hold; scalars only
};

struct JointDescription {
  std::string name;
  const JointType* type = nullptr;
  std::vector<Value> values;
  Attachment inlet, outlet;
  std::vector<CoordinateDescription> coordinates;  ///< one for each block of the type
  Source source;
};

/// A scalar coordinate of a joint.
struct CoordinateReference {
  JointId joint;
  std::uint32_t block = 0;

  friend constexpr bool operator==(CoordinateReference, CoordinateReference) = default;
};

struct ConstraintDescription {
  std::string name;
  const ConstraintType* type = nullptr;
  std::vector<Value> values;
  std::vector<Attachment> frames;  ///< none or two
  std::vector<CoordinateReference> coordinates;
  Source source;
};

struct ForceDescription {
  std::string name;
  const ForceType* type = nullptr;
  std::vector<Value> values;
  std::vector<Attachment> frames;  ///< none, one or two
  std::vector<CoordinateReference> coordinates;
  Source source;
};

struct DriveDescription {
  std::string name;  ///< "joint.coordinate" unless the scene names it
  CoordinateReference of;
  const FunctionType* type = nullptr;
  std::vector<Value> values;
  Source source;
};

enum class RecordSubject { coordinate, joint_cardan, joint_load, frame };

/// Quantities of coordinates: value, rate, acceleration, effort. Of joints: force, moment; with a quaternion: cardan.
/// Of frames, in world axes: position, quaternion, cardan, velocity, angular_velocity, linear_acceleration,
/// angular_acceleration; fixed_axode, the axis about which it turns and along which it slides, as point, direction and
/// pitch [m/rad]; moving_axode, the same in its own axes.
enum class Quantity {
  value,
  rate,
  acceleration,
  position,
  quaternion,
  cardan,
  velocity,
  angular_velocity,
  linear_acceleration,
  angular_acceleration,
  effort,
  force,
  moment,
  fixed_axode,
  moving_axode,
};

/// One recorded thing; it makes as many columns as the quantity has components.
struct RecordDescription {
  std::string name;  ///< columns are `name`, or `name.x` and so on
  RecordSubject subject = RecordSubject::coordinate;
  Quantity quantity = Quantity::value;
  JointId joint;
  std::uint32_t block = 0;
  Attachment frame;
  std::optional<Attachment> against;      ///< of axodes: in which frame the other moves; none: in the world
  std::optional<CoordinateReference> by;  ///< a driven coordinate that takes the place of time in rates
};

enum class Direction { either, rising, falling };

/// A value that a simulation looks out for.
struct WatchDescription {
  std::string name;  ///< "joint.coordinate" or "joint.coordinate.rate" unless the scene names it
  CoordinateReference of;
  bool rate = false;   ///< of the coordinate's rate, not of itself
  double value = 0.0;  ///< [m, rad, m/s, rad/s] that is crossed
  Direction direction = Direction::either;
  bool stop = false;  ///< the simulation ends there
};

/// How a simulation is made, where the scene says so.
struct SimulationDescription {
  std::optional<double> tolerance;  ///< relative, of one step
  std::optional<double> step;       ///< [s]
  std::string integrator;           ///< empty: the default one
  std::string formulation;          ///< empty: the one that goes with the integrator
};

struct Scene {
  std::string name;
  std::string title;
  Vector3 gravity = Vector3(0, 0, -9.81);  ///< [m/s^2]
  std::optional<double> length;            ///< [m] characteristic length, where the scene sets it
  double duration = 1.0;                   ///< [s] that a run takes
  std::uint32_t steps = 100;               ///< of a run
  SimulationDescription simulation;
  std::vector<BodyDescription> bodies;  ///< ground first, then in file order
  std::vector<FrameDescription> frames;
  std::vector<JointDescription> joints;
  std::vector<ConstraintDescription> constraints;
  std::vector<DriveDescription> drives;
  std::vector<ForceDescription> forces;
  std::vector<WatchDescription> watches;
  std::vector<RecordDescription> records;  ///< all coordinates, if the scene has no [[record]]
  std::uint64_t hash = 0;  ///< of the content, includes and parameters applied; not of comments or layout
};

/// Reads a scene file and all that it includes. Findings go into `diagnostics`, all of them; the Result holds the first
/// error if there is any.
Result<Scene> read_scene_file(Registry& registry, const std::filesystem::path& file, Diagnostics& diagnostics);

/// The same from text. `folder`: what relative file names refer to; empty: they are errors.
Result<Scene> read_scene_text(Registry& registry, std::string_view text, const std::filesystem::path& folder,
                              Diagnostics& diagnostics);

}  // namespace koppel

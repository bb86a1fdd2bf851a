// The compiled scene: everything that evaluation walks through, laid out in the order in which it is walked. Immutable,
// shared by threads. A Mechanism can only come from compile().
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/error.hpp"
#include "base/id.hpp"
#include "mechanism/face.hpp"
#include "mechanism/joint.hpp"
#include "plugin/type.hpp"
#include "scene/scene.hpp"
#include "spatial/pose.hpp"

namespace koppel {

/// A body, or the second half of a body that is cut to open a loop.
using Node = std::uint32_t;

/// A step of forward kinematics: from the parent node over a joint to the child node.
struct TreeStep {
  JointId joint;
  Node parent = 0, child = 0;
  bool reversed = false;        ///< the parent sits at the joint's outlet
  Pose to_near, from_far;       ///< near frame in the parent; child in the far frame
  bool near_is_parent = false;  ///< to_near is the identity
  bool far_is_child = false;    ///< from_far is the identity
};

/// A rate on which a relation depends.
struct PathRate {
  std::uint32_t column = 0;  ///< in the Jacobian
  std::uint32_t rate = 0;    ///< in v
  double sign = 1.0;         ///< +1: on the way to frame b, -1: on the way to frame a
};

enum class RelationKind { cut_joint, cut_body, constraint };

/// A block of closure equations between two frames, or on coordinates.
struct Relation {
  RelationKind kind = RelationKind::cut_joint;
  JointId joint;                 ///< the joint that closes the loop
  std::uint32_t constraint = 0;  ///< or the number of the constraint
  bool has_frames = true;
  Node node_a = 0, node_b = 0;
  Pose pose_a, pose_b;  ///< the frames in their nodes
  std::uint32_t first_row = 0, rows = 0;
  std::vector<PathRate> path;     ///< rates that move b against a
  std::vector<PathRate> coupled;  ///< of a constraint: its coordinates (sign not used)
  std::vector<JointId> joints;    ///< tree joints on the path, and those of the coordinates
  std::optional<Face> face;       ///< cut_joint only
};

/// A constraint with its plugin instance.
struct Constraint {
  std::string name;
  const ConstraintType* type = nullptr;
  Instance instance;
  std::vector<std::uint32_t> q, v;  ///< where its coordinates are in the state
};

/// A force with its plugin instance. With one frame, that is b, and a is the world.
struct Force {
  std::string name;
  const ForceType* type = nullptr;
  Instance instance;
  bool has_frames = false;
  Node node_a = 0, node_b = 0;
  Pose pose_a, pose_b;              ///< the frames in their nodes
  std::vector<std::uint32_t> q, v;  ///< where its coordinates are in the state
  std::uint32_t first_state = 0;    ///< of its internal states among those of all forces
};

/// A driven coordinate with its function of time; without a type it is held where the state's input has it.
struct Input {
  std::string name;
  CoordinateReference of;
  std::uint32_t q = 0, v = 0;  ///< in the state
  const FunctionType* type = nullptr;
  Instance instance;
};

/// A named number of the state: unit as "m", "rad", "m/s".
struct NamedNumber {
  std::string name;
  std::string unit;
};

/// A value of a coordinate or a rate that a simulation looks out for.
struct Watch {
  std::string name;
  bool rate = false;
  std::uint32_t at = 0;  ///< in q, or in v for a rate
  double value = 0.0;
  Direction direction = Direction::either;
  bool stop = false;
};

struct Body {
  std::string name;
  const BodyType* type = nullptr;  ///< null for the ground
  std::vector<Value> values;       ///< kept until somebody asks for inertia
};

/// One column of the record: component of a recorded quantity.
struct RecordColumn {
  std::string name, unit;
  std::uint32_t record = 0;
  std::uint32_t component = 0;
};

/// A coordinate block of the state, for everything that walks through q and v.
struct StateBlock {
  BlockKind kind = BlockKind::angle;
  JointId joint;
  std::uint32_t block = 0;
  std::uint32_t q = 0, v = 0;
};

class Mechanism {
 public:
  std::string name, title;
  Vector3 gravity = Vector3::Zero();
  double length = 1.0;  ///< characteristic length [m]
  double duration = 1.0;
  std::uint32_t run_steps = 100;
  SimulationDescription simulation;
  std::uint64_t hash = 0;

  std::vector<Body> bodies;
  std::vector<FrameDescription> frames;
  std::vector<Joint> joints;
  std::vector<Constraint> constraints;
  std::vector<Input> inputs;
  /// The same mechanism with the coordinates whose start values are fixed as further inputs, behind the others: for its
  /// first closing. Null: there are none.
  std::shared_ptr<const Mechanism> with_start_held;
  std::vector<Force> forces;
  Eigen::VectorXd internal_start;  ///< internal states of all forces, where they start
  std::vector<Watch> watches;
  std::vector<RecordDescription> records;
  std::vector<RecordColumn> record_columns;
  bool records_loads = false;  ///< some record asks for what joints or drives bear
  /// Inputs by which some record is a derivative, each once.
  std::vector<std::uint32_t> record_inputs;

  std::uint32_t nq = 0, nv = 0;
  std::vector<StateBlock> blocks;  ///< of all joints, in file order
  std::vector<NamedNumber> coordinate_names, rate_names, equation_names;
  std::vector<double> rate_scale;  ///< length for rates of lines, 1 for all others: turns rates into radians' size

  Node nodes = 1;               ///< bodies and second halves of cut bodies
  std::vector<TreeStep> steps;  ///< parents before children
  std::vector<Relation> relations;
  std::uint32_t loops = 0;     ///< the first relations; the others are constraints
  bool explicit_time = false;  ///< some constraint depends on time
  std::uint32_t rows = 0;
  std::vector<double> row_scale;  ///< 1/length for rows in metres, 1 for all others

  /// Columns of the Jacobian: unknown rates first, then driven ones. Rates of joints at which a loop is cut have none.
  std::uint32_t unknowns = 0, columns = 0;
  std::vector<std::uint32_t> rate_of_column;
  std::vector<std::int32_t> column_of_rate;  ///< -1: none
  std::int32_t mobility_count = 0;           ///< Gruebler, spatial (K-II-1.3.1)

  /// The relation that closes at this joint; null for tree joints.
  const Relation* cut_at(JointId joint) const;

 private:
  friend class Compiler;
  Mechanism() = default;
};

/// Builds the mechanism; findings (notes) go into `diagnostics`. Errors: a plugin that refuses or misbehaves.
Result<std::shared_ptr<const Mechanism>> compile(const Scene& scene, Diagnostics& diagnostics);

}  // namespace koppel

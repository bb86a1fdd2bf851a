// Typed views of what plugins offer. Each copies the plugin's table once, checked and with the missing tail
// zero-filled, so that the rest of core never looks at a struct_size.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "koppel/plugin.h"

namespace koppel {

enum class PluginKind { joint, body, constraint, function, force };

/// "joint", "body", ... as written in scenes.
std::string_view plugin_kind_name(PluginKind kind);

enum class ParameterKind {
  real = KOPPEL_PARAMETER_REAL,
  integer = KOPPEL_PARAMETER_INTEGER,
  boolean = KOPPEL_PARAMETER_BOOLEAN,
  string = KOPPEL_PARAMETER_STRING,
  vector = KOPPEL_PARAMETER_VECTOR,
  direction = KOPPEL_PARAMETER_DIRECTION,
  table = KOPPEL_PARAMETER_TABLE,
  frame = KOPPEL_PARAMETER_FRAME,
  coordinates = KOPPEL_PARAMETER_COORDINATES,
};

/// One entry of a type's parameter schema.
struct Parameter {
  ParameterKind kind = ParameterKind::real;
  std::string name;
  std::string unit;  ///< "" for a pure number
  std::string doc;
  bool required = false;
  std::size_t columns = 1;    ///< numbers in a table's row
  std::size_t count_min = 1;  ///< entries, or rows of a table
  std::size_t count_max = 1;
  std::optional<std::vector<double>> fallback;
  std::optional<double> minimum, maximum;
};

/// A parameter's checked value. Directions of joints are in inlet-frame axes.
struct Value {
  bool given = false;
  std::size_t count = 0;  ///< as koppel_value.count
  std::vector<double> numbers;
  std::string text;
};

/// A plugin's instance: owns it, and keeps the library that it comes from loaded.
class Instance {
 public:
  Instance() = default;
  Instance(void* pointer, void (*destroy)(void*), std::shared_ptr<const void> library);
  Instance(Instance&& other) noexcept;
  Instance& operator=(Instance&& other) noexcept;
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;
  ~Instance();

  const void* get() const { return pointer_; }

 private:
  void* pointer_ = nullptr;
  void (*destroy_)(void*) = nullptr;
  std::shared_ptr<const void> library_;
};

/// What types of all kinds have in common.
struct Type {
  PluginKind kind = PluginKind::joint;
  std::string name;
  std::string summary;
  std::string origin;  ///< file of the plugin, or "built in"
  std::vector<Parameter> parameters;
  koppel_type table{};
  Logger log;
  std::shared_ptr<const void> library;

  /// Builds an instance from values in the order of `parameters`. Error: instance_refused, with the plugin's reason.
  Result<Instance> create(std::span<const Value> values) const;
};

enum class BlockKind {
  line = KOPPEL_BLOCK_LINE,
  angle = KOPPEL_BLOCK_ANGLE,
  quaternion = KOPPEL_BLOCK_QUATERNION,
  unit_vector = KOPPEL_BLOCK_UNIT_VECTOR,
};

/// How many numbers a block has in q, and how many in v.
constexpr std::size_t coordinate_count(BlockKind kind) {
  switch (kind) {
    case BlockKind::line:
    case BlockKind::angle: return 1;
    case BlockKind::quaternion: return 4;
    case BlockKind::unit_vector: return 3;
  }
  return 0;
}
constexpr std::size_t rate_count(BlockKind kind) {
  switch (kind) {
    case BlockKind::line:
    case BlockKind::angle: return 1;
    case BlockKind::quaternion: return 3;
    case BlockKind::unit_vector: return 2;
  }
  return 0;
}
constexpr bool is_scalar(BlockKind kind) { return coordinate_count(kind) == 1; }

struct Block {
  BlockKind kind = BlockKind::angle;
  std::string name;
};

struct Row {
  std::string name;
  std::string unit;
};

struct JointType : Type {
  std::vector<Block> blocks;
  std::vector<Row> rows;  ///< of the implicit face that the plugin itself offers; empty if none
  koppel_joint_type calls{};

  std::size_t nq() const;
  std::size_t nv() const;
  /// The motion is a product of elementary motions, told by motions().
  bool is_product() const { return calls.motions != nullptr || blocks.empty(); }
};

struct BodyType : Type {
  koppel_body_type calls{};
};

struct ConstraintType : Type {
  std::vector<Row> rows;
  koppel_constraint_type calls{};
};

struct FunctionType : Type {
  koppel_function_type calls{};
};

struct InternalState {
  std::string name;
  std::string unit;
};

struct ForceType : Type {
  std::vector<InternalState> states;
  koppel_force_type calls{};
};

}  // namespace koppel

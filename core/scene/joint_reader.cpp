// [[joint]]: where it sits, and what is said of its coordinates.
#include <algorithm>

#include "scene/coordinate_reader.hpp"
#include "scene/frame_reader.hpp"
#include "scene/type_values.hpp"

namespace koppel {
namespace {

struct Placement {
  std::optional<Attachment> inlet, outlet;
  Matrix3 to_inlet = Matrix3::Identity();  ///< turns the axes in which directions are given into inlet axes
};

/// `between = [body, body]` with a pose in the world at the design position.
Placement read_between(Reading& reading, Scope& scope, TableReader& table, const Node& between) {
  Placement placement;
  table.none_of({"inlet", "outlet"}, "does not go with `between`, which places the joint already");
  const auto pose = read_axis_pose(table);
  const std::string_view advice = "name two bodies: between = [\"ground\", \"crank\"]";
  if (!table.values().is_list(between, "`between`", 2, 2, advice)) return placement;
  std::optional<BodyId> bodies[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const Node& item = between.items[i];
    const auto name = table.values().text(item, "`between`");
    if (name) bodies[i] = reading.names.body(*name, {scope.prefix, table.report(), item.place});
  }
  if (pose) placement.to_inlet = pose->rotation.transpose();
  if (!pose || !bodies[0] || !bodies[1]) return placement;
  const auto attach = [&](BodyId body) {
    return Attachment{body, relative_pose(reading.scene.bodies[body.index()].design, *pose)};
  };
  placement.inlet = attach(*bodies[0]);
  placement.outlet = attach(*bodies[1]);
  return placement;
}

Placement read_frames(Reading& reading, Scope& scope, TableReader& table) {
  Placement placement;
  table.none_of({"at", "axis", "x_axis"}, "goes with `between`; `inlet` and `outlet` say where the joint sits");
  const std::string_view advice = "give both `inlet` and `outlet`, or `between = [\"body\", \"body\"]` with `at`";
  if (const Node* inlet = table.require("inlet", advice)) {
    placement.inlet = read_attachment(reading, scope, table.values(), *inlet, "`inlet`");
  }
  if (const Node* outlet = table.require("outlet", advice)) {
    placement.outlet = read_attachment(reading, scope, table.values(), *outlet, "`outlet`");
  }
  return placement;
}

Placement read_placement(Reading& reading, Scope& scope, TableReader& table) {
  if (const Node* between = table.find("between")) return read_between(reading, scope, table, *between);
  if (table.find("inlet") != nullptr || table.find("outlet") != nullptr) return read_frames(reading, scope, table);
  table.report().error(Code::missing_key, table.place(), "the joint does not say where it sits",
                       "add `between = [\"body\", \"body\"]` with `at` and `axis`, or `inlet` and `outlet`");
  read_axis_pose(table);
  return {};
}

std::optional<std::vector<double>> read_start(const ValueReader& values, const Block& block, const Node& node) {
  const std::string what = "`start." + block.name + '`';
  switch (block.kind) {
    case BlockKind::line:
    case BlockKind::angle: {
      const auto start = values.number(node, what, unit_of(block.kind));
      return start ? std::optional(std::vector<double>{*start}) : std::nullopt;
    }
    case BlockKind::quaternion: {
      const auto q = values.quaternion(node, what);
      return q ? std::optional(std::vector<double>(q->begin(), q->end())) : std::nullopt;
    }
    case BlockKind::unit_vector: {
      const auto n = values.direction(node, what);
      return n ? std::optional(std::vector<double>(n->begin(), n->end())) : std::nullopt;
    }
  }
  return std::nullopt;
}

/// One number for each rate of the block, per second: of a quaternion the angular velocity in outlet axes.
std::optional<std::vector<double>> read_start_rate(const ValueReader& values, const Block& block, const Node& node) {
  const std::string what = "`start_rate." + block.name + '`';
  if (!is_scalar(block.kind)) {
    const std::size_t count = rate_count(block.kind);
    const std::string_view advice = block.kind == BlockKind::quaternion
                                        ? "write the angular velocity in the axes of the outlet: [wx, wy, wz]"
                                        : "write one number for each rate";
    return values.numbers(node, what, count, count, "rad", advice);
  }
  const auto rate = values.number(node, what, unit_of(block.kind));
  return rate ? std::optional(std::vector<double>{*rate}) : std::nullopt;
}

std::optional<std::array<double, 2>> read_limits(const ValueReader& values, const Block& block, const Node& node) {
  const auto limits = values.numbers(node, "`limits." + block.name + '`', 2, 2, unit_of(block.kind));
  if (!limits) return std::nullopt;
  if ((*limits)[0] > (*limits)[1]) {
    values.report().error(Code::bad_limits, node.place, "the lower limit lies above the upper one",
                          "write [lower, upper]");
    return std::nullopt;
  }
  return std::array<double, 2>{(*limits)[0], (*limits)[1]};
}

/// The table `zero`, `start`, `start_rate` or `limits` of a joint: calls read(block number, node) for each coordinate
/// in it.
template <typename Read>
void read_by_coordinate(TableReader& table, const JointType& type, std::string_view key, Read read) {
  const Node* node = table.find(key);
  if (node == nullptr) return;
  if (!node->is_table()) {
    table.values().wrong_kind(*node, quote(key), "a table { coordinate = value }");
    return;
  }
  for (std::size_t i = 0; i < node->keys.size(); ++i) {
    const Node::Key& name = node->keys[i];
    std::size_t block = 0;
    while (block < type.blocks.size() && type.blocks[block].name != name.text) ++block;
    if (block < type.blocks.size()) {
      read(block, node->items[i]);
    } else {
      table.report().error(Code::unknown_coordinate, name.place, "the joint has no coordinate " + quote(name.text),
                           coordinates_text(type));
    }
  }
}

void read_coordinate_settings(Reading& reading, const Element& element, TableReader& table, JointDescription& joint) {
  const JointType& type = *joint.type;
  const ValueReader& values = table.values();
  const auto scalar = [&](std::size_t block, const Node& node, std::string_view key) {
    if (is_scalar(type.blocks[block].kind)) return true;
    values.report().error(Code::not_scalar, node.place,
                          quote(key) + " is for lengths and angles; " + quote(type.blocks[block].name) + " is neither");
    return false;
  };
  read_by_coordinate(table, type, "zero", [&](std::size_t block, const Node& node) {
    if (!scalar(block, node, "zero")) return;
    const auto zero = values.number(node, "`zero." + type.blocks[block].name + '`', unit_of(type.blocks[block].kind));
    joint.coordinates[block].zero = zero.value_or(0.0);
  });
  read_by_coordinate(table, type, "start", [&](std::size_t block, const Node& node) {
    joint.coordinates[block].start = read_start(values, type.blocks[block], node);
    reading.starts[element.index][block].value = node.place;
  });
  read_by_coordinate(table, type, "start_rate", [&](std::size_t block, const Node& node) {
    joint.coordinates[block].start_rate = read_start_rate(values, type.blocks[block], node);
    reading.starts[element.index][block].rate = node.place;
  });
  read_by_coordinate(table, type, "limits", [&](std::size_t block, const Node& node) {
    if (!scalar(block, node, "limits")) return;
    joint.coordinates[block].limits = read_limits(values, type.blocks[block], node);
  });
}

/// `fixed`: names of coordinates whose start values must hold.
void read_fixed(TableReader& table, JointDescription& joint) {
  const Node* node = table.find("fixed");
  const ValueReader& values = table.values();
  if (node == nullptr || !values.is_list(*node, "`fixed`", 1, unbounded, "write the names of coordinates")) return;
  for (const Node& item : node->items) {
    const auto name = values.text(item, "an entry of `fixed`");
    if (!name) continue;
    const auto& blocks = joint.type->blocks;
    const auto block = std::find_if(blocks.begin(), blocks.end(), [&](const Block& b) { return b.name == *name; });
    if (block == blocks.end()) {
      table.report().error(Code::unknown_coordinate, item.place, "the joint has no coordinate " + quote(*name),
                           coordinates_text(*joint.type));
      continue;
    }
    CoordinateDescription& coordinate = joint.coordinates[static_cast<std::size_t>(block - blocks.begin())];
    if (!is_scalar(block->kind)) {
      table.report().error(Code::not_scalar, item.place,
                           "`fixed` is for lengths and angles; " + quote(*name) + " is neither");
    } else if (!coordinate.start && !coordinate.start_rate) {
      table.report().error(Code::missing_key, item.place, quote(*name) + " is fixed, and nothing says where",
                           "give it a `start`, a `start_rate` or both");
    }
    coordinate.fixed = true;
  }
}

}  // namespace

void read_joint(Reading& reading, const Element& element) {
  Scope& scope = *element.scope;
  TableReader table = reading.table(element);
  table.find("name");
  JointDescription& joint = reading.scene.joints[element.index];
  const Placement placement = read_placement(reading, scope, table);
  if (placement.inlet && placement.outlet) {
    joint.inlet = *placement.inlet;
    joint.outlet = *placement.outlet;
    if (joint.inlet.body == joint.outlet.body) {
      const Place& place = table.place_of(table.find("between") != nullptr ? "between" : "outlet");
      table.report().error(Code::same_body, place, "both sides of the joint are on the same body",
                           "connect two different bodies");
    }
  }
  joint.type = find_type<JointType>(reading, scope, table, "", &Registry::joint);
  if (joint.type == nullptr) return table.finish_without_type({"zero", "start", "start_rate", "limits", "fixed"});
  joint.coordinates.resize(joint.type->blocks.size());
  reading.starts[element.index].resize(joint.type->blocks.size());
  joint.values = read_values(reading, scope, table, *joint.type, placement.to_inlet).values;
  read_coordinate_settings(reading, element, table, joint);
  read_fixed(table, joint);
  table.finish();
}

}  // namespace koppel

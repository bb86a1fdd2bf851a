#include "mechanism/names.hpp"

#include <span>
#include <string_view>

namespace koppel {
namespace {

constexpr std::string_view quaternion_suffixes[] = {".w", ".x", ".y", ".z"};
constexpr std::string_view vector_suffixes[] = {".x", ".y", ".z"};
constexpr std::string_view tangent_suffixes[] = {".1", ".2"};
constexpr std::string_view cardan_suffixes[] = {".alpha", ".beta", ".gamma"};
constexpr std::string_view axode_suffixes[] = {".x", ".y", ".z", ".ux", ".uy", ".uz", ".pitch"};
constexpr std::string_view no_suffix[] = {""};

std::string coordinate_unit(BlockKind kind) {
  switch (kind) {
    case BlockKind::line: return "m";
    case BlockKind::angle: return "rad";
    case BlockKind::quaternion:
    case BlockKind::unit_vector: return "1";
  }
  return "";
}

std::string effort_unit(BlockKind kind) { return kind == BlockKind::line ? "N" : "N m"; }

std::string rate_unit(BlockKind kind) { return kind == BlockKind::line ? "m/s" : "rad/s"; }

std::span<const std::string_view> coordinate_suffixes(BlockKind kind) {
  switch (kind) {
    case BlockKind::line:
    case BlockKind::angle: return no_suffix;
    case BlockKind::quaternion: return quaternion_suffixes;
    case BlockKind::unit_vector: return vector_suffixes;
  }
  return no_suffix;
}

std::span<const std::string_view> rate_suffixes(BlockKind kind) {
  switch (kind) {
    case BlockKind::line:
    case BlockKind::angle: return no_suffix;
    case BlockKind::quaternion: return vector_suffixes;
    case BlockKind::unit_vector: return tangent_suffixes;
  }
  return no_suffix;
}

std::string block_name(const Mechanism& mechanism, const StateBlock& block) {
  const Joint& joint = mechanism.joints[block.joint.index()];
  return joint.name + "." + joint.type->blocks[block.block].name;
}

struct QuantityColumns {
  std::string unit;
  std::span<const std::string_view> suffixes;
};

/// What stands for "per second" in the unit of a record, or for "per second squared".
std::string per_time(const Mechanism& mechanism, const RecordDescription& record, int order) {
  std::string unit = "/";
  unit += record.by ? coordinate_unit(mechanism.joints[record.by->joint.index()].blocks[record.by->block].kind) : "s";
  return order == 2 ? unit + "^2" : unit;
}

QuantityColumns quantity_columns(const Mechanism& mechanism, const RecordDescription& record) {
  const auto coordinate = [&](const std::string& per) {
    const BlockKind kind = mechanism.joints[record.joint.index()].blocks[record.block].kind;
    const std::string unit = is_scalar(kind) || per.empty() ? coordinate_unit(kind) : "rad";
    return unit + per;
  };
  const std::string first = per_time(mechanism, record, 1), second = per_time(mechanism, record, 2);
  const auto suffixes = [&](bool rates) {
    const BlockKind kind = mechanism.joints[record.joint.index()].blocks[record.block].kind;
    return rates ? rate_suffixes(kind) : coordinate_suffixes(kind);
  };
  switch (record.quantity) {
    case Quantity::value: return {coordinate(""), suffixes(false)};
    case Quantity::rate: return {coordinate(first), suffixes(true)};
    case Quantity::acceleration: return {coordinate(second), suffixes(true)};
    case Quantity::position: return {"m", vector_suffixes};
    case Quantity::quaternion: return {"1", quaternion_suffixes};
    case Quantity::cardan: return {"rad", cardan_suffixes};
    case Quantity::velocity: return {"m" + first, vector_suffixes};
    case Quantity::angular_velocity: return {"rad" + first, vector_suffixes};
    case Quantity::linear_acceleration: return {"m" + second, vector_suffixes};
    case Quantity::angular_acceleration: return {"rad" + second, vector_suffixes};
    case Quantity::effort:
      return {effort_unit(mechanism.joints[record.joint.index()].blocks[record.block].kind), suffixes(true)};
    case Quantity::force: return {"N", vector_suffixes};
    case Quantity::moment: return {"N m", vector_suffixes};
    // Each column has a unit of its own: record_columns().
    case Quantity::fixed_axode:
    case Quantity::moving_axode: return {"m", axode_suffixes};
  }
  return {"", no_suffix};
}

}  // namespace

std::vector<NamedNumber> coordinate_names(const Mechanism& mechanism) {
  std::vector<NamedNumber> names;
  for (const StateBlock& block : mechanism.blocks) {
    for (const std::string_view suffix : coordinate_suffixes(block.kind)) {
      names.push_back({block_name(mechanism, block) + std::string(suffix), coordinate_unit(block.kind)});
    }
  }
  return names;
}

std::vector<NamedNumber> rate_names(const Mechanism& mechanism) {
  std::vector<NamedNumber> names;
  for (const StateBlock& block : mechanism.blocks) {
    for (const std::string_view suffix : rate_suffixes(block.kind)) {
      names.push_back({block_name(mechanism, block) + std::string(suffix), rate_unit(block.kind)});
    }
  }
  return names;
}

std::string relation_name(const Mechanism& mechanism, const Relation& relation) {
  if (relation.kind == RelationKind::constraint) return "constraint " + mechanism.constraints[relation.constraint].name;
  return "loop at joint " + mechanism.joints[relation.joint.index()].name;
}

std::vector<Row> relation_rows(const Mechanism& mechanism, const Relation& relation) {
  switch (relation.kind) {
    case RelationKind::cut_joint: return relation.face->rows();
    case RelationKind::constraint: return mechanism.constraints[relation.constraint].type->rows;
    case RelationKind::cut_body:
      return {{"direction x", "rad"}, {"direction y", "rad"}, {"direction z", "rad"},
              {"position x", "m"},    {"position y", "m"},    {"position z", "m"}};
  }
  return {};
}

std::vector<RecordColumn> record_columns(const Mechanism& mechanism) {
  std::vector<RecordColumn> columns;
  for (std::uint32_t i = 0; i < mechanism.records.size(); ++i) {
    const QuantityColumns all = quantity_columns(mechanism, mechanism.records[i]);
    for (std::uint32_t k = 0; k < all.suffixes.size(); ++k) {
      columns.push_back({mechanism.records[i].name + std::string(all.suffixes[k]), all.unit, i, k});
      if (all.suffixes.data() == axode_suffixes && k >= 3) columns.back().unit = k < 6 ? "1" : "m/rad";
    }
  }
  return columns;
}

}  // namespace koppel

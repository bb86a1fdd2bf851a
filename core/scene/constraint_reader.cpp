// [[constraint]], [[force]] and [[drive]].
#include "scene/coordinate_reader.hpp"
#include "scene/type_values.hpp"

namespace koppel {
namespace {

/// Each coordinate has one drive, and then its start value says nothing.
void check_driven(Reading& reading, const Element& element, const TableReader& table, const Node& of,
                  CoordinateReference coordinate) {
  const auto& drives = reading.scene.drives;
  for (std::size_t i = 0; i < element.index; ++i) {
    const DriveDescription& other = drives[i];
    if (other.type == nullptr || other.of.joint != coordinate.joint || other.of.block != coordinate.block) continue;
    table.report().error(Code::driven_twice, of.place, quote(of.text) + " has a drive already",
                         "remove one of the two; the other is in line " + std::to_string(other.source.line));
    return;
  }
  const Reading::StartPlaces& start = reading.starts[coordinate.joint.index()][coordinate.block];
  // The joint may stand in another file than the drive.
  for (const Element& joint : reading.joints) {
    if (joint.index != coordinate.joint.index()) continue;
    const Reporter report = reading.reporter(*joint.scope, joint.label);
    const auto ignored = [&](const Place& place, const std::string& what) {
      if (place.line == 0) return;
      report.warning(Code::start_ignored, place, "the " + what + " is ignored: a drive sets this coordinate",
                     "remove it, or the drive of " + quote(of.text));
    };
    ignored(start.value, "start value");
    ignored(start.rate, "start rate");
  }
}

/// The unit of the coordinate that a standard force acts on: values without a unit in its schema are measured in it.
std::string_view coordinate_unit(Reading& reading, Scope& scope, TableReader& table, const ForceType& type) {
  if (type.name.find('.') != std::string::npos) return "";
  for (const Parameter& parameter : type.parameters) {
    const Node* node = parameter.kind == ParameterKind::coordinates ? table.find(parameter.name) : nullptr;
    if (node == nullptr || !node->is_string()) continue;
    // A fault is told once more when the values are read, and then counts once.
    const auto of = read_scalar_coordinate(reading, scope, table.values(), *node, quote(parameter.name));
    if (of) return unit_of(reading.scene.joints[of->joint.index()].type->blocks[of->block].kind);
  }
  return "";
}

/// What the values of a function are measured in where its schema does not say: standard functions have the unit of the
/// coordinate, those of other plugins speak for themselves.
std::string_view value_unit(const Reading& reading, const FunctionType& type,
                            const std::optional<CoordinateReference>& coordinate) {
  const bool standard = type.name.find('.') == std::string::npos;
  if (!standard || !coordinate) return "";
  return unit_of(reading.scene.joints[coordinate->joint.index()].type->blocks[coordinate->block].kind);
}

}  // namespace

void read_constraint(Reading& reading, const Element& element) {
  Scope& scope = *element.scope;
  TableReader table = reading.table(element);
  table.find("name");
  ConstraintDescription& constraint = reading.scene.constraints[element.index];
  constraint.type = find_type<ConstraintType>(reading, scope, table, "", &Registry::constraint);
  if (constraint.type == nullptr) return table.finish_without_type();
  TypeValues given = read_values(reading, scope, table, *constraint.type);
  constraint.values = std::move(given.values);
  constraint.frames = std::move(given.frames);
  constraint.coordinates = std::move(given.coordinates);
  table.finish();
}

void read_force(Reading& reading, const Element& element) {
  Scope& scope = *element.scope;
  TableReader table = reading.table(element);
  table.find("name");
  ForceDescription& force = reading.scene.forces[element.index];
  force.type = find_type<ForceType>(reading, scope, table, "", &Registry::force);
  if (force.type == nullptr) return table.finish_without_type();
  const std::string_view unit = coordinate_unit(reading, scope, table, *force.type);
  TypeValues given = read_values(reading, scope, table, *force.type, Matrix3::Identity(), unit);
  force.values = std::move(given.values);
  force.frames = std::move(given.frames);
  force.coordinates = std::move(given.coordinates);
  table.finish();
}

void read_drive(Reading& reading, const Element& element) {
  Scope& scope = *element.scope;
  TableReader table = reading.table(element);
  table.find("name");
  DriveDescription& drive = reading.scene.drives[element.index];
  const Node* of = table.require("of", "name the coordinate that is driven: of = \"joint.coordinate\"");
  const auto coordinate = of ? read_scalar_coordinate(reading, scope, table.values(), *of, "`of`") : std::nullopt;
  const auto* type = find_type<FunctionType>(reading, scope, table, "", &Registry::function);
  if (coordinate) {
    drive.of = *coordinate;
    if (drive.name.empty()) drive.name = coordinate_name(reading.scene, *coordinate);
    check_driven(reading, element, table, *of, *coordinate);
  }
  if (type == nullptr) return table.finish_without_type();
  // The type marks the drive as complete: check_driven() compares with no other.
  if (coordinate) drive.type = type;
  drive.values =
      read_values(reading, scope, table, *type, Matrix3::Identity(), value_unit(reading, *type, coordinate)).values;
  table.finish();
}

}  // namespace koppel

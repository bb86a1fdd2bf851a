// [[watch]]: values that a simulation looks out for.
#include <string>

#include "scene/coordinate_reader.hpp"

namespace koppel {
namespace {

/// `quantity`: the coordinate itself or its rate.
bool read_quantity(TableReader& table) {
  const Node* node = table.find("quantity");
  if (node == nullptr) return false;
  const auto name = table.values().text(*node, "`quantity`");
  if (!name || *name == "value") return false;
  if (*name == "rate") return true;
  table.report().error(Code::unknown_quantity, node->place, "a watch has no quantity " + quote(*name),
                       "it watches a coordinate's `value` or its `rate`");
  return false;
}

Direction read_direction(TableReader& table) {
  const Node* node = table.find("direction");
  if (node == nullptr) return Direction::either;
  const auto name = table.values().text(*node, "`direction`");
  if (!name || *name == "either") return Direction::either;
  if (*name == "rising") return Direction::rising;
  if (*name == "falling") return Direction::falling;
  table.report().error(Code::out_of_range, node->place, "there is no direction " + quote(*name),
                       "a value is crossed `rising`, `falling` or in `either` direction");
  return Direction::either;
}

}  // namespace

void read_watch(Reading& reading, const Element& element) {
  Scope& scope = *element.scope;
  TableReader table = reading.table(element);
  table.find("name");
  WatchDescription& watch = reading.scene.watches[element.index];
  const Node* of = table.require("of", "name the coordinate that is watched: of = \"joint.coordinate\"");
  const auto coordinate = of ? read_scalar_coordinate(reading, scope, table.values(), *of, "`of`") : std::nullopt;
  watch.rate = read_quantity(table);
  watch.direction = read_direction(table);
  if (const Node* stop = table.find("stop")) watch.stop = table.values().truth(*stop, "`stop`").value_or(false);
  const Node* value = table.find("value");
  table.finish();
  if (!coordinate) return;
  watch.of = *coordinate;
  const Block& block = reading.scene.joints[coordinate->joint.index()].type->blocks[coordinate->block];
  const std::string unit = std::string(unit_of(block.kind)) + (watch.rate ? "/s" : "");
  if (value != nullptr) watch.value = table.values().number(*value, "`value`", unit).value_or(0.0);
  if (!watch.name.empty()) return;
  watch.name = coordinate_name(reading.scene, *coordinate) + (watch.rate ? ".rate" : "");
  if (reading.watch_names.insert(watch.name).second) return;
  table.report().error(Code::duplicate_name, of->place, quote(watch.name) + " is watched already",
                       "give one of the watches a name");
}

}  // namespace koppel

// [[record]]: what a run writes.
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "scene/coordinate_reader.hpp"
#include "scene/frame_reader.hpp"

namespace koppel {
namespace {

using QuantityName = std::pair<std::string_view, Quantity>;

constexpr auto of_coordinates = std::to_array<QuantityName>({
    {"value", Quantity::value},
    {"rate", Quantity::rate},
    {"acceleration", Quantity::acceleration},
    {"effort", Quantity::effort},
});
constexpr auto of_joints = std::to_array<QuantityName>({{"force", Quantity::force}, {"moment", Quantity::moment}});
constexpr auto of_turning_joints = std::to_array<QuantityName>({{"cardan", Quantity::cardan}});
constexpr auto of_frames = std::to_array<QuantityName>({
    {"position", Quantity::position},
    {"quaternion", Quantity::quaternion},
    {"cardan", Quantity::cardan},
    {"velocity", Quantity::velocity},
    {"angular_velocity", Quantity::angular_velocity},
    {"linear_acceleration", Quantity::linear_acceleration},
    {"angular_acceleration", Quantity::angular_acceleration},
    {"fixed_axode", Quantity::fixed_axode},
    {"moving_axode", Quantity::moving_axode},
});

/// The quantity that a record asks for; `value` if it asks for none.
struct Asked {
  const Node* node = nullptr;
  std::string name;
};

template <std::size_t Count>
bool offers(const std::array<QuantityName, Count>& table, std::string_view name) {
  for (const auto& [candidate, quantity] : table) {
    if (candidate == name) return true;
  }
  return false;
}

/// Looks the quantity up among those that a subject has. Error: unknown_quantity.
template <std::size_t Count>
bool choose(const std::array<QuantityName, Count>& table, const Asked& asked, const Reporter& report,
            std::string_view subject, Quantity& out) {
  std::string all;
  std::vector<std::string> names;
  for (const auto& [name, quantity] : table) {
    if (asked.node == nullptr || name == asked.name) {
      out = quantity;
      return true;
    }
    all += (all.empty() ? "" : ", ") + std::string(name);
    names.emplace_back(name);
  }
  const std::string near = did_you_mean(asked.name, names);
  report.error(Code::unknown_quantity, asked.node->place,
               std::string(subject) + " has no quantity " + quote(asked.name), near.empty() ? "it has " + all : near);
  return false;
}

bool has_quaternion(const JointType& type) {
  for (const Block& block : type.blocks) {
    if (block.kind == BlockKind::quaternion) return true;
  }
  return false;
}

/// Whether a text that names neither frame nor joint is meant as joint.coordinate: before its last dot stands something
/// else than the prefix of an included scene.
bool means_coordinate(const Reading& reading, std::string_view prefix, std::string_view text) {
  const std::size_t dot = text.rfind('.');
  if (dot == std::string_view::npos) return false;
  if (reading.names.find_joint(prefix, text.substr(0, dot))) return true;
  const std::string begin = std::string(prefix) + std::string(text.substr(0, dot + 1));
  return std::none_of(reading.scopes.begin(), reading.scopes.end(),
                      [&begin](const auto& scope) { return scope->prefix == begin; });
}

void read_subject(Reading& reading, Scope& scope, const TableReader& table, const Node& of, const Asked& asked,
                  RecordDescription& record) {
  const Reporter& report = table.report();
  const auto joint = reading.names.find_joint(scope.prefix, of.text);
  const JointType* type = joint ? reading.scene.joints[joint->index()].type : nullptr;
  const auto fixed = reading.names.find_fixed(scope.prefix, of.text);
  const bool turning = type != nullptr && has_quaternion(*type);
  if (turning && offers(of_turning_joints, asked.name)) {
    record.subject = RecordSubject::joint_cardan;
    record.joint = *joint;
    record.quantity = Quantity::cardan;
  } else if (type != nullptr && offers(of_joints, asked.name)) {
    record.subject = RecordSubject::joint_load;
    record.joint = *joint;
    choose(of_joints, asked, report, "a joint", record.quantity);
  } else if (fixed) {
    record.subject = RecordSubject::frame;
    if (const auto frame = read_attachment(reading, scope, table.values(), of, "`of`")) record.frame = *frame;
    choose(of_frames, asked, report, "a frame", record.quantity);
  } else if (type != nullptr) {
    report.error(Code::unknown_quantity, of.place, quote(of.text) + " is a joint; here a coordinate or frame is needed",
                 std::string("add quantity = \"force\", \"moment\"") + (turning ? " or \"cardan\"" : "") +
                     ", or name a coordinate: " + coordinates_text(*type));
  } else if (joint || reading.names.is_lost(scope.prefix, of.text)) {
    return;  // the joint or frame is faulty, which has been reported
  } else if (means_coordinate(reading, scope.prefix, of.text)) {
    const auto coordinate = read_coordinate(reading, scope, report, of);
    if (coordinate) {
      record.joint = coordinate->joint;
      record.block = coordinate->block;
    }
    choose(of_coordinates, asked, report, "a coordinate", record.quantity);
  } else {
    reading.names.fixed(of.text, {scope.prefix, report, of.place});
  }
}

/// `by`: the coordinate that takes the place of time.
void read_by(Reading& reading, Scope& scope, const TableReader& table, const Node& node, RecordDescription& record) {
  const Reporter& report = table.report();
  const auto by = read_scalar_coordinate(reading, scope, table.values(), node, "`by`");
  if (!by) return;
  const auto& drives = reading.scene.drives;
  if (std::none_of(drives.begin(), drives.end(), [&](const DriveDescription& drive) { return drive.of == *by; })) {
    report.error(Code::not_driven, node.place, "no drive sets " + quote(node.text),
                 "name a coordinate with a [[drive]]");
    return;
  }
  for (const ConstraintDescription& constraint : reading.scene.constraints) {
    if (constraint.type == nullptr || constraint.type->calls.time_rate == nullptr) continue;
    report.error(Code::not_driven, node.place,
                 "constraint " + quote(constraint.name) + " depends on time, so that nothing follows from drives alone",
                 "record rates by time instead: leave out `by`");
    return;
  }
  switch (record.quantity) {
    case Quantity::rate:
    case Quantity::acceleration:
    case Quantity::velocity:
    case Quantity::angular_velocity:
    case Quantity::linear_acceleration:
    case Quantity::angular_acceleration: record.by = by; return;
    default:
      report.error(Code::unknown_quantity, node.place, "`by` is for rates and accelerations",
                   "add quantity = \"rate\" or \"acceleration\", of frames \"velocity\" and so on, or leave out `by`");
  }
}

/// `against`: in which frame an axode is seen.
void read_against(Reading& reading, Scope& scope, const TableReader& table, const Node& node,
                  RecordDescription& record) {
  if (record.quantity == Quantity::fixed_axode || record.quantity == Quantity::moving_axode) {
    record.against = read_attachment(reading, scope, table.values(), node, "`against`");
    return;
  }
  table.report().error(Code::unknown_quantity, node.place, "`against` is for axodes",
                       "add quantity = \"fixed_axode\" or \"moving_axode\", or leave out `against`");
}

}  // namespace

void read_record(Reading& reading, const Element& element) {
  Scope& scope = *element.scope;
  TableReader table = reading.table(element);
  table.find("name");
  RecordDescription& record = reading.scene.records[element.index];
  const Node* of = table.require("of", "say what is recorded: of = \"joint.coordinate\", or a frame");
  Asked asked;
  asked.node = table.find("quantity");
  const Node *by = table.find("by"), *against = table.find("against");
  table.finish();
  if (asked.node != nullptr) {
    const auto name = table.values().text(*asked.node, "`quantity`");
    if (!name) return;
    asked.name = *name;
  }
  if (of == nullptr) return;
  if (of->is_string()) {
    read_subject(reading, scope, table, *of, asked, record);
    if (by != nullptr) read_by(reading, scope, table, *by, record);
    if (against != nullptr) read_against(reading, scope, table, *against, record);
    if (!record.name.empty()) return;
    record.name = scope.prefix + of->text + (asked.node ? '.' + asked.name : "");
    if (record.by) record.name += '/' + scope.prefix + by->text;
    if (!reading.record_names.insert(record.name).second) {
      table.report().error(Code::duplicate_name, of->place, quote(record.name) + " is recorded already",
                           "remove one of the records, or give it a name");
    }
    return;
  }
  record.subject = RecordSubject::frame;
  if (const auto frame = read_attachment(reading, scope, table.values(), *of, "`of`")) record.frame = *frame;
  choose(of_frames, asked, table.report(), "a frame", record.quantity);
  if (by != nullptr) read_by(reading, scope, table, *by, record);
  if (against != nullptr) read_against(reading, scope, table, *against, record);
  if (record.name.empty()) record.name = "frame" + std::to_string(element.index + 1);
}

void add_default_records(Scene& scene) {
  if (!scene.records.empty()) return;
  for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
    for (std::uint32_t block = 0; block < scene.joints[joint].coordinates.size(); ++block) {
      RecordDescription record;
      record.joint = JointId{joint};
      record.block = block;
      record.name = coordinate_name(scene, {record.joint, block});
      scene.records.push_back(std::move(record));
    }
  }
}

}  // namespace koppel

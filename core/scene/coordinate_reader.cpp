#include "scene/coordinate_reader.hpp"

namespace koppel {
namespace {

std::optional<std::uint32_t> find_block(const JointType& type, std::string_view name) {
  for (std::size_t i = 0; i < type.blocks.size(); ++i) {
    if (type.blocks[i].name == name) return static_cast<std::uint32_t>(i);
  }
  return std::nullopt;
}

}  // namespace

std::string coordinates_text(const JointType& type) {
  if (type.blocks.empty()) return "a joint of type " + quote(type.name) + " has no coordinates";
  std::string names;
  for (const Block& block : type.blocks) names += (names.empty() ? "" : ", ") + quote(block.name);
  return (type.blocks.size() == 1 ? "its coordinate is " : "its coordinates are ") + names;
}

std::optional<CoordinateReference> read_coordinate(Reading& reading, Scope& scope, const Reporter& report,
                                                   const Node& text) {
  const std::string_view whole = text.text;
  const std::size_t dot = whole.rfind('.');
  if (dot == std::string_view::npos) {
    const auto joint = reading.names.find_joint(scope.prefix, whole);
    const JointType* type = joint ? reading.scene.joints[joint->index()].type : nullptr;
    std::string advice = "write \"joint.coordinate\"";
    if (type != nullptr && !type->blocks.empty()) advice = "write \"" + text.text + '.' + type->blocks[0].name + '"';
    report.error(Code::unknown_coordinate, text.place, quote(whole) + " names no coordinate", advice);
    return std::nullopt;
  }
  const Place joint_place = report.document().within(text, 0, dot);
  const auto joint = reading.names.joint(whole.substr(0, dot), {scope.prefix, report, joint_place});
  if (!joint) return std::nullopt;
  const JointDescription& description = reading.scene.joints[joint->index()];
  if (description.type == nullptr) return std::nullopt;
  const std::string_view name = whole.substr(dot + 1);
  if (const auto block = find_block(*description.type, name)) return CoordinateReference{*joint, *block};
  report.error(Code::unknown_coordinate, report.document().within(text, dot + 1, name.size()),
               "joint " + quote(whole.substr(0, dot)) + " has no coordinate " + quote(name),
               coordinates_text(*description.type));
  return std::nullopt;
}

std::optional<CoordinateReference> read_scalar_coordinate(Reading& reading, Scope& scope, const ValueReader& values,
                                                          const Node& node, std::string_view what) {
  if (!values.text(node, what)) return std::nullopt;
  const auto coordinate = read_coordinate(reading, scope, values.report(), node);
  if (!coordinate) return std::nullopt;
  const Block& block = reading.scene.joints[coordinate->joint.index()].type->blocks[coordinate->block];
  if (is_scalar(block.kind)) return coordinate;
  values.report().error(
      Code::not_scalar, node.place, quote(node.text) + " is no single length or angle",
      "only coordinates with one number can stand here: take a chain of revolutes or a universal joint instead");
  return std::nullopt;
}

std::string coordinate_name(const Scene& scene, CoordinateReference coordinate) {
  const JointDescription& joint = scene.joints[coordinate.joint.index()];
  return joint.name + '.' + joint.type->blocks[coordinate.block].name;
}

std::string_view unit_of(BlockKind kind) { return kind == BlockKind::line ? "m" : "rad"; }

}  // namespace koppel

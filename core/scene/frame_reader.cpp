#include "scene/frame_reader.hpp"

#include <cmath>
#include <numbers>

#include "spatial/quaternion.hpp"
#include "spatial/rotation.hpp"

namespace koppel {
namespace {

// Two directions closer than this [rad] span no frame that means something.
constexpr double parallel = 1e-9;

/// Cosine and sine, exact at multiples of a quarter turn: "90 deg" then turns axes into axes.
Matrix3 turn_about(const Vector3& axis, double angle) {
  const double quarters = angle / (std::numbers::pi / 2.0);
  if (quarters != std::round(quarters) || std::abs(quarters) > 1e6) return rotation_about<double>(axis, angle);
  constexpr double cosines[] = {1.0, 0.0, -1.0, 0.0};
  const auto quarter = static_cast<unsigned>(static_cast<int>(quarters) & 3);
  return rotation_about<double>(axis, cosines[quarter], cosines[(quarter + 3) % 4]);
}

std::optional<Matrix3> read_turn(const ValueReader& values, const Node& node) {
  constexpr std::string_view what = "an entry of `rotate`";
  if (!values.is_list(node, what, 2, 2)) return std::nullopt;
  const auto axis = values.text(node.items[0], "the axis in `rotate`");
  const auto angle = values.number(node.items[1], "the angle in `rotate`", "rad");
  if (!axis || !angle) return std::nullopt;
  if (*axis == "x") return turn_about(Vector3::UnitX(), *angle);
  if (*axis == "y") return turn_about(Vector3::UnitY(), *angle);
  if (*axis == "z") return turn_about(Vector3::UnitZ(), *angle);
  values.report().error(Code::out_of_range, node.items[0].place, quote(*axis) + " is no axis",
                        "write \"x\", \"y\" or \"z\"; for other axes use `axis` or `quaternion`");
  return std::nullopt;
}

std::optional<Matrix3> read_turns(const ValueReader& values, const Node& node) {
  if (!node.is_list()) {
    values.wrong_kind(node, "`rotate`", "a list of turns such as [[\"x\", \"30 deg\"]]");
    return std::nullopt;
  }
  Matrix3 rotation = Matrix3::Identity();
  bool complete = true;
  for (const Node& item : node.items) {
    const auto turn = read_turn(values, item);
    complete = complete && turn;
    if (turn) rotation *= *turn;
  }
  return complete ? std::optional(rotation) : std::nullopt;
}

/// z along `axis`, x as near as possible to `x_axis` or, without it, to the x axis (y axis) of the reference.
std::optional<Matrix3> read_axes(TableReader& table) {
  const ValueReader& values = table.values();
  const Node* axis = table.find("axis");
  const Node* x_axis = table.find("x_axis");
  const auto z = axis ? values.direction(*axis, "`axis`") : std::optional(Vector3(Vector3::UnitZ()));
  const auto wish = x_axis ? values.direction(*x_axis, "`x_axis`") : std::optional(Vector3(Vector3::UnitX()));
  if (!z || !wish) return std::nullopt;
  Vector3 y = z->cross(*wish);
  if (y.norm() < parallel) {
    if (x_axis != nullptr) {
      table.report().error(Code::zero_direction, x_axis->place, "`x_axis` is parallel to the axis",
                           "give a direction across the axis, or leave `x_axis` out");
      return std::nullopt;
    }
    y = z->cross(Vector3::UnitY());
  }
  y.normalize();
  Matrix3 rotation;
  rotation << y.cross(*z), y, *z;
  return rotation;
}

std::optional<Vector3> read_origin(TableReader& table) {
  const Node* at = table.find("at");
  return at ? table.values().vector(*at, "`at`", "m") : std::optional(Vector3(Vector3::Zero()));
}

std::optional<Matrix3> read_rotation(TableReader& table) {
  if (const Node* rotate = table.find("rotate")) return read_turns(table.values(), *rotate);
  if (const Node* quaternion = table.find("quaternion")) {
    const auto q = table.values().quaternion(*quaternion, "`quaternion`");
    if (!q) return std::nullopt;
    return rotation_of_quaternion<double>(*q);
  }
  return Matrix3(Matrix3::Identity());
}

std::optional<Pose> joined(const std::optional<Matrix3>& rotation, const std::optional<Vector3>& position) {
  if (!rotation || !position) return std::nullopt;
  return Pose{*rotation, *position};
}

}  // namespace

std::optional<Pose> read_pose(TableReader& table) {
  const auto origin = read_origin(table);
  return joined(read_rotation(table), origin);
}

std::optional<Pose> read_axis_pose(TableReader& table) {
  const auto origin = read_origin(table);
  return joined(read_axes(table), origin);
}

std::optional<Attachment> read_attachment(Reading& reading, Scope& scope, TableReader& table) {
  const Node* on = table.require("on", "name the body that the frame is fixed on: on = \"ground\"");
  const auto name = on ? table.values().text(*on, "`on`") : std::nullopt;
  const auto body = name ? reading.names.body(*name, {scope.prefix, table.report(), on->place}) : std::nullopt;
  const bool has_axis = table.find("axis") != nullptr;
  const bool by_axis = table.find("x_axis") != nullptr || has_axis;
  const bool single = table.at_most_one({has_axis ? "axis" : "x_axis", "rotate", "quaternion"});
  const auto pose = by_axis ? read_axis_pose(table) : read_pose(table);
  if (!single) return std::nullopt;
  if (!body || !pose) return std::nullopt;
  return Attachment{*body, *pose};
}

std::optional<Attachment> read_attachment(Reading& reading, Scope& scope, const ValueReader& values, const Node& node,
                                          std::string_view what) {
  if (node.is_table()) {
    TableReader table(node, values);
    auto attachment = read_attachment(reading, scope, table);
    table.finish();
    return attachment;
  }
  if (!node.is_string()) {
    values.wrong_kind(node, what, "the name of a frame or body, or a description { on = \"body\", at = [0, 0, 0] }");
    return std::nullopt;
  }
  const auto fixed = reading.names.fixed(node.text, {scope.prefix, values.report(), node.place});
  if (!fixed) return std::nullopt;
  if (fixed->is_body) return Attachment{BodyId{fixed->index}, {}};
  if (reading.faulty_frames.count(fixed->index) > 0) return std::nullopt;
  return reading.scene.frames[fixed->index].on;
}

}  // namespace koppel

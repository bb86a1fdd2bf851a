#include "rewriting.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>

namespace koppel::test {
namespace {

constexpr std::string_view joint_frames[] = {"inlet", "outlet"};
constexpr std::string_view force_frames[] = {"from", "to", "against", "on"};
constexpr std::string_view elements[] = {"body", "frame", "joint", "constraint", "drive", "force"};

std::string number_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return '(' + std::string(text, end) + ')';
}

/// A number or an expression of a scene as an expression in parentheses.
std::string expression(const toml::node& node) {
  if (const auto text = node.value<std::string>()) return '(' + *text + ')';
  if (const auto number = node.value<double>()) return number_text(*number);
  throw std::runtime_error("neither a number nor an expression");
}

std::string negated(const toml::node& node) {
  std::string text = "-";
  return text += expression(node);
}

void negate(toml::table& values, std::string_view key) {
  if (const toml::node* value = values.get(key)) values.insert_or_assign(key, negated(*value));
}

toml::array list(const Eigen::Vector3d& v) { return toml::array{v.x(), v.y(), v.z()}; }

/// rotation * v + shift, of a vector of numbers and expressions; without one, of `fallback`.
toml::array moved(const toml::node* v, const Eigen::Vector3d& fallback, const Eigen::Matrix3d& rotation,
                  const Eigen::Vector3d& shift) {
  if (v == nullptr) return list(rotation * fallback + shift);
  toml::array result;
  for (int row = 0; row < 3; ++row) {
    std::string sum = number_text(shift[row]);
    for (std::size_t i = 0; i < 3; ++i) {
      sum += " + " + number_text(rotation(row, static_cast<int>(i))) + '*' + expression(*v->as_array()->get(i));
    }
    result.push_back(sum);
  }
  return result;
}

toml::array turn(std::string_view axis, double angle) { return toml::array{axis, angle}; }

/// Puts turns before (outside) the ones that a table has.
void turn_outside(toml::table& table, const Place& place) {
  toml::array turns{turn("x", place.turns.x()), turn("y", place.turns.y()), turn("z", place.turns.z())};
  if (const toml::array* own = table["rotate"].as_array()) {
    for (const toml::node& item : *own) turns.push_back(*item.as_array());
  }
  table.insert_or_assign("rotate", turns);
}

std::optional<Eigen::Vector3d> numbers(const toml::node* v) {
  Eigen::Vector3d result;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = v->as_array()->get(i)->value<double>();
    if (!number) return std::nullopt;
    result[static_cast<Eigen::Index>(i)] = *number;
  }
  return result;
}

/// What x of a frame given by `axis` comes nearest to where the scene does not say so: x, unless z lies along it.
Eigen::Vector3d default_x_axis(const toml::node* axis) {
  const auto z = axis != nullptr ? numbers(axis) : std::optional(Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
  const bool along_x = z && z->tail<2>().isZero(0);
  return along_x ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
}

/// Moves `axis` and `x_axis` of a table, and makes them explicit.
void turn_axes(toml::table& table, const Place& place) {
  const toml::node* axis = table.get("axis");
  const Eigen::Vector3d x = default_x_axis(axis);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  table.insert_or_assign("x_axis", moved(table.get("x_axis"), x, place.rotation(), none));
  table.insert_or_assign("axis", moved(table.get("axis"), Eigen::Vector3d::UnitZ(), place.rotation(), none));
}

void shift_origin(toml::table& table, const Place& place) {
  table.insert_or_assign("at", moved(table.get("at"), Eigen::Vector3d::Zero(), place.rotation(), place.shift));
}

std::string joint_of(const std::string& coordinate) { return coordinate.substr(0, coordinate.rfind('.')); }

std::string text_at(const toml::table& table, std::string_view key) { return table[key].value_or(std::string()); }

void shuffle(toml::array& array, Random& random) {
  std::vector<std::size_t> order(array.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  toml::array shuffled;
  for (const std::size_t i : order) shuffled.push_back(*array.get(i)->as_table());
  array = std::move(shuffled);
}

/// The values that `zero` and `start` give to a scalar coordinate change their sign.
void negate_coordinate(toml::table& joint, std::string_view coordinate) {
  for (const std::string_view key : {"zero", "start", "start_rate"}) {
    if (toml::table* values = joint[key].as_table()) negate(*values, coordinate);
  }
}

}  // namespace

Eigen::Matrix3d Place::rotation() const {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(turns.x(), Vector3d::UnitX()) * AngleAxisd(turns.y(), Vector3d::UnitY()) *
          AngleAxisd(turns.z(), Vector3d::UnitZ()))
      .toRotationMatrix();
}

Place random_place(Random& random) {
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi), shift(-1.0, 1.0);
  Place place;
  for (int i = 0; i < 3; ++i) place.turns[i] = angle(random);
  for (int i = 0; i < 3; ++i) place.shift[i] = shift(random);
  return place;
}

Rewriting::Rewriting(std::string_view text) {
  try {
    root_ = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(error.what());
  }
  if (root_.contains("include")) throw std::runtime_error("rewriting does not follow [[include]]");
  root_.erase("record");
}

std::string Rewriting::text() const {
  std::ostringstream stream;
  stream << root_;
  return stream.str();
}

toml::array& Rewriting::tables(std::string_view key) {
  if (!root_.contains(key)) root_.insert(key, toml::array{});
  return *root_[key].as_array();
}

template <typename Do>
void Rewriting::each(std::string_view key, Do action) {
  for (toml::node& element : tables(key)) action(*element.as_table());
}

std::map<std::string, std::string> Rewriting::rename(Random& random) {
  // Bodies and frames share their names' space; joints have one of their own.
  std::map<std::string, std::string> fixed{{"ground", "ground"}}, joints, bodies;
  std::set<std::uint64_t> used;
  const auto fresh = [&] {
    std::uint64_t number = random() % 100000;
    while (!used.insert(number).second) number = random() % 100000;
    return std::string("n").append(std::to_string(number));
  };
  const auto anew = [&](std::string_view key, auto& names) {
    each(key, [&](toml::table& element) {
      const std::string old = text_at(element, "name");
      if (old.empty()) return;
      element.insert_or_assign("name", names[old] = fresh());
    });
  };
  std::map<std::string, std::string> others;
  anew("body", bodies);
  anew("frame", fixed);
  anew("joint", joints);
  anew("constraint", others);
  anew("drive", others);
  anew("force", others);
  fixed.insert(bodies.begin(), bodies.end());

  const auto follow = [&](toml::node& node) {
    if (const auto name = node.value<std::string>()) node.ref<std::string>() = fixed.at(*name);
    if (toml::table* table = node.as_table()) table->insert_or_assign("on", fixed.at(text_at(*table, "on")));
  };
  const auto follow_coordinate = [&](toml::node& node) {
    const std::string old = node.ref<std::string>();
    node.ref<std::string>() = joints.at(joint_of(old)) + old.substr(old.rfind('.'));
  };
  const auto follow_keys = [&](toml::table& element, std::span<const std::string_view> keys) {
    for (const std::string_view key : keys) {
      if (toml::node* node = element.get(key)) follow(*node);
    }
  };
  each("frame", [&](toml::table& frame) { follow(*frame.get("on")); });
  each("joint", [&](toml::table& joint) {
    follow_keys(joint, joint_frames);
    if (toml::array* between = joint["between"].as_array()) std::for_each(between->begin(), between->end(), follow);
  });
  each("constraint", [&](toml::table& constraint) {
    follow_keys(constraint, force_frames);
    if (toml::array* of = constraint["coordinates"].as_array())
      std::for_each(of->begin(), of->end(), follow_coordinate);
  });
  each("drive", [&](toml::table& drive) { follow_coordinate(*drive.get("of")); });
  each("force", [&](toml::table& force) {
    follow_keys(force, force_frames);
    if (toml::node* of = force.get("of")) follow_coordinate(*of);
  });
  return bodies;
}

void Rewriting::reorder(Random& random) {
  for (const std::string_view key : elements) shuffle(tables(key), random);
}

/// Joints whose coordinates stand in a drive, a constraint or a force.
std::set<std::string> Rewriting::bound_joints() {
  std::set<std::string> bound;
  each("drive", [&](toml::table& drive) { bound.insert(joint_of(text_at(drive, "of"))); });
  each("force", [&](toml::table& force) { bound.insert(joint_of(text_at(force, "of"))); });
  each("constraint", [&](toml::table& constraint) {
    const toml::array* of = constraint["coordinates"].as_array();
    for (std::size_t i = 0; of != nullptr && i < of->size(); ++i) {
      bound.insert(joint_of(of->get(i)->value_or(std::string())));
    }
  });
  return bound;
}

std::size_t Rewriting::swap_joints(Random& random) {
  const std::set<std::string> bound = bound_joints();
  std::size_t swapped = 0;
  each("joint", [&](toml::table& joint) {
    if (random() % 2 == 0 || bound.count(text_at(joint, "name")) > 0) return;
    if (swap(joint)) ++swapped;
  });
  return swapped;
}

// The outlet seen from the inlet moves by T(q); with the two swapped it is T(q)^-1.
bool Rewriting::swap(toml::table& joint) {
  static const std::map<std::string, std::vector<std::string>> scalars{{"revolute", {"angle"}},
                                                                       {"prismatic", {"displacement"}},
                                                                       {"helical", {"angle"}},
                                                                       {"cylindrical", {"angle", "displacement"}},
                                                                       {"weld", {}},
                                                                       {"spherical", {}},
                                                                       {"universal", {}}};
  const std::string type = text_at(joint, "type");
  const auto known = scalars.find(type);
  if (known == scalars.end()) return false;
  if (joint.contains("limits")) throw std::runtime_error("rewriting does not know limits");
  // The angular velocity would have to be turned by where the joint starts.
  if (joint["start_rate"]["rotation"]) return false;
  for (const std::string& coordinate : known->second) negate_coordinate(joint, coordinate);
  if (toml::array* quaternion = joint["start"]["rotation"].as_array()) {
    for (std::size_t i = 1; i < 4; ++i)
      quaternion->replace(quaternion->begin() + static_cast<std::ptrdiff_t>(i), negated(*quaternion->get(i)));
  }
  if (type == "universal") swap_universal(joint);
  if (toml::array* between = joint["between"].as_array()) {
    *between = toml::array{*between->get(1)->as_string(), *between->get(0)->as_string()};
    return true;
  }
  const toml::table inlet = described(*joint.get("inlet")), outlet = described(*joint.get("outlet"));
  joint.insert_or_assign("inlet", outlet);
  joint.insert_or_assign("outlet", inlet);
  return true;
}

// T = Rz(angle1) R2(angle2) with the second axis across z. Its inverse R2(-angle2) Rz(-angle1) is such a product again
// in frames whose z lies along the second axis: those turned by C, z to axis2, where the second axis is C'z.
void Rewriting::swap_universal(toml::table& joint) {
  for (const std::string_view key : {"zero", "start", "start_rate"}) {
    toml::table* values = joint[key].as_table();
    if (values == nullptr) continue;
    toml::table swapped;
    if (const toml::node* angle = values->get("angle1")) swapped.insert("angle2", negated(*angle));
    if (const toml::node* angle = values->get("angle2")) swapped.insert("angle1", negated(*angle));
    *values = std::move(swapped);
  }
  const auto axis2 = joint.contains("axis2") ? numbers(joint.get("axis2")) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  if (joint.contains("between")) {
    const toml::array second = joint.contains("axis2") ? *joint["axis2"].as_array() : toml::array{1, 0, 0};
    const toml::array first = joint.contains("axis") ? *joint["axis"].as_array() : toml::array{0, 0, 1};
    joint.insert_or_assign("axis", second);
    joint.insert_or_assign("axis2", first);
    return;
  }
  if (!axis2 || axis2->z() != 0.0) throw std::runtime_error("rewriting knows second axes across the first only");
  for (const std::string_view side : {"inlet", "outlet"}) {
    toml::table frame = described(*joint.get(side));
    if (frame.contains("axis") || frame.contains("x_axis") || frame.contains("quaternion")) {
      throw std::runtime_error("rewriting knows frames given by `rotate` only");
    }
    toml::array turns = frame.contains("rotate") ? *frame["rotate"].as_array() : toml::array{};
    turns.push_back(turn("z", std::atan2(axis2->y(), axis2->x())));
    turns.push_back(turn("y", std::numbers::pi / 2.0));
    frame.insert_or_assign("rotate", turns);
    joint.insert_or_assign(side, frame);
  }
  joint.insert_or_assign("axis2", toml::array{-1, 0, 0});
}

toml::table Rewriting::described(const toml::node& frame) {
  if (const toml::table* table = frame.as_table()) return *table;
  const std::string name = frame.value_or(std::string());
  toml::table result{{"on", name}};
  each("frame", [&](toml::table& candidate) {
    if (text_at(candidate, "name") == name) result = candidate;
  });
  result.erase("name");
  return result;
}

void Rewriting::relocate(const Place& place) {
  toml::table& scene = *root_["scene"].as_table();
  scene.insert_or_assign("gravity", moved(scene.get("gravity"), {0, 0, -9.81}, place.rotation(), {0, 0, 0}));
  each("body", [&](toml::table& body) {
    if (body.contains("quaternion")) throw std::runtime_error("rewriting knows bodies given by `rotate` only");
    shift_origin(body, place);
    turn_outside(body, place);
  });
  // Joints and forces first: they may name frames, which must not have moved yet.
  each("joint", [&](toml::table& joint) { relocate_joint(joint, place); });
  each("force", [&](toml::table& force) { relocate_force(force, place); });
  each("frame", [&](toml::table& frame) { relocate_frame(frame, place); });
  each("constraint", [](const toml::table&) { throw std::runtime_error("rewriting does not move constraints"); });
}

void Rewriting::relocate_joint(toml::table& joint, const Place& place) {
  if (joint.contains("between")) {
    shift_origin(joint, place);
    turn_axes(joint, place);
    if (joint.contains("axis2")) {
      joint.insert_or_assign("axis2", moved(joint.get("axis2"), {1, 0, 0}, place.rotation(), {0, 0, 0}));
    }
    return;
  }
  for (const std::string_view side : {"inlet", "outlet"}) {
    toml::table frame = described(*joint.get(side));
    relocate_frame(frame, place);
    joint.insert_or_assign(side, frame);
  }
}

void Rewriting::relocate_force(toml::table& force, const Place& place) {
  for (const std::string_view key : force_frames) {
    if (!force.contains(key)) continue;
    toml::table frame = described(*force.get(key));
    relocate_frame(frame, place);
    force.insert_or_assign(key, frame);
  }
  if (text_at(force, "axes") != "world") return;
  for (const std::string_view key : {"force", "moment"}) {
    force.insert_or_assign(key, moved(force.get(key), {0, 0, 0}, place.rotation(), {0, 0, 0}));
  }
}

void Rewriting::relocate_frame(toml::table& frame, const Place& place) {
  if (text_at(frame, "on") != "ground") return;
  if (frame.contains("quaternion")) throw std::runtime_error("rewriting does not move frames given by `quaternion`");
  shift_origin(frame, place);
  if (frame.contains("axis") || frame.contains("x_axis")) {
    turn_axes(frame, place);
  } else {
    turn_outside(frame, place);
  }
}

void Rewriting::change_vendor(std::string_view vendor) {
  each("joint",
       [&](toml::table& joint) { joint.insert_or_assign("type", std::string(vendor) + '.' + text_at(joint, "type")); });
}

}  // namespace koppel::test

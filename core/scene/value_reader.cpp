#include "scene/value_reader.hpp"

#include <cmath>
#include <cstdio>

namespace koppel {
namespace {

// Shorter than any length that means something, in metres or as a quaternion.
constexpr double no_length = 1e-12;
// Longer than any mechanism [m].
constexpr double longest = 1e9;

/// Unit of length one, without overflow for large components.
template <typename V>
std::optional<V> normalised(const V& v) {
  const double greatest = v.cwiseAbs().maxCoeff();
  if (!(greatest > no_length)) return std::nullopt;
  return V((v / greatest).normalized());
}

bool is_base_unit(std::string_view unit) { return unit == "m" || unit == "rad" || unit == "s" || unit == "kg"; }

/// Whether the unit is this base unit, or the base unit stands first in it, as m in m/rad.
bool begins_with_unit(std::string_view unit, std::string_view base) {
  if (unit.substr(0, base.size()) != base) return false;
  return unit.size() == base.size() || unit[base.size()] == '/' || unit[base.size()] == ' ';
}

/// What to write where a direction is expected.
std::string_view direction_advice(const Node& node) {
  if (node.is_string() && node.text == "x") return "write [1, 0, 0]";
  if (node.is_string() && node.text == "y") return "write [0, 1, 0]";
  if (node.is_string() && node.text == "z") return "write [0, 0, 1]";
  return "write all three components: [x, y, z]";
}

}  // namespace

std::string count_text(std::size_t count_min, std::size_t count_max) {
  if (count_min == count_max) return std::to_string(count_min);
  if (count_max == unbounded) return "at least " + std::to_string(count_min);
  return std::to_string(count_min) + " to " + std::to_string(count_max);
}

std::string number_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

void ValueReader::wrong_kind(const Node& node, std::string_view what, std::string_view expected,
                             std::string_view advice) const {
  report_.error(Code::wrong_kind, node.place,
                std::string(what) + " takes " + std::string(expected) + ", not " + std::string(kind_name(node.kind)),
                std::string(advice));
}

bool ValueReader::fits(const Node& string, std::string_view what, std::string_view unit) const {
  const std::string_view own = quantity_unit(string.text);
  if (unit.empty() || own.empty() || begins_with_unit(unit, own)) return true;
  report_.error(Code::wrong_kind, string.place,
                std::string(what) + " is measured in " + std::string(unit) + ", not in " + std::string(own),
                is_base_unit(unit) ? "write a quantity in " + std::string(unit) + ", or a plain number"
                                   : "write a plain number, in " + std::string(unit));
  return false;
}

std::optional<double> ValueReader::within_reach(double value, const Node& node, std::string_view what,
                                                std::string_view unit) const {
  const bool is_length = unit == "m" || (node.is_string() && quantity_unit(node.text) == "m");
  if (!is_length || std::abs(value) <= longest) return value;
  report_.error(
      Code::out_of_range, node.place,
      std::string(what) + " must lie within " + number_text(longest) + " m, and is " + number_text(value) + " m",
      "check the number and its unit: plain numbers are metres, \"120 mm\" is 0.12");
  return std::nullopt;
}

std::optional<double> ValueReader::number(const Node& node, std::string_view what, std::string_view unit) const {
  if (node.is_string()) {
    const auto value = fits(node, what, unit) ? parameters_->evaluate(node, report_) : std::nullopt;
    return value ? within_reach(*value, node, what, unit) : std::nullopt;
  }
  if (!node.is_number()) {
    wrong_kind(node, what, "a number");
    return std::nullopt;
  }
  if (!std::isfinite(node.number)) {
    report_.error(Code::not_finite, node.place, std::string(what) + " must be finite", "write a finite number");
    return std::nullopt;
  }
  return within_reach(node.number, node, what, unit);
}

std::optional<double> ValueReader::positive(const Node& node, std::string_view what, std::string_view unit) const {
  const auto value = number(node, what, unit);
  if (!value || *value > 0.0) return value;
  report_.error(Code::out_of_range, node.place,
                std::string(what) + " must be greater than 0, and is " + number_text(*value));
  return std::nullopt;
}

bool ValueReader::is_whole(double value, const Node& node, std::string_view what) const {
  if (value == std::floor(value)) return true;
  report_.error(Code::wrong_kind, node.place, std::string(what) + " takes whole numbers, not " + number_text(value));
  return false;
}

bool ValueReader::is_list(const Node& node, std::string_view what, std::size_t count_min, std::size_t count_max,
                          std::string_view advice) const {
  if (!node.is_list()) {
    wrong_kind(node, what, "a list of " + count_text(count_min, count_max), advice);
    return false;
  }
  if (node.items.size() >= count_min && node.items.size() <= count_max) return true;
  report_.error(Code::wrong_count, node.place,
                std::string(what) + " takes " + count_text(count_min, count_max) + " entries, not " +
                    std::to_string(node.items.size()),
                std::string(advice));
  return false;
}

std::optional<std::vector<double>> ValueReader::numbers(const Node& node, std::string_view what, std::size_t count_min,
                                                        std::size_t count_max, std::string_view unit,
                                                        std::string_view advice) const {
  if (!is_list(node, what, count_min, count_max, advice)) return std::nullopt;
  std::vector<double> values;
  for (const Node& item : node.items) {
    if (const auto value = number(item, what, unit)) values.push_back(*value);
  }
  if (values.size() != node.items.size()) return std::nullopt;
  return values;
}

std::optional<Vector3> ValueReader::vector(const Node& node, std::string_view what, std::string_view unit) const {
  const auto values = numbers(node, what, 3, 3, unit, "write all three components: [x, y, z]");
  if (!values) return std::nullopt;
  return Vector3((*values)[0], (*values)[1], (*values)[2]);
}

std::optional<Vector3> ValueReader::direction(const Node& node, std::string_view what) const {
  const auto given = numbers(node, what, 3, 3, "", direction_advice(node));
  if (!given) return std::nullopt;
  auto unit = normalised(Vector3((*given)[0], (*given)[1], (*given)[2]));
  if (!unit) {
    report_.error(Code::zero_direction, node.place, std::string(what) + " has no length, so it has no direction",
                  "write a vector of any length but zero");
  }
  return unit;
}

std::optional<Vector4> ValueReader::quaternion(const Node& node, std::string_view what) const {
  const auto values = numbers(node, what, 4, 4);
  if (!values) return std::nullopt;
  auto unit = normalised(Vector4((*values)[0], (*values)[1], (*values)[2], (*values)[3]));
  if (!unit) {
    report_.error(Code::zero_direction, node.place, std::string(what) + " has no length, so it is no rotation",
                  "write [w, x, y, z]; [1, 0, 0, 0] turns nothing");
  }
  return unit;
}

std::optional<std::string> ValueReader::text(const Node& node, std::string_view what) const {
  if (node.is_string()) return node.text;
  wrong_kind(node, what, "a string");
  return std::nullopt;
}

std::optional<bool> ValueReader::truth(const Node& node, std::string_view what) const {
  if (node.kind == Node::Kind::boolean) return node.truth;
  wrong_kind(node, what, "true or false");
  return std::nullopt;
}

}  // namespace koppel

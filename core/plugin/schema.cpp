#include "plugin/schema.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "plugin/library.hpp"

namespace koppel {

tl::unexpected<Error> Subject::malformed(const std::string& what, std::string advice) const {
  return tl::make_unexpected(plugin_error(Code::plugin_malformed, origin, type + ": " + what, std::move(advice)));
}

bool is_identifier(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return !name.empty() && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), [&](char c) { return is_letter(c) || is_digit(c); });
}

namespace {

/// A name that differs from those of the elements before it.
template <typename Element>
Result<std::string> read_name(const Subject& subject, const char* name, const std::vector<Element>& before,
                              const std::string& what) {
  if (name == nullptr) return subject.malformed(what + ": name is NULL");
  if (!is_identifier(name)) {
    return subject.malformed(what + ": `" + name + "` is no name",
                             "use lower-case letters, digits and underscores, a digit not first");
  }
  if (std::any_of(before.begin(), before.end(), [name](const Element& e) { return e.name == name; })) {
    return subject.malformed(what + ": the name `" + name + "` stands twice");
  }
  return std::string(name);
}

/// How many numbers a fallback has.
std::size_t fallback_count(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::real:
    case ParameterKind::integer:
    case ParameterKind::boolean: return parameter.count_min;
    case ParameterKind::vector:
    case ParameterKind::direction: return 3;
    case ParameterKind::table: return parameter.count_min * parameter.columns;
    case ParameterKind::string:
    case ParameterKind::frame:
    case ParameterKind::coordinates: return 0;
  }
  return 0;
}

/// Number of entries, or of rows, and what follows from the kind.
Result<void> read_counts(const Subject& subject, const koppel_parameter& from, PluginKind kind, Parameter& parameter) {
  const std::string what = "parameter `" + parameter.name + '`';
  constexpr std::uint32_t implausible = 1 << 16;
  const bool table = parameter.kind == ParameterKind::table;
  const bool counted = table || parameter.kind == ParameterKind::real || parameter.kind == ParameterKind::integer ||
                       parameter.kind == ParameterKind::coordinates;
  if (table) {
    if (from.columns == 0 || from.columns > implausible) {
      return subject.malformed(what + ": a table with columns = " + std::to_string(from.columns));
    }
    parameter.columns = from.columns;
  }
  if (counted && from.count_max != 0) {
    if (from.count_min > from.count_max || from.count_min > implausible) {
      return subject.malformed(what + ": count_min is " + std::to_string(from.count_min) + " and count_max " +
                               std::to_string(from.count_max));
    }
    parameter.count_min = from.count_min;
    parameter.count_max = from.count_max;
  } else if (table) {
    parameter.count_min = std::min(from.count_min, implausible);
    parameter.count_max = std::numeric_limits<std::size_t>::max();
  }
  const bool acts_on = parameter.kind == ParameterKind::frame || parameter.kind == ParameterKind::coordinates;
  if (acts_on && kind != PluginKind::constraint && kind != PluginKind::force) {
    return subject.malformed(what + ": frames and coordinates are for constraints and forces only");
  }
  if (parameter.kind == ParameterKind::direction && kind != PluginKind::joint) {
    return subject.malformed(what + ": directions are for joints only", "use a vector");
  }
  return {};
}

Result<void> read_bounds(const Subject& subject, const koppel_parameter& from, Parameter& parameter) {
  const std::string what = "parameter `" + parameter.name + '`';
  if (from.minimum != nullptr) parameter.minimum = *from.minimum;
  if (from.maximum != nullptr) parameter.maximum = *from.maximum;
  const double least = parameter.minimum.value_or(-std::numeric_limits<double>::infinity());
  const double greatest = parameter.maximum.value_or(std::numeric_limits<double>::infinity());
  if (!(least <= greatest)) return subject.malformed(what + ": minimum does not lie below maximum");
  if (from.fallback == nullptr || fallback_count(parameter) == 0) return {};
  parameter.fallback.emplace(from.fallback, from.fallback + fallback_count(parameter));
  for (const double value : *parameter.fallback) {
    if (!std::isfinite(value) || value < least || value > greatest) {
      return subject.malformed(what + ": fallback " + std::to_string(value) + " is not finite or out of range");
    }
  }
  return {};
}

}  // namespace

Result<std::vector<Parameter>> read_parameters(const Subject& subject, const koppel_type& type, PluginKind kind) {
  KOPPEL_TRY(const auto table, read_array(subject, type.parameters, type.parameter_count,
                                          size_through(&koppel_parameter::maximum), "parameter"));
  std::vector<Parameter> out;
  for (const koppel_parameter& from : table) {
    const std::string what = "parameter " + std::to_string(out.size());
    Parameter parameter;
    KOPPEL_TRY(parameter.name, read_name(subject, from.name, out, what));
    if (from.kind < KOPPEL_PARAMETER_REAL || from.kind > KOPPEL_PARAMETER_COORDINATES) {
      return subject.malformed("parameter `" + parameter.name + "`: kind is " + std::to_string(from.kind) +
                               ", which is none of KOPPEL_PARAMETER_...");
    }
    parameter.kind = static_cast<ParameterKind>(from.kind);
    parameter.unit = from.unit != nullptr ? from.unit : "";
    parameter.doc = from.doc != nullptr ? from.doc : "";
    parameter.required = from.required != 0;
    KOPPEL_CHECK(read_counts(subject, from, kind, parameter));
    KOPPEL_CHECK(read_bounds(subject, from, parameter));
    out.push_back(std::move(parameter));
  }
  return out;
}

Result<std::vector<Block>> read_blocks(const Subject& subject, const koppel_coordinate* first, std::size_t count) {
  KOPPEL_TRY(const auto table, read_array(subject, first, count, size_through(&koppel_coordinate::name), "coordinate"));
  std::vector<Block> out;
  for (const koppel_coordinate& from : table) {
    Block block;
    KOPPEL_TRY(block.name, read_name(subject, from.name, out, "coordinate " + std::to_string(out.size())));
    if (from.kind < KOPPEL_BLOCK_LINE || from.kind > KOPPEL_BLOCK_UNIT_VECTOR) {
      return subject.malformed("coordinate `" + block.name + "`: kind is " + std::to_string(from.kind) +
                               ", which is none of KOPPEL_BLOCK_...");
    }
    block.kind = static_cast<BlockKind>(from.kind);
    out.push_back(std::move(block));
  }
  return out;
}

Result<std::vector<Row>> read_rows(const Subject& subject, const koppel_row* first, std::size_t count) {
  KOPPEL_TRY(const auto table, read_array(subject, first, count, size_through(&koppel_row::unit), "row"));
  std::vector<Row> out;
  for (const koppel_row& from : table) {
    Row row;
    KOPPEL_TRY(row.name, read_name(subject, from.name, out, "row " + std::to_string(out.size())));
    if (from.unit == nullptr) return subject.malformed("row `" + row.name + "`: unit is NULL");
    row.unit = from.unit;
    out.push_back(std::move(row));
  }
  return out;
}

Result<std::vector<InternalState>> read_states(const Subject& subject, const koppel_internal_state* first,
                                               std::size_t count) {
  KOPPEL_TRY(const auto table, read_array(subject, first, count, size_through(&koppel_internal_state::unit), "state"));
  std::vector<InternalState> out;
  for (const koppel_internal_state& from : table) {
    InternalState state;
    KOPPEL_TRY(state.name, read_name(subject, from.name, out, "state " + std::to_string(out.size())));
    if (from.unit == nullptr) return subject.malformed("state `" + state.name + "`: unit is NULL");
    state.unit = from.unit;
    out.push_back(std::move(state));
  }
  return out;
}

}  // namespace koppel

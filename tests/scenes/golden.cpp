#include "golden.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include <toml++/toml.h>

#include "folders.hpp"
#include "model.hpp"

namespace koppel::test {
namespace {

template <typename T>
T as(const toml::node* node) {
  const auto value = node != nullptr ? node->value<T>() : std::nullopt;
  if (!value) throw std::runtime_error("golden.toml: a value is missing or of another kind");
  return *value;
}

const toml::array& rows(const toml::table& table, std::string_view key) {
  static const toml::array none;
  const toml::array* array = table[key].as_array();
  return array != nullptr ? *array : none;
}

std::vector<double> numbers(const toml::node* node) {
  std::vector<double> values;
  if (const toml::array* list = node->as_array()) {
    for (const toml::node& item : *list) values.push_back(as<double>(&item));
  } else {
    values.push_back(as<double>(node));
  }
  return values;
}

Facts read_facts(const toml::array& row) {
  const auto count = [&row](std::size_t column) {
    return static_cast<std::uint32_t>(as<std::int64_t>(row.get(column)));
  };
  Facts facts;
  facts.scene = as<std::string>(row.get(0));
  facts.bodies = count(1);
  facts.joints = count(2);
  facts.loops = count(3);
  facts.freedoms = count(4);
  facts.count = static_cast<std::int32_t>(as<std::int64_t>(row.get(5)));
  facts.rank = count(6);
  facts.mobility = static_cast<std::int32_t>(as<std::int64_t>(row.get(7)));
  facts.closes = as<bool>(row.get(8));
  return facts;
}

/// [coordinate, value, unit], or [coordinate, rate].
Setting read_setting(const toml::array& row) {
  Setting setting{as<std::string>(row.get(0)), numbers(row.get(1))};
  if (row.size() > 2 && as<std::string>(row.get(2)) == "deg") {
    for (double& value : setting.values) value *= std::numbers::pi / 180.0;
  }
  return setting;
}

std::vector<Setting> read_settings(const toml::table& table, std::string_view key) {
  std::vector<Setting> settings;
  for (const toml::node& row : rows(table, key)) settings.push_back(read_setting(*row.as_array()));
  return settings;
}

Expectation read_expectation(const toml::array& row) {
  return {as<std::string>(row.get(0)), as<std::string>(row.get(1)), as<std::string>(row.get(3)), numbers(row.get(2)),
          static_cast<int>(as<std::int64_t>(row.get(4)))};
}

Case read_case(const toml::table& table) {
  Case result;
  result.scene = as<std::string>(table.get("scene"));
  result.source = as<std::string>(table.get("source"));
  result.closes = table["closes"].value_or(true);
  result.inputs = read_settings(table, "inputs");
  if (table.contains("start")) result.start = read_settings(table, "start");
  result.speeds = read_settings(table, "speeds");
  for (const toml::node& row : rows(table, "expect")) result.expect.push_back(read_expectation(*row.as_array()));
  return result;
}

Variant read_variant(const toml::table& table) {
  Variant variant{as<std::string>(table.get("name")), as<std::string>(table.get("of")), {}};
  for (const toml::node& row : rows(table, "replace")) {
    variant.replace.emplace_back(as<std::string>(row.as_array()->get(0)), as<std::string>(row.as_array()->get(1)));
  }
  return variant;
}

/// "rstr_3_crank_angle_30": scene, number of the case among those of the scene, and the inputs as printed.
std::string name_of(const toml::table& table, std::size_t number) {
  std::string name = as<std::string>(table.get("scene")) + ' ' + std::to_string(number);
  for (const toml::node& row : rows(table, "inputs")) {
    const toml::array& input = *row.as_array();
    const double value = as<double>(input.get(1));
    name += ' ' + as<std::string>(input.get(0)) + (value < 0 ? " minus " : " ");
    name += std::to_string(std::abs(value)).substr(0, 6);
  }
  return test_name(name);
}

std::size_t replace_all(std::string& text, const std::string& from, const std::string& to) {
  std::size_t count = 0;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
    ++count;
  }
  return count;
}

}  // namespace

const Facts& Golden::facts(const std::string& scene) const {
  const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const Facts& row) { return row.scene == scene; });
  if (found == scenes.end()) throw std::runtime_error("golden.toml: no facts about " + scene);
  return *found;
}

std::string Golden::text(const std::string& scene) const {
  const auto variant =
      std::find_if(variants.begin(), variants.end(), [&](const Variant& entry) { return entry.name == scene; });
  if (variant == variants.end()) {
    const std::string beside = tests_folder() + "/scenes/" + scene + ".toml";
    return std::filesystem::exists(beside) ? read_text(beside) : shipped_scene(scene);
  }
  std::string result = text(variant->of);
  for (const auto& [from, to] : variant->replace) {
    if (replace_all(result, from, to) == 0) throw std::runtime_error(variant->of + " does not hold: " + from);
  }
  return result;
}

Golden read_golden() {
  Golden golden;
  try {
    const toml::table root = toml::parse_file(tests_folder() + "/scenes/golden.toml");
    for (const toml::node& row : rows(root, "scene")) golden.scenes.push_back(read_facts(*row.as_array()));
    for (const toml::node& entry : rows(root, "variant")) golden.variants.push_back(read_variant(*entry.as_table()));
    for (const toml::node& entry : rows(root, "case")) {
      Case next = read_case(*entry.as_table());
      const auto number = std::count_if(golden.cases.begin(), golden.cases.end(),
                                        [&](const Case& other) { return other.scene == next.scene; });
      next.name = name_of(*entry.as_table(), static_cast<std::size_t>(number) + 1);
      golden.cases.push_back(std::move(next));
    }
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(std::string("golden.toml: ") + error.what());
  }
  return golden;
}

}  // namespace koppel::test

#include "scene/scene_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace koppel {

void SceneParameters::read(const Node* table, const ParameterOverrides& overrides, const Reporter& report) {
  if (table == nullptr) return;
  if (!table->is_table()) {
    report.error(Code::wrong_kind, table->place, "[parameters] is " + std::string(kind_name(table->kind)),
                 "write a table: [parameters], then lines `name = value`");
    return;
  }
  collect(*table, overrides, report);
  connect();
  // Those that need nothing first, then those that need only what is computed.
  std::map<std::string, std::size_t> open;
  std::vector<std::string> ready;
  for (const auto& [name, definition] : definitions_) {
    if (definition.needs.empty()) {
      ready.push_back(name);
    } else {
      open[name] = definition.needs.size();
    }
  }
  while (!ready.empty()) {
    const std::string name = std::move(ready.back());
    ready.pop_back();
    Definition& definition = definitions_.at(name);
    compute(definition, name, overrides, report);
    for (const std::string& user : definition.users) {
      if (--open.at(user) > 0) continue;
      open.erase(user);
      ready.push_back(user);
    }
  }
  report_cycles(open, report);
}

void SceneParameters::collect(const Node& table, const ParameterOverrides& overrides, const Reporter& report) {
  const auto refuse = [this](std::string_view name) {
    for (std::string& word : names_in(name)) refused_.insert(std::move(word));
  };
  for (std::size_t i = 0; i < table.keys.size(); ++i) {
    const auto& [name, place] = table.keys[i];
    if (!is_parameter_name(name)) {
      refuse(name);
      report.error(Code::bad_name, place, quote(name) + " cannot be the name of a parameter",
                   "use letters, digits and underscores: in an expression a hyphen means minus");
      continue;
    }
    if (const std::string_view word = reserved_word(name); !word.empty()) {
      refuse(name);
      report.error(Code::bad_name, place, quote(name) + " is " + std::string(word) + " in expressions",
                   "give the parameter another name");
      continue;
    }
    Definition& definition = definitions_[name];
    definition.value = &table.items[i];
    definition.place = place;
    definition.overridden = overrides.count(name) > 0;
  }
}

void SceneParameters::connect() {
  for (auto& [name, definition] : definitions_) {
    if (!definition.value->is_string()) continue;
    for (std::string& word : names_in(definition.value->text)) {
      const auto found = definitions_.find(word);
      if (found == definitions_.end()) continue;
      found->second.used = true;
      if (definition.overridden) continue;
      if (definition.needs.insert(std::move(word)).second) found->second.users.push_back(name);
    }
  }
}

void SceneParameters::compute(Definition& definition, const std::string& name, const ParameterOverrides& overrides,
                              const Reporter& report) {
  const Node& node = *definition.value;
  std::optional<double> value;
  if (definition.overridden) {
    value = overrides.at(name);
  } else if (node.is_string()) {
    value = evaluate(node, report);
  } else if (!node.is_number()) {
    report.error(Code::wrong_kind, node.place, "a parameter is a number, not " + std::string(kind_name(node.kind)),
                 "write a number, a quantity such as \"30 deg\" or an expression");
  } else if (!std::isfinite(node.number)) {
    report.error(Code::not_finite, node.place, quote(name) + " is not a finite number");
  } else {
    value = node.number;
  }
  if (!value) return;
  calculator_.define(name, *value);
  definition.usable = true;
}

void SceneParameters::report_cycles(const std::map<std::string, std::size_t>& open, const Reporter& report) const {
  std::set<std::string> seen;
  for (const auto& [start, count] : open) {
    // From any open parameter, what it waits for leads into a cycle, perhaps one that is reported already.
    std::vector<std::string> path;
    std::string name = start;
    while (seen.insert(name).second) {
      path.push_back(name);
      const auto& needs = definitions_.at(name).needs;
      name = *std::find_if(needs.begin(), needs.end(), [&open](const std::string& n) { return open.count(n) > 0; });
    }
    const auto begin = std::find(path.begin(), path.end(), name);
    if (begin == path.end()) continue;
    std::string chain;
    for (auto i = begin; i != path.end(); ++i) chain += quote(*i) + " needs ";
    report.error(Code::parameter_cycle, definitions_.at(name).value->place,
                 "parameters define each other: " + chain + quote(name), "give one of them a number");
  }
}

std::optional<double> SceneParameters::evaluate(const Node& string, const Reporter& report) {
  bool usable = true, refused = false;
  for (const std::string& word : names_in(string.text)) {
    refused = refused || refused_.count(word) > 0;
    const auto found = definitions_.find(word);
    if (found == definitions_.end()) continue;
    found->second.used = true;
    usable = usable && found->second.usable;
  }
  if (!usable) return std::nullopt;
  const auto value = calculator_.evaluate(string.text);
  if (value) return *value;
  if (refused) return std::nullopt;
  const ExpressionFault& fault = value.error();
  report.error(fault.code, report.document().within(string, fault.offset, fault.length), fault.message, fault.advice);
  return std::nullopt;
}

std::vector<std::string> SceneParameters::names() const {
  std::vector<std::string> names;
  for (const auto& [name, definition] : definitions_) names.push_back(name);
  return names;
}

void SceneParameters::report_unused(const Reporter& report) const {
  for (const auto& [name, definition] : definitions_) {
    if (definition.used || definition.overridden) continue;
    report.warning(Code::unused_parameter, definition.place, "parameter " + quote(name) + " is not used",
                   "remove it, or use it in an expression");
  }
}

}  // namespace koppel

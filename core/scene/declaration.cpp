// Finds all elements of a file, checks their names and makes room for their descriptions.
#include "scene/reading.hpp"

namespace koppel {
namespace {

/// How one kind of element is taken in.
struct Kind {
  const char* key;
  bool needs_name;
  std::vector<Element>& elements;
};

std::string read_name(Names& names, const Scope& scope, const Reporter& report, const Node& table, const Kind& kind) {
  const Node* node = table.find("name");
  if (node == nullptr) {
    if (kind.needs_name) {
      report.error(Code::missing_key, table.place, "`name` is missing",
                   "give the " + std::string(kind.key) + " a name: name = \"...\"");
    }
    return {};
  }
  if (!node->is_string()) {
    report.error(Code::wrong_kind, node->place, "`name` takes a string, not " + std::string(kind_name(node->kind)));
    return {};
  }
  if (is_element_name(node->text)) return scope.prefix + node->text;
  names.refuse(scope.prefix + node->text);
  report.error(Code::bad_name, node->place, quote(node->text) + " cannot be a name",
               "begin with a letter or underscore and go on with letters, digits, underscores and hyphens");
  return {};
}

/// Calls add(element, source), which makes room in the scene and tells whether the name is free.
template <typename Add>
void declare(Reading& reading, Scope& scope, const Kind& kind, Add add) {
  const Node* list = scope.document->root().find(kind.key);
  if (list == nullptr) return;
  const std::string key = kind.key;
  const Reporter general = reading.reporter(scope, "");
  if (!list->is_list()) {
    general.error(Code::wrong_kind, list->place, quote(key) + " is a list of tables",
                  "write [[" + key + "]] for each element");
    return;
  }
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    const Node& table = list->items[i];
    if (!table.is_table()) {
      general.error(Code::wrong_kind, table.place, quote(key) + " is a list of tables", "write [[" + key + "]]");
      continue;
    }
    Element element;
    element.scope = &scope;
    element.table = &table;
    element.name =
        read_name(reading.names, scope, reading.reporter(scope, key + ' ' + std::to_string(i + 1)), table, kind);
    element.label = key + ' ' + (element.name.empty() ? std::to_string(i + 1) : element.name);
    if (!add(element, scope.document->source(table.place)) && !element.name.empty()) {
      reading.reporter(scope, element.label)
          .error(Code::duplicate_name, table.find("name")->place, "the name " + quote(element.name) + " is taken",
                 element.name == "ground" ? "`ground` is always there" : "choose another name");
    }
    kind.elements.push_back(std::move(element));
  }
}

/// Appends an element of that name to a list of the scene.
template <typename Description>
Description& append(std::vector<Description>& list, Element& element) {
  element.index = list.size();
  list.emplace_back();
  list.back().name = element.name;
  return list.back();
}

}  // namespace

void declare_elements(Reading& reading, Scope& scope) {
  Scene& scene = reading.scene;
  Names& names = reading.names;
  declare(reading, scope, {"body", true, reading.bodies}, [&](Element& element, Source source) {
    append(scene.bodies, element).source = std::move(source);
    return names.add_body(element.name, BodyId{static_cast<std::uint32_t>(element.index)});
  });
  declare(reading, scope, {"frame", true, reading.frames}, [&](Element& element, Source source) {
    append(scene.frames, element).source = std::move(source);
    return names.add_frame(element.name, FrameId{static_cast<std::uint32_t>(element.index)});
  });
  declare(reading, scope, {"joint", true, reading.joints}, [&](Element& element, Source source) {
    append(scene.joints, element).source = std::move(source);
    reading.starts.emplace_back();
    return names.add_joint(element.name, JointId{static_cast<std::uint32_t>(element.index)});
  });
  declare(reading, scope, {"constraint", true, reading.constraints}, [&](Element& element, Source source) {
    append(scene.constraints, element).source = std::move(source);
    return reading.constraint_names.insert(element.name).second;
  });
  declare(reading, scope, {"force", true, reading.forces}, [&](Element& element, Source source) {
    append(scene.forces, element).source = std::move(source);
    return reading.force_names.insert(element.name).second;
  });
  declare(reading, scope, {"drive", false, reading.drives}, [&](Element& element, Source source) {
    append(scene.drives, element).source = std::move(source);
    return reading.drive_names.insert(element.name).second;
  });
  declare(reading, scope, {"watch", false, reading.watches}, [&](Element& element, Source) {
    append(scene.watches, element);
    return element.name.empty() || reading.watch_names.insert(element.name).second;
  });
  declare(reading, scope, {"record", false, reading.records}, [&](Element& element, Source) {
    append(scene.records, element);
    return element.name.empty() || reading.record_names.insert(element.name).second;
  });
}

}  // namespace koppel

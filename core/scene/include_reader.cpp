// Files: the scene itself, and what it includes.
#include <algorithm>
#include <exception>
#include <fstream>
#include <system_error>

#include "scene/reading.hpp"

namespace koppel {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes = std::size_t{1} << 26;
// Files that include one another twice each grow like powers of two.
constexpr std::size_t most_scopes = 1000;

/// Whether the document is written in this version of the language; nothing else is looked at if it is not.
bool check_schema(const Scope& scope, const Reporter& report) {
  const Node* schema = scope.document->root().find("schema");
  if (schema == nullptr) {
    report.error(Code::unknown_schema, {1, 1, 1},
                 "the scene does not say which version of the language it is written in", "begin with `schema = 1`");
    return true;
  }
  if (schema->is_number() && schema->number == 1.0) return true;
  report.error(Code::unknown_schema, schema->place, "this version of koppel reads schema 1 only", "write `schema = 1`");
  return false;
}

void check_tables(const Node& root, const Reporter& report) {
  const std::vector<std::string> tables = {"schema", "scene",  "parameters", "simulation", "body",
                                           "frame",  "joint",  "constraint", "force",      "drive",
                                           "watch",  "record", "include"};
  for (const Node::Key& key : root.keys) {
    if (std::find(tables.begin(), tables.end(), key.text) != tables.end()) continue;
    std::string advice = did_you_mean(key.text, tables);
    if (advice.empty()) advice = "values of your own go into [parameters]";
    report.error(Code::unknown_table, key.place, quote(key.text) + " is no part of a scene", std::move(advice));
  }
}

/// `parameters` of an [[include]]: expressions of the including scene, for names that the included one defines.
ParameterOverrides read_overrides(TableReader& table, const Node* definitions) {
  ParameterOverrides overrides;
  const Node* given = table.find("parameters");
  if (given == nullptr) return overrides;
  if (!given->is_table()) {
    table.values().wrong_kind(*given, "`parameters`", "a table { name = value }");
    return overrides;
  }
  const auto known = [&] {
    std::vector<std::string> names;
    if (definitions == nullptr) return names;
    for (const Node::Key& key : definitions->keys) names.push_back(key.text);
    return names;
  }();
  for (std::size_t i = 0; i < given->keys.size(); ++i) {
    const Node::Key& name = given->keys[i];
    overrides[name.text] = table.values().number(given->items[i], quote(name.text));
    if (std::find(known.begin(), known.end(), name.text) != known.end()) continue;
    std::string advice = did_you_mean(name.text, known);
    if (advice.empty()) advice = "define it in [parameters] of the included scene";
    table.report().error(Code::unknown_parameter, name.place, "the included scene has no parameter " + quote(name.text),
                         std::move(advice));
  }
  return overrides;
}

std::string read_prefix(TableReader& table) {
  const Node* node = table.find("prefix");
  const auto prefix = node ? table.values().text(*node, "`prefix`") : std::nullopt;
  if (!prefix) return {};
  if (is_element_name(*prefix)) return *prefix + '.';
  table.report().error(Code::bad_name, node->place, quote(*prefix) + " cannot be a prefix",
                       "begin with a letter and use letters, digits, underscores and hyphens; the dot is added");
  return {};
}

/// Whether the names of another included scene begin with this prefix.
bool is_taken(const Reading& reading, const std::string& prefix) {
  return std::any_of(reading.scopes.begin(), reading.scopes.end(),
                     [&prefix](const auto& scope) { return scope->prefix == prefix; });
}

/// Where a file lies, without links and dots. Errors: file_unreadable.
Result<fs::path> locate(const fs::path& file, const fs::path& folder) {
  if (file.is_relative() && folder.empty()) {
    return tl::make_unexpected(Error{Code::file_unreadable,
                                     Severity::error,
                                     {},
                                     "",
                                     "a scene from a text has no folder that " + quote(file.string()) + " could be in",
                                     "give the folder with the text, or write an absolute file name"});
  }
  std::error_code fault;
  fs::path found = fs::canonical(folder / file, fault);
  if (!fault) return found;
  return tl::make_unexpected(Error{Code::file_unreadable,
                                   Severity::error,
                                   {},
                                   "",
                                   (folder / file).string() + ": " + fault.message(),
                                   "file names are relative to the folder of the scene that includes"});
}

/// The name of an included file for findings: beside the name of the file that includes it.
std::string shown_name(const Scope& scope, const fs::path& file) {
  return file.is_absolute() ? file.string() : (fs::path(scope.document->name()).parent_path() / file).string();
}

/// False if the file could not be taken in; that has been reported, and its names are unknown.
bool read_include(Reading& reading, Scope& scope, TableReader& table, const std::string& prefix,
                  const std::vector<fs::path>& ancestors) {
  const Node* node = table.require("file", "name the scene that is taken in: file = \"suspension.toml\"");
  const auto file = node ? table.values().text(*node, "`file`") : std::nullopt;
  if (!file) return false;
  const auto refuse = [&](Error error) {
    table.report().error(std::move(error), node->place);
    return false;
  };
  auto path = locate(*file, scope.folder);
  if (!path) return refuse(path.error());
  if (std::find(ancestors.begin(), ancestors.end(), *path) != ancestors.end()) {
    table.report().error(Code::include_cycle, node->place, quote(*file) + " includes itself in the end",
                         "remove the [[include]] that closes the circle");
    return false;
  }
  if (reading.scopes.size() >= most_scopes) {
    table.report().error(Code::out_of_range, node->place,
                         "the scene takes in more than " + std::to_string(most_scopes) + " files");
    return false;
  }
  auto text = read_text_file(*path);
  if (!text) return refuse(text.error());
  auto document = Document::parse(std::move(*text), shown_name(scope, *file));
  if (!document) {
    reading.findings.add(document.error());
    return false;
  }
  const Node* definitions = (*document)->root().find("parameters");
  const ParameterOverrides overrides = read_overrides(table, definitions);
  std::vector<fs::path> lineage = ancestors;
  lineage.push_back(*path);
  return read_scope(reading, std::move(*document), path->parent_path(), prefix, overrides, lineage) != nullptr;
}

void read_includes(Reading& reading, Scope& scope, const std::vector<fs::path>& ancestors) {
  const Node* includes = scope.document->root().find("include");
  if (includes == nullptr) return;
  if (!includes->is_list()) {
    reading.reporter(scope, "").error(Code::wrong_kind, includes->place, "`include` is a list of tables",
                                      "write [[include]]");
    return;
  }
  for (const Node& item : includes->items) {
    if (!item.is_table()) {
      reading.values(scope, "").wrong_kind(item, "`include`", "tables");
      continue;
    }
    TableReader table(item, reading.values(scope, "include"));
    const std::string own_prefix = read_prefix(table);
    const std::string prefix = scope.prefix + own_prefix;
    table.find("file");
    table.find("parameters");
    if (!own_prefix.empty() && is_taken(reading, prefix)) {
      const Node& node = *table.find("prefix");
      table.report().error(Code::duplicate_name, node.place, "prefix " + quote(node.text) + " is taken",
                           "choose another prefix: each included scene has its own");
      reading.names.give_up(prefix);
    } else if (!read_include(reading, scope, table, prefix, ancestors))
      reading.names.give_up(prefix);
    table.finish();
  }
}

}  // namespace

Result<std::string> read_text_file(const fs::path& file) {
  const auto fault = [&file](std::string reason) {
    return tl::make_unexpected(Error{Code::file_unreadable,
                                     Severity::error,
                                     {},
                                     "",
                                     file.string() + ": " + std::move(reason),
                                     "check the name and the permissions"});
  };
  std::error_code error;
  if (fs::is_directory(file, error)) return fault("this is a folder, not a file");
  try {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return fault("the file does not exist or cannot be read");
    std::string text;
    char buffer[1 << 14];
    while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0) {
      text.append(buffer, static_cast<std::size_t>(stream.gcount()));
      if (text.size() > most_bytes) return fault("the file is longer than any scene");
    }
    if (stream.bad()) return fault("the file cannot be read");
    return text;
  } catch (const std::exception& exception) {
    return fault(exception.what());
  }
}

Scope* read_scope(Reading& reading, std::unique_ptr<Document> document, const fs::path& folder,
                  const std::string& prefix, const ParameterOverrides& overrides,
                  const std::vector<fs::path>& ancestors) {
  reading.scopes.push_back(std::make_unique<Scope>());
  Scope& scope = *reading.scopes.back();
  scope.document = std::move(document);
  scope.folder = folder;
  scope.prefix = prefix;
  const Reporter report = reading.reporter(scope, "");
  if (!check_schema(scope, report)) return nullptr;
  const Node& root = scope.document->root();
  check_tables(root, report);
  scope.parameters.read(root.find("parameters"), overrides, report);
  declare_elements(reading, scope);
  read_includes(reading, scope, ancestors);
  return &scope;
}

}  // namespace koppel

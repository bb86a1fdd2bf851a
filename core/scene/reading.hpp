// What the passes over a scene share: the files, the names, and the scene that grows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "scene/findings.hpp"
#include "scene/names.hpp"
#include "scene/scene.hpp"
#include "scene/scene_parameters.hpp"
#include "scene/table_reader.hpp"
#include "scene/toml_text.hpp"

namespace koppel {

/// One file as it is taken in once: a file included twice makes two scopes.
struct Scope {
  std::unique_ptr<Document> document;
  std::filesystem::path folder;  ///< what relative file names refer to; empty: they are errors
  std::string prefix;            ///< "" or "left."
  SceneParameters parameters;
};

/// A table of a list such as [[joint]], and where its description stands in the scene.
struct Element {
  Scope* scope = nullptr;
  const Node* table = nullptr;
  std::string label;      ///< "joint crank"; "joint 3" where the name is faulty
  std::string name;       ///< with prefix; empty where it is faulty or not given
  std::size_t index = 0;  ///< in the list of the scene
};

struct Reading {
  explicit Reading(Registry& types) : registry(types) {}

  Registry& registry;
  Findings findings;
  std::vector<std::unique_ptr<Scope>> scopes;  ///< the scene itself first, included ones after those that include them
  Names names;
  Scene scene;
  std::vector<Element> bodies, frames, joints, constraints, forces, drives, watches, records;
  std::set<std::string> constraint_names, force_names, drive_names, watch_names, record_names;
  std::set<std::uint32_t> faulty_frames;  ///< their faults are reported; what sits on them says nothing
  std::set<std::string> faulty_plugins;   ///< reported once, however many elements ask for them
  /// For each joint and block where `start` and `start_rate` stand; line 0: nowhere.
  struct StartPlaces {
    Place value, rate;
  };
  std::vector<std::vector<StartPlaces>> starts;

  Reporter reporter(const Scope& scope, std::string label) {
    return Reporter(findings, *scope.document, std::move(label));
  }
  ValueReader values(Scope& scope, std::string label) {
    return ValueReader(reporter(scope, std::move(label)), scope.parameters);
  }
  TableReader table(const Element& element) {
    return TableReader(*element.table, values(*element.scope, element.label));
  }
};

// The passes, in this order. Each reports all that is wrong; errors do not keep later passes from looking.

/// Takes in a document and the files that it includes: one scope for each. `ancestors`: the files that include it, and
/// itself. Returns the new scope, or null if the document is of another schema.
Scope* read_scope(Reading& reading, std::unique_ptr<Document> document, const std::filesystem::path& folder,
                  const std::string& prefix, const ParameterOverrides& overrides,
                  const std::vector<std::filesystem::path>& ancestors);
/// The text of a file. Error: file_unreadable.
Result<std::string> read_text_file(const std::filesystem::path& file);
/// Reads [scene] into the scene.
void read_header(Reading& reading, Scope& scope, Scene& scene);
/// Reads [simulation] into the scene.
void read_simulation(Reading& reading, Scope& scope, Scene& scene);
/// Finds the elements of a scope and takes in their names, so that references may point forward.
void declare_elements(Reading& reading, Scope& scope);
void read_body(Reading& reading, const Element& element);
void read_frame(Reading& reading, const Element& element);
void read_joint(Reading& reading, const Element& element);
void read_constraint(Reading& reading, const Element& element);
void read_force(Reading& reading, const Element& element);
void read_drive(Reading& reading, const Element& element);
void read_watch(Reading& reading, const Element& element);
void read_record(Reading& reading, const Element& element);
/// Gives a free joint to the first body of each component that no joint connects to the ground.
void add_free_joints(Reading& reading);
/// Without any [[record]] all joint coordinates are recorded.
void add_default_records(Scene& scene);
/// FNV-1a, 64 bits, over all that the scene says once names, includes and parameters are resolved; places in texts,
/// and where plugins come from, do not count.
std::uint64_t scene_hash(const Scene& scene);

}  // namespace koppel

#include "scene/scene.hpp"

#include <exception>
#include <system_error>

#include "scene/reading.hpp"

namespace koppel {
namespace {

namespace fs = std::filesystem;

constexpr double most_steps = 1e9;

BodyDescription make_ground() {
  BodyDescription body;
  body.name = "ground";
  return body;
}

/// All passes over a document that could be parsed.
Result<Scene> read_document(Registry& registry, std::unique_ptr<Document> document, const fs::path& folder,
                            const std::vector<fs::path>& ancestors, Diagnostics& diagnostics) {
  Reading reading(registry);
  reading.scene.name = "scene";
  reading.scene.bodies.push_back(make_ground());
  Scope* root = read_scope(reading, std::move(document), folder, "", {}, ancestors);
  for (const auto& scope : reading.scopes) {
    Scene unused;
    read_header(reading, *scope, scope.get() == root ? reading.scene : unused);
    read_simulation(reading, *scope, scope.get() == root ? reading.scene : unused);
  }
  for (const Element& element : reading.bodies) read_body(reading, element);
  for (const Element& element : reading.frames) read_frame(reading, element);
  for (const Element& element : reading.joints) read_joint(reading, element);
  for (const Element& element : reading.constraints) read_constraint(reading, element);
  for (const Element& element : reading.forces) read_force(reading, element);
  for (const Element& element : reading.drives) read_drive(reading, element);
  for (const Element& element : reading.watches) read_watch(reading, element);
  for (const Element& element : reading.records) read_record(reading, element);
  for (const auto& scope : reading.scopes) scope->parameters.report_unused(reading.reporter(*scope, ""));
  if (!reading.findings.has_errors()) add_free_joints(reading);
  const bool failed = reading.findings.has_errors();
  reading.findings.hand_over(diagnostics);
  if (failed) return tl::make_unexpected(diagnostics.first_error());
  add_default_records(reading.scene);
  reading.scene.hash = scene_hash(reading.scene);
  return std::move(reading.scene);
}

Result<Scene> fail(Error error, Diagnostics& diagnostics) {
  diagnostics.add(error);
  return tl::make_unexpected(std::move(error));
}

Result<Scene> read(Registry& registry, std::string text, std::string name, const fs::path& folder,
                   const std::vector<fs::path>& ancestors, Diagnostics& diagnostics) {
  auto document = Document::parse(std::move(text), std::move(name));
  if (!document) return fail(document.error(), diagnostics);
  return read_document(registry, std::move(*document), folder, ancestors, diagnostics);
}

/// Memory may run out, and the file system library throws where it has no other form.
template <typename Body>
Result<Scene> guarded(Diagnostics& diagnostics, Body body) {
  Error error;
  try {
    return body();
  } catch (const std::bad_alloc&) {
    error.code = Code::out_of_memory;
    error.message = "no memory is left to read the scene";
  } catch (const std::exception& exception) {
    error.message = std::string("reading the scene failed: ") + exception.what();
  }
  return fail(std::move(error), diagnostics);
}

}  // namespace

void read_header(Reading& reading, Scope& scope, Scene& scene) {
  const Node* node = scope.document->root().find("scene");
  if (node == nullptr) return;
  const ValueReader values = reading.values(scope, "scene");
  if (!node->is_table()) return values.wrong_kind(*node, "[scene]", "a table");
  TableReader table(*node, values);
  if (const Node* name = table.find("name")) {
    scene.name = values.text(*name, "`name`").value_or(scene.name);
    if (name->is_string() && !is_element_name(name->text)) {
      table.report().error(Code::bad_name, name->place, quote(name->text) + " cannot be the name of a scene",
                           "begin with a letter and use letters, digits, underscores and hyphens");
    }
  }
  if (const Node* title = table.find("title")) scene.title = values.text(*title, "`title`").value_or("");
  if (const Node* gravity = table.find("gravity")) {
    scene.gravity = values.vector(*gravity, "`gravity`").value_or(scene.gravity);
  }
  if (const Node* length = table.find("length")) scene.length = values.positive(*length, "`length`", "m");
  if (const Node* duration = table.find("duration")) {
    scene.duration = values.positive(*duration, "`duration`", "s").value_or(scene.duration);
  }
  if (const Node* steps = table.find("steps")) {
    const auto count = values.positive(*steps, "`steps`");
    if (count && *count > most_steps) {
      table.report().error(Code::out_of_range, steps->place, "`steps` must be at most " + number_text(most_steps));
    } else if (count && values.is_whole(*count, *steps, "`steps`")) {
      scene.steps = static_cast<std::uint32_t>(*count);
    }
  }
  table.finish();
}

Result<Scene> read_scene_file(Registry& registry, const fs::path& file, Diagnostics& diagnostics) {
  return guarded(diagnostics, [&]() -> Result<Scene> {
    auto text = read_text_file(file);
    if (!text) return fail(text.error(), diagnostics);
    std::error_code fault;
    fs::path place = fs::canonical(file, fault);
    if (fault) place = fs::absolute(file);
    return read(registry, std::move(*text), file.string(), place.parent_path(), {place}, diagnostics);
  });
}

Result<Scene> read_scene_text(Registry& registry, std::string_view text, const fs::path& folder,
                              Diagnostics& diagnostics) {
  return guarded(diagnostics, [&]() -> Result<Scene> {
    const fs::path place = folder.empty() ? folder : fs::absolute(folder);
    return read(registry, std::string(text), "scene", place, {}, diagnostics);
  });
}

}  // namespace koppel

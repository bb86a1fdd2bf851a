#include "mechanism/mechanism.hpp"

#include <algorithm>

#include "boundary.hpp"
#include "closure/explain.hpp"
#include "closure/explain_flow.hpp"
#include "closure/flow_diagram.hpp"
#include "mechanism/inertia.hpp"

namespace {

using koppel::Mechanism;

/// How many things of a kind there are; -1: no such kind.
std::ptrdiff_t count_of(const Mechanism& m, std::int32_t kind) {
  switch (kind) {
    case KOPPEL_KIND_BODY: return std::ssize(m.bodies);
    case KOPPEL_KIND_FRAME: return std::ssize(m.frames);
    case KOPPEL_KIND_JOINT: return std::ssize(m.joints);
    case KOPPEL_KIND_COORDINATE: return std::ssize(m.coordinate_names);
    case KOPPEL_KIND_RATE: return std::ssize(m.rate_names);
    case KOPPEL_KIND_INPUT: return std::ssize(m.inputs);
    case KOPPEL_KIND_RECORD: return std::ssize(m.record_columns);
    case KOPPEL_KIND_EQUATION: return std::ssize(m.equation_names);
    case KOPPEL_KIND_SCENE: return 2;
    case KOPPEL_KIND_WATCH: return std::ssize(m.watches);
    default: return -1;
  }
}

std::string_view name_of(const Mechanism& m, std::int32_t kind, std::size_t i) {
  switch (kind) {
    case KOPPEL_KIND_BODY: return m.bodies[i].name;
    case KOPPEL_KIND_FRAME: return m.frames[i].name;
    case KOPPEL_KIND_JOINT: return m.joints[i].name;
    case KOPPEL_KIND_COORDINATE: return m.coordinate_names[i].name;
    case KOPPEL_KIND_RATE: return m.rate_names[i].name;
    case KOPPEL_KIND_INPUT: return m.inputs[i].name;
    case KOPPEL_KIND_RECORD: return m.record_columns[i].name;
    case KOPPEL_KIND_EQUATION: return m.equation_names[i].name;
    case KOPPEL_KIND_WATCH: return m.watches[i].name;
    default: return i == 0 ? m.name : m.title;
  }
}

std::string_view unit_of(const Mechanism& m, std::int32_t kind, std::size_t i) {
  switch (kind) {
    case KOPPEL_KIND_COORDINATE: return m.coordinate_names[i].unit;
    case KOPPEL_KIND_RATE: return m.rate_names[i].unit;
    case KOPPEL_KIND_INPUT: return m.coordinate_names[m.inputs[i].q].unit;
    case KOPPEL_KIND_RECORD: return m.record_columns[i].unit;
    case KOPPEL_KIND_EQUATION: return m.equation_names[i].unit;
    case KOPPEL_KIND_WATCH: return (m.watches[i].rate ? m.rate_names : m.coordinate_names)[m.watches[i].at].unit;
    default: return "";
  }
}

bool has(const koppel_mechanism* mechanism, std::int32_t kind, std::size_t index) {
  if (mechanism == nullptr) return false;
  const std::ptrdiff_t count = count_of(*mechanism->mechanism, kind);
  return count >= 0 && index < static_cast<std::size_t>(count);
}

std::uint32_t u32(std::size_t n) { return static_cast<std::uint32_t>(n); }

}  // namespace

koppel_status koppel_mechanism_compile(const koppel_scene* scene, koppel_diagnostics* diagnostics,
                                       koppel_mechanism** mechanism, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (scene == nullptr || mechanism == nullptr) {
      return koppel::invalid_argument("scene or mechanism is NULL", error);
    }
    koppel::Diagnostics findings;
    auto compiled = koppel::compile(*scene->scene, findings);
    if (!compiled) findings.add(compiled.error());
    if (diagnostics != nullptr) {
      for (const koppel::Error& finding : findings.findings()) diagnostics->list.add(finding);
    }
    if (!compiled) return koppel::fail(compiled.error(), error);
    *mechanism = new koppel_mechanism{scene->registry, scene->log, std::move(*compiled)};
    return KOPPEL_OK;
  });
}

void koppel_mechanism_destroy(koppel_mechanism* mechanism) { delete mechanism; }

koppel_status koppel_mechanism_sizes(const koppel_mechanism* mechanism, koppel_sizes* sizes) {
  if (mechanism == nullptr || sizes == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const Mechanism& m = *mechanism->mechanism;
  koppel_sizes out{};
  out.bodies = u32(m.bodies.size());
  out.joints = u32(m.joints.size());
  out.frames = u32(m.frames.size());
  out.coordinates = m.nq;
  out.rates = m.nv;
  out.inputs = u32(m.inputs.size());
  out.records = u32(m.record_columns.size());
  out.loops = m.loops;
  out.constraints = u32(m.constraints.size());
  out.equations = m.rows;
  out.unknowns = m.unknowns;
  out.watches = static_cast<std::uint32_t>(m.watches.size());
  koppel::write_struct(out, sizes);
  return KOPPEL_OK;
}

koppel_status koppel_mechanism_settings(const koppel_mechanism* mechanism, koppel_settings* settings) {
  if (mechanism == nullptr || settings == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const Mechanism& m = *mechanism->mechanism;
  koppel_settings out{};
  out.steps = m.run_steps;
  out.duration = m.duration;
  out.length = m.length;
  std::copy(m.gravity.data(), m.gravity.data() + 3, out.gravity);
  out.hash = m.hash;
  koppel::write_struct(out, settings);
  return KOPPEL_OK;
}

koppel_status koppel_mechanism_name(const koppel_mechanism* mechanism, int32_t kind, size_t index, char* text,
                                    size_t size, size_t* needed) {
  if (!has(mechanism, kind, index)) return KOPPEL_INVALID_ARGUMENT;
  return koppel::write_text(name_of(*mechanism->mechanism, kind, index), text, size, needed);
}

koppel_status koppel_mechanism_unit(const koppel_mechanism* mechanism, int32_t kind, size_t index, char* text,
                                    size_t size, size_t* needed) {
  if (!has(mechanism, kind, index)) return KOPPEL_INVALID_ARGUMENT;
  return koppel::write_text(unit_of(*mechanism->mechanism, kind, index), text, size, needed);
}

koppel_status koppel_mechanism_start(const koppel_mechanism* mechanism, size_t coordinate, int32_t* wish,
                                     double* value) {
  if (mechanism == nullptr || wish == nullptr || value == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::Mechanism& m = *mechanism->mechanism;
  if (coordinate >= m.nq) return KOPPEL_INVALID_ARGUMENT;
  *wish = KOPPEL_START_FREE;
  for (const koppel::StateBlock& block : m.blocks) {
    if (coordinate < block.q || coordinate >= block.q + koppel::coordinate_count(block.kind)) continue;
    const auto& described = m.joints[block.joint.index()].blocks[block.block].described;
    const bool driven = std::any_of(m.inputs.begin(), m.inputs.end(), [&](const auto& x) { return x.q == coordinate; });
    if (!described.start || driven) break;
    *wish = described.fixed ? KOPPEL_START_FIXED : KOPPEL_START_PREFERRED;
    *value = (*described.start)[coordinate - block.q];
  }
  return KOPPEL_OK;
}

koppel_status koppel_mechanism_find(const koppel_mechanism* mechanism, int32_t kind, const char* name, size_t* index,
                                    koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (mechanism == nullptr || name == nullptr || index == nullptr) {
      return koppel::invalid_argument("mechanism, name or index is NULL", error);
    }
    const std::ptrdiff_t count = count_of(*mechanism->mechanism, kind);
    std::vector<std::string> names;
    for (std::size_t i = 0; static_cast<std::ptrdiff_t>(i) < count; ++i) {
      names.emplace_back(name_of(*mechanism->mechanism, kind, i));
      if (names.back() != name) continue;
      *index = i;
      return KOPPEL_OK;
    }
    const auto nearest = koppel::nearest_name(name, names);
    return koppel::fail(
        koppel::make_error(koppel::Code::invalid_argument, {}, "there is no `" + std::string(name) + "`",
                           nearest ? "did you mean `" + *nearest + "`?" : std::string()),
        error);
  });
}

koppel_status koppel_mechanism_closure(const koppel_mechanism* mechanism, size_t index, koppel_closure* closure,
                                       uint32_t* path, size_t count) {
  if (mechanism == nullptr || closure == nullptr || index >= mechanism->mechanism->relations.size()) {
    return KOPPEL_INVALID_ARGUMENT;
  }
  const koppel::Relation& relation = mechanism->mechanism->relations[index];
  if (path != nullptr && count != relation.joints.size()) return KOPPEL_INVALID_ARGUMENT;
  koppel_closure out{};
  const bool constraint = relation.kind == koppel::RelationKind::constraint;
  out.kind = constraint                                         ? KOPPEL_CUT_NONE
             : relation.kind == koppel::RelationKind::cut_joint ? KOPPEL_CUT_JOINT
                                                                : KOPPEL_CUT_BODY;
  out.joint = constraint ? -1 : static_cast<std::int32_t>(relation.joint.value);
  out.first_equation = relation.first_row;
  out.equations = relation.rows;
  out.path = u32(relation.joints.size());
  koppel::write_struct(out, closure);
  for (std::size_t i = 0; path != nullptr && i < count; ++i) path[i] = relation.joints[i].value;
  return KOPPEL_OK;
}

koppel_status koppel_mechanism_explain(const koppel_mechanism* mechanism, char* text, size_t size, size_t* needed) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (mechanism == nullptr) return KOPPEL_INVALID_ARGUMENT;
    return koppel::write_text(koppel::explain(*mechanism->mechanism), text, size, needed);
  });
}

koppel_status koppel_flow_explain(const koppel_mechanism* mechanism, int32_t format, char* text, size_t size,
                                  size_t* needed) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (mechanism == nullptr || (format != KOPPEL_FLOW_TEXT && format != KOPPEL_FLOW_DOT)) {
      return KOPPEL_INVALID_ARGUMENT;
    }
    const Mechanism& m = *mechanism->mechanism;
    const koppel::Flow flow = koppel::plan_flow(m);
    const std::string words = format == KOPPEL_FLOW_DOT ? koppel::flow_diagram(m, flow) : koppel::explain(m, flow);
    return koppel::write_text(words, text, size, needed);
  });
}

koppel_status koppel_body_inertia(const koppel_mechanism* mechanism, size_t body, koppel_inertia* inertia,
                                  koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (inertia == nullptr || !has(mechanism, KOPPEL_KIND_BODY, body)) {
      return koppel::invalid_argument("mechanism or inertia is NULL, or there is no such body", error);
    }
    const auto result = koppel::body_inertia(*mechanism->mechanism, {u32(body)});
    if (!result) return koppel::fail(result.error(), error);
    koppel::write_struct(*result, inertia);
    return KOPPEL_OK;
  });
}

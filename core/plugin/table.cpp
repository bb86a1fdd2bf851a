#include "plugin/table.hpp"

#include <algorithm>
#include <string_view>

#include "plugin/schema.hpp"

namespace koppel {
namespace {

/// What is the same for all tables of one plugin.
struct Reader {
  std::shared_ptr<const Library> library;
  Naming naming;
  Logger log;
};

Result<void> check_type_name(const Reader& reader, const Subject& subject, const char* name) {
  if (name == nullptr || *name == '\0') return subject.malformed("its type has no name");
  const std::string_view text = name;
  if (reader.naming == Naming::plain) {
    if (is_identifier(text)) return {};
    return subject.malformed("`" + std::string(text) + "` is not the plain name of a standard type");
  }
  const std::string prefix = std::string(reader.library->entry().name) + '.';
  if (text.substr(0, prefix.size()) == prefix && is_identifier(text.substr(prefix.size()))) return {};
  return subject.malformed("the type name `" + std::string(text) + "` does not begin with `" + prefix + '`',
                           "names without a dot belong to koppel; write `" + prefix +
                               "type` with lower-case letters, digits and underscores");
}

/// Fills what types of all kinds have in common. On return `subject` calls the type by its name.
Result<void> read_common(const Reader& reader, Subject& subject, PluginKind kind, const koppel_type* from, Type& type) {
  KOPPEL_TRY(type.table, read_struct(subject, from, size_through(&koppel_type::destroy), "type"));
  KOPPEL_CHECK(check_type_name(reader, subject, type.table.name));
  type.kind = kind;
  type.name = type.table.name;
  type.summary = type.table.summary != nullptr ? type.table.summary : "";
  type.origin = subject.origin;
  type.log = reader.log;
  type.library = reader.library;
  subject.type = "type `" + type.name + '`';
  if (type.table.create == nullptr && type.table.destroy != nullptr) {
    return subject.malformed("destroy is given, but create is NULL");
  }
  KOPPEL_TRY(type.parameters, read_parameters(subject, type.table, kind));
  return {};
}

Result<void> check_motion(const Subject& subject, const JointType& joint) {
  const koppel_joint_type& calls = joint.calls;
  if (calls.motions == nullptr && calls.pose == nullptr && !joint.blocks.empty()) {
    return subject.malformed("motions and pose are both NULL", "give one of them: they tell how the joint moves");
  }
  if (calls.motions == nullptr) return {};
  if (calls.pose != nullptr) {
    return subject.malformed("motions and pose are both given", "a product of elementary motions needs no pose");
  }
  for (const Block& block : joint.blocks) {
    if (block.kind == BlockKind::unit_vector) {
      return subject.malformed("coordinate `" + block.name + "`: no elementary motion is moved by a unit vector",
                               "give pose instead of motions");
    }
  }
  return {};
}

Result<void> check_implicit(const Subject& subject, const JointType& joint) {
  const koppel_joint_type& calls = joint.calls;
  if (calls.implicit == nullptr) {
    if (calls.row_count != 0) return subject.malformed("has rows, but implicit is NULL");
    return {};
  }
  if (calls.coordinates_of == nullptr) return subject.malformed("implicit is given, but coordinates_of is NULL");
  const std::size_t expected = 6 - joint.nv();
  if (calls.row_count != expected) {
    return subject.malformed("row_count is " + std::to_string(calls.row_count) + ", but a joint with " +
                             std::to_string(joint.nv()) + " rates has " + std::to_string(expected) +
                             " implicit equations");
  }
  return {};
}

Result<AnyType> read_joint(const Reader& reader, Subject& subject, const void* table) {
  JointType out;
  KOPPEL_TRY(out.calls, read_struct(subject, static_cast<const koppel_joint_type*>(table),
                                    size_through(&koppel_joint_type::coordinates_of), "koppel_joint_type"));
  KOPPEL_CHECK(read_common(reader, subject, PluginKind::joint, out.calls.type, out));
  KOPPEL_TRY(out.blocks, read_blocks(subject, out.calls.coordinates, out.calls.coordinate_count));
  if (out.nv() > 6) return subject.malformed("has " + std::to_string(out.nv()) + " rates; a body has 6");
  KOPPEL_CHECK(check_motion(subject, out));
  KOPPEL_CHECK(check_implicit(subject, out));
  KOPPEL_TRY(out.rows, read_rows(subject, out.calls.rows, out.calls.row_count));
  return AnyType(std::move(out));
}

Result<AnyType> read_body(const Reader& reader, Subject& subject, const void* table) {
  BodyType out;
  KOPPEL_TRY(out.calls, read_struct(subject, static_cast<const koppel_body_type*>(table),
                                    size_through(&koppel_body_type::coordinate_count), "koppel_body_type"));
  KOPPEL_CHECK(read_common(reader, subject, PluginKind::body, out.calls.type, out));
  if (out.calls.inertia == nullptr) return subject.malformed("inertia is NULL");
  if (out.calls.coordinates != nullptr || out.calls.coordinate_count != 0) {
    return subject.malformed("coordinates are reserved in " KOPPEL_BODY_INTERFACE,
                             "set coordinates to NULL and coordinate_count to 0");
  }
  return AnyType(std::move(out));
}

std::ptrdiff_t parameters_of(const Type& type, ParameterKind kind) {
  return std::count_if(type.parameters.begin(), type.parameters.end(),
                       [kind](const Parameter& p) { return p.kind == kind; });
}

/// What constraints and forces act on: frames, coordinates or both. The least number of frames that a scene gives.
Result<std::ptrdiff_t> check_subjects(const Subject& subject, const Type& type) {
  const auto frames = parameters_of(type, ParameterKind::frame);
  const auto coordinates = parameters_of(type, ParameterKind::coordinates);
  if (coordinates > 1) return subject.malformed("has more than one parameter of kind COORDINATES");
  if (frames + coordinates == 0) return subject.malformed("has no parameter of kind FRAME or COORDINATES to act on");
  return std::count_if(type.parameters.begin(), type.parameters.end(),
                       [](const Parameter& p) { return p.kind == ParameterKind::frame && p.required; });
}

Result<AnyType> read_constraint(const Reader& reader, Subject& subject, const void* table) {
  ConstraintType out;
  KOPPEL_TRY(out.calls, read_struct(subject, static_cast<const koppel_constraint_type*>(table),
                                    size_through(&koppel_constraint_type::second_order), "koppel_constraint_type"));
  KOPPEL_CHECK(read_common(reader, subject, PluginKind::constraint, out.calls.type, out));
  if (out.calls.residual == nullptr) return subject.malformed("residual is NULL");
  if (out.calls.jacobian == nullptr) return subject.malformed("jacobian is NULL");
  if (out.calls.second_order == nullptr) return subject.malformed("second_order is NULL");
  const auto frames = parameters_of(out, ParameterKind::frame);
  if (frames != 0 && frames != 2) {
    return subject.malformed("has " + std::to_string(frames) + " parameters of kind FRAME; it may have none or two");
  }
  KOPPEL_TRY(const auto required_frames, check_subjects(subject, out));
  if (required_frames != frames) {
    return subject.malformed("has a parameter of kind FRAME that is not required; a constraint needs both frames");
  }
  if (out.calls.row_count == 0) return subject.malformed("row_count is 0");
  KOPPEL_TRY(out.rows, read_rows(subject, out.calls.rows, out.calls.row_count));
  return AnyType(std::move(out));
}

Result<AnyType> read_function(const Reader& reader, Subject& subject, const void* table) {
  FunctionType out;
  KOPPEL_TRY(out.calls, read_struct(subject, static_cast<const koppel_function_type*>(table),
                                    size_through(&koppel_function_type::evaluate), "koppel_function_type"));
  KOPPEL_CHECK(read_common(reader, subject, PluginKind::function, out.calls.type, out));
  if (out.calls.evaluate == nullptr) return subject.malformed("evaluate is NULL");
  return AnyType(std::move(out));
}

Result<void> check_calls(const Subject& subject, const koppel_force_type& calls) {
  if (calls.evaluate == nullptr) return subject.malformed("evaluate is NULL");
  if (calls.initial != nullptr && calls.state_count == 0) {
    return subject.malformed("initial is given, but state_count is 0");
  }
  if (calls.dissipation != nullptr && calls.energy == nullptr) {
    return subject.malformed("dissipation is given, but energy is NULL",
                             "a force that only loses energy gives an energy that is always 0");
  }
  if ((calls.switches != nullptr) != (calls.switch_count != 0)) {
    return subject.malformed(calls.switches == nullptr ? "has a switch_count, but switches is NULL"
                                                       : "switches is given, but switch_count is 0");
  }
  constexpr std::size_t implausible = 256;
  if (calls.switch_count > implausible) {
    return subject.malformed("has " + std::to_string(calls.switch_count) + " switches");
  }
  return {};
}

Result<AnyType> read_force(const Reader& reader, Subject& subject, const void* table) {
  ForceType out;
  KOPPEL_TRY(out.calls, read_struct(subject, static_cast<const koppel_force_type*>(table),
                                    size_through(&koppel_force_type::switches), "koppel_force_type"));
  KOPPEL_CHECK(read_common(reader, subject, PluginKind::force, out.calls.type, out));
  KOPPEL_CHECK(check_calls(subject, out.calls));
  const auto frames = parameters_of(out, ParameterKind::frame);
  if (frames > 2) {
    return subject.malformed("has " + std::to_string(frames) + " parameters of kind FRAME; it may have two at most");
  }
  KOPPEL_TRY(const auto required_frames, check_subjects(subject, out));
  if (frames > 0 && required_frames == 0) {
    return subject.malformed("none of its parameters of kind FRAME is required", "require the one that it acts on");
  }
  KOPPEL_TRY(out.states, read_states(subject, out.calls.states, out.calls.state_count));
  return AnyType(std::move(out));
}

struct Interface {
  const char* id;
  const char* table;
  Result<AnyType> (*read)(const Reader&, Subject&, const void*);
};

constexpr Interface interfaces[] = {
    {KOPPEL_JOINT_INTERFACE, "joint table", read_joint},
    {KOPPEL_BODY_INTERFACE, "body table", read_body},
    {KOPPEL_CONSTRAINT_INTERFACE, "constraint table", read_constraint},
    {KOPPEL_FUNCTION_INTERFACE, "function table", read_function},
    {KOPPEL_FORCE_INTERFACE, "force table", read_force},
};

}  // namespace

Result<std::vector<AnyType>> read_types(const std::shared_ptr<const Library>& library, Naming naming,
                                        const Logger& log) {
  const Reader reader{library, naming, log};
  std::vector<AnyType> out;
  for (const Interface& interface : interfaces) {
    for (std::size_t index = 0;; ++index) {
      Subject subject{library->origin(), std::string(interface.table) + ' ' + std::to_string(index)};
      const void* table = library->entry().type_table(interface.id, index);
      if (table == nullptr) break;
      KOPPEL_TRY(AnyType type, interface.read(reader, subject, table));
      const auto same_name = [&](const AnyType& other) { return common(other).name == common(type).name; };
      if (std::any_of(out.begin(), out.end(), same_name)) return subject.malformed("the plugin offers it twice");
      out.push_back(std::move(type));
    }
  }
  if (out.empty()) {
    return tl::make_unexpected(plugin_error(Code::plugin_malformed, library->origin(),
                                            "type_table() offers no type of any interface that this engine knows"));
  }
  return out;
}

}  // namespace koppel

// Reads the parts that tables are made of: names, parameter schemas, coordinates, rows, internal states.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "plugin/copy.hpp"
#include "plugin/type.hpp"

namespace koppel {

/// Whose table is being read; begins every finding.
struct Subject {
  std::string origin;
  std::string type;  ///< "type `acme.cam`", or "joint table 2" as long as its name is not known

  tl::unexpected<Error> malformed(const std::string& what, std::string advice = {}) const;
};

/// The struct that `from` points at, which must have at least `needed` bytes.
template <typename Struct>
Result<Struct> read_struct(const Subject& subject, const Struct* from, std::size_t needed, const std::string& what) {
  constexpr std::size_t implausible = 1 << 16;
  if (from == nullptr) return subject.malformed(what + " is NULL");
  const std::size_t size = from->struct_size;
  if (size < needed || size > implausible) {
    return subject.malformed(
        what + ": struct_size is " + std::to_string(size) + ", expected " + std::to_string(needed) + " or more",
        "set struct_size to the sizeof of the struct");
  }
  return copy_struct(from);
}

/// An array of structs; the first element's struct_size is the distance from one to the next.
template <typename Struct>
Result<std::vector<Struct>> read_array(const Subject& subject, const Struct* first, std::size_t count,
                                       std::size_t needed, const std::string& what) {
  constexpr std::size_t implausible = 256;
  std::vector<Struct> out;
  if (count == 0) return out;
  if (count > implausible) return subject.malformed("has " + std::to_string(count) + ' ' + what + "s");
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = what + ' ' + std::to_string(i);
    const Struct* element = first == nullptr ? nullptr : array_element(first, first->struct_size, i);
    KOPPEL_TRY(Struct copy, read_struct(subject, element, needed, name));
    if (element->struct_size != first->struct_size || first->struct_size % alignof(Struct) != 0) {
      return subject.malformed(name + ": struct_size is " + std::to_string(element->struct_size) +
                               ", which is no distance from element to element");
    }
    out.push_back(copy);
  }
  return out;
}

/// A name of lower-case letters, digits and underscores.
bool is_identifier(std::string_view name);

Result<std::vector<Parameter>> read_parameters(const Subject& subject, const koppel_type& type, PluginKind kind);
Result<std::vector<Block>> read_blocks(const Subject& subject, const koppel_coordinate* first, std::size_t count);
Result<std::vector<Row>> read_rows(const Subject& subject, const koppel_row* first, std::size_t count);
Result<std::vector<InternalState>> read_states(const Subject& subject, const koppel_internal_state* first,
                                               std::size_t count);

}  // namespace koppel

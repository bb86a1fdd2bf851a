// The values that a scene gives to the parameters of a plugin's type, checked against the type's schema.
#pragma once

#include <vector>

#include "scene/reading.hpp"

namespace koppel {

/// The type that an element names by `type` and perhaps `plugin`, or null after reporting the registry's error.
/// `standard`: the name if the scene gives none; empty: it must. Find: Registry::joint, Registry::body, ...
template <typename T>
const T* find_type(Reading& reading, const Scope& scope, TableReader& table, std::string_view standard,
                   Result<const T*> (Registry::*find)(std::string_view, const PluginReference&));

/// What a parameter is if the scene does not give it.
Value fallback_value(const Parameter& parameter);

/// What the values of one type amount to.
struct TypeValues {
  std::vector<Value> values;  ///< in the order of the schema
  std::vector<Attachment> frames;
  std::vector<CoordinateReference> coordinates;
};

/// Reads all parameters of a type. `to_inlet` turns the axes in which directions are given into inlet axes;
/// `value_unit` is the unit of real parameters, and of the columns of functions' tables, for which the schema has none.
/// Errors:
/// missing_key, wrong_kind, wrong_count, out_of_range and those of names. After a fault the values are incomplete.
TypeValues read_values(Reading& reading, Scope& scope, TableReader& table, const Type& type,
                       const Matrix3& to_inlet = Matrix3::Identity(), std::string_view value_unit = "");

}  // namespace koppel

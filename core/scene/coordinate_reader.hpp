// Names of joint coordinates: `joint.coordinate`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/reading.hpp"

namespace koppel {

/// The coordinate block that a text names; the last dot stands before the coordinate. Errors: unknown_joint,
/// unknown_coordinate.
std::optional<CoordinateReference> read_coordinate(Reading& reading, Scope& scope, const Reporter& report,
                                                   const Node& text);

/// The same, and it must be a length or an angle. Errors also: wrong_kind, not_scalar.
std::optional<CoordinateReference> read_scalar_coordinate(Reading& reading, Scope& scope, const ValueReader& values,
                                                          const Node& node, std::string_view what);

/// The blocks of a type by name: "its coordinates are `x`, `y`"; for advice.
std::string coordinates_text(const JointType& type);

/// "joint.coordinate", with prefix.
std::string coordinate_name(const Scene& scene, CoordinateReference coordinate);

/// The SI unit of a scalar block.
std::string_view unit_of(BlockKind kind);

}  // namespace koppel

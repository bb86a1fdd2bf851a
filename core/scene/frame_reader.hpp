// Frames and poses as scenes describe them.
#pragma once

#include <optional>

#include "scene/reading.hpp"

namespace koppel {

/// Where body and joint, constraint or record say that a frame lies: a name or a description in place.
std::optional<Attachment> read_attachment(Reading& reading, Scope& scope, const ValueReader& values, const Node& node,
                                          std::string_view what);

/// The frame that a table describes: `on`, `at` and one of `rotate`, `axis`, `quaternion`.
std::optional<Attachment> read_attachment(Reading& reading, Scope& scope, TableReader& table);

/// `at` and one of `rotate` and `quaternion`, from the axes of the frame that it refers to.
std::optional<Pose> read_pose(TableReader& table);

/// `at`, `axis` and `x_axis`.
std::optional<Pose> read_axis_pose(TableReader& table);

}  // namespace koppel

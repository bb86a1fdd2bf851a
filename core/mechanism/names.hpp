// What the numbers of a mechanism are called and measured in.
#pragma once

#include <string>
#include <vector>

#include "mechanism/mechanism.hpp"

namespace koppel {

std::vector<NamedNumber> coordinate_names(const Mechanism& mechanism);
std::vector<NamedNumber> rate_names(const Mechanism& mechanism);

/// "loop at joint ball", "constraint rod".
std::string relation_name(const Mechanism& mechanism, const Relation& relation);
/// The equations of a relation.
std::vector<Row> relation_rows(const Mechanism& mechanism, const Relation& relation);

/// Columns of the recorded quantities.
std::vector<RecordColumn> record_columns(const Mechanism& mechanism);

}  // namespace koppel

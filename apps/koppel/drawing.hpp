// Drawings by Graphviz.
#pragma once

#include <string>

#include "common/model.hpp"

namespace koppel::app {

/// Writes a graph in the DOT language to a file: as it is if the name ends in .dot, laid out by Graphviz' program `dot`
/// if it ends in .svg. What goes wrong is told on standard error.
Exit write_drawing(const std::string& dot, const std::string& file);

/// "" if write_drawing knows what to do with a file of this name, or what is wrong with it.
std::string drawing_file(const std::string& file);

}  // namespace koppel::app

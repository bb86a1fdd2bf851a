// What was built from a scene, in words.
#pragma once

#include <string>

#include "closure/freedoms.hpp"
#include "mechanism/mechanism.hpp"

namespace koppel {

/// A page of text: size, tree, how each loop is cut, equations and unknowns, inputs, what is formed numerically, and
/// what was left out because nothing asks for it.
std::string explain(const Mechanism& mechanism);

/// A page of text on the freedoms: the count and the rank and what makes them differ, the kinds of the loops, freedoms
/// of one body alone, reactions that statics does not determine, and the screw axes of bodies that move.
std::string explain(const Mechanism& mechanism, const Freedoms& freedoms);

}  // namespace koppel

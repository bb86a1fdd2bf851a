// What was built from a scene, in words.
#pragma once

#include <string>

#include "mechanism/mechanism.hpp"

namespace koppel {

/// A page of text: size, tree, how each loop is cut, equations and unknowns, inputs, what is formed numerically, and
/// what was left out because nothing asks for it.
std::string explain(const Mechanism& mechanism);

}  // namespace koppel

// The solution flow of a mechanism, in words.
#pragma once

#include <string>

#include "closure/flow.hpp"
#include "mechanism/mechanism.hpp"

namespace koppel {

/// A page of text: the loops and where each is cut, inputs, what is taken as it is, and step by step what is computed,
/// from what and how; apart from these the steps that are done only if somebody asks for the coordinates of cut joints;
/// what must be found together, where angles on a common axis add up, and whether every step is in closed form.
std::string explain(const Mechanism& mechanism, const Flow& flow);

}  // namespace koppel

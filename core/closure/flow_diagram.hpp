// The solution flow of a mechanism as a block diagram, in the manner of kinematic transformers (K-II-4.2.3).
#pragma once

#include <string>

#include "closure/flow.hpp"
#include "mechanism/mechanism.hpp"

namespace koppel {

/// A digraph in the DOT language of Graphviz. Each box is a loop, or the loops that are solved together, with its
/// joints and how it is solved, in another colour where that is numerical; an arrow is the coordinates that one box
/// gives to another; from the left come the inputs and what is taken as it is, on the right leave the recorded
/// coordinates. If none is recorded, or all are, the ones leave that no box needs. What is only computed on demand is
/// left out unless it is recorded.
std::string flow_diagram(const Mechanism& mechanism, const Flow& flow);

}  // namespace koppel

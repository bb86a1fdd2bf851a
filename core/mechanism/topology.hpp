// The graph of bodies and joints: which joints form the spanning tree, which close loops.
#pragma once

#include <cstdint>
#include <vector>

#include "base/id.hpp"

namespace koppel {

/// A joint as an edge. `cost`: equations that a loop needs when it is cut here.
struct Edge {
  BodyId a, b;
  std::uint32_t cost = 6;
};

/// A tree joint, walked from parent to child.
struct Branch {
  JointId joint;
  BodyId parent, child;
};

struct Topology {
  std::vector<Branch> branches;  ///< parents before children, from the ground outwards
  std::vector<JointId> chords;   ///< one for each independent loop, in file order
};

/// The spanning tree that leaves the fewest closure equations: joints that are dear to cut go into the tree first
/// (Kruskal), equals in file order. Every body must be connected to the ground.
Topology span(std::size_t bodies, const std::vector<Edge>& edges);

}  // namespace koppel

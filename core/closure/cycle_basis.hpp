// Independent closed walks in a graph of bodies and joints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace koppel {

struct WeightedEdge {
  std::uint32_t a = 0, b = 0;  ///< the bodies that it joins
  std::uint32_t weight = 1;
};

/// An edge, walked from a to b, or from b to a.
struct EdgeStep {
  std::uint32_t edge = 0;
  bool reversed = false;
};

/// Closed walks, lightest first, that are independent and as many as can be: a minimum cycle basis over GF(2), found
/// among the candidates of Horton (1987), "A polynomial-time algorithm to find the shortest cycle basis of a graph".
/// Of very large graphs only the lightest walks through each edge and those of a shortest-path tree are candidates: a
/// basis still, though perhaps not the lightest. Two edges between the same bodies are a walk, too.
std::vector<std::vector<EdgeStep>> cycle_basis(std::size_t bodies, const std::vector<WeightedEdge>& edges);

}  // namespace koppel

// Which equations can be solved for themselves: matching and strong components of a bipartite graph.
#pragma once

#include <cstdint>
#include <vector>

namespace koppel {

/// An equation of a group; the equations of a group are only used together.
struct BlockEquation {
  std::uint32_t group = 0;
  std::vector<std::uint32_t> unknowns;
};

/// The least set of groups whose equations determine as many unknowns as they have, and no others enter: a block that
/// comes first in the block triangular form of the well-determined part (Dulmage and Mendelsohn 1958). Empty: every
/// group has unknowns that the equations leave free.
std::vector<std::uint32_t> least_block(const std::vector<BlockEquation>& equations, std::uint32_t unknowns);

}  // namespace koppel

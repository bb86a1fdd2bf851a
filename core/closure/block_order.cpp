#include "closure/block_order.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

namespace koppel {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A maximum matching by augmenting paths.
class Matching {
 public:
  Matching(const std::vector<BlockEquation>& equations, std::uint32_t unknowns)
      : equations_(equations), equation_of_(unknowns, none), unknown_of_(equations.size(), none) {
    for (std::uint32_t e = 0; e < equations.size(); ++e) {
      visited_.assign(unknowns, false);
      augment(e);
    }
  }
  std::uint32_t equation_of(std::uint32_t unknown) const { return equation_of_[unknown]; }
  std::uint32_t unknown_of(std::uint32_t equation) const { return unknown_of_[equation]; }

 private:
  bool augment(std::uint32_t equation) {
    for (const std::uint32_t u : equations_[equation].unknowns) {
      if (visited_[u]) continue;
      visited_[u] = true;
      if (equation_of_[u] != none && !augment(equation_of_[u])) continue;
      equation_of_[u] = equation;
      unknown_of_[equation] = u;
      return true;
    }
    return false;
  }

  const std::vector<BlockEquation>& equations_;
  std::vector<std::uint32_t> equation_of_, unknown_of_;
  std::vector<bool> visited_;
};

}  // namespace

std::vector<std::uint32_t> least_block(const std::vector<BlockEquation>& equations, std::uint32_t unknowns) {
  const Matching matching(equations, unknowns);
  std::vector<std::vector<std::uint32_t>> of_group;
  for (std::uint32_t e = 0; e < equations.size(); ++e) {
    if (equations[e].group >= of_group.size()) of_group.resize(equations[e].group + 1);
    of_group[equations[e].group].push_back(e);
  }
  // From each group follow everything that its equations need: the unknowns in them, the equations that these are
  // matched with, and the others of their groups. Where that meets an unknown without equation, it is not determined.
  std::vector<std::uint32_t> best;
  for (std::uint32_t start = 0; start < of_group.size(); ++start) {
    if (of_group[start].empty()) continue;
    std::set<std::uint32_t> groups{start};
    std::vector<std::uint32_t> front{start};
    bool determined = true;
    while (!front.empty() && determined && (best.empty() || groups.size() < best.size())) {
      const std::uint32_t group = front.back();
      front.pop_back();
      for (const std::uint32_t e : of_group[group]) {
        for (const std::uint32_t u : equations[e].unknowns) {
          const std::uint32_t by = matching.equation_of(u);
          determined = determined && by != none;
          if (by != none && groups.insert(equations[by].group).second) front.push_back(equations[by].group);
        }
      }
    }
    if (determined && front.empty() && (best.empty() || groups.size() < best.size())) {
      best.assign(groups.begin(), groups.end());
    }
  }
  return best;
}

}  // namespace koppel

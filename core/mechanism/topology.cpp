#include "mechanism/topology.hpp"

#include <algorithm>
#include <numeric>

namespace koppel {
namespace {

/// Sets of connected bodies (union-find with path halving).
class Components {
 public:
  explicit Components(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// False: both were connected already.
  bool join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return false;
    parent_[a] = b;
    return true;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

Topology span(std::size_t bodies, const std::vector<Edge>& edges) {
  std::vector<std::uint32_t> order(edges.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t x, std::uint32_t y) { return edges[x].cost > edges[y].cost; });

  Components components(bodies);
  std::vector<bool> in_tree(edges.size(), false);
  for (const std::uint32_t i : order) in_tree[i] = components.join(edges[i].a.index(), edges[i].b.index());

  Topology topology;
  std::vector<std::vector<std::uint32_t>> at_body(bodies);
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    if (!in_tree[i]) {
      topology.chords.push_back({i});
      continue;
    }
    at_body[edges[i].a.index()].push_back(i);
    at_body[edges[i].b.index()].push_back(i);
  }

  std::vector<bool> reached(bodies, false);
  reached[ground.index()] = true;
  std::vector<BodyId> front{ground};
  for (std::size_t next = 0; next < front.size(); ++next) {
    const BodyId parent = front[next];
    for (const std::uint32_t i : at_body[parent.index()]) {
      const BodyId child = edges[i].a == parent ? edges[i].b : edges[i].a;
      if (reached[child.index()]) continue;
      reached[child.index()] = true;
      topology.branches.push_back({{i}, parent, child});
      front.push_back(child);
    }
  }
  return topology;
}

}  // namespace koppel

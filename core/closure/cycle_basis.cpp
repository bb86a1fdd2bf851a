#include "closure/cycle_basis.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <unordered_map>
#include <utility>

namespace koppel {
namespace {

constexpr std::size_t thorough = 1u << 20;  // bodies times edges up to which all of Horton's candidates are made
constexpr std::size_t few = 512;            // equally light walks among which the best is looked for each time
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A cycle as the edges that it uses an odd number of times, ascending.
struct Candidate {
  std::uint64_t weight = 0;
  std::vector<std::uint32_t> edges;

  auto key() const { return std::make_pair(weight, edges.size()); }
};

class Graph {
 public:
  Graph(std::size_t bodies, const std::vector<WeightedEdge>& edges) : edges_(edges), at_(bodies) {
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      at_[edges[i].a].push_back(i);
      if (edges[i].b != edges[i].a) at_[edges[i].b].push_back(i);
    }
  }

  std::uint32_t other_end(std::uint32_t edge, std::uint32_t body) const {
    return edges_[edge].a == body ? edges_[edge].b : edges_[edge].a;
  }

  /// Lightest ways from a body: by which edge each body is reached.
  std::vector<std::uint32_t> ways(std::uint32_t from) const {
    Search search(from);
    while (!search.done()) search.go_on(*this);
    std::vector<std::uint32_t> by(at_.size(), none);
    for (const auto& [body, place] : search.met) by[body] = place.by;
    return by;
  }

  /// The edges of a lightest way between the ends of an edge that does not use it; none if there is none. Searched from
  /// both ends, and first where few joints are: a body with many is met, but hardly ever gone on from.
  std::vector<std::uint32_t> detour(std::uint32_t edge) const {
    Search from_a(edges_[edge].a, edge), from_b(edges_[edge].b, edge);
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    std::uint32_t middle = none;
    while (!from_a.done() && !from_b.done() && from_a.next() + from_b.next() < least) {
      const bool a_first = at_[from_a.body()].size() <= at_[from_b.body()].size();
      Search &here = a_first ? from_a : from_b, &there = a_first ? from_b : from_a;
      here.go_on(*this, [&](std::uint32_t body, std::uint64_t distance) {
        const auto other = there.met.find(body);
        if (other == there.met.end() || distance + other->second.distance >= least) return;
        least = distance + other->second.distance;
        middle = body;
      });
    }
    std::vector<std::uint32_t> used;
    if (middle == none) return used;
    for (const Search* half : {&from_a, &from_b}) {
      for (std::uint32_t body = middle, by = none; (by = half->met.at(body).by) != none; body = other_end(by, body)) {
        used.push_back(by);
      }
    }
    return used;
  }

  /// The edges of the way to a body, back to its start, toggled in `edges`.
  void toggle_way(const std::vector<std::uint32_t>& by, std::uint32_t body, std::vector<std::uint32_t>& edges) const {
    while (by[body] != none) {
      edges.push_back(by[body]);
      body = other_end(by[body], body);
    }
  }

  std::uint64_t cost(std::uint32_t edge) const { return std::uint64_t{edges_[edge].weight} * 1024 + 1; }

  const std::vector<WeightedEdge>& edges() const { return edges_; }

  Candidate candidate(std::vector<std::uint32_t> used) const {
    std::sort(used.begin(), used.end());
    Candidate result;
    for (std::size_t i = 0; i < used.size();) {
      std::size_t j = i;
      while (j < used.size() && used[j] == used[i]) ++j;
      if ((j - i) % 2 == 1) {
        result.edges.push_back(used[i]);
        result.weight += cost(used[i]);
      }
      i = j;
    }
    return result;
  }

  /// The cycle as a walk that starts with its first edge, forwards.
  std::vector<EdgeStep> walk(const std::vector<std::uint32_t>& cycle) const {
    std::vector<EdgeStep> steps;
    std::vector<bool> used(cycle.size(), false);
    std::uint32_t body = edges_[cycle.front()].a;
    for (std::size_t n = 0; n < cycle.size(); ++n) {
      for (std::size_t i = 0; i < cycle.size(); ++i) {
        const WeightedEdge& edge = edges_[cycle[i]];
        if (used[i] || (edge.a != body && edge.b != body)) continue;
        used[i] = true;
        steps.push_back({cycle[i], edge.a != body});
        body = other_end(cycle[i], body);
        break;
      }
    }
    return steps;
  }

 private:
  /// Dijkstra's, with the bodies that it has met so far. Few joints before light ones would make walks longer; a joint
  /// counts for a little, so that welds cost something.
  struct Search {
    struct Place {
      std::uint64_t distance;
      std::uint32_t by;  ///< edge
    };
    using Entry = std::pair<std::uint64_t, std::uint32_t>;

    explicit Search(std::uint32_t from, std::uint32_t without = none) : avoided(without) {
      met.emplace(from, Place{0, none});
      front.push({0, from});
    }
    bool done() const { return front.empty(); }
    std::uint64_t next() const { return front.top().first; }
    std::uint32_t body() const { return front.top().second; }
    /// Goes on from the nearest body; tells each that is reached on a shorter way than before.
    template <typename Reached>
    void go_on(const Graph& graph, const Reached& reached) {
      const auto [so_far, body] = front.top();
      front.pop();
      if (so_far > met.at(body).distance) return;
      for (const std::uint32_t edge : graph.at_[body]) {
        if (edge == avoided) continue;
        const std::uint32_t to = graph.other_end(edge, body);
        const std::uint64_t length = so_far + graph.cost(edge);
        const auto [place, fresh] = met.try_emplace(to, Place{length, edge});
        if (!fresh && length >= place->second.distance) continue;
        place->second = {length, edge};
        front.push({length, to});
        reached(to, length);
      }
    }
    void go_on(const Graph& graph) {
      go_on(graph, [](std::uint32_t, std::uint64_t) {});
    }

    std::uint32_t avoided;
    std::unordered_map<std::uint32_t, Place> met;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  };

  const std::vector<WeightedEdge>& edges_;
  std::vector<std::vector<std::uint32_t>> at_;
};

/// Whether every body is met at most twice: a closed walk that does not cross itself.
bool is_simple(const Graph& graph, const Candidate& candidate) {
  std::map<std::uint32_t, int> met;
  for (const std::uint32_t edge : candidate.edges) {
    if (graph.edges()[edge].a == graph.edges()[edge].b) return candidate.edges.size() == 1;
    if (++met[graph.edges()[edge].a] > 2 || ++met[graph.edges()[edge].b] > 2) return false;
  }
  return !candidate.edges.empty();
}

std::vector<Candidate> candidates(const Graph& graph, std::size_t bodies) {
  std::vector<Candidate> result;
  const auto add_from = [&](std::uint32_t start) {
    const std::vector<std::uint32_t> by = graph.ways(start);
    for (std::uint32_t edge = 0; edge < graph.edges().size(); ++edge) {
      std::vector<std::uint32_t> used{edge};
      graph.toggle_way(by, graph.edges()[edge].a, used);
      graph.toggle_way(by, graph.edges()[edge].b, used);
      result.push_back(graph.candidate(std::move(used)));
    }
  };
  if (bodies * graph.edges().size() <= thorough) {
    for (std::uint32_t body = 0; body < bodies; ++body) add_from(body);
  } else {
    add_from(0);
    for (std::uint32_t edge = 0; edge < graph.edges().size(); ++edge) {
      std::vector<std::uint32_t> used = graph.detour(edge);
      if (used.empty()) continue;
      used.push_back(edge);
      result.push_back(graph.candidate(std::move(used)));
    }
  }
  std::erase_if(result, [&](const Candidate& candidate) { return !is_simple(graph, candidate); });
  std::sort(result.begin(), result.end(), [](const Candidate& a, const Candidate& b) {
    return a.key() != b.key() ? a.key() < b.key() : a.edges < b.edges;
  });
  const auto same = [](const Candidate& a, const Candidate& b) { return a.edges == b.edges; };
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  return result;
}

/// Rows over GF(2), each with a leading edge of its own.
class Independence {
 public:
  bool add(std::vector<std::uint32_t> row) {
    while (!row.empty()) {
      const auto with_same = rows_.find(row.front());
      if (with_same == rows_.end()) {
        const std::uint32_t leading = row.front();
        rows_.emplace(leading, std::move(row));
        return true;
      }
      std::vector<std::uint32_t> sum;
      std::set_symmetric_difference(row.begin(), row.end(), with_same->second.begin(), with_same->second.end(),
                                    std::back_inserter(sum));
      row = std::move(sum);
    }
    return false;
  }

 private:
  std::map<std::uint32_t, std::vector<std::uint32_t>> rows_;
};

}  // namespace

std::vector<std::vector<EdgeStep>> cycle_basis(std::size_t bodies, const std::vector<WeightedEdge>& edges) {
  const Graph graph(bodies, edges);
  Independence independence;
  std::vector<std::vector<EdgeStep>> basis;
  const std::vector<std::uint32_t> tree = graph.ways(0);
  const auto reached =
      static_cast<std::size_t>(std::count_if(tree.begin(), tree.end(), [](auto e) { return e != none; }));
  const std::size_t wanted = edges.size() - reached;
  const std::vector<Candidate> all = candidates(graph, bodies);
  std::vector<std::uint32_t> loops_through(edges.size(), 0);
  // Of equally light walks those come first that go on from the chosen ones by few joints, and that make few more of
  // these belong to several loops: shared joints couple the loops.
  const auto spread = [&](std::uint32_t index) {
    const auto through = [&](std::uint32_t loops) {
      return std::count_if(all[index].edges.begin(), all[index].edges.end(),
                           [&](std::uint32_t edge) { return loops_through[edge] == loops; });
    };
    return std::pair(through(0), through(1));
  };
  for (std::size_t first = 0; first < all.size() && basis.size() < wanted;) {
    std::size_t end = first;
    while (end < all.size() && all[end].key() == all[first].key()) ++end;
    std::deque<std::uint32_t> open;
    for (std::size_t i = first; i < end; ++i) open.push_back(static_cast<std::uint32_t>(i));
    while (!open.empty() && basis.size() < wanted) {
      auto next = open.begin();
      if (open.size() <= few) {
        next = std::min_element(open.begin(), open.end(),
                                [&](std::uint32_t x, std::uint32_t y) { return spread(x) < spread(y); });
      }
      const Candidate& candidate = all[*next];
      open.erase(next);
      if (!independence.add(candidate.edges)) continue;
      for (const std::uint32_t edge : candidate.edges) ++loops_through[edge];
      basis.push_back(graph.walk(candidate.edges));
    }
    first = end;
  }
  return basis;
}

}  // namespace koppel

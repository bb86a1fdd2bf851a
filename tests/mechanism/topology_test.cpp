// The spanning tree: fewest equations, parents first, chords in file order.
#include "mechanism/topology.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace koppel::test {
namespace {

Edge edge(std::uint32_t a, std::uint32_t b, std::uint32_t cost = 5) { return {BodyId{a}, BodyId{b}, cost}; }

/// Equations that are left: the sum over chords.
std::uint32_t cost_of(const std::vector<JointId>& chords, const std::vector<Edge>& edges) {
  return std::accumulate(chords.begin(), chords.end(), 0u,
                         [&](std::uint32_t sum, JointId i) { return sum + edges[i.index()].cost; });
}

TEST(Topology, OfAChainHasNoChords) {
  const Topology topology = span(3, {edge(1, 2), edge(0, 1)});
  EXPECT_TRUE(topology.chords.empty());
  ASSERT_EQ(topology.branches.size(), 2u);
  EXPECT_EQ(topology.branches[0].joint, JointId{1});
  EXPECT_EQ(topology.branches[1].child, BodyId{2});
}

TEST(Topology, CutsALoopWhereFewestEquationsRemain) {
  const Topology topology = span(4, {edge(0, 1), edge(0, 2), edge(2, 3, 4), edge(3, 1, 3)});
  ASSERT_EQ(topology.chords.size(), 1u);
  EXPECT_EQ(topology.chords[0], JointId{3});
}

TEST(Topology, AmongEqualsCutsTheLastInTheFile) {
  const Topology topology = span(3, {edge(0, 1), edge(1, 2), edge(2, 0)});
  ASSERT_EQ(topology.chords.size(), 1u);
  EXPECT_EQ(topology.chords[0], JointId{2});
}

TEST(Topology, CutsAllButOneOfParallelJoints) {
  const Topology topology = span(2, {edge(0, 1, 3), edge(1, 0, 6), edge(0, 1, 5)});
  EXPECT_EQ(topology.branches.size(), 1u);
  EXPECT_EQ(topology.branches[0].joint, JointId{1});
  EXPECT_EQ(topology.chords, (std::vector<JointId>{JointId{0}, JointId{2}}));
}

/// A connected graph: a random tree and some edges more, shuffled.
std::vector<Edge> random_graph(std::uint32_t bodies, std::uint32_t loops, std::mt19937& random) {
  std::vector<Edge> edges;
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  for (std::uint32_t i = 1; i < bodies; ++i) edges.push_back(edge(below(i), i, below(7)));
  for (std::uint32_t i = 0; i < loops; ++i) {
    const std::uint32_t a = below(bodies);
    edges.push_back(edge(a, (a + 1 + below(bodies - 1)) % bodies, below(7)));
  }
  std::shuffle(edges.begin(), edges.end(), random);
  return edges;
}

TEST(Topology, ReachesEveryBodyWithParentsFirstAndChordsInFileOrder) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<Edge> edges = random_graph(12, 5, random);
    const Topology topology = span(12, edges);
    std::set<std::uint32_t> reached{0};
    for (const Branch& branch : topology.branches) {
      EXPECT_TRUE(reached.contains(branch.parent.value));
      EXPECT_TRUE(reached.insert(branch.child.value).second);
      const Edge& e = edges[branch.joint.index()];
      EXPECT_TRUE((e.a == branch.parent && e.b == branch.child) || (e.b == branch.parent && e.a == branch.child));
    }
    EXPECT_EQ(reached.size(), 12u);
    EXPECT_EQ(topology.chords.size(), 5u);
    EXPECT_TRUE(std::is_sorted(topology.chords.begin(), topology.chords.end()));
  }
}

/// Whether leaving these edges out keeps all bodies together.
bool connected_without(std::size_t bodies, const std::vector<Edge>& edges, std::uint32_t left_out) {
  std::vector<bool> reached(bodies, false);
  reached[0] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if ((left_out >> i & 1u) != 0 || reached[edges[i].a.index()] == reached[edges[i].b.index()]) continue;
      reached[edges[i].a.index()] = reached[edges[i].b.index()] = true;
      grown = true;
    }
  }
  return std::all_of(reached.begin(), reached.end(), [](bool r) { return r; });
}

TEST(Topology, LeavesNoMoreEquationsThanAnyOtherChoice) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Edge> edges = random_graph(6, 3, random);
    std::uint32_t best = ~0u;
    for (std::uint32_t choice = 0; choice < 1u << edges.size(); ++choice) {
      std::vector<JointId> chords;
      for (std::uint32_t i = 0; i < edges.size(); ++i) {
        if ((choice >> i & 1u) != 0) chords.push_back({i});
      }
      if (chords.size() == 3 && connected_without(6, edges, choice)) best = std::min(best, cost_of(chords, edges));
    }
    EXPECT_EQ(cost_of(span(6, edges).chords, edges), best);
  }
}

}  // namespace
}  // namespace koppel::test

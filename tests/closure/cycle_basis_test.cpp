// Independent loops of a graph of bodies and joints: how many there are, that they are walks, and that none are
// lighter.
#include "closure/cycle_basis.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace koppel::test {
namespace {

using Edges = std::vector<WeightedEdge>;
using Basis = std::vector<std::vector<EdgeStep>>;
using Mask = std::uint64_t;  ///< a set of edges

Mask mask_of(const std::vector<EdgeStep>& walk) {
  Mask mask = 0;
  for (const EdgeStep& step : walk) mask ^= Mask{1} << step.edge;
  return mask;
}

std::uint64_t weight_of(const std::vector<EdgeStep>& walk, const Edges& edges) {
  return std::accumulate(walk.begin(), walk.end(), std::uint64_t{0},
                         [&](std::uint64_t sum, const EdgeStep& step) { return sum + edges[step.edge].weight; });
}

/// Rank over GF(2).
std::size_t rank(std::vector<Mask> rows) {
  std::size_t rank = 0;
  for (int bit = 63; bit >= 0; --bit) {
    const auto pivot = std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(rank), rows.end(),
                                    [&](Mask row) { return (row >> bit & 1) != 0; });
    if (pivot == rows.end()) continue;
    std::iter_swap(rows.begin() + static_cast<std::ptrdiff_t>(rank), pivot);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i != rank && (rows[i] >> bit & 1) != 0) rows[i] ^= rows[rank];
    }
    ++rank;
  }
  return rank;
}

/// Every step leaves from where the one before has arrived, the last arrives where the first left, and no body is
/// passed twice.
void expect_closed_walk(const std::vector<EdgeStep>& walk, const Edges& edges) {
  ASSERT_FALSE(walk.empty());
  const auto from = [&](const EdgeStep& step) { return step.reversed ? edges[step.edge].b : edges[step.edge].a; };
  const auto to = [&](const EdgeStep& step) { return step.reversed ? edges[step.edge].a : edges[step.edge].b; };
  std::set<std::uint32_t> bodies, used;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    EXPECT_EQ(to(walk[i]), from(walk[(i + 1) % walk.size()])) << "step " << i;
    EXPECT_TRUE(bodies.insert(from(walk[i])).second) << "body " << from(walk[i]) << " twice";
    EXPECT_TRUE(used.insert(walk[i].edge).second) << "joint " << walk[i].edge << " twice";
  }
}

Basis expect_basis(std::size_t bodies, const Edges& edges) {
  const Basis basis = cycle_basis(bodies, edges);
  EXPECT_EQ(basis.size(), edges.size() + 1 - bodies);
  std::vector<Mask> rows;
  for (const auto& walk : basis) {
    expect_closed_walk(walk, edges);
    rows.push_back(mask_of(walk));
  }
  EXPECT_EQ(rank(rows), basis.size()) << "independent";
  for (std::size_t i = 1; i < basis.size(); ++i) {
    EXPECT_LE(weight_of(basis[i - 1], edges), weight_of(basis[i], edges)) << "the lightest come first";
  }
  return basis;
}

/// Weights of a lightest basis, found among all sums of any basis: the greedy choice is right for a matroid.
std::vector<std::uint64_t> least_weights(const Basis& any, const Edges& edges) {
  std::vector<std::pair<std::uint64_t, Mask>> all;
  for (Mask choice = 1; choice < Mask{1} << any.size(); ++choice) {
    Mask sum = 0;
    for (std::size_t i = 0; i < any.size(); ++i) {
      if ((choice >> i & 1) != 0) sum ^= mask_of(any[i]);
    }
    std::uint64_t weight = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) weight += (sum >> i & 1) * edges[i].weight;
    all.emplace_back(weight, sum);
  }
  std::sort(all.begin(), all.end());
  std::vector<Mask> rows;
  std::vector<std::uint64_t> weights;
  for (const auto& [weight, sum] : all) {
    rows.push_back(sum);
    if (rank(rows) == rows.size()) {
      weights.push_back(weight);
    } else {
      rows.pop_back();
    }
  }
  return weights;
}

/// Bodies that hang together by different joints, as those of a mechanism do: a random tree and `more` joints.
Edges random_graph(std::uint32_t bodies, std::uint32_t more, std::uint32_t heaviest, std::mt19937& random) {
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  Edges edges;
  for (std::uint32_t i = 1; i < bodies; ++i) edges.push_back({below(i), i, below(heaviest + 1)});
  for (std::uint32_t i = 0; i < more; ++i) {
    const std::uint32_t a = below(bodies);
    edges.push_back({a, (a + 1 + below(bodies - 1)) % bodies, below(heaviest + 1)});
  }
  std::shuffle(edges.begin(), edges.end(), random);
  return edges;
}

std::vector<std::uint64_t> weights_of(const Basis& basis, const Edges& edges) {
  std::vector<std::uint64_t> weights;
  for (const auto& walk : basis) weights.push_back(weight_of(walk, edges));
  return weights;
}

/// As many legs of `joints` joints each between body 0 and body 1.
Edges legs(std::uint32_t count, std::uint32_t joints) {
  Edges edges;
  std::uint32_t next = 2;
  for (std::uint32_t leg = 0; leg < count; ++leg) {
    std::uint32_t at = 0;
    for (std::uint32_t k = 0; k < joints; ++k) {
      const std::uint32_t to = k + 1 == joints ? 1 : next++;
      edges.push_back({at, to, k % 3 + 1});
      at = to;
    }
  }
  return edges;
}

std::size_t bodies_of(const Edges& edges) {
  std::uint32_t last = 0;
  for (const WeightedEdge& edge : edges) last = std::max({last, edge.a, edge.b});
  return last + 1;
}

// ------------------------------------------------------------------ known graphs

TEST(CycleBasis, OfATreeIsEmpty) {
  EXPECT_TRUE(expect_basis(1, {}).empty());
  EXPECT_TRUE(expect_basis(5, {{0, 1}, {1, 2}, {1, 3}, {4, 0}}).empty());
}

TEST(CycleBasis, OfOneLoopIsTheLoop) {
  const Edges edges{{0, 1}, {2, 1}, {2, 3}, {0, 3}};
  const Basis basis = expect_basis(4, edges);
  ASSERT_EQ(basis.size(), 1u);
  EXPECT_EQ(basis[0].size(), 4u);
}

TEST(CycleBasis, OfATetrahedronIsThreeOfItsFaces) {
  const Basis basis = expect_basis(4, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}});
  ASSERT_EQ(basis.size(), 3u);
  for (const auto& walk : basis) EXPECT_EQ(walk.size(), 3u);
}

TEST(CycleBasis, OfAThetaLeavesOutItsLongestLoop) {
  // Three ways from 0 to 1, of one, two and three joints.
  const Edges edges{{0, 1}, {0, 2}, {2, 1}, {0, 3}, {3, 4}, {4, 1}};
  const Basis basis = expect_basis(5, edges);
  ASSERT_EQ(basis.size(), 2u);
  EXPECT_EQ(basis[0].size(), 3u);
  EXPECT_EQ(basis[1].size(), 4u);
}

TEST(CycleBasis, TwoJointsBetweenTheSameBodiesAreALoop) {
  const Basis basis = expect_basis(2, {{0, 1}, {0, 1}, {1, 0}});
  ASSERT_EQ(basis.size(), 2u);
  for (const auto& walk : basis) EXPECT_EQ(walk.size(), 2u);
}

TEST(CycleBasis, PrefersFewFreedomsToFewJoints) {
  // From 0 to 1 by one joint of five freedoms, or over three bodies by joints of one each.
  const Basis basis = expect_basis(5, {{0, 1, 5}, {0, 2, 1}, {2, 3, 1}, {3, 1, 1}, {0, 4, 2}, {4, 1, 2}});
  ASSERT_EQ(basis.size(), 2u);
  EXPECT_EQ(mask_of(basis[0]), 0b111110u);
}

// A weld has no freedom; yet each makes a loop longer.
TEST(CycleBasis, ChainsOfWeldsAreNoDetour) {
  Edges edges{{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {0, 3, 0}, {3, 4, 1}, {4, 0, 1}, {3, 5, 1}, {5, 0, 1}};
  const Basis basis = expect_basis(6, edges);
  ASSERT_EQ(basis.size(), 3u);
  EXPECT_EQ(mask_of(basis[0]), 0b1111u) << "welds alone";
  EXPECT_EQ(basis[1].size(), 3u) << "over the one weld, not over the three";
  EXPECT_EQ(basis[2].size(), 3u);
}

// ------------------------------------------------------------------ properties

TEST(CycleBasis, IsTheLightestOfAll) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 400; ++trial) {
    const auto bodies = static_cast<std::uint32_t>(2 + random() % 6), more = static_cast<std::uint32_t>(random() % 8);
    const Edges edges = random_graph(bodies, more, trial % 2 == 0 ? 3 : 1000, random);
    const Basis basis = expect_basis(bodies, edges);
    EXPECT_EQ(weights_of(basis, edges), least_weights(basis, edges)) << "trial " << trial;
    if (HasFailure()) return;
  }
}

/// What does not depend on names and order: each loop as the set of its joints' weights, all of which differ.
std::set<std::set<std::uint32_t>> by_weights(const Basis& basis, const Edges& edges) {
  std::set<std::set<std::uint32_t>> loops;
  for (const auto& walk : basis) {
    std::set<std::uint32_t> loop;
    for (const EdgeStep& step : walk) loop.insert(edges[step.edge].weight);
    loops.insert(loop);
  }
  return loops;
}

TEST(CycleBasis, DoesNotDependOnTheOrderOfJointsAndBodies) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const auto bodies = static_cast<std::uint32_t>(3 + random() % 6), more = static_cast<std::uint32_t>(random() % 8);
    Edges edges = random_graph(bodies, more, 0, random);
    // Powers of two: no two sets of joints weigh the same, and the lightest basis is unique.
    for (std::size_t i = 0; i < edges.size(); ++i) edges[i].weight = 1u << i;
    const auto loops = by_weights(cycle_basis(bodies, edges), edges);
    for (int again = 0; again < 5; ++again) {
      std::vector<std::uint32_t> name(bodies);
      std::iota(name.begin(), name.end(), 0u);
      std::shuffle(name.begin(), name.end(), random);
      Edges other = edges;
      for (WeightedEdge& edge : other) {
        edge = {name[edge.a], name[edge.b], edge.weight};
        if (random() % 2 == 0) std::swap(edge.a, edge.b);
      }
      std::shuffle(other.begin(), other.end(), random);
      EXPECT_EQ(by_weights(cycle_basis(bodies, other), other), loops) << "trial " << trial;
    }
  }
}

// Legs that are all alike: every loop is two of them, and all loops share one leg, so that few joints couple them.
TEST(CycleBasis, LoopsOfAPlatformShareOneLeg) {
  for (std::uint32_t joints = 1; joints <= 3; ++joints) {
    const Edges edges = legs(6, joints);
    const Basis basis = expect_basis(bodies_of(edges), edges);
    ASSERT_EQ(basis.size(), 5u);
    std::map<std::uint32_t, int> loops_through;
    for (const auto& walk : basis) {
      EXPECT_EQ(walk.size(), 2 * joints) << "each loop is two legs";
      for (const EdgeStep& step : walk) ++loops_through[step.edge];
    }
    const auto shared =
        std::count_if(loops_through.begin(), loops_through.end(), [](const auto& joint) { return joint.second > 1; });
    EXPECT_EQ(shared, joints) << joints << " joints in each leg";
  }
}

/// A ladder of many rungs, beyond the size up to which all walks are looked at.
TEST(CycleBasis, OfALongLadderIsItsMeshes) {
  constexpr std::uint32_t rungs = 520;
  Edges edges;
  for (std::uint32_t i = 0; i < rungs; ++i) {
    edges.push_back({2 * i, 2 * i + 1, 1});
    if (i == 0) continue;
    edges.push_back({2 * i - 2, 2 * i, 1});
    edges.push_back({2 * i + 1, 2 * i - 1, 1});
  }
  const Basis basis = cycle_basis(2 * rungs, edges);
  ASSERT_EQ(basis.size(), rungs - 1);
  std::set<std::set<std::uint32_t>> different;
  for (const auto& walk : basis) {
    EXPECT_EQ(walk.size(), 4u);
    expect_closed_walk(walk, edges);
    std::set<std::uint32_t> mesh;
    for (const EdgeStep& step : walk) mesh.insert(step.edge);
    different.insert(mesh);
  }
  EXPECT_EQ(different.size(), rungs - 1) << "each mesh once";
}

/// The same where all stands on one body, and couplers join neighbours: every walk might pass the ground.
TEST(CycleBasis, OfManyFourBarsInARowIsEachOfThem) {
  constexpr std::uint32_t loops = 1000;
  Edges edges{{0, 1}};
  for (std::uint32_t i = 1; i <= loops; ++i) {
    const std::uint32_t before = 2 * i - 1, coupler = 2 * i, bar = 2 * i + 1;
    edges.insert(edges.end(), {{0, bar}, {before, coupler}, {coupler, bar}});
  }
  const Basis basis = cycle_basis(2 * loops + 2, edges);
  ASSERT_EQ(basis.size(), loops);
  std::set<std::uint32_t> couplers;
  for (const auto& walk : basis) {
    EXPECT_EQ(walk.size(), 4u);
    expect_closed_walk(walk, edges);
    for (const EdgeStep& step : walk) {
      if (edges[step.edge].a % 2 == 0 && edges[step.edge].a != 0) couplers.insert(edges[step.edge].a);
    }
  }
  EXPECT_EQ(couplers.size(), loops) << "each once";
}

}  // namespace
}  // namespace koppel::test

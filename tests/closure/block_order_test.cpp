// Which equations can be solved for themselves: small systems by hand, and all sets of groups tried one by one.
#include "closure/block_order.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace koppel::test {
namespace {

using Groups = std::vector<std::uint32_t>;
using Equations = std::vector<BlockEquation>;

TEST(LeastBlock, OfNothingIsNothing) {
  EXPECT_EQ(least_block({}, 0), Groups{});
  EXPECT_EQ(least_block({}, 3), Groups{});
}

TEST(LeastBlock, IsOneOfIndependentEquations) {
  EXPECT_EQ(least_block({{0, {0}}}, 1), Groups{0});
  EXPECT_EQ(least_block({{0, {1}}, {1, {0}}}, 2).size(), 1u);
}

TEST(LeastBlock, IsTheFirstLinkOfAChain) {
  // Each needs what the one after it gives.
  EXPECT_EQ(least_block({{0, {0, 1}}, {1, {1, 2}}, {2, {2}}}, 3), Groups{2});
}

TEST(LeastBlock, HoldsWhatIsCoupled) {
  EXPECT_EQ(least_block({{0, {0, 1}}, {1, {0, 1}}}, 2), (Groups{0, 1}));
  // A ring of three, and one that needs them.
  EXPECT_EQ(least_block({{0, {0, 1}}, {1, {1, 2}}, {2, {2, 0}}, {3, {3, 0}}}, 4), (Groups{0, 1, 2}));
}

TEST(LeastBlock, IsTheSmallerOneOfTwo) {
  EXPECT_EQ(least_block({{0, {0, 1}}, {1, {0, 1}}, {2, {2}}, {3, {3, 2}}}, 4), Groups{2});
}

TEST(LeastBlock, LeavesOutWhatIsFree) {
  EXPECT_EQ(least_block({{0, {0, 1}}}, 2), Groups{});
  EXPECT_EQ(least_block({{0, {0, 1}}, {1, {2}}}, 3), Groups{1});
  EXPECT_EQ(least_block({{0, {0, 1, 2}}, {1, {0, 1, 2}}}, 3), Groups{});
}

TEST(LeastBlock, TakesRedundantEquationsAsTheyAre) {
  EXPECT_EQ(least_block({{0, {0}}, {0, {0}}}, 1), Groups{0}) << "two equations of one group";
  EXPECT_EQ(least_block({{0, {0}}, {1, {0}}}, 1).size(), 1u) << "either of two groups";
  EXPECT_EQ(least_block({{0, {0, 1}}, {0, {0, 1}}, {0, {0, 1}}, {1, {1, 2}}}, 3), Groups{0});
}

TEST(LeastBlock, KeepsTheEquationsOfAGroupTogether) {
  // The second equation alone would give its unknown, but the first comes with it and needs what the other group gives.
  EXPECT_EQ(least_block({{0, {0, 1}}, {0, {2}}, {1, {1}}, {1, {1, 3}}}, 4), (Groups{1}));
  EXPECT_EQ(least_block({{0, {0, 1}}, {0, {2}}, {1, {1, 0}}}, 3), (Groups{0, 1}));
}

TEST(LeastBlock, SkipsNumbersOfGroupsThatAreNotThere) { EXPECT_EQ(least_block({{5, {0}}, {2, {0, 1}}}, 2), Groups{5}); }

// ------------------------------------------------------------------ all sets

/// Whether every unknown can have an equation of its own.
bool determined(const Equations& equations, const Groups& groups) {
  std::set<std::uint32_t> unknowns;
  std::vector<const BlockEquation*> here;
  for (const BlockEquation& equation : equations) {
    if (std::find(groups.begin(), groups.end(), equation.group) == groups.end()) continue;
    here.push_back(&equation);
    unknowns.insert(equation.unknowns.begin(), equation.unknowns.end());
  }
  // Hall: any unknowns are in at least as many equations.
  const std::vector<std::uint32_t> all(unknowns.begin(), unknowns.end());
  for (std::uint32_t some = 1; some < 1u << all.size(); ++some) {
    const auto chosen = [&](std::uint32_t unknown) {
      const auto at = std::find(all.begin(), all.end(), unknown) - all.begin();
      return (some >> at & 1) != 0;
    };
    const auto hit = std::count_if(here.begin(), here.end(), [&](const BlockEquation* equation) {
      return std::any_of(equation->unknowns.begin(), equation->unknowns.end(), chosen);
    });
    if (hit < __builtin_popcount(some)) return false;
  }
  return !here.empty();
}

/// The size of the least set of groups that determine their unknowns; 0: none does.
std::size_t least_size(const Equations& equations, std::uint32_t groups) {
  std::size_t least = 0;
  for (std::uint32_t some = 1; some < 1u << groups; ++some) {
    Groups chosen;
    for (std::uint32_t g = 0; g < groups; ++g) {
      if ((some >> g & 1) != 0) chosen.push_back(g);
    }
    if ((least == 0 || chosen.size() < least) && determined(equations, chosen)) least = chosen.size();
  }
  return least;
}

/// Groups of one to three equations in the same unknowns, as loops enter a block.
Equations random_system(std::uint32_t groups, std::uint32_t unknowns, std::mt19937& random) {
  Equations equations;
  for (std::uint32_t group = 0; group < groups; ++group) {
    std::vector<std::uint32_t> all(unknowns);
    std::iota(all.begin(), all.end(), 0u);
    std::shuffle(all.begin(), all.end(), random);
    all.resize(1 + random() % std::min<std::size_t>(3, unknowns));
    equations.insert(equations.end(), 1 + random() % 2, BlockEquation{group, all});
  }
  std::shuffle(equations.begin(), equations.end(), random);
  return equations;
}

/// Whether some equation says what others say already, as far as the incidence tells.
bool has_redundant(const Equations& equations, std::uint32_t unknowns) {
  // As above, with the parts exchanged.
  std::vector<BlockEquation> of_unknown(unknowns);
  for (std::uint32_t e = 0; e < equations.size(); ++e) {
    for (const std::uint32_t u : equations[e].unknowns) of_unknown[u].unknowns.push_back(e);
  }
  return !determined(of_unknown, {0});
}

TEST(LeastBlock, IsAsSmallAsCanBe) {
  std::mt19937 random(1);
  int found = 0, several = 0, none = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const auto groups = static_cast<std::uint32_t>(1 + random() % 5),
               unknowns = static_cast<std::uint32_t>(2 + random() % 6);
    const Equations equations = random_system(groups, unknowns, random);
    if (has_redundant(equations, unknowns)) continue;
    const Groups block = least_block(equations, unknowns);
    (block.empty() ? none : block.size() > 1 ? several : found) += 1;
    EXPECT_TRUE(block.empty() || determined(equations, block)) << "trial " << trial;
    EXPECT_EQ(block.size(), least_size(equations, groups)) << "trial " << trial;
  }
  EXPECT_GT(std::min({found, several, none}), 20) << "of every kind there are many";
}

TEST(LeastBlock, IsFoundAmongRedundantEquationsToo) {
  std::mt19937 random(2);
  int found = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const auto groups = static_cast<std::uint32_t>(1 + random() % 5),
               unknowns = static_cast<std::uint32_t>(2 + random() % 6);
    const Equations equations = random_system(groups, unknowns, random);
    if (!has_redundant(equations, unknowns)) continue;
    const Groups block = least_block(equations, unknowns);
    found += block.empty() ? 0 : 1;
    EXPECT_TRUE(block.empty() || determined(equations, block)) << "trial " << trial;
    EXPECT_EQ(block.empty(), least_size(equations, groups) == 0) << "trial " << trial;
  }
  EXPECT_GT(found, 100);
}

}  // namespace
}  // namespace koppel::test

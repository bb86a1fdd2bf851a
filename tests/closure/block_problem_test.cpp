// A numerical block over the complex numbers: its derivatives are those of its equations, its seeds solve it, and it
// has as many solutions as are known of mechanisms of its kind.
#include "closure/block_problem.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "closure/loop_cut.hpp"
#include "random_loop.hpp"

namespace koppel::test {
namespace {

using Family = BlockProblem::Family;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// A block with the place where it stands.
struct Block {
  std::string name;
  Flow flow;
  FlowStep step;
  Eigen::VectorXd q;  ///< closed, or nearly

  BlockProblem problem(Family family) const { return {flow, step, q, family}; }
};

/// The numerical step of a shipped scene, where the mechanism is closed at its start.
Block shipped_block(const std::string& scene) {
  Closed closed(shipped(scene));
  EXPECT_GE(closed.close(), 0);
  Block block{scene, plan_flow(*closed.built), {}, closed.state.q};
  // Imaginary joints have places behind those of the state; where they stand is not asked here.
  const auto more = 7 * static_cast<Eigen::Index>(block.flow.loops.imaginary.size());
  block.q.conservativeResizeLike(Eigen::VectorXd::Ones(block.q.size() + more));
  for (const FlowStep& step : block.flow.steps) {
    if (step.kind == StepKind::numerical) block.step = step;
  }
  EXPECT_EQ(block.step.kind, StepKind::numerical) << scene;
  return block;
}

LoopJoint of_type(const std::string& type) { return {type, "", false, false, false}; }

/// A loop of one-freedom joints, the last of them driven, that enters as a whole.
Block whole_loop(int slides) {
  std::vector<LoopJoint> joints;
  for (int i = 0; i < 6; ++i) joints.push_back(of_type(i % 2 == 1 && i / 2 < slides ? "prismatic" : "revolute"));
  joints.push_back({"revolute", "angle", false, false, false});
  Random random(31 + static_cast<unsigned>(slides));
  const RandomLoop loop = random_loop(joints, random);
  const Built built(loop.text);
  Block block{std::to_string(slides) + "_slides", plan_flow(*built), {}, loop.known};
  block.step = {};
  block.step.kind = StepKind::numerical;
  block.step.unknowns = {0, 1, 2, 3, 4, 5};
  block.step.whole_loops = {0};
  return block;
}

/// A loop that is cut at a pair: all conditions of the pair, and as many unknowns as there are conditions.
Block pair_block(const std::string& name, CutShape a, CutShape b, const std::vector<LoopJoint>& joints) {
  Random random(7);
  const RandomLoop text = random_loop(joints, random);
  const Built built(text.text);
  Block block{name, {}, {}, text.known};
  block.flow.loops = find_loops(*built).loops;
  block.flow.length = 1.0;
  const Loop& loop = block.flow.loops.loops.at(0);
  const std::size_t n = loop.motions.size();
  std::optional<CutJoint> one, other;
  for (std::size_t first = 0; first < n; ++first) {
    for (const std::size_t count : {1u, 2u, 3u}) {
      const auto joint = cut_joint(loop, block.flow.loops.variables, first, count, 1.0);
      if (!joint) continue;
      if (!one && joint->shape == a) {
        one = joint;
      } else if (joint->shape == b && first >= one.value_or(CutJoint{}).first + one.value_or(CutJoint{}).count) {
        other = joint;
      }
    }
  }
  if (!one || !other) throw std::runtime_error("no such pair: " + name);
  const auto conditions = pair_conditions(a, b);
  block.flow.cuts.push_back({0, *one, *other, {conditions.begin(), conditions.end()}});
  for (std::uint32_t k = 0; k < conditions.size(); ++k) block.step.rows.push_back({0, k, {}});
  Eigen::Index freedoms = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (block.flow.cuts[0].hides(i, n)) continue;
    const std::uint32_t v = loop.motions[i].variable;
    freedoms += block.flow.loops.variables[v].kind == VariableKind::ball ? 3 : 1;
    if (freedoms <= static_cast<Eigen::Index>(conditions.size())) block.step.unknowns.push_back(v);
  }
  std::sort(block.step.unknowns.begin(), block.step.unknowns.end());
  block.step.kind = StepKind::numerical;
  return block;
}

const LoopJoint ball = of_type("spherical"), turn = of_type("revolute"), slide = of_type("prismatic"),
                cylinder = of_type("cylindrical"), plane = of_type("planar");

struct Made {
  std::string name;
  std::function<Block()> make;
};

const std::vector<Made> blocks{
    {"multilink", [] { return shipped_block("multilink"); }},
    {"7r", [] { return shipped_block("7r"); }},
    {"stewart", [] { return shipped_block("stewart"); }},
    {"no_slides", [] { return whole_loop(0); }},
    {"one_slide", [] { return whole_loop(1); }},
    {"two_slides", [] { return whole_loop(2); }},
    {"three_slides", [] { return whole_loop(3); }},
    {"C_C",
     [] {
       return pair_block("C_C", CutShape::cylinder, CutShape::cylinder, {cylinder, turn, cylinder, slide, turn});
     }},
    {"S_R",
     [] {
       return pair_block("S_R", CutShape::ball, CutShape::turn, {ball, turn, slide, turn, slide});
     }},
    {"E_R",
     [] {
       return pair_block("E_R", CutShape::plane, CutShape::turn, {plane, slide, turn, turn});
     }},
    {"C_R",
     [] {
       return pair_block("C_R", CutShape::cylinder, CutShape::turn, {cylinder, ball, slide, turn});
     }},
    {"R_R",
     [] {
       return pair_block("R_R", CutShape::turn, CutShape::turn, {turn, ball, slide, turn, slide});
     }},
    {"R_P",
     [] {
       return pair_block("R_P", CutShape::turn, CutShape::slide, {turn, ball, turn, slide});
     }},
    {"P_P", [] {
       return pair_block("P_P", CutShape::slide, CutShape::slide, {slide, ball, turn, slide, turn});
     }}};

void PrintTo(const Made& block, std::ostream* out) { *out << block.name; }

struct ABlock : testing::TestWithParam<Made> {
  /// Made once; the tests only look.
  const Block& block() const {
    static std::map<std::string, Block> all;
    const auto found = all.find(GetParam().name);
    return found != all.end() ? found->second : all.emplace(GetParam().name, GetParam().make()).first->second;
  }
};

INSTANTIATE_TEST_SUITE_P(Closure, ABlock, testing::ValuesIn(blocks),
                         [](const auto& test) { return std::string("of_").append(test.param.name); });

constexpr Family families[] = {Family::these_measures, Family::all_measures};

ComplexVector random_vector(Eigen::Index size, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return ComplexVector::NullaryExpr(size, [&] { return Complex(normal(random), normal(random)) / 2.0; });
}

double largest(const ComplexMatrix& m) { return m.size() == 0 ? 0.0 : m.cwiseAbs().maxCoeff(); }

// The difference over four points, so far apart that what it leaves out of a series, h^4, and what rounding adds,
// eps/h, are alike.
const double h = std::pow(eps, 1.0 / 5.0);
template <typename Function>
ComplexVector difference_quotient(const Function& at) {
  return (8.0 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12.0 * h);
}
// eps^(4/5) is 3e-13; the fifth derivative of a product of trigonometric functions of a few complex angles, and its
// terms, are a thousand times as large as the first at most.
constexpr double of_difference = 1e-9;

ComplexVector residual(BlockProblem& problem, const ComplexVector& x, const ComplexVector& p) {
  ComplexVector result;
  problem.evaluate(x, p, result, nullptr, nullptr, nullptr);
  return result;
}

TEST_P(ABlock, HasTheJacobianOfItsEquations) {
  for (const Family family : families) {
    BlockProblem problem = block().problem(family);
    ASSERT_TRUE(problem.is_square());
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 5; ++trial) {
      ComplexVector x, p, r, moved;
      ASSERT_TRUE(problem.seed(random, x, p));
      p += random_vector(problem.parameters(), random) / 4.0;  // no solution any more
      ComplexMatrix jacobian;
      problem.evaluate(x, p, r, &jacobian, nullptr, nullptr);
      ASSERT_EQ(jacobian.rows(), problem.unknowns());
      ASSERT_EQ(jacobian.cols(), problem.unknowns());
      EXPECT_EQ(r, residual(problem, x, p)) << "the same with and without derivatives";
      const double allowed = of_difference * (1.0 + largest(jacobian) + largest(r));
      for (Eigen::Index j = 0; j < problem.unknowns(); ++j) {
        const ComplexVector by = difference_quotient([&](double t) {
          problem.move(x, t * ComplexVector::Unit(problem.unknowns(), j), moved);
          return residual(problem, moved, p);
        });
        EXPECT_LE(largest(jacobian.col(j) - by), allowed) << "unknown " << j;
      }
    }
  }
}

TEST_P(ABlock, HasTheDerivativeByItsParameters) {
  for (const Family family : families) {
    BlockProblem problem = block().problem(family);
    std::mt19937_64 random(2);
    for (int trial = 0; trial < 10; ++trial) {
      ComplexVector x, p, r, along;
      ASSERT_TRUE(problem.seed(random, x, p));
      // Anywhere but near poles: displacements have Rodrigues parameters, whose square is not to come near -1.
      p = random_vector(problem.parameters(), random) / 4.0;
      const ComplexVector dp = random_vector(problem.parameters(), random);
      problem.evaluate(x, p, r, nullptr, &dp, &along);
      const ComplexVector by =
          difference_quotient([&](double t) { return residual(problem, x, ComplexVector(p + t * dp)); });
      EXPECT_LE(largest(along - by), of_difference * (1.0 + largest(along) + largest(by)));
    }
  }
}

// A walk is a product of some twenty matrices; at a complex place their entries are larger than one, as the Jacobian
// shows.
TEST_P(ABlock, IsSolvedByItsSeeds) {
  for (const Family family : families) {
    BlockProblem problem = block().problem(family);
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 20; ++trial) {
      ComplexVector x, p, r;
      ASSERT_TRUE(problem.seed(random, x, p));
      ComplexMatrix jacobian;
      problem.evaluate(x, p, r, &jacobian, nullptr, nullptr);
      const double terms = std::max({1.0, largest(jacobian), largest(p)});
      EXPECT_LE(largest(r), 100 * 20 * eps * terms * terms);
      EXPECT_GT(largest(x.imag().cast<Complex>()), 0.01) << "not real";
    }
  }
}

TEST_P(ABlock, MovesOnItsManifold) {
  BlockProblem problem = block().problem(Family::these_measures);
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 10; ++trial) {
    ComplexVector x, p, moved, lifted, scratch, print, moved_print;
    ASSERT_TRUE(problem.seed(random, x, p));
    problem.move(x, ComplexVector::Zero(problem.unknowns()), moved);
    ASSERT_EQ(moved.size(), problem.point_size());
    // The length of (cos, sin) or of a quaternion is mended; it is a sum of squares that cancel to one.
    const double rounding = eps * std::pow(std::max(1.0, largest(x)), 3);
    EXPECT_LE(largest(moved - x), 8 * rounding) << "nowhere";
    const ComplexVector rate = random_vector(problem.unknowns(), random);
    problem.lift(x, rate, lifted, scratch);
    const ComplexVector by = difference_quotient([&](double t) {
      ComplexVector there;
      problem.move(x, t * rate, there);
      return there;
    });
    EXPECT_LE(largest(lifted - by), of_difference * (1.0 + largest(lifted))) << "at the rate";
    // Steps are Cayley's: the way back leads back.
    problem.move(x, 1e-6 * rate, moved);
    problem.move(ComplexVector(moved), ComplexVector(-1e-6 * rate), scratch);
    EXPECT_LE(largest(scratch - x), 32 * rounding);
    problem.fingerprint(x, print);
    problem.fingerprint(moved, moved_print);
    ASSERT_EQ(print.size(), moved_print.size());
    EXPECT_GT(largest(print - moved_print), 1e-8 * largest(rate)) << "another place, another print";
  }
}

Eigen::Index numbers_of(VariableKind kind) {
  return kind == VariableKind::turn ? 2 : kind == VariableKind::slide ? 1 : 4;
}

/// The place of the unknowns at q.
ComplexVector point(const Block& block) {
  ComplexVector x(64);
  Eigen::Index next = 0;
  for (const std::uint32_t v : block.step.unknowns) {
    const Variable& variable = block.flow.loops.variables[v];
    const Place<double> at = place(variable, block.q.data());
    const double unit = variable.kind == VariableKind::slide ? block.flow.length : 1.0;
    const auto numbers = static_cast<std::size_t>(numbers_of(variable.kind));
    for (std::size_t i = 0; i < numbers; ++i) x[next++] = at[i] / unit;
  }
  return x.head(next);
}

/// Coordinates of imaginary joints are not those of a state.
bool imaginary(const Block& block) { return !block.flow.loops.imaginary.empty(); }

TEST_P(ABlock, IsSolvedByTheMechanismAsItIs) {
  if (imaginary(block())) GTEST_SKIP() << "auxiliary coordinates are in no state";
  const ComplexVector x = point(block());
  for (const Family family : families) {
    BlockProblem problem = block().problem(family);
    ASSERT_EQ(x.size(), problem.point_size());
    const ComplexVector r = residual(problem, x, ComplexVector::Zero(problem.parameters()));
    // Closed to 1e-13 of the length; or built to a few roundings. A squared distance of some lengths takes that
    // several times.
    EXPECT_LE(largest(r), 1e-13 * 20);
  }
}

TEST_P(ABlock, ReadsItsPointBack) {
  if (imaginary(block())) GTEST_SKIP() << "auxiliary coordinates are in no state";
  const Eigen::VectorXd& here = block().q;
  Eigen::VectorXd q = here;
  block().problem(Family::these_measures).read(point(block()), q);
  EXPECT_LE((q - here).lpNorm<Eigen::Infinity>(), 8 * eps * (1.0 + here.lpNorm<Eigen::Infinity>()));
}

// A quaternion and its opposite are one rotation.
TEST_P(ABlock, HasOnePrintForOppositeQuaternions) {
  BlockProblem problem = block().problem(Family::these_measures);
  std::mt19937_64 random(5);
  ComplexVector x, p, print, other;
  ASSERT_TRUE(problem.seed(random, x, p));
  problem.fingerprint(x, print);
  Eigen::Index at = 0, balls = 0;
  for (const std::uint32_t v : block().step.unknowns) {
    const Eigen::Index numbers = numbers_of(block().flow.loops.variables[v].kind);
    if (numbers == 4) x.segment(at, numbers) *= -1.0, ++balls;
    at += numbers;
  }
  if (balls == 0) GTEST_SKIP() << "no ball";
  problem.fingerprint(x, other);
  EXPECT_EQ(print, other);
}

// ------------------------------------------------------------------ how many solutions

TEST(BlockProblem, KnowsHowManySolutionsItsKindHas) {
  EXPECT_EQ(shipped_block("7r").problem(Family::these_measures).known_count(), 16);
  EXPECT_EQ(shipped_block("multilink").problem(Family::these_measures).known_count(), 40);
  const Eigen::Index counts[] = {16, 16, 8, 2};
  for (int slides = 0; slides <= 3; ++slides) {
    EXPECT_EQ(whole_loop(slides).problem(Family::these_measures).known_count(), counts[slides]) << slides;
  }
}

TEST(BlockProblem, HasAsManySolutionsAsItsKind) {
  for (int slides = 0; slides <= 3; ++slides) {
    BlockProblem problem = whole_loop(slides).problem(Family::these_measures);
    ContinuationOptions options;
    options.known_count = problem.known_count();
    const AllSolutions all = find_all(problem, ComplexVector::Zero(problem.parameters()), options);
    EXPECT_TRUE(all.complete()) << slides;
    EXPECT_EQ(all.generic, problem.known_count()) << slides << " slides";
    EXPECT_EQ(all.unpaired, 0);
    EXPECT_GE(all.real, 1) << "the position of which the measures were made";
  }
}

TEST(BlockProblem, OfAWheelCarrierHasForty) {
  BlockProblem problem = shipped_block("multilink").problem(Family::these_measures);
  ContinuationOptions options;
  options.known_count = problem.known_count();
  const GenericSolutions generic = find_generic(problem, options);
  EXPECT_TRUE(generic.settled);
  EXPECT_EQ(generic.count(), 40);
}

// Without being told how many there are, monodromy finds as many and no more.
TEST(BlockProblem, OfALoopWithThreeSlidesHasTwoAndNoMore) {
  BlockProblem problem = whole_loop(3).problem(Family::all_measures);
  const GenericSolutions generic = find_generic(problem, {});
  EXPECT_TRUE(generic.settled);
  EXPECT_EQ(generic.count(), 2);
}

TEST(BlockProblem, IsNoneWithFewerConditionsThanUnknowns) {
  Block block = pair_block("C_C", CutShape::cylinder, CutShape::cylinder, {cylinder, turn, cylinder, slide, turn});
  block.step.rows.pop_back();
  EXPECT_FALSE(block.problem(Family::these_measures).is_square());
}

TEST(BlockProblem, CombinesConditionsWhereThereAreMoreThanUnknowns) {
  Block block = pair_block("C_C", CutShape::cylinder, CutShape::cylinder, {cylinder, turn, cylinder, slide, turn});
  block.step.unknowns.pop_back();
  BlockProblem problem = block.problem(Family::these_measures);
  ASSERT_TRUE(problem.is_square());
  EXPECT_EQ(residual(problem, point(block), ComplexVector::Zero(problem.parameters())).size(), 1);
}

}  // namespace
}  // namespace koppel::test

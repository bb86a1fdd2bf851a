// All solutions of polynomials whose number is known, and of targets where paths meet or run away.
#include "closure/continuation.hpp"

#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "closure/continuation_path.hpp"
#include "continuation_polynomials.hpp"

namespace koppel::test {
namespace {

/// Random real coefficients.
ComplexVector real_target(const Polynomials& problem, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  ComplexVector target(problem.coefficients);
  for (Complex& value : target) value = uniform(random);
  return target;
}

/// Every regular solution solves the equations: the residual's own rounding is a few of its largest term.
void expect_solved(const AllSolutions& all, double largest_term) {
  for (const ContinuationSolution& solution : all.solutions) {
    if (solution.end == PathEnd::regular) {
      EXPECT_LE(solution.residual, 100.0 * std::numeric_limits<double>::epsilon() * largest_term);
    }
  }
}

Polynomials fifth_root() {
  Polynomials problem;
  problem.add(0, {0, 0, 0, 0, 0});
  problem.add(0, {});
  return problem;
}

TEST(Continuation, LuSolvesAndNoticesSingularMatrices) {
  std::mt19937_64 random(3);
  for (Eigen::Index n = 1; n <= 30; ++n) {
    ComplexMatrix a(n, n);
    ComplexVector x(n);
    for (Complex& value : a.reshaped()) value = uniform_complex(random);
    for (Complex& value : x) value = uniform_complex(random);
    SmallLu lu(n);
    lu.matrix = a;
    ASSERT_TRUE(lu.factorise());
    ComplexVector b = a * x;
    lu.solve(b);
    const double condition = a.norm() * a.inverse().norm();
    EXPECT_LE((b - x).norm(), 10.0 * static_cast<double>(n) * 2.2e-16 * condition * x.norm()) << n;
    lu.matrix = a;
    lu.matrix.col(n - 1).setZero();
    EXPECT_FALSE(lu.factorise());
  }
}

TEST(Continuation, FindsFifthRoots) {
  Polynomials problem = fifth_root();
  ComplexVector target(2);
  target << 1.0, -32.0;
  const AllSolutions all = find_all(problem, target, {});
  EXPECT_TRUE(all.complete());
  ASSERT_EQ(all.regular, 5);
  EXPECT_EQ(all.real, 1);
  EXPECT_EQ(all.unpaired, 0);
  for (const ContinuationSolution& solution : all.solutions) {
    EXPECT_NEAR(std::abs(solution.point[0]), 2.0, 1e-14);
    EXPECT_EQ(solution.real, std::abs(solution.point[0] - 2.0) < 1e-14);
  }
}

TEST(Continuation, FindsAllIntersectionsOfQuadrics) {
  for (const Eigen::Index n : {2, 3, 4}) {
    Polynomials problem = quadrics(n);
    const AllSolutions all = find_all(problem, real_target(problem, 11), {});
    EXPECT_TRUE(all.complete());
    EXPECT_EQ(all.regular, 1 << n) << n;
    EXPECT_EQ(all.unpaired, 0);
    expect_solved(all, 1e3);
  }
}

TEST(Continuation, FindsAllCyclicRoots) {
  for (const auto& [n, count] : {std::pair<Eigen::Index, Eigen::Index>{3, 6}, {5, 70}}) {
    Polynomials problem = cyclic(n);
    ComplexVector target = ComplexVector::Ones(problem.coefficients);
    target[problem.coefficients - 1] = -1.0;
    const AllSolutions all = find_all(problem, target, {});
    EXPECT_TRUE(all.complete());
    EXPECT_EQ(all.regular, count);
    EXPECT_EQ(all.real, n == 5 ? 10 : 0);
    EXPECT_EQ(all.unpaired, 0);
    expect_solved(all, 1e2);
  }
}

TEST(Continuation, StopsAtTheKnownCountAndWhenTold) {
  Polynomials problem = quadrics(3);
  const ComplexVector target = real_target(problem, 5);
  ContinuationOptions options;
  const GenericSolutions slow = find_generic(problem, options);
  options.known_count = 8;
  const GenericSolutions fast = find_generic(problem, options);
  EXPECT_TRUE(fast.settled);
  EXPECT_EQ(fast.count(), 8);
  EXPECT_LT(fast.cost.paths, slow.cost.paths);
  options.known_count = 0;
  options.max_solutions = 4;
  EXPECT_FALSE(find_generic(problem, options).settled);
  options.max_solutions = 100;
  int calls = 0;
  options.progress = [&calls](const ContinuationProgress&) { return ++calls < 3; };
  const AllSolutions all = find_all(problem, target, options);
  EXPECT_TRUE(all.stopped);
  EXPECT_FALSE(all.complete());
  // Another set of generic solutions, stopped in the middle of the paths to the target.
  calls = 0;
  const AllSolutions half = follow_all(problem, slow, target, options);
  EXPECT_TRUE(half.stopped);
  EXPECT_EQ(half.regular, 3);
}

TEST(Continuation, IsDeterministic) {
  Polynomials problem = quadrics(3);
  const ComplexVector target = real_target(problem, 5);
  const AllSolutions one = find_all(problem, target, {}), two = find_all(problem, target, {});
  ASSERT_EQ(one.solutions.size(), two.solutions.size());
  for (std::size_t i = 0; i < one.solutions.size(); ++i) EXPECT_EQ(one.solutions[i].point, two.solutions[i].point);
}

TEST(Continuation, WithoutSeedsThereIsNothing) {
  class Seedless : public Polynomials {
    bool seed(std::mt19937_64&, ComplexVector&, ComplexVector&) override { return false; }
  } problem;
  static_cast<Polynomials&>(problem) = quadrics(2);
  const GenericSolutions none = find_generic(problem, {});
  EXPECT_FALSE(none.seeded);
  EXPECT_FALSE(none.settled);
  const AllSolutions all = follow_all(problem, none, real_target(problem, 1), {});
  EXPECT_TRUE(all.solutions.empty());
  EXPECT_FALSE(all.complete());
}

TEST(Continuation, FindsTheFivefoldRoot) {
  Polynomials problem = fifth_root();
  ComplexVector target(2);
  target << 1.0, 0.0;
  const AllSolutions all = find_all(problem, target, {});
  EXPECT_TRUE(all.complete());
  EXPECT_EQ(all.singular, 5);
  ASSERT_EQ(all.solutions.size(), 1U);
  EXPECT_EQ(all.solutions[0].paths, 5);
  EXPECT_EQ(all.solutions[0].winding, 5);
  EXPECT_LE(std::abs(all.solutions[0].point[0]), 1e-12);
}

// x^2 + y^2 = 1 and (x - 1)^2 + c y^2 = 4: they touch in (-1, 0); two more points for c != 1.
TEST(Continuation, FindsATangencyToMoreThanHalfTheDigits) {
  Polynomials problem = quadrics(2);
  ComplexVector target(12);
  target << 1, 0, 1, 0, 0, -1, /**/ 1, 0, 3, -2, 0, -3;
  const AllSolutions all = find_all(problem, target, {});
  EXPECT_TRUE(all.complete());
  EXPECT_EQ(all.regular, 2);
  EXPECT_EQ(all.singular, 2);
  ASSERT_EQ(all.solutions.size(), 3U);
  const ContinuationSolution& touch = all.solutions[2];
  EXPECT_EQ(touch.end, PathEnd::singular);
  EXPECT_EQ(touch.paths, 2);
  EXPECT_EQ(touch.winding, 2);
  EXPECT_GE(touch.condition, 1e8);
  EXPECT_LE(touch.accuracy, 1e-10);
  EXPECT_LE(std::abs(touch.point[0] + 1.0), touch.accuracy);
  EXPECT_LE(std::abs(touch.point[1]), touch.accuracy);
  // x^2 + y^2 = 1, x^2 - 2 x + 3 y^2 = 3 gives (x + 1) 2 x = 0.
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LE(std::abs(all.solutions[i].point[0]), all.solutions[i].accuracy);
}

// Two circles have two points at infinity in common; concentric ones touch there.
TEST(Continuation, NoticesDivergence) {
  Polynomials problem = quadrics(2);
  ComplexVector target(12);
  target << 1, 0, 1, 0, 0, -1, /**/ 1, 0, 1, -1, 0, -1;
  const AllSolutions circles = find_all(problem, target, {});
  EXPECT_TRUE(circles.complete());
  EXPECT_EQ(circles.regular, 2);
  EXPECT_EQ(circles.diverging, 2);
  EXPECT_EQ(circles.real, 2);
  target[9] = 0.0;
  target[11] = -2.0;
  const AllSolutions concentric = find_all(problem, target, {});
  EXPECT_TRUE(concentric.complete());
  EXPECT_EQ(concentric.diverging, 4);
  EXPECT_TRUE(concentric.solutions.empty());
}

// Near a double root: two roots 2e-3 apart are regular, and real or not as their sign says.
TEST(Continuation, TellsNearbyRootsApart) {
  for (const double sign : {-1.0, 1.0}) {
    Polynomials problem;
    problem.add(0, {0, 0});
    problem.add(0, {0});
    problem.add(0, {});
    ComplexVector target(3);
    target << 1.0, -2.0, 1.0 + sign * 1e-6;
    const AllSolutions all = find_all(problem, target, {});
    EXPECT_TRUE(all.complete());
    ASSERT_EQ(all.regular, 2);
    EXPECT_EQ(all.real, sign < 0 ? 2 : 0);
    for (const ContinuationSolution& solution : all.solutions) {
      const Complex offset = solution.point[0] - 1.0;
      EXPECT_LE(std::abs(offset * offset + sign * 1e-6), 1e-14);
    }
  }
}

}  // namespace
}  // namespace koppel::test

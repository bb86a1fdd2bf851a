// All assemblies of mechanisms whose number is known.
#include "continuation_mechanisms.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "closure/continuation.hpp"

namespace koppel::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

const ContinuationSolution* nearest(const AllSolutions& all, const ComplexVector& print) {
  const ContinuationSolution* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const ContinuationSolution& solution : all.solutions) {
    const double distance = (solution.print - print).cwiseAbs().maxCoeff();
    if (distance < least) least = distance, best = &solution;
  }
  return best;
}

/// The real solution of this print is there, as exactly as the solution's own bound and the print's rounding say.
void expect_found(const AllSolutions& all, const ComplexVector& print, double print_error) {
  const ContinuationSolution* solution = nearest(all, print);
  ASSERT_NE(solution, nullptr);
  EXPECT_LE((solution->print - print).cwiseAbs().maxCoeff(), solution->accuracy + print_error);
  EXPECT_TRUE(solution->real);
}

// Benchmark 5.5, unit 10.
TEST(ContinuationOfMechanisms, FindsSixAssembliesOf3Rpr) {
  PlanarPlatform problem;
  problem.base = {Eigen::Vector2d(0, 0), Eigen::Vector2d(1.591, 0), Eigen::Vector2d(0, 1)};
  problem.platform = {Eigen::Vector2d(0, 0), Eigen::Vector2d(1.704, 0),
                      Eigen::Vector2d(1.3236373239436617, 1.609670846683651)};
  ComplexVector target(3);
  target << 1.498 * 1.498, 1.538 * 1.538, 1.2 * 1.2;
  const AllSolutions all = find_all(problem, target, {});
  EXPECT_TRUE(all.complete());
  EXPECT_EQ(all.generic, 6);
  EXPECT_EQ(all.regular, 6);
  EXPECT_EQ(all.real, 6);
  const double known[6][3] = {
      {-14.8961281001728, 1.5829616619626, .245309530991627},  {-13.4199390139744, -6.6562479567102, .585672783258552},
      {-8.7265953318629, 12.1756697521700, -.986974237845446}, {-5.4956608154529, -13.9354982760394, -.047331369366918},
      {14.6739436557350, -3.0126031249259, 2.132904365129089}, {14.9201332471544, -1.3379177430462, 1.002038539902250}};
  for (const auto& row : known) {
    ComplexVector print(4);
    print << row[0] / 10.0, row[1] / 10.0, std::cos(row[2]), std::sin(row[2]);
    expect_found(all, print, 1e-13);  // printed to 1e-13, and the angle to 1e-15
  }
}

// Benchmark 5.2 (Manseur, Doty 1989): sixteen real solutions.
TEST(ContinuationOfMechanisms, FindsSixteenPosturesOf6R) {
  SixRevolutes problem;
  problem.a = {.3, 1, 0, 1.5, 0, 0};
  problem.d = {0, 0, .2, 0, 0, 0};
  problem.alpha = {90 * degree, degree, 90 * degree, degree, 90 * degree, degree};
  problem.hand_position << -1.140175, 0, 0;
  problem.hand_rotation << -0.76011709545176298075, -0.64168879131897176529, 0.10226190051809398931,
      0.1333330381041550302, 1.7448607481454760835e-7, 0.99107128953970082071, -0.63595935573894294937,
      0.7669651198689329318, 0.085558183434093263125;
  const AllSolutions all = find_all(problem, ComplexVector::Zero(6), {});
  EXPECT_TRUE(all.complete());
  EXPECT_EQ(all.generic, 16);
  EXPECT_EQ(all.regular, 16);
  EXPECT_EQ(all.real, 16);
  const double known[8][6] = {{-3.1088884650057368, 1.8883005150226998, -2.5784418134759811, -0.099365939821168948,
                               -2.8741133202989497, 3.1342711223725442},
                              {-2.1081549469475503, 3.0078020615851215, -3.1254105463326639, 0.54684631607853842,
                               -2.5606627327571422, 2.4926947846100905},
                              {-1.6804820859336546, -0.10949475107780417, 3.1410491995983848, 0.67170706095226203,
                               0.91716812328015995, -0.68774190895856936},
                              {-0.22589680733081538, -1.8342767733177623, -2.0066990332881573, 0.052769183299653422,
                               0.12945102778931656, -1.3861723877788398},
                              {0.043934118178058847, 1.8862800460932164, 1.9555218225312339, -0.18366052792969082,
                               8.9200711438537832e-5, -0.0019116475439892423},
                              {1.5477313248282808, -3.0844276001731083, 0.05708874443093488, -2.0378135552489206,
                               0.39800623964664273, -0.69051056607512992},
                              {1.9869459048985606, 0.092613987787467131, -3.1022229821848118, -0.97606078553144542,
                               -1.099292607211138, -0.75707724070187336},
                              {2.9377715673884206, -1.8132604154758219, -0.58287384355248209, -2.8406819470716002,
                               -0.14173409879483671, -1.4282879443835941}};
  constexpr double pi = std::numbers::pi;
  for (const auto& row : known) {
    for (const bool flipped : {false, true}) {
      std::array<double, 6> angles;
      std::copy(std::begin(row), std::end(row), angles.begin());
      if (flipped) angles = {row[0], row[1], row[2] + pi, pi - row[3], pi - row[4], row[5] + pi};
      ComplexVector print(12);
      for (std::size_t i = 0; i < 6; ++i) {
        print[2 * static_cast<Eigen::Index>(i)] = std::cos(angles[i]);
        print[2 * static_cast<Eigen::Index>(i) + 1] = std::sin(angles[i]);
      }
      const ContinuationSolution* solution = nearest(all, print);
      ASSERT_NE(solution, nullptr);
      EXPECT_LE((solution->print - print).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_TRUE(solution->real);
    }
  }
}

/// A platform with random joints and the squared legs of a random pose, whose point is given.
GeneralStewart random_platform(std::mt19937_64& random, ComplexVector& point, ComplexVector& squares) {
  GeneralStewart problem;
  for (std::size_t i = 0; i < 6; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      problem.base[i][j] = uniform(random);
      problem.platform[i][j] = uniform(random);
    }
  }
  point.resize(7);
  for (Complex& value : point) value = uniform(random);
  point.head<4>() /= point.head<4>().norm();
  squares.setZero(6);
  ComplexVector residual(6);
  problem.Stewart::evaluate(point, squares, residual, nullptr, nullptr, nullptr);
  squares = residual;
  return problem;
}

TEST(ContinuationOfMechanisms, FindsFortyAssembliesOfGeneralStewartPlatforms) {
  std::mt19937_64 random(2024);
  GenericSolutions generic;
  for (int i = 0; i < 4; ++i) {
    ComplexVector pose, squares, print;
    GeneralStewart problem = random_platform(random, pose, squares);
    // All platforms are of one family; its generic solutions serve for all.
    if (i == 0) generic = find_generic(problem, {});
    EXPECT_TRUE(generic.settled);
    ASSERT_EQ(generic.count(), 40);
    const ComplexVector target = problem.with(squares);
    const AllSolutions all = follow_all(problem, generic, target, {});
    EXPECT_EQ(all.lost, 0);
    EXPECT_EQ(all.doubled, 0);
    EXPECT_EQ(all.unpaired, 0);
    EXPECT_EQ(all.regular, 40) << i;
    problem.fingerprint(pose, print);
    expect_found(all, print, 1e-15);
    // Substituted into equations that know nothing of quaternions.
    for (const ContinuationSolution& solution : all.solutions) {
      const Complex33 r = Eigen::Map<const Complex33>(solution.print.data());
      const Complex3 o = solution.print.tail<3>();
      double size = 1.0;
      for (const Complex& value : solution.print) size = std::max(size, std::norm(value));
      EXPECT_LE((r * r.transpose() - Complex33::Identity()).cwiseAbs().maxCoeff(), 1e-13 * size);
      for (std::size_t leg = 0; leg < 6; ++leg) {
        const Complex3 l = o + r * problem.platform[leg] - problem.base[leg];
        EXPECT_LE(std::abs(product(l, l) - squares[static_cast<Eigen::Index>(leg)]), 1e-13 * size);
      }
    }
  }
}

// Legs alone as parameters: loops of these mix less, see ContinuationProblem::parameters().
TEST(ContinuationOfMechanisms, FindsFortyAssembliesWithLegsAsParameters) {
  std::mt19937_64 random(7);
  ContinuationOptions options;
  options.known_count = 40;
  for (int i = 0; i < 4; ++i) {
    ComplexVector pose, squares, print;
    GeneralStewart general = random_platform(random, pose, squares);
    Stewart problem = general;
    const AllSolutions all = find_all(problem, squares, options);
    EXPECT_TRUE(all.complete());
    EXPECT_EQ(all.regular, 40);
    problem.fingerprint(pose, print);
    expect_found(all, print, 1e-15);
  }
}

// X-STEWART: planar and symmetric. Of the 40 solutions 12 run away.
TEST(ContinuationOfMechanisms, FindsThePoseOfTheFlightSimulator) {
  GeneralStewart problem;
  const double base[6] = {-10, 10, 110, 130, 230, 250}, platform[6] = {-50, 50, 70, 170, 190, 290};
  const double legs[6] = {0.615940342, 0.681213598, 0.661119803, 0.671461919, 0.582507898, 0.661579625};
  ComplexVector squares(6);
  for (std::size_t i = 0; i < 6; ++i) {
    problem.base[i] = 0.5 * Eigen::Vector3d(std::cos(base[i] * degree), std::sin(base[i] * degree), 0);
    problem.platform[i] = 0.3 * Eigen::Vector3d(std::cos(platform[i] * degree), std::sin(platform[i] * degree), 0);
    squares[static_cast<Eigen::Index>(i)] = legs[i] * legs[i];
  }
  const AllSolutions all = find_all(problem, problem.with(squares), {});
  EXPECT_TRUE(all.complete());
  EXPECT_EQ(all.generic, 40);
  EXPECT_EQ(all.regular, 28);
  EXPECT_EQ(all.diverging, 12);
  EXPECT_EQ(all.unpaired, 0);
  const Eigen::Matrix3d r = (Eigen::AngleAxisd(5 * degree, Eigen::Vector3d::UnitX()) *
                             Eigen::AngleAxisd(-4 * degree, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(10 * degree, Eigen::Vector3d::UnitZ()))
                                .toRotationMatrix();
  ComplexVector print(12);
  print << r.reshaped().cast<Complex>(), 0.02, -0.03, 0.55;
  const ContinuationSolution* pose = nearest(all, print);
  ASSERT_NE(pose, nullptr);
  // The legs are given to half a unit of their ninth digit.
  EXPECT_LE((pose->print - print).cwiseAbs().maxCoeff(), 0.5e-9 * pose->condition);
  EXPECT_TRUE(pose->real);
  // Both mirror images at the base plane.
  EXPECT_EQ(all.real % 2, 0);
}

}  // namespace
}  // namespace koppel::test

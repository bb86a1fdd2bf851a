// All real common roots of two closure conditions in two joint coordinates.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace koppel {

/// One of the two unknowns: what it is and how high it occurs. Its basis functions are {1, cos, sin} or
/// {1, cos, sin, cos 2, sin 2} of an angle, {1, s} or {1, s, s^2} of a displacement.
struct Unknown {
  enum class Kind { angle, displacement };
  Kind kind = Kind::angle;
  int order = 1;        ///< 1 or 2
  double length = 1.0;  ///< of a displacement: what is usual [m]; sets the sample points and the tolerances

  int terms() const;           ///< basis functions, and sample points: 3 or 5, 2 or 3
  double sample(int i) const;  ///< i-th sample point: those of scalar_roots.hpp; -length and length for {1, s}
};

/// A condition sum c(i, j) X_i(x) Y_j(y) in the basis functions X of x and Y of y. Unused coefficients are zero.
struct Condition2 {
  Eigen::Matrix<double, 5, 5> c = Eigen::Matrix<double, 5, 5>::Zero();

  /// From values(i, j) at (x.sample(i), y.sample(j)); what lies outside x.terms() by y.terms() is not read.
  static Condition2 from_samples(const Unknown& x, const Unknown& y, const Eigen::Matrix<double, 5, 5>& values);

  double value(const Unknown& x, const Unknown& y, double at_x, double at_y) const;
};

struct CommonRoot {
  double x = 0.0, y = 0.0;  ///< angles in (-pi, pi]
  bool repeated = false;    ///< the Jacobian is singular to rounding: a limit position
  double error = 0.0;       ///< expected from rounding of the coefficients [rad, and lengths]
};

struct CommonRoots {
  std::vector<CommonRoot> roots;  ///< ascending in x, then y
  /// Finite complex roots with their multiplicity, the real ones included; -1: unknown. A displacement of more than a
  /// thousand lengths counts as infinite, as does an angle with an imaginary part of more than 7.
  int complex_count = -1;
  bool degenerate = false;  ///< a curve of common roots, maybe a complex one; isolated roots may then be missing
};

/// All real (x, y) with f = g = 0 (spec K-II-3.2.3, h = 2): y is eliminated by Sylvester's matrix, the eigenvalues of
/// which are candidates; each is then polished by Newton's method on f and g themselves and kept if both vanish to
/// rounding of their terms. `scale`: as in scalar_roots.hpp. Two first-order conditions in two angles have at most 8.
CommonRoots common_roots(const Unknown& x, const Unknown& y, const Condition2& f, const Condition2& g,
                         double scale = 0.0);

}  // namespace koppel

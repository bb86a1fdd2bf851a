// Real roots of a closure condition seen as a function of one joint coordinate: of an angle, or of a displacement.
#pragma once

#include <array>
#include <numbers>
#include <span>

namespace koppel {

/// c0 + c1 cos x + s1 sin x of an angle x: closure types 1, 2, 4 and 5 (K-II-3.4.1).
struct FirstHarmonic {
  double c0 = 0.0, c1 = 0.0, s1 = 0.0;

  /// Where to sample it: a third of a turn apart [rad], so that no sample weighs more than another.
  static constexpr std::array<double, 3> samples = {0.0, 2.0 / 3.0 * std::numbers::pi, -2.0 / 3.0 * std::numbers::pi};
  static FirstHarmonic from_samples(const std::array<double, 3>& values);

  double value(double x) const;
  double derivative(double x) const;
};

/// c0 + c1 cos x + s1 sin x + c2 cos 2x + s2 sin 2x of an angle x: closure type 3 as well (K-II-3.4.1).
struct SecondHarmonic {
  double c0 = 0.0, c1 = 0.0, s1 = 0.0, c2 = 0.0, s2 = 0.0;

  /// A fifth of a turn apart [rad].
  static constexpr std::array<double, 5> samples = {0.0, 0.4 * std::numbers::pi, 0.8 * std::numbers::pi,
                                                    -0.8 * std::numbers::pi, -0.4 * std::numbers::pi};
  static SecondHarmonic from_samples(const std::array<double, 5>& values);

  double value(double x) const;
  double derivative(double x) const;
};

/// c0 + c1 x + c2 x^2 of a displacement x. `length` says what is a usual displacement; it decides which coefficients
/// are nothing but rounding, and no more.
struct Quadratic {
  double c0 = 0.0, c1 = 0.0, c2 = 0.0;
  double length = 1.0;

  /// Where to sample it, in units of the length.
  static constexpr std::array<double, 3> samples = {-1.0, 0.0, 1.0};
  static Quadratic from_samples(const std::array<double, 3>& values, double length);

  double value(double x) const { return c0 + x * (c1 + x * c2); }
  double derivative(double x) const { return c1 + 2.0 * x * c2; }
};

/// The real roots of one function. With count = 0 and not `everywhere` there is none, and the last two say why.
struct Roots {
  int count = 0;
  std::array<double, 4> values = {};  ///< angles in (-pi, pi]
  std::array<bool, 4> repeated = {};  ///< a double root to rounding: a limit position
  bool everywhere = false;            ///< the function vanishes to rounding: the coordinate is undetermined
  double missed_by = 0.0;             ///< least |f| over the amplitude if there is no root; infinite if f is constant
  double nearest = 0.0;               ///< where it is attained; 0 if f is constant
};

// In the functions below, `scale` is the size of the numbers that the coefficients were computed from, in the unit of
// the condition: they are taken to be wrong by some roundings of it. Zero if they are exact as they stand.

/// Roots of a first-order condition: at most two (K-II-3.4.4a). values[0] is the seed's branch k = 1, where the
/// function rises, values[1] is k = 2, where it falls: along a motion each keeps its number until both meet in a limit
/// position, and both numbers turn into one double root there, values[0]. Amplitude: sqrt(c1^2 + s1^2). Not finite: no
/// roots, missed_by NaN.
Roots roots(const FirstHarmonic& f, double scale = 0.0);

/// Roots of a second-order condition, ascending: at most four, several equal ones listed once, as repeated.
/// Amplitude: sqrt(c1^2 + s1^2 + c2^2 + s2^2).
Roots roots(const SecondHarmonic& f, double scale = 0.0);

/// Roots of a condition in a displacement, ascending: at most two. "Amplitude": |c2|, so that missed_by is the square
/// of a length. A root beyond length / rounding is at infinity and none.
Roots roots(const Quadratic& f, double scale = 0.0);

/// What several conditions on one coordinate have in common.
struct RowRoots {
  Roots roots;                 ///< nearest and missed_by (residual over scale) tell of the best place if count = 0
  bool unique = false;         ///< the rows determine the coordinate by linear equations alone
  double inconsistency = 0.0;  ///< largest |row| at the best root, over the scale; of a root everywhere too
};

/// The angle that several first-order conditions agree on; some may be zero or repeat others. All in one unit. If they
/// determine cos x and sin x independently, the unique angle by least squares (K-II-3.4.4b), whatever the
/// inconsistency: that is for the caller to judge. If not, those roots of their dominant combination (K-II-3.4.4a, in
/// its order) where no row is off by more than tolerance * scale. A scale of zero stands for the largest coefficient.
RowRoots angle_of_rows(std::span<const FirstHarmonic> rows, double scale = 0.0, double tolerance = 1e-9);

/// The same for a displacement (K-II-3.4.4c); all rows have the length of the first.
RowRoots displacement_of_rows(std::span<const Quadratic> rows, double scale = 0.0, double tolerance = 1e-9);

}  // namespace koppel

// The even functions of an angle x that rotations are made of, as functions of its square s = x^2 >= 0. Smooth at zero,
// where no root is taken, so that derivatives by dual numbers are exact there; the closed form takes over where it
// cancels nothing.
#pragma once

#include <cmath>
#include <type_traits>

#include "spatial/types.hpp"

namespace koppel {

namespace series {

/// Enough terms for s < 1: what is left out is below 1e-17, for wider types below 1e-24.
template <typename T>
inline constexpr int terms = std::is_same_v<T, double> ? 9 : 12;

/// 1 - s/(p q) (1 - s/((p+2)(q+2)) (1 - ...))
template <int p, int q, int left, typename T>
inline T alternating(const T& s) {
  if constexpr (left == 0) {
    return T(1);
  } else {
    return T(1) - s * constant<T>(1.0L / (p * q)) * alternating<p + 2, q + 2, left - 1>(s);
  }
}

}  // namespace series

/// What exponentials of rotations and their derivatives are made of.
template <typename T>
struct SincTerms {
  T cosine;       ///< cos x
  T sinc;         ///< sin x / x; 1 at zero
  T cosinc;       ///< (1 - cos x) / x^2; 1/2 at zero
  T sinc_defect;  ///< (x - sin x) / x^3; 1/6 at zero
};

/// All of them together, each to rounding beside 1.
template <typename T>
inline SincTerms<T> sinc_terms(const T& s) {
  using std::cos, std::sin, std::sqrt;
  if (s < T(1)) {
    const T cosinc = series::alternating<3, 4, series::terms<T>>(s) / T(2);
    const T defect = series::alternating<4, 5, series::terms<T>>(s) / T(6);
    return {T(1) - s * cosinc, T(1) - s * defect, cosinc, defect};
  }
  const T x = sqrt(s), c = cos(x), sinc = sin(x) / x;
  return {c, sinc, (T(1) - c) / s, (T(1) - sinc) / s};
}

/// (1 - (x/2) cot(x/2)) / x^2; 1/12 at zero. Grows without bound towards full turns, x = 2 pi, 4 pi, ...
template <typename T>
inline T cotangent_defect_of_square(const T& s) {
  using std::cos, std::sin, std::sqrt;
  const T quarter = s / T(4);
  if (quarter < T(1)) {
    // (sin h - h cos h) / h^3 over sin h / h, with h = x / 2.
    const T sinc = series::alternating<2, 3, series::terms<T>>(quarter);
    return series::alternating<2, 5, series::terms<T>>(quarter) / (T(12) * sinc);
  }
  const T h = sqrt(quarter), sine = sin(h);
  return (sine - h * cos(h)) / (sine * s);
}

}  // namespace koppel

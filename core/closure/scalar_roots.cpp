#include "closure/scalar_roots.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "spatial/rotation_coordinates.hpp"

namespace koppel {

namespace {

constexpr double pi = std::numbers::pi, infinite = std::numeric_limits<double>::infinity();
constexpr double negligible = 1e-12;  ///< of the scale: an amplitude that determines nothing (spec section 6)
constexpr double limit = 1e-14;       ///< of the terms: a radicand that is zero (spec section 6)
constexpr double distinct = 1e-3;     ///< ratio of singular values from which two linear equations are two

/// atan2 in (-pi, pi]; atan2 itself rounds to -pi, too.
double angle_of(double sine, double cosine) {
  const double x = std::atan2(sine, cosine);
  return x > -pi ? x : pi;
}

double rounding_of(double scale) { return rounding_floor<double>() * scale; }

Roots no_roots(double missed_by, double nearest) {
  Roots r;
  r.missed_by = missed_by;
  r.nearest = nearest;
  return r;
}

Roots constant_roots(bool zero) {
  Roots r;
  r.everywhere = zero;
  r.missed_by = zero ? 0.0 : infinite;
  return r;
}

void append(Roots& r, double x, bool repeated) {
  const auto i = static_cast<std::size_t>(r.count++);
  r.values[i] = x;
  r.repeated[i] = repeated;
}

void sort(Roots& r) {
  for (int last = r.count - 1; last > 0; --last) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(last); ++i) {
      if (r.values[i] <= r.values[i + 1]) continue;
      std::swap(r.values[i], r.values[i + 1]);
      std::swap(r.repeated[i], r.repeated[i + 1]);
    }
  }
}

template <std::size_t N>
double horner(const std::array<double, N>& p, double t) {
  double sum = p[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * t + p[i];
  return sum;
}

template <std::size_t N>
std::array<double, N - 1> derivative_of(const std::array<double, N>& p) {
  std::array<double, N - 1> d{};
  for (std::size_t i = 1; i < N; ++i) d[i - 1] = static_cast<double>(i) * p[i];
  return d;
}

/// The root of a polynomial that is monotone in [low, high] and has different signs at its ends: Newton's method, and
/// bisection where that leaves the bracket or does not halve its step.
template <std::size_t N>
double root_between(const std::array<double, N>& p, double low, double high) {
  const auto slope = derivative_of(p);
  const bool rising = horner(p, low) < 0.0;
  double t = 0.5 * (low + high), before = high - low;
  for (int i = 0; i < 120; ++i) {
    const double value = horner(p, t);
    if (value == 0.0) return t;
    ((value < 0.0) == rising ? low : high) = t;
    double next = t - value / horner(slope, t);
    if (!(next > low && next < high) || std::abs(next - t) > 0.5 * before) next = 0.5 * (low + high);
    before = std::abs(next - t);
    t = next;
    if (before <= epsilon<double>() * std::abs(t) || before < 1e-30) break;
  }
  return t;
}

template <std::size_t Degree>
struct Ascending {
  std::array<double, Degree> values = {};
  std::size_t count = 0;
};

/// Where a polynomial changes its sign in (-bound, bound), from where its derivative does: no change can be missed, for
/// it is monotone in between.
template <std::size_t N>
Ascending<N - 1> sign_changes(const std::array<double, N>& p, double bound) {
  Ascending<N - 1> found;
  if constexpr (N == 2) {
    found = {{-p[0] / p[1]}, 1};
  } else {
    const auto extrema = sign_changes(derivative_of(p), bound);
    double low = -bound;
    for (std::size_t i = 0; i <= extrema.count; ++i) {
      const double high = i < extrema.count ? extrema.values[i] : bound;
      if ((horner(p, low) < 0.0) != (horner(p, high) < 0.0)) {
        found.values[found.count++] = root_between(p, low, high);
      }
      low = high;
    }
  }
  return found;
}

SecondHarmonic derivative_of(const SecondHarmonic& f) { return {0.0, f.s1, -f.c1, 2.0 * f.s2, -2.0 * f.c2}; }

double amplitude_of(const SecondHarmonic& f) { return std::hypot(std::hypot(f.c1, f.s1), std::hypot(f.c2, f.s2)); }

/// (1 + t^2)^2 f(x), t = tan((x - base) / 2). The base is chosen so that t is infinite where |f| is large, a multiple
/// of pi/4: then the leading coefficient is large, and all roots are of the order of one.
struct HalfAngle {
  std::array<double, 5> p;
  double base;

  double angle(double t) const { return wrapped<double>(base + 2.0 * std::atan(t)); }
  double value(double t) const {
    const double q = 1.0 + t * t;
    return horner(p, t) / (q * q);
  }
  double bound() const {
    double largest = 0.0;
    for (int i = 0; i < 4; ++i) largest = std::max(largest, std::abs(p[static_cast<std::size_t>(i)]));
    return 1.0 + largest / std::abs(p[4]);
  }
};

HalfAngle half_angle(const SecondHarmonic& f) {
  constexpr double r = std::numbers::sqrt2 / 2.0;
  constexpr std::array<double, 8> cosine = {1.0, r, 0.0, -r, -1.0, -r, 0.0, r};
  std::size_t best = 0;
  double largest = -1.0;
  const auto at = [&](std::size_t k) { return std::array{cosine[k % 8], cosine[(k + 6) % 8]}; };
  for (std::size_t k = 0; k < 8; ++k) {
    const auto [c, s] = at(k);
    const auto [cc, ss] = at(2 * k);
    const double size = std::abs(f.c0 + f.c1 * c + f.s1 * s + f.c2 * cc + f.s2 * ss);
    if (size > largest) largest = size, best = k;
  }
  const std::size_t k = (best + 4) % 8;
  const auto [c, s] = at(k);
  const auto [cc, ss] = at(2 * k);
  const double c1 = f.c1 * c + f.s1 * s, s1 = f.s1 * c - f.c1 * s;
  const double c2 = f.c2 * cc + f.s2 * ss, s2 = f.s2 * cc - f.c2 * ss;
  return {{f.c0 + c1 + c2, 2.0 * s1 + 4.0 * s2, 2.0 * f.c0 - 6.0 * c2, 2.0 * s1 - 4.0 * s2, f.c0 - c1 + c2},
          static_cast<double>(k) * 0.25 * pi};
}

/// Newton's method in x itself, as long as it lowers |f|.
double polished(const SecondHarmonic& f, double x) {
  double value = f.value(x);
  for (int i = 0; i < 3 && value != 0.0; ++i) {
    const double next = x - value / f.derivative(x), at_next = f.value(next);
    if (!(std::abs(at_next) < std::abs(value))) break;
    x = next;
    value = at_next;
  }
  return wrapped<double>(x);
}

/// The roots of f where it exceeds `touch` between them; where an extremum does not, it is a repeated root.
Roots crossings(const SecondHarmonic& f, double touch) {
  const HalfAngle h = half_angle(f);
  const SecondHarmonic slope = derivative_of(f), curvature = derivative_of(slope);
  const double bound = h.bound();
  const auto extrema = sign_changes(derivative_of(h.p), bound);
  Roots r;
  double low = -bound, at_low = h.p[4];
  for (std::size_t i = 0; i <= extrema.count; ++i) {
    const bool inner = i < extrema.count;
    const double high = inner ? extrema.values[i] : bound;
    double at_high = inner ? h.value(high) : h.p[4];
    if (inner && std::abs(at_high) <= touch) at_high = 0.0;
    if (at_low * at_high < 0.0) {
      const double x = polished(f, h.angle(root_between(h.p, low, high))), rise = slope.value(x);
      append(r, x, rise * rise <= 2.0 * touch * std::abs(curvature.value(x)));
    } else if (at_high == 0.0 && at_low != 0.0) {
      // The extremum is of f here; Newton on f' puts it where f' vanishes, unless f'' does as well.
      const double x = h.angle(high), step = slope.value(x) / curvature.value(x);
      append(r, std::abs(step) < 1e-4 ? wrapped<double>(x - step) : x, true);
    }
    low = high;
    at_low = at_high;
  }
  sort(r);
  return r;
}

}  // namespace

FirstHarmonic FirstHarmonic::from_samples(const std::array<double, 3>& v) {
  return {(v[0] + v[1] + v[2]) / 3.0, (2.0 * v[0] - v[1] - v[2]) / 3.0, (v[1] - v[2]) * std::numbers::inv_sqrt3};
}

double FirstHarmonic::value(double x) const { return c0 + c1 * std::cos(x) + s1 * std::sin(x); }
double FirstHarmonic::derivative(double x) const { return s1 * std::cos(x) - c1 * std::sin(x); }

SecondHarmonic SecondHarmonic::from_samples(const std::array<double, 5>& v) {
  constexpr double cos1 = 0.30901699437494742410, cos2 = -0.80901699437494742410;  // of 72 and 144 degrees
  constexpr double sin1 = 0.95105651629515357212, sin2 = 0.58778525229247312917;
  const double even1 = v[1] + v[4], even2 = v[2] + v[3], odd1 = v[1] - v[4], odd2 = v[2] - v[3];
  return {0.2 * (v[0] + even1 + even2), 0.4 * (v[0] + cos1 * even1 + cos2 * even2), 0.4 * (sin1 * odd1 + sin2 * odd2),
          0.4 * (v[0] + cos2 * even1 + cos1 * even2), 0.4 * (sin2 * odd1 - sin1 * odd2)};
}

double SecondHarmonic::value(double x) const {
  const double c = std::cos(x), s = std::sin(x);
  return c0 + c1 * c + s1 * s + c2 * (c - s) * (c + s) + 2.0 * s2 * s * c;
}
double SecondHarmonic::derivative(double x) const { return derivative_of(*this).value(x); }

Quadratic Quadratic::from_samples(const std::array<double, 3>& v, double length) {
  return {v[1], 0.5 * (v[2] - v[0]) / length, 0.5 * ((v[2] - v[1]) - (v[1] - v[0])) / (length * length), length};
}

Roots roots(const FirstHarmonic& f, double scale) {
  const double size = std::max({std::abs(f.c0), std::abs(f.c1), std::abs(f.s1)});
  if (!std::isfinite(f.c0 + f.c1 + f.s1)) return no_roots(std::numeric_limits<double>::quiet_NaN(), 0.0);
  if (size <= negligible * scale) return constant_roots(true);
  const double a = f.c1 / size, b = f.s1 / size, c = f.c0 / size, square = a * a + b * b, amplitude = std::sqrt(square);
  if (amplitude <= negligible * scale / size) return constant_roots(false);
  // a^2 + b^2 - c^2 as if b or a were wrong by a rounding: the larger one and c lose nothing in their difference.
  const double high = std::max(std::abs(a), std::abs(b)), low = std::min(std::abs(a), std::abs(b));
  const double radicand = (high - std::abs(c)) * (high + std::abs(c)) + low * low;
  if (std::abs(radicand) <= std::max(limit * square, 4.0 * rounding_of(scale / size) * amplitude)) {
    Roots r;
    append(r, angle_of(-b * c, -a * c), true);
    return r;
  }
  if (radicand < 0.0) {
    return no_roots(-radicand / (amplitude * (std::abs(c) + amplitude)), angle_of(-b * c, -a * c));
  }
  const double w = std::sqrt(radicand);
  Roots r;
  append(r, angle_of(-b * c - a * w, -a * c + b * w), false);
  append(r, angle_of(-b * c + a * w, -a * c - b * w), false);
  return r;
}

Roots roots(const SecondHarmonic& f, double scale) {
  const double size = std::max({std::abs(f.c0), std::abs(f.c1), std::abs(f.s1), std::abs(f.c2), std::abs(f.s2)});
  if (!std::isfinite(f.c0 + f.c1 + f.s1 + f.c2 + f.s2)) return no_roots(std::numeric_limits<double>::quiet_NaN(), 0.0);
  if (size <= negligible * scale) return constant_roots(true);
  if (std::hypot(f.c2, f.s2) <= rounding_of(std::max(scale, size))) {
    Roots r = roots(FirstHarmonic{f.c0, f.c1, f.s1}, scale);
    sort(r);
    return r;
  }
  const SecondHarmonic g = {f.c0 / size, f.c1 / size, f.s1 / size, f.c2 / size, f.s2 / size};
  const double amplitude = amplitude_of(g);
  if (amplitude <= negligible * scale / size) return constant_roots(false);
  const double touch = std::max(0.5 * limit * amplitude, 4.0 * rounding_of(scale / size));
  Roots r = crossings(g, touch);
  if (r.count > 0) return r;
  r.missed_by = infinite;
  const Roots extrema = crossings(derivative_of(g), 0.0);
  for (int i = 0; i < extrema.count; ++i) {
    const double x = extrema.values[static_cast<std::size_t>(i)], miss = std::abs(g.value(x)) / amplitude;
    if (miss < r.missed_by) r.missed_by = miss, r.nearest = x;
  }
  return r;
}

Roots roots(const Quadratic& f, double scale) {
  const double b = f.c1 * f.length, a = f.c2 * f.length * f.length, half = 0.5 * b, c = f.c0;
  const double size = std::max({std::abs(a), std::abs(b), std::abs(c)});
  if (!std::isfinite(a + b + c)) return no_roots(std::numeric_limits<double>::quiet_NaN(), 0.0);
  if (size <= negligible * scale) return constant_roots(true);
  const double noise = rounding_of(std::max(scale, size));
  Roots r;
  if (std::abs(a) <= noise) {
    if (std::abs(b) <= std::max(negligible * scale, rounding_of(size))) return constant_roots(false);
    append(r, -c / b * f.length, false);
    return r;
  }
  // Divided by the size, lest the squares overflow.
  const double h = half / size, p = a / size, q = c / size, discriminant = h * h - p * q;
  const double bound = std::max(limit * (h * h + std::abs(p * q)),
                                rounding_of(scale / size) * (std::abs(h) + std::abs(p) + std::abs(q)));
  if (std::abs(discriminant) <= bound) {
    append(r, -h / p * f.length, true);
    return r;
  }
  if (discriminant < 0.0) return no_roots(-discriminant / (p * p) * f.length * f.length, -h / p * f.length);
  const double larger = -(h + std::copysign(std::sqrt(discriminant), h));
  append(r, larger / p * f.length, false);
  append(r, q / larger * f.length, false);
  sort(r);
  return r;
}

namespace {

/// A row as a linear equation c + m0 w0 + m1 w1 = 0 in w = (cos x, sin x), or (s, s^2) in units of the length.
struct Linear {
  double c, m0, m1;
};

struct AngleRows {
  using Function = FirstHarmonic;
  static Linear linear(const Function& f, double) { return {f.c0, f.c1, f.s1}; }
  static Function function(const Linear& r, double) { return {r.c, r.m0, r.m1}; }
  static double solution(double cosine, double sine, double) { return angle_of(sine, cosine); }
  static double normal(double x) { return wrapped<double>(x); }
  static bool is_linear(const Linear&, double) { return false; }
};

struct DisplacementRows {
  using Function = Quadratic;
  static Linear linear(const Function& f, double length) { return {f.c0, f.c1 * length, f.c2 * length * length}; }
  static Function function(const Linear& r, double length) {
    return {r.c, r.m0 / length, r.m1 / (length * length), length};
  }
  static double solution(double s, double, double length) { return s * length; }
  static double normal(double x) { return x; }
  static bool is_linear(const Linear& r, double noise) { return std::abs(r.m1) <= noise && std::abs(r.m0) > noise; }
};

/// The rows as two: the singular values of their m, each with its right vector, and the part of c that it belongs to.
struct TwoRows {
  Linear dominant, other;  ///< u_k' (c, m): m = sigma_k v_k'
  double larger = 0.0, smaller = 0.0;
  double largest_c = 0.0;
};

template <typename Kind>
TwoRows two_rows(std::span<const typename Kind::Function> rows, double scale, double length) {
  double m00 = 0.0, m11 = 0.0, m01 = 0.0;
  const auto scaled = [&](const auto& row) {
    const Linear r = Kind::linear(row, length);
    return Linear{r.c / scale, r.m0 / scale, r.m1 / scale};
  };
  for (const auto& row : rows) {
    const Linear r = scaled(row);
    m00 += r.m0 * r.m0;
    m11 += r.m1 * r.m1;
    m01 += r.m0 * r.m1;
  }
  // One Jacobi rotation makes two columns orthogonal, and their lengths are the singular values to all digits.
  const double turn = 0.5 * std::atan2(2.0 * m01, m00 - m11), cosine = std::cos(turn), sine = std::sin(turn);
  double pp = 0.0, qq = 0.0, pc = 0.0, qc = 0.0;
  TwoRows two;
  for (const auto& row : rows) {
    const Linear r = scaled(row);
    const double p = r.m0 * cosine + r.m1 * sine, q = r.m1 * cosine - r.m0 * sine;
    pp += p * p, qq += q * q, pc += p * r.c, qc += q * r.c;
    two.largest_c = std::max(two.largest_c, std::abs(r.c));
  }
  two.larger = std::sqrt(pp);
  two.smaller = std::sqrt(qq);
  two.dominant = {two.larger > 0.0 ? pc / two.larger : 0.0, two.larger * cosine, two.larger * sine};
  two.other = {two.smaller > 0.0 ? qc / two.smaller : 0.0, -two.smaller * sine, two.smaller * cosine};
  return two;
}

/// Largest |row| at x.
template <typename F>
double residual(std::span<const F> rows, double x) {
  double largest = 0.0;
  for (const F& row : rows) largest = std::max(largest, std::abs(row.value(x)));
  return largest;
}

/// Gauss-Newton on all rows, as long as it lowers the sum of squares.
template <typename Kind, typename F>
double refined(std::span<const F> rows, double x) {
  const auto squares = [&](double at) {
    double sum = 0.0;
    for (const F& row : rows) sum += row.value(at) * row.value(at);
    return sum;
  };
  double before = squares(x);
  for (int i = 0; i < 4; ++i) {
    double gradient = 0.0, curvature = 0.0;
    for (const F& row : rows) {
      const double slope = row.derivative(x);
      gradient += slope * row.value(x);
      curvature += slope * slope;
    }
    if (!(curvature > 0.0)) break;
    const double next = x - gradient / curvature, after = squares(next);
    if (!(after < before)) break;
    x = next;
    before = after;
  }
  return Kind::normal(x);
}

template <typename Kind, typename F>
RowRoots of_rows(std::span<const F> rows, double scale, double tolerance, double length) {
  RowRoots result;
  if (scale == 0.0) {
    for (const F& row : rows) {
      const Linear r = Kind::linear(row, length);
      scale = std::max({scale, std::abs(r.c), std::abs(r.m0), std::abs(r.m1)});
    }
  }
  if (scale == 0.0) {
    result.roots = constant_roots(true);
    return result;
  }
  const TwoRows two = two_rows<Kind>(rows, scale, length);
  if (!(two.larger > negligible)) {
    result.inconsistency = two.largest_c;
    result.roots = constant_roots(two.largest_c <= tolerance);
    result.roots.missed_by = result.roots.everywhere ? 0.0 : two.largest_c;
    return result;
  }
  const auto candidates = roots(Kind::function(two.dominant, length), 1.0);
  const bool linear = Kind::is_linear(two.dominant, rounding_of(1.0));
  result.unique = linear || two.smaller > distinct * two.larger;
  if (result.unique) {
    const double p = two.dominant.c / (two.larger * two.larger);
    const double q = linear ? 0.0 : two.other.c / (two.smaller * two.smaller);
    const double w0 = -p * two.dominant.m0 - q * two.other.m0, w1 = -p * two.dominant.m1 - q * two.other.m1;
    const double x = refined<Kind, F>(rows, Kind::solution(w0, w1, length));
    append(result.roots, x, false);
    result.inconsistency = residual(rows, x) / scale;
    return result;
  }
  result.inconsistency = infinite;
  double best = candidates.nearest;
  for (int i = 0; i < candidates.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double x = refined<Kind, F>(rows, candidates.values[k]), off = residual(rows, x) / scale;
    if (off <= tolerance) append(result.roots, x, candidates.repeated[k]);
    if (off < result.inconsistency) result.inconsistency = off, best = x;
  }
  if (candidates.count == 0) result.inconsistency = residual(rows, best) / scale;
  if (result.roots.count == 0) result.roots.nearest = best, result.roots.missed_by = result.inconsistency;
  return result;
}

}  // namespace

RowRoots angle_of_rows(std::span<const FirstHarmonic> rows, double scale, double tolerance) {
  return of_rows<AngleRows>(rows, scale, tolerance, 1.0);
}

RowRoots displacement_of_rows(std::span<const Quadratic> rows, double scale, double tolerance) {
  return of_rows<DisplacementRows>(rows, scale, tolerance, rows.empty() ? 1.0 : rows.front().length);
}

}  // namespace koppel

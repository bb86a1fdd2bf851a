// Dual numbers a + eps b with eps^2 = 0 (Clifford). As scalars of the vectors, matrices and rotations of this room they
// turn formulas about directions into formulas about lines (K-I-6.3), and they carry first derivatives: a value and its
// rate. Dual<Dual<T>> carries second ones.
#pragma once

#include <cmath>
#include <compare>
#include <limits>
#include <optional>
#include <ostream>
#include <type_traits>

#include "spatial/types.hpp"

namespace koppel {

/// A dual number (K-I-6.1.1). Not a field: a pure dual number eps b divides zero and has no inverse. Operators and
/// functions follow IEEE arithmetic there and give infinities; inverse(), and is_smooth_root() and is_smooth_arc()
/// before a root or arc function, tell. A constant (dual part zero) keeps the derivative zero even where the function
/// has none.
template <typename T>
struct Dual {
  T real{};
  T dual{};

  constexpr Dual() = default;
  /// A real number is a dual one.
  constexpr Dual(const T& a) : real(a) {}
  constexpr Dual(const T& a, const T& b) : real(a), dual(b) {}
  /// Constants such as Dual<long double>(0.5) or Dual<Dual<double>>(1).
  template <typename Number>
  requires(std::is_arithmetic_v<Number> && !std::is_same_v<Number, T>) constexpr Dual(Number a)
      : real(static_cast<T>(a)) {}

  constexpr Dual operator-() const { return {-real, -dual}; }
  constexpr Dual& operator+=(const Dual& o) { return *this = *this + o; }
  constexpr Dual& operator-=(const Dual& o) { return *this = *this - o; }
  constexpr Dual& operator*=(const Dual& o) { return *this = *this * o; }
  constexpr Dual& operator/=(const Dual& o) { return *this = *this / o; }

  friend constexpr Dual operator+(const Dual& a, const Dual& b) { return {a.real + b.real, a.dual + b.dual}; }
  friend constexpr Dual operator-(const Dual& a, const Dual& b) { return {a.real - b.real, a.dual - b.dual}; }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    return {a.real * b.real, a.real * b.dual + a.dual * b.real};
  }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    const T quotient = a.real / b.real;
    return {quotient, (a.dual - quotient * b.dual) / b.real};
  }

  friend constexpr bool operator==(const Dual& a, const Dual& b) = default;
  /// Ordered as the real parts are: branches go the way that they go without derivatives.
  friend constexpr std::partial_ordering operator<=>(const Dual& a, const Dual& b) {
    if (a.real < b.real) return std::partial_ordering::less;
    if (b.real < a.real) return std::partial_ordering::greater;
    return a.real == b.real ? std::partial_ordering::equivalent : std::partial_ordering::unordered;
  }

  friend std::ostream& operator<<(std::ostream& out, const Dual& a) { return out << a.real << " + eps " << a.dual; }
};

/// 1 / a; empty for a pure dual number (K-I-6.1.1).
template <typename T>
std::optional<Dual<T>> inverse(const Dual<T>& a) {
  if (a.real == T(0)) return std::nullopt;
  return Dual<T>(T(1)) / a;
}

/// Whether sqrt, and log, have a derivative at a: its real part is positive (K-I-6.1.2).
template <typename T>
bool is_smooth_root(const Dual<T>& a) {
  return a.real > T(0);
}

/// Whether asin and acos have a derivative at a: its real part lies inside (-1, 1) (K-I-6.1.2).
template <typename T>
bool is_smooth_arc(const Dual<T>& a) {
  return a.real > T(-1) && a.real < T(1);
}

/// f(a + eps b) = f(a) + eps b f'(a): a function from its value and its derivative at the real part (K-I-6.1.2).
template <typename T>
Dual<T> chain(const Dual<T>& a, const T& value, const T& derivative) {
  using std::isfinite;
  if (a.dual == T(0) && !isfinite(derivative)) return {value, T(0)};
  return {value, a.dual * derivative};
}

/// Sine, cosine, tangent of an angle [rad] (K-I-6.1.2).
template <typename T>
Dual<T> sin(const Dual<T>& a) {
  using std::sin, std::cos;
  return chain<T>(a, sin(a.real), cos(a.real));
}
template <typename T>
Dual<T> cos(const Dual<T>& a) {
  using std::sin, std::cos;
  return chain<T>(a, cos(a.real), -sin(a.real));
}
template <typename T>
Dual<T> tan(const Dual<T>& a) {
  using std::tan;
  const T t = tan(a.real);
  return chain<T>(a, t, T(1) + t * t);
}
/// Angle [rad] of a sine, a cosine, a tangent (K-I-6.1.2). asin and acos have no derivative at +-1.
template <typename T>
Dual<T> asin(const Dual<T>& a) {
  using std::asin, std::sqrt;
  return chain<T>(a, asin(a.real), T(1) / sqrt((T(1) - a.real) * (T(1) + a.real)));
}
template <typename T>
Dual<T> acos(const Dual<T>& a) {
  using std::acos, std::sqrt;
  return chain<T>(a, acos(a.real), T(-1) / sqrt((T(1) - a.real) * (T(1) + a.real)));
}
template <typename T>
Dual<T> atan(const Dual<T>& a) {
  using std::atan;
  return chain<T>(a, atan(a.real), T(1) / (T(1) + a.real * a.real));
}
/// Exponential and natural logarithm (K-I-6.1.2).
template <typename T>
Dual<T> exp(const Dual<T>& a) {
  using std::exp;
  const T e = exp(a.real);
  return chain<T>(a, e, e);
}
template <typename T>
Dual<T> log(const Dual<T>& a) {
  using std::log;
  return chain<T>(a, log(a.real), T(1) / a.real);
}
/// sqrt(a + eps b) = sqrt(a) + eps b / (2 sqrt(a)) (K-I-6.1.2). The root of 0 + eps 0 is 0: a zero vector has the
/// length zero.
template <typename T>
Dual<T> sqrt(const Dual<T>& a) {
  using std::sqrt;
  const T root = sqrt(a.real);
  if (a.dual == T(0) && !(root > T(0))) return {root, T(0)};
  return {root, a.dual / (T(2) * root)};
}
/// a or -a, by the sign of the real part.
template <typename T>
Dual<T> abs(const Dual<T>& a) {
  return a.real < T(0) ? -a : a;
}
/// a^n for a constant n (K-I-6.1.2).
template <typename T>
Dual<T> pow(const Dual<T>& a, const std::type_identity_t<T>& n) {
  using std::pow;
  if (n == T(0)) return {T(1), T(0)};
  return chain<T>(a, pow(a.real, n), n * pow(a.real, n - T(1)));
}
/// a^b. Where b varies, a must be positive (K-I-6.1.2).
template <typename T>
Dual<T> pow(const Dual<T>& a, const Dual<T>& b) {
  using std::log, std::pow;
  Dual<T> power = pow(a, b.real);
  if (!(b.dual == T(0))) power.dual += b.dual * log(a.real) * power.real;
  return power;
}
/// The angle [rad] of the vector (x, y), in [-pi, pi] (K-I-6.1.2). Has no derivative at the origin, where the dual part
/// is zero, as for sqrt.
template <typename T>
Dual<T> atan2(const Dual<T>& y, const Dual<T>& x) {
  using std::atan2, std::hypot;
  const T angle = atan2(y.real, x.real), length = hypot(x.real, y.real);
  if (length == T(0)) return {angle, T(0)};
  return {angle, ((x.real / length) * y.dual - (y.real / length) * x.dual) / length};
}
/// The length of the vector (x, y). Has no derivative at the origin, where the dual part is zero, as for sqrt.
template <typename T>
Dual<T> hypot(const Dual<T>& x, const Dual<T>& y) {
  using std::hypot;
  const T length = hypot(x.real, y.real);
  if (length == T(0)) return {length, T(0)};
  return {length, (x.real / length) * x.dual + (y.real / length) * y.dual};
}
/// Whether both parts are.
template <typename T>
bool isfinite(const Dual<T>& a) {
  using std::isfinite;
  return isfinite(a.real) && isfinite(a.dual);
}

}  // namespace koppel

template <typename T>
struct Eigen::NumTraits<koppel::Dual<T>> : Eigen::GenericNumTraits<koppel::Dual<T>> {
  using Real = koppel::Dual<T>;
  using NonInteger = koppel::Dual<T>;
  using Nested = koppel::Dual<T>;
  using Literal = koppel::Dual<T>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2 * NumTraits<T>::ReadCost,
    AddCost = 2 * NumTraits<T>::AddCost,
    MulCost = 3 * NumTraits<T>::MulCost + NumTraits<T>::AddCost,
    HasFloatingPoint = 1
  };
  static Real epsilon() { return Real(NumTraits<T>::epsilon()); }
  static Real dummy_precision() { return Real(NumTraits<T>::dummy_precision()); }
  static int digits10() { return NumTraits<T>::digits10(); }
  static Real highest() { return Real(NumTraits<T>::highest()); }
  static Real lowest() { return Real(NumTraits<T>::lowest()); }
};

namespace Eigen {
template <typename T, typename Operation>
struct ScalarBinaryOpTraits<koppel::Dual<T>, T, Operation> {
  using ReturnType = koppel::Dual<T>;
};
template <typename T, typename Operation>
struct ScalarBinaryOpTraits<T, koppel::Dual<T>, Operation> {
  using ReturnType = koppel::Dual<T>;
};
}  // namespace Eigen

namespace koppel {

/// A dual vector or matrix of any shape: its real part ...
template <typename Derived>
auto real_part(const Eigen::MatrixBase<Derived>& m) {
  using T = decltype(Derived::Scalar::real);
  return Eigen::Matrix<T, Derived::RowsAtCompileTime, Derived::ColsAtCompileTime>(
      m.unaryExpr([](const Dual<T>& entry) { return entry.real; }));
}
/// ... its dual part ...
template <typename Derived>
auto dual_part(const Eigen::MatrixBase<Derived>& m) {
  using T = decltype(Derived::Scalar::real);
  return Eigen::Matrix<T, Derived::RowsAtCompileTime, Derived::ColsAtCompileTime>(
      m.unaryExpr([](const Dual<T>& entry) { return entry.dual; }));
}
/// ... and both put together, real + eps dual.
template <typename Real, typename Other>
auto dual(const Eigen::MatrixBase<Real>& real, const Eigen::MatrixBase<Other>& dual) {
  using T = typename Real::Scalar;
  return Eigen::Matrix<Dual<T>, Real::RowsAtCompileTime, Real::ColsAtCompileTime>(
      real.binaryExpr(dual, [](const T& a, const T& b) { return Dual<T>(a, b); }));
}

/// The real form of a dual 3x3 matrix A + eps B: the 6x6 matrix [[A, 0], [B, A]] on pairs [real; dual] (K-I-6.2.5).
template <typename T>
Matrix6T<T> real_form(const Matrix3T<Dual<T>>& m) {
  Matrix6T<T> r = Matrix6T<T>::Zero();
  r.template topLeftCorner<3, 3>() = real_part(m);
  r.template bottomRightCorner<3, 3>() = r.template topLeftCorner<3, 3>();
  r.template bottomLeftCorner<3, 3>() = dual_part(m);
  return r;
}

}  // namespace koppel

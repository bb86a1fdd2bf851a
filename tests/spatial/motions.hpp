// Random smooth motions as functions of a time of any scalar, so that dual numbers differentiate them.
#pragma once

#include <array>

#include "directions.hpp"
#include "spatial/dual.hpp"
#include "spatial/pose.hpp"

namespace koppel::test {

/// What a matrix or vector of second-order dual numbers holds.
template <typename Moving>
struct TimeDerivatives {
  using Time = typename Moving::Scalar;
  static constexpr auto value_of = [](const Time& x) { return x.real.real; };
  static constexpr auto rate_of = [](const Time& x) { return x.real.dual; };
  static constexpr auto second_rate_of = [](const Time& x) { return x.dual.dual; };
  using Plain = Eigen::Matrix<decltype(value_of(Time{})), Moving::RowsAtCompileTime, Moving::ColsAtCompileTime>;

  explicit TimeDerivatives(const Moving& moving)
      : value(moving.unaryExpr(value_of)),
        rate(moving.unaryExpr(rate_of)),
        second_rate(moving.unaryExpr(second_rate_of)) {}

  Plain value, rate, second_rate;
};

template <typename T>
Vector3T<T> constant(const Vector3& v) {
  return v.unaryExpr([](double x) { return T(x); });
}

/// A number c0 + c1 t + c2 t^2 + c3 t^3.
struct Cubic {
  explicit Cubic(Random& random)
      : c{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)} {}
  template <typename T>
  T operator()(const T& t) const {
    return T(c[0]) + t * (T(c[1]) + t * (T(c[2]) + t * T(c[3])));
  }

  std::array<double, 4> c;
};

/// A vector of cubics.
struct CubicVector {
  explicit CubicVector(Random& random) : x(random), y(random), z(random) {}
  template <typename T>
  Vector3T<T> operator()(const T& t) const {
    return {x(t), y(t), z(t)};
  }

  Cubic x, y, z;
};

/// Turns about two axes, one carried along by the other, with cubics as angles.
struct RandomTurning {
  explicit RandomTurning(Random& random)
      : first(random.direction()), second(random.direction()), first_angle(random), second_angle(random) {}
  template <typename T>
  Matrix3T<T> operator()(const T& t) const {
    return rotation_about<T>(constant<T>(first), first_angle(t)) *
           rotation_about<T>(constant<T>(second), second_angle(t));
  }

  Vector3 first, second;
  Cubic first_angle, second_angle;
};

struct RandomMotion {
  explicit RandomMotion(Random& random) : rotation(random), position(random) {}
  template <typename T>
  PoseT<T> operator()(const T& t) const {
    return {rotation(t), position(t)};
  }

  RandomTurning rotation;
  CubicVector position;
};

}  // namespace koppel::test

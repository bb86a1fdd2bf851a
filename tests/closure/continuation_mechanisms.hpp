// Families of mechanisms' closures whose numbers of solutions are known.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Dense>

#include "continuation_polynomials.hpp"

namespace koppel::test {

using Complex3 = Eigen::Vector3cd;
using Complex33 = Eigen::Matrix3cd;

// Not Eigen's, which conjugates.
template <class A, class B>
Complex product(const A& a, const B& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class A, class B>
Complex3 cross(const A& a, const B& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Complex33 skew(const Complex3& a) {
  Complex33 m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// The planar 3-RPR platform: point (x, y, cos, sin) of B1 and the platform; parameters the squared legs.
class PlanarPlatform : public ContinuationProblem {
 public:
  std::array<Eigen::Vector2d, 3> base, platform;

  Eigen::Index unknowns() const override { return 3; }
  Eigen::Index point_size() const override { return 4; }
  Eigen::Index parameters() const override { return 3; }
  void evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                const ComplexVector* dp, ComplexVector* along_dp) override {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Vector2d& b = platform[static_cast<std::size_t>(i)];
      const Eigen::Vector2d& a = base[static_cast<std::size_t>(i)];
      const Complex u = x[2] * b[0] - x[3] * b[1], v = x[3] * b[0] + x[2] * b[1];
      const Complex d = x[0] + u - a[0], e = x[1] + v - a[1];
      residual[i] = d * d + e * e - p[i];
      if (jacobian) jacobian->row(i) << 2.0 * d, 2.0 * e, 2.0 * (e * u - d * v);
      if (along_dp) (*along_dp)[i] = -(*dp)[i];
    }
  }
  void move(const ComplexVector& x, const ComplexVector& delta, ComplexVector& result) const override {
    const Complex c = x[2] - x[3] * delta[2], s = x[3] + x[2] * delta[2], size = std::sqrt(c * c + s * s);
    result << x[0] + delta[0], x[1] + delta[1], c / size, s / size;
  }
  void fingerprint(const ComplexVector& x, ComplexVector& print) const override { print = x; }
  bool seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) override {
    const Complex angle = 3.0 * uniform_complex(random);
    x << uniform_complex(random), uniform_complex(random), std::cos(angle), std::sin(angle);
    ComplexVector residual(3);
    p.setZero();
    evaluate(x, p, residual, nullptr, nullptr, nullptr);
    p = residual;
    return true;
  }
};

/// The Stewart-Gough platform: point (quaternion w x y z, position); parameters the squared legs.
class Stewart : public ContinuationProblem {
 public:
  std::array<Eigen::Vector3d, 6> base, platform;

  static Complex33 rotation(const ComplexVector& x) {
    const Complex w = x[0];
    const Complex3 v = x.segment<3>(1);
    const Complex33 s = skew(v);
    return Complex33::Identity() + 2.0 * (w * s + s * s);
  }
  Eigen::Index unknowns() const override { return 6; }
  Eigen::Index point_size() const override { return 7; }
  Eigen::Index parameters() const override { return 6; }
  void evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                const ComplexVector* dp, ComplexVector* along_dp) override {
    const Complex33 r = rotation(x);
    for (Eigen::Index i = 0; i < 6; ++i) {
      const Eigen::Vector3d& b = platform[static_cast<std::size_t>(i)];
      const Complex3 arm = r.col(0) * b[0] + r.col(1) * b[1] + r.col(2) * b[2];
      const Complex3 leg = x.tail<3>() + arm - base[static_cast<std::size_t>(i)];
      residual[i] = product(leg, leg) - p[i];
      if (jacobian) {
        jacobian->row(i).head<3>() = 2.0 * cross(arm, leg);
        jacobian->row(i).tail<3>() = 2.0 * leg;
      }
      if (along_dp) (*along_dp)[i] = -(*dp)[i];
    }
  }
  void move(const ComplexVector& x, const ComplexVector& delta, ComplexVector& result) const override {
    const Complex w = x[0];
    const Complex3 v = x.segment<3>(1), d = 0.5 * delta.head<3>();
    const Complex w1 = w - product(d, v);
    const Complex3 v1 = v + w * d + cross(d, v);
    const Complex size = std::sqrt(w1 * w1 + product(v1, v1));
    result[0] = w1 / size;
    result.segment<3>(1) = v1 / size;
    result.tail<3>() = x.tail<3>() + delta.tail<3>();
  }
  void fingerprint(const ComplexVector& x, ComplexVector& print) const override {
    const Complex33 r = rotation(x);
    print.resize(12);
    for (Eigen::Index i = 0; i < 3; ++i) print.segment<3>(3 * i) = r.col(i);
    print.tail<3>() = x.tail<3>();
  }
  bool seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) override {
    for (Complex& value : x) value = uniform_complex(random);
    x.head<4>() /= std::sqrt(x[0] * x[0] + product(x.segment<3>(1), x.segment<3>(1)));
    ComplexVector residual(6);
    p.setZero();
    evaluate(x, p, residual, nullptr, nullptr, nullptr);
    p = residual;
    return true;
  }
};

/// The same with the joints as parameters, too: squared legs (6), base joints (18), platform joints (18).
class GeneralStewart : public Stewart {
 public:
  Eigen::Index parameters() const override { return 42; }
  void evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                const ComplexVector* dp, ComplexVector* along_dp) override {
    const Complex33 r = rotation(x);
    for (Eigen::Index i = 0; i < 6; ++i) {
      const Complex3 arm = r * p.segment<3>(24 + 3 * i), leg = x.tail<3>() + arm - p.segment<3>(6 + 3 * i);
      residual[i] = product(leg, leg) - p[i];
      if (jacobian) {
        jacobian->row(i).head<3>() = 2.0 * cross(arm, leg);
        jacobian->row(i).tail<3>() = 2.0 * leg;
      }
      if (along_dp) {
        const Complex3 change = r * dp->segment<3>(24 + 3 * i) - dp->segment<3>(6 + 3 * i);
        (*along_dp)[i] = 2.0 * product(leg, change) - (*dp)[i];
      }
    }
  }
  bool seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) override {
    for (Complex& value : p) value = uniform_complex(random);
    p.head<6>().setZero();
    for (Complex& value : x) value = uniform_complex(random);
    x.head<4>() /= std::sqrt(x[0] * x[0] + product(x.segment<3>(1), x.segment<3>(1)));
    ComplexVector residual(6);
    evaluate(x, p, residual, nullptr, nullptr, nullptr);
    p.head<6>() = residual;
    return true;
  }
  /// Parameters of this geometry with given squared legs.
  ComplexVector with(const ComplexVector& squares) const {
    ComplexVector p(42);
    p.head<6>() = squares;
    for (Eigen::Index i = 0; i < 6; ++i) {
      p.segment<3>(6 + 3 * i) = base[static_cast<std::size_t>(i)].cast<Complex>();
      p.segment<3>(24 + 3 * i) = platform[static_cast<std::size_t>(i)].cast<Complex>();
    }
    return p;
  }
};

/// Six revolutes by Denavit and Hartenberg, Rz(angle) Tz(d) Tx(a) Rx(alpha): point (cos, sin) of each; parameters:
/// Rodrigues' vector and displacement of the hand in the frame of `hand`.
class SixRevolutes : public ContinuationProblem {
 public:
  std::array<double, 6> a{}, d{}, alpha{};
  Eigen::Matrix3d hand_rotation;
  Eigen::Vector3d hand_position;

  Eigen::Index unknowns() const override { return 6; }
  Eigen::Index point_size() const override { return 12; }
  Eigen::Index parameters() const override { return 6; }
  void evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                const ComplexVector* dp, ComplexVector* along_dp) override {
    std::array<Complex3, 6> axis, origin;
    Complex33 r = Complex33::Identity();
    Complex3 o = Complex3::Zero();
    for (std::size_t i = 0; i < 6; ++i) {
      axis[i] = r.col(2);
      origin[i] = o;
      const Complex c = x[2 * static_cast<Eigen::Index>(i)], s = x[2 * static_cast<Eigen::Index>(i) + 1];
      const Complex3 u = r.col(0) * c + r.col(1) * s, v = r.col(1) * c - r.col(0) * s;
      o += d[i] * axis[i] + a[i] * u;
      const double ca = std::cos(alpha[i]), sa = std::sin(alpha[i]);
      r.col(0) = u;
      r.col(1) = ca * v + sa * axis[i];
      r.col(2) = ca * axis[i] - sa * v;
    }
    const Complex3 u = p.head<3>();
    const Complex33 hat = skew(u), unit = Complex33::Identity();
    const Complex scale = 2.0 / (1.0 + product(u, u));
    const Complex33 turned = unit + scale * (hat * hat - hat);  // Cayley's transform of u, transposed
    const Complex33 into = turned * hand_rotation.transpose();
    const Complex33 error = into * r;
    residual.head<3>() = vee(error);
    residual.tail<3>() = hand_rotation.transpose() * (o - hand_position) - p.tail<3>();
    if (jacobian) {
      for (std::size_t i = 0; i < 6; ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        jacobian->col(column).head<3>() = vee(skew(into * axis[i]) * error);
        jacobian->col(column).tail<3>() = hand_rotation.transpose() * cross(axis[i], o - origin[i]);
      }
    }
    if (along_dp) {
      const Complex3 du = dp->head<3>();
      along_dp->head<3>() = -vee(skew(scale * (du - cross(u, du))) * error);
      along_dp->tail<3>() = -dp->tail<3>();
    }
  }
  void move(const ComplexVector& x, const ComplexVector& delta, ComplexVector& result) const override {
    for (Eigen::Index i = 0; i < 6; ++i) {
      const Complex c = x[2 * i] - x[2 * i + 1] * delta[i], s = x[2 * i + 1] + x[2 * i] * delta[i];
      const Complex size = std::sqrt(c * c + s * s);
      result[2 * i] = c / size;
      result[2 * i + 1] = s / size;
    }
  }
  void fingerprint(const ComplexVector& x, ComplexVector& print) const override { print = x; }
  bool seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) override {
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double re = uniform(random);
      const Complex angle(std::numbers::pi * re, 0.7 * uniform(random));
      x[2 * i] = std::cos(angle);
      x[2 * i + 1] = std::sin(angle);
    }
    ComplexVector residual(6);
    p.setZero();
    evaluate(x, p, residual, nullptr, nullptr, nullptr);
    p.tail<3>() = residual.tail<3>();
    p.head<3>() = 2.0 * residual.head<3>() / (1.0 + trace(x));
    return true;
  }

 private:
  template <class M>
  static Complex3 vee(const M& m) {
    const Complex33 e = m;
    return 0.5 * Complex3(e(2, 1) - e(1, 2), e(0, 2) - e(2, 0), e(1, 0) - e(0, 1));
  }
  /// Of the hand's rotation in the frame of `hand`.
  Complex trace(const ComplexVector& x) const {
    Complex33 r = hand_rotation.transpose().cast<Complex>();
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double ca = std::cos(alpha[static_cast<std::size_t>(i)]), sa = std::sin(alpha[static_cast<std::size_t>(i)]);
      Complex33 link;
      link << x[2 * i], -ca * x[2 * i + 1], sa * x[2 * i + 1], x[2 * i + 1], ca * x[2 * i], -sa * x[2 * i], 0, sa, ca;
      r *= link;
    }
    return r.trace();
  }
};

}  // namespace koppel::test

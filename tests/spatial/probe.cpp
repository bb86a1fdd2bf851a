// Prints arguments and results of rotation functions with all their digits, for the comparison with fifty digits in
// fifty_digits_test.py: a name, then the argument, then the result, as hexadecimal numbers.
#include <cstdio>
#include <numbers>

#include "every_coordinates.hpp"
#include "spatial/pose_exponential.hpp"
#include "spatial/vector.hpp"

namespace koppel::test {
namespace {

constexpr double pi = std::numbers::pi;

template <typename Derived>
void print(const Eigen::MatrixBase<Derived>& m) {
  std::printf(" ;");
  // Row by row.
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) std::printf(" %a", m(i, j));
  }
}

template <typename Argument, typename Derived>
void line(const std::string& name, const Argument& x, const Eigen::MatrixBase<Derived>& result) {
  std::printf("%s", name.c_str());
  print(x);
  print(result);
  std::printf("\n");
}

template <typename C>
void coordinates(const Vector3& phi) {
  const auto x = C::template of_quaternion<double>(quaternion_of_rotation_vector<double>(phi)).coordinates;
  const std::string kind = NameOf<C>::text();
  line(kind + " rotation", x, rotation<C, double>(x));
  line(kind + " quaternion", x, C::template quaternion<double>(x));
  for (const Axes axes : {Axes::base, Axes::body}) {
    const std::string where = axes == Axes::base ? " base" : " body";
    line(kind + " H" + where, x, C::template h_matrix<double>(x, axes));
    const auto k = C::template k_matrix<double>(x, axes);
    if (k) {
      line(kind + " K" + where, x, *k);
    } else {
      line(kind + " noK" + where, x, Vector3::Zero().eval());
    }
  }
}

void everything(const Vector3& phi) {
  const Vector4 q = quaternion_of_rotation_vector<double>(phi);
  line("exp quaternion", phi, q);
  line("exp", phi, rotation_of_rotation_vector<double>(phi));
  line("log", q, rotation_vector_of_quaternion<double>(q));
  line("J_l", phi, left_jacobian<double>(phi));
  line("J_r", phi, right_jacobian<double>(phi));
  if (RotationVector::k_matrix<double>(phi, Axes::base)) {
    line("J_l^-1", phi, left_jacobian_inverse<double>(phi));
    line("J_r^-1", phi, right_jacobian_inverse<double>(phi));
  }
  const Vector6 x = (Vector6() << phi, 0.3, -0.7, 0.4).finished();
  line("pose exp", x, pose_exp<double>(x).position);
  line("pose J_l", x, pose_left_jacobian<double>(x));
  coordinates<AxisAngle>(phi);
  coordinates<RotationVector>(phi);
  coordinates<EulerParameters>(phi);
  coordinates<RodriguesParameters>(phi);
  coordinates<EulerAngles>(phi);
  coordinates<CardanAngles>(phi);
  coordinates<AngleSequence<1, 0, 2>>(phi);
  coordinates<AngleSequence<1, 2, 1>>(phi);
}

}  // namespace
}  // namespace koppel::test

int main() {
  using koppel::Vector3;
  for (const double angle : {0.0, 1e-300, 1e-160, 1e-16, 1e-8, 1e-4, 1.0, koppel::test::pi - 1e-8,
                             koppel::test::pi - 1e-16, koppel::test::pi, 2 * koppel::test::pi}) {
    for (const Vector3& along : {Vector3(1, 0, 0), Vector3(-1, 2, 2), Vector3(0.3, -0.8, 0.5)}) {
      koppel::test::everything(angle * *koppel::normalised<double>(along));
    }
  }
}

// How many units of rounding the functions of this room lose at worst, over many random and all special arguments:
// measured against long double, printed as tables, and kept in a file.
#include "accuracy.hpp"

#include <fstream>
#include <iostream>
#include <tuple>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "every_coordinates.hpp"
#include "folders.hpp"
#include "spatial/pose_exponential.hpp"
#include "spatial/twist.hpp"
#include "special_rotations.hpp"

namespace koppel::test {
namespace {

/// What every conversion keeps to, in units of rounding times its condition.
constexpr double bound = 8;

std::string& report() {
  static std::string text;
  return text;
}

/// The special rotations and random ones, each exact in long double.
template <typename Check>
void for_many_rotations(const Check& check) {
  for (const auto& q : special_rotations()) check(q);
  Random random(1);
  for (int n = 0; n < KOPPEL_SAMPLES; ++n) check(Vector4T<Long>(random.quaternion().cast<Long>().normalized()));
}

/// Of all cases, so few may be left out because the coordinates are singular there.
constexpr long enough = KOPPEL_SAMPLES * 9L / 10;

void expect_bounds(const ErrorList& list) {
  for (const auto& [name, worst] : list.rows()) {
    EXPECT_LE(worst.value(), bound) << name;
    EXPECT_GE(worst.count(), enough) << name;
  }
  report() += list.text();
}

template <std::size_t n>
void expect_bounds(ErrorSquare<n>& square) {
  for (std::size_t from = 0; from < n; ++from) {
    for (std::size_t to = 0; to < n; ++to) {
      if (from == to) continue;
      EXPECT_LE(square.at(from, to).value(), bound) << square.name(from) << " to " << square.name(to);
      EXPECT_GE(square.at(from, to).count(), enough) << square.name(from) << " to " << square.name(to);
    }
  }
  report() += square.text();
}

/// One rotation in coordinates of one kind: exact, rounded, and its matrices H and K in base axes.
template <typename C>
struct Sample {
  explicit Sample(const Vector4T<Long>& q)
      : exact(C::template of_quaternion<Long>(q).coordinates),
        rounded(exact.template cast<double>()),
        h(C::template h_matrix<double>(rounded, Axes::base)) {
    const auto inverse = C::template k_matrix<double>(rounded, Axes::base);
    regular = inverse && !C::template of_quaternion<double>(q.cast<double>()).singular;
    if (inverse) k = *inverse;
  }

  /// How far the body turns when the coordinates change by a part of their size.
  Long turn() const { return h.norm() * rounded.norm(); }
  /// How far the coordinates move by a turn, or by a part of their size.
  Long moved_by(Long turned) const { return std::max<Long>(exact.norm(), k.norm() * turned); }

  Eigen::Matrix<Long, C::size, 1> exact;
  Eigen::Matrix<double, C::size, 1> rounded;
  Eigen::Matrix<double, 3, C::size> h;
  Eigen::Matrix<double, C::size, 3> k;
  bool regular;
};

/// Distance to the nearest of the coordinates that mean the same.
template <typename C>
Long distance(const Eigen::Matrix<double, C::size, 1>& computed, const Eigen::Matrix<Long, C::size, 1>& exact) {
  const Eigen::Matrix<Long, C::size, 1> off = computed.template cast<Long>() - exact;
  Long least = off.norm();
  if constexpr (requires { C::template twin<Long>(exact); }) {
    const std::optional<Eigen::Matrix<Long, C::size, 1>> twin = C::template twin<Long>(exact);
    if (twin) least = std::min(least, (computed.template cast<Long>() - *twin).norm());
  }
  if constexpr (std::is_same_v<C, AxisAngle>) {
    // At half a turn the axis may point either way.
    Vector4T<Long> turned = -exact;
    turned[3] += 2 * constants::pi<Long>();
    least = std::min(least, (computed.template cast<Long>() - turned).norm());
  }
  if constexpr (C::size == 3 && !std::is_same_v<C, RotationVector> && !std::is_same_v<C, RodriguesParameters>) {
    // An angle at pi may be at -pi.
    least = std::min(least, off.unaryExpr([](Long angle) { return wrapped<Long>(angle); }).norm());
  }
  return least;
}

/// The angle between the rotation of coordinates and the exact one [rad].
template <typename C>
Long turned_by(const Eigen::Matrix<double, C::size, 1>& computed, const Vector4T<Long>& exact) {
  const auto q = C::template quaternion<Long>(computed.template cast<Long>());
  return 2 * quaternion_product<Long>(conjugate<Long>(q), exact).template tail<3>().norm() / q.norm();
}

struct Conversions {
  static constexpr std::size_t kinds = 7;
  using Square = ErrorSquare<kinds>;
  using Samples =
      std::tuple<Sample<DirectionCosines>, Sample<AxisAngle>, Sample<RotationVector>, Sample<EulerParameters>,
                 Sample<RodriguesParameters>, Sample<EulerAngles>, Sample<CardanAngles>>;
  static inline const std::array<std::string, kinds> names{
      "matrix", "axis and angle", "rotation vector", "quaternion", "Rodrigues", "Euler angles", "Cardan angles"};

  template <std::size_t a, std::size_t b, typename From, typename To>
  void convert(const Vector4T<Long>& q, const Sample<From>& from, const Sample<To>& to) {
    const auto y = converted<To, From, double>(from.rounded).coordinates;
    // Rounding the coordinates alone turns the body: those from which it starts, and those where it ends.
    rotation.at(a, b).take(turned_by<To>(y, q), std::max<Long>(1, from.turn() + to.h.norm() * y.norm()));
    if (!from.regular || !to.regular) return;
    const Long there = std::max<Long>(to.exact.norm(), (to.k * from.h).norm() * from.rounded.norm());
    coordinates.at(a, b).take(distance<To>(y, to.exact), there);
    // Back again, from coordinates that have been rounded twice.
    const auto x = converted<From, To, double>(y).coordinates;
    round_trip.at(a, b).take(distance<From>(x, from.exact), from.moved_by(from.turn() + to.turn()));
  }

  void take(const Vector4T<Long>& q) {
    const Samples samples{Sample<DirectionCosines>(q), Sample<AxisAngle>(q),           Sample<RotationVector>(q),
                          Sample<EulerParameters>(q),  Sample<RodriguesParameters>(q), Sample<EulerAngles>(q),
                          Sample<CardanAngles>(q)};
    const auto pair = [&]<std::size_t code>() {
      constexpr std::size_t a = code / kinds, b = code % kinds;
      if constexpr (a != b) convert<a, b>(q, std::get<a>(samples), std::get<b>(samples));
    };
    const auto all = [&]<std::size_t... code>(std::index_sequence<code...>) {
      (pair.template operator()<code>(), ...);
    };
    all(std::make_index_sequence<kinds * kinds>());
  }

  Square coordinates{"Conversions, error of the coordinates over their size times the condition", names};
  Square rotation{"Conversions, error of the rotation over that of rounding the coordinates", names};
  Square round_trip{"There and back, error of the coordinates over their size times the condition", names};
};

// Checks K-I-4.7, K-I-4.2.2, K-I-4.5.3.
// The coordinates of a rotation are rounded, converted, and compared with those that the exact rotation has. Condition
// of a conversion: |K_to H_from| |x_from| / |x_to|, at least one. Where coordinates are singular, only the rotation
// counts.
TEST(Accuracy, OfConversions) {
  Conversions conversions;
  for_many_rotations([&](const Vector4T<Long>& q) { conversions.take(q); });
  expect_bounds(conversions.coordinates);
  expect_bounds(conversions.rotation);
  expect_bounds(conversions.round_trip);
}

template <typename C>
void take_matrices(ErrorList& list, const Vector4T<Long>& q) {
  const Eigen::Matrix<double, C::size, 1> x = C::template of_quaternion<double>(q.cast<double>()).coordinates;
  const Eigen::Matrix<Long, C::size, 1> same = x.template cast<Long>();
  const std::string name = NameOf<C>::text();
  // The argument itself moves the entries, by a part of its size. Those of Rodrigues parameters are rational functions:
  // a part of the argument moves them by as many parts.
  constexpr bool rational = std::is_same_v<C, RodriguesParameters>;
  const Long size = rational ? 1 : 1 + same.norm();
  const auto exact_rotation = rotation<C, Long>(same);
  list[name + ": rotation"].take(rotation<C, double>(x), exact_rotation, exact_rotation.norm() * size);
  for (const Axes axes : {Axes::base, Axes::body}) {
    const std::string where = axes == Axes::base ? " in base axes" : " in body axes";
    const auto h = C::template h_matrix<Long>(same, axes);
    list[name + ": H" + where].take(C::template h_matrix<double>(x, axes), h, h.norm() * size);
    const auto k = C::template k_matrix<double>(x, axes);
    const auto exact = C::template k_matrix<Long>(same, axes);
    if (!k || !exact) continue;
    // dK = -K dH K, and nowhere less than by rounding K.
    const Long turned = rational ? 1 : std::max<Long>(1, exact->norm() * h.norm());
    list[name + ": K" + where].take(*k, *exact, exact->norm() * turned * size);
  }
}

/// The rate of the matrix, by dual numbers, against the angular velocity that H gives.
template <typename C>
void take_derivative(ErrorList& list, const Vector4T<Long>& q, Random& random) {
  const Sample<C> at(q);
  if (!at.regular) return;
  const Vector3 omega = random.direction();
  const Eigen::Matrix<double, C::size, 1> rates = at.k * omega;
  const Matrix3T<Dual<double>> moving = rotation<C, Dual<double>>(dual(at.rounded, rates));
  const Vector3 turning = axial(dual_part(moving) * real_part(moving).transpose());
  const Vector3T<Long> exact =
      C::template h_matrix<Long>(at.rounded.template cast<Long>(), Axes::base) * rates.template cast<Long>();
  list[NameOf<C>::text() + ": R' by dual numbers is skew(H x') R"].take(
      turning, exact, at.h.norm() * rates.norm() * (1 + at.exact.norm()));
}

// Checks K-I-4.0a, K-I-3.2.2, K-I-6.1.2.
TEST(Accuracy, OfDerivatives) {
  ErrorList list("Derivatives of rotations, over |H| |x'| (1 + |x|)");
  Random random(4);
  for_many_rotations([&](const Vector4T<Long>& q) {
    take_derivative<DirectionCosines>(list, q, random);
    take_derivative<AxisAngle>(list, q, random);
    take_derivative<RotationVector>(list, q, random);
    take_derivative<EulerParameters>(list, q, random);
    take_derivative<RodriguesParameters>(list, q, random);
    take_derivative<EulerAngles>(list, q, random);
    take_derivative<CardanAngles>(list, q, random);
  });
  expect_bounds(list);
}

// Checks K-I-4.0a, K-I-4.2.4, K-I-4.3.2, K-I-4.4.2, K-I-4.5.5, K-I-4.6.2.
TEST(Accuracy, OfRotationAndRateMatrices) {
  ErrorList list(
      "Rotation, H and K of given coordinates, over their size times (1 + |x|), K also times |K| |H|; Rodrigues: over "
      "their size");
  for_many_rotations([&](const Vector4T<Long>& q) {
    take_matrices<AxisAngle>(list, q);
    take_matrices<RotationVector>(list, q);
    take_matrices<EulerParameters>(list, q);
    take_matrices<RodriguesParameters>(list, q);
    take_matrices<EulerAngles>(list, q);
    take_matrices<CardanAngles>(list, q);
  });
  expect_bounds(list);
}

// Checks K-I-4.2.1b, K-I-3.3.1.
TEST(Accuracy, OfExponentialsLogarithmsAndTheirDerivatives) {
  ErrorList list("Exponential, logarithm, derivatives, over their size times (1 + |argument|) times the condition");
  Random random(2);
  for_many_rotations([&](const Vector4T<Long>& q) {
    Vector6 x;
    x << rotation_vector_of_quaternion<Long>(q).cast<double>(), random.vector();
    const Vector6T<Long> same = x.cast<Long>();
    const Long size = 1 + same.norm();
    const PoseT<double> pose = pose_exp<double>(x);
    const PoseT<Long> exact = pose_exp<Long>(same);
    list["exp to rotations"].take(pose.rotation, exact.rotation, exact.rotation.norm() * size);
    list["exp to poses: position"].take(pose.position, exact.position, size * same.tail<3>().norm());
    const Matrix6T<Long> left = pose_left_jacobian<Long>(same), back = pose_left_jacobian_inverse<Long>(same);
    list["J_l of poses"].take(pose_left_jacobian<double>(x), left, left.norm() * size);
    list["J_r of poses"].take(pose_right_jacobian<double>(x), pose_right_jacobian<Long>(same), left.norm() * size);
    list["J_l^-1 of poses"].take(pose_left_jacobian_inverse<double>(x), back, back.norm() * left.norm() * size);
    // Twelve entries that were rounded, and the longest vector is pi: the condition of log is |J_l^-1| |X|.
    const PoseT<double> rounded{exact.rotation.cast<double>(), exact.position.cast<double>()};
    const Vector6 log = pose_log<double>(rounded);
    Vector6T<Long> other = same;
    if (same.head<3>().norm() > 3) {
      // At half a turn the other way round is as long.
      PoseT<Long> turned = exact;
      other << *RotationVector::twin<Long>(same.head<3>()), 0, 0, 0;
      other.tail<3>() = left_jacobian_inverse<Long>(other.head<3>()) * turned.position;
    }
    const Long off = std::min((log.cast<Long>() - same).norm(), (log.cast<Long>() - other).norm());
    list["log of poses"].take(off, back.norm() * (exact.rotation.norm() + exact.position.norm()));
  });
  expect_bounds(list);
}

// Checks K-I-4.5.1, K-I-3.3.1, K-I-6.4.
// Products of three, either way; a product with the inverse; an inverse of a product. Sizes are one but for positions.
TEST(Accuracy, OfGroupLaws) {
  ErrorList list("Group laws, over the sizes of the factors");
  Random random(3);
  using Lines = Dual<double>;
  for (int n = 0; n < KOPPEL_SAMPLES; ++n) {
    const Vector4 a = random.quaternion(), b = random.quaternion(), c = random.quaternion();
    const auto times = [](const auto& p, const auto& q) {
      return quaternion_product<typename std::decay_t<decltype(p)>::Scalar>(p, q);
    };
    list["(p q) r = p (q r), unit quaternions"].take((times(times(a, b), c) - times(a, times(b, c))).norm(), 1);
    list["q conj(q) = 1, unit quaternions"].take((times(a, conjugate<double>(a)) - Vector4::Unit(0)).norm(), 1);
    const Pose x{rotation_of_quaternion<double>(a), random.vector()},
        y{rotation_of_quaternion<double>(b), random.vector()}, z{rotation_of_quaternion<double>(c), random.vector()};
    const double reach = 1 + x.position.norm() + y.position.norm() + z.position.norm();
    const Pose left = (x * y) * z, right = x * (y * z), none = x * x.inverse();
    list["(A B) C = A (B C), rotation matrices"].take((left.rotation - right.rotation).norm(), std::sqrt(3.0L));
    list["(A B) C = A (B C), poses: position"].take((left.position - right.position).norm(), reach);
    list["A A^-1 = 1, rotation matrices"].take((none.rotation - Matrix3::Identity()).norm(), 3);
    list["A A^-1 = 1, poses: position"].take(none.position.norm(), 2 * x.position.norm());
    list["|R v| = |v|"].take(std::abs((x.rotation * z.position).norm() - z.position.norm()), z.position.norm());
    const Matrix6 both = adjoint<double>(x * y), product = adjoint<double>(x) * adjoint<double>(y);
    list["Ad(A B) = Ad(A) Ad(B)"].take((both - product).norm(), both.norm() + product.norm());
    const auto screw = [](const Vector4& q, const Pose& p) {
      const Vector4 moved = 0.5 * quaternion_product<double>((Vector4() << 0, p.position).finished(), q);
      return Vector4T<Lines>(dual(q, moved));
    };
    const Vector4T<Lines> i = screw(a, x), j = screw(b, y), k = screw(c, z);
    list["(p q) r = p (q r), unit dual quaternions"].take(
        dual_part(times(times(i, j), k) - times(i, times(j, k))).norm(), reach);
    list["q conj(q) = 1, unit dual quaternions"].take(dual_part(times(i, conjugate<Lines>(i))).norm(), reach);
  }
  expect_bounds(list);
}

}  // namespace
}  // namespace koppel::test

int main(int count, char** arguments) {
  testing::InitGoogleTest(&count, arguments);
  const int failed = RUN_ALL_TESTS();
  const std::string text =
      "Worst errors of core/spatial in units of rounding, 2^-53 = 1.1e-16\n" + koppel::test::report();
  std::cout << text;
  std::ofstream(koppel::test::build_folder() + "/spatial_accuracy.md") << text;
  return failed;
}

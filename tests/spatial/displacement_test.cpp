// Displacements: dual matrices and quaternions do with lines what rotations do with directions; every pose is a screw;
// motions compose.
#include "spatial/displacement.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using D = Dual<double>;
using DualVector = Vector3T<D>;
using DualMatrix = Matrix3T<D>;
using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

Pose random_pose(Random& random) { return {random.rotation(), random.vector()}; }
DualVector random_screw(Random& random) { return dual(random.vector(), random.vector()); }

/// The greater of the real and the dual parts.
template <typename Derived>
double greatest(const Eigen::MatrixBase<Derived>& m) {
  return std::max(real_part(m).cwiseAbs().maxCoeff(), dual_part(m).cwiseAbs().maxCoeff());
}
double apart(const Pose& a, const Pose& b) {
  return std::max((a.rotation - b.rotation).cwiseAbs().maxCoeff(), (a.position - b.position).cwiseAbs().maxCoeff());
}

/// A screw displacement with known data, and the pose it makes: t = c - R c + d u.
struct Known {
  explicit Known(Random& random)
      : axis(random.direction()),
        point(random.vector()),
        angle(random.between(0.1, 3.1), random.between(-1, 1)),
        line(dual(axis, point.cross(axis))),
        pose{rotation_about<double>(axis, angle.real), Vector3::Zero()} {
    pose.position = point - pose.rotation * point + angle.dual * axis;
  }
  Vector3 axis, point;
  D angle;
  DualVector line;
  Pose pose;
};

// Checks K-I-6.2.5. Three products of numbers of order one in every entry.
TEST(DualRotation, ChainsAndIsOrthogonal) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Pose x = random_pose(random), y = random_pose(random);
    const DualMatrix m = dual_rotation_of_pose(x);
    EXPECT_LE(greatest(m * dual_rotation_of_pose(y) - dual_rotation_of_pose(x * y)), 32 * eps);
    EXPECT_LE(greatest(m * m.transpose() - DualMatrix::Identity()), 32 * eps);
    EXPECT_LE(greatest(m.transpose() - dual_rotation_of_pose(x.inverse())), 32 * eps);
    EXPECT_LE(apart(pose_of_dual_rotation(m), x), 16 * eps);
    EXPECT_LE(greatest(m - dual_basis(x)), 4 * eps) << "its columns are the lines along the axes of B";
  }
  const Vector3 r(1, 2, 3);
  EXPECT_EQ(dual_rotation_of_pose<double>({Matrix3::Identity(), r}), DualMatrix(dual(Matrix3::Identity(), skew(r))));
}

// Checks K-I-6.2.5.
TEST(DualRotation, InRealFormIsTheMatrixOfTwists) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Pose x = random_pose(random);
    const Matrix6 m = real_form(dual_rotation_of_pose(x));
    EXPECT_LE((m - adjoint(x)).cwiseAbs().maxCoeff(), 4 * eps);
    EXPECT_NEAR(m.determinant(), 1, 256 * eps);
    const DualVector s = random_screw(random), moved = transform_screw(x, s);
    EXPECT_LE(greatest(moved - dual_rotation_of_pose(x) * s), 32 * eps);
    EXPECT_LE((transformed(x, twist_of_dual(s)).vector() - twist_of_dual(moved).vector()).norm(), 32 * eps);
    EXPECT_LE((transformed(x, wrench_of_dual(s)).vector() - wrench_of_dual(moved).vector()).norm(), 32 * eps);
  }
}

// Checks K-I-6.2.5. Another frame changes neither the dual length, so the pitch, nor the line as a set of points.
TEST(TransformScrew, KeepsPitchAndLine) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Pose x = random_pose(random);
    const Vector3 a = random.direction(), point = random.vector();
    const double pitch = random.between(-1, 1);
    const Screw s = screw_of<double>(transform_screw<double>(x, dual(a, point.cross(a) + pitch * a)), 1.0);
    EXPECT_NEAR(s.magnitude.real, 1, 8 * eps);
    EXPECT_NEAR(s.pitch(), pitch, 64 * eps);
    EXPECT_LE((s.axis.direction - x.rotation * a).norm(), 8 * eps);
    EXPECT_LE((s.axis.moment - (x * point).cross(s.axis.direction)).norm(), 64 * eps);
    const Vector3 p = random.vector();
    const DualVector shifted_screw = shift_reference(s.dual(), p);
    EXPECT_LE(greatest(shifted_screw - transform_screw<double>({Matrix3::Identity(), -p}, s.dual())), 8 * eps);
    EXPECT_NEAR(screw_of(shifted_screw, 1.0).pitch(), pitch, 64 * eps);
  }
}

// Checks K-I-6.3, K-I-6.4. The rotation's formula, on a dual axis and a dual angle, is the dual matrix of the pose.
TEST(Transference, RotationAboutALineIsAScrewDisplacement) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Known known(random);
    EXPECT_LE(greatest(rotation_about<D>(known.line, known.angle) - dual_rotation_of_pose(known.pose)), 64 * eps);
    const DualVector vector = known.line * known.angle;
    EXPECT_LE(greatest(rotation_of_rotation_vector<D>(vector) - dual_rotation_of_pose(known.pose)), 64 * eps);
    // Near half a turn the vector is as well determined as anywhere: the quaternion's greatest part is divided by.
    EXPECT_LE(greatest(rotation_vector_of_rotation<D>(dual_rotation_of_pose(known.pose)) - vector), 256 * eps);
  }
}

// Checks K-I-6.3, K-I-6.4. cos(b/2) + u sin(b/2) with dual b and u, the product, and p = q p0 conj(q).
TEST(Transference, QuaternionsOfDualNumbersAreScrewDisplacements) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Known known(random), next(random);
    const D half = known.angle / D(2);
    Vector4T<D> q;
    q << cos(half), known.line * sin(half);
    EXPECT_LE(greatest(q - dual_quaternion_of_pose(known.pose)), 32 * eps);
    EXPECT_LE(greatest(rotation_of_quaternion<D>(q) - dual_rotation_of_pose(known.pose)), 64 * eps);
    EXPECT_LE(greatest(quaternion_of_rotation<D>(dual_rotation_of_pose(known.pose)) - q), 64 * eps);
    const Vector4T<D> product = quaternion_product<D>(q, dual_quaternion_of_pose(next.pose));
    EXPECT_LE(apart(pose_of_dual_quaternion(product), known.pose * next.pose), 128 * eps);
    Vector4T<D> s0;
    s0 << D(0), random_screw(random);
    const Vector4T<D> s = quaternion_product<D>(quaternion_product<D>(q, s0), conjugate<D>(q));
    EXPECT_LE(greatest(s.tail<3>() - transform_screw<double>(known.pose, s0.tail<3>())), 128 * eps);
    EXPECT_LE(greatest(s.head<1>()), 64 * eps);
  }
}

/// The two angles at the output joint of a spherical four-bar, from the cosine rule u2.u3 = cos(a23) (closure type 4).
template <typename T>
std::array<T, 2> output_angles(const T& input, const T& a12, const T& a23, const T& a34, const T& a41) {
  using std::atan2, std::cos, std::sqrt;
  const Vector3T<T> x = Vector3T<T>::UnitX(), z = Vector3T<T>::UnitZ();
  const Vector3T<T> u2 = rotation_about<T>(z, input) * (rotation_about<T>(x, a12) * z);
  const Vector3T<T> p = rotation_about<T>(x, a41).transpose() * u2, r = rotation_about<T>(x, a34) * z;
  const T a = p.x() * r.x() + p.y() * r.y(), b = p.y() * r.x() - p.x() * r.y(), c = p.z() * r.z() - cos(a23);
  const T root = sqrt(a * a + b * b - c * c);
  return {atan2(-b * c + a * root, -a * c - b * root), atan2(-b * c - a * root, -a * c + b * root)};
}

constexpr double degree = pi / 180;
constexpr double printed_angle = 0.5e-9 * degree + 16 * eps, printed_length = 0.5e-9 + 16 * eps;

/// Which of the two is the nearer one to the angle [rad].
template <typename T>
T nearer(const std::array<T, 2>& solutions, double angle) {
  using std::abs;
  return abs(solutions[0] - T(angle)) < abs(solutions[1] - T(angle)) ? solutions[0] : solutions[1];
}

// Checks K-I-6.3. The published angles of the spherical four-bar, in degrees.
TEST(Transference, ClosureOfTheSphericalFourBar) {
  const std::array<std::array<double, 3>, 4> published{{{0, 85.776000616, -85.776000616},
                                                        {45, 60.269140511, -128.141072249},
                                                        {90, 68.289921051, -149.154843224},
                                                        {180, 142.125760500, -142.125760500}}};
  for (const auto& [input, first, second] : published) {
    const auto found = output_angles<double>(input * degree, 40 * degree, 70 * degree, 60 * degree, 80 * degree);
    EXPECT_NEAR(nearer(found, first * degree), first * degree, printed_angle);
    EXPECT_NEAR(nearer(found, second * degree), second * degree, printed_angle);
  }
}

// Checks K-I-6.3. The same function, on dual angles whose dual parts are the offsets and distances of the joint axes,
// closes the loop RCCC: the dual part of the output is the advance in the cylindrical joint. Published numbers.
TEST(Transference, ClosureOfTheSphericalFourBarClosesTheSpatialOne) {
  struct Row {
    double input, angle, advance;
  };
  const std::array<Row, 8> published{{{40, 116.674593388, -0.171355185},
                                      {40, -154.370250936, 0.106344451},
                                      {0, 144.209380265, -0.155144897},
                                      {0, -144.209380265, 0.135144897},
                                      {120, 67.559072890, -0.105074197},
                                      {120, -136.989080798, 0.096425549},
                                      {250, 141.683026456, -0.076045412},
                                      {250, -71.156843622, 0.100176286}}};
  for (const Row& row : published) {
    // Its output is counted from the frame, here from the link: the angles a34, a41 and theta4 change sign.
    const auto found = output_angles<D>(D(row.input * degree, 0.02), D(30 * degree, 0.05), D(55 * degree, 0.15),
                                        -D(45 * degree, 0.10), -D(60 * degree, 0.12));
    const D output = -nearer(found, -row.angle * degree);
    EXPECT_NEAR(output.real, row.angle * degree, printed_angle);
    EXPECT_NEAR(output.dual, row.advance, printed_length) << "at " << row.input;
  }
}

// Checks K-I-6.3, K-I-6.2.5. The whole loop as a product of dual matrices, with the published joint coordinates; those
// of the inner joints have six and eight decimals.
TEST(Transference, LoopOfDualMatricesCloses) {
  const auto link = [](double angle, double offset, double twist, double distance) -> DualMatrix {
    return rotation_about<D>(Vector3::UnitZ().cast<D>(), D(angle * degree, offset)) *
           rotation_about<D>(Vector3::UnitX().cast<D>(), D(twist * degree, distance));
  };
  const DualMatrix first = link(40, 0.02, 30, 0.05);
  const DualMatrix one = first * link(108.761181, -0.15616165, 55, 0.15) * link(58.310907, 0.08356444, 45, 0.10) *
                         link(116.674593388, -0.171355185, 60, 0.12);
  const DualMatrix other = first * link(-176.810421, 0.05097209, 55, 0.15) * link(-58.310907, -0.08356444, 45, 0.10) *
                           link(-154.370250936, 0.106344451, 60, 0.12);
  constexpr double left_out = 2 * 0.5e-6 * degree + 2 * 0.5e-8;
  EXPECT_LE(greatest(one - DualMatrix::Identity()), left_out);
  EXPECT_LE(greatest(other - DualMatrix::Identity()), left_out);
}

// Checks K-I-6.4. Against the source's formula for a point of the axis, c = (t - d u) / 2 + cot(b / 2) u x t / 2, in
// higher precision.
TEST(ScrewDisplacement, IsThatOfTheFormula) {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Known known(random);
    const auto s = screw_displacement_of_pose(known.pose, 1.0);
    ASSERT_EQ(s.kind, MotionKind::screw);
    EXPECT_NEAR(s.angle, known.angle.real, 16 * eps);
    EXPECT_NEAR(s.displacement, known.angle.dual, 64 * eps);
    // The direction is known to the rounding of the matrix over the sine of half the angle, and moves the point as far
    // again.
    const double sine = std::sin(s.angle / 2);
    EXPECT_LE((s.axis.direction - known.axis).norm(), 8 * eps / sine);
    const Vector3T<Long> u = known.axis.cast<Long>(), t = known.pose.position.cast<Long>();
    const Long d = u.dot(t), cotangent = 1 / std::tan(Long(known.angle.real) / 2);
    const Vector3 c = ((t - d * u + cotangent * u.cross(t)) / 2).cast<double>();
    EXPECT_LE((s.axis.moment - c.cross(known.axis)).norm(), 32 * eps / (sine * sine));
    EXPECT_LE((s.axis.moment - known.point.cross(known.axis)).norm(), 32 * eps / (sine * sine));
  }
}

constexpr std::array<double, 12> angles{0.0,  1e-300, 1e-160, 1e-16,     1e-12,      1e-8,
                                        1e-3, 1.0,    3.0,    pi - 1e-8, pi - 1e-15, pi};
constexpr std::array<double, 7> ways{0.0, 1e-300, 1e-160, 1e-12, 1.0, 1e6, 1e150};

// Checks K-I-6.4. To rounding of the position, and of the angle; what the kinds leave out is rounding beside the
// length.
TEST(ScrewDisplacement, MakesThePoseAgain) {
  Random random(7);
  for (const double angle : angles) {
    for (const double way : ways) {
      for (int i = 0; i < 20; ++i) {
        const Vector3 u = i < 3 ? Vector3(Vector3::Unit(i)) : random.direction();
        const Vector3 t = way * (i % 4 == 0 ? u : random.direction());
        const Pose x{rotation_of_rotation_vector<double>(angle * u), t};
        const auto s = screw_displacement_of_pose(x, 1.0);
        const Pose again = pose_of_screw_displacement(s);
        const double lost_turn = s.kind == MotionKind::translation ? std::min(4.0, 8 * eps * way) : 0;
        const double lost_way = s.kind == MotionKind::rotation ? 8 * eps * std::max(2 * way, angle) : 0;
        EXPECT_LE((again.rotation - x.rotation).cwiseAbs().maxCoeff(), 16 * eps + lost_turn) << angle << ' ' << way;
        EXPECT_LE((again.position - t).cwiseAbs().maxCoeff(), 64 * eps * way + lost_way) << angle << ' ' << way;
        EXPECT_TRUE(s.axis.direction.allFinite() && s.axis.moment.allFinite());
        EXPECT_GE(s.angle, 0);
        EXPECT_LE(s.angle, pi + 4 * eps);
        if (s.angle > 0) {
          EXPECT_NEAR(s.angle / angle, 1, 8 * eps) << angle << ' ' << way;
        }
      }
    }
  }
}

// Checks K-I-6.4.
TEST(ScrewDisplacement, KindsHaveNames) {
  const Vector3 z = Vector3::UnitZ(), none = Vector3::Zero();
  const auto found = [&](double angle, const Vector3& t) {
    return screw_displacement_of_pose<double>({rotation_about<double>(z, angle), t}, 1.0);
  };
  EXPECT_EQ(found(0, none).kind, MotionKind::rest);
  const auto translation = found(0, {0, 3, 4});
  EXPECT_EQ(translation.kind, MotionKind::translation);
  EXPECT_EQ(translation.angle, 0);
  EXPECT_NEAR(translation.displacement, 5, 4 * eps);
  EXPECT_LE((translation.axis.direction - Vector3(0, 0.6, 0.8)).norm(), 2 * eps);
  EXPECT_EQ(found(1, none).kind, MotionKind::rotation);
  EXPECT_EQ(found(1e-160, none).kind, MotionKind::rotation);
  EXPECT_EQ(found(1e-17, {1, 0, 0}).kind, MotionKind::translation) << "a line 1e17 m away is none";
  EXPECT_EQ(found(1e-160, {1e-160, 0, 0}).kind, MotionKind::rotation) << "about a line a metre away";
  EXPECT_NEAR(found(1e-160, {1e-160, 0, 0}).axis.moment.norm(), 1, 8 * eps);
  EXPECT_EQ(found(1, {1, 0, 0}).kind, MotionKind::rotation);
  EXPECT_EQ(found(1, {1, 0, 1}).kind, MotionKind::screw);
  EXPECT_EQ(found(1, {1, 0, 1e-17}).kind, MotionKind::rotation);
  // Half a turn about a line through (1, 2, 0): either sense, and the advance with it.
  const auto half = found(pi, {2, 4, 0.5});
  EXPECT_EQ(half.kind, MotionKind::screw);
  EXPECT_NEAR(half.angle, pi, 2 * eps);
  EXPECT_NEAR(half.displacement * half.axis.direction.z(), 0.5, 4 * eps);
  EXPECT_LE((half.axis.direction.cross(half.axis.moment) - Vector3(1, 2, 0)).norm(), 16 * eps);
}

// Checks K-I-6.4. Among pose, angles beyond half a turn and negative ones: the shortest way is found again.
TEST(ScrewDisplacement, OfAnyAngleMakesAPose) {
  Random random(8);
  for (const double angle : {-1.0, 4.0, 2 * pi, 50.0}) {
    const Known known(random);
    const LineT<double> axis{known.axis, known.point.cross(known.axis)};
    const Pose x = pose_of_screw_displacement<double>({MotionKind::screw, axis, angle, 0.3});
    const Matrix3 r = rotation_about<double>(known.axis, angle);
    const double rounding = 32 * eps * (1 + std::abs(angle));
    EXPECT_LE((x.rotation - r).cwiseAbs().maxCoeff(), rounding);
    EXPECT_LE((x.position - (known.point - r * known.point + 0.3 * known.axis)).norm(), rounding);
  }
}

// Checks K-I-6.4. A point on the way runs on a helix about the axis: its distance stays, angle and advance grow evenly.
TEST(InterpolatedPose, MovesOnAHelix) {
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const Pose a = random_pose(random);
    const Known known(random);
    const Pose b = a * known.pose;
    const Vector3 p = random.vector(), r = p - known.point, across = r - known.axis.dot(r) * known.axis;
    for (const double s : {0.0, 0.25, 0.5, 1.0, -1.0, 2.0}) {
      const auto found = interpolated(a, b, s);
      EXPECT_FALSE(found.ambiguous);
      const Matrix3 turn = rotation_about<double>(known.axis, s * known.angle.real);
      const Vector3 helix =
          known.point + s * known.angle.dual * known.axis + known.axis.dot(r) * known.axis + turn * across;
      // The axis is determined as the sine of half the angle allows.
      const double sine = std::sin(known.angle.real / 2);
      EXPECT_LE((found.value * p - a * helix).norm(), 128 * eps / sine) << s;
    }
    EXPECT_LE(apart(interpolated(a, b, 0.0).value, a), 8 * eps);
    EXPECT_LE(apart(interpolated(a, b, 1.0).value, b), 64 * eps);
  }
}

// Checks K-I-6.4. The velocity screw is the same all the way, displacement over time: differentiated by the fraction.
TEST(InterpolatedPose, HasAConstantVelocityScrew) {
  Random random(10);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(random);
    const Known known(random);
    const Pose b = a * known.pose;
    const auto moving = [](const Pose& x) { return PoseT<D>{x.rotation.cast<D>(), x.position.cast<D>()}; };
    const auto x = interpolated<D>(moving(a), moving(b), D(random.between(0, 1), 1)).value;
    const Vector3 omega = axial(dual_part(x.rotation) * real_part(x.rotation).transpose());
    const Vector3 v = dual_part(x.position) - omega.cross(real_part(x.position));
    const DualVector expected = transform_screw<double>(a, known.line * known.angle);
    EXPECT_LE(greatest(dual(omega, v) - expected), 512 * eps / std::sin(known.angle.real / 2));
  }
}

// Checks K-I-6.4. Hardly a turn, and a long way: no line that is far away costs digits.
TEST(InterpolatedPose, IsRegularForTranslations) {
  Random random(11);
  for (const double angle : {0.0, 1e-300, 1e-160, 1e-16, 1e-12, 1e-8}) {
    for (const double way : {1e-160, 1.0, 1e6, 1e150}) {
      const Vector3 u = random.direction(), t = way * random.direction();
      const Pose b{rotation_of_rotation_vector<double>(angle * u), t};
      const auto middle = interpolated<double>({}, b, 0.5).value;
      // The chord is half the way, less a sagitta of angle / 8 of it.
      EXPECT_LE((middle.position - t / 2).norm() / way, angle / 4 + 8 * eps);
      EXPECT_LE((axial(middle.rotation) - angle / 2 * u).norm(), 8 * eps * angle);
      EXPECT_LE(apart(middle * relative_pose(middle, b), b) / std::max(1.0, way), 8 * eps);
      EXPECT_LE((interpolated<double>(Pose{}, b, 1.0).value.position - t).norm() / way, 16 * eps);
    }
  }
  EXPECT_EQ(apart(interpolated<double>(Pose{}, Pose{}, 0.3).value, {}), 0);
}

// Checks K-I-6.4.
TEST(InterpolatedPose, TellsWhereBothWaysAreAsShort) {
  const Vector3 z = Vector3::UnitZ();
  EXPECT_TRUE(interpolated<double>(Pose{}, Pose{rotation_about<double>(z, pi), z}, 0.5).ambiguous);
  EXPECT_FALSE(interpolated<double>(Pose{}, Pose{rotation_about<double>(z, pi - 1e-12), z}, 0.5).ambiguous);
  EXPECT_FALSE(interpolated<double>(Pose{}, Pose{Matrix3::Identity(), z}, 0.5).ambiguous);
}

// Checks K-I-6.4. Another base changes nothing.
TEST(InterpolatedPose, DoesNotDependOnTheBase) {
  Random random(12);
  for (int i = 0; i < 100; ++i) {
    const Pose y = random_pose(random), a = random_pose(random), b = random_pose(random);
    // Half a turn would let rounding choose the way.
    if (quaternion_of_rotation<double>(relative_pose(a, b).rotation)[0] < 1e-6) continue;
    EXPECT_LE(apart(interpolated<double>(y * a, y * b, 0.3).value, y * interpolated(a, b, 0.3).value), 128 * eps);
  }
}

// Checks K-I-6.4. Eight numbers, two conditions; the dual part is half the translation times the real part.
TEST(DualQuaternion, OfAPoseMeetsItsConditions) {
  Random random(13);
  for (int i = 0; i < 1000; ++i) {
    const Pose x = random_pose(random);
    const Vector4T<D> q = dual_quaternion_of_pose(x);
    const D square = q.dot(q);
    EXPECT_NEAR(square.real, 1, 4 * eps);
    EXPECT_NEAR(square.dual, 0, 4 * eps) << "twice q.q'";
    EXPECT_GE(q[0].real, 0);
    EXPECT_LE(apart(pose_of_dual_quaternion(q), x), 16 * eps);
    EXPECT_LE(apart(pose_of_dual_quaternion<double>(-q), x), 16 * eps) << "both signs are one pose";
    Vector4 t;
    t << 0, x.position;
    EXPECT_LE((dual_part(q) - 0.5 * quaternion_product<double>(t, real_part(q))).norm(), 4 * eps);
  }
}

// Checks K-I-6.4. Eight numbers of any size become those of a pose; a dual factor is all that goes.
TEST(DualQuaternion, IsNormalisedByItsDualLength) {
  Random random(14);
  for (const double scale : {1e-160, 1.0, 1e150}) {
    for (int i = 0; i < 100; ++i) {
      const Pose x = random_pose(random);
      const Vector4T<D> q = dual_quaternion_of_pose(x);
      const D factor(scale * random.between(0.5, 2), scale * random.between(-1, 1));
      const auto again = normalised_dual_quaternion<double>(q * factor);
      ASSERT_TRUE(again.has_value());
      EXPECT_LE(greatest(*again - q), 32 * eps);
      EXPECT_NEAR(again->dot(*again).dual, 0, 16 * eps);
    }
  }
  Random other(15);
  const Pose x = random_pose(other);
  EXPECT_LE(apart(pose_of_dual_quaternion<double>(dual_quaternion_of_pose(x) * D(1.5, 0.7)), x), 32 * eps);
  Vector4T<D> pure = Vector4T<D>::Zero();
  EXPECT_FALSE(normalised_dual_quaternion(pure).has_value());
  pure[2] = D(0, 1);
  EXPECT_FALSE(normalised_dual_quaternion(pure).has_value());
}

/// Two motions one on the other, as functions of time.
struct Carried {
  explicit Carried(Random& random) {
    for (auto& v : vectors) v = random.vector();
    for (auto& u : axes) u = random.direction();
  }
  template <typename T>
  PoseT<T> part(int k, const T& t) const {
    const Vector3T<T> a = vectors[k].cast<T>(), b = vectors[k + 1].cast<T>(), c = vectors[k + 2].cast<T>();
    return {rotation_about<T>(axes[k].cast<T>(), t * (T(1) + t)) * rotation_about<T>(axes[k + 1].cast<T>(), sin(t)),
            a + t * b + t * t * c};
  }
  std::array<Vector3, 6> vectors;
  std::array<Vector3, 6> axes;
};

using Time = Dual<D>;

/// Velocity and acceleration of a pose, about the moving origin; exact derivatives.
RelativeMotion motion_of(const PoseT<Time>& x) {
  const Matrix3T<D> r = real_part(x.rotation), r_rate = dual_part(x.rotation);
  const Vector3T<D> omega = axial(r_rate * r.transpose()), v = dual_part(x.position);
  return {
      {real_part(r), real_part(real_part(x.position))}, real_part(omega), real_part(v), dual_part(omega), dual_part(v)};
}

double apart(const RelativeMotion& a, const RelativeMotion& b) {
  return std::max({apart(a.pose, b.pose), (a.angular_velocity - b.angular_velocity).norm(),
                   (a.linear_velocity - b.linear_velocity).norm(),
                   (a.angular_acceleration - b.angular_acceleration).norm(),
                   (a.linear_acceleration - b.linear_acceleration).norm()});
}

// Checks K-I-6.6, K-I-6.5.1, K-I-6.5.2. The velocities are below 4, the accelerations below 30, in rad, m and s; a
// product of three of them is what rounds most.
TEST(DualMotion, ComposesAsTheMotionsDo) {
  Random random(16);
  for (int i = 0; i < 200; ++i) {
    const Carried motion(random);
    const Time t(D(random.between(-1, 1), 1), D(1));
    const PoseT<Time> x_01 = motion.part(0, t), x_12 = motion.part(3, t);
    const RelativeMotion m_01 = motion_of(x_01), m_12 = motion_of(x_12), m_02 = motion_of(x_01 * x_12);
    const DualMotion found = dual_motion(m_01) * dual_motion(m_12);
    constexpr double rounding = 1024 * eps;
    EXPECT_LE(apart(relative_motion_of_dual(found), m_02), rounding) << "the derivatives of the composed pose";
    const DualMotion direct = dual_motion(m_02);
    EXPECT_LE(greatest(found.rotation - direct.rotation), rounding);
    EXPECT_LE(greatest(found.velocity - direct.velocity), rounding);
    EXPECT_LE(greatest(found.acceleration - direct.acceleration), rounding);

    // The composition of K-I-5.2, written out in K_0.
    const Matrix3& r_01 = m_01.pose.rotation;
    const Vector3 &omega = m_01.angular_velocity, &alpha = m_01.angular_acceleration;
    const Vector3 r = r_01 * m_12.pose.position, omega_12 = r_01 * m_12.angular_velocity;
    const Vector3 v_12 = r_01 * m_12.linear_velocity;
    const RelativeMotion by_hand{{r_01 * m_12.pose.rotation, m_01.pose.position + r},
                                 omega + omega_12,
                                 m_01.linear_velocity + v_12 + omega.cross(r),
                                 alpha + r_01 * m_12.angular_acceleration + omega.cross(omega_12),
                                 m_01.linear_acceleration + r_01 * m_12.linear_acceleration + alpha.cross(r) +
                                     2 * omega.cross(v_12) + omega.cross(omega.cross(r))};
    EXPECT_LE(apart(relative_motion_of_dual(found), by_hand), rounding);
  }
}

// Checks K-I-6.6. Both screws of the composed motion, by the formulas with dual vectors alone, are derivatives: that of
// the dual matrix and that of the velocity screw.
TEST(DualMotion, IsMadeOfDerivatives) {
  Random random(17);
  for (int i = 0; i < 100; ++i) {
    const Carried motion(random);
    const Time t(D(random.between(-1, 1), 1), D(1));
    const RelativeMotion m = motion_of(motion.part(0, t));
    const DualMotion d = dual_motion(m);
    // The pose with its first derivative; its dual matrix as pairs real + eps dual, each with a rate.
    const PoseT<Time> x = motion.part(0, t);
    const PoseT<D> x_and_rate{real_part(x.rotation), real_part(x.position)};
    const Matrix3T<Dual<D>> m_and_rate = dual_rotation_of_pose(x_and_rate);
    const DualMatrix value = dual(real_part(real_part(m_and_rate)), real_part(dual_part(m_and_rate)));
    const DualMatrix rate = dual(dual_part(real_part(m_and_rate)), dual_part(dual_part(m_and_rate)));
    EXPECT_LE(greatest(rate - skew(d.velocity) * value), 256 * eps) << "Poisson's equation, on dual numbers";
  }
}

// Checks K-I-6.6. A point that runs outwards on a turntable: Coriolis' acceleration 2 Omega u comes out by itself.
TEST(DualMotion, HasCoriolisAcceleration) {
  const double turn = 3, speed = 2, place = 0.5;
  RelativeMotion table, runner;
  table.angular_velocity = {0, 0, turn};
  runner.pose.position = {place, 0, 0};
  runner.linear_velocity = {speed, 0, 0};
  const RelativeMotion m = relative_motion_of_dual(dual_motion(table) * dual_motion(runner));
  EXPECT_LE((m.linear_acceleration - Vector3(-turn * turn * place, 2 * turn * speed, 0)).norm(), 32 * eps);
  EXPECT_LE((m.linear_velocity - Vector3(speed, turn * place, 0)).norm(), 8 * eps);
  EXPECT_EQ(relative_motion_of_dual(DualMotion{}).linear_acceleration, Vector3::Zero()) << "the default is rest";
}

TEST(Displacement, ExistsInOtherPrecisionsAndWithDerivatives) {
  Random random(18);
  const Known known(random);
  const PoseT<Long> wide{known.pose.rotation.cast<Long>(), known.pose.position.cast<Long>()};
  const auto s = screw_displacement_of_pose<Long>(wide, 1.0L);
  EXPECT_NEAR(static_cast<double>(s.angle), known.angle.real, 16 * eps);
  EXPECT_NEAR(static_cast<double>(s.displacement), known.angle.dual, 64 * eps);
  const auto back = pose_of_dual_quaternion<Long>(dual_quaternion_of_pose<Long>(wide));
  EXPECT_LE(static_cast<double>((back.position - wide.position).norm()), 8 * eps);
  // The angle grows by 2 rad/s about an axis that rests, the advance by 3 m/s.
  const Vector3T<D> u = known.axis.cast<D>(), c = known.point.cast<D>();
  const Matrix3T<D> r = rotation_about<D>(u, D(known.angle.real, 2));
  const auto moving = screw_displacement_of_pose<D>({r, c - r * c + D(known.angle.dual, 3) * u}, D(1));
  EXPECT_NEAR(moving.angle.dual, 2, 256 * eps);
  EXPECT_NEAR(moving.displacement.dual, 3, 256 * eps);
  EXPECT_LE(dual_part(moving.axis.moment).norm(), 512 * eps / std::sin(known.angle.real / 2));
}

}  // namespace
}  // namespace koppel::test

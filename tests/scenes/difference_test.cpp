// Velocities and accelerations of every shipped scene against differences of its positions over time.
//
// Positions at nine times give first and second derivatives by central differences of eighth order. Their error has two
// parts: truncation, seen from what halving the step changes (it falls by 2^8), and rounding, the error of a position
// times the sum of the weights over the step. Both are estimated where they arise; nothing is tuned to a scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "model.hpp"

namespace koppel::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t reach = 4;  // positions on either side
constexpr std::array<double, reach> first_weights{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
constexpr std::array<double, reach> second_weights{8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
// The weight of the centre, less its sign; what it weighs is zero here, but for its error.
constexpr double second_centre = 205.0 / 72;
// Sums of the weights' magnitudes: what an error of 1 in every position does at most.
constexpr double first_sum = 2.0 * (4.0 / 5 + 1.0 / 5 + 4.0 / 105 + 1.0 / 280);
constexpr double second_sum = 2.0 * (8.0 / 5 + 1.0 / 5 + 8.0 / 315 + 1.0 / 560) + second_centre;

constexpr double coarse = 1.0 / 512;  // of the run's duration; the fine step is half of it

/// Where in the run to look. All shipped drives are smooth between the ends of the run.
constexpr std::array fractions{0.06, 0.21, 0.39, 0.52, 0.68, 0.83, 0.94};

/// Rotation vector of a rotation, precise for small ones.
Eigen::Vector3d logarithm(const Eigen::Quaterniond& rotation) {
  const double sine = rotation.vec().norm();
  if (sine == 0.0) return Eigen::Vector3d::Zero();
  const double angle = 2.0 * std::atan2(rotation.w() < 0 ? -sine : sine, std::abs(rotation.w()));
  return angle / sine * rotation.vec();
}

/// How the mechanism stands, as small displacements from a centre: of all joints (the tangents of their coordinates)
/// and of all bodies (in world axes: rotation vector, then position).
///
/// A rotation r(t) away from the centre has r' = angular velocity and r'' = angular acceleration there: the terms of
/// second order in the derivative of the exponential map are r' x r', which vanish.
class Centre {
 public:
  explicit Centre(Motion& motion) : q_(motion.positions()), poses_(motion.poses(KOPPEL_KIND_BODY)) {
    const Model& model = motion.model();
    for (Eigen::Index i = 0; i < q_.size(); ++i) {
      const std::string name = model.name(KOPPEL_KIND_COORDINATE, static_cast<std::size_t>(i));
      const bool quaternion = name.size() > 2 && name.compare(name.size() - 2, 2, ".w") == 0;
      blocks_.push_back(quaternion ? 4 : 1);
      if (quaternion) i += 3;
    }
  }

  VectorXd displacement(Motion& motion) const {
    VectorXd result(motion.velocities().size() + 6 * poses_.cols());
    Eigen::Index at = put_joints(motion.positions(), result);
    const MatrixXd poses = motion.poses(KOPPEL_KIND_BODY);
    for (Eigen::Index body = 0; body < poses.cols(); ++body, at += 6) {
      const Eigen::Matrix3d turned = rotation_of(poses.col(body)) * rotation_of(poses_.col(body)).transpose();
      result.segment<3>(at) = logarithm(Eigen::Quaterniond(turned));
      result.segment<3>(at + 3) = position_of(poses.col(body)) - position_of(poses_.col(body));
    }
    return result;
  }

 private:
  Eigen::Index put_joints(const VectorXd& q, VectorXd& result) const {
    Eigen::Index from = 0, to = 0;
    for (const int size : blocks_) {
      if (size == 1) {
        result[to++] = q[from] - q_[from];
      } else {
        const auto rotation = [from](const VectorXd& c) {
          return Eigen::Quaterniond(c[from], c[from + 1], c[from + 2], c[from + 3]);
        };
        result.segment<3>(to) = logarithm(rotation(q_).conjugate() * rotation(q));
        to += 3;
      }
      from += size;
    }
    return to;
  }

  VectorXd q_;
  MatrixXd poses_;
  std::vector<int> blocks_;  ///< how many numbers each
};

struct Derivatives {
  VectorXd first, second;
  double position_error = 0.0;  ///< [rad], or [m]: of the positions that went in
};

Derivatives differences(const Motion& centre_motion, const Centre& centre, double time, double step) {
  const Model& model = centre_motion.model();
  Derivatives result;
  for (std::size_t k = 1; k <= reach; ++k) {
    std::array<VectorXd, 2> sides;
    for (const double sign : {1.0, -1.0}) {
      Motion motion(centre_motion);
      const Outcome outcome = motion.move(time + sign * static_cast<double>(k) * step);
      EXPECT_TRUE(outcome) << outcome.message;
      sides[sign > 0 ? 0 : 1] = centre.displacement(motion);
      result.position_error = std::max(result.position_error, outcome.report.coordinate_error);
    }
    if (k == 1) {
      result.first = VectorXd::Zero(sides[0].size());
      result.second = result.first;  // the centre's own displacement is zero, and with it its term
    }
    result.first += first_weights[k - 1] / step * (sides[0] - sides[1]);
    result.second += second_weights[k - 1] / (step * step) * (sides[0] + sides[1]);
  }
  // Every joint on the way to a body adds the error of its coordinate; lengths are in units of the scene's length.
  const double joints = model.sizes().joints;
  result.position_error = joints * std::max(1.0, model.settings().length) *
                          (result.position_error + 4.0 * std::numeric_limits<double>::epsilon());
  return result;
}

VectorXd joined(const VectorXd& joints, const MatrixXd& bodies) {
  VectorXd result(joints.size() + bodies.size());
  result << joints, bodies.reshaped();
  return result;
}

/// How much larger than the motion itself an error may be that is still a check of anything.
constexpr double sharp_first = 1e-8, sharp_second = 1e-5;

void expect_near(const VectorXd& given, const VectorXd& fine, const VectorXd& coarse_ones, double rounding,
                 double sharpness, const char* what) {
  const double size = std::max(1.0, given.lpNorm<Eigen::Infinity>());
  // What halving the step changes is the coarse truncation; the fine one is 2^8 times smaller, and 2^4 is allowed for
  // the terms that follow.
  const double truncation = (fine - coarse_ones).lpNorm<Eigen::Infinity>() / 16.0;
  EXPECT_LE(truncation + rounding, sharpness * size) << what << ": the differences are too rough to tell anything";
  EXPECT_LE((given - fine).lpNorm<Eigen::Infinity>(), truncation + rounding) << what;
}

struct Rates : testing::TestWithParam<std::string> {
  const Model model{shipped_scene(GetParam())};

  /// Calls check(motion, time) at several times of the run.
  template <typename Check>
  void along_the_run(const Check& check) {
    Motion motion(model);
    motion.run_to(0);
    std::size_t step = 0;
    for (const double fraction : fractions) {
      const double time = fraction * model.settings().duration;
      while (model.time(step + 1) < time) ASSERT_TRUE(motion.move(model.time(++step)));
      Motion here(motion);
      ASSERT_TRUE(here.move(time));
      SCOPED_TRACE("time " + std::to_string(time));
      check(here, time);
    }
  }
};

TEST_P(Rates, AgreeWithDifferencesOfPositions) {
  along_the_run([this](Motion& motion, double time) {
    const Centre centre(motion);
    const double step = coarse * model.settings().duration;
    const Derivatives rough = differences(motion, centre, time, step);
    const Derivatives fine = differences(motion, centre, time, step / 2.0);
    expect_near(joined(motion.velocities(), motion.twists(KOPPEL_KIND_BODY)), fine.first, rough.first,
                first_sum * 2.0 / step * fine.position_error, sharp_first, "velocities");
    expect_near(joined(motion.accelerations(), motion.frame_accelerations(KOPPEL_KIND_BODY)), fine.second, rough.second,
                second_sum * 4.0 / (step * step) * fine.position_error, sharp_second, "accelerations");
  });
}

TEST_P(Rates, AgreeWithTheJacobians) {
  const double eps = std::numeric_limits<double>::epsilon();
  along_the_run([&](Motion& motion, double /*time*/) {
    const VectorXd v = motion.velocities(), a = motion.accelerations();
    for (const std::int32_t kind : {KOPPEL_KIND_BODY, KOPPEL_KIND_FRAME}) {
      const MatrixXd twists = motion.twists(kind), accelerations = motion.frame_accelerations(kind);
      for (std::size_t i = 0; i < model.count(kind); ++i) {
        const Motion::Jacobian j = motion.jacobian(kind, i);
        const auto column = static_cast<Eigen::Index>(i);
        // Each joint on the way adds its rounding, relative to the largest thing that it adds to.
        const double speeds = j.value.lpNorm<Eigen::Infinity>() * v.lpNorm<Eigen::Infinity>();
        const double changes = j.value.lpNorm<Eigen::Infinity>() * a.lpNorm<Eigen::Infinity>() +
                               j.rate.lpNorm<Eigen::Infinity>() * v.lpNorm<Eigen::Infinity>();
        const double rounding = 8.0 * eps * (1.0 + model.sizes().joints);
        EXPECT_LE((j.value * v - twists.col(column)).lpNorm<Eigen::Infinity>(), rounding * speeds)
            << model.name(kind, i);
        EXPECT_LE((j.value * a + j.rate * v - accelerations.col(column)).lpNorm<Eigen::Infinity>(), rounding * changes)
            << model.name(kind, i);
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Scenes, Rates, testing::ValuesIn(shipped_scenes()),
                         [](const auto& test) { return test_name(test.param); });

}  // namespace
}  // namespace koppel::test

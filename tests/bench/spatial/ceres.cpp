// ceres/rotation.h. Its Euler angles are in degrees, and are left out.
#include <ceres/rotation.h>

#include "batch.hpp"

namespace koppel::bench {
namespace {

using Three = std::array<double, 3>;
using Four = std::array<double, 4>;
using Nine = std::array<double, 9>;

}  // namespace

Library ceres_library() {
  Library library;
  library.add<Nine>("matrix_to_quaternion", [](const auto& r) {
    Four q;
    ceres::RotationMatrixToQuaternion(r.data(), q.data());
    return q;
  });
  library.add<Four>("quaternion_to_matrix", [](const auto& q) {
    Nine r;
    ceres::QuaternionToRotation(q.data(), ceres::ColumnMajorAdapter3x3(r.data()));
    return r;
  });
  library.add<Nine>("matrix_to_rotation_vector", [](const auto& r) {
    Three phi;
    ceres::RotationMatrixToAngleAxis(r.data(), phi.data());
    return phi;
  });
  library.add<Three>("rotation_vector_to_matrix", [](const auto& phi) {
    Nine r;
    ceres::AngleAxisToRotationMatrix(phi.data(), r.data());
    return r;
  });
  library.add<Four>("quaternion_to_rotation_vector", [](const auto& q) {
    Three phi;
    ceres::QuaternionToAngleAxis(q.data(), phi.data());
    return phi;
  });
  library.add<Three>("rotation_vector_to_quaternion", [](const auto& phi) {
    Four q;
    ceres::AngleAxisToQuaternion(phi.data(), q.data());
    return q;
  });
  library.add<Four, Four>("quaternion_product", [](const auto& a, const auto& b) {
    Four q;
    ceres::QuaternionProduct(a.data(), b.data(), q.data());
    return q;
  });
  library.add<Four, Three>("quaternion_times_vector", [](const auto& q, const auto& v) {
    Three turned;
    ceres::UnitQuaternionRotatePoint(q.data(), v.data(), turned.data());
    return turned;
  });
  return library;
}

}  // namespace koppel::bench

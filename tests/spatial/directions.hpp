// Random directions and turns, the same ones in every run.
#pragma once

#include <random>

#include "spatial/rotation.hpp"
#include "spatial/vector.hpp"

namespace koppel::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3 vector() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  double normal() { return normal_(engine_); }
  Vector3 direction() {
    const Vector3 v(normal(), normal(), normal());
    return v.normalized();
  }
  /// Uniform over the group.
  Vector4 quaternion() {
    const Vector4 q(normal(), normal(), normal(), normal());
    return q.normalized();
  }
  Matrix3 rotation() { return rotation_about<double>(direction(), between(-3.1, 3.1)); }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace koppel::test

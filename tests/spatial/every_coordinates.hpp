// All kinds of rotation coordinates, for typed tests.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "spatial/angle_sequence.hpp"
#include "spatial/axis_angle.hpp"
#include "spatial/direction_cosines.hpp"
#include "spatial/euler_parameters.hpp"
#include "spatial/rodrigues_parameters.hpp"
#include "spatial/rotation_vector.hpp"

namespace koppel::test {

using EveryCoordinates =
    testing::Types<DirectionCosines, AxisAngle, RotationVector, EulerParameters, RodriguesParameters,
                   AngleSequence<0, 1, 2>, AngleSequence<0, 2, 1>, AngleSequence<1, 0, 2>, AngleSequence<1, 2, 0>,
                   AngleSequence<2, 0, 1>, AngleSequence<2, 1, 0>, AngleSequence<0, 1, 0>, AngleSequence<0, 2, 0>,
                   AngleSequence<1, 0, 1>, AngleSequence<1, 2, 1>, AngleSequence<2, 0, 2>, AngleSequence<2, 1, 2>>;

template <typename C>
struct NameOf;
template <>
struct NameOf<DirectionCosines> {
  static std::string text() { return "matrix"; }
};
template <>
struct NameOf<AxisAngle> {
  static std::string text() { return "axis_angle"; }
};
template <>
struct NameOf<RotationVector> {
  static std::string text() { return "rotation_vector"; }
};
template <>
struct NameOf<EulerParameters> {
  static std::string text() { return "quaternion"; }
};
template <>
struct NameOf<RodriguesParameters> {
  static std::string text() { return "rodrigues"; }
};
template <int i, int j, int k>
struct NameOf<AngleSequence<i, j, k>> {
  static std::string text() { return std::string{"xyz"[i], "xyz"[j], "xyz"[k]}; }
};

struct NamesOfCoordinates {
  template <typename C>
  static std::string GetName(int) {
    return NameOf<C>::text();
  }
};

}  // namespace koppel::test

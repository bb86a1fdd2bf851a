// Eigen's matrices, and what koppel makes of them, as lists of numbers.
#pragma once

#include "batch.hpp"
#include "spatial/dual.hpp"
#include "spatial/twist.hpp"

namespace koppel::bench {

template <typename T, int rows, int columns>
struct Numbers<Eigen::Matrix<T, rows, columns>> {
  using Matrix = Eigen::Matrix<T, rows, columns>;
  static constexpr auto size = static_cast<std::size_t>(rows) * columns;
  static Matrix read(const double* from) {
    return Eigen::Map<const Eigen::Matrix<double, rows, columns>>(from).template cast<T>();
  }
  static void write(const Matrix& value, T* to) { Eigen::Map<Matrix>{to} = value; }
};

/// Real part, dual part.
template <typename T, int rows, int columns>
struct Numbers<Eigen::Matrix<Dual<T>, rows, columns>> {
  using Part = Numbers<Eigen::Matrix<T, rows, columns>>;
  static constexpr std::size_t size = 2 * Part::size;
  static Eigen::Matrix<Dual<T>, rows, columns> read(const double* from) {
    return dual(Part::read(from), Part::read(from + Part::size));
  }
  static void write(const Eigen::Matrix<Dual<T>, rows, columns>& value, T* to) {
    Part::write(real_part(value), to);
    Part::write(dual_part(value), to + Part::size);
  }
};

template <typename T>
struct Numbers<PoseT<T>> {
  static constexpr std::size_t size = 12;
  static PoseT<T> read(const double* from) {
    return {Numbers<Matrix3T<T>>::read(from), Numbers<Vector3T<T>>::read(from + 9)};
  }
  static void write(const PoseT<T>& value, T* to) {
    Numbers<Matrix3T<T>>::write(value.rotation, to);
    Numbers<Vector3T<T>>::write(value.position, to + 9);
  }
};

template <typename T>
struct Numbers<TwistT<T>> {
  static constexpr std::size_t size = 6;
  static TwistT<T> read(const double* from) {
    return {Numbers<Vector3T<T>>::read(from), Numbers<Vector3T<T>>::read(from + 3)};
  }
  static void write(const TwistT<T>& value, T* to) { Numbers<Vector6T<T>>::write(value.vector(), to); }
};

}  // namespace koppel::bench

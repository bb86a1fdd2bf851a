// Vectors and rotations as plain numbers, for the innermost loops of kinematics and dynamics. Eigen writes a vector of
// three as a pair and a single number and reads it back in other portions, which costs more than the arithmetic;
// these stay in registers.
#pragma once

#include "spatial/types.hpp"

namespace koppel {

struct Plain3 {
  double x = 0.0, y = 0.0, z = 0.0;

  Plain3() = default;
  Plain3(double a, double b, double c) : x(a), y(b), z(c) {}
  explicit Plain3(const Vector3& v) : x(v.x()), y(v.y()), z(v.z()) {}

  void store(Vector3& v) const { v.x() = x, v.y() = y, v.z() = z; }
  Vector3 vector() const { return {x, y, z}; }

  Plain3 operator+(const Plain3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Plain3 operator-(const Plain3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Plain3 operator-() const { return {-x, -y, -z}; }
  friend Plain3 operator*(double f, const Plain3& v) { return {f * v.x, f * v.y, f * v.z}; }
  Plain3& operator+=(const Plain3& o) { return *this = *this + o; }
  Plain3& operator-=(const Plain3& o) { return *this = *this - o; }
  bool operator==(const Plain3& o) const = default;

  double dot(const Plain3& o) const { return x * o.x + y * o.y + z * o.z; }
  Plain3 cross(const Plain3& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  double squared_norm() const { return dot(*this); }
  bool is_zero() const { return x == 0.0 && y == 0.0 && z == 0.0; }
};

/// By columns.
struct PlainMatrix3 {
  Plain3 x, y, z;

  PlainMatrix3() = default;
  PlainMatrix3(const Plain3& a, const Plain3& b, const Plain3& c) : x(a), y(b), z(c) {}
  explicit PlainMatrix3(const Matrix3& m)
      : x(m(0, 0), m(1, 0), m(2, 0)), y(m(0, 1), m(1, 1), m(2, 1)), z(m(0, 2), m(1, 2), m(2, 2)) {}

  void store(Matrix3& m) const {
    m(0, 0) = x.x, m(1, 0) = x.y, m(2, 0) = x.z;
    m(0, 1) = y.x, m(1, 1) = y.y, m(2, 1) = y.z;
    m(0, 2) = z.x, m(1, 2) = z.y, m(2, 2) = z.z;
  }

  Plain3 operator*(const Plain3& v) const { return v.x * x + v.y * y + v.z * z; }
  PlainMatrix3 operator*(const PlainMatrix3& o) const { return {*this * o.x, *this * o.y, *this * o.z}; }
  /// The transpose times a vector.
  Plain3 transposed_times(const Plain3& v) const { return {x.dot(v), y.dot(v), z.dot(v)}; }
};

/// Symmetric: xx, yy, zz and yz, zx, xy.
struct PlainSymmetric3 {
  Plain3 diagonal, off;

  /// Of a matrix, by its lower triangle.
  static PlainSymmetric3 of(const Matrix3& m) { return {{m(0, 0), m(1, 1), m(2, 2)}, {m(2, 1), m(2, 0), m(1, 0)}}; }
  Plain3 operator*(const Plain3& v) const {
    return {diagonal.x * v.x + off.z * v.y + off.y * v.z, off.z * v.x + diagonal.y * v.y + off.x * v.z,
            off.y * v.x + off.x * v.y + diagonal.z * v.z};
  }
  double trace() const { return diagonal.x + diagonal.y + diagonal.z; }
  PlainSymmetric3& operator+=(const PlainSymmetric3& o) {
    diagonal += o.diagonal, off += o.off;
    return *this;
  }
  /// Adds factor a a^T.
  void add_dyad(double factor, const Plain3& a) {
    const Plain3 b = factor * a;
    diagonal += {a.x * b.x, a.y * b.y, a.z * b.z};
    off += {a.y * b.z, a.z * b.x, a.x * b.y};
  }
  /// R S R^T.
  PlainSymmetric3 turned(const PlainMatrix3& r) const {
    // Columns of R S, then their products with rows of R.
    const PlainMatrix3 h{diagonal.x * r.x + off.z * r.y + off.y * r.z, off.z * r.x + diagonal.y * r.y + off.x * r.z,
                         off.y * r.x + off.x * r.y + diagonal.z * r.z};
    return {{h.x.x * r.x.x + h.y.x * r.y.x + h.z.x * r.z.x, h.x.y * r.x.y + h.y.y * r.y.y + h.z.y * r.z.y,
             h.x.z * r.x.z + h.y.z * r.y.z + h.z.z * r.z.z},
            {h.x.y * r.x.z + h.y.y * r.y.z + h.z.y * r.z.z, h.x.z * r.x.x + h.y.z * r.y.x + h.z.z * r.z.x,
             h.x.x * r.x.y + h.y.x * r.y.y + h.z.x * r.z.y}};
  }
};

}  // namespace koppel

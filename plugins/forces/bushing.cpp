// An elastic joint between two frames: linear in the position of the second frame's origin, in the axes of the first,
// and in the rotation vector between the frames. Moments follow from the energy, so that it is conservative at any
// angle below half a turn.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

/// Row by row; rotation first, as in twists and wrenches.
struct Matrix6 {
  double entries[36] = {};

  double& operator()(int i, int j) { return entries[6 * i + j]; }
  double operator()(int i, int j) const { return entries[6 * i + j]; }
  /// out += this * x
  void add_product(const double* x, double* out) const {
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) out[i] += (*this)(i, j) * x[j];
    }
  }
  double form(const double* x) const {
    double product[6] = {}, sum = 0;
    add_product(x, product);
    for (int i = 0; i < 6; ++i) sum += x[i] * product[i];
    return sum;
  }
};

void cross(const double* a, const double* b, double* out) {
  for (int i = 0; i < 3; ++i) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/// By way of the quaternion, w first, whose greatest component is taken from the diagonal (Shepperd).
void rotation_vector(const double* r, double* phi) {
  const double squares[4] = {1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8],
                             1 - r[0] - r[4] + r[8]};
  const double skew[3] = {r[7] - r[5], r[2] - r[6], r[3] - r[1]};
  const double mixed[3] = {r[5] + r[7], r[2] + r[6], r[1] + r[3]};
  const auto greatest = static_cast<int>(std::max_element(squares, squares + 4) - squares);
  double q[4] = {squares[0], skew[0], skew[1], skew[2]};
  if (greatest > 0) {
    const int i = greatest - 1;
    q[0] = skew[i];
    for (int j = 0; j < 3; ++j) q[1 + j] = i == j ? squares[greatest] : mixed[3 - i - j];
  }
  if (q[0] < 0) std::transform(q, q + 4, q, [](double x) { return -x; });
  const double sine = std::hypot(q[1], q[2], q[3]);
  const double factor = sine > 0 ? 2 * std::atan2(sine, q[0]) / sine : 2 / q[0];
  for (int j = 0; j < 3; ++j) phi[j] = factor * q[1 + j];
}

/// (1 - a/2 cot(a/2)) / a^2.
double cotangent_defect(double a) {
  const double s = a * a;
  if (a < 0.1) return 1.0 / 12 + s * (1.0 / 720 + s * (1.0 / 30240 + s / 1209600));
  return (1 - a / 2 / std::tan(a / 2)) / s;
}

/// d(phi)/dt for the angular velocity omega in the turned axes, with sign = 1: the inverse of the right Jacobian. With
/// sign = -1 its transpose, which turns derivatives by phi into moments in the turned axes.
void rate_of_vector(const double* phi, const double* omega, double sign, double* out) {
  double once[3], twice[3];
  cross(phi, omega, once);
  cross(phi, once, twice);
  const double defect = cotangent_defect(std::hypot(phi[0], phi[1], phi[2]));
  for (int i = 0; i < 3; ++i) out[i] = omega[i] + sign * once[i] / 2 + defect * twice[i];
}

struct Bushing {
  Matrix6 stiffness, damping;

  static void strain(const double* pose, double* e) {
    rotation_vector(pose, e);
    std::copy(pose + 9, pose + 12, e + 3);
  }
  static void strain_rate(const double* pose, const double* e, const double* twist, double* rate) {
    rate_of_vector(e, twist, 1, rate);
    for (std::size_t i = 0; i < 3; ++i) {
      rate[3 + i] = pose[3 * i] * twist[3] + pose[3 * i + 1] * twist[4] + pose[3 * i + 2] * twist[5];
    }
  }

  void evaluate(const Standing& at, const Action& out) const {
    double e[6], rate[6], g[6] = {}, moment[3];
    strain(at.pose, e);
    strain_rate(at.pose, e, at.twist, rate);
    stiffness.add_product(e, g);
    damping.add_product(rate, g);
    rate_of_vector(e, g, -1, moment);
    for (int j = 0; j < 3; ++j) {
      out.wrench[j] = -moment[j];
      out.wrench[3 + j] = -(at.pose[j] * g[3] + at.pose[3 + j] * g[4] + at.pose[6 + j] * g[5]);
    }
  }
  double energy(const Standing& at) const {
    double e[6];
    strain(at.pose, e);
    return stiffness.form(e) / 2;
  }
  double dissipation(const Standing& at) const {
    double e[6], rate[6];
    strain(at.pose, e);
    strain_rate(at.pose, e, at.twist, rate);
    return damping.form(rate);
  }
};

constexpr koppel_parameter matrix(const char* name, const char* doc) {
  koppel_parameter p = optional(KOPPEL_PARAMETER_TABLE, name, "", doc, nullptr);
  p.columns = 6;
  return counted(p, 6, 6);
}

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_FRAME, "from", "", "Frame in whose axes it is described"),
    required(KOPPEL_PARAMETER_FRAME, "to", "", "Frame that it holds where the first one is"),
    not_negative(optional(KOPPEL_PARAMETER_VECTOR, "stiffness", "N/m", "Stiffness along each axis", zeros)),
    not_negative(
        optional(KOPPEL_PARAMETER_VECTOR, "rotational_stiffness", "N m/rad", "Stiffness about each axis", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_VECTOR, "damping", "N s/m", "Damping along each axis", zeros)),
    not_negative(
        optional(KOPPEL_PARAMETER_VECTOR, "rotational_damping", "N m s/rad", "Damping about each axis", zeros)),
    matrix("stiffness_matrix", "Or, in SI units: symmetric, from rotation vector and position to moment and force"),
    matrix("damping_matrix", "Or, in SI units: symmetric, from their rates to moment and force"),
};

Matrix6 take(const koppel_value& along, const koppel_value& about, const koppel_value& whole) {
  Matrix6 out;
  if (whole.count > 0) {
    std::copy(whole.reals, whole.reals + 36, out.entries);
    return out;
  }
  for (int i = 0; i < 3; ++i) {
    out(i, i) = about.reals[i];
    out(3 + i, 3 + i) = along.reals[i];
  }
  return out;
}

bool is_symmetric(const Matrix6& m) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      if (m(i, j) != m(j, i)) return false;
    }
  }
  return true;
}

/// By elimination without square roots. What rounding leaves of a pivot that should be zero passes for zero, and then
/// nothing may stand beside it either.
bool is_nowhere_negative(Matrix6 m) {
  const Matrix6 given = m;
  for (int k = 0; k < 6; ++k) {
    const double slack = 1e-12 * given(k, k);
    if (m(k, k) < -slack || given(k, k) < 0) return false;
    for (int i = k + 1; i < 6; ++i) {
      if (m(k, k) <= slack) {
        if (m(i, k) * m(i, k) > 1e-12 * given(k, k) * given(i, i)) return false;
        continue;
      }
      for (int j = k + 1; j < 6; ++j) m(i, j) -= m(i, k) * m(k, j) / m(k, k);
    }
  }
  return true;
}

koppel_status check(const koppel_host* host, const char* name, const koppel_value& along, const koppel_value& about,
                    const koppel_value& whole) {
  if (whole.count == 0) return KOPPEL_OK;
  if (along.given != 0 || about.given != 0) {
    return reject(host, name, "is given beside numbers for single axes", "put all of them into the matrix");
  }
  const Matrix6 matrix = take(along, about, whole);
  if (!is_symmetric(matrix)) {
    return reject(host, name, "is not symmetric", "a force from an energy is; give equal entries on both sides");
  }
  if (is_nowhere_negative(matrix)) return KOPPEL_OK;
  return reject(host, name, "is negative in some direction", "give a positive semidefinite matrix");
}

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  koppel_status status = check(host, "stiffness_matrix", values[2], values[3], values[6]);
  if (status >= 0) status = check(host, "damping_matrix", values[4], values[5], values[7]);
  if (status < 0) return status;
  return keep<Bushing>(instance, [&] {
    return Bushing{take(values[2], values[3], values[6]), take(values[4], values[5], values[7])};
  });
}

constexpr koppel_type described = type<Bushing>("bushing", "Elastic joint of two frames", parameters, create);
constexpr koppel_force_type table = force<Bushing>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

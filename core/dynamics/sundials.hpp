// What SUNDIALS holds for an integrator: its context, vectors, and a dense matrix with its solver.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>

#include <Eigen/Core>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace koppel {

inline Eigen::Map<Eigen::VectorXd> values(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<Eigen::Index>(N_VGetLength(vector))};
}

inline Eigen::Map<Eigen::MatrixXd> values(SUNMatrix matrix) {
  return {SUNDenseMatrix_Data(matrix), static_cast<Eigen::Index>(SUNDenseMatrix_Rows(matrix)),
          static_cast<Eigen::Index>(SUNDenseMatrix_Columns(matrix))};
}

/// Weight of components that are not controlled: SUNDIALS divides by weights.
inline constexpr double no_weight = 1e-100;

struct SundialsVectors {
  SUNContext context = nullptr;
  N_Vector y = nullptr, y_rate = nullptr, scratch = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;

  /// Of n components, zero. Throws std::bad_alloc.
  explicit SundialsVectors(Eigen::Index n) {
    SUNContext_Create(nullptr, &context);
    if (context != nullptr) {
      y = N_VNew_Serial(n, context);
      y_rate = N_VNew_Serial(n, context);
      scratch = N_VNew_Serial(n, context);
      matrix = SUNDenseMatrix(n, n, context);
    }
    if (y != nullptr && y_rate != nullptr && scratch != nullptr && matrix != nullptr) {
      N_VConst(0.0, y);
      N_VConst(0.0, y_rate);
      solver = SUNLinSol_Dense(y, matrix, context);
    }
    if (solver != nullptr) return;
    release();
    throw std::bad_alloc();
  }
  SundialsVectors(const SundialsVectors&) = delete;
  SundialsVectors& operator=(const SundialsVectors&) = delete;
  ~SundialsVectors() { release(); }

 private:
  void release() {
    if (solver != nullptr) SUNLinSolFree(solver);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (scratch != nullptr) N_VDestroy(scratch);
    if (y_rate != nullptr) N_VDestroy(y_rate);
    if (y != nullptr) N_VDestroy(y);
    if (context != nullptr) SUNContext_Free(&context);
  }
};

/// Tries of one step that may fail, by its error or by Newton's method.
inline constexpr int most_failures = 40;

inline void say_nothing(int, const char*, const char*, char*, void*) {}

/// Weights by tolerance and scales, of the first components; none of the others is controlled. SUNDIALS takes the mean
/// over all components, and errors count in the mean over those that are controlled.
inline void set_weights(N_Vector y, const Eigen::VectorXd& scales, double tolerance, N_Vector weights) {
  const auto at = values(y);
  auto out = values(weights);
  out.setConstant(no_weight);
  const auto controlled = std::max<Eigen::Index>(scales.array().isFinite().count(), 1);
  const double share = std::sqrt(static_cast<double>(at.size()) / static_cast<double>(controlled));
  for (Eigen::Index i = 0; i < scales.size(); ++i) {
    if (std::isfinite(scales[i])) out[i] = share / (tolerance * std::max(scales[i], std::abs(at[i])));
  }
}

/// By how much a component is changed for difference quotients.
inline double quotient_step(double at, double scale) {
  return std::sqrt(std::numeric_limits<double>::epsilon()) * std::max(scale, std::abs(at));
}

/// The polynomial of the last step of a method that remembers several, by its derivatives at the end.
struct StepPolynomial {
  static constexpr int highest = 5;
  std::array<Eigen::VectorXd, highest + 1> derivatives;
  double end = 0.0;  ///< [s] where they are taken
  int degree = -1;   ///< -1: not taken yet

  /// derivative(k, vector): of the order k at the end, into the vector. False: there is none.
  template <typename Derivative>
  void take(double time, int order, N_Vector scratch, const Derivative& derivative) {
    degree = -1;
    end = time;
    for (int k = 0; k <= std::min(order, highest) && derivative(k, scratch); ++k) {
      derivatives[static_cast<std::size_t>(k)] = values(scratch);
      degree = k;
    }
  }
  void at(double t, Eigen::VectorXd& y) const {
    y.setZero(derivatives[0].size());
    for (int k = degree; k >= 0; --k) y = derivatives[static_cast<std::size_t>(k)] + (t - end) / (k + 1) * y;
  }
};

}  // namespace koppel

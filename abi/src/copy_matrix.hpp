// Matrices with their errors, to a caller's arrays.
#pragma once

#include "dynamics/derivative.hpp"
#include "koppel/koppel.h"

namespace koppel {

/// Row by row; values and errors hold `count` numbers, errors may be null.
inline koppel_status copy_matrix(const Derivative& from, double* values, double* errors, std::size_t count) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto size = static_cast<std::size_t>(from.value.size());
  if ((values == nullptr && size > 0) || count != size) return KOPPEL_INVALID_ARGUMENT;
  if (size == 0) return KOPPEL_OK;
  Eigen::Map<RowMajor>(values, from.value.rows(), from.value.cols()) = from.value;
  if (errors != nullptr) Eigen::Map<RowMajor>(errors, from.value.rows(), from.value.cols()) = from.error;
  return KOPPEL_OK;
}

}  // namespace koppel

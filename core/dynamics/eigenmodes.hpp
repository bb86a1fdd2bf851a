// Eigenvalues of a matrix with what each may be wrong by.
#pragma once

#include <Eigen/Core>

#include "dynamics/derivative.hpp"

namespace koppel {

struct Eigenmodes {
  Eigen::VectorXcd values;   ///< ascending by size; of a pair that with the positive imaginary part first
  Eigen::MatrixXcd vectors;  ///< columns
  Eigen::VectorXd errors;    ///< of the values, from those of the matrix and of rounding
};

/// Of a real square matrix, balanced before by powers of two.
Eigenmodes eigenmodes(const Derivative& matrix);

}  // namespace koppel

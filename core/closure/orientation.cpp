#include "closure/orientation.hpp"

#include <Eigen/SparseLU>

#include "closure/dense_factorisation.hpp"
#include "closure/factorisation.hpp"

namespace koppel {

void Orientation::remember(const Eigen::SparseMatrix<double>& jacobian) {
  if (columns_ > largest_dense) {
    sparse_before_ = jacobian.leftCols(columns_);
    return;
  }
  before_.resize(jacobian.rows(), columns_);
  spread_columns(jacobian, before_);
}

bool Orientation::is_kept(const Eigen::SparseMatrix<double>& jacobian) {
  if (columns_ > largest_dense) {
    const Eigen::SparseMatrix<double> turned = sparse_before_.transpose() * jacobian.leftCols(columns_);
    Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(turned);
    return factors.info() == Eigen::Success && factors.signDeterminant() > 0.0;
  }
  turned_.setZero(columns_, columns_);
  for (Eigen::Index column = 0; column < columns_; ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(jacobian, column); entry; ++entry) {
      turned_.col(column) += entry.value() * before_.row(entry.row()).transpose();
    }
  }
  factors_.compute(turned_);
  double sign = static_cast<double>(factors_.permutationP().determinant());
  for (Eigen::Index i = 0; i < columns_; ++i) sign = factors_.matrixLU()(i, i) < 0.0 ? -sign : sign;
  return sign > 0.0;
}

}  // namespace koppel

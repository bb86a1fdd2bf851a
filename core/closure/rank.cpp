#include "closure/rank.hpp"

#include "closure/decompositions.hpp"
#include "closure/sparse_factorisation.hpp"

namespace koppel {
namespace {

Rank by_values(const Eigen::VectorXd& values, const Eigen::SparseMatrix<double>& jacobian) {
  Rank result;
  const double threshold = rank_tolerance(jacobian.rows(), jacobian.cols(), values[0]);
  result.rank = (values.array() > threshold).count();
  if (result.rank > 0) {
    result.largest = values[0];
    result.smallest = values[result.rank - 1];
  }
  if (result.rank < values.size()) result.next = values[result.rank];
  return result;
}

/// Every column with the row that it was left out for: what the kept rows say of that row.
Eigen::SparseMatrix<double> stresses_of(Elimination& elimination, const Eigen::SparseMatrix<double>& jacobian) {
  const auto& left_out = elimination.left_out();
  Eigen::SparseMatrix<double> stresses(jacobian.rows(), static_cast<Eigen::Index>(left_out.size()));
  const Eigen::SparseMatrix<double> transposed = jacobian.transpose();
  Eigen::VectorXd multipliers(jacobian.rows());
  for (Eigen::Index k = 0; k < stresses.cols(); ++k) {
    const Eigen::Index row = left_out[static_cast<std::size_t>(k)];
    elimination.solve_transposed(Eigen::VectorXd(-transposed.col(row)), multipliers);
    multipliers[row] = 1.0;
    stresses.col(k) = multipliers.normalized().sparseView();
  }
  return stresses;
}

}  // namespace

Rank rank_of(const Eigen::SparseMatrix<double>& jacobian) {
  if (jacobian.size() == 0) return {};
  if (jacobian.cols() <= largest_dense) {
    return by_values(Eigen::BDCSVD<Eigen::MatrixXd>(Eigen::MatrixXd(jacobian)).singularValues(), jacobian);
  }
  SparseFactorisation factorisation(jacobian.rows(), jacobian.cols());
  factorisation.compute(jacobian);
  const Factorisation::Condition condition = factorisation.condition();
  return {factorisation.rank(), condition.smallest * condition.ratio, condition.smallest,
          factorisation.elimination().remainder()};
}

NullSpaces null_spaces_of(const Eigen::SparseMatrix<double>& jacobian) {
  NullSpaces spaces;
  if (jacobian.size() == 0) {
    spaces.motions = Eigen::MatrixXd::Identity(jacobian.cols(), jacobian.cols());
    spaces.stresses = Eigen::MatrixXd::Identity(jacobian.rows(), jacobian.rows()).sparseView();
    return spaces;
  }
  if (jacobian.cols() <= largest_dense) {
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(jacobian), Eigen::ComputeFullU | Eigen::ComputeFullV);
    spaces.rank = by_values(svd.singularValues(), jacobian).rank;
    spaces.motions = svd.matrixV().rightCols(jacobian.cols() - spaces.rank);
    spaces.stresses = svd.matrixU().rightCols(jacobian.rows() - spaces.rank).sparseView();
    return spaces;
  }
  SparseFactorisation factorisation(jacobian.rows(), jacobian.cols());
  factorisation.compute(jacobian);
  Elimination& elimination = factorisation.elimination();
  Elimination::Transfer transfer(jacobian.cols(), static_cast<Eigen::Index>(elimination.independent().size()));
  elimination.transfer(transfer);
  spaces.rank = factorisation.rank();
  spaces.motions = transfer;
  spaces.stresses = stresses_of(elimination, jacobian);
  return spaces;
}

}  // namespace koppel

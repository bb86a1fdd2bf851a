#include "closure/factorisation.hpp"

#include <algorithm>
#include <limits>

#include "closure/dense_factorisation.hpp"
#include "closure/sparse_factorisation.hpp"

namespace koppel {

double rank_tolerance(Eigen::Index rows, Eigen::Index columns, double largest) {
  return 10.0 * static_cast<double>(std::max(rows, columns)) * std::numeric_limits<double>::epsilon() * largest;
}

std::unique_ptr<Factorisation> Factorisation::of(Eigen::Index rows, Eigen::Index columns) {
  if (columns > largest_dense) return std::make_unique<SparseFactorisation>(rows, columns);
  return std::make_unique<DenseFactorisation>(rows, columns);
}

}  // namespace koppel

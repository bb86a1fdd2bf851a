#include "closure/independent.hpp"

#include <algorithm>
#include <limits>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

bool evaluate(Work& work, const State& state) {
  work.factorised = false;
  if (!work.equations.evaluate(state.q, state.time)) return false;
  work.equations.evaluate_jacobian();
  return true;
}

/// Where the equations stand.
double quality_of(const Work& work, const std::vector<std::uint32_t>& rates) {
  const Mechanism& mechanism = *work.mechanism;
  const Eigen::MatrixXd jacobian = work.equations.jacobian;
  Eigen::MatrixXd others(jacobian.rows(), jacobian.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[static_cast<std::size_t>(i)];
    if (!std::binary_search(rates.begin(), rates.end(), rate)) others.col(count++) = jacobian.col(i);
  }
  if (count == 0) return 1.0;
  if (count > jacobian.rows()) return 0.0;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(others.leftCols(count));
  return svd.singularValues()[count - 1] / svd.singularValues()[0];
}

/// Where the equations stand.
IndependentSet best_set(const Work& work) {
  const Mechanism& mechanism = *work.mechanism;
  const Eigen::MatrixXd jacobian = work.equations.jacobian;
  IndependentSet set;
  Eigen::Index rank = 0;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(jacobian.cols()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  if (jacobian.size() > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
    const auto pivots = qr.matrixQR().diagonal();
    const double least = rank_tolerance(jacobian.rows(), jacobian.cols(), qr.maxPivot());
    while (rank < pivots.size() && std::abs(pivots[rank]) > least) ++rank;
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = qr.colsPermutation().indices()[static_cast<Eigen::Index>(i)];
    }
  }
  for (std::size_t i = static_cast<std::size_t>(rank); i < order.size(); ++i) {
    set.rates.push_back(mechanism.rate_of_column[static_cast<std::size_t>(order[i])]);
  }
  std::sort(set.rates.begin(), set.rates.end());
  set.quality = quality_of(work, set.rates);
  return set;
}

}  // namespace

bool choose_independent(Work& work, const State& state, IndependentSet& set) {
  if (!evaluate(work, state)) return false;
  set = best_set(work);
  return true;
}

bool update_independent(Work& work, const State& state, IndependentSet& set, bool& switched) {
  switched = false;
  if (!evaluate(work, state)) return false;
  if (!set.rates.empty()) set.quality = quality_of(work, set.rates);
  if (!set.rates.empty() && set.quality >= poor_quality) return true;
  IndependentSet best = best_set(work);
  // In a singular position there are more freedoms than beside it: no set is worth a switch there.
  if (!set.rates.empty() && (best.rates.size() != set.rates.size() || best.quality < much_better * set.quality)) {
    return true;
  }
  switched = best.rates != set.rates;
  set = std::move(best);
  return true;
}

}  // namespace koppel

#include "closure/analysis.hpp"

#include <limits>

#include <Eigen/SVD>

namespace koppel {

bool analyse(Work& work, const State& state, Analysis& analysis) {
  const Mechanism& mechanism = *work.mechanism;
  work.factorised = false;
  if (!work.equations.evaluate(state.q, state.time)) return false;
  work.equations.evaluate_jacobian();
  analysis = Analysis{};
  analysis.gap = std::numeric_limits<double>::infinity();
  analysis.mobility_count = mechanism.mobility_count;
  if (work.equations.jacobian.size() > 0) {
    const Eigen::VectorXd values = Eigen::BDCSVD<Eigen::MatrixXd>(work.equations.jacobian).singularValues();
    const double threshold = rank_tolerance(mechanism.rows, mechanism.columns, values[0]);
    const Eigen::Index rank = (values.array() > threshold).count();
    analysis.rank = static_cast<std::uint32_t>(rank);
    analysis.largest_singular_value = values[0];
    if (rank > 0) analysis.last_singular_value = values[rank - 1];
    if (rank > 0 && rank < values.size()) analysis.gap = values[rank - 1] / values[rank];
  }
  analysis.mobility_rank = static_cast<std::int32_t>(mechanism.columns) - static_cast<std::int32_t>(analysis.rank);
  return true;
}

}  // namespace koppel

#include "closure/analysis.hpp"

#include <limits>

#include "closure/rank.hpp"

namespace koppel {

bool analyse(Work& work, const State& state, Analysis& analysis) {
  const Mechanism& mechanism = *work.mechanism;
  work.factorised = false;
  if (!work.equations.evaluate(state.q, state.time)) return false;
  work.equations.evaluate_jacobian();
  analysis = Analysis{};
  analysis.gap = std::numeric_limits<double>::infinity();
  analysis.mobility_count = mechanism.mobility_count;
  const Rank rank = rank_of(work.equations.jacobian);
  analysis.rank = static_cast<std::uint32_t>(rank.rank);
  analysis.largest_singular_value = rank.largest;
  analysis.last_singular_value = rank.smallest;
  if (rank.rank > 0 && rank.next > 0.0) analysis.gap = rank.smallest / rank.next;
  analysis.mobility_rank = static_cast<std::int32_t>(mechanism.columns) - static_cast<std::int32_t>(analysis.rank);
  return true;
}

}  // namespace koppel

// Which coordinates are independent where a mechanism stands: those that determine all others best.
#pragma once

#include <cstdint>
#include <vector>

#include "closure/work.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// A set of rates of the tree, as many as there are freedoms.
struct IndependentSet {
  std::vector<std::uint32_t> rates;  ///< in v, ascending
  /// Smallest over largest singular value of the Jacobian of all other columns, those of the same size left out that
  /// are zero: 0 if the set does not determine them.
  double quality = 0.0;
};

/// Sets with less are left (K-II-3.5.1d), for one that is so many times better.
inline constexpr double poor_quality = 1e-3, much_better = 10.0;

/// The best set by column-pivoted QR at a closed state: its columns are those that are pivoted last. False: a plugin
/// failed.
bool choose_independent(Work& work, const State& state, IndependentSet& set);

/// Keeps the set while it is good, and switches to the best where it is poor and that is much better; an empty set is
/// chosen anew. switched: whether it did. False: a plugin failed.
bool update_independent(Work& work, const State& state, IndependentSet& set, bool& switched);

}  // namespace koppel

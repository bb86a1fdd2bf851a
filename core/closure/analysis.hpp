// Counting freedoms: by Gruebler's formula and by the rank of the Jacobian.
#pragma once

#include <cstdint>

#include "closure/work.hpp"
#include "mechanism/state.hpp"

namespace koppel {

struct Analysis {
  std::int32_t mobility_count = 0;  ///< Gruebler, spatial (K-II-1.3.1)
  std::int32_t mobility_rank = 0;   ///< tree rates minus rank
  std::uint32_t rank = 0;           ///< of the scaled Jacobian of all tree rates
  double largest_singular_value = 0.0;
  double last_singular_value = 0.0;  ///< the smallest that counts
  double gap = 0.0;                  ///< last that counts over first that does not; infinity: none left
};

/// At a closed state, by rank_of(). False: a plugin failed.
bool analyse(Work& work, const State& state, Analysis& analysis);

}  // namespace koppel

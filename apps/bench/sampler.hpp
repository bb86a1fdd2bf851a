// Where the time of a piece of work goes: the stack is looked at many times a second, and each look counts for the part
// of koppel that the innermost function with a part belongs to.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace koppel::app::bench {

/// The parts, as they stand in the document; the last one is whatever belongs to no other.
const std::vector<std::string>& profile_parts();

struct Samples {
  std::vector<std::size_t> counts;  ///< by part
  std::size_t runs = 0;             ///< how often the work was done
  std::string problem;              ///< why there are none
};

/// Does the work again and again for a time [s] in the thread that calls; other threads are not looked at.
Samples sample(const std::function<bool()>& work, double seconds);

}  // namespace koppel::app::bench

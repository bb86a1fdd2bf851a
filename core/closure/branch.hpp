// Which way a motion goes on where branches of it meet.
#pragma once

namespace koppel {

enum class Branch {
  stay,  ///< past a change point the motion goes on as it came
  take   ///< past a change point it takes the other branch
};

}  // namespace koppel

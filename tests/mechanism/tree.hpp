// Random open chains and trees as scene texts: any joints, walked either way, frames at random.
#pragma once

#include <string>

#include "../spatial/directions.hpp"
#include "built.hpp"

namespace koppel::test {

inline std::string number(double x) { return std::to_string(x); }
inline std::string numbered(std::string name, std::size_t i) { return name += std::to_string(i); }

inline std::string random_place(Random& random, const std::string& body) {
  const Vector3 at = random.vector();
  std::string text = "{ on = '" + body + "', at = [" + number(at[0]) + ", " + number(at[1]) + ", " + number(at[2]) +
                     "], rotate = [['x', " + number(random.between(-3, 3)) + "], ['y', " +
                     number(random.between(-3, 3)) + "]] }";
  return text;
}

/// `count` joints of all kinds that have scalar or quaternion coordinates.
inline std::string random_tree(std::size_t count, unsigned seed) {
  Random random(seed);
  const std::vector<JointCase> kinds = all_joints();
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.between(0, 1) * static_cast<double>(n));
  };
  std::string text = "[scene]\nlength = 1\n";
  for (std::size_t i = 1; i <= count; ++i) {
    const JointCase* kind = &kinds[below(kinds.size())];
    while (kind->name == "pointing") kind = &kinds[below(kinds.size())];
    const std::size_t parent = below(i);
    const std::string own = numbered("b", i);
    const std::string other = parent == 0 ? "ground" : numbered("b", parent);
    const bool reversed = random.between(0, 1) < 0.5;
    text += "[[body]]\nname = '" + own + "'\n[[joint]]\nname = '" + numbered("j", i) + "'\n" + kind->text +
            "\ninlet = " + random_place(random, reversed ? own : other) +
            "\noutlet = " + random_place(random, reversed ? other : own) + "\n";
  }
  return text;
}

}  // namespace koppel::test

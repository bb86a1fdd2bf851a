// Bars on the ground whose ends couplers join, each to the next: as many planar loops in a row as one likes.
#pragma once

#include <sstream>
#include <string>

namespace koppel::test {

inline std::string row_of_four_bars(int loops) {
  std::ostringstream text;
  text << "[scene]\nlength = 1\n";
  const auto revolute = [&text](const std::string& name, const std::string& from, const std::string& to, double x,
                                double y) {
    text << "[[joint]]\nname = '" << name << "'\ntype = 'revolute'\nbetween = ['" << from << "', '" << to
         << "']\nat = [" << x << ", " << y << ", 0]\n";
  };
  for (int i = 0; i <= loops; ++i) {
    const std::string n = std::to_string(i), bar = "bar" + n, coupler = "coupler" + n;
    text << "[[body]]\nname = '" << bar << "'\n";
    revolute(bar, "ground", bar, i, 0.0);
    if (i == loops) break;
    text << "[[body]]\nname = '" << coupler << "'\n";
    revolute(coupler, bar, coupler, i, 1.0);
    revolute("end" + n, coupler, "bar" + std::to_string(i + 1), i + 1.0, 1.0);
  }
  return text.str();
}

}  // namespace koppel::test

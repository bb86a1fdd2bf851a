// Shipped scenes with other measures, so that they have limits and change points.
#pragma once

#include <string>

#include "closed.hpp"

namespace koppel::test {

/// The spatial four-bar with a crank of 0.30 m, which turns to and fro.
inline std::string long_crank(const std::string& start, const std::string& rocker, const std::string& slope) {
  return shipped("rstr", {{"crank = 0.10", "crank = 0.30"},
                          {"slope = \"360 deg\"", "start = \"" + start + "\"\nslope = \"" + slope + "\""},
                          {"start = { angle = \"71.8 deg\" }", "start = { angle = \"" + rocker + "\" }"}});
}

/// The planar four-bar with other lengths, and a crank that starts at another angle and takes 4 s for a turn.
inline std::string four_bar(const std::string& crank, const std::string& coupler, const std::string& rocker,
                            const std::string& at, const std::string& rocker_at) {
  return shipped("4bar", {{"crank = 0.12", "crank = " + crank},
                          {"coupler = 0.35", "coupler = " + coupler},
                          {"rocker = 0.25", "rocker = " + rocker},
                          {"start = { angle = \"45 deg\" }", "start = { angle = \"-" + at + "\" }"},
                          {"start = { angle = \"97.5 deg\" }", "start = { angle = \"" + rocker_at + "\" }"},
                          {"slope = \"360 deg\"", "start = \"" + at + "\"\nslope = \"90 deg\""}});
}

inline const std::string parallelogram = four_bar("0.25", "0.40", "0.25", "90 deg", "90 deg");

/// A second parallelogram behind the first, as on the wheels of a locomotive: both become flat together.
inline const std::string two_parallelograms =
    parallelogram +
    "\n[[body]]\nname = 'rod2'\n[[body]]\nname = 'wheel2'\n"
    "[[joint]]\nname = 'pin2'\ntype = 'revolute'\ninlet = { on = 'rocker', at = ['rocker', 0, 0] }\noutlet = 'rod2'\n"
    "start = { angle = '-90 deg' }\n"
    "[[joint]]\nname = 'wheel2'\ntype = 'revolute'\ninlet = { on = 'ground', at = ['2*ground', 0, 0] }\n"
    "outlet = 'wheel2'\nstart = { angle = '90 deg' }\n"
    "[[joint]]\nname = 'end2'\ntype = 'revolute'\ninlet = { on = 'wheel2', at = ['rocker', 0, 0] }\n"
    "outlet = { on = 'rod2', at = ['ground', 0, 0] }\nstart = { angle = '-90 deg' }\n";

/// The slider-crank, its slider driven from 0.3 m.
inline std::string driven_by_slider(const std::string& slope) {
  return shipped("slidercrank",
                 {{"[[drive]]\nof = \"crank.angle\"\ntype = \"ramp\"\nslope = \"360 deg\"",
                   "[[drive]]\nof = \"slider.displacement\"\ntype = \"ramp\"\nstart = 0.3\nslope = " + slope},
                  {"start = { displacement = \"crank + rod\" }\n", ""},
                  {"outlet = \"crank\"\n", "outlet = \"crank\"\nstart = { angle = \"80 deg\" }\n"}});
}

}  // namespace koppel::test

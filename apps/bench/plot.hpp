// Curves on logarithmic axes, as SVG that stands in a page or in a file of its own.
#pragma once

#include <string>
#include <vector>

namespace koppel::app::bench {

struct Dot {
  double x, y;
  double least, greatest;  ///< of y
  bool bound = false;      ///< x is no value but a bound: it lies at or left of it
  std::string note;        ///< what a pointer on it shows
};

struct Line {
  std::string name;
  std::vector<Dot> dots;
  bool joined = true;
};

struct Chart {
  std::string title, across, up;  ///< with units
  std::vector<Line> lines;
  bool rising = false;  ///< x grows to the right; else it falls, so that better stands to the right
};

/// One line of a chart is one group of class "line lN": a page hides it by that name. alone: with the style and the
/// header that a file needs.
std::string draw(const Chart& chart, bool alone);

/// Style sheet of the charts, in a page too.
extern const char* const chart_style;

}  // namespace koppel::app::bench

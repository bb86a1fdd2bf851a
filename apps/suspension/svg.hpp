// A drawing as SVG, readable on light and dark ground, and panels with axes in it.
#pragma once

#include <array>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace koppel::app {

using Point2 = std::array<double, 2>;

/// Collects shapes; coordinates are pixels, y downwards. `style` names one of the classes in svg.cpp.
class Svg {
 public:
  Svg(double width, double height);

  void line(Point2 from, Point2 to, std::string_view style);
  void polyline(const std::vector<Point2>& points, std::string_view style);
  /// Through the points with the given slopes dy/dx, as cubic Bezier curves.
  void curve(const std::vector<Point2>& points, const std::vector<double>& slopes, std::string_view style);
  void dot(Point2 at, double radius, std::string_view style);
  void text(Point2 at, std::string_view text, std::string_view style, double turned = 0.0);
  /// The whole document.
  std::string document() const;

 private:
  std::ostringstream body_;
  double width_, height_;
};

/// A range of values along one axis of a panel. `first` stands left or at the bottom; it may be the greater one.
struct Range {
  double first = 0.0, last = 1.0;
};

/// A rectangle of a drawing with axes, grid, ticks and titles; maps values to pixels.
class Panel {
 public:
  Panel(Point2 corner, Point2 size, Range horizontal, Range vertical)
      : corner_(corner), size_(size), horizontal_(horizontal), vertical_(vertical) {}

  Point2 at(double horizontal, double vertical) const;
  /// Pixels for one unit upwards over pixels for one unit to the right, times a slope.
  double slope(double value) const;
  void axes(Svg& svg, std::string_view title, std::string_view horizontal, std::string_view vertical) const;

 private:
  Point2 corner_, size_;
  Range horizontal_, vertical_;
};

}  // namespace koppel::app

#include "suspension/svg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/markup.hpp"

namespace koppel::app {
namespace {

constexpr std::string_view style_sheet = R"(<style>
text { font-family: sans-serif; font-size: 12px; fill: #222; }
.ground { fill: #fff; }
.heading { font-size: 17px; }
.title { font-size: 14px; text-anchor: middle; }
.number { text-anchor: middle; }
.value { text-anchor: end; }
.grid { stroke: #ddd; stroke-width: 1; }
.frame { stroke: #777; stroke-width: 1; fill: none; }
.zero { stroke: #999; stroke-width: 1; }
.rod, .wheel, .carrier { fill: none; stroke-linecap: round; stroke-linejoin: round; }
.rod { stroke-width: 2.5; }
.wheel { stroke-width: 1.5; }
.carrier { stroke-width: 1; stroke-dasharray: 3 3; }
.curve { stroke: #1f5fa8; stroke-width: 2; fill: none; }
.point { fill: #1f5fa8; }
.down { stroke: #b3541e; } .design { stroke: #222; } .up { stroke: #1f7a4d; }
circle.down { fill: #b3541e; } circle.design { fill: #222; } circle.up { fill: #1f7a4d; }
@media (prefers-color-scheme: dark) {
  text { fill: #ddd; }
  .ground { fill: #181818; }
  .grid { stroke: #333; } .frame { stroke: #888; } .zero { stroke: #666; }
  .curve { stroke: #7db4f0; } .point { fill: #7db4f0; }
  .down { stroke: #f0a070; } .design { stroke: #eee; } .up { stroke: #70d0a0; }
  circle.down { fill: #f0a070; } circle.design { fill: #eee; } circle.up { fill: #70d0a0; }
}
</style>
)";

/// 1, 2 or 5 times a power of ten, so that a range has about five ticks.
double tick_distance(double range) {
  const double rough = range / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double digit = rough / power;
  return power * (digit < 1.5 ? 1.0 : digit < 3.5 ? 2.0 : digit < 7.5 ? 5.0 : 10.0);
}

std::vector<double> ticks(Range range) {
  const auto [low, high] = std::minmax(range.first, range.last);
  const double distance = tick_distance(high - low);
  std::vector<double> out;
  for (double i = std::ceil(low / distance - 1e-9); i * distance <= high + 1e-9 * distance; ++i) {
    out.push_back(i * distance + 0.0);
  }
  return out;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", std::abs(value) < 1e-12 ? 0.0 : value);
  return text.data();
}

double fraction(Range range, double value) { return (value - range.first) / (range.last - range.first); }

}  // namespace

Svg::Svg(double width, double height) : width_(width), height_(height) {
  body_.setf(std::ios::fixed);
  body_.precision(2);
}

void Svg::line(Point2 from, Point2 to, std::string_view style) {
  body_ << "<line class=\"" << style << "\" x1=\"" << from[0] << "\" y1=\"" << from[1] << "\" x2=\"" << to[0]
        << "\" y2=\"" << to[1] << "\"/>\n";
}

void Svg::polyline(const std::vector<Point2>& points, std::string_view style) {
  body_ << "<polyline class=\"" << style << "\" points=\"";
  for (const Point2& point : points) body_ << point[0] << ',' << point[1] << ' ';
  body_ << "\"/>\n";
}

void Svg::curve(const std::vector<Point2>& points, const std::vector<double>& slopes, std::string_view style) {
  body_ << "<path class=\"" << style << "\" d=\"";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [x, y] = points[i];
    if (i == 0) {
      body_ << 'M' << x << ',' << y;
      continue;
    }
    const auto [x0, y0] = points[i - 1];
    const double third = (x - x0) / 3.0;
    body_ << " C" << x0 + third << ',' << y0 + third * slopes[i - 1] << ' ' << x - third << ',' << y - third * slopes[i]
          << ' ' << x << ',' << y;
  }
  body_ << "\"/>\n";
}

void Svg::dot(Point2 at, double radius, std::string_view style) {
  body_ << "<circle class=\"" << style << "\" cx=\"" << at[0] << "\" cy=\"" << at[1] << "\" r=\"" << radius << "\"/>\n";
}

void Svg::text(Point2 at, std::string_view text, std::string_view style, double turned) {
  body_ << "<text class=\"" << style << "\" x=\"" << at[0] << "\" y=\"" << at[1] << '"';
  if (turned != 0.0) body_ << " transform=\"rotate(" << turned << ' ' << at[0] << ' ' << at[1] << ")\"";
  body_ << '>' << escaped(text) << "</text>\n";
}

std::string Svg::document() const {
  std::ostringstream out;
  out << R"(<?xml version="1.0" encoding="UTF-8"?>)"
      << "\n<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width_ << ' ' << height_ << "\" width=\""
      << width_ << "\" height=\"" << height_ << "\">\n"
      << style_sheet << "<rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n"
      << body_.str() << "</svg>\n";
  return out.str();
}

Point2 Panel::at(double horizontal, double vertical) const {
  return {corner_[0] + size_[0] * fraction(horizontal_, horizontal),
          corner_[1] + size_[1] * (1.0 - fraction(vertical_, vertical))};
}

double Panel::slope(double value) const {
  return -value * (size_[1] / (vertical_.last - vertical_.first)) / (size_[0] / (horizontal_.last - horizontal_.first));
}

void Panel::axes(Svg& svg, std::string_view title, std::string_view horizontal, std::string_view vertical) const {
  const double left = corner_[0], top = corner_[1], right = left + size_[0], bottom = top + size_[1];
  for (const double value : ticks(horizontal_)) {
    const double x = at(value, vertical_.first)[0];
    svg.line({x, top}, {x, bottom}, std::abs(value) < 1e-12 ? "zero" : "grid");
    svg.text({x, bottom + 16}, number(value), "number");
  }
  for (const double value : ticks(vertical_)) {
    const double y = at(horizontal_.first, value)[1];
    svg.line({left, y}, {right, y}, std::abs(value) < 1e-12 ? "zero" : "grid");
    svg.text({left - 6, y + 4}, number(value), "value");
  }
  svg.polyline({{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}, "frame");
  const double middle = (left + right) / 2;
  svg.text({middle, top - 8}, title, "title");
  svg.text({middle, bottom + 34}, horizontal, "number");
  svg.text({left - 46, (top + bottom) / 2}, vertical, "number", -90.0);
}

}  // namespace koppel::app

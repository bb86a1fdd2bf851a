#include "bench/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "common/markup.hpp"

namespace koppel::app::bench {

const char* const chart_style = R"(
svg text { font: 12px sans-serif; fill: #333; }
svg .title { font-size: 14px; }
svg .middle { text-anchor: middle; }
svg .end { text-anchor: end; }
svg .ground { fill: #fff; }
svg .grid { stroke: #e4e4e4; }
svg .fine { stroke: #f3f3f3; }
svg .frame { stroke: #888; fill: none; }
svg .line polyline { fill: none; stroke-width: 1.8; }
svg .line path, svg .line circle { stroke-width: 1.5; }
svg .l0 { stroke: #1f5fa8; fill: #1f5fa8; } svg .l1 { stroke: #b3541e; fill: #b3541e; }
svg .l2 { stroke: #1f7a4d; fill: #1f7a4d; } svg .l3 { stroke: #8a3fa0; fill: #8a3fa0; }
svg .l4 { stroke: #967800; fill: #967800; } svg .l5 { stroke: #b02a5b; fill: #b02a5b; }
svg .l6 { stroke: #4a6670; fill: #4a6670; } svg .l7 { stroke: #3d3d3d; fill: #3d3d3d; }
svg .line text { stroke: none; }
@media (prefers-color-scheme: dark) {
  svg text { fill: #ddd; } svg .ground { fill: #181818; } svg .grid { stroke: #383838; } svg .fine { stroke: #262626; }
  svg .l0 { stroke: #7db4f0; fill: #7db4f0; } svg .l1 { stroke: #f0a070; fill: #f0a070; }
  svg .l2 { stroke: #70d0a0; fill: #70d0a0; } svg .l3 { stroke: #d0a0e8; fill: #d0a0e8; }
  svg .l4 { stroke: #e0c860; fill: #e0c860; } svg .l5 { stroke: #f090b4; fill: #f090b4; }
  svg .l6 { stroke: #a8c4cc; fill: #a8c4cc; } svg .l7 { stroke: #cccccc; fill: #cccccc; }
}
)";

namespace {

constexpr double width = 560.0, height = 380.0, left = 74.0, right = 16.0, top = 34.0, bottom = 50.0;

/// Whole decades that hold all values.
struct Decades {
  int first = 0, last = 1;

  template <typename Value>
  static Decades of(const Chart& chart, const Value& value) {
    double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
    for (const Line& line : chart.lines) {
      for (const Dot& dot : line.dots) {
        least = std::min(least, value(dot));
        greatest = std::max(greatest, value(dot));
      }
    }
    if (!(greatest > 0.0)) return {};
    const int low = static_cast<int>(std::floor(std::log10(least) + 1e-9));
    return {low, std::max(low + 1, static_cast<int>(std::ceil(std::log10(greatest) - 1e-9)))};
  }

  double part(double value) const { return (std::log10(value) - first) / (last - first); }
  /// Every how many decades a label fits.
  int labelled(int most) const { return 1 + (last - first) / (most + 1); }
};

class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart),
        across_(Decades::of(chart, [](const Dot& dot) { return dot.x; })),
        up_(Decades::of(chart, [](const Dot& dot) { return dot.y; })) {
    out_.setf(std::ios::fixed);
    out_.precision(1);
  }

  std::string body() {
    axes();
    for (std::size_t i = 0; i < chart_.lines.size(); ++i) line(i);
    return out_.str();
  }

 private:
  double x(double value) const {
    const double part = across_.part(value);
    return left + (width - left - right) * (chart_.rising ? part : 1.0 - part);
  }
  double y(double value) const { return height - bottom - (height - top - bottom) * up_.part(value); }

  void rule(double x1, double y1, double x2, double y2, const char* style) {
    out_ << "<line class=\"" << style << "\" x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2
         << "\"/>\n";
  }
  void text(double at_x, double at_y, const std::string& what, const char* style) {
    out_ << "<text class=\"" << style << "\" x=\"" << at_x << "\" y=\"" << at_y << "\">" << escaped(what)
         << "</text>\n";
  }
  static std::string power(int decade) { return "1e" + std::to_string(decade); }

  void axes() {
    const int every_x = across_.labelled(8), every_y = up_.labelled(8);
    for (int d = across_.first; d <= across_.last; ++d) {
      const double at = x(std::pow(10.0, d));
      rule(at, top, at, height - bottom, "grid");
      if ((d - across_.first) % every_x == 0) text(at, height - bottom + 16, power(d), "middle");
    }
    for (int d = up_.first; d <= up_.last; ++d) {
      const double at = y(std::pow(10.0, d));
      rule(left, at, width - right, at, "grid");
      if ((d - up_.first) % every_y == 0) text(left - 6, at + 4, power(d), "end");
      for (int k = 2; k < 10 && d < up_.last; ++k) {
        const double between = y(k * std::pow(10.0, d));
        rule(left, between, width - right, between, "fine");
      }
    }
    out_ << "<rect class=\"frame\" x=\"" << left << "\" y=\"" << top << "\" width=\"" << width - left - right
         << "\" height=\"" << height - top - bottom << "\"/>\n";
    text(width / 2, 20, chart_.title, "title middle");
    text((left + width - right) / 2, height - 12, chart_.across, "middle");
    out_ << "<text class=\"middle\" transform=\"translate(16 " << (top + height - bottom) / 2 << ") rotate(-90)\">"
         << escaped(chart_.up) << "</text>\n";
  }

  void line(std::size_t index) {
    const Line& line = chart_.lines[index];
    out_ << "<g class=\"line l" << index % 8 << "\" data-line=\"" << index << "\">\n";
    if (line.joined && line.dots.size() > 1) {
      out_ << "<polyline points=\"";
      for (const Dot& dot : line.dots) out_ << x(dot.x) << ',' << y(dot.y) << ' ';
      out_ << "\"/>\n";
    }
    for (const Dot& dot : line.dots) mark(dot);
    out_ << "</g>\n";
  }

  /// A circle, or for a bound an arrow to where the value lies; a bar for the spread.
  void mark(const Dot& dot) {
    const double at_x = x(dot.x), at_y = y(dot.y);
    out_ << "<g class=\"dot\"><title>" << escaped(dot.note) << "</title>";
    if (dot.greatest > dot.least) {
      out_ << "<path d=\"M" << at_x << ' ' << y(std::max(dot.least, std::pow(10.0, up_.first))) << "V"
           << y(std::min(dot.greatest, std::pow(10.0, up_.last))) << "\"/>";
    }
    if (dot.bound) {
      const double forward = chart_.rising ? -8 : 8;
      out_ << "<path d=\"M" << at_x << ' ' << at_y - 4 << "l" << forward << " 4l" << -forward << " 4z\"/>";
    } else {
      out_ << "<circle cx=\"" << at_x << "\" cy=\"" << at_y << "\" r=\"3\"/>";
    }
    out_ << "</g>\n";
  }

  const Chart& chart_;
  Decades across_, up_;
  std::ostringstream out_;
};

/// Names of the lines, below the drawing, for a file of its own; a page has its own, to choose from.
std::string legend(const Chart& chart, double from) {
  std::ostringstream out;
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    const double y = from + 18.0 * static_cast<double>(i);
    out << "<g class=\"line l" << i % 8 << "\"><circle cx=\"" << left << "\" cy=\"" << y << "\" r=\"4\"/><text x=\""
        << left + 12 << "\" y=\"" << y + 4 << "\">" << escaped(chart.lines[i].name) << "</text></g>\n";
  }
  return out.str();
}

}  // namespace

std::string draw(const Chart& chart, bool alone) {
  const double tall = alone ? height + 18.0 * static_cast<double>(chart.lines.size()) + 8.0 : height;
  std::ostringstream out;
  if (alone) out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out << "<svg " << (alone ? "xmlns=\"http://www.w3.org/2000/svg\" " : "") << "viewBox=\"0 0 " << width << ' ' << tall
      << "\" width=\"" << width << "\" height=\"" << tall << "\" role=\"img\">\n";
  if (alone) out << "<style>" << chart_style << "</style>\n";
  out << "<rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n" << Drawing(chart).body();
  if (alone) out << legend(chart, height + 6.0);
  out << "</svg>\n";
  return out.str();
}

}  // namespace koppel::app::bench

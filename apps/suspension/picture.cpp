#include "suspension/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>

#include "suspension/svg.hpp"

namespace koppel::app {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double shown_radius = 0.3;  // [m] of the wheel, where the user gives none

/// A rod as numbers of the frames at its ends.
struct Rod {
  std::size_t inner = 0, outer = 0;
};

struct Skeleton {
  std::vector<Rod> rods;
  std::size_t wheel = 0;
  double radius = shown_radius;
};

Skeleton skeleton_of(const Model& model, const SweepOptions& options) {
  const std::vector<std::string> names = model.names(KOPPEL_KIND_FRAME, model.sizes().frames);
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < names.size(); ++i) index[names[i]] = i;
  Skeleton skeleton;
  skeleton.wheel = index[options.frame];
  if (options.radius > 0.0) skeleton.radius = options.radius;
  constexpr std::string_view inner = "_inner";
  for (const auto& [name, at] : index) {
    if (!name.ends_with(inner)) continue;
    const auto outer = index.find(name.substr(0, name.size() - inner.size()) + "_outer");
    if (outer != index.end()) skeleton.rods.push_back({at, outer->second});
  }
  return skeleton;
}

Point origin(const Row& row, std::size_t frame) {
  const double* pose = row.poses.data() + 12 * frame;
  return {pose[9], pose[10], pose[11]};
}

std::vector<Point> wheel_circle(const Row& row, const Skeleton& skeleton) {
  constexpr int corners = 72;
  const double* pose = row.poses.data() + 12 * skeleton.wheel;
  std::vector<Point> points;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const double x = skeleton.radius * std::cos(angle), z = skeleton.radius * std::sin(angle);
    points.push_back({pose[9] + pose[0] * x + pose[2] * z, pose[10] + pose[3] * x + pose[5] * z,
                      pose[11] + pose[6] * x + pose[8] * z});
  }
  return points;
}

/// Two world axes seen on paper.
struct View {
  std::size_t right, up;
};
constexpr View from_front = {1, 2};
constexpr View from_above = {1, 0};

void draw(Svg& svg, const Panel& panel, View view, const Skeleton& skeleton, const Row& row, const std::string& style) {
  const auto place = [&](const Point& point) { return panel.at(point[view.right], point[view.up]); };
  std::vector<Point2> rim;
  for (const Point& point : wheel_circle(row, skeleton)) rim.push_back(place(point));
  svg.polyline(rim, "wheel " + style);
  const Point2 centre = place(origin(row, skeleton.wheel));
  for (const Rod& rod : skeleton.rods) {
    const Point2 outer = place(origin(row, rod.outer));
    svg.line(outer, centre, "carrier " + style);
    svg.line(place(origin(row, rod.inner)), outer, "rod " + style);
    svg.dot(outer, 3.0, style);
  }
  svg.dot(centre, 4.0, style);
}

/// Least and greatest value of what is drawn along a world axis.
Range extent(const SweepResult& result, const Skeleton& skeleton, std::size_t axis) {
  Range range = {infinity, -infinity};
  const auto take = [&](const Point& point) {
    range.first = std::min(range.first, point[axis]);
    range.last = std::max(range.last, point[axis]);
  };
  for (const Row* row : {&result.rows.front(), &result.rows.back()}) {
    for (const Point& point : wheel_circle(*row, skeleton)) take(point);
    for (const Rod& rod : skeleton.rods) {
      take(origin(*row, rod.inner));
      take(origin(*row, rod.outer));
    }
  }
  return {range.first - 0.04, range.last + 0.04};
}

/// Where the two views stand, one under the other in one scale.
struct Layout {
  Panel front, above;
  double right = 0.0;  ///< edge of both
};

Layout layout_of(const SweepResult& result, const Skeleton& skeleton) {
  constexpr double left = 80.0, top = 80.0, gap = 80.0;
  const Range x = extent(result, skeleton, 0), y = extent(result, skeleton, 1), z = extent(result, skeleton, 2);
  const double scale = std::min(400.0 / (y.last - y.first), 640.0 / (x.last - x.first + z.last - z.first));
  const double width = scale * (y.last - y.first);
  const double front_height = scale * (z.last - z.first), above_height = scale * (x.last - x.first);
  // Forward points down, so that the view lies under the one from the front.
  return {Panel({left, top}, {width, front_height}, y, z),
          Panel({left, top + front_height + gap}, {width, above_height}, y, {x.last, x.first}), left + width};
}

void draw_views(Svg& svg, const Layout& layout, const SweepResult& result, const Skeleton& skeleton) {
  layout.front.axes(svg, "from the front", "y [m], to the left of the car", "z [m]");
  layout.above.axes(svg, "from above", "y [m]", "x [m], forward is down");
  struct Position {
    std::size_t row;
    const char* style;
  };
  for (const Position& position :
       std::array<Position, 3>{{{0, "down"}, {result.rows.size() - 1, "up"}, {result.design, "design"}}}) {
    draw(svg, layout.front, from_front, skeleton, result.rows[position.row], position.style);
    draw(svg, layout.above, from_above, skeleton, result.rows[position.row], position.style);
  }
}

void plot(Svg& svg, Point2 corner, const SweepResult& result, const std::string& name, double Wheel::*angle,
          double Wheel::*rate) {
  Range values = {infinity, -infinity};
  for (const Row& row : result.rows) {
    values.first = std::min(values.first, row.wheel.*angle / degree);
    values.last = std::max(values.last, row.wheel.*angle / degree);
  }
  const double margin = std::max(0.05, 0.08 * (values.last - values.first));
  const double end = 1e3 * result.rows.back().travel;
  const Panel panel(corner, {360, 280}, {-end, end}, {values.first - margin, values.last + margin});
  panel.axes(svg, name + " over travel", "travel [mm], up is positive", name + " [deg]");
  std::vector<Point2> points;
  std::vector<double> slopes;
  for (const Row& row : result.rows) {
    points.push_back(panel.at(1e3 * row.travel, row.wheel.*angle / degree));
    slopes.push_back(panel.slope(row.wheel.*rate / degree / (1e3 * result.speed)));
  }
  svg.curve(points, slopes, "curve");
  for (const Point2& point : points) svg.dot(point, 2.5, "point");
}

void draw_legend(Svg& svg, double left, const SweepResult& result) {
  struct Entry {
    double travel;
    const char* style;
  };
  double x = left;
  for (const Entry& entry : std::array<Entry, 3>{
           {{result.rows.front().travel, "down"}, {0.0, "design"}, {result.rows.back().travel, "up"}}}) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%+.0f mm", 1e3 * entry.travel);
    svg.line({x, 44}, {x + 24, 44}, std::string("rod ") + entry.style);
    svg.text({x + 32, 48}, text.data(), "");
    x += 110.0;
  }
}

}  // namespace

std::string picture(const Model& model, const SweepOptions& options, const SweepResult& result) {
  const Skeleton skeleton = skeleton_of(model, options);
  const Layout layout = layout_of(result, skeleton);
  const double plots = layout.right + 110.0;
  Svg svg(plots + 400.0, 860);
  const std::string title = model.name(KOPPEL_KIND_SCENE, 1);
  svg.text({80, 30}, title.empty() ? model.name(KOPPEL_KIND_SCENE, 0) : title, "heading");
  draw_legend(svg, plots, result);
  draw_views(svg, layout, result, skeleton);
  plot(svg, {plots, 80}, result, "toe", &Wheel::toe, &Wheel::toe_rate);
  plot(svg, {plots, 470}, result, "camber", &Wheel::camber, &Wheel::camber_rate);
  return svg.document();
}

}  // namespace koppel::app

// Points joined by the natural cubic spline: two continuous derivatives, the second zero at both ends, where the curve
// goes on as a straight line.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Spline {
  std::vector<double> x, y;
  std::vector<double> bend;  // second derivatives at the points

  explicit Spline(const koppel_value& points);
  Jet at(double t) const;

 private:
  void solve_bends();
  Jet in_segment(std::size_t k, double t) const;
};

Spline::Spline(const koppel_value& points) {
  for (std::size_t i = 0; i + 1 < points.count; i += 2) {
    x.push_back(points.reals[i]);
    y.push_back(points.reals[i + 1]);
  }
  bend.assign(x.size(), 0.0);
  solve_bends();
}

/// Equal slopes from both sides at each inner point make a tridiagonal system; it is diagonally dominant, so that
/// elimination without pivoting is safe.
void Spline::solve_bends() {
  std::vector<double> diagonal(x.size(), 1.0);
  for (std::size_t k = 1; k + 1 < x.size(); ++k) {
    const double before = x[k] - x[k - 1], after = x[k + 1] - x[k];
    const double jump = (y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before;
    const double factor = k > 1 ? before / diagonal[k - 1] : 0.0;
    diagonal[k] = 2 * (before + after) - factor * before;
    bend[k] = 6 * jump - factor * bend[k - 1];
  }
  for (std::size_t k = x.size() - 1; k-- > 1;) bend[k] = (bend[k] - (x[k + 1] - x[k]) * bend[k + 1]) / diagonal[k];
}

Jet Spline::in_segment(std::size_t k, double t) const {
  const double h = x[k + 1] - x[k];
  const double a = (x[k + 1] - t) / h, b = (t - x[k]) / h;
  const double value =
      a * y[k] + b * y[k + 1] + (a * (a * a - 1) * bend[k] + b * (b * b - 1) * bend[k + 1]) * h * h / 6;
  const double first = (y[k + 1] - y[k]) / h + ((1 - 3 * a * a) * bend[k] + (3 * b * b - 1) * bend[k + 1]) * h / 6;
  return {value, first, a * bend[k] + b * bend[k + 1]};
}

Jet Spline::at(double t) const {
  const double inside = std::clamp(t, x.front(), x.back());
  const auto next = std::upper_bound(x.begin() + 1, x.end() - 1, inside);
  const Jet jet = in_segment(static_cast<std::size_t>(next - x.begin()) - 1, inside);
  if (inside == t) return jet;
  return {jet.value + jet.first * (t - inside), jet.first, 0};
}

constexpr koppel_parameter pairs(koppel_parameter p) {
  p.columns = 2;
  p.count_min = 2;  // count_max 0: as many rows as there are
  return p;
}

constexpr koppel_parameter parameters[] = {
    pairs(required(KOPPEL_PARAMETER_TABLE, "points", "s", "Pairs of time and value, times increasing")),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const koppel_value& points = values[0];
  if (points.count < 4) return reject(host, "points", "has fewer than two points", "give two pairs or more");
  for (std::size_t i = 2; i < points.count; i += 2) {
    if (!(points.reals[i] > points.reals[i - 2])) {
      return reject(host, "points", "times do not increase", "sort the points by time, each time once");
    }
  }
  return keep<Spline>(instance, [&] { return Spline(points); });
}

constexpr koppel_type described = type<Spline>("table", "Points joined by a natural cubic spline", parameters, create);
constexpr koppel_function_type table = function<Spline>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();

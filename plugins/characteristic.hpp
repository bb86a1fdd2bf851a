// A measured characteristic: points joined so that the curve has no corners and nowhere rises or falls where its points
// do not, with its exact integral. Beyond the ends it goes on straight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "standard.hpp"

namespace koppel::plugin {

/// The monotone cubic of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5, 1984). Without points it is zero.
class Characteristic {
 public:
  Characteristic() = default;
  /// Pairs, the first numbers increasing.
  explicit Characteristic(const koppel_value& points);

  double value(double x) const;
  double slope(double x) const;
  /// From 0 to x.
  double integral(double x) const;
  bool empty() const { return x_.empty(); }

 private:
  /// The cubic from point k on, in the distance from it: y + slope d + square d^2 + cube d^3.
  struct Piece {
    double y, slope, square, cube;
  };

  std::vector<double> slopes(const std::vector<double>& y) const;
  std::size_t piece_at(double x) const;
  double integral_from_first(double x) const;

  std::vector<double> x_;
  std::vector<Piece> pieces_;  // one before the first point, one after each
  std::vector<double> areas_;  // from the first point to each
  double at_zero_ = 0.0;       // of the integral from the first point
};

inline Characteristic::Characteristic(const koppel_value& points) {
  std::vector<double> y;
  for (std::size_t i = 0; i + 1 < points.count; i += 2) {
    x_.push_back(points.reals[i]);
    y.push_back(points.reals[i + 1]);
  }
  if (x_.empty()) return;
  const std::vector<double> d = slopes(y);
  pieces_.push_back({y[0], d[0], 0.0, 0.0});
  areas_.push_back(0.0);
  for (std::size_t k = 0; k + 1 < x_.size(); ++k) {
    const double h = x_[k + 1] - x_[k], s = (y[k + 1] - y[k]) / h;
    pieces_.push_back({y[k], d[k], (3 * s - 2 * d[k] - d[k + 1]) / h, (d[k] + d[k + 1] - 2 * s) / (h * h)});
    areas_.push_back(areas_[k] + h * ((y[k] + y[k + 1]) / 2 + h * (d[k] - d[k + 1]) / 12));
  }
  pieces_.push_back({y.back(), d.back(), 0.0, 0.0});
  at_zero_ = integral_from_first(0.0);
}

/// At inner points a harmonic mean of the slopes on both sides, weighted by the distances; zero where they disagree in
/// sign. At the ends the slope of the outermost chord.
inline std::vector<double> Characteristic::slopes(const std::vector<double>& y) const {
  const std::size_t last = x_.size() - 1;
  std::vector<double> d(x_.size(), 0.0);
  if (last == 0) return d;
  d[0] = (y[1] - y[0]) / (x_[1] - x_[0]);
  d[last] = (y[last] - y[last - 1]) / (x_[last] - x_[last - 1]);
  for (std::size_t k = 1; k < last; ++k) {
    const double before = x_[k] - x_[k - 1], after = x_[k + 1] - x_[k];
    const double a = (y[k] - y[k - 1]) / before, b = (y[k + 1] - y[k]) / after;
    const double weight = (before + 2 * after) / (3 * (before + after));
    d[k] = a * b > 0 ? a * b / (weight * b + (1 - weight) * a) : 0.0;
  }
  return d;
}

inline std::size_t Characteristic::piece_at(double x) const {
  return static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin());
}

inline double Characteristic::value(double x) const {
  if (empty()) return 0.0;
  const std::size_t k = piece_at(x);
  const Piece& p = pieces_[k];
  const double d = x - x_[k == 0 ? 0 : k - 1];
  return p.y + d * (p.slope + d * (p.square + d * p.cube));
}

inline double Characteristic::slope(double x) const {
  if (empty()) return 0.0;
  const std::size_t k = piece_at(x);
  const Piece& p = pieces_[k];
  const double d = x - x_[k == 0 ? 0 : k - 1];
  return p.slope + d * (2 * p.square + d * 3 * p.cube);
}

inline double Characteristic::integral_from_first(double x) const {
  const std::size_t k = piece_at(x), from = k == 0 ? 0 : k - 1;
  const Piece& p = pieces_[k];
  const double d = x - x_[from];
  return areas_[from] + d * (p.y + d * (p.slope / 2 + d * (p.square / 3 + d * p.cube / 4)));
}

inline double Characteristic::integral(double x) const { return empty() ? 0.0 : integral_from_first(x) - at_zero_; }

/// The first numbers of pairs increase; else create() shall return what this does.
inline koppel_status check_increasing(const koppel_host* host, const char* parameter, const koppel_value& points) {
  for (std::size_t i = 2; i + 1 < points.count; i += 2) {
    if (points.reals[i] > points.reals[i - 2]) continue;
    return reject(host, parameter, "does not increase in its first column",
                  "sort the rows by their first number, each number once");
  }
  return KOPPEL_OK;
}

}  // namespace koppel::plugin

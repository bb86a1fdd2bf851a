#include "closure/walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

constexpr double largest_step = 0.05, first_step = 0.02, smallest_step = 1e-7;
constexpr double near_singular = 2e-3;  // of the largest singular value: no point of a curve should stand there
constexpr double same_place = 1e-9;     // in the size of an angle
constexpr int most_steps = 4000;

class Walker {
 public:
  Walker(Curve& curve, Branch branch) : curve_(curve), branch_(branch) {}

  /// Ends at a value of the parameter.
  std::optional<double> target;
  /// Or after a length.
  double most = std::numeric_limits<double>::infinity();

  Walk go(const Eigen::VectorXd& q, double parameter, Eigen::VectorXd along);

 private:
  double scaled(double parameter) const { return parameter / curve_.way().scale(); }
  double left_to(const CurvePoint& point) const { return scaled(*target - point.parameter); }
  bool begin(const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along);
  bool step_back();
  void stop_here();
  std::optional<Stretch> next();
  bool go_over(Stretch& stretch, bool leaves_change_point);
  bool end_between(Stretch& stretch, double from, double to);
  bool end_at_length(Stretch& stretch, double from, double to);
  void arrive(CurvePlace place, double distance);

  Curve& curve_;
  Branch branch_;
  Walk walk_;
  CurvePoint here_;
  CurvePoint origin_;
  double step_ = first_step;
  double skip_ = 0.0;  ///< how far before the origin the walk begins
  double gone_ = 0.0;
  std::optional<ChangePoint> leave_;  ///< along `leave_along_`
  Eigen::VectorXd leave_along_;
  bool done_ = false;
  double ended_ = 0.0;  ///< where on the last stretch
};

bool Walker::begin(const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along) {
  if (!curve_.begin(q, parameter, along, here_)) {
    if (!curve_.plugin_failed() && target && here_.motions.cols() == 1) stop_here();
    return false;
  }
  // The parameter's own direction is only a beginning: what follows has a tangent.
  origin_ = here_;
  CurvePoint probe;
  const Eigen::Index before = curve_.rank();
  double probed = first_step;
  while (!curve_.step(here_, probed, probe) && probed > smallest_step && !curve_.plugin_failed()) probed /= 2.0;
  if (curve_.plugin_failed()) return false;
  const bool singular = curve_.rank() > before || here_.weakest < near_singular * here_.largest;
  if (singular) return step_back();
  step_ = probed;
  return true;
}

/// The walk begins where the parameter cannot go on.
void Walker::stop_here() {
  here_.tangent = here_.motions.col(0);
  walk_.passed.push_back({SingularKind::limit, here_, 1});
  walk_.place.point = here_;
  walk_.end = WalkEnd::limit;
}

/// From a singular position no tangent can be told but the one that is known: the walk begins some way before it.
bool Walker::step_back() {
  CurvePoint before;
  // Far enough to be clear of it, and not so far that others come near.
  for (const double far : {0.02, 0.03, 0.045, 0.06, 0.01, 0.005}) {
    if (!curve_.step(origin_, -far, before)) continue;
    if (before.weakest < near_singular * before.largest) continue;
    here_ = before;
    here_.curvature.resize(0);
    skip_ = far;
    gone_ = std::numeric_limits<double>::quiet_NaN();
    step_ = 2.5 * far;
    return true;
  }
  return false;
}

/// The next stretch from here.
std::optional<Stretch> Walker::next() {
  CurvePoint to;
  // Longer steps over what is too near to a singular position, shorter ones where the curve is not clear.
  constexpr std::array stretched = {1.0, 1.5, 2.25, 3.375};
  for (const double longer : stretched) {
    double step = step_ * longer;
    bool good = curve_.step(here_, step, to);
    while (!good && !curve_.plugin_failed() && step > smallest_step) {
      step *= 0.5;
      good = curve_.step(here_, step, to);
    }
    if (!good) return std::nullopt;
    if (here_.motions.cols() != to.motions.cols() && !curve_.look(here_, here_.tangent)) return std::nullopt;
    if (to.weakest < near_singular * to.largest && longer < 2.5) continue;
    const double turned = std::acos(std::min(1.0, here_.tangent.dot(to.tangent)));
    step_ = std::min(largest_step, turned < 0.06 ? 1.5 * step : step);
    return Stretch(curve_, here_, to, step);
  }
  return std::nullopt;
}

void Walker::arrive(CurvePlace place, double distance) {
  ended_ = distance;
  walk_.place = std::move(place);
  walk_.end = WalkEnd::arrived;
  done_ = true;
}

/// Ends between two places of the stretch, if what is asked for lies there. False: it was lost there.
bool Walker::end_between(Stretch& stretch, double from, double to) {
  if (!target) return end_at_length(stretch, from, to);
  CurvePlace place;
  const auto left = [&](double x) {
    return stretch.at(x, place) ? left_to(place.point) : std::numeric_limits<double>::quiet_NaN();
  };
  const double at_from = left(from), at_to = left(to);
  if (std::isnan(at_from) || std::isnan(at_to)) return false;
  if (at_to != 0.0 && (at_from == 0.0 || (at_from < 0.0) == (at_to < 0.0))) return true;
  const double x = root_between(left, from, at_from, to, at_to);
  if (std::isnan(x) || !stretch.at(x, place)) return false;
  arrive(std::move(place), x);
  return true;
}

bool Walker::end_at_length(Stretch& stretch, double from, double to) {
  const double start = stretch.arc(from), whole = stretch.arc(to) - start;
  if (std::isnan(whole)) return false;
  if (gone_ + whole < most) {
    gone_ += whole;
    return true;
  }
  const double wanted = most - gone_ + start;
  double x = from + (to - from) * (most - gone_) / whole;
  CurvePlace place;
  for (int i = 0; i < 4; ++i) {
    const double arc = stretch.arc(x);
    if (std::isnan(arc) || !stretch.at(x, place)) return false;
    x += (wanted - arc) * stretch.a().tangent.dot(place.point.tangent);
  }
  if (!stretch.at(x, place)) return false;
  gone_ = most;
  arrive(std::move(place), x);
  return true;
}

/// Goes over a stretch, its singular positions in order. False: lost.
bool Walker::go_over(Stretch& stretch, bool leaves_change_point) {
  const std::optional<ChangePoint> change = leaves_change_point ? std::nullopt : stretch.find_change_point();
  const std::optional<double> limit = stretch.find_limit();
  double from = 0.0;
  if (skip_ > 0.0) {
    // The origin is the place whose offset along the tangent was stepped back.
    from = stretch.a().tangent.dot(curve_.offset(stretch.a(), origin_.q, origin_.parameter));
    if (from > stretch.length()) {
      here_ = stretch.b();
      return true;
    }
    skip_ = 0.0;
    gone_ = 0.0;
  }
  const double after_origin = from > 0.0 ? from + same_place : 0.0;
  bool limit_first = limit && (!change || *limit < change->at);
  for (int i = 0; i < 2 && !done_; ++i, limit_first = !limit_first) {
    if (limit_first && limit && *limit > after_origin) {
      if (!end_between(stretch, from, *limit)) return false;
      if (done_) return true;
      CurvePlace place;
      if (!stretch.at(*limit, place)) return false;
      walk_.passed.push_back({SingularKind::limit, place.point, 1});
      if (target) {
        walk_.end = WalkEnd::limit;
        walk_.place = std::move(place);
        done_ = true;
        return true;
      }
      from = *limit;
    } else if (!limit_first && change && change->at > after_origin) {
      if (!end_between(stretch, from, change->at)) return false;
      const bool at_end = done_ && std::abs(ended_ - change->at) <= same_place;
      if (done_ && !at_end) return true;
      walk_.passed.push_back({SingularKind::change_point, change->point, change->branches.size()});
      from = change->at;
      if (branch_ == Branch::take && change->branches.size() > 1) {
        leave_ = change;
        leave_along_ = change->branches[1];
        if (done_) walk_.place.point.tangent = leave_along_;
        return true;
      }
    }
  }
  if (!done_ && !end_between(stretch, from, stretch.length())) return false;
  here_ = stretch.b();
  return true;
}

Walk Walker::go(const Eigen::VectorXd& q, double parameter, Eigen::VectorXd along) {
  const Eigen::Index last = curve_.unknowns();
  if (along.size() == 0) along = Eigen::VectorXd::Unit(last + 1, last) * (target && *target < parameter ? -1.0 : 1.0);
  if (begin(q, parameter, along)) {
    for (int i = 0; i < most_steps && !done_; ++i) {
      const std::optional<ChangePoint> leave = std::exchange(leave_, std::nullopt);
      const bool leaves = leave.has_value();
      std::optional<Stretch> stretch = leaves ? Stretch::on_branch(curve_, *leave, leave_along_) : next();
      if (!stretch) break;
      if (!leaves) stretch->find_change_point();
      if (stretch->hopped()) {
        // Two branches pass by each other: only in shorter steps can they be told apart.
        step_ = stretch->length() / 4.0;
        if (step_ < smallest_step) break;
        continue;
      }
      if (!go_over(*stretch, leaves)) break;
    }
  }
  if (curve_.plugin_failed()) walk_.end = WalkEnd::plugin_failed;
  walk_.length = gone_;
  return std::move(walk_);
}

}  // namespace

Walk walk_to(Curve& curve, const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along, double target,
             Branch branch) {
  Walker walker(curve, branch);
  walker.target = target;
  return walker.go(q, parameter, along);
}

Walk walk_by(Curve& curve, const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along, double length,
             Branch branch) {
  Walker walker(curve, branch);
  walker.most = length;
  return walker.go(q, parameter, along);
}

std::size_t stopped_input(Curve& curve, const CurvePoint& limit) {
  const Mechanism& m = curve.mechanism();
  Eigen::VectorXd q = limit.q;
  if (m.inputs.empty() || !curve.linearise(q, limit.parameter)) return 0;
  // At a limit the unknowns can move alone; what stretches then is the left null vector, against the parameter.
  const Eigen::MatrixXd unknown = curve.extended().leftCols(curve.unknowns());
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(unknown, Eigen::ComputeFullU);
  const Eigen::MatrixXd stresses = svd.matrixU().rightCols(unknown.rows() - (curve.rank() - 1));
  const Eigen::VectorXd against = stresses * (stresses.transpose() * curve.extended().col(curve.unknowns()));
  std::size_t result = 0;
  double greatest = -1.0;
  for (std::size_t i = 0; i < m.inputs.size(); ++i) {
    const std::uint32_t rate = m.inputs[i].v;
    const auto column = curve.work().equations.jacobian.col(m.column_of_rate[rate]);
    const double speed = curve.way().rate()[static_cast<Eigen::Index>(i)] / m.rate_scale[rate];
    const double part = std::abs(speed * column.dot(against));
    if (part > greatest) {
      greatest = part;
      result = i;
    }
  }
  return result;
}

}  // namespace koppel

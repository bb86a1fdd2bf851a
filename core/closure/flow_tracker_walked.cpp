// The steps of a FlowTracker whose conditions many coordinates enter: they are walked along. One unknown, or a block of
// as many conditions as unknowns that is solved together by Newton's method; with rates and accelerations.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "closure/flow_tracker.hpp"
#include "spatial/quaternion.hpp"
#include "spatial/rotation_vector.hpp"

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int most_iterations = 8;
constexpr double largest_move = 0.35;    // from the start values, in radians or lengths
constexpr double least_slope = 0.03;     // of a condition over its size
constexpr double all_but_solved = 1e-8;  // a correction whose square, times what bends, is rounding
// Where other branches cannot be near: as Closing has it.
constexpr double surely_nearest = 0.25;
constexpr double well_conditioned = 1e3;

}  // namespace

/// A condition whose ways are placed. unknown(variable, rate, by): takes over the derivative by an unknown, per rad
/// or m; false: it is none.
template <typename Unknown>
FlowTracker::Linear FlowTracker::linearise(const Row& row, const Unknown& unknown) {
  const double over_size = 1.0 / size_of(row.condition, length_);
  Linear at;
  for (const bool upper : {false, true}) {
    const TrackedWay& way = upper ? row.upper : row.lower;
    const double sign = upper ? -over_size : over_size;
    if (way.pieces.empty()) {
      at.open += sign * row.rigid[upper];
      continue;
    }
    at.open += sign * value(row.condition, way.end);
    ConditionSlope<double> slope = koppel::slope(row.condition, way.end);
    slope.angular *= sign;
    slope.linear *= sign;
    linearise(way, slope, unknown, at);
  }
  constexpr double roundings = 8.0;
  at.uncertain += roundings * eps;
  return at;
}

/// What the pieces of one way do; slope: of the condition at its end. Of what is uncertain the greatest part counts:
/// errors have common causes.
template <typename Unknown>
void FlowTracker::linearise(const TrackedWay& way, const ConditionSlope<double>& slope, const Unknown& unknown,
                            Linear& at) const {
  for (std::size_t i = 0; i < way.pieces.size(); ++i) {
    const Piece& piece = way.pieces[i];
    const Matrix3& axes = way.frames[i].rotation;
    const double sign = piece.inverse ? -1.0 : 1.0;
    // Of turning about the piece's own point.
    const Vector3 moment = slope.angular + (way.end.position - way.frames[i].position).cross(slope.linear);
    if (piece.kind == Piece::Kind::run) {
      const Run& run = places_.runs[piece.index];
      const ConditionSlope<double> local{sign * (axes.transpose() * moment), sign * (axes.transpose() * slope.linear)};
      // A block's own runs are given to the steps behind it: the first variable tells for all.
      if (run.unknown && unknown(run.screws.front().variable, 0, 0.0)) {
        for (const RunScrew& screw : run.screws) {
          unknown(screw.variable, screw.rate, local.along(screw.twist.angular, screw.twist.linear));
        }
        continue;
      }
      at.given += local.along(run.motion.twist.angular, run.motion.twist.linear);
      const Vector3 about_end = local.angular - run.way.end.position.cross(local.linear);
      at.uncertain = std::max({at.uncertain, about_end.norm() * run.turn_error, local.linear.norm() * run.shift_error});
      continue;
    }
    const MovingPlace& place = places_.variables[piece.index];
    if (piece.kind == Piece::Kind::ball) {
      const Vector3 by = sign * (axes.transpose() * moment);
      if (unknown(piece.index, 0, by[0])) {
        unknown(piece.index, 1, by[1]);
        unknown(piece.index, 2, by[2]);
        continue;
      }
      at.given += by.dot(place.rate);
      at.uncertain = std::max(at.uncertain, by.lpNorm<1>() * errors_[piece.index]);
      continue;
    }
    const double by = axes.col(2).dot(piece.kind == Piece::Kind::turn ? moment : slope.linear);
    if (unknown(piece.index, 0, by)) continue;
    at.given += by * place.rate[0];
    at.uncertain = std::max(at.uncertain, std::abs(by) * errors_[piece.index]);
  }
}

/// The condition's slope in a variable where that is placed, per rad or m.
double FlowTracker::walked_slope(Row& row, std::uint32_t variable) const {
  const auto of_way = [&](TrackedWay& way) {
    if (way.pieces.empty()) return 0.0;
    places_.place(way);
    const Twist by = screw(way, variable);
    return change(row.condition, way.end, by.angular, velocity_at(by, way.end.position));
  };
  return (of_way(row.lower) - of_way(row.upper)) / size_of(row.condition, length_);
}

bool FlowTracker::solve_walk(Row& row, std::uint32_t x, double& slope) {
  const bool harmonic = row.condition.type != ClosureType::point_line || variables_[x].kind == VariableKind::slide;
  if (!(harmonic ? solve_harmonic(row, x) : solve_by_slopes(row, x))) return false;
  const double unit = this->unit(x);
  slope = 0.0;
  for (TrackedWay* way : {&row.lower, &row.upper}) places_.place_again(*way, x);
  const Linear at = linearise(row, [&](std::uint32_t variable, std::uint8_t, double by) {
    if (variable == x) slope += unit * by;
    return variable == x;
  });
  if (!(std::abs(slope) > least_slope)) return false;
  place(x, (*q_)[variables_[x].q] - unit * at.open / slope);  // what rounding has left
  const double v = -unit * at.given / slope;
  set_motion(x, v, 0.0);
  set_motion(x, v, -unit * bending(row) / slope);
  accuracy_.residual = std::max(accuracy_.residual, std::abs(at.open));
  accuracy_.condition = std::max(accuracy_.condition, 1.0 / std::abs(slope));
  take_error(x, at.uncertain / std::abs(slope));
  return true;
}

/// A condition is a harmonic of a turn, or a parabola of a slide: value, slope and second derivative tell all of it.
bool FlowTracker::solve_harmonic(Row& row, std::uint32_t x) {
  std::array<double, 3> f{};
  for (const bool upper : {false, true}) {
    const double over_size = (upper ? -1.0 : 1.0) / size_of(row.condition, length_);
    TrackedWay& way = upper ? row.upper : row.lower;
    if (way.pieces.empty()) {
      f[0] += over_size * row.rigid[upper];
      continue;
    }
    places_.place(way);
    const Twist by = screw(way, x);
    const ConditionSlope<double> slope = koppel::slope(row.condition, way.end);
    const Vector3 linear = velocity_at(by, way.end.position);
    f[0] += over_size * value(row.condition, way.end);
    f[1] += over_size * slope.along(by.angular, linear);
    f[2] += over_size *
            (slope.linear.dot(by.angular.cross(linear)) + quadratic_change(row.condition, way.end, by.angular, linear));
  }
  LastVariable form;
  if (variables_[x].kind == VariableKind::turn) {
    const auto [cosine, sine] = bases_[x].value;
    form.value = {f[0] + f[2], -f[2] * cosine - f[1] * sine, -f[2] * sine + f[1] * cosine};
    return solve_turn(form, x);
  }
  const double start = (*q_)[variables_[x].q], half = 0.5 * f[2];
  form.value = {f[0] - start * (f[1] - start * half), f[1] - 2.0 * half * start, half};
  return solve_slide(form, x);
}

/// Newton's method; as long as the slope hardly changes, the start belongs to this root.
bool FlowTracker::solve_by_slopes(Row& row, std::uint32_t x) {
  const double unit = this->unit(x), size = size_of(row.condition, length_);
  double first_slope = 0.0, moved = 0.0, last = 1.0;
  for (int i = 0; i < most_iterations; ++i) {
    const double slope = unit * walked_slope(row, x);
    const auto value_of = [&](const TrackedWay& way, double rigid) {
      return way.pieces.empty() ? rigid : value(row.condition, way.end);
    };
    const double open = (value_of(row.lower, row.rigid[0]) - value_of(row.upper, row.rigid[1])) / size;
    if (i == 0) first_slope = slope;
    if (!(std::abs(slope) > least_slope) || std::abs(slope - first_slope) > surely_nearest * std::abs(first_slope)) {
      return false;
    }
    const double change = -open / slope;
    if (std::abs(change) <= 2.0 * eps || (i > 1 && std::abs(change) > 0.5 * last)) break;
    last = std::abs(change);
    moved += last;
    if (!(moved <= largest_move)) return false;
    place(x, (*q_)[variables_[x].q] + unit * change);
  }
  return true;
}

/// Of all conditions of a block by its unknowns, in radians or lengths.
void FlowTracker::linearise(Step& step, BlockMatrix& jacobian, BlockLinear& at) {
  jacobian.setZero();
  for (Eigen::Index k = 0; k < step.size; ++k) {
    Row& row = step.rows[static_cast<std::size_t>(k)];
    places_.place(row.lower);
    places_.place(row.upper);
    const Linear linear = linearise(row, [&](std::uint32_t x, std::uint8_t rate, double by) {
      const int column = step.column[x];
      if (column >= 0) jacobian(k, column + rate) += unit(x) * by;
      return column >= 0;
    });
    at.open[k] = linear.open;
    at.given[k] = linear.given;
    at.uncertain[k] = linear.uncertain;
  }
}

void FlowTracker::shift_block(const Step& step, const BlockVector& by) {
  for (const std::uint32_t x : step.unknowns) {
    const Eigen::Index column = step.column[x];
    if (variables_[x].kind != VariableKind::ball) {
      place(x, (*q_)[variables_[x].q] + unit(x) * by[column]);
      continue;
    }
    const Vector4 turn = quaternion_of_rotation_vector<double>(Vector3(by.segment<3>(column)));
    place_ball(x, quaternion_product<double>(q_->segment<4>(variables_[x].q), turn).normalized());
  }
  place_runs(step);
}

/// Those that the block's own unknowns make.
void FlowTracker::place_runs(const Step& step) {
  for (const std::uint32_t i : step.runs) {
    if (places_.runs[i].unknown) places_.place(places_.runs[i]);
  }
}

void FlowTracker::set_block_motion(const Step& step, const BlockVector& v, const BlockVector& a) {
  for (const std::uint32_t x : step.unknowns) {
    const Eigen::Index column = step.column[x];
    if (variables_[x].kind == VariableKind::ball) {
      set_ball_motion(x, v.segment<3>(column), a.segment<3>(column));
    } else {
      set_motion(x, unit(x) * v[column], unit(x) * a[column]);
    }
  }
  for (const std::uint32_t i : step.runs) {
    if (places_.runs[i].unknown) places_.move(places_.runs[i]);
  }
}

/// The second time derivative of a condition whose ways are placed, by the motions as they are set.
double FlowTracker::bending(const Row& row) {
  const auto of_way = [&](const TrackedWay& way) {
    if (way.pieces.empty()) return 0.0;
    const WayMotion motion = places_.motion(way);
    const Vector3& p = way.end.position;
    return change(row.condition, way.end, motion.rate.angular, motion.acceleration(p)) +
           quadratic_change(row.condition, way.end, motion.twist.angular, motion.velocity(p));
  };
  return (of_way(row.lower) - of_way(row.upper)) / size_of(row.condition, length_);
}

bool FlowTracker::solve_block(Step& step, std::int8_t side) {
  BlockMatrix jacobian(step.size, step.size);
  BlockLinear at(step.size);
  BlockVector change(step.size);
  Eigen::PartialPivLU<BlockMatrix> factors(step.size);
  for (const std::uint32_t x : step.unknowns) {
    if (variables_[x].kind == VariableKind::ball) {
      place_ball(x, q_->segment<4>(variables_[x].q));
    } else {
      place(x, (*q_)[variables_[x].q]);
    }
  }
  place_runs(step);
  double moved = 0.0, last = 1.0;
  for (int i = 0;; ++i) {
    linearise(step, jacobian, at);
    factors.compute(jacobian);
    if (last <= all_but_solved) break;
    change = factors.solve(-at.open);
    last = change.lpNorm<Eigen::Infinity>();
    moved += last;
    if (!(moved <= largest_move) || i == most_iterations) return false;
    shift_block(step, change);
  }
  const BlockMatrix inverse = factors.inverse();
  const double stretch = inverse.norm(), condition = jacobian.norm() * stretch;
  if (!(condition <= well_conditioned && moved * stretch <= surely_nearest)) return false;
  if ((factors.determinant() < 0.0) != (side < 0)) return false;
  accuracy_.residual = std::max(accuracy_.residual, at.open.lpNorm<Eigen::Infinity>());
  accuracy_.condition = std::max(accuracy_.condition, condition);
  shift_block(step, -(inverse * at.open));  // what rounding has left

  const BlockVector v = -(inverse * at.given);
  set_block_motion(step, v, BlockVector::Zero(step.size));
  for (Eigen::Index k = 0; k < step.size; ++k) at.open[k] = bending(step.rows[static_cast<std::size_t>(k)]);
  set_block_motion(step, v, -(inverse * at.open));
  for (const std::uint32_t x : step.unknowns) {
    double error = 0.0;
    for (Eigen::Index i = 0; i < freedoms_of(variables_[x].kind); ++i) {
      error = std::max(error, inverse.row(step.column[x] + i).cwiseAbs().dot(at.uncertain));
    }
    take_error(x, error);
  }
  return true;
}

}  // namespace koppel

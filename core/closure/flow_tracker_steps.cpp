// The steps of a FlowTracker.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "closure/flow_tracker.hpp"
#include "spatial/quaternion.hpp"

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double largest_move = 0.35;  // from the start value, in radians or lengths: more is not followed blindly
constexpr double least_slope = 0.03;   // of a condition over its amplitude: nearer to a limit position others take over
constexpr double nearest_part =
    0.25;  // of the way to the other solution: what is further from the start is not certain
constexpr int most_iterations = 8;

double slope_in(const LastVariable& form, const CoordinateBasis& basis) {
  return form.value[1] * basis.slope[0] + form.value[2] * basis.slope[1];
}

}  // namespace

/// What an unknown may be off by: rounding in the condition, and the errors of what it was computed from.
double FlowTracker::error_through(const ProductForm& form, std::uint32_t unknown, double slope) const {
  double sum = 4.0 * eps * form.size();
  for (std::size_t i = 0; i < form.variables().size(); ++i) {
    const std::uint32_t v = form.variables()[i];
    if (v == unknown || errors_[v] == 0.0) continue;
    sum += std::abs(form.by(i, bases_)) * errors_[v];
  }
  return sum / std::abs(slope);
}

/// The condition's slope in a variable where that is placed, in radians or lengths.
double FlowTracker::slope(Row& row, std::uint32_t variable) {
  if (row.form) return unit(variable) * slope_in(row.form->last(bases_), bases_[variable]);
  return unit(variable) * walked_slope(row, variable);
}

/// Of several conditions that agree the one that is steepest where its unknown is placed.
std::size_t FlowTracker::steepest(Step& step) {
  std::size_t best = 0;
  double greatest = -1.0;
  for (std::size_t k = 0; k < step.rows.size() && step.rows.size() > 1; ++k) {
    const double size = std::abs(slope(step.rows[k], step.unknowns[0]));
    if (size <= greatest) continue;
    greatest = size;
    best = k;
  }
  return best;
}

std::int8_t FlowTracker::side_of(Step& step) {
  const auto coded = [](double x, std::size_t row) {
    const auto number = static_cast<std::int8_t>(row + 1);
    return x < 0.0 ? static_cast<std::int8_t>(-number) : number;
  };
  switch (step.kind) {
    case StepKind::one_unknown: {
      const std::size_t row = steepest(step);
      return coded(slope(step.rows[row], step.unknowns[0]), row);
    }
    case StepKind::two_unknowns: return coded(jacobian_of(step).determinant(), 0);
    case StepKind::numerical: {
      BlockMatrix jacobian(step.size, step.size);
      BlockLinear at(step.size);
      linearise(step, jacobian, at);
      return coded(Eigen::PartialPivLU<BlockMatrix>(jacobian).determinant(), 0);
    }
    case StepKind::joint:
    case StepKind::spin: break;
  }
  return 1;
}

bool FlowTracker::solve_one(Step& step, std::int8_t side) {
  const std::uint32_t x = step.unknowns[0];
  place(x, (*q_)[variables_[x].q]);
  // The one that was steepest when the motion came here: another would have sides of its own.
  Row& best = step.rows[static_cast<std::size_t>(std::abs(side)) - 1];
  errors_[x] = 0.0;
  double slope_here = 0.0;
  if (!(best.form ? solve_form(best, x, slope_here) : solve_walk(best, x, slope_here))) return false;
  return (slope_here < 0.0) == (side < 0);
}

bool FlowTracker::solve_form(const Row& row, std::uint32_t x, double& slope) {
  const LastVariable form = row.form->last(bases_);
  const bool turn = variables_[x].kind == VariableKind::turn;
  if (!(turn ? solve_turn(form, x) : solve_slide(form, x))) return false;
  const CoordinateBasis& b = bases_[x];
  slope = slope_in(form, b);
  // The condition stays met: its time derivatives vanish.
  const double moved = form.rate[0] + form.rate[1] * b.value[0] + form.rate[2] * b.value[1];
  const double v = -moved / slope;
  const double curvature = turn ? -(form.value[1] * b.value[0] + form.value[2] * b.value[1]) : 2.0 * form.value[2];
  const double bent = form.acceleration[0] + form.acceleration[1] * b.value[0] + form.acceleration[2] * b.value[1] +
                      2.0 * (form.rate[1] * b.slope[0] + form.rate[2] * b.slope[1]) * v + curvature * v * v;
  set_motion(x, v, -bent / slope);
  take_error(x, error_through(*row.form, x, slope) / (turn ? 1.0 : length_));
  const double open = form.value[0] + form.value[1] * b.value[0] + form.value[2] * b.value[1];
  const double amplitude = turn ? std::sqrt(form.value[1] * form.value[1] + form.value[2] * form.value[2]) : slope;
  accuracy_.residual = std::max(accuracy_.residual, std::abs(open));
  accuracy_.condition = std::max(accuracy_.condition, std::abs(amplitude / slope));
  return true;
}

/// The root of C + A cos + B sin = 0 (K-II-3.4.4a) on the side of the start.
bool FlowTracker::solve_turn(const LastVariable& form, std::uint32_t variable) {
  const auto [c, a, b] = form.value;
  const double square = a * a + b * b, radicand = square - c * c;
  if (!(radicand > least_slope * least_slope * square)) return false;
  const double cosine0 = bases_[variable].value[0], sine0 = bases_[variable].value[1];
  // Between the two roots lies an extremum; the slope tells them apart.
  const double slope0 = b * cosine0 - a * sine0;
  const double w = std::copysign(std::sqrt(radicand), slope0);
  const double cosine = (-a * c + b * w) / square, sine = (-b * c - a * w) / square;
  const double moved = std::atan2(sine * cosine0 - cosine * sine0, cosine * cosine0 + sine * sine0);
  const double to_other = 2.0 * std::abs(w) / std::sqrt(square);  // the sine of half of it is half of this
  if (!(std::abs(moved) <= std::min(largest_move, nearest_part * to_other))) return false;
  place_turn(variable, (*q_)[variables_[variable].q] + moved, cosine, sine);
  return true;
}

bool FlowTracker::solve_slide(const LastVariable& form, std::uint32_t variable) {
  const auto [c, b, a] = form.value;
  const double start = (*q_)[variables_[variable].q];
  // The form about the start: f + g x + a x^2.
  const double f = c + start * (b + start * a), g = b + 2.0 * a * start;
  const double radicand = g * g - 4.0 * a * f;
  if (!(radicand > least_slope * least_slope * g * g)) return false;
  const double moved = -2.0 * f / (g + std::copysign(std::sqrt(radicand), g));
  const double to_other = a != 0.0 ? std::sqrt(radicand) / std::abs(a) : std::numeric_limits<double>::infinity();
  if (!(std::abs(moved) <= std::min(largest_move * length_, nearest_part * to_other))) return false;
  place(variable, start + moved);
  return true;
}

/// Of two conditions by their unknowns, in radians or lengths.
Eigen::Matrix2d FlowTracker::jacobian_of(const Step& step) const {
  Eigen::Matrix2d jacobian;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto names = step.rows[k].form->variables();
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint32_t x = step.unknowns[i];
      const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), x) - names.begin());
      jacobian(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          at == names.size() ? 0.0 : unit(x) * step.rows[k].form->by(at, bases_);
    }
  }
  return jacobian;
}

/// Two conditions in two unknowns: Newton's method, and the rates by the same Jacobian.
bool FlowTracker::solve_two(const Step& step, std::int8_t side) {
  const std::array<std::uint32_t, 2> x{step.unknowns[0], step.unknowns[1]};
  std::array<double, 2> units{};
  Eigen::Matrix2d jacobian;
  Eigen::Vector2d open;
  const auto conditions = [&](std::size_t derivative) {
    for (std::size_t k = 0; k < 2; ++k) {
      open[static_cast<Eigen::Index>(k)] = step.rows[k].form->value(bases_)[derivative];
    }
  };
  const auto linearise = [&] { jacobian = jacobian_of(step); };
  for (std::size_t i = 0; i < 2; ++i) {
    units[i] = unit(x[i]);
    errors_[x[i]] = 0.0;
    place(x[i], (*q_)[variables_[x[i]].q]);
    set_motion(x[i], 0.0, 0.0);
  }
  double moved = 0.0, last = 1.0;
  for (int i = 0; i < most_iterations; ++i) {
    conditions(0);
    linearise();
    const double determinant = jacobian.determinant();
    if (!(std::abs(determinant) > least_slope * jacobian.row(0).norm() * jacobian.row(1).norm())) return false;
    const Eigen::Vector2d change = -jacobian.inverse() * open;
    const double way = change.lpNorm<Eigen::Infinity>();
    if (way <= 2.0 * eps || (i > 1 && way > 0.5 * last)) break;
    last = way;
    moved += way;
    // Newton's method finds the root that continues the motion if the start lies well within the reach of its slopes.
    if (!(moved <= least_slope)) return false;
    for (std::size_t k = 0; k < 2; ++k) {
      place(x[k], (*q_)[variables_[x[k]].q] + units[k] * change[static_cast<Eigen::Index>(k)]);
    }
  }
  if ((jacobian.determinant() < 0.0) != (side < 0)) return false;
  const Eigen::Matrix2d inverse = jacobian.inverse();
  accuracy_.residual = std::max(accuracy_.residual, open.lpNorm<Eigen::Infinity>());
  accuracy_.condition = std::max(accuracy_.condition, jacobian.norm() * inverse.norm());
  const Eigen::Vector2d uncertain(error_through(*step.rows[0].form, x[0], 1.0),
                                  error_through(*step.rows[1].form, x[0], 1.0));
  conditions(1);
  const Eigen::Vector2d v = -inverse * open;
  for (std::size_t i = 0; i < 2; ++i) set_motion(x[i], units[i] * v[static_cast<Eigen::Index>(i)], 0.0);
  conditions(2);
  const Eigen::Vector2d a = -inverse * open;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    set_motion(x[i], units[i] * v[k], units[i] * a[k]);
    take_error(x[i], inverse.row(k).cwiseAbs().dot(uncertain));
  }
  return true;
}

/// The walk leads from behind the joint to before it, so that it shows the joint's motion backwards.
void FlowTracker::read_joint(Step& step) {
  if (step.sum) return read_sum(*step.sum, step.unknowns[0]);
  // What the worst of the given coordinates leaves.
  double error = 32.0 * eps;
  for (const std::uint32_t v : step.given) {
    error = std::max(error, errors_[v] / unit(v));
  }
  places_.place(step.around);
  const Pose& before = step.around.end;
  const WayMotion motion = places_.motion(step.around);
  for (std::size_t i = 0; i < step.unknowns.size(); ++i) {
    const std::uint32_t x = step.unknowns[i];
    switch (variables_[x].kind) {
      case VariableKind::turn: {
        const Matrix3& r = before.rotation;
        const double cosine = r(0, 0) + r(1, 1), sine = r(0, 1) - r(1, 0);
        const double start = (*q_)[variables_[x].q], angle = std::atan2(sine, cosine);
        const double size = std::sqrt(cosine * cosine + sine * sine);
        place_turn(x, start + std::remainder(angle - start, 2.0 * std::numbers::pi), cosine / size, sine / size);
        set_motion(x, -motion.twist.angular.z(), -motion.rate.angular.z());
        break;
      }
      case VariableKind::slide: {
        const double sign = step.against ? 1.0 : -1.0;
        place(x, sign * before.position.z());
        set_motion(x, sign * motion.velocity(before.position).z(), sign * motion.acceleration(before.position).z());
        break;
      }
      case VariableKind::ball: read_ball(before, motion, step.inverse[i], x); break;
    }
    take_error(x, error);
  }
}

void FlowTracker::read_sum(const TurnSum& sum, std::uint32_t x) {
  const double start = (*q_)[variables_[x].q];
  double angle = sum.constant, v = 0.0, a = 0.0, error = 0.0, size = std::abs(start) + std::abs(angle);
  for (const auto& [variable, sign] : sum.terms) {
    const double term = (*q_)[variables_[variable].q];
    angle += sign * term;
    v += sign * (*v_)[variables_[variable].v];
    a += sign * (*a_)[variables_[variable].v];
    error += errors_[variable];
    size += std::abs(term);
  }
  place(x, start + std::remainder(angle - start, 2.0 * std::numbers::pi));
  set_motion(x, v, a);
  // Each addition rounds what is at most the sum of all sizes.
  take_error(x, error + static_cast<double>(sum.terms.size() + 2) * eps * size);
}

/// Quaternion, angular velocity and acceleration in the axes of the ball's outlet: that is behind the joint, or before
/// it if the loop passes it backwards.
void FlowTracker::read_ball(const Pose& before, const WayMotion& motion, bool inverse, std::uint32_t x) {
  const Variable& variable = variables_[x];
  const Matrix3 to_outlet = inverse ? Matrix3(before.rotation) : Matrix3(before.rotation.transpose());
  Vector4 quaternion = quaternion_of_rotation<double>(to_outlet);
  if (quaternion.dot(q_->segment<4>(variable.q)) < 0.0) quaternion = -quaternion;
  place_ball(x, quaternion);
  if (inverse) {
    set_ball_motion(x, before.rotation.transpose() * motion.twist.angular,
                    before.rotation.transpose() * motion.rate.angular);
  } else {
    set_ball_motion(x, -motion.twist.angular, -motion.rate.angular);
  }
}

}  // namespace koppel

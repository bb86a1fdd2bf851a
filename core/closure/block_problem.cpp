#include "closure/block_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spatial/rotation_coordinates.hpp"

namespace koppel {
namespace {

using ComplexPose = PoseT<Complex>;
using ComplexVector3 = Vector3T<Complex>;
using ComplexMatrix3 = Matrix3T<Complex>;

/// With lengths in units of the mechanism's.
Way scaled(Way way, double length) {
  for (Leg& leg : way.legs) leg.to.position /= length;
  way.last.position /= length;
  return way;
}

Complex bilinear(const ComplexVector3& a, const ComplexVector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A displacement by six parameters: Rodrigues parameters of a rotation, and a translation.
ComplexPose displacement(const Complex* p) {
  return {rotation_of_quaternion<Complex>({Complex(1.0), p[0], p[1], p[2]}), ComplexVector3(p[3], p[4], p[5])};
}

/// Its motion when the parameters change by dp: angular velocity and velocity of the origin, in the axes before it.
std::pair<ComplexVector3, ComplexVector3> displacement_rate(const Complex* p, const Complex* dp) {
  const ComplexVector3 x(p[0], p[1], p[2]), dx(dp[0], dp[1], dp[2]);
  return {Complex(2.0) / (Complex(1.0) + bilinear(x, x)) * (dx + cross<Complex>(x, dx)),
          ComplexVector3(dp[3], dp[4], dp[5])};
}

Complex random_number(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double re = normal(random), im = normal(random);
  return {re, im};
}

/// Divides by the bilinear length, which is near 1 or not zero.
void normalise(Complex* x, Eigen::Index count) {
  Complex square = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) square += x[i] * x[i];
  const Complex factor = Complex(1.0) / std::sqrt(square);
  for (Eigen::Index i = 0; i < count; ++i) x[i] *= factor;
}

Eigen::Index numbers_of(VariableKind kind) {
  return kind == VariableKind::turn ? 2 : kind == VariableKind::slide ? 1 : 4;
}

}  // namespace

BlockProblem::BlockProblem(const Flow& flow, const FlowStep& step, const Eigen::VectorXd& q, Family family)
    : variables_(flow.loops.variables), length_(flow.length) {
  for (const FlowRow& row : step.rows) {
    const LoopCut& cut = flow.cuts[row.cut];
    const Loop& loop = flow.loops.loops[cut.loop];
    rows_.push_back({cut.conditions[row.condition], scaled(lower_way(loop, variables_, cut), length_),
                     scaled(upper_way(loop, variables_, cut), length_)});
  }
  for (const std::uint32_t loop : step.whole_loops) {
    whole_.push_back(scaled(round_way(flow.loops.loops[loop], variables_), length_));
  }
  unknown_of_.assign(variables_.size(), -1);
  for (const std::uint32_t v : step.unknowns) {
    unknown_of_[v] = static_cast<std::int32_t>(unknowns_.size());
    unknowns_.push_back({v, variables_[v].kind, numbers_, tangents_});
    numbers_ += numbers_of(variables_[v].kind);
    tangents_ += freedoms_of(variables_[v].kind);
  }
  for (const Variable& variable : variables_) {
    const Place<double> here = place(variable, q.data());
    Place<Complex> complex{};
    for (std::size_t i = 0; i < here.size(); ++i) complex[i] = here[i];
    if (variable.kind == VariableKind::slide) complex[0] /= length_;
    at_.push_back(complex);
  }
  known_count_ = count_solutions(flow, step);
  const bool displaces = family == Family::all_measures && known_count_ > 0;
  displaces_joints_ = displaces && rows_.empty();
  displaces_points_ = displaces && !rows_.empty();
  const auto whole = static_cast<Eigen::Index>(whole_.size());
  equations_ = static_cast<Eigen::Index>(rows_.size()) + 6 * whole;
  parameters_ = static_cast<Eigen::Index>(rows_.size()) +
                (displaces_joints_ ? 6 * static_cast<Eigen::Index>(whole_[0].legs.size()) : 6 * whole);
  square_ = equations_ >= tangents_;
  if (!square_) return;
  all_residual_.resize(equations_);
  all_along_.resize(equations_);
  all_jacobian_.resize(equations_, tangents_);
  if (equations_ > tangents_) {
    std::mt19937_64 random(7);
    combination_ = ComplexMatrix::NullaryExpr(tangents_, equations_, [&] { return random_number(random); });
    combination_ /= std::sqrt(static_cast<double>(equations_));
  }
  if (displaces_points_) {
    parameters_ += 6 * static_cast<Eigen::Index>(rows_.size());
  }
}

bool BlockProblem::has_unknowns(const Way& way) const {
  return std::any_of(way.legs.begin(), way.legs.end(),
                     [this](const Leg& leg) { return unknown_of_[leg.variable] >= 0; });
}

Eigen::Index BlockProblem::count_solutions(const Flow& flow, const FlowStep& step) const {
  const auto count = [this](VariableKind kind) {
    return std::count_if(unknowns_.begin(), unknowns_.end(), [kind](const Unknown& u) { return u.kind == kind; });
  };
  if (rows_.empty() && whole_.size() == 1 && tangents_ == 6 && count(VariableKind::ball) == 0) {
    const auto slides = count(VariableKind::slide);
    return slides <= 1 ? 16 : slides == 2 ? 8 : slides == 3 ? 2 : 0;
  }
  // A body that rods hold, or joints that are as good as rods: six conditions, of which the chain with the unknowns may
  // be one, as two slides and a ball keep a point in a plane.
  const bool all_rows = static_cast<Eigen::Index>(step.rows.size()) == tangents_ && whole_.empty();
  if (!all_rows || tangents_ < 5 || tangents_ > 6 || count(VariableKind::ball) != 1) return 0;
  for (const FlowRow& row : step.rows) {
    const LoopCut& cut = flow.cuts[row.cut];
    const bool ball = cut.a.shape == CutShape::ball || (cut.b && cut.b->shape == CutShape::ball);
    const ClosureType type = cut.conditions[row.condition].type;
    if (!ball || (type != ClosureType::point_point && type != ClosureType::point_plane)) return 0;
  }
  return count(VariableKind::slide) + 3 == tangents_ ? 40 : 0;
}

void BlockProblem::set_places(const ComplexVector& x) {
  for (const Unknown& u : unknowns_) {
    for (Eigen::Index i = 0; i < numbers_of(u.kind); ++i) {
      at_[u.variable][static_cast<std::size_t>(i)] = x[u.number + i];
    }
  }
}

void BlockProblem::conditions(const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                              const ComplexVector* dp, ComplexVector* along_dp) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const ClosureCondition& condition = rows_[k].condition;
    residual[row] = -p[row];
    if (along_dp != nullptr) (*along_dp)[row] = -(*dp)[row];
    for (const bool lower : {true, false}) {
      columns_.clear();
      Columns* columns = jacobian != nullptr ? &columns_ : nullptr;
      const Way& way = lower ? rows_[k].lower : rows_[k].upper;
      ComplexPose a_in_b = walk<Complex>(way, at_, columns);
      const Complex sign = lower ? 1.0 : -1.0;
      ComplexVector3 shift = ComplexVector3::Zero();  // of b's frame; a's point is moved with a
      if (displaces_points_ && has_unknowns(way)) {
        const Eigen::Index first = static_cast<Eigen::Index>(rows_.size()) + 6 * row;
        shift = p.segment<3>(first + 3);
        a_in_b.position += a_in_b.rotation * p.segment<3>(first) + shift;
        if (along_dp != nullptr) {
          const ComplexVector3 moved = a_in_b.rotation * dp->segment<3>(first) + dp->segment<3>(first + 3);
          (*along_dp)[row] += sign * change(condition, a_in_b, ComplexVector3(ComplexVector3::Zero()), moved);
        }
      }
      residual[row] += sign * value(condition, a_in_b);
      if (jacobian == nullptr) continue;
      for (const WayColumn<Complex>& column : columns_) {
        const std::int32_t unknown = unknown_of_[column.variable];
        if (unknown < 0) continue;
        const ComplexVector3 linear = column.velocity(a_in_b.position - shift);
        (*jacobian)(row, unknowns_[static_cast<std::size_t>(unknown)].tangent + column.rate) +=
            sign * change(condition, a_in_b, column.angular, linear);
      }
    }
  }
}

void BlockProblem::whole_loop(std::size_t index, const ComplexVector& p, ComplexVector& residual,
                              ComplexMatrix* jacobian, const ComplexVector* dp, ComplexVector* along_dp) {
  const Eigen::Index first_row = static_cast<Eigen::Index>(rows_.size() + 6 * index);
  const auto first_parameter = static_cast<Eigen::Index>(rows_.size() + (displaces_joints_ ? 0 : 6 * index));
  struct Displaced {
    ComplexVector3 angular, linear, point;
  };
  std::vector<Displaced> displaced;
  ComplexPose frame;
  columns_.clear();
  const auto displace = [&](Eigen::Index parameter) {
    if (along_dp != nullptr) {
      const auto [angular, linear] = displacement_rate(p.data() + parameter, dp->data() + parameter);
      const ComplexVector3 moved = frame.rotation * linear;
      frame = frame * displacement(p.data() + parameter);
      // The displacement turns about its own far origin, which it carries along.
      displaced.push_back({(frame.rotation * displacement(p.data() + parameter).rotation.transpose()) * angular, moved,
                           frame.position});
    } else {
      frame = frame * displacement(p.data() + parameter);
    }
  };
  for (std::size_t i = 0; i < whole_[index].legs.size(); ++i) {
    const Leg& leg = whole_[index].legs[i];
    frame = frame * as<Complex>(leg.to);
    if (displaces_joints_) displace(first_parameter + 6 * static_cast<Eigen::Index>(i));
    pass(leg, at_[leg.variable], frame, &columns_);
  }
  if (!displaces_joints_) displace(first_parameter);
  residual.segment<3>(first_row) = axial(frame.rotation);
  residual.segment<3>(first_row + 3) = frame.position;
  // How the skew part of a rotation near the identity turns with it.
  const ComplexMatrix3 of_angular =
      Complex(0.5) * (frame.rotation.trace() * ComplexMatrix3::Identity() - frame.rotation);
  if (jacobian != nullptr) {
    for (const WayColumn<Complex>& column : columns_) {
      const std::int32_t unknown = unknown_of_[column.variable];
      if (unknown < 0) continue;
      const Eigen::Index j = unknowns_[static_cast<std::size_t>(unknown)].tangent + column.rate;
      jacobian->col(j).segment<3>(first_row) += of_angular * column.angular;
      jacobian->col(j).segment<3>(first_row + 3) += column.velocity(frame.position);
    }
  }
  if (along_dp != nullptr) {
    along_dp->segment<6>(first_row).setZero();
    for (const Displaced& d : displaced) {
      along_dp->segment<3>(first_row) += of_angular * d.angular;
      along_dp->segment<3>(first_row + 3) += d.linear + cross<Complex>(d.angular, frame.position - d.point);
    }
  }
}

void BlockProblem::evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual,
                            ComplexMatrix* jacobian, const ComplexVector* dp, ComplexVector* along_dp) {
  set_places(x);
  ComplexMatrix* all_jacobian = jacobian != nullptr ? &all_jacobian_ : nullptr;
  ComplexVector* all_along = along_dp != nullptr ? &all_along_ : nullptr;
  if (all_jacobian != nullptr) all_jacobian_.setZero();
  conditions(p, all_residual_, all_jacobian, dp, all_along);
  for (std::size_t i = 0; i < whole_.size(); ++i) whole_loop(i, p, all_residual_, all_jacobian, dp, all_along);
  const bool as_they_are = equations_ == tangents_;
  residual = as_they_are ? all_residual_ : ComplexVector(combination_ * all_residual_);
  if (jacobian != nullptr) *jacobian = as_they_are ? all_jacobian_ : ComplexMatrix(combination_ * all_jacobian_);
  if (along_dp != nullptr) *along_dp = as_they_are ? all_along_ : ComplexVector(combination_ * all_along_);
}

void BlockProblem::move(const ComplexVector& x, const ComplexVector& delta, ComplexVector& result) const {
  result.resize(numbers_);
  for (const Unknown& u : unknowns_) {
    const Complex* from = x.data() + u.number;
    Complex* to = result.data() + u.number;
    const Complex* d = delta.data() + u.tangent;
    switch (u.kind) {
      case VariableKind::turn: {
        const Complex t = d[0] / 2.0;
        to[0] = (1.0 - t * t) * from[0] - 2.0 * t * from[1];
        to[1] = (1.0 - t * t) * from[1] + 2.0 * t * from[0];
        const Complex factor = Complex(1.0) / (1.0 + t * t);
        to[0] *= factor;
        to[1] *= factor;
        normalise(to, 2);
        break;
      }
      case VariableKind::slide: to[0] = from[0] + d[0]; break;
      case VariableKind::ball: {
        const Vector4T<Complex> q = quaternion_product<Complex>({from[0], from[1], from[2], from[3]},
                                                                {Complex(1.0), d[0] / 2.0, d[1] / 2.0, d[2] / 2.0});
        std::copy(q.data(), q.data() + 4, to);
        normalise(to, 4);
        break;
      }
    }
  }
}

void BlockProblem::lift(const ComplexVector& x, const ComplexVector& rate, ComplexVector& derivative,
                        ComplexVector& scratch) const {
  (void)scratch;
  derivative.resize(numbers_);
  for (const Unknown& u : unknowns_) {
    const Complex* at = x.data() + u.number;
    const Complex* d = rate.data() + u.tangent;
    if (u.kind == VariableKind::turn) {
      derivative[u.number] = -at[1] * d[0];
      derivative[u.number + 1] = at[0] * d[0];
    } else if (u.kind == VariableKind::slide) {
      derivative[u.number] = d[0];
    } else {
      derivative.segment<4>(u.number) =
          quaternion_product<Complex>({at[0], at[1], at[2], at[3]}, {Complex(0.0), d[0] / 2.0, d[1] / 2.0, d[2] / 2.0});
    }
  }
}

void BlockProblem::fingerprint(const ComplexVector& x, ComplexVector& print) const {
  Eigen::Index size = 0;
  for (const Unknown& u : unknowns_) size += u.kind == VariableKind::ball ? 9 : numbers_of(u.kind);
  print.resize(size);
  Eigen::Index next = 0;
  for (const Unknown& u : unknowns_) {
    const Complex* at = x.data() + u.number;
    if (u.kind == VariableKind::ball) {
      const ComplexMatrix3 r = rotation_of_quaternion<Complex>({at[0], at[1], at[2], at[3]});
      print.segment<9>(next) = r.reshaped();
      next += 9;
    } else {
      for (Eigen::Index i = 0; i < numbers_of(u.kind); ++i) print[next++] = at[i];
    }
  }
}

bool BlockProblem::seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) {
  x.resize(numbers_);
  for (const Unknown& u : unknowns_) {
    for (Eigen::Index i = 0; i < numbers_of(u.kind); ++i) x[u.number + i] = random_number(random);
    if (u.kind != VariableKind::slide) normalise(x.data() + u.number, numbers_of(u.kind));
  }
  p.resize(parameters_);
  for (Complex& value : p) value = 0.5 * random_number(random);
  // What is left open with these is taken up by the last parameters.
  set_places(x);
  const auto rows = static_cast<Eigen::Index>(rows_.size());
  ComplexVector open(equations_);
  p.head(rows).setZero();
  conditions(p, open, nullptr, nullptr, nullptr);
  p.head(rows) = open.head(rows);  // they enter with a minus
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    const std::vector<Leg>& legs = whole_[i].legs;
    const auto first = static_cast<Eigen::Index>(rows_.size() + (displaces_joints_ ? 0 : 6 * i));
    // Displace the last joint, or the end, so that the loop closes: before * D * after = 1.
    ComplexPose before, after;
    for (std::size_t k = 0; k < legs.size(); ++k) {
      const bool last = k + 1 == legs.size();
      before = before * as<Complex>(legs[k].to);
      if (displaces_joints_ && !last) {
        before = before * displacement(p.data() + first + 6 * static_cast<Eigen::Index>(k));
      }
      apply(legs[k].kind, at_[legs[k].variable], legs[k].inverse, displaces_joints_ && last ? after : before);
    }
    const ComplexPose needed = before.inverse() * after.inverse();
    const ComplexMatrix3& r = needed.rotation;
    // Rodrigues parameters of a rotation.
    const Complex denominator = 1.0 + r.trace();
    if (std::abs(denominator) < 1e-3) return false;
    Complex* d = p.data() + first + (displaces_joints_ ? 6 * static_cast<Eigen::Index>(legs.size() - 1) : 0);
    const ComplexVector3 x_r = Complex(2.0) / denominator * axial(r);
    for (int k = 0; k < 3; ++k) {
      d[k] = x_r[k];
      d[k + 3] = needed.position[k];
    }
  }
  return true;
}

void BlockProblem::read(const ComplexVector& x, Eigen::VectorXd& q) const {
  for (const Unknown& u : unknowns_) {
    const std::uint32_t at = variables_[u.variable].q;
    if (u.kind == VariableKind::turn) {
      const double angle = std::atan2(x[u.number + 1].real(), x[u.number].real());
      q[at] = unwrapped<double>(angle, q[at]);
    } else if (u.kind == VariableKind::slide) {
      q[at] = length_ * x[u.number].real();
    } else {
      Vector4 quaternion = x.segment<4>(u.number).real();
      if (quaternion.dot(q.segment<4>(at)) < 0.0) quaternion = -quaternion;
      q.segment<4>(at) = quaternion.normalized();
    }
  }
}

bool BlockProblem::equal(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  const double tolerance = std::sqrt(std::numeric_limits<double>::epsilon());
  return std::all_of(unknowns_.begin(), unknowns_.end(), [&](const Unknown& u) {
    const std::uint32_t at = variables_[u.variable].q;
    switch (u.kind) {
      case VariableKind::turn: return std::abs(wrapped<double>(a[at] - b[at])) <= tolerance;
      case VariableKind::slide: return std::abs(a[at] - b[at]) <= tolerance * length_;
      case VariableKind::ball:
        return 1.0 - std::abs(a.segment<4>(at).dot(b.segment<4>(at))) <= tolerance * tolerance * 4.0;
    }
    return false;
  });
}

}  // namespace koppel

#include "closure/flow_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "closure/loop_cut.hpp"
#include "spatial/quaternion.hpp"

namespace koppel {
namespace {

constexpr std::size_t written_out = 3;  // variables of a condition: with more of them walking costs less

/// Where a coordinate does not move what it belongs to.
Place<double> at_rest(const Variable& variable) {
  return {variable.kind == VariableKind::slide ? 0.0 : 1.0, 0.0, 0.0, 0.0};
}

/// With one variable moved to the end.
std::vector<std::uint32_t> with_last(std::vector<std::uint32_t> variables, std::uint32_t last) {
  std::erase(variables, last);
  variables.push_back(last);
  return variables;
}

}  // namespace

std::optional<FlowTracker> FlowTracker::of(const Mechanism& mechanism, const Flow& flow) {
  if (!flow.obstacle.empty() || !flow.held.empty() || flow.steps.empty()) return std::nullopt;
  for (const std::uint32_t v : flow.outside) {
    if (std::find(flow.inputs.begin(), flow.inputs.end(), v) == flow.inputs.end()) return std::nullopt;
  }
  FlowTracker tracker(mechanism, flow);
  std::vector<Place<double>> places;
  for (const Variable& variable : tracker.variables_) places.push_back(at_rest(variable));
  for (const FlowStep& from : flow.steps) {
    Step step;
    if (!tracker.compile(flow, from, places, step)) return std::nullopt;
    tracker.steps_.push_back(std::move(step));
  }
  tracker.compile_runs();
  return tracker;
}

FlowTracker::FlowTracker(const Mechanism& mechanism, const Flow& flow)
    : length_(mechanism.length),
      variables_(flow.loops.variables),
      inputs_(flow.inputs),
      bases_(variables_.size()),
      errors_(variables_.size(), 0.0),
      mechanism_(&mechanism),
      kinematics_(mechanism) {
  places_.variables.resize(variables_.size());
  const auto count = flow.loops.imaginary.size();
  if (count == 0) return;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [a, b] = flow.loops.imaginary[i];
    const auto first = static_cast<std::uint32_t>(variables_.size() - 4 * (count - i));
    imaginary_.push_back({a.value, b.value, first});
  }
  const auto more = static_cast<Eigen::Index>(count);
  extended_[0].setZero(mechanism.nq + 7 * more);
  extended_[1].setZero(mechanism.nv + 6 * more);
  extended_[2].setZero(mechanism.nv + 6 * more);
}

/// places: of all variables, at rest, before and afterwards.
bool FlowTracker::compile(const Flow& flow, const FlowStep& from, std::vector<Place<double>>& places,
                          Step& step) const {
  if (from.kind == StepKind::spin || !from.whole_loops.empty()) return false;
  step.kind = from.kind;
  step.given = from.given;
  step.unknowns = from.unknowns;
  if (from.kind == StepKind::joint) compile_joint(flow, from, step);
  if (from.kind == StepKind::numerical) {
    step.column.assign(variables_.size(), -1);
    for (const std::uint32_t x : from.unknowns) {
      step.column[x] = static_cast<int>(step.size);
      step.size += freedoms_of(variables_[x].kind);
    }
    if (step.size > most_unknowns || step.size != static_cast<Eigen::Index>(from.rows.size())) return false;
  }
  for (const FlowRow& from_row : from.rows) {
    const LoopCut& cut = flow.cuts[from_row.cut];
    const Loop& loop = flow.loops.loops[cut.loop];
    const Way lower = lower_way(loop, variables_, cut), upper = upper_way(loop, variables_, cut);
    Row row{cut.conditions[from_row.condition], std::nullopt, tracked(lower), tracked(upper), {}};
    row.rigid = {value(row.condition, lower.last), value(row.condition, upper.last)};
    const auto variables = with_last(from_row.variables, from.unknowns.back());
    const bool small =
        from.kind == StepKind::two_unknowns || (from.kind == StepKind::one_unknown && variables.size() <= written_out);
    if (small) {
      row.form = ProductForm::of(variables, variables_, length_, [&](std::span<const double> x) {
        for (std::size_t i = 0; i < x.size(); ++i) {
          places[variables[i]] = place_at(variables_[variables[i]].kind, x[i]);
        }
        return openness(row.condition, lower, upper, places, length_);
      });
      for (const std::uint32_t v : variables) places[v] = at_rest(variables_[v]);
    }
    if (from.kind == StepKind::two_unknowns && !row.form) return false;
    step.rows.push_back(std::move(row));
  }
  return true;
}

void FlowTracker::compile_joint(const Flow& flow, const FlowStep& from, Step& step) const {
  const LoopCut& cut = flow.cuts[from.cut];
  const Loop& loop = flow.loops.loops[cut.loop];
  step.around = tracked(lower_way(loop, variables_, cut));
  step.unknowns.clear();
  for (std::size_t i = 0; i < cut.a.count; ++i) {
    const LoopMotion& motion = loop.motions[(cut.a.first + i) % loop.motions.size()];
    step.unknowns.push_back(motion.variable);
    step.inverse.push_back(motion.inverse);
    step.against = step.against || (i == 1 && motion.to.rotation(2, 2) < 0.0);
  }
  const bool turn = step.unknowns.size() == 1 && variables_[step.unknowns[0]].kind == VariableKind::turn;
  if (turn) step.sum = sum_of_turns(step.around);
}

/// The turn between the ends of a way, backwards, if all turns on it are about the z axis of its ends.
std::optional<FlowTracker::TurnSum> FlowTracker::sum_of_turns(const TrackedWay& around) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const auto along_z = [&](const Matrix3& r) { return r.col(2).head<2>().lpNorm<Eigen::Infinity>() <= rounding; };
  TurnSum sum;
  Matrix3 r = Matrix3::Identity();
  for (const Piece& piece : around.pieces) {
    r = (r * piece.to.rotation).eval();
    if (piece.kind == Piece::Kind::slide) continue;
    if (piece.kind != Piece::Kind::turn || !along_z(r)) return std::nullopt;
    sum.terms.emplace_back(piece.index, r(2, 2) > 0.0 ? -1.0 : 1.0);
  }
  r = (r * around.last.rotation).eval();
  if (!along_z(r)) return std::nullopt;
  sum.constant = std::atan2(r(0, 1) - r(1, 0), r(0, 0) + r(1, 1));
  return sum;
}

/// Runs that the walked conditions, and the joints that are read, have in common.
void FlowTracker::compile_runs() {
  std::vector<WayOfStep> ways;
  for (Step& step : steps_) {
    const bool together = step.kind == StepKind::numerical;
    constexpr int of_block = 5, of_condition = 3;  // iterations, rates and accelerations
    for (Row& row : step.rows) {
      if (row.form) continue;
      for (TrackedWay* way : {&row.lower, &row.upper}) {
        ways.push_back({way, step.unknowns, together ? of_block : of_condition});
      }
    }
    if (step.kind == StepKind::joint && !step.sum) ways.push_back({&step.around, {}, 1});
  }
  places_.runs = share_runs(ways);
  std::vector<std::size_t> known_after(variables_.size(), 0);  // steps
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    for (const std::uint32_t x : steps_[i].unknowns) known_after[x] = i + 1;
  }
  for (std::uint32_t i = 0; i < places_.runs.size(); ++i) {
    std::size_t after = 0;
    for (const Piece& piece : places_.runs[i].way.pieces) after = std::max(after, known_after[piece.index]);
    (after == 0 ? first_runs_ : steps_[after - 1].runs).push_back(i);
  }
}

void FlowTracker::find_sides(const Eigen::VectorXd& q, Sides& sides) {
  Eigen::VectorXd all(std::max(extended_[0].size(), q.size()));
  all.head(q.size()) = q;
  q_ = &all;
  start_imaginary();
  for (std::uint32_t i = 0; i < variables_.size(); ++i) {
    if (variables_[i].kind == VariableKind::ball) {
      place_ball(i, all.segment<4>(variables_[i].q));
    } else {
      place(i, all[variables_[i].q]);
    }
  }
  for (Run& run : places_.runs) places_.place(run);
  for (std::size_t i = 0; i < steps_.size(); ++i) sides[i] = side_of(steps_[i]);
}

bool FlowTracker::follow(Eigen::VectorXd& q, Eigen::VectorXd& v, Eigen::VectorXd& a, const Sides& sides,
                         TrackedAccuracy& accuracy) {
  const std::array<Eigen::VectorXd*, 3> own{&q, &v, &a};
  const bool extends = !imaginary_.empty();
  for (std::size_t i = 0; extends && i < 3; ++i) extended_[i].head(own[i]->size()) = *own[i];
  q_ = extends ? &extended_[0] : &q;
  v_ = extends ? &extended_[1] : &v;
  a_ = extends ? &extended_[2] : &a;
  const bool followed = follow_steps(sides);
  for (std::size_t i = 0; extends && i < 3; ++i) *own[i] = extended_[i].head(own[i]->size());
  accuracy = accuracy_;
  return followed;
}

/// Where the bodies of imaginary joints stand by the tree.
void FlowTracker::start_imaginary() {
  if (imaginary_.empty() || !forward_position(*mechanism_, q_->data(), kinematics_)) return;
  for (const Imaginary& joint : imaginary_) {
    const Pose pose = relative_pose(kinematics_.poses[joint.a], kinematics_.poses[joint.b]);
    for (std::uint32_t k = 0; k < 3; ++k) (*q_)[variables_[joint.first + k].q] = pose.position[k];
    q_->segment<4>(variables_[joint.first + 3].q) = quaternion_of_rotation<double>(pose.rotation);
  }
}

bool FlowTracker::follow_steps(const Sides& sides) {
  accuracy_ = {};
  start_imaginary();
  for (const std::uint32_t input : inputs_) {
    const Variable& variable = variables_[input];
    place(input, (*q_)[variable.q]);
    set_motion(input, (*v_)[variable.v], (*a_)[variable.v]);
    errors_[input] = 0.0;
  }
  finish_runs(first_runs_);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    Step& step = steps_[i];
    switch (step.kind) {
      case StepKind::one_unknown:
        if (!solve_one(step, sides[i])) return false;
        break;
      case StepKind::two_unknowns:
        if (!solve_two(step, sides[i])) return false;
        break;
      case StepKind::joint: read_joint(step); break;
      case StepKind::numerical:
        if (!solve_block(step, sides[i])) return false;
        break;
      case StepKind::spin: return false;  // not compiled
    }
    finish_runs(step.runs);
  }
  constexpr double closed = 1e-13;
  return std::isfinite(accuracy_.coordinate_error) && accuracy_.residual <= closed;
}

/// Of variables that are known with their motions and errors.
void FlowTracker::finish_runs(std::span<const std::uint32_t> runs) {
  for (const std::uint32_t i : runs) {
    Run& run = places_.runs[i];
    if (!run.unknown) {  // a block has moved its own
      places_.place(run);
      places_.move(run);
    }
    places_.take_errors(errors_, run);
  }
}

void FlowTracker::place(std::uint32_t variable, double x) {
  if (variables_[variable].kind == VariableKind::turn) {
    place_turn(variable, x, std::cos(x), std::sin(x));
  } else {
    (*q_)[variables_[variable].q] = x;
    bases_[variable].set_slide(x);
    places_.variables[variable].at[0] = x;
  }
}

void FlowTracker::place_turn(std::uint32_t variable, double x, double cosine, double sine) {
  (*q_)[variables_[variable].q] = x;
  bases_[variable].set_turn(cosine, sine);
  places_.variables[variable].at = {cosine, sine, 0.0, 0.0};
}

void FlowTracker::place_ball(std::uint32_t variable, const Vector4& quaternion) {
  q_->segment<4>(variables_[variable].q) = quaternion;
  std::copy(quaternion.begin(), quaternion.end(), places_.variables[variable].at.begin());
}

void FlowTracker::set_ball_motion(std::uint32_t variable, const Vector3& v, const Vector3& a) {
  v_->segment<3>(variables_[variable].v) = places_.variables[variable].rate = v;
  a_->segment<3>(variables_[variable].v) = places_.variables[variable].acceleration = a;
}

void FlowTracker::set_motion(std::uint32_t variable, double v, double a) {
  (*v_)[variables_[variable].v] = v;
  (*a_)[variables_[variable].v] = a;
  bases_[variable].set_motion(variables_[variable].kind, v, a);
  places_.variables[variable].rate[0] = v;
  places_.variables[variable].acceleration[0] = a;
}

void FlowTracker::take_error(std::uint32_t variable, double error) {
  errors_[variable] = error * unit(variable);
  accuracy_.coordinate_error = std::max(accuracy_.coordinate_error, error);
}

}  // namespace koppel

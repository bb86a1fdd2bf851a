#include "closure/closing.hpp"

#include <algorithm>
#include <cmath>

#include "closure/ceres_closure.hpp"
#include "closure/flow_closing.hpp"
#include "closure/passage.hpp"

namespace koppel {
namespace {

constexpr double largest_move = 0.35;    // of any unknown in one step that is believed without looking closer
constexpr double surely_nearest = 0.25;  // correction over singular value: branches are further apart than that
constexpr double well_conditioned = 1e3;
constexpr double smallest_fraction = 1.0 / 4096.0;
constexpr std::uint32_t default_ceres_iterations = 500;

}  // namespace

Closing::Closing(Work& work, const State& state, const CloseOptions& options, Report& report)
    : work_(work), mechanism_(*work.mechanism), state_(state), options_(options), report_(report) {
  newton_.max_iterations = options.max_iterations == 0 ? 50 : options.max_iterations;
  if (options.tolerance > 0.0) newton_.tolerance = std::min(options.tolerance, closed_limit);
  ceres_iterations_ = options.max_iterations == 0 ? default_ceres_iterations : options.max_iterations;
}

bool Closing::follow() {
  predict();
  if (options_.method != Method::ceres && try_newton() && moved_little()) {
    if (options_.method == Method::newton || believed(distance(work_.q_start), distance(state_.q))) return true;
  }
  if (plugin_failed_) return false;
  // A state that was moved by closed forms does not know its singular values.
  double weakest = state_.history.weakest;
  if (weakest == 0.0 && !weakest_here(weakest)) return false;
  if (options_.method == Method::automatic && lead(state_.q, &weakest)) return true;
  if (plugin_failed_ || options_.method == Method::newton) return false;
  if (options_.method == Method::automatic) {
    const PassageEnd end = pass(work_, state_, options_.branch, report_);
    plugin_failed_ = end == PassageEnd::plugin_failed;
    if (end != PassageEnd::lost) return end == PassageEnd::arrived;
  }
  work_.q = state_.q;
  set_inputs(1.0);
  if (!try_ceres()) return false;
  work_.q_start = state_.q;
  branch_changed_ = !moved_little();
  return true;
}

bool Closing::assemble() {
  if (assemble_numerically()) return true;
  return !plugin_failed_ && options_.method == Method::automatic && by_flow();
}

bool Closing::by_flow() {
  const FlowOutcome outcome = close_by_flow(work_, state_, report_);
  plugin_failed_ = outcome == FlowOutcome::plugin_failed;
  if (outcome == FlowOutcome::unreachable) report_.verdict = Verdict::unreachable;
  if (outcome == FlowOutcome::closed) {
    work_.q_start = state_.q;
    branch_changed_ = state_.stage != Stage::assigned && !moved_little();
  }
  return outcome == FlowOutcome::closed;
}

bool Closing::assemble_numerically() {
  work_.q = state_.q;
  set_inputs(1.0);
  if (options_.method != Method::ceres && try_newton()) return true;
  if (plugin_failed_ || options_.method == Method::newton) return false;
  work_.q = state_.q;
  set_inputs(1.0);
  if (try_ceres()) return true;
  if (plugin_failed_ || options_.method == Method::ceres || mechanism_.inputs.empty()) return false;
  // Let the inputs go, close wherever it is nearest, and lead them to where they should be.
  work_.q = state_.q;
  if (!try_newton(InputsAre::free)) {
    work_.q = state_.q;
    if (plugin_failed_ || !try_ceres(InputsAre::free)) return false;
  }
  return lead(work_.q);
}

/// The smallest singular value where the state stands. False: a plugin failed.
bool Closing::weakest_here(double& weakest) {
  work_.factorised = false;
  if (!work_.equations.evaluate(state_.q, state_.history.time)) {
    plugin_failed_ = true;
    return false;
  }
  work_.factorise(state_.q, state_.history.time);
  weakest = work_.condition.smallest;
  return true;
}

bool Closing::try_newton(InputsAre inputs) {
  newton_.inputs = inputs;
  const NewtonResult result = newton(work_, state_.time, newton_);
  report_.iterations += result.iterations;
  if (result.iterations > 0) report_.solver = SolverUsed::newton;
  plugin_failed_ = result.plugin_failed;
  if (!result.converged && inputs == InputsAre::held && inputs_at_target() && work_.equations.error() < nearest_) {
    Eigen::Index row = 0;
    nearest_ = work_.equations.residual.cwiseAbs().maxCoeff(&row);
    nearest_row_ = static_cast<std::uint32_t>(row);
  }
  return result.converged;
}

bool Closing::inputs_at_target() const {
  for (std::size_t i = 0; i < mechanism_.inputs.size(); ++i) {
    if (work_.q[mechanism_.inputs[i].q] != state_.input[static_cast<Eigen::Index>(i)]) return false;
  }
  return true;
}

/// Ceres comes near; Newton takes it down to rounding.
bool Closing::try_ceres(InputsAre inputs) {
  if (!work_.ceres) work_.ceres = std::make_unique<CeresClosure>(work_);
  const CeresClosure::Result result = work_.ceres->solve(state_.time, ceres_iterations_, inputs);
  report_.iterations += result.iterations;
  plugin_failed_ = result.plugin_failed;
  if (plugin_failed_) return false;
  const bool converged = try_newton(inputs);
  report_.solver = SolverUsed::ceres;
  return converged;
}

/// Sets the driven coordinates of work.q to a fraction of the way from where the search started to their targets.
void Closing::set_inputs(double fraction) {
  for (std::size_t i = 0; i < mechanism_.inputs.size(); ++i) {
    const std::uint32_t q = mechanism_.inputs[i].q;
    const double target = state_.input[static_cast<Eigen::Index>(i)];
    // Exactly the target at the end, not a sum that rounds.
    work_.q[q] = fraction == 1.0 ? target : work_.q_start[q] + fraction * (target - work_.q_start[q]);
  }
}

/// From the last position along velocity, acceleration and the change of acceleration over the last step.
void Closing::predict() {
  work_.q = state_.q;
  const double h = state_.time - state_.history.time;
  if (state_.stage == Stage::accelerations && h != 0.0) {
    work_.delta = h * state_.v + (h * h / 2.0) * state_.a;
    if (state_.history.step != 0.0) {
      work_.delta += (h * h * h / 6.0 / state_.history.step) * (state_.a - state_.history.acceleration);
    }
    // A wild extrapolation is worse than none.
    if (greatest_unknown(work_.delta) <= largest_move) integrate(mechanism_, state_.q, work_.delta, work_.q);
  }
  work_.q_start = work_.q;
  set_inputs(1.0);
}

/// Largest component of a change of coordinates, in radians' size; of unknowns only.
double Closing::greatest_unknown(const Eigen::VectorXd& delta) const {
  double result = 0.0;
  for (std::uint32_t i = 0; i < mechanism_.unknowns; ++i) {
    const std::uint32_t rate = mechanism_.rate_of_column[i];
    result = std::max(result, std::abs(delta[rate]) / mechanism_.rate_scale[rate]);
  }
  return result;
}

/// Of work.q from a position.
double Closing::distance(const Eigen::VectorXd& from) {
  difference(mechanism_, from, work_.q, work_.delta);
  return greatest_unknown(work_.delta);
}

bool Closing::moved_little() { return distance(work_.q_start) <= largest_move; }

/// Whether the closed position work.q is surely that of the branch: another branch is as far away as the smallest
/// singular value says, and it has not gone through zero on the way.
bool Closing::believed(double correction, double motion) {
  work_.factorise(work_.q, state_.time);
  const Factorisation::Condition& condition = work_.condition;
  if (work_.factorisation->rank() != state_.history.rank) return false;
  if (work_.factorisation->rank() == 0) return true;
  if (condition.ratio > well_conditioned || correction > surely_nearest * condition.smallest) return false;
  return motion <= condition.smallest || same_orientation();
}

/// Whether the Jacobian of the unknowns keeps its orientation from the state to work.q.
bool Closing::same_orientation() {
  const auto unknowns = static_cast<Eigen::Index>(mechanism_.unknowns);
  if (work_.factorisation->rank() < unknowns) return false;
  Equations& equations = work_.equations;
  work_.factorised = false;
  if (!equations.evaluate(state_.q, state_.history.time)) return false;
  equations.evaluate_jacobian();
  work_.orientation.remember(equations.jacobian);
  if (!equations.evaluate(work_.q, state_.time)) return false;
  equations.evaluate_jacobian();
  work_.factorised = true;
  return work_.orientation.is_kept(equations.jacobian);
}

/// Leads the inputs from a closed position to their targets, in steps that halve when they are not believed. weakest:
/// singular value at that position; null: any closed position will do.
bool Closing::lead(const Eigen::VectorXd& from, double* weakest) {
  Eigen::VectorXd& here = work_.q_start;
  if (&from != &here) here = from;
  double done = 0.0, fraction = 1.0;
  while (done < 1.0) {
    const double left = 1.0 - done;
    const double next = std::min(left, fraction);
    work_.q = here;
    set_inputs(next >= left ? 1.0 : next / left);
    const auto sure = [&] {
      if (weakest == nullptr) return true;
      const double moved = distance(here);
      if (moved > surely_nearest * *weakest || !believed(moved, moved)) return false;
      *weakest = work_.condition.smallest;
      return true;
    };
    if (try_newton() && moved_little() && sure()) {
      here = work_.q;
      done = next >= left ? 1.0 : done + next;
      fraction = std::min(1.0, 2.0 * next);
      continue;
    }
    if (plugin_failed_ || next <= smallest_fraction) return false;
    fraction = next / 2.0;
  }
  return true;
}

}  // namespace koppel

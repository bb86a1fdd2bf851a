#include "closure/newton.hpp"

#include <algorithm>
#include <cmath>

namespace koppel {
namespace {

constexpr double largest_step = 0.5;  // radians, or lengths of the scene: beyond it a linear step means little
constexpr int largest_halvings = 10;
constexpr std::uint32_t finishing_steps = 4;  // more than are asked for, to take what is all but closed to rounding
constexpr double rounding_region = 1e-12;     // here a step that gains less than half has met rounding

/// delta = factor * step, spread from columns to rates.
void spread(const Mechanism& mechanism, const Eigen::VectorXd& step, double factor, Eigen::Index columns,
            Eigen::VectorXd& delta) {
  delta.setZero();
  for (Eigen::Index i = 0; i < columns; ++i) {
    const std::uint32_t rate = mechanism.rate_of_column[static_cast<std::size_t>(i)];
    delta[rate] = factor * mechanism.rate_scale[rate] * step[i];
  }
}

}  // namespace

NewtonResult newton(Work& work, double time, const NewtonOptions& options) {
  const Mechanism& mechanism = *work.mechanism;
  Equations& equations = work.equations;
  const bool all = options.inputs == InputsAre::free;
  if (all && !work.all_columns) {
    work.all_columns = Factorisation::of(mechanism.rows, mechanism.columns);
  }
  Factorisation& factorisation = all ? *work.all_columns : *work.factorisation;
  const Eigen::Index columns = all ? mechanism.columns : mechanism.unknowns;

  NewtonResult result;
  const auto fail_plugin = [&result] {
    result.plugin_failed = true;
    return result;
  };
  work.factorised = false;
  if (!equations.evaluate(work.q, time)) return fail_plugin();
  double error = equations.error(), norm = equations.residual.norm();
  const auto steps = [&] { return options.max_iterations + (error <= closed_limit ? finishing_steps : 0); };
  while (error > options.tolerance && result.iterations < steps() && columns > 0) {
    ++result.iterations;
    equations.evaluate_jacobian();
    factorisation.compute(equations.jacobian);
    work.rhs = -equations.residual;
    factorisation.solve(work.rhs, work.step);
    const double size = work.step.head(columns).lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size)) break;
    double factor = std::min(1.0, largest_step / std::max(size, largest_step));
    double trial_norm = norm;
    bool usable = false;
    for (int halvings = 0; halvings <= largest_halvings; ++halvings, factor /= 2.0) {
      spread(mechanism, work.step, factor, columns, work.delta);
      integrate(mechanism, work.q, work.delta, work.q_trial);
      usable = equations.evaluate(work.q_trial, time);
      if (!usable) continue;  // outside what a plugin can answer: nearer it may
      trial_norm = equations.residual.norm();
      if (trial_norm < norm * (1.0 - 1e-4 * factor)) break;
      if (error <= rounding_region) break;  // halving cannot help against rounding
    }
    if (!usable) return fail_plugin();
    const bool at_rounding = error <= rounding_region && !(trial_norm < 0.5 * norm);
    if (trial_norm < norm) {
      work.q = work.q_trial;
      norm = trial_norm;
      error = equations.error();
    } else {
      if (!equations.evaluate(work.q, time)) return fail_plugin();
      if (!at_rounding) break;  // a valley that is not a root
    }
    if (at_rounding) break;
  }
  result.converged = error <= closed_limit;
  return result;
}

}  // namespace koppel

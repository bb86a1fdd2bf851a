#include "closure/work.hpp"

#include "closure/ceres_closure.hpp"
#include "closure/flow_tracker.hpp"

namespace koppel {

Work::Work(std::shared_ptr<const Mechanism> m)
    : mechanism(std::move(m)),
      equations(*mechanism),
      factorisation(Factorisation::of(mechanism->rows, mechanism->unknowns)),
      q(mechanism->nq),
      q_trial(mechanism->nq),
      q_start(mechanism->nq),
      delta(mechanism->nv),
      v(mechanism->nv),
      a(mechanism->nv),
      rhs(mechanism->rows),
      rhs_copy(mechanism->rows),
      step(mechanism->columns),
      rest(Eigen::VectorXd::Zero(mechanism->nv)),
      orientation(mechanism->unknowns),
      saved(*mechanism) {
  factorised_at.resize(mechanism->nq);
}

Work::~Work() = default;

void Work::factorise(const Eigen::VectorXd& at, double time) {
  equations.evaluate_jacobian();
  factorisation->compute(equations.jacobian);
  condition = factorisation->condition();
  factorised = true;
  factorised_at = at;
  factorised_time = time;
}

}  // namespace koppel

#include "dynamics/integrator.hpp"

#include "dynamics/cvode.hpp"
#include "dynamics/runge_kutta.hpp"
#include "dynamics/semi_implicit.hpp"

namespace koppel {

bool Integrator::exchange(Archive& archive) {
  archive(tolerance_, step_, time_, before_, y_);
  archive(statistics_.steps, statistics_.rejected, statistics_.evaluations, statistics_.stiff);
  return archive.good() && y_.size() == problem_->size();
}

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, DifferentialEquation& problem, double tolerance,
                                            double step) {
  switch (kind) {
#define KOPPEL_INTEGRATOR(name, type, control, description) \
  case IntegratorKind::name:                                \
    return std::make_unique<type>(problem, tolerance, step);
#include "scene/integrators.inc"
#undef KOPPEL_INTEGRATOR
  }
  return nullptr;
}

}  // namespace koppel

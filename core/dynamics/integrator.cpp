#include "dynamics/integrator.hpp"

#include <type_traits>

#include "dynamics/arkode.hpp"
#include "dynamics/cvode.hpp"
#include "dynamics/generalised_alpha.hpp"
#include "dynamics/ida.hpp"
#include "dynamics/runge_kutta.hpp"
#include "dynamics/semi_implicit.hpp"

namespace koppel {

namespace {

/// Null: the problem is not of the kind that the method is for.
template <typename Method>
std::unique_ptr<Integrator> make(DifferentialEquation& problem, double tolerance, double step) {
  if constexpr (std::is_constructible_v<Method, DifferentialEquation&, double, double>) {
    return std::make_unique<Method>(problem, tolerance, step);
  } else {
    auto* loops = dynamic_cast<ConstrainedEquation*>(&problem);
    return loops == nullptr ? nullptr : std::make_unique<Method>(*loops, tolerance, step);
  }
}

}  // namespace

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
    return make<type>(problem, tolerance, step);
#include "scene/integrators.inc"
#undef KOPPEL_INTEGRATOR
  }
  return nullptr;
}

}  // namespace koppel

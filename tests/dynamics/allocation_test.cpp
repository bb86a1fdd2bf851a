// Simulating allocates nothing from step to step: shown by counting what this thread asks of malloc.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "../allocations.hpp"
#include "simulated.hpp"

namespace koppel::test {
namespace {

struct Way {
  const char* scene;
  IntegratorKind integrator;
};

/// Where coordinates are not chosen anew. What SUNDIALS asks for is its own.
TEST(Allocation, DoesNotHappenInSteps) {
  for (const auto& [name, integrator] :
       {Way{"double_pendulum", IntegratorKind::dormand_prince}, Way{"fourbar_free", IntegratorKind::dormand_prince},
        Way{"fourbar_free", IntegratorKind::dop853}, Way{"fourbar_free", IntegratorKind::classical},
        Way{"fourbar_free", IntegratorKind::semi_implicit}, Way{"fourbar_free", IntegratorKind::generalised_alpha},
        Way{"stewart_free", IntegratorKind::dormand_prince}, Way{"governor", IntegratorKind::classical},
        Way{"car_axis", IntegratorKind::dormand_prince}}) {
    const bool fixed = integrators()[static_cast<std::size_t>(integrator)].control == StepControl::step;
    SCOPED_TRACE(std::string(name) + " by " + std::string(integrators()[static_cast<std::size_t>(integrator)].name));
    Simulated run(scene(name), by(integrator, fixed ? 0.0 : 1e-6, fixed ? 1e-4 : 0.0, 0.2));
    run.to(0.05);  // warm
    const std::uint64_t before = run.simulation->summary().steps;
    bool fine = true;
    const int count = allocations_of([&] { fine = run.simulation->advance(0.2, run.state).has_value(); });
    EXPECT_TRUE(fine);
    EXPECT_GT(run.simulation->summary().steps, before);
    EXPECT_EQ(count, 0);
  }
}

}  // namespace
}  // namespace koppel::test

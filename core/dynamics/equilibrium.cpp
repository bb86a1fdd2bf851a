#include "dynamics/equilibrium.hpp"

#include <cmath>
#include <optional>

#include "dynamics/rest_search.hpp"

namespace koppel {
namespace {

/// Writes down where the statics stand.
void describe(const Mechanism& mechanism, Statics& statics, const RestSearch& search, const Eigen::VectorXd& start,
              Equilibrium& result) {
  result.q = statics.q();
  result.v = statics.v();
  result.internal = statics.states();
  result.independent = statics.motion().independent();
  result.residual = search.residual();
  result.force_scale = search.force_scale();
  result.coordinate_error = search.error();
  result.unrest = statics.unrest();
  const Eigen::Index f = statics.freedoms();
  result.force = search.r().head(f).cwiseQuotient(statics.scale());
  if (f > 0) {
    Eigen::Index worst = 0;
    search.r().head(f).cwiseAbs().maxCoeff(&worst);
    result.worst = result.independent[static_cast<std::size_t>(worst)];
    result.worst_force = result.force[worst];
  }
  Eigen::VectorXd change(mechanism.nv);
  difference(mechanism, start, result.q, change);
  result.moved = 0.0;
  for (std::uint32_t i = 0; i < mechanism.nv; ++i) {
    const double moved = std::abs(change[i]) / mechanism.rate_scale[i];
    if (moved <= result.moved) continue;
    result.moved = moved;
    result.moved_most = i;
  }
}

}  // namespace

Result<Equilibrium> find_equilibrium(std::shared_ptr<const Mechanism> mechanism, const State& state,
                                     const EquilibriumOptions& options) {
  KOPPEL_TRY(Inertias bodies, inertias(*mechanism));
  const Mechanism& m = *mechanism;
  Statics statics(mechanism, std::move(bodies), state.time, options.moving);
  Equilibrium result;
  result.time = state.time;
  result.moving = options.moving;
  const auto stopped = [&]() -> Error {
    if (statics.motion().obstacle() == Obstacle::plugin) return plugin_error(statics.motion());
    return make_error(Code::no_equilibrium, statics.motion().culprit(),
                      "the forces cannot be evaluated at the start and beside it: the loops are at a singular position",
                      "start from another position");
  };
  if (!statics.stand(state.q, state.internal)) return tl::make_unexpected(stopped());
  const Eigen::VectorXd start = statics.q();
  std::optional<RestSearch> search(std::in_place, m, statics, options.max_iterations);
  const bool by_work = !options.nearest && m.internal_start.size() == 0;
  result.found = by_work ? search->descend() : search->find_root();
  result.why = search->why();
  if (by_work && !result.found && !search->broken()) {
    // Perhaps there is one that the forces do not push it to.
    result.iterations = search->iterations();
    describe(m, statics, *search, start, result);
    if (!statics.stand(state.q, state.internal)) return tl::make_unexpected(stopped());
    search.emplace(m, statics, options.max_iterations);
    result.found = search->find_root();
  }
  if (search->broken()) return tl::make_unexpected(stopped());
  result.iterations += search->iterations();
  describe(m, statics, *search, start, result);
  Eigen::VectorXd r;
  if (result.found) {
    if (!find_stiffness(m, statics, result.force_scale, result.stiffness)) return tl::make_unexpected(stopped());
  }
  if (!statics.evaluate(Eigen::VectorXd::Zero(statics.size()), r) || !statics.potential(result.energy)) {
    return tl::make_unexpected(stopped());
  }
  return result;
}

const Input* take_place(const Mechanism& mechanism, const Equilibrium& equilibrium, State& state) {
  const Input* failed = set_time(mechanism, equilibrium.time, state);
  if (failed != nullptr) return failed;
  state.q = equilibrium.q;
  state.v = equilibrium.v;
  state.a.setZero();
  state.internal = equilibrium.internal;
  state.stage = Stage::velocities;
  if (!equilibrium.moving) {
    state.input_rate.setZero();
    state.input_acceleration.setZero();
    state.stage = Stage::accelerations;
  }
  state.history.time = equilibrium.time;
  state.history.step = 0.0;
  state.history.sides[0] = 0;
  return nullptr;
}

}  // namespace koppel

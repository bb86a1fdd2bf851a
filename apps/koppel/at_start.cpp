#include "koppel/at_start.hpp"

namespace koppel::app {

AtStart at_start(const Model& model) {
  AtStart result;
  result.motion = start(model);
  koppel_state* state = result.motion.state.get();
  koppel_work* work = result.motion.work.get();
  koppel_status& status = result.status;
  status = koppel_state_set_time(state, 0.0, &result.error);
  if (status >= 0) status = koppel_close(state, work, nullptr, &result.report, &result.error);
  result.closed = status >= 0;
  if (status >= 0) status = koppel_velocities(state, work, &result.error);
  if (status >= 0) status = koppel_accelerations(state, work, &result.error);
  // The counts are told of an open position too: they may be the reason.
  auto analysis = sized<koppel_analysis>();
  const koppel_status analysed = koppel_analyse(state, work, &analysis, status >= 0 ? &result.error : nullptr);
  if (analysed >= 0) result.analysis = analysis;
  if (status >= 0 && analysed < 0) status = analysed;
  return result;
}

koppel_status close_at(const Motion& motion, double time, koppel_error& error) {
  if (!motion.state || !motion.work) return KOPPEL_NO_MEMORY;
  auto report = sized<koppel_report>();
  koppel_status status = koppel_close(motion.state.get(), motion.work.get(), nullptr, &report, &error);
  if (status >= 0 && time != 0.0) {
    status = koppel_move(motion.state.get(), motion.work.get(), time, &report, &error);
  }
  return status;
}

}  // namespace koppel::app

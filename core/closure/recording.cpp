#include "closure/recording.hpp"

#include <limits>

#include "closure/close.hpp"
#include "mechanism/records.hpp"

namespace koppel {
namespace {

/// The state with this input moving at the rate one, and nothing else.
koppel_status move_by_one(Work& work, const State& state, std::uint32_t input) {
  const Mechanism& mechanism = *work.mechanism;
  State& moved = *work.by_one;
  moved = state;
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    moved.input[static_cast<Eigen::Index>(i)] = state.q[mechanism.inputs[i].q];
  }
  moved.input_rate.setZero();
  moved.input_acceleration.setZero();
  moved.input_rate[input] = 1.0;
  moved.stage = Stage::closed;
  for (const auto step : {velocities, accelerations}) {
    if (const koppel_status status = step(work, moved); status < 0) return status;
  }
  return KOPPEL_OK;
}

void set_not_a_number(const Mechanism& mechanism, const CoordinateReference& by, double* values) {
  for (std::size_t i = 0; i < mechanism.record_columns.size(); ++i) {
    if (mechanism.records[mechanism.record_columns[i].record].by != by) continue;
    values[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

koppel_status evaluate_recording(Work& work, const State& state, const Loads* loads, double* values) {
  const Mechanism& mechanism = *work.mechanism;
  if (!realise(work, state)) return KOPPEL_PLUGIN;
  evaluate_records(mechanism, state, work.equations.kinematics, loads, std::nullopt, values);
  if (mechanism.record_inputs.empty()) return KOPPEL_OK;
  if (!is_closed(mechanism, state)) return KOPPEL_INVALID_ARGUMENT;
  if (!work.by_one) work.by_one = std::make_unique<State>(mechanism);
  for (const std::uint32_t input : mechanism.record_inputs) {
    const CoordinateReference by = mechanism.inputs[input].of;
    const koppel_status status = move_by_one(work, state, input);
    if (status == KOPPEL_SINGULAR) {
      set_not_a_number(mechanism, by, values);
      continue;
    }
    if (status < 0) return status;
    if (!realise(work, *work.by_one)) return KOPPEL_PLUGIN;
    evaluate_records(mechanism, *work.by_one, work.equations.kinematics, loads, by, values);
  }
  return KOPPEL_OK;
}

}  // namespace koppel

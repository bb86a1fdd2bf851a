#include "koppel/global_error.hpp"

#include <algorithm>
#include <cmath>

namespace koppel::app {

GlobalError::GlobalError(const Model& model) : motion_(start(model)) {
  const std::size_t n = model.sizes().coordinates;
  coarse_.resize(n);
  fine_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    weights_.push_back(model.unit(KOPPEL_KIND_COORDINATE, i) == "m" ? 1.0 / model.settings().length : 1.0);
  }
}

koppel_status GlobalError::begin(const koppel_state* state, const koppel_simulation* simulation,
                                 koppel_simulation_options how, koppel_error& error) {
  if (!motion_.state) return KOPPEL_NO_MEMORY;
  auto used = sized<koppel_simulation_summary>();
  koppel_simulation_summarise(simulation, &used);
  const std::string name = text_of([&](char* text, std::size_t size, std::size_t* needed) {
    return koppel_simulation_integrator(simulation, text, size, needed);
  });
  how.integrator = name.c_str();
  how.tolerance = used.tolerance / 10.0;
  how.step = used.step / 2.0;
  is_fixed_ = used.step > 0.0;
  koppel_simulation* finer = nullptr;
  koppel_status status = koppel_state_copy(state, motion_.state.get());
  if (status >= 0) status = koppel_simulation_create(state, &how, &finer, &error);
  finer_.reset(finer);
  return status;
}

koppel_status GlobalError::compare(const koppel_state* state, double time, koppel_error& error) {
  const double before = koppel_simulation_time(finer_.get());
  // Fixed steps end at what is asked for, so that rows closer than the step would make both take the same ones.
  koppel_status status = KOPPEL_OK;
  if (is_fixed_ && time > before) {
    status = koppel_simulation_advance(finer_.get(), 0.5 * (before + time), motion_.state.get(), &error);
  }
  if (status >= 0) status = koppel_simulation_advance(finer_.get(), time, motion_.state.get(), &error);
  if (status < 0) return status;
  koppel_state_get(state, KOPPEL_Q, coarse_.data(), coarse_.size());
  koppel_state_get(motion_.state.get(), KOPPEL_Q, fine_.data(), fine_.size());
  last_ = 0.0;
  for (std::size_t i = 0; i < coarse_.size(); ++i) {
    last_ = std::max(last_, weights_[i] * std::abs(coarse_[i] - fine_[i]));
  }
  greatest_ = std::max(greatest_, last_);
  return status;
}

}  // namespace koppel::app

#include "suspension/sweep.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace koppel::app {
namespace {

constexpr double speed = 0.1;            // [m/s]
constexpr std::size_t repetitions = 21;  // of each step, for the median of its time

class Sweep {
 public:
  Sweep(const Model& model, const SweepOptions& options, koppel_stream* stream)
      : model_(model), options_(options), stream_(stream), motion_(start(model)), before_(start(model).state) {
    result_.speed = speed;
  }

  SweepResult run() {
    if (!good(find(KOPPEL_KIND_INPUT, options_.input, input_)) ||
        !good(find(KOPPEL_KIND_FRAME, options_.frame, frame_))) {
      return std::move(result_);
    }
    const int half = std::max(1, static_cast<int>(std::lround(options_.travel / options_.spacing)));
    for (int i = 0; i > -half; --i) {
      if (!move(i, -speed)) return std::move(result_);
    }
    for (int i = -half; i <= half; ++i) {
      if (!move(i, speed) || !take_row(i)) return std::move(result_);
    }
    result_.design = static_cast<std::size_t>(half);
    return std::move(result_);
  }

 private:
  bool good(koppel_status status) {
    if (status < 0) result_.outcome = exit_of(status);
    return status >= 0;
  }

  koppel_status find(std::int32_t kind, const std::string& name, std::size_t& index) {
    return koppel_mechanism_find(model_.mechanism.get(), kind, name.c_str(), &index, &result_.error);
  }

  /// One position, by the way a host takes that sets its inputs by hand.
  koppel_status solve(double travel, double rate) {
    koppel_state* state = motion_.state.get();
    koppel_work* work = motion_.work.get();
    koppel_status status = koppel_state_set_input(state, input_, travel, rate, 0.0);
    if (status >= 0) status = koppel_close(state, work, nullptr, &report_, &result_.error);
    if (status >= 0) status = koppel_velocities(state, work, &result_.error);
    if (status >= 0) status = koppel_accelerations(state, work, &result_.error);
    return status;
  }

  /// The same step several times over, from the same start; all give the same state.
  bool move(int row, double rate) {
    using Clock = std::chrono::steady_clock;
    const double time = static_cast<double>(positions_) * options_.spacing / speed;
    if (!good(koppel_state_set_time(motion_.state.get(), time, &result_.error))) return false;
    if (!good(koppel_state_copy(motion_.state.get(), before_.get()))) return false;
    std::vector<double> seconds;
    for (std::size_t i = 0; i < repetitions; ++i) {
      koppel_state_copy(before_.get(), motion_.state.get());
      const Clock::time_point begin = Clock::now();
      if (!good(solve(row * options_.spacing, rate))) return false;
      seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
    }
    std::nth_element(seconds.begin(), seconds.begin() + repetitions / 2, seconds.end());
    seconds_ = seconds[repetitions / 2];
    ++positions_;
    return !stream_ || good(koppel_stream_publish(stream_, motion_.state.get(), motion_.work.get(), &report_));
  }

  bool take_row(int index) {
    const std::size_t frames = model_.sizes().frames;
    std::vector<double> twists(6 * frames);
    Row row;
    row.travel = index * options_.spacing;
    row.report = report_;
    row.seconds = seconds_;
    row.poses.resize(12 * frames);
    koppel_state* state = motion_.state.get();
    koppel_work* work = motion_.work.get();
    if (!good(koppel_poses(state, work, KOPPEL_KIND_FRAME, row.poses.data(), row.poses.size())) ||
        !good(koppel_twists(state, work, KOPPEL_KIND_FRAME, twists.data(), twists.size()))) {
      return false;
    }
    const double* pose = row.poses.data() + 12 * frame_;
    result_.side = pose[10] < 0.0 ? -1.0 : 1.0;
    row.wheel = wheel_of(pose, twists.data() + 6 * frame_, result_.side, options_.radius);
    result_.rows.push_back(std::move(row));
    return true;
  }

  const Model& model_;
  const SweepOptions& options_;
  koppel_stream* stream_;
  Motion motion_;
  State before_;
  std::size_t input_ = 0;
  std::size_t frame_ = 0;
  std::size_t positions_ = 0;
  koppel_report report_ = sized<koppel_report>();
  double seconds_ = 0.0;
  SweepResult result_;
};

}  // namespace

SweepResult sweep(const Model& model, const SweepOptions& options, koppel_stream* stream) {
  return Sweep(model, options, stream).run();
}

}  // namespace koppel::app

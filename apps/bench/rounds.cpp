#include "bench/rounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <unistd.h>

namespace koppel::app::bench {
namespace {

constexpr std::size_t fewest = 3;  // repeats

}  // namespace

double median(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  const std::size_t half = sample.size() / 2;
  return sample.size() % 2 == 1 ? sample[half] : 0.5 * (sample[half - 1] + sample[half]);
}

void progress(const std::string& text, bool lasting) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) {
    std::fprintf(stderr, "\r\033[K%.100s%s", text.c_str(), lasting ? "\n" : "");
  } else if (lasting) {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
}

void Rounds::add(std::string label, Json::json_pointer place, std::function<double()> once, double first) {
  const bool few = first > longest_;
  tasks_.push_back({std::move(label), std::move(place), std::move(once), {}, few});
  if (few) tasks_.back().seconds = {first};
}

double Rounds::time(const Task& task) const {
  constexpr std::size_t most = 1000;
  double best = std::numeric_limits<double>::infinity();
  const Stopwatch watch;
  for (std::size_t i = 0; i < most; ++i) {
    const double seconds = task.once();
    if (std::isnan(seconds)) return seconds;
    best = std::min(best, seconds);
    if (watch.seconds() > budget_ && (i + 1 >= fewest || seconds > budget_)) break;
  }
  return best;
}

void Rounds::run(Json& document) {
  for (std::size_t round = 1; round <= count_; ++round) {
    const Stopwatch watch;
    const std::string where = std::string("round ") + std::to_string(round) + " of " + std::to_string(count_);
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      if (tasks_[i].few && tasks_[i].seconds.size() >= fewest) continue;
      progress(where + ", " + std::to_string(i + 1) + " of " + std::to_string(tasks_.size()) + ": " + tasks_[i].label);
      tasks_[i].seconds.push_back(time(tasks_[i]));
    }
    progress(where + ": " + std::to_string(tasks_.size()) + " items timed in " +
                 std::to_string(std::lround(watch.seconds())) + " s",
             true);
  }
  for (const Task& task : tasks_) document.at(task.place)["seconds"] = summary(task.seconds);
}

Json summary(const std::vector<double>& seconds) {
  if (seconds.empty() || std::any_of(seconds.begin(), seconds.end(), [](double s) { return !(s > 0); })) return nullptr;
  const auto [least, greatest] = std::minmax_element(seconds.begin(), seconds.end());
  return {{"median", median(seconds)}, {"least", *least}, {"greatest", *greatest}, {"repeats", seconds.size()}};
}

}  // namespace koppel::app::bench

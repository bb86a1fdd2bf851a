// Times by rounds: each round goes through all that is to be timed, so that the spread over the rounds tells how much
// the machine itself wavered meanwhile.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace koppel::app::bench {

using Json = nlohmann::ordered_json;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

class Rounds {
 public:
  /// In each of `count` rounds, each thing is done three times, and again until it has taken `budget` [s]; what takes
  /// longer than that, once. What takes longer than `longest` [s] is left out after the first few rounds.
  Rounds(std::size_t count, double budget, double longest) : count_(count), budget_(budget), longest_(longest) {}

  /// once() does it once and returns its time [s], NaN if it failed; the least within a round is that of the round:
  /// what else the machine does can only add to it. The object at `place` of the document gets "seconds" in the end:
  /// median, least and greatest of the rounds. first: its time when it was done before; if that is more than `longest`,
  /// it counts as a round, and two more follow: three repeats.
  void add(std::string label, Json::json_pointer place, std::function<double()> once, double first = 0.0);
  /// Tells its progress on standard error.
  void run(Json& document);

  std::size_t count() const { return count_; }

 private:
  struct Task {
    std::string label;
    Json::json_pointer place;
    std::function<double()> once;
    std::vector<double> seconds;
    bool few = false;  ///< three repeats, not one for each round
  };

  double time(const Task& task) const;

  std::size_t count_;
  double budget_, longest_;
  std::vector<Task> tasks_;
};

/// Of a sample that is not empty.
double median(std::vector<double> sample);
/// Times as they stand in the document; null if one failed.
Json summary(const std::vector<double>& seconds);

/// One line on standard error that replaces the one before it on a terminal; elsewhere only lines with `lasting` stand.
void progress(const std::string& text, bool lasting = false);

}  // namespace koppel::app::bench

#include "bench/compare.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "bench/tables.hpp"

namespace koppel::app::bench {
namespace {

constexpr double time_margin = 1.25;  // beyond the spread of both
constexpr double error_margin = 2.0;  // of an error at the same setting
constexpr double exact = 1e-13;       // below it errors of closures are rounding, which may fall this way or that

/// What two documents are compared by.
struct Figure {
  Json seconds, error;
  bool failed = false;
  double floor = 0.0;  ///< errors below it are all alike
};

using Figures = std::map<std::string, Figure>;

std::string word(const Json& object, const char* key) { return object.at(key).get<std::string>(); }

void take_simulations(Figures& all, const Json& document) {
  for (const Json& problem : document.at("simulations")) {
    for (const Json& series : problem.at("series")) {
      if (series.at("engine") != "koppel") continue;
      for (const Json& point : series.at("points")) {
        const std::string item = "simulation/" + word(problem, "name") + ", " + word(series, "method") + ", " +
                                 word(series, "setting") + ' ' + point.at("setting").dump();
        all[item] = {point.value("seconds", Json()), point.value("error", Json()), !point.at("finished").get<bool>()};
      }
    }
  }
}

void take_closures(Figures& all, const Json& document) {
  for (const Json& scene : document.at("closures")) {
    for (const Json& way : scene.at("ways")) {
      all["closure/" + word(scene, "name") + ", " + word(way, "way")] = {
          way.value("seconds", Json()), way.at("coordinate_error"), way.at("failed").get<double>() > 0.0, exact};
    }
  }
}

void take_scaling(Figures& all, const Json& document) {
  for (const Json& chain : document.at("scaling")) {
    for (const Json& point : chain.at("points")) {
      const std::string item = "scaling/" + word(chain, "name") + " of " + point.at("size").dump();
      all[item] = {point.value("seconds", Json()), point.value("error", Json()), !point.at("finished").get<bool>(),
                   exact};
      all[item + ", compiling"] = {point.at("compiling").value("seconds", Json()), Json()};
    }
  }
}

Figures figures_of(const Json& document) {
  Figures all;
  take_simulations(all, document);
  take_closures(all, document);
  take_scaling(all, document);
  for (const Json& hard : document.at("cases")) {
    all["case/" + word(hard, "name")] = {Json(), Json(), !hard.at("pass").get<bool>()};
  }
  return all;
}

/// The changes as they are found.
class Changes {
 public:
  /// machine: how many times as long the yardstick takes now.
  explicit Changes(double machine) : slow_(std::max(1.0, machine)), fast_(std::min(1.0, machine)) {}

  void outcome(const std::string& item, const Figure& old, const Figure& now) {
    if (old.failed == now.failed) return;
    const auto told = [](bool failed) { return std::string(failed ? "failed" : "succeeded"); };
    add(item, "outcome", told(old.failed), told(now.failed), old.failed,
        item + ": " + told(old.failed) + ", now " + told(now.failed));
  }

  void error(const std::string& item, const Figure& old, const Figure& now) {
    if (!old.error.is_number() || !now.error.is_number()) return;
    const double before = std::max(old.error.get<double>(), now.floor),
                 after = std::max(now.error.get<double>(), now.floor);
    const bool worse = after > error_margin * before;
    if (!worse && !(before > error_margin * after)) return;
    add(item, "error", old.error, now.error, !worse,
        item + ": error " + in_powers(old.error) + ", now " + in_powers(now.error));
  }

  void time(const std::string& item, const Figure& old, const Figure& now) {
    if (!old.seconds.is_object() || !now.seconds.is_object()) return;
    const auto part = [](const Figure& figure, const char* key) { return figure.seconds.at(key).get<double>(); };
    const bool slower = part(now, "least") > time_margin * slow_ * part(old, "greatest");
    const bool faster = time_margin * part(now, "greatest") < fast_ * part(old, "least");
    if (!slower && !faster) return;
    add(item, "time", old.seconds.at("median"), now.seconds.at("median"), faster,
        item + ": " + median_of(old.seconds) + ", now " + median_of(now.seconds));
  }

  Json list() const { return list_; }
  /// How many of times, or of errors and outcomes, went one way.
  std::size_t count(bool times, bool better) const {
    return static_cast<std::size_t>(std::count_if(list_.begin(), list_.end(), [&](const Json& change) {
      return (change["what"] == "time") == times && change["better"].get<bool>() == better;
    }));
  }

 private:
  void add(const std::string& item, const char* what, const Json& old, const Json& now, bool better,
           const std::string& text) {
    list_.push_back({{"item", item}, {"what", what}, {"old", old}, {"now", now}, {"better", better}, {"text", text}});
  }

  double slow_, fast_;
  Json list_ = Json::array();
};

double yardstick_of(const Json& document) {
  const Json::json_pointer place("/machine/yardstick/seconds/median");
  return document.contains(place) ? document.at(place).get<double>() : 1.0;
}

}  // namespace

Json compare(const Json& old, const Json& now) {
  const Figures before = figures_of(old), after = figures_of(now);
  const double machine = yardstick_of(now) / yardstick_of(old);
  Changes changes(machine);
  std::size_t compared = 0;
  for (const auto& [item, figure] : after) {
    const auto then = before.find(item);
    if (then == before.end()) continue;
    ++compared;
    changes.outcome(item, then->second, figure);
    changes.error(item, then->second, figure);
    changes.time(item, then->second, figure);
  }
  return {{"old", old.at("started")},
          {"compared", compared},
          {"machine", machine},
          {"worse", changes.count(false, false)},
          {"better", changes.count(false, true)},
          {"slower", changes.count(true, false)},
          {"faster", changes.count(true, true)},
          {"changes", changes.list()}};
}

}  // namespace koppel::app::bench

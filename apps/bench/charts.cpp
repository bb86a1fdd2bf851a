// Which charts a document has.
#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/page.hpp"
#include "bench/tables.hpp"

namespace koppel::app::bench {
namespace {

constexpr double rounding = 1e-16;  // where an error of 0 stands on a logarithmic axis

/// Time of a member of the document over what `x` is; nothing if it was not timed.
void add_dot(Line& line, double x, const Json& timed, bool bound, const std::string& note) {
  if (!timed.contains("seconds") || !timed["seconds"].is_object()) return;
  const Json& seconds = timed["seconds"];
  const double median = seconds["median"].get<double>();
  const std::string times = in_seconds(seconds["median"]) + " (" + in_seconds(seconds["least"]) + " to " +
                            in_seconds(seconds["greatest"]) + ", " + seconds["repeats"].dump() + " repeats)";
  line.dots.push_back({x, median, seconds["least"].get<double>(), seconds["greatest"].get<double>(), bound,
                       line.name + "\n" + note + "\n" + times});
}

std::string label_of(const Json& series) {
  return series["engine"].get<std::string>() + ", " + series["method"].get<std::string>();
}

Chart simulation(const Json& problem) {
  Chart chart{problem["name"].get<std::string>() + ", " + problem["end"].dump() + " s",
              "error at the end, better to the right",
              "time [s]",
              {}};
  for (const Json& series : problem["series"]) {
    Line line{label_of(series), {}, true};
    for (const Json& point : series["points"]) {
      if (!point["finished"].get<bool>() || !point["error"].is_number()) continue;
      const bool bound = point["bound"].get<bool>() || point["error"].get<double>() < rounding;
      const std::string setting = series["setting"].get<std::string>() + " " + point["setting"].dump();
      add_dot(line, std::max(point["error"].get<double>(), rounding), point, bound,
              setting + ", error " + (bound ? "below " : "") + in_powers(point["error"]));
    }
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

/// One line for each way, its dots are the scenes.
Chart closures(const Json& document) {
  Chart chart{"closures", "estimated error of a coordinate, better to the right", "time [s]", {}};
  for (const Json& scene : document["closures"]) {
    for (const Json& way : scene["ways"]) {
      const std::string name = way["way"].get<std::string>();
      auto line = std::find_if(chart.lines.begin(), chart.lines.end(), [&](const Line& l) { return l.name == name; });
      if (line == chart.lines.end()) line = chart.lines.insert(line, {name, {}, false});
      if (!way["coordinate_error"].is_number()) continue;
      const double error = way["coordinate_error"].get<double>();
      add_dot(*line, std::max(error, rounding), way, error < rounding,
              scene["name"].get<std::string>() + ", error " + in_powers(way["coordinate_error"]) + ", residual " +
                  in_powers(way["residual"]));
    }
  }
  return chart;
}

Chart scaling(const Json& document) {
  Chart chart{"growing chains", "size", "time [s]", {}, true};
  for (const Json& chain : document["scaling"]) {
    Line line{chain["name"].get<std::string>() + ": " + chain["title"].get<std::string>(), {}, true};
    for (const Json& point : chain["points"]) {
      add_dot(line, point["size"].get<double>(), point, false,
              "size " + point["size"].dump() + ", error " + in_powers(point.value("error", Json())));
    }
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

Chart memory(const Json& document) {
  Chart chart{"memory of growing chains", "size", "held, ready to move [bytes]", {}, true};
  for (const Json& chain : document["scaling"]) {
    Line line{chain["name"].get<std::string>(), {}, true};
    for (const Json& point : chain["points"]) {
      const Json bytes = point.value("memory", Json());
      if (!bytes.is_number()) continue;
      const auto y = bytes.get<double>();
      line.dots.push_back(
          {point["size"].get<double>(), y, y, y, false,
           line.name + "\nsize " + point["size"].dump() + "\n" + std::to_string(std::lround(y / 1e3)) + " kB"});
    }
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

bool empty(const Chart& chart) {
  return std::all_of(chart.lines.begin(), chart.lines.end(), [](const Line& line) { return line.dots.empty(); });
}

}  // namespace

std::vector<NamedChart> charts(const Json& document) {
  std::vector<NamedChart> all;
  const auto add = [&all](const std::string& name, const std::string& section, Chart chart) {
    if (!empty(chart)) all.push_back({name, section, std::move(chart)});
  };
  for (const Json& problem : document["simulations"])
    add(problem["name"].get<std::string>(), "simulations", simulation(problem));
  add("closures", "closures", closures(document));
  add("scaling", "scaling", scaling(document));
  add("memory", "scaling", memory(document));
  return all;
}

std::vector<File> plots(const Json& document) {
  std::vector<File> files;
  for (const NamedChart& named : charts(document)) files.push_back({named.name + ".svg", draw(named.chart, true)});
  return files;
}

}  // namespace koppel::app::bench

#include "bench/peers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include <unistd.h>

namespace koppel::app::bench {
namespace {

/// What is known of engines, whether their programs were built or not.
struct Known {
  const char* name;
  const char* package;
};
constexpr Known known[] = {{"simbody", "libsimbody-dev"}, {"mujoco", "libmujoco-dev"}, {"dart", "libdart-dev"}};

/// No figure of an engine counts unless one of its ends is at least as near as this to the reference.
constexpr double same_motion = 1e-2;

struct Close {
  void operator()(std::FILE* pipe) const { pclose(pipe); }
};

/// What a program prints, as JSON; discarded if it fails.
Json answer(const std::string& program, const std::vector<std::string>& arguments) {
  std::string command = '\'' + program + '\'';
  for (const std::string& argument : arguments) command.append(" '").append(argument).append("'");
  command += " 2>/dev/null";
  const std::unique_ptr<std::FILE, Close> pipe(popen(command.c_str(), "r"));
  if (!pipe) return Json(Json::value_t::discarded);
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe.get())) text.append(part.data(), size);
  return Json::parse(text, nullptr, false);
}

std::string exact(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

std::string rough(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1e", value);
  return text.data();
}

/// Where an engine comes to by a method and a setting; discarded if it does not.
Json end_of(const std::string& program, const Problem& problem, const std::string& method, double setting) {
  return answer(program, {problem.name, exact(problem.end), method, exact(setting)});
}

/// Greatest difference from the reference of those quantities that the engine knows; NaN if it knows none.
double error_of(const Json& values, const Trial& trial, const Reference& reference) {
  double error = not_a_number;
  for (std::size_t i = 0; i < reference.names.size(); ++i) {
    const auto found = values.find(reference.names[i]);
    if (found == values.end()) continue;
    const double off = std::abs(found->get<double>() / trial.scale(reference.names[i]) - reference.values[i]);
    if (!(off <= error)) error = off;
  }
  return error;
}

/// All settings of a method, from coarse to fine until one takes too long.
void add_method(Bench& bench, const Problem& problem, const Trial& trial, const Reference& reference,
                const Json::json_pointer& place, Json& peer, const Json& method) {
  const double longest = bench.plan.quick ? 0.3 : 5.0;
  const std::string program = peer["program"];
  const std::string name = method["method"];
  Json series = {
      {"engine", peer["engine"]}, {"method", name}, {"setting", method["setting"]}, {"points", Json::array()}};
  std::vector<std::pair<double, double>> timed;  // setting and first time of each point that finished
  double best = std::numeric_limits<double>::infinity();
  for (const Json& value : method["values"]) {
    const auto setting = value.get<double>();
    const Json end = end_of(program, problem, name, setting);
    if (!end.is_object()) {
      series["points"].push_back({{"setting", setting}, {"finished", false}, {"why", "it did not get to the end"}});
      timed.emplace_back(setting, not_a_number);
      continue;
    }
    const double error = error_of(end["values"], trial, reference);
    const bool bound = error <= reference.uncertainty;
    best = std::min(best, error);
    series["points"].push_back(
        {{"setting", setting}, {"finished", true}, {"error", bound ? reference.uncertainty : error}, {"bound", bound}});
    timed.emplace_back(setting, end["seconds"].get<double>());
    if (timed.back().second > longest) break;
  }
  if (!(best < same_motion)) {
    const std::string nearest =
        std::isfinite(best) ? "comes no nearer to the reference than " + rough(best) : "does not get to the end";
    peer["left_out"].push_back(problem.name + ", " + name + ": " + nearest);
    return;
  }
  Json& all = bench.document.at(place);
  all.push_back(std::move(series));
  const Json::json_pointer points = place / (all.size() - 1) / "points";
  for (std::size_t i = 0; i < timed.size(); ++i) {
    if (std::isnan(timed[i].second)) continue;
    bench.rounds.add(
        problem.name + ", " + peer["engine"].get<std::string>() + ", " + name, points / i,
        [program, &problem, name, setting = timed[i].first] {
          const Json end = end_of(program, problem, name, setting);
          return end.is_object() ? end["seconds"].get<double>() : not_a_number;
        },
        timed[i].second);
  }
}

}  // namespace

void ask_peers(Bench& bench) {
  bench.document["peers"] = Json::array();
  for (const Known& engine : known) {
    const std::string program = bench.plan.peers + "/koppel_peer_" + engine.name;
    const Json can = answer(program, {});
    Json entry = {{"name", engine.name}, {"found", can.is_object()}};
    if (can.is_object()) {
      entry["program"] = program;
      entry["left_out"] = Json::array();
      entry.update(can);
    } else {
      entry["help"] = std::string("apt-get install ") + engine.package + ", then configure and build koppel anew";
    }
    bench.document["peers"].push_back(std::move(entry));
  }
}

void add_peers(Bench& bench, const Problem& problem, const Trial& trial, const Reference& reference,
               const Json::json_pointer& place) {
  if (!bench.document.contains("peers")) return;
  for (Json& peer : bench.document["peers"]) {
    const Json problems = peer.value("problems", Json::array());
    if (std::find(problems.begin(), problems.end(), problem.name) == problems.end()) continue;
    progress(problem.name + ", " + peer["engine"].get<std::string>());
    for (const Json& method : peer["methods"]) add_method(bench, problem, trial, reference, place, peer, method);
  }
}

}  // namespace koppel::app::bench

#include "bench/bench.hpp"

#include <algorithm>
#include <ctime>

#include "bench/cases.hpp"
#include "bench/machine.hpp"
#include "bench/peers.hpp"
#include "bench/problems.hpp"

namespace koppel::app::bench {
namespace {

std::string now() {
  const std::time_t time = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&time));
  return text;
}

Bench prepared(const Plan& plan) {
  Bench bench{plan, {}, plan.quick ? Rounds(3, 2e-3, 0.2) : Rounds(5, 20e-3, 3.0)};
  bench.document = {{"schema", "koppel-bench/1"},      {"quick", plan.quick}, {"started", now()}, {"seconds", nullptr},
                    {"repeats", bench.rounds.count()}, {"machine", machine()}};
  bench.document["machine"]["load"] = {{"before", load()}, {"after", nullptr}};
  bench.document["machine"]["yardstick"] = Json::object();
  for (const char* section : {"simulations", "closures", "scaling", "cases", "profiles"})
    bench.document[section] = Json::array();
  return bench;
}

}  // namespace

bool Bench::wants(const std::string& section, const std::string& name) const {
  const auto meant = [&](const std::string& text) {
    return text == section || text == name || text == section + '/' + name;
  };
  return plan.names.empty() || std::any_of(plan.names.begin(), plan.names.end(), meant);
}

Json::json_pointer Bench::entry(const std::string& section, Json data) {
  Json& list = document.at(section);
  list.push_back(std::move(data));
  return Json::json_pointer("/" + section) / (list.size() - 1);
}

std::vector<std::string> all_names(const Plan& plan) {
  std::vector<std::string> names;
  for (const Problem& problem : problems()) names.push_back("simulation/" + problem.name);
  for (const std::string& scene : closure_scenes(plan.scenes)) names.push_back("closure/" + scene);
  for (const std::string& name : scaling_names()) names.push_back("scaling/" + name);
  for (const Case& hard : cases()) names.push_back("case/" + hard.name);
  for (const std::string& scene : closure_scenes(plan.scenes)) names.push_back("profile/" + scene);
  for (const Problem& problem : problems()) names.push_back("profile/" + problem.name);
  return names;
}

Json run(const Plan& plan) {
  const Stopwatch watch;
  Bench bench = prepared(plan);
  if (!plan.peers.empty()) ask_peers(bench);
  add_simulations(bench);
  add_closures(bench);
  add_scaling(bench);
  add_cases(bench);
  add_profiles(bench);
  bench.rounds.add("yardstick", Json::json_pointer("/machine/yardstick"), yardstick);
  bench.rounds.run(bench.document);
  bench.document["machine"]["load"]["after"] = load();
  bench.document["seconds"] = watch.seconds();
  return std::move(bench.document);
}

}  // namespace koppel::app::bench

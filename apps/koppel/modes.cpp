// koppel modes SCENE
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/ioctl.h>
#include <unistd.h>

#include "koppel/command.hpp"
#include "koppel/text_table.hpp"

namespace koppel::app {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::string scene;
  double time = 0.0;
  std::optional<std::uint64_t> most;
  bool all_twins = false;
  bool json = false;
};

struct FoundMode {
  std::string id;
  std::vector<double> q;
  double residual = 0.0;
  bool limit = false;
};

struct Coordinate {
  std::string name, unit;
};

/// What a search has found, or why there was none.
struct Search {
  koppel_status status = KOPPEL_OK;
  koppel_error error = sized<koppel_error>();
  koppel_modes_summary summary = sized<koppel_modes_summary>();
  std::string why;
  std::vector<FoundMode> modes;
};

/// Says on a terminal how far a search is, once it takes long enough for somebody to wonder.
class Progress {
 public:
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  std::int32_t show(std::size_t found, double part) {
    const auto now = Clock::now();
    if (isatty(STDERR_FILENO) == 0 || now - begin_ < std::chrono::milliseconds(500)) return 0;
    if (shown_ && now - last_ < std::chrono::milliseconds(100)) return 0;
    std::fprintf(stderr, "\r\033[Ksearching for %.0f s: %.0f %%, %zu found",
                 std::chrono::duration<double>(now - begin_).count(), 100.0 * part, found);
    std::fflush(stderr);
    shown_ = true;
    last_ = now;
    return 0;
  }

 private:
  Clock::time_point begin_ = Clock::now(), last_;
  bool shown_ = false;
};

std::int32_t show_progress(std::size_t found, double part, void* progress) {
  return static_cast<Progress*>(progress)->show(found, part);
}

FoundMode read_mode(const koppel_modes* modes, std::size_t index, koppel_state* state, std::size_t coordinates) {
  FoundMode found;
  found.id = text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_modes_id(modes, index, buffer, size, needed);
  });
  auto mode = sized<koppel_mode>();
  koppel_modes_get(modes, index, &mode);
  found.residual = mode.residual;
  found.limit = mode.limit != 0;
  found.q.resize(coordinates);
  koppel_modes_take(modes, index, state);
  koppel_state_get(state, KOPPEL_Q, found.q.data(), found.q.size());
  return found;
}

Search search(const Model& model, const Options& options) {
  Search result;
  const Motion motion = start(model);
  if (!motion.state || !motion.work) {
    result.status = KOPPEL_NO_MEMORY;
    return result;
  }
  result.status = koppel_state_set_time(motion.state.get(), options.time, &result.error);
  if (result.status < 0) return result;
  Progress progress;
  auto given = sized<koppel_modes_options>();
  given.most = options.most.value_or(0);
  given.all_twins = options.all_twins ? 1 : 0;
  given.progress = show_progress;
  given.user = &progress;
  koppel_modes* found = nullptr;
  result.status = koppel_modes_find(motion.state.get(), motion.work.get(), &given, &found, &result.error);
  if (result.status < 0) return result;
  const Modes modes(found);
  koppel_modes_summarise(found, &result.summary);
  result.why = text_of([found](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_modes_why(found, buffer, size, needed);
  });
  for (std::size_t i = 0; i < result.summary.count; ++i) {
    result.modes.push_back(read_mode(found, i, motion.state.get(), model.sizes().coordinates));
  }
  return result;
}

/// That there is no mode is a finding like that of a closure that fails.
koppel_error none_found(const Search& found, double time) {
  auto finding = sized<koppel_error>();
  finding.severity = KOPPEL_SEVERITY_ERROR;
  std::snprintf(finding.code, sizeof finding.code, "E0701");
  char missed[96] = "";
  if (found.summary.missed_by > 0.0) {
    std::snprintf(missed, sizeof missed, "; at best a condition stays open by %.3g (scaled to the mechanism's length)",
                  found.summary.missed_by);
  }
  const bool none = found.summary.complete != 0;
  std::snprintf(finding.message, sizeof finding.message, "%s at time %g s%s%s%s%s",
                none ? "there is no closed position" : "no closed position found", time, none ? " (" : ": ",
                found.why.c_str(), none ? ")" : "", missed);
  std::snprintf(finding.advice, sizeof finding.advice,
                none ? "check lengths and inputs: the mechanism does not reach this position"
                     : "`koppel check` tries to close the mechanism from its start values; check lengths and inputs");
  return finding;
}

std::vector<Coordinate> coordinates_of(const Model& model) {
  std::vector<Coordinate> all;
  for (std::size_t i = 0; i < model.sizes().coordinates; ++i) {
    all.push_back({model.name(KOPPEL_KIND_COORDINATE, i), model.unit(KOPPEL_KIND_COORDINATE, i)});
  }
  return all;
}

// ---- the table

bool is_angle(const Coordinate& coordinate) { return coordinate.unit == "rad"; }
/// Of a quaternion or a unit vector.
bool is_component(const Coordinate& coordinate) { return coordinate.unit == "1"; }

bool differ(double a, double b, const Coordinate& coordinate) {
  constexpr double rounding = 1e-9;
  return std::abs(is_angle(coordinate) ? std::remainder(a - b, 2.0 * std::numbers::pi) : a - b) > rounding;
}

bool differs(const std::vector<FoundMode>& modes, std::size_t i, const Coordinate& coordinate) {
  return std::any_of(modes.begin(), modes.end(),
                     [&](const FoundMode& mode) { return differ(mode.q[i], modes.front().q[i], coordinate); });
}

/// Of several columns those first that each tell more modes apart than the ones before it do.
void put_telling_first(std::vector<std::size_t>& columns, const std::vector<Coordinate>& coordinates,
                       const std::vector<FoundMode>& modes) {
  std::vector<std::pair<std::size_t, std::size_t>> alike;  // modes that no column so far tells apart
  for (std::size_t a = 0; a < modes.size(); ++a) {
    for (std::size_t b = a + 1; b < modes.size(); ++b) alike.emplace_back(a, b);
  }
  std::vector<std::size_t> telling, others;
  for (const std::size_t i : columns) {
    const std::size_t told = std::erase_if(alike, [&](const auto& pair) {
      return differ(modes[pair.first].q[i], modes[pair.second].q[i], coordinates[i]);
    });
    (told > 0 ? telling : others).push_back(i);
  }
  columns = std::move(telling);
  columns.insert(columns.end(), others.begin(), others.end());
}

/// What tells the modes apart, what is recorded first. Of a single mode all but its inputs.
std::vector<std::size_t> columns_of(const Model& model, const std::vector<Coordinate>& coordinates,
                                    const std::vector<FoundMode>& modes) {
  const std::vector<std::string> records = model.names(KOPPEL_KIND_RECORD, model.sizes().records);
  const std::vector<std::string> inputs = model.names(KOPPEL_KIND_INPUT, model.sizes().inputs);
  const auto in = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const bool components : {false, true}) {
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      if (is_component(coordinates[i]) != components || in(inputs, coordinates[i].name)) continue;
      if (modes.size() == 1 || differs(modes, i, coordinates[i])) columns.push_back(i);
    }
    std::stable_partition(columns.begin(), columns.end(),
                          [&](std::size_t i) { return in(records, coordinates[i].name); });
    put_telling_first(columns, coordinates, modes);
    if (!columns.empty()) return columns;
  }
  return {};
}

std::size_t line_width() {
  constexpr std::size_t usual = 100;
  winsize window{};
  if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0) return usual;
  return window.ws_col;
}

std::string heading(const Coordinate& coordinate) {
  std::string text = coordinate.name;
  if (is_component(coordinate)) return text;
  text += " [";
  text += is_angle(coordinate) ? "deg" : coordinate.unit;
  text += ']';
  return text;
}

std::string cell(const Coordinate& coordinate, double value) {
  char text[48];
  const double unit = is_angle(coordinate) ? 1e4 * 180.0 / std::numbers::pi : 1e6;
  // Rounded before it is printed, and zero added, so that nothing reads as minus zero.
  std::snprintf(text, sizeof text, is_angle(coordinate) ? "%.4f" : "%.6f",
                (std::round(value * unit) + 0.0) / (is_angle(coordinate) ? 1e4 : 1e6));
  return text;
}

void print_modes(const Model& model, const std::vector<FoundMode>& modes) {
  const std::vector<Coordinate> coordinates = coordinates_of(model);
  std::vector<std::vector<std::string>> table{{"mode"}}, ends{{"residual"}};
  for (const FoundMode& mode : modes) {
    table.front().push_back(mode.id);
    char residual[32];
    std::snprintf(residual, sizeof residual, "%.1e%s", mode.residual, mode.limit ? " limit" : "");
    ends.front().emplace_back(residual);
  }
  const auto width = [](const std::vector<std::string>& column) {
    std::size_t most = 0;
    for (const std::string& text : column) most = std::max(most, places(text));
    return most + 2;
  };
  std::size_t used = width(table.front()) + width(ends.front()), left_out = 0;
  for (const std::size_t i : columns_of(model, coordinates, modes)) {
    std::vector<std::string> column{heading(coordinates[i])};
    for (const FoundMode& mode : modes) column.push_back(cell(coordinates[i], mode.q[i]));
    if (left_out > 0 || (table.size() > 1 && used + width(column) > line_width())) {
      ++left_out;
      continue;
    }
    used += width(column);
    table.push_back(std::move(column));
  }
  table.push_back(std::move(ends.front()));
  print_table(table);
  if (left_out > 0) {
    std::printf("%zu more coordinate%s: --json has all\n", left_out, left_out == 1 ? "" : "s");
  }
}

void print_text(const Model& model, const Search& found, double time) {
  std::printf("%s: %llu assembly mode%s at t = %g s\n", model.name(KOPPEL_KIND_SCENE, 0).c_str(),
              static_cast<unsigned long long>(found.summary.count), found.summary.count == 1 ? "" : "s", time);
  if (found.modes.empty()) return;
  print_modes(model, found.modes);
  if (found.summary.twins > 1) {
    std::printf("each stands for %llu: links that turn over unnoticed; --all-twins lists them\n",
                static_cast<unsigned long long>(found.summary.twins));
  }
  std::printf("%s: %s\n", found.summary.complete != 0 ? "complete" : "not complete", found.why.c_str());
}

nlohmann::ordered_json to_json(const Model& model, const Search& found, double time) {
  nlohmann::ordered_json document;
  document["scene"] = model.name(KOPPEL_KIND_SCENE, 0);
  document["time"] = time;
  document["modes"] = nullptr;
  document["complete"] = nullptr;
  document["why"] = nullptr;
  document["twins"] = nullptr;
  if (found.status >= 0) {
    const std::vector<std::string> names = model.names(KOPPEL_KIND_COORDINATE, model.sizes().coordinates);
    document["modes"] = nlohmann::ordered_json::array();
    for (const FoundMode& mode : found.modes) {
      auto coordinates = nlohmann::ordered_json::object();
      for (std::size_t i = 0; i < names.size(); ++i) coordinates[names[i]] = mode.q[i];
      document["modes"].push_back({{"id", mode.id},
                                   {"coordinates", std::move(coordinates)},
                                   {"residual", mode.residual},
                                   {"limit", mode.limit}});
    }
    document["complete"] = found.summary.complete != 0;
    document["why"] = found.why;
    document["twins"] = found.summary.twins;
  }
  document["diagnostics"] = json_of_findings(model);
  return document;
}

Exit modes(const Options& options, bool verbose) {
  const Model model = load(options.scene, verbose);
  if (!options.json) model.print_findings();
  if (!model.mechanism) {
    if (options.json) print_json({{"modes", nullptr}, {"complete", nullptr}, {"diagnostics", json_of_findings(model)}});
    return model.outcome;
  }
  const Search found = search(model, options);
  std::optional<koppel_error> finding;
  if (found.status < 0) {
    finding = found.error;
  } else if (found.modes.empty()) {
    finding = none_found(found, options.time);
  }
  if (options.json) {
    nlohmann::ordered_json document = to_json(model, found, options.time);
    if (finding) document["diagnostics"].push_back(json_of(*finding));
    print_json(document);
  } else {
    if (found.status >= 0) print_text(model, found, options.time);
    if (finding) print_error(*finding);
  }
  if (found.status < 0) return exit_of(found.status);
  return found.modes.empty() ? Exit::not_closed : Exit::fine;
}

std::string finite(const std::string& text) {
  double value = 0.0;
  return CLI::detail::lexical_cast(text, value) && std::isfinite(value) ? "" : "must be a number of seconds";
}

std::string mode_count(const std::string& text) {
  std::int64_t value = 0;
  const bool good = CLI::detail::lexical_cast(text, value) && value >= 1 && value <= 1000000000;
  return good ? "" : "must be a whole number from 1 to 1000000000";
}

}  // namespace

void add_modes(CLI::App& app, const Common& common, Exit& outcome) {
  CLI::App* command =
      app.add_subcommand("modes", "Find all assembly modes: every closed position for the inputs as they are");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_option("--time", options->time, "When to take the inputs; default: 0")
      ->check(finite)
      ->type_name("SECONDS");
  command->add_option("--most", options->most, "End the search at this number of modes; default: 4096")
      ->check(mode_count)
      ->type_name("N");
  command->add_flag("--all-twins", options->all_twins,
                    "List every position of links with a ball and a Cardan joint, which turn over unnoticed");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([options, &common, &outcome] { outcome = modes(*options, common.verbose); });
}

}  // namespace koppel::app

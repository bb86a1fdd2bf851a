#include "bench/tables.hpp"

#include <array>
#include <cstdio>
#include <sstream>
#include <utility>

namespace koppel::app::bench {
namespace {

template <typename... Values>
std::string format(const char* how, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), how, values...);
  return text.data();
}

/// A field of a row of comma-separated values.
std::string field(const Json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  std::string text = "\"";
  for (const char c : value.get<std::string>()) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + '"';
}

/// Rows with the columns of the first one: names of members, "a/b" for members of members.
class Csv {
 public:
  Csv(std::string name, std::vector<std::string> columns) : name_(std::move(name)), columns_(std::move(columns)) {
    for (std::size_t i = 0; i < columns_.size(); ++i) out_ << (i == 0 ? "" : ",") << columns_[i];
    out_ << '\n';
  }

  /// Members are looked for in one after the other of the objects, from the innermost on.
  void row(const std::vector<const Json*>& objects) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      out_ << (i == 0 ? "" : ",");
      const Json::json_pointer place("/" + columns_[i]);
      for (const Json* object : objects) {
        if (!object->contains(place)) continue;
        out_ << field(object->at(place));
        break;
      }
    }
    out_ << '\n';
    any_ = true;
  }
  void add_to(std::vector<File>& files) const {
    if (any_) files.push_back({name_, out_.str()});
  }

 private:
  std::string name_;
  std::vector<std::string> columns_;
  std::ostringstream out_;
  bool any_ = false;
};

std::string spread_of(const Json& seconds) {
  if (!seconds.is_object()) return "";
  return std::string("(") + in_seconds(seconds["least"]) + " to " + in_seconds(seconds["greatest"]) + ")";
}

void show_peers(std::ostream& out, const Json& document) {
  for (const Json& peer : document.value("peers", Json::array())) {
    if (!peer["found"].get<bool>()) {
      out << "no " << peer["name"].get<std::string>() << ": " << peer["help"].get<std::string>() << "\n";
      continue;
    }
    for (const Json& what : peer["left_out"]) {
      out << peer["engine"].get<std::string>() << " left out: " << what.get<std::string>() << "\n";
    }
  }
}

void show_simulations(std::ostream& out, const Json& document) {
  for (const Json& problem : document["simulations"]) {
    out << "\n" << problem["name"].get<std::string>() << ", " << problem["end"] << " s";
    if (problem.contains("why")) {
      out << ": " << problem["why"].get<std::string>() << "\n";
      continue;
    }
    const Json& reference = problem["reference"];
    out << "; reference: " << reference["source"].get<std::string>() << ", to " << in_powers(reference["uncertainty"])
        << "\n";
    for (const Json& series : problem["series"]) {
      const std::string label = series["engine"].get<std::string>() + ", " + series["method"].get<std::string>();
      for (const Json& point : series["points"]) {
        out << format("  %-28s %-10s %-9.2g ", label.c_str(), series["setting"].get<std::string>().c_str(),
                      point["setting"].get<double>());
        if (!point["finished"].get<bool>()) {
          out << point["why"].get<std::string>() << "\n";
          continue;
        }
        const std::string error = std::string(point["bound"].get<bool>() ? "< " : "") + in_powers(point["error"]);
        out << format("error %-10s %10s  %s\n", error.c_str(), median_of(point["seconds"]).c_str(),
                      spread_of(point["seconds"]).c_str());
      }
    }
  }
}

void show_closures(std::ostream& out, const Json& document) {
  if (document["closures"].empty()) return;
  out << format("\n%-14s %-16s %10s %-22s %9s %9s %9s %6s\n", "closure", "way", "time", " (spread)", "residual",
                "estimate", "differs", "failed");
  for (const Json& scene : document["closures"]) {
    for (const Json& way : scene["ways"]) {
      const Json seconds = way.value("seconds", Json());
      out << format("%-14s %-16s %10s %-22s %9s %9s %9s %6d\n", scene["name"].get<std::string>().c_str(),
                    way["way"].get<std::string>().c_str(), median_of(seconds).c_str(), spread_of(seconds).c_str(),
                    in_powers(way["residual"]).c_str(), in_powers(way["coordinate_error"]).c_str(),
                    in_powers(way["difference"]).c_str(), way["failed"].get<int>());
    }
  }
}

void show_scaling(std::ostream& out, const Json& document) {
  for (const Json& chain : document["scaling"]) {
    out << "\n" << chain["name"].get<std::string>() << ": " << chain["title"].get<std::string>() << "\n";
    for (const Json& point : chain["points"]) {
      const Json memory = point.value("memory", Json());
      const Json seconds = point.value("seconds", Json());
      out << format("  %5d  %10s  %-22s  error %-9s  compiling %10s  memory %s\n", point["size"].get<int>(),
                    median_of(seconds).c_str(), spread_of(seconds).c_str(),
                    in_powers(point.value("error", Json())).c_str(),
                    median_of(point["compiling"].value("seconds", Json())).c_str(),
                    memory.is_number() ? format("%.0f kB", memory.get<double>() / 1e3).c_str() : "-");
    }
  }
}

void show_cases(std::ostream& out, const Json& document) {
  if (!document["cases"].empty()) out << "\n";
  for (const Json& hard : document["cases"]) {
    out << format("%-5s %-26s error %-8s of %-8s %s\n", hard["pass"].get<bool>() ? "pass" : "FAIL",
                  hard["name"].get<std::string>().c_str(), in_powers(hard["error"]).c_str(),
                  in_powers(hard["allowed"]).c_str(), hard["found"].get<std::string>().c_str());
  }
}

void show_profiles(std::ostream& out, const Json& document) {
  for (const Json& scene : document["profiles"]) {
    out << (&scene == &document["profiles"].front() ? "\n" : "")
        << format("%-20s ", scene["name"].get<std::string>().c_str());
    if (scene.contains("why")) {
      out << scene["why"].get<std::string>() << "\n";
      continue;
    }
    for (const Json& part : scene["parts"]) {
      const double share = part["share"].get<double>();
      if (share >= 0.005) out << part["part"].get<std::string>() << format(" %.0f%%, ", 100.0 * share);
    }
    out << "of " << scene["samples"] << " samples\n";
  }
}

void show_comparison(std::ostream& out, const Json& document) {
  if (!document.contains("comparison")) return;
  const Json& comparison = document["comparison"];
  out << "\ncompared with the bench of " << comparison["old"].get<std::string>() << ": " << comparison["compared"]
      << " items; errors and outcomes " << comparison["worse"] << " worse, " << comparison["better"]
      << " better; times " << comparison["slower"] << " slower, " << comparison["faster"] << " faster"
      << format("; the yardstick takes %.2f times as long\n", comparison["machine"].get<double>());
  for (const Json& change : comparison["changes"]) {
    out << "  " << (change["better"].get<bool>() ? "better  " : "worse   ") << change["text"].get<std::string>()
        << "\n";
  }
}

}  // namespace

std::string in_seconds(const Json& number) {
  if (!number.is_number()) return "-";
  const double s = number.get<double>();
  if (s < 1e-6) return format("%.3g ns", 1e9 * s);
  if (s < 1e-3) return format("%.3g us", 1e6 * s);
  return s < 1.0 ? format("%.3g ms", 1e3 * s) : format("%.3g s", s);
}

std::string in_powers(const Json& number) {
  if (!number.is_number()) return "-";
  return format("%.1e", number.get<double>());
}

std::string in_short(const Json& number) { return number.is_number() ? format("%.3g", number.get<double>()) : "-"; }

std::string median_of(const Json& seconds) { return seconds.is_object() ? in_seconds(seconds["median"]) : "-"; }

std::vector<File> tables(const Json& document) {
  const std::vector<std::string> time = {"seconds/median", "seconds/least", "seconds/greatest", "seconds/repeats"};
  const auto columns = [&time](std::vector<std::string> names) {
    names.insert(names.end(), time.begin(), time.end());
    return names;
  };
  Csv simulations("simulations.csv",
                  columns({"name", "end", "engine", "method", "setting", "error", "bound", "energy_error",
                           "position_drift", "velocity_drift", "steps", "rejected", "evaluations"}));
  for (const Json& problem : document["simulations"]) {
    for (const Json& series : problem["series"]) {
      for (const Json& point : series["points"]) simulations.row({&point, &series, &problem});
    }
  }
  Csv closures("closures.csv", columns({"name", "equations", "unknowns", "steps", "way", "closed", "failed", "residual",
                                        "coordinate_error", "difference", "iterations"}));
  for (const Json& scene : document["closures"]) {
    for (const Json& way : scene["ways"]) closures.row({&way, &scene});
  }
  Csv scaling("scaling.csv", columns({"name", "size", "rates", "error", "bound", "evaluations", "memory",
                                      "compiling/seconds/median"}));
  for (const Json& chain : document["scaling"]) {
    for (const Json& point : chain["points"]) scaling.row({&point, &chain});
  }
  Csv hard_cases("cases.csv", columns({"name", "what", "expected", "found", "error", "allowed", "pass"}));
  for (const Json& hard : document["cases"]) hard_cases.row({&hard});
  Csv profiles("profiles.csv", {"name", "samples", "runs", "part", "share"});
  for (const Json& scene : document["profiles"]) {
    for (const Json& part : scene["parts"]) profiles.row({&part, &scene});
  }
  std::vector<File> files;
  for (const Csv* csv : {&simulations, &closures, &scaling, &hard_cases, &profiles}) csv->add_to(files);
  return files;
}

std::string text(const Json& document) {
  std::ostringstream out;
  const Json& machine = document["machine"];
  out << "koppel " << machine["koppel"].get<std::string>() << " on " << machine["processor"].get<std::string>() << ", "
      << machine["cores"] << " cores; " << machine["compiler"].get<std::string>() << ' '
      << machine["flags"].get<std::string>() << "\n"
      << "load " << in_short(machine["load"]["before"]) << " before, " << in_short(machine["load"]["after"])
      << " after; times are medians of " << document["repeats"] << " rounds, with the least and the greatest\n";
  show_peers(out, document);
  show_simulations(out, document);
  show_closures(out, document);
  show_scaling(out, document);
  show_cases(out, document);
  show_profiles(out, document);
  show_comparison(out, document);
  return out.str();
}

bool all_well(const Json& document) {
  for (const Json& hard : document["cases"]) {
    if (!hard["pass"].get<bool>()) return false;
  }
  return !document.contains("comparison") || document["comparison"]["worse"] == 0;
}

}  // namespace koppel::app::bench

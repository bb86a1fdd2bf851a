// koppel bench
#include "bench/bench.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/compare.hpp"
#include "bench/page.hpp"
#include "bench/tables.hpp"
#include "koppel/command.hpp"

namespace koppel::app {
namespace {

struct Options {
  bench::Plan plan;
  std::string out, compare;
  bool list = false;
  bool peers = false;
  bool json = false;
};

Exit failed(const std::string& what) {
  std::fprintf(stderr, "error: %s\n", what.c_str());
  return Exit::system;
}

/// True if all that a comparison looks at is there.
bool comparable(const bench::Json& document) {
  try {
    return document.value("schema", "") == "koppel-bench/1" && bench::compare(document, document).is_object();
  } catch (const bench::Json::exception&) {
    return false;
  }
}

/// A document that was written by --out; none, and told on standard error, if it cannot be used.
std::optional<bench::Json> read_document(const std::string& file) {
  std::ifstream in(file);
  bench::Json document = bench::Json::parse(in, nullptr, false);
  if (in.is_open() && document.is_object() && comparable(document)) return document;
  failed(file + " is not a readable result of koppel bench (schema koppel-bench/1)\n" +
         "  help: use the bench.json that --out wrote");
  return std::nullopt;
}

bool write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  return out.flush().good();
}

/// Everything that --out writes.
Exit write_results(const std::string& folder, const bench::Json& document) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::vector<bench::File> files = bench::tables(document);
  for (bench::File& plot : bench::plots(document)) files.push_back(std::move(plot));
  files.push_back({"bench.html", bench::page(document)});
  files.push_back({"bench.json", document.dump(1) + '\n'});
  for (const bench::File& file : files) {
    const std::filesystem::path path = std::filesystem::path(folder) / file.name;
    if (!write(path, file.text)) return failed("cannot write " + path.string());
  }
  std::fprintf(stderr, "wrote %zu files; look at %s\n", files.size(),
               (std::filesystem::path(folder) / "bench.html").c_str());
  return Exit::fine;
}

/// How many letters have to be changed, put in or left out to make one word of another.
std::size_t letters_apart(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, change}));
    }
  }
  return row.back();
}

/// What a name may stand for: "section/name", "section" and "name".
std::vector<std::string> meanings(const std::string& full) {
  const std::size_t slash = full.find('/');
  return {full, full.substr(0, slash), full.substr(slash + 1)};
}

/// Names that contain the word, else the nearest one; empty if none is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& all) {
  std::vector<std::string> near;
  std::copy_if(all.begin(), all.end(), std::back_inserter(near),
               [&](const std::string& name) { return name.find(word) != std::string::npos; });
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& full : near.empty() ? all : std::vector<std::string>{}) {
    for (const std::string& name : meanings(full)) {
      const std::size_t apart = letters_apart(word, name);
      if (apart < least) near = {name};
      least = std::min(least, apart);
    }
  }
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(near.size(), 5); ++i) text += (i == 0 ? "" : ", ") + near[i];
  return text;
}

/// False, and what is there on standard error, if a name means nothing.
bool known(const bench::Plan& plan) {
  const std::vector<std::string> all = bench::all_names(plan);
  for (const std::string& word : plan.names) {
    const bool found = std::any_of(all.begin(), all.end(), [&](const std::string& full) {
      const std::vector<std::string> names = meanings(full);
      return std::find(names.begin(), names.end(), word) != names.end();
    });
    if (found) continue;
    const std::string near = suggestion(word, all);
    std::fprintf(stderr, "error: nothing to measure is called %s\n  help: %skoppel bench --list prints all names\n",
                 word.c_str(), near.empty() ? "" : ("did you mean " + near + "? ").c_str());
    return false;
  }
  return true;
}

/// Where this program is; the other engines' are beside it.
std::string own_folder() { return std::filesystem::read_symlink("/proc/self/exe").parent_path().string(); }

Exit bench_all(const Options& options) {
  if (!std::filesystem::is_directory(options.plan.scenes)) {
    return failed("no folder of scenes at " + options.plan.scenes + "\n  help: name it with --scenes");
  }
  if (options.list) {
    for (const std::string& name : bench::all_names(options.plan)) std::puts(name.c_str());
    return Exit::fine;
  }
  if (!known(options.plan)) return Exit::usage;
  std::optional<bench::Json> old;
  if (!options.compare.empty()) {
    old = read_document(options.compare);
    if (!old) return Exit::system;
  }
  bench::Json document = bench::run(options.plan);
  if (old) document["comparison"] = bench::compare(*old, document);
  if (options.json) {
    print_json(document);
  } else {
    std::fputs(bench::text(document).c_str(), stdout);
  }
  if (!options.out.empty()) {
    const Exit written = write_results(options.out, document);
    if (written != Exit::fine) return written;
  }
  return bench::all_well(document) ? Exit::fine : Exit::worse;
}

}  // namespace

void add_bench(CLI::App& app, const Common& /*common*/, Exit& outcome) {
  CLI::App* command = app.add_subcommand(
      "bench", "Measure speed against error: motions, closures, growing chains, hard cases; and where the time goes");
  auto options = std::make_shared<Options>();
  options->plan.scenes = KOPPEL_SCENES;
  command->add_option("NAMES", options->plan.names, "What to measure, as --list names it; default: everything")
      ->type_name("");
  command->add_flag("--quick", options->plan.quick,
                    "Fewer settings, shorter chains, three rounds: about half a minute");
  command->add_option("--out", options->out, "Write bench.json, bench.html, tables (CSV) and plots (SVG) into a folder")
      ->check(not_empty)
      ->type_name("DIR");
  command->add_option("--compare", options->compare, "Tell what got better or worse than in an older bench.json")
      ->check(not_empty)
      ->type_name("OLD.json");
  command->add_option("--scenes", options->plan.scenes, "Folder of the scenes; default: that of the source")
      ->check(not_empty)
      ->type_name("DIR");
  command->add_flag("--peers", options->peers, "Set other engines beside koppel, as far as their programs were built");
  command->add_flag("--list", options->list, "Print the names of all that can be measured");
  command->add_flag("--json", options->json, "Print the results as JSON");
  command->callback([options, &outcome] {
    if (options->peers) options->plan.peers = own_folder();
    outcome = bench_all(*options);
  });
}

}  // namespace koppel::app

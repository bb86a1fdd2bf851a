#include "bench/page.hpp"

#include <sstream>

#include "bench/sampler.hpp"
#include "common/markup.hpp"

namespace koppel::app::bench {
namespace {

constexpr const char* page_style = R"(
body { font: 15px/1.45 sans-serif; max-width: 1180px; margin: 2em auto; padding: 0 1em; color: #222; background: #fff; }
h1 { font-size: 1.5em; } h2 { font-size: 1.2em; margin-top: 2em; }
table { border-collapse: collapse; font-size: 13px; margin: .6em 0; }
td, th { padding: .15em .7em; text-align: left; border-bottom: 1px solid #ddd; vertical-align: top; }
td.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.pass { color: #1f7a4d; } .fail { color: #b3261e; font-weight: bold; }
.bar { display: flex; width: 420px; height: 1.1em; background: #8885; } .bar span { height: 100%; }
.charts { display: flex; flex-wrap: wrap; gap: 18px; }
figure { margin: 0; } figcaption { font-size: 13px; max-width: 560px; }
label { margin-right: 1em; white-space: nowrap; }
.key { display: inline-block; width: .8em; height: .8em; border-radius: 50%; margin-right: .3em; }
.k0 { background: #1f5fa8; } .k1 { background: #b3541e; } .k2 { background: #1f7a4d; } .k3 { background: #8a3fa0; }
.k4 { background: #967800; } .k5 { background: #b02a5b; } .k6 { background: #4a6670; } .k7 { background: #3d3d3d; }
details { margin: .4em 0; } summary { cursor: pointer; }
svg .dot:hover circle, svg .dot:hover path { stroke-width: 5; }
#tip { position: fixed; display: none; background: #222; color: #fff; padding: .3em .6em; font-size: 12px;
  white-space: pre; pointer-events: none; border-radius: 4px; }
@media (prefers-color-scheme: dark) {
  body { color: #ddd; background: #181818; } td, th { border-color: #383838; }
  .pass { color: #70d0a0; } .fail { color: #ff8a80; }
  .k0 { background: #7db4f0; } .k1 { background: #f0a070; } .k2 { background: #70d0a0; } .k3 { background: #d0a0e8; }
  .k4 { background: #e0c860; } .k5 { background: #f090b4; } .k6 { background: #a8c4cc; } .k7 { background: #ccc; }
}
)";

/// Lines of a chart can be hidden, and what a dot means stands beside the pointer.
constexpr const char* page_script = R"(
for (const box of document.querySelectorAll('figure input')) {
  box.addEventListener('change', () => {
    const line = box.closest('figure').querySelector('[data-line="' + box.value + '"]');
    line.style.display = box.checked ? '' : 'none';
  });
}
const tip = document.getElementById('tip');
for (const dot of document.querySelectorAll('svg .dot')) {
  const title = dot.querySelector('title'), text = title.textContent;
  title.remove();
  dot.addEventListener('mousemove', (event) => {
    tip.textContent = text;
    tip.style.display = 'block';
    tip.style.left = event.clientX + 14 + 'px';
    tip.style.top = event.clientY + 10 + 'px';
  });
  dot.addEventListener('mouseleave', () => { tip.style.display = 'none'; });
}
)";

std::string text_of(const Json& value) { return escaped(value.is_string() ? value.get<std::string>() : value.dump()); }

/// A table as rows of cells.
class Rows {
 public:
  explicit Rows(std::ostream& out, const std::vector<std::string>& heads) : out_(out) {
    out_ << "<table><thead><tr>";
    for (const std::string& head : heads) out_ << "<th>" << escaped(head) << "</th>";
    out_ << "</tr></thead><tbody>\n";
  }
  ~Rows() { out_ << "</tbody></table>\n"; }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;

  Rows& begin() {
    out_ << "<tr>";
    return *this;
  }
  Rows& text(const std::string& what, const std::string& style = "") {
    out_ << "<td" << (style.empty() ? "" : " class=\"" + style + "\"") << '>' << escaped(what) << "</td>";
    return *this;
  }
  Rows& number(const std::string& what) { return text(what, "n"); }
  Rows& time(const Json& seconds) {
    if (!seconds.is_object()) return number("-").text("");
    return number(in_seconds(seconds["median"]))
        .text(in_seconds(seconds["least"]) + " to " + in_seconds(seconds["greatest"]) + ", " +
              seconds["repeats"].dump());
  }
  void end() { out_ << "</tr>\n"; }

 private:
  std::ostream& out_;
};

void add_figure(std::ostream& out, const NamedChart& named, const std::string& caption) {
  out << "<figure>\n" << draw(named.chart, false) << "<figcaption>";
  for (std::size_t i = 0; i < named.chart.lines.size(); ++i) {
    out << "<label><input type=\"checkbox\" value=\"" << i << "\" checked=\"checked\"/><span class=\"key k" << i % 8
        << "\"></span>" << escaped(named.chart.lines[i].name) << "</label> ";
  }
  out << caption << "</figcaption>\n</figure>\n";
}

std::string reference_of(const Json& document, const std::string& name) {
  for (const Json& problem : document["simulations"]) {
    if (problem["name"] != name || !problem["reference"].is_object()) continue;
    const Json& reference = problem["reference"];
    return "<br/>Reference: " + text_of(reference["source"]) + ", to " + in_powers(reference["uncertainty"]) + ".";
  }
  return "";
}

void add_charts(std::ostream& out, const Json& document, const std::string& section) {
  out << "<div class=\"charts\">\n";
  for (const NamedChart& named : charts(document)) {
    if (named.section == section) add_figure(out, named, reference_of(document, named.name));
  }
  out << "</div>\n";
}

void add_head(std::ostream& out, const Json& document) {
  const Json& machine = document["machine"];
  out << "<h1>koppel bench: speed against error</h1>\n<p>koppel " << text_of(machine["koppel"]) << ", "
      << text_of(document["started"]) << ", " << text_of(machine["processor"]) << ", " << machine["cores"]
      << " cores, load " << in_short(machine["load"]["before"]) << " before and " << in_short(machine["load"]["after"])
      << " after; " << text_of(machine["system"]) << "; " << text_of(machine["compiler"]) << ' '
      << text_of(machine["flags"]) << ".</p>\n<p>Times are medians of " << document["repeats"]
      << " rounds (of three where one run takes long), with the least and the greatest. Arrows are "
         "bounds: there the error is below what the reference itself is good to.</p>\n";
}

void add_simulations(std::ostream& out, const Json& document) {
  if (document["simulations"].empty()) return;
  out << "<h2>Motions by forces</h2>\n";
  add_charts(out, document, "simulations");
  out << "<details><summary>all points</summary>\n";
  {
    Rows rows(out, {"problem", "method", "setting", "error", "time", "spread, repeats", "energy", "loops", "steps",
                    "rejected", "evaluations"});
    for (const Json& problem : document["simulations"]) {
      for (const Json& series : problem["series"]) {
        for (const Json& point : series["points"]) {
          rows.begin()
              .text(problem["name"])
              .text(series["engine"].get<std::string>() + ", " + series["method"].get<std::string>());
          rows.text(series["setting"].get<std::string>() + ' ' + in_powers(point["setting"]));
          if (!point["finished"].get<bool>()) {
            rows.text(point.value("why", "did not finish"), "fail").end();
            continue;
          }
          rows.number(std::string(point["bound"].get<bool>() ? "< " : "") + in_powers(point["error"]))
              .time(point["seconds"]);
          for (const char* key : {"energy_error", "position_drift"}) rows.number(in_powers(point.value(key, Json())));
          for (const char* key : {"steps", "rejected", "evaluations"})
            rows.number(point.contains(key) ? point[key].dump() : "-");
          rows.end();
        }
      }
    }
  }
  out << "</details>\n";
}

void add_closures(std::ostream& out, const Json& document) {
  if (document["closures"].empty()) return;
  out << "<h2>Closed positions</h2>\n<p><i>step</i> is a whole step of a run, with velocities and accelerations; "
         "<i>newton</i> "
         "its closure alone, from the step before; the others close the scene from its start.</p>\n";
  add_charts(out, document, "closures");
  out << "<details><summary>all closures</summary>\n";
  {
    Rows rows(out, {"scene", "equations", "unknowns", "way", "time", "spread, repeats", "residual", "error, estimated",
                    "differs from step", "iterations", "failed"});
    for (const Json& scene : document["closures"]) {
      for (const Json& way : scene["ways"]) {
        rows.begin()
            .text(scene["name"])
            .number(scene["equations"].dump())
            .number(scene["unknowns"].dump())
            .text(way["way"]);
        rows.time(way.value("seconds", Json()));
        for (const char* key : {"residual", "coordinate_error", "difference"}) rows.number(in_powers(way[key]));
        rows.number(way["iterations"].dump()).number(way["failed"].dump()).end();
      }
    }
  }
  out << "</details>\n";
}

void add_scaling(std::ostream& out, const Json& document) {
  if (document["scaling"].empty()) return;
  out << "<h2>Growing chains</h2>\n";
  add_charts(out, document, "scaling");
  Rows rows(out, {"chain", "size", "rates", "error", "time", "spread, repeats", "evaluations", "compiling", "memory"});
  for (const Json& chain : document["scaling"]) {
    for (const Json& point : chain["points"]) {
      rows.begin().text(chain["name"]).number(point["size"].dump()).number(point["rates"].dump());
      rows.number(std::string(point.value("bound", false) ? "< " : "") + in_powers(point.value("error", Json())));
      rows.time(point.value("seconds", Json()))
          .number(point.contains("evaluations") ? point["evaluations"].dump() : "");
      rows.number(median_of(point["compiling"].value("seconds", Json())));
      const Json memory = point.value("memory", Json());
      rows.number(memory.is_number() ? std::to_string(static_cast<long long>(memory.get<double>() / 1e3)) + " kB" : "-")
          .end();
    }
  }
}

void add_cases(std::ostream& out, const Json& document) {
  if (document["cases"].empty()) return;
  out << "<h2>Hard cases</h2>\n";
  Rows rows(out, {"", "case", "what is hard", "what should come out", "what does", "error", "allowed", "time"});
  for (const Json& hard : document["cases"]) {
    const bool pass = hard["pass"].get<bool>();
    rows.begin().text(pass ? "pass" : "FAIL", pass ? "pass" : "fail").text(hard["name"]).text(hard["what"]);
    rows.text(hard["expected"]).text(hard["found"]).number(in_powers(hard["error"])).number(in_powers(hard["allowed"]));
    rows.number(in_seconds(hard["took"])).end();
  }
}

/// Colour of a part; the last one is what is left of the bar.
std::string colour(std::size_t part) { return {'k', static_cast<char>('0' + part % 8)}; }

/// One bar for each scene, with the figures behind it.
void add_profiles(std::ostream& out, const Json& document) {
  if (document["profiles"].empty()) return;
  out << "<h2>Where the time goes</h2>\n<p>Shares of the time of whole runs, by looking at the stack many times a "
         "second: the innermost function that belongs to a part counts; what is left of a bar belongs to none. ";
  const std::vector<std::string>& parts = profile_parts();
  for (std::size_t i = 0; i + 1 < parts.size(); ++i)
    out << "<label><span class=\"key " << colour(i) << "\"></span>" << escaped(parts[i]) << "</label> ";
  out << "</p>\n<table><thead><tr><th>scene</th><th>samples</th><th>runs</th><th>shares</th></tr></thead><tbody>\n";
  for (const Json& scene : document["profiles"]) {
    out << "<tr><td>" << text_of(scene["name"]) << "</td><td class=\"n\">" << scene["samples"]
        << "</td><td class=\"n\">" << scene["runs"] << "</td><td>" << text_of(scene.value("why", ""))
        << "<div class=\"bar\">";
    for (std::size_t i = 0; i + 1 < scene["parts"].size(); ++i) {
      const std::string percent = in_short(100.0 * scene["parts"][i]["share"].get<double>()) + '%';
      out << "<span class=\"" << colour(i) << "\" style=\"width: " << percent << "\" title=\""
          << text_of(scene["parts"][i]["part"]) << ' ' << percent << "\"></span>";
    }
    out << "</div></td></tr>\n";
  }
  out << "</tbody></table>\n";
}

void add_comparison(std::ostream& out, const Json& document) {
  if (!document.contains("comparison")) return;
  const Json& comparison = document["comparison"];
  out << "<h2>Compared with the bench of " << text_of(comparison["old"]) << "</h2>\n<p>" << comparison["compared"]
      << " items; errors and outcomes: " << comparison["worse"] << " worse, " << comparison["better"]
      << " better; times: " << comparison["slower"] << " slower, " << comparison["faster"]
      << " faster. The yardstick takes " << in_short(comparison["machine"]) << " times as long.</p>\n<ul>\n";
  for (const Json& change : comparison["changes"]) {
    out << "<li class=\"" << (change["better"].get<bool>() ? "pass" : "fail") << "\">" << text_of(change["text"])
        << "</li>\n";
  }
  out << "</ul>\n";
}

}  // namespace

std::string page(const Json& document) {
  std::ostringstream out;
  out << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<title>koppel bench</title>\n<style>"
      << page_style << chart_style << "</style>\n</head>\n<body>\n";
  add_head(out, document);
  add_comparison(out, document);
  add_cases(out, document);
  add_simulations(out, document);
  add_closures(out, document);
  add_scaling(out, document);
  add_profiles(out, document);
  // The script stands in a section of characters, so that the page is XML too.
  out << "<div id=\"tip\"></div>\n<script>//<![CDATA[\n" << page_script << "//]]></script>\n</body>\n</html>\n";
  return out.str();
}

}  // namespace koppel::app::bench

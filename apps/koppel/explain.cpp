// koppel explain SCENE [--flow [FILE]] | CODE
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <memory>
#include <string>

#include "koppel/at_start.hpp"
#include "koppel/command.hpp"
#include "koppel/drawing.hpp"

namespace koppel::app {
namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/// text: in capitals.
bool looks_like_code(const std::string& text) {
  const std::size_t digits = !text.empty() && (text[0] == 'E' || text[0] == 'W' || text[0] == 'N') ? 1 : 0;
  return text.size() > digits && std::all_of(text.begin() + static_cast<std::ptrdiff_t>(digits), text.end(),
                                             [](unsigned char c) { return std::isdigit(c) != 0; });
}

Exit explain_code(const std::string& code) {
  const std::string text = text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_explain_code(code.c_str(), buffer, size, needed);
  });
  if (text.empty()) {
    std::fprintf(stderr, "error: there is no finding with the code %s\n", code.c_str());
    return Exit::usage;
  }
  std::puts(text.c_str());
  return Exit::fine;
}

Exit explain_scene(const std::string& file, bool verbose) {
  const Model model = load(file, verbose);
  model.print_findings();
  if (!model.mechanism) return model.outcome;
  const std::string text = text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_mechanism_explain(model.mechanism.get(), buffer, size, needed);
  });
  std::fputs(text.c_str(), stdout);
  const AtStart start = at_start(model);
  if (!start.closed) {
    std::puts("\nFreedoms: not known, the mechanism does not close at t = 0; koppel check tells more");
    return Exit::fine;
  }
  const std::string freedoms = text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_explain_freedoms(start.motion.state.get(), start.motion.work.get(), buffer, size, needed);
  });
  std::printf("\nAt t = 0\n%s", freedoms.c_str());
  return Exit::fine;
}

std::string flow_of(const Model& model, std::int32_t format) {
  return text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_flow_explain(model.mechanism.get(), format, buffer, size, needed);
  });
}

/// drawing: the file that gets the block diagram; empty: none.
Exit explain_flow(const std::string& file, const std::string& drawing, bool verbose) {
  const Model model = load(file, verbose);
  model.print_findings();
  if (!model.mechanism) return model.outcome;
  const std::string text = flow_of(model, KOPPEL_FLOW_TEXT);
  if (text.empty()) {
    std::fputs("error: the flow cannot be told; the system may be short of memory\n", stderr);
    return Exit::system;
  }
  std::fputs(text.c_str(), stdout);
  return drawing.empty() ? Exit::fine : write_drawing(flow_of(model, KOPPEL_FLOW_DOT), drawing);
}

}  // namespace

void add_explain(CLI::App& app, const Common& common, Exit& outcome) {
  struct Options {
    std::string subject, drawing;
  };
  CLI::App* command = app.add_subcommand(
      "explain", "Tell what was built from a scene and how its loops are closed, or what a finding's code means");
  auto options = std::make_shared<Options>();
  command->add_option("SUBJECT", options->subject, "A scene file, or a code such as E0304")
      ->required()
      ->check(not_empty)
      ->type_name("");
  CLI::Option* flow = command
                          ->add_option("--flow", options->drawing,
                                       "Tell instead in which order and how the coordinates follow from the inputs; "
                                       "FILE.svg or FILE.dot gets a block diagram of it")
                          ->expected(0, 1)
                          ->check(drawing_file)
                          ->type_name("[FILE]");
  command->callback([options, flow, &common, &outcome] {
    const std::string code = upper(options->subject);
    if (flow->count() > 0) {
      outcome = explain_flow(options->subject, options->drawing, common.verbose);
    } else {
      outcome = looks_like_code(code) ? explain_code(code) : explain_scene(options->subject, common.verbose);
    }
  });
}

}  // namespace koppel::app

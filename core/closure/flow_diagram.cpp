#include "closure/flow_diagram.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "closure/flow_words.hpp"

namespace koppel {
namespace {

/// A text inside quotation marks of DOT. Backslashes and entities mean something there; control characters do not.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '"': out += "\\\""; break;
      case '\\': out += "\\\\"; break;
      case '&': out += "&amp;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return out;
}

/// Words in lines of some forty letters.
std::string in_lines(const std::vector<std::string>& words) {
  constexpr std::size_t wide = 40;
  std::string out;
  std::size_t length = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += ',';
    if (i > 0 && length + words[i].size() > wide) {
      out += "\\n";
      length = 0;
    } else if (i > 0) {
      out += ' ';
    }
    out += escaped(words[i]);
    length += words[i].size() + 2;
  }
  return out;
}

/// Steps of the same loops that need nothing in between from elsewhere.
struct Box {
  std::vector<std::uint32_t> loops;
  std::vector<std::size_t> steps;
};

class Diagram {
 public:
  Diagram(const Mechanism& mechanism, const Flow& flow) : mechanism_(mechanism), flow_(flow) {
    choose_outputs();
    choose_steps();
    make_boxes();
  }

  void write(std::ostream& out) const {
    out << "digraph flow {\n"
        << "  graph [rankdir=LR, label=\"" << title() << "\", labelloc=t, fontname=\"Helvetica\"];\n"
        << "  node [fontname=\"Helvetica\", fontsize=11];\n"
        << "  edge [fontname=\"Helvetica\", fontsize=10];\n";
    write_ends(out, flow_.inputs, "in", "shape=plaintext");
    write_ends(out, sources_, "kept", "shape=plaintext, fontcolor=gray40");
    for (std::size_t i = 0; i < boxes_.size(); ++i) write_box(i, out);
    write_ends(out, outputs_, "out", "shape=plaintext");
    write_wires(out);
    out << "}\n";
  }

 private:
  using Variables = std::vector<std::uint32_t>;

  std::string title() const {
    std::string text = escaped(mechanism_.title.empty() ? mechanism_.name : mechanism_.title);
    if (!flow_.obstacle.empty()) return text + "\\nno solution flow: " + escaped(flow_.obstacle);
    if (flow_.loops.loops.empty()) text += "\\nno loops";
    return text;
  }

  /// The recorded coordinates that steps compute.
  Variables recorded() const {
    std::set<std::uint32_t> places;
    for (const RecordDescription& record : mechanism_.records) {
      if (record.subject == RecordSubject::frame) continue;
      const Joint& joint = mechanism_.joints[record.joint.index()];
      places.insert(joint.q + joint.blocks[record.block].q);
    }
    Variables result;
    for (std::uint32_t v = 0; v < flow_.loops.variables.size(); ++v) {
      if (places.contains(flow_.loops.variables[v].q) && computed(v)) result.push_back(v);
    }
    return result;
  }

  bool computed(std::uint32_t v) const {
    return std::any_of(flow_.steps.begin(), flow_.steps.end(), [v](const FlowStep& step) {
      return std::binary_search(step.unknowns.begin(), step.unknowns.end(), v);
    });
  }

  void choose_outputs() {
    std::size_t all = 0;
    std::set<std::uint32_t> given, main;
    for (const FlowStep& step : flow_.steps) {
      all += step.unknowns.size();
      if (step.only_here) continue;
      given.insert(step.given.begin(), step.given.end());
      main.insert(step.unknowns.begin(), step.unknowns.end());
    }
    outputs_ = recorded();
    if (!outputs_.empty() && outputs_.size() < all) return;
    outputs_.clear();
    std::set_difference(main.begin(), main.end(), given.begin(), given.end(), std::back_inserter(outputs_));
  }

  /// Those that are done anyway, and those that an output needs.
  void choose_steps() {
    std::set<std::uint32_t> wanted(outputs_.begin(), outputs_.end());
    for (std::size_t i = flow_.steps.size(); i-- > 0;) {
      const FlowStep& step = flow_.steps[i];
      const bool needed =
          std::any_of(step.unknowns.begin(), step.unknowns.end(), [&](std::uint32_t v) { return wanted.contains(v); });
      if (step.only_here && !needed) continue;
      steps_.push_back(i);
      if (step.only_here) wanted.insert(step.given.begin(), step.given.end());
    }
    std::reverse(steps_.begin(), steps_.end());
  }

  void make_boxes() {
    for (const std::size_t number : steps_) {
      const FlowStep& step = flow_.steps[number];
      std::size_t latest = 0;
      for (const std::uint32_t v : step.given) {
        if (const auto from = box_of_.find(v); from != box_of_.end()) latest = std::max(latest, from->second);
      }
      const std::size_t box = box_for(step, latest);
      boxes_[box].steps.push_back(number);
      for (const std::uint32_t v : step.unknowns) box_of_[v] = box;
    }
    for (const FlowStep& step : flow_.steps) {
      for (const std::uint32_t v : step.given) {
        const bool kept = std::count(flow_.held.begin(), flow_.held.end(), v) > 0;
        if (kept && std::count(sources_.begin(), sources_.end(), v) == 0) sources_.push_back(v);
      }
    }
  }

  /// The last box of the same loops, unless the step needs something from a later one: no arrow may lead back.
  std::size_t box_for(const FlowStep& step, std::size_t latest) {
    for (std::size_t i = boxes_.size(); i-- > latest;) {
      if (boxes_[i].loops == step.loops) return i;
    }
    boxes_.push_back({step.loops, {}});
    return boxes_.size() - 1;
  }

  void write_ends(std::ostream& out, const Variables& ends, const std::string& kind, const std::string& look) const {
    for (const std::uint32_t v : ends) {
      out << "  " << kind << v << " [label=\"" << escaped(variable_name(mechanism_, flow_, v)) << "\", " << look
          << "];\n";
    }
  }

  void write_box(std::size_t number, std::ostream& out) const {
    const Box& box = boxes_[number];
    std::vector<JointId> joints;
    for (const std::uint32_t loop : box.loops) {
      for (const JointId joint : flow_.loops.loops[loop].joints) {
        if (std::find(joints.begin(), joints.end(), joint) == joints.end()) joints.push_back(joint);
      }
    }
    bool numerical = false;
    Variables read;
    std::string how;
    for (const std::size_t i : box.steps) {
      const FlowStep& step = flow_.steps[i];
      numerical = numerical || step.kind == StepKind::numerical;
      if (step.kind == StepKind::joint) {
        read.insert(read.end(), step.unknowns.begin(), step.unknowns.end());
      } else {
        how += solver(step);
      }
    }
    if (!read.empty()) how += "read off: " + in_lines(variable_names(mechanism_, flow_, read)) + "\\n";
    std::string name = loop_words(box.loops);
    name.front() = 'L';
    out << "  box" << number << " [shape=box, style=filled, fillcolor=\"" << (numerical ? "#f6c6a0" : "#dbe8f4")
        << "\", label=\"" << name << "\\n"
        << in_lines(joint_names(mechanism_, flow_, joints)) << "\\n"
        << how << "\"];\n";
  }

  /// "lever.angle: closed form, S-T, type 1"
  std::string solver(const FlowStep& step) const {
    const std::string names = in_lines(variable_names(mechanism_, flow_, step.unknowns));
    switch (step.kind) {
      case StepKind::one_unknown:
      case StepKind::two_unknowns: {
        const std::string form = step.kind == StepKind::one_unknown ? "closed form" : "by elimination";
        std::set<std::string> cuts;
        for (const FlowRow& row : step.rows) cuts.insert(cut_letters(flow_, flow_.cuts[row.cut]));
        return names + ": " + form + ", " + listed({cuts.begin(), cuts.end()}) + ", " + type_numbers(flow_, step) +
               "\\n";
      }
      case StepKind::joint: return {};
      case StepKind::spin: return names + ": spin kept\\n";
      case StepKind::numerical: return "numerical, " + std::to_string(unknowns_in(flow_, step)) + " unknowns\\n";
    }
    return {};
  }

  void write_wires(std::ostream& out) const {
    std::map<std::pair<std::size_t, std::size_t>, std::set<std::uint32_t>> between;
    std::set<std::pair<std::string, std::size_t>> from_ends;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      for (const std::size_t number : boxes_[i].steps) {
        for (const std::uint32_t v : flow_.steps[number].given) {
          if (const auto from = box_of_.find(v); from != box_of_.end()) {
            if (from->second != i) between[{from->second, i}].insert(v);
          } else if (std::count(flow_.inputs.begin(), flow_.inputs.end(), v) > 0) {
            from_ends.insert({"in" + std::to_string(v), i});
          } else if (std::count(sources_.begin(), sources_.end(), v) > 0) {
            from_ends.insert({"kept" + std::to_string(v), i});
          }
        }
      }
    }
    for (const auto& [end, box] : from_ends) out << "  " << end << " -> box" << box << ";\n";
    for (const auto& [boxes, variables] : between) {
      std::string label;
      for (const std::uint32_t v : variables) {
        label += (label.empty() ? "" : "\\n") + escaped(variable_name(mechanism_, flow_, v));
      }
      out << "  box" << boxes.first << " -> box" << boxes.second << " [label=\"" << label << "\"];\n";
    }
    for (const std::uint32_t v : outputs_) out << "  box" << box_of_.at(v) << " -> out" << v << ";\n";
  }

  const Mechanism& mechanism_;
  const Flow& flow_;
  Variables outputs_, sources_;
  std::vector<std::size_t> steps_;
  std::vector<Box> boxes_;
  std::map<std::uint32_t, std::size_t> box_of_;  ///< of each computed variable
};

}  // namespace

std::string flow_diagram(const Mechanism& mechanism, const Flow& flow) {
  std::ostringstream out;
  Diagram(mechanism, flow).write(out);
  return out.str();
}

}  // namespace koppel

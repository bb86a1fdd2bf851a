#include "closure/explain.hpp"

#include <sstream>

#include "mechanism/names.hpp"

namespace koppel {
namespace {

std::string plural(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

template <typename Names>
std::string joined(const Names& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

void explain_tree(const Mechanism& mechanism, std::ostream& out) {
  out << "Spanning tree (parents before children)\n";
  for (const TreeStep& step : mechanism.steps) {
    const Joint& joint = mechanism.joints[step.joint.index()];
    const auto node_name = [&](Node node) {
      if (node < mechanism.bodies.size()) return mechanism.bodies[node].name;
      return mechanism.bodies[joint.outlet.body.index()].name + " (second half)";
    };
    out << "  " << node_name(step.parent) << " -> " << node_name(step.child) << "  over " << joint.name << " ("
        << joint.type->name << (step.reversed ? ", walked from its outlet" : "") << ")\n";
  }
}

void explain_relation(const Mechanism& mechanism, const Relation& relation, std::ostream& out) {
  out << "  " << relation_name(mechanism, relation) << ": ";
  switch (relation.kind) {
    case RelationKind::cut_joint:
      out << "cut at the joint (" << mechanism.joints[relation.joint.index()].type->name
          << "), whose coordinates are computed afterwards\n";
      break;
    case RelationKind::cut_body:
      out << "cut at body " << mechanism.bodies[mechanism.joints[relation.joint.index()].outlet.body.index()].name
          << ", because the coordinates of the joint are needed or it has no implicit face\n";
      break;
    case RelationKind::constraint: out << mechanism.constraints[relation.constraint].type->name << '\n'; break;
  }
  out << "    " << plural(relation.rows, "equation", "equations");
  std::string separator = ": ";
  for (const Row& row : relation_rows(mechanism, relation)) {
    out << separator << row.name << " [" << row.unit << ']';
    separator = ", ";
  }
  out << '\n';
  std::vector<std::string> names;
  for (const JointId joint : relation.joints) names.push_back(mechanism.joints[joint.index()].name);
  out << "    depends on " << (names.empty() ? std::string("nothing") : joined(names)) << '\n';
}

}  // namespace

std::string explain(const Mechanism& mechanism) {
  std::ostringstream out;
  out << mechanism.name;
  if (!mechanism.title.empty()) out << ": " << mechanism.title;
  out << "\n\nBuilt: " << plural(mechanism.bodies.size() - 1, "moving body", "moving bodies") << ", "
      << plural(mechanism.joints.size(), "joint", "joints") << ", "
      << plural(mechanism.loops, "independent loop", "independent loops") << ", "
      << plural(mechanism.constraints.size(), "constraint", "constraints") << '\n'
      << "Characteristic length " << mechanism.length << " m: residuals in metres are divided by it\n"
      << "Mobility by count " << mechanism.mobility_count
      << " (6 for each body, minus what joints and constraints take)\n"
      << "Equations " << mechanism.rows << ", unknown rates " << mechanism.unknowns << ", inputs "
      << mechanism.inputs.size() << "\n\n";
  explain_tree(mechanism, out);
  if (!mechanism.relations.empty()) out << "\nClosure\n";
  for (const Relation& relation : mechanism.relations) explain_relation(mechanism, relation, out);
  if (!mechanism.inputs.empty()) out << "\nInputs\n";
  for (const Input& input : mechanism.inputs) {
    out << "  " << mechanism.coordinate_names[input.q].name << " follows a " << input.type->name << '\n';
  }
  out << "\nFormed numerically: ";
  std::vector<std::string> numerical;
  for (const Joint& joint : mechanism.joints) {
    for (const std::string& part : joint.numerical_parts()) numerical.push_back(part + " of " + joint.name);
  }
  out << (numerical.empty() ? std::string("nothing") : joined(numerical)) << '\n';
  out << "Left out: inertia (nothing asks for it), a Ceres problem (built when Newton does not converge)";
  if (mechanism.relations.empty()) out << ", closure (an open chain)";
  if (mechanism.constraints.empty()) out << ", constraints";
  out << '\n';
  return out.str();
}

}  // namespace koppel

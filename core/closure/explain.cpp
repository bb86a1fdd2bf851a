#include "closure/explain.hpp"

#include <cmath>
#include <iomanip>
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

/// A vector with as many digits as a person reads; what is rounding is zero.
std::string text_of(const Vector3& v) {
  std::ostringstream out;
  out << std::setprecision(6) << '(';
  for (int i = 0; i < 3; ++i) out << (i == 0 ? "" : ", ") << (std::abs(v[i]) < 1e-12 ? 0.0 : v[i]);
  out << ')';
  return out.str();
}

std::string text_of(const ScrewAxis& axis) {
  const std::string line = "the line through " + text_of(axis.point()) + " along " + text_of(axis.line.direction);
  std::ostringstream out;
  out << std::setprecision(6);
  switch (axis.kind) {
    case MotionKind::rest: return "rests";
    case MotionKind::translation: return "moves along " + text_of(axis.line.direction);
    case MotionKind::rotation: return "turns about " + line;
    case MotionKind::screw: out << "turns about " << line << " and slides along it by " << axis.pitch << " m/rad";
  }
  return out.str();
}

/// "moment about x y, force along z"
std::string text_of(const IndeterminateReaction& reaction) {
  const auto axes = [](const std::array<bool, 3>& which, const std::string& word) {
    std::string text;
    for (std::size_t i = 0; i < 3; ++i) {
      if (which[i]) text += std::string(" ") + "xyz"[i];
    }
    return text.empty() ? text : word + text;
  };
  const std::string moment = axes(reaction.moment, "moment about"), force = axes(reaction.force, "force along");
  return moment + (moment.empty() || force.empty() ? "" : ", ") + force;
}

void explain_loop(const LoopFreedoms& loop, std::ostream& out) {
  switch (loop.kind) {
    case LoopKind::spatial: out << "spatial"; break;
    case LoopKind::planar: out << "planar across " << text_of(loop.normal); break;
    case LoopKind::spherical: out << "spherical about " << text_of(loop.centre); break;
  }
  out << ", closed by " << plural(static_cast<std::size_t>(loop.conditions), "condition", "conditions") << '\n';
}

void explain_redundancy(const Mechanism& mechanism, const Freedoms& freedoms, std::ostream& out) {
  if (freedoms.redundant_here > 0) {
    out << freedoms.redundant_here << " of " << mechanism.rows << " equations follow from the others here, "
        << freedoms.redundant_nearby << " at closed positions near by\n";
  }
  if (freedoms.shaky) {
    out << "Shaky: gives way to a small force, but has no other closed position near by\n";
  } else if (freedoms.mobility_nearby < freedoms.mobility_here) {
    out << "Singular position: motions are possible here that are not near by\n";
  }
  if (freedoms.mobility_here < freedoms.mobility_by_kind) {
    out << "Fewer freedoms than the count: axes are parallel, or meet, only to half the digits\n";
  } else if (!freedoms.shaky && freedoms.mobility_nearby > freedoms.mobility_by_kind) {
    out << "Overconstrained: "
        << plural(static_cast<std::size_t>(freedoms.mobility_nearby - freedoms.mobility_by_kind), "freedom", "freedoms")
        << " more than the count, owed to its exact measures alone\n";
  }
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

std::string explain(const Mechanism& mechanism, const Freedoms& freedoms) {
  std::ostringstream out;
  out << "Freedoms: " << freedoms.mobility_here << " by rank here, " << freedoms.mobility_by_kind
      << " by count with the kinds of the loops, " << mechanism.mobility_count << " by the spatial count\n";
  for (std::size_t i = 0; i < freedoms.loops.size(); ++i) {
    out << "  " << relation_name(mechanism, mechanism.relations[i]) << ": ";
    explain_loop(freedoms.loops[i], out);
  }
  explain_redundancy(mechanism, freedoms, out);
  for (const IsolatedFreedom& freedom : freedoms.isolated) {
    out << "Isolated freedom: " << mechanism.bodies[freedom.body.index()].name << ' ' << text_of(freedom.axis)
        << " while all others rest\n";
  }
  if (!freedoms.isolated.empty()) {
    out << "  An isolated freedom is held by a joint with one freedom less: a universal joint for one of two balls\n";
  }
  if (!freedoms.indeterminate.empty()) {
    out << "Reactions that statics alone does not determine, along the axes of the joint's inlet frame\n";
  }
  for (const IndeterminateReaction& reaction : freedoms.indeterminate) {
    out << "  " << mechanism.joints[reaction.joint.index()].name << ": " << text_of(reaction) << '\n';
  }
  bool any = false;
  for (std::size_t body = 1; body < freedoms.axes.size(); ++body) {
    if (freedoms.axes[body].kind == MotionKind::rest) continue;
    if (!any) out << "Screw axes of the velocities, in the world\n";
    any = true;
    out << "  " << mechanism.bodies[body].name << ' ' << text_of(freedoms.axes[body]) << '\n';
  }
  return out.str();
}

}  // namespace koppel

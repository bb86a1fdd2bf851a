// Mechanisms compiled from short scene texts, with the standard types and the stranger's plugin "acme".
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "../plugin/fixtures.hpp"
#include "base/error.hpp"
#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"
#include "odd_joints.hpp"
#include "scene/scene.hpp"

namespace koppel::test {

/// A compiled scene together with the types that it points to.
struct Built {
  /// Keeps the registry alive; several mechanisms may share one.
  explicit Built(const std::string& text, std::shared_ptr<Registry> from = types()) : registry(std::move(from)) {
    const std::string head = text.rfind("schema", 0) == 0 ? "" : "schema = 1\n";
    auto scene = read_scene_text(*registry, head + text, {}, diagnostics);
    if (!scene) throw std::runtime_error(diagnostics.render());
    description = std::move(*scene);
    auto compiled = compile(description, diagnostics);
    if (!compiled) throw std::runtime_error(koppel::render(compiled.error()));
    mechanism = std::move(*compiled);
  }
  static std::shared_ptr<Registry> types() {
    auto registry = std::make_shared<Registry>(with_strangers());
    if (auto added = registry->add(odd_plugin); !added) throw std::runtime_error(koppel::render(added.error()));
    return registry;
  }

  const Mechanism& operator*() const { return *mechanism; }
  const Mechanism* operator->() const { return mechanism.get(); }

  const Joint& joint(const std::string& name) const {
    for (const Joint& j : mechanism->joints) {
      if (j.name == name) return j;
    }
    throw std::runtime_error("no joint " + name);
  }
  /// Where a coordinate, say "crank.angle", stands in q.
  Eigen::Index coordinate(const std::string& name) const {
    for (std::size_t i = 0; i < mechanism->coordinate_names.size(); ++i) {
      if (mechanism->coordinate_names[i].name == name) return static_cast<Eigen::Index>(i);
    }
    throw std::runtime_error("no coordinate " + name);
  }

  std::shared_ptr<Registry> registry;
  Diagnostics diagnostics;
  Scene description;
  std::shared_ptr<const Mechanism> mechanism;
};

/// A scene with one joint between the ground and a body, at a place that is not simple.
inline std::string single_joint(const std::string& type_and_parameters) {
  return "[scene]\nlength = 1\n[[body]]\nname = 'part'\n[[joint]]\nname = 'joint'\ninlet = 'ground'\noutlet = "
         "'part'\n" +
         type_and_parameters;
}

/// A copy of a text with every occurrence of something replaced; there must be one.
inline std::string replaced(std::string text, const std::string& old, const std::string& with) {
  std::size_t i = text.find(old);
  if (i == std::string::npos) throw std::runtime_error("nothing to replace: " + old);
  for (; i != std::string::npos; i = text.find(old, i + with.size())) text.replace(i, old.size(), with);
  return text;
}

struct JointCase {
  std::string name;
  std::string text;  ///< type and parameters in a scene
  double accuracy;   ///< of its derivatives: rounding for products and callbacks, more for what core forms numerically
};

inline void PrintTo(const JointCase& joint, std::ostream* out) { *out << joint.name; }

/// All standard joints, and the stranger's that are not like one of them.
inline std::vector<JointCase> all_joints() {
  const double exact = 1e-13;
  const auto plain = [&](const std::string& name) { return JointCase{name, "type = '" + name + "'", exact}; };
  return {plain("revolute"),
          plain("prismatic"),
          {"helical", "type = 'helical'\npitch = 0.2", exact},
          plain("cylindrical"),
          plain("universal"),
          {"oblique_universal", "type = 'universal'\naxis2 = [1, 0.3, 0.8]", exact},
          plain("spherical"),
          plain("planar"),
          plain("free"),
          plain("weld"),
          {"shifted_cylindrical", "type = 'cylindrical'\nzero = { angle = 0.4, displacement = -0.1 }", exact},
          {"hinge", "type = 'acme.hinge'", exact},
          {"parallel", "type = 'odd.parallel'", exact},
          {"beside", "type = 'odd.beside'", exact},
          {"slide", "type = 'odd.slide'", exact},
          {"along", "type = 'odd.along'", exact},
          {"oblique", "type = 'odd.oblique'", exact},
          {"pointing", "type = 'odd.pointing'", 1e-10},
          {"varying_screw", "type = 'acme.varying_screw'\npitch = 0.2\ngrowth = 0.02\nzero = { angle = 0.2 }", exact},
          {"bare_screw", "type = 'acme.bare_screw'\npitch = 0.2\ngrowth = 0.02", 1e-10}};
}

/// A position of the whole mechanism at random: angles and lengths up to `size`, any quaternion.
template <typename Random>
Eigen::VectorXd random_position(const Mechanism& mechanism, Random& random, double size = 1.0) {
  Eigen::VectorXd q = State(mechanism).q, delta(mechanism.nv);
  for (Eigen::Index i = 0; i < delta.size(); ++i) delta[i] = random.between(-size, size);
  integrate(mechanism, q, delta, q);
  return q;
}

template <typename Random>
Eigen::VectorXd random_rates(Eigen::Index count, Random& random) {
  Eigen::VectorXd v(count);
  for (Eigen::Index i = 0; i < count; ++i) v[i] = random.between(-1, 1);
  return v;
}

}  // namespace koppel::test

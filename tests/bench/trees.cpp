#include "trees.hpp"

#include <cstdio>
#include <cstdlib>
#include <iomanip>
#include <random>
#include <sstream>

#include "mechanism/state.hpp"
#include "scene/scene.hpp"
#include "standard_types.hpp"

namespace koppel::bench {
namespace {

class Writer {
 public:
  explicit Writer(unsigned seed) : engine_(seed) {
    text_ << std::setprecision(17) << "schema = 1\n[scene]\nlength = 1\ngravity = [0, 0, -9.81]\n";
  }

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3 vector(double size) {
    const double x = between(-size, size), y = between(-size, size);
    return {x, y, between(-size, size)};
  }

  /// A bar of a length [m] with a mass [kg] and its joint. turns: about z, then y, then x.
  void add(const std::string& name, const std::string& type, const std::string& parent, const Vector3& at,
           const Vector3& turns, double mass, const Vector3& centre, double length) {
    const double a = between(0.05, 0.1), b = between(0.05, 0.1), f = mass / 12;
    text_ << "[[body]]\nname = '" << name << "'\ntype = 'rigid'\nmass = " << mass << "\ncentre_of_mass = [" << centre[0]
          << ", " << centre[1] << ", " << centre[2] << "]\ninertia = [" << f * (b * b + length * length) << ", "
          << f * (a * a + length * length) << ", " << f * (a * a + b * b) << ", " << 0.01 * f * a * b << ", 0, 0]\n"
          << "[[joint]]\nname = '" << name << "'\ntype = '" << type << "'\ninlet = { on = '" << parent << "', at = ["
          << at[0] << ", " << at[1] << ", " << at[2] << "], rotate = [['z', " << turns[0] << "], ['y', " << turns[1]
          << "], ['x', " << turns[2] << "]] }\noutlet = '" << name << "'\n";
  }

  Tree tree(const std::string& name) const;

 private:
  std::mt19937 engine_;
  std::ostringstream text_;
};

[[noreturn]] void stop(const std::string& why) {
  std::fputs(why.c_str(), stderr);
  std::exit(1);
}

std::vector<TreeState> random_states(const Mechanism& mechanism, int count) {
  std::mt19937 engine(99);
  const auto vector = [&] {
    std::uniform_real_distribution<double> between(-1, 1);
    return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(mechanism.nv, [&] { return between(engine); }));
  };
  std::vector<TreeState> states;
  for (int i = 0; i < count; ++i) {
    TreeState state{State(mechanism).q, vector(), vector(), vector()};
    integrate(mechanism, Eigen::VectorXd(state.q), vector(), state.q);
    states.push_back(std::move(state));
  }
  return states;
}

Tree Writer::tree(const std::string& name) const {
  Tree tree;
  tree.name = name;
  tree.registry = standard_types();
  Diagnostics findings;
  auto scene = read_scene_text(*tree.registry, text_.str(), {}, findings);
  if (!scene) stop(findings.render());
  auto mechanism = compile(*scene, findings);
  if (!mechanism) stop(render(mechanism.error()));
  tree.mechanism = std::move(*mechanism);
  auto masses = inertias(*tree.mechanism);
  if (!masses) stop(render(masses.error()));
  tree.inertias = std::move(*masses);
  tree.states = random_states(*tree.mechanism, 16);
  return tree;
}

}  // namespace

Tree arm7() {
  constexpr double right = 1.5707963267948966;
  struct Link {
    Vector3 at;
    double turn, mass;
  };
  const Link links[] = {{{0, 0, 0.333}, 0, 3.5},
                        {{0, 0, 0}, -right, 3},
                        {{0, -0.316, 0}, right, 2.8},
                        {{0.0825, 0, 0}, right, 2.6},
                        {{-0.0825, 0.384, 0}, -right, 2.2},
                        {{0, 0, 0}, right, 1.7},
                        {{0.088, 0, 0}, right, 0.8}};
  Writer writer(7);
  std::string parent = "ground";
  for (const Link& link : links) {
    const std::string name = "link" + std::to_string(&link - links);
    writer.add(name, "revolute", parent, link.at, {0, 0, link.turn}, link.mass, writer.vector(0.05), 0.2);
    parent = name;
  }
  return writer.tree("arm7");
}

Tree chain(int n) {
  Writer writer(static_cast<unsigned>(n));
  std::string parent = "ground";
  for (int i = 0; i < n; ++i) {
    const Vector3 turns = writer.vector(1.5);
    const Vector3 at = i == 0 ? Vector3(Vector3::Zero()) : Vector3(writer.vector(0.1) + Vector3(0, 0, 0.2));
    const double mass = writer.between(0.5, 2);
    const std::string name = "link" + std::to_string(i);
    writer.add(name, "revolute", parent, at, turns, mass, writer.vector(0.05) + Vector3(0, 0, 0.07), 0.2);
    parent = name;
  }
  return writer.tree("chain" + std::to_string(n));
}

Tree humanoid30() {
  constexpr double right = 1.5707963267948966;
  Writer writer(30);
  writer.add("trunk", "free", "ground", {0, 0, 0}, {0, 0, 0}, 10, {0, 0, 0.02}, 0.3);
  // Joints turn about z, y, x in turns.
  const auto limb = [&](const std::string& limb_name, std::string parent, const Vector3& root, int joints,
                        double length, double most) {
    for (int i = 0; i < joints; ++i) {
      const Vector3 turns = i % 3 == 0   ? Vector3(writer.between(-0.2, 0.2), 0, 0)
                            : i % 3 == 1 ? Vector3(0, 0, right)
                                         : Vector3(0, right, 0);
      Vector3 at = i == 0 ? root : writer.vector(0.02);
      if (i > 0) at.z() = i % 2 == 1 ? -length : 0.02;
      Vector3 centre = writer.vector(0.03);
      centre.z() = -length / 2;
      const std::string name = limb_name + std::to_string(i);
      writer.add(name, "revolute", parent, at, turns, most * writer.between(0.5, 1), centre, length);
      parent = name;
    }
    return parent;
  };
  limb("left_leg", "trunk", {0, 0.1, -0.1}, 6, 0.25, 4);
  limb("right_leg", "trunk", {0, -0.1, -0.1}, 6, 0.25, 4);
  const std::string chest = limb("waist", "trunk", {0, 0, 0.1}, 2, 0.1, 8);
  limb("left_arm", chest, {0, 0.2, 0.3}, 5, 0.2, 2);
  limb("right_arm", chest, {0, -0.2, 0.3}, 5, 0.2, 2);
  return writer.tree("humanoid30");
}

}  // namespace koppel::bench

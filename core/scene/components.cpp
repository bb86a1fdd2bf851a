// Bodies that no chain of joints connects to the ground float: the first of each such component gets a free joint.
#include <numeric>

#include "scene/type_values.hpp"

namespace koppel {
namespace {

/// Which bodies belong together (disjoint sets, with path halving).
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

void add_free_joints(Reading& reading) {
  Scene& scene = reading.scene;
  Components components(scene.bodies.size());
  for (const JointDescription& joint : scene.joints)
    components.join(joint.inlet.body.index(), joint.outlet.body.index());
  for (const Element& element : reading.bodies) {
    if (components.root(element.index) == components.root(ground.index())) continue;
    const BodyDescription& body = scene.bodies[element.index];
    const Reporter report = reading.reporter(*element.scope, element.label);
    auto type = reading.registry.joint("free", {});
    if (!type) {
      report.error(std::move(type).error(), element.table->place);
      return;
    }
    JointDescription joint;
    joint.name = body.name + ".free";
    while (!reading.names.add_joint(joint.name, JointId{static_cast<std::uint32_t>(scene.joints.size())})) {
      joint.name += '_';
    }
    joint.type = *type;
    for (const Parameter& parameter : joint.type->parameters) joint.values.push_back(fallback_value(parameter));
    joint.inlet = {ground, body.design};
    joint.outlet = {BodyId{static_cast<std::uint32_t>(element.index)}, {}};
    joint.coordinates.resize(joint.type->blocks.size());
    joint.source = body.source;
    report.note(Code::free_joint_added, element.table->place,
                "no joint connects the body to the ground; it gets the free joint " + quote(joint.name),
                "connect it, or write a free joint of your own if it shall be driven");
    scene.joints.push_back(std::move(joint));
    components.join(element.index, ground.index());
  }
}

}  // namespace koppel

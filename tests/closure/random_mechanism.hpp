// A mechanism drawn at random, as a scene text writes it.
#pragma once

#include <array>
#include <iomanip>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "closed.hpp"

namespace koppel::test {

/// What is special about a mechanism.
enum class Special {
  nothing,
  many_scales,      ///< bodies of sizes from 1e-3 to 1e3
  nearly_parallel,  ///< axes on a body differ by 1e-9 to 1e-2
  coaxial,          ///< axes on a body are one line
  zero_length,      ///< joints on a body have one origin
  planar,
  spherical,
  far_off,     ///< the ground's joints are 1e2 to 1e5 sizes away from its origin
  stranger,    ///< joints of other plugins: products under other names, and some that are none
  overdriven,  ///< one coordinate is held that follows from the others
  too_long     ///< one link is longer than all others of its loop together: nothing closes it
};
inline constexpr std::array<const char*, 11> special_names{"nothing",     "many_scales", "nearly_parallel", "coaxial",
                                                           "zero_length", "planar",      "spherical",       "far_off",
                                                           "stranger",    "overdriven",  "too_long"};

/// A joint with its parameters as lines of a scene; "?" stands for a pitch.
struct JointKind {
  std::string type, parameters;
  int freedoms;
};

/// The choice among which joints are drawn; those that come twice are drawn twice as often.
inline std::vector<JointKind> choice_of_joints(Special special) {
  const JointKind revolute{"revolute", "", 1}, prismatic{"prismatic", "", 1}, universal{"universal", "", 2},
      ball{"spherical", "", 3}, planar{"planar", "", 3};
  switch (special) {
    case Special::planar: return {revolute, revolute, revolute, prismatic, planar};
    case Special::spherical: return {revolute, revolute, universal, ball};
    case Special::too_long: return {revolute, revolute, universal, ball, {"acme.hinge", "", 1}};
    case Special::stranger:
      return {{"acme.hinge", "", 1},
              {"acme.cylindrical", "", 2},
              {"acme.helical", "pitch = ?\n", 1},
              {"odd.parallel", "", 2},
              {"odd.beside", "", 2},
              {"odd.slide", "", 2},
              {"odd.along", "", 2},
              {"odd.oblique", "", 2},
              {"acme.spherical", "", 3},
              {"acme.universal", "", 2},
              {"odd.pointing", "", 2},
              {"acme.varying_screw", "growth = 0.02\npitch = 0.5\n", 1},
              {"revolute", "", 1},
              {"prismatic", "", 1},
              {"acme.bare_screw", "growth = 0.02\npitch = 0.5\n", 1}};
    default:
      return {revolute,
              revolute,
              revolute,
              prismatic,
              {"cylindrical", "", 2},
              universal,
              ball,
              ball,
              planar,
              {"helical", "pitch = ?\n", 1},
              {"universal", "axis2 = [1, 0.3, 0.8]\n", 2},
              {"free", "", 6},
              {"weld", "", 0}};
  }
}

struct RandomJoint {
  std::size_t inlet = 0, outlet = 0;  ///< bodies; 0 is the ground
  JointKind kind;
  Pose at_inlet, at_outlet;
};

/// One registry for all of them: looking for plugins takes longer than reading a scene.
inline std::shared_ptr<Registry> types_of_random_mechanisms() {
  static const std::shared_ptr<Registry> types = Built::types();
  return types;
}

/// A frame as a scene writes it.
inline std::string frame_of(std::size_t body, const Pose& pose) {
  std::ostringstream out;
  const Vector4 q = quaternion_of_rotation<double>(pose.rotation);
  const Vector3& p = pose.position;
  out << std::setprecision(17) << "{ on = '" << (body == 0 ? "ground" : std::string("b") + std::to_string(body))
      << "', at = [" << p[0] << ", " << p[1] << ", " << p[2] << "], quaternion = [" << q[0] << ", " << q[1] << ", "
      << q[2] << ", " << q[3] << "] }";
  return out.str();
}

struct RandomMechanism {
  Special special = Special::nothing;
  std::size_t bodies = 1;           ///< without the ground
  std::vector<RandomJoint> joints;  ///< the first ones make a tree: number i carries body i + 1; the others close loops
  std::vector<std::pair<std::string, double>> drives;
  Eigen::VectorXd known;    ///< q of a closed position; of mechanisms that are too long: before they were stretched
  bool all_driven = false;  ///< the position is determined, or determined to first order at least

  std::size_t loops() const { return joints.size() - bodies; }

  /// The scene; with a position where the first closure starts, if there is one.
  std::string text(const Mechanism* of = nullptr, const Eigen::VectorXd* start = nullptr) const {
    std::ostringstream out;
    out << std::setprecision(17);
    for (std::size_t i = 1; i <= bodies; ++i) out << "[[body]]\nname = 'b" << i << "'\n";
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const RandomJoint& joint = joints[i];
      out << "[[joint]]\nname = 'j" << i << "'\ntype = '" << joint.kind.type << "'\n"
          << joint.kind.parameters << "inlet = " << frame_of(joint.inlet, joint.at_inlet)
          << "\noutlet = " << frame_of(joint.outlet, joint.at_outlet) << "\n";
      if (start != nullptr) write_start(out, of->joints[i], *start);
    }
    for (const auto& [of_what, value] : drives) {
      out << "[[drive]]\nof = '" << of_what << "'\ntype = 'constant'\nvalue = " << value << "\n";
    }
    return out.str();
  }

 private:
  static void write_start(std::ostream& out, const Joint& joint, const Eigen::VectorXd& q) {
    if (joint.blocks.empty()) return;
    out << "start = {";
    for (std::size_t b = 0; b < joint.blocks.size(); ++b) {
      const JointBlock& block = joint.blocks[b];
      out << (b == 0 ? " " : ", ") << joint.type->blocks[b].name << " = ";
      const std::size_t count = coordinate_count(block.kind);
      for (std::size_t i = 0; i < count; ++i) {
        out << (count == 1 ? "" : i == 0 ? "[" : ", ") << q[static_cast<Eigen::Index>(joint.q + block.q + i)];
      }
      out << (count == 1 ? "" : "]");
    }
    out << " }\n";
  }
};

}  // namespace koppel::test

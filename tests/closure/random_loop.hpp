// Single loops of given joints with random measures, built so that one closed position is known.
#pragma once

#include <iomanip>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "closed.hpp"

namespace koppel::test {

/// A joint of a random loop.
struct LoopJoint {
  std::string type;         ///< as in a scene, with parameters: "revolute", "helical'\npitch = '0.1"
  std::string driven;       ///< a coordinate that a drive holds at its known value; empty: none
  bool parallel = false;    ///< its inlet axes are those of the outlet of the joint before
  bool same_point = false;  ///< its inlet origin is the outlet origin of the joint before
  bool across = false;      ///< its inlet z axis is the outlet x axis of the joint before
};

struct RandomLoop {
  std::string text;
  Eigen::VectorXd known;  ///< q of a closed position
};

inline std::string frame_text(const std::string& body, const Pose& pose) {
  std::ostringstream out;
  const Vector4 q = quaternion_of_rotation<double>(pose.rotation);
  const Vector3& p = pose.position;
  out << std::setprecision(17) << "{ on = '" << body << "', at = [" << p[0] << ", " << p[1] << ", " << p[2]
      << "], quaternion = [" << q[0] << ", " << q[1] << ", " << q[2] << ", " << q[3] << "] }";
  return out.str();
}

inline Pose random_pose(Random& random, double size) {
  return {rotation_of_quaternion<double>(random.quaternion()), size * random.vector()};
}

/// Joints in the order of the walk, from the ground round to the ground; every second one is turned round in its
/// bodies.
inline RandomLoop random_loop(const std::vector<LoopJoint>& joints, Random& random) {
  const std::size_t n = joints.size();
  std::vector<Pose> inlets(n), outlets(n);
  for (std::size_t i = 0; i < n; ++i) {
    inlets[i] = random_pose(random, 0.5);
    outlets[i] = random_pose(random, 0.5);
    if (i == 0) continue;
    if (joints[i].parallel) inlets[i].rotation = outlets[i - 1].rotation;
    if (joints[i].across)
      inlets[i].rotation = outlets[i - 1].rotation * rotation_about<double>(Vector3::UnitY(), std::numbers::pi / 2);
    if (joints[i].same_point) inlets[i].position = outlets[i - 1].position;
  }
  const auto write = [&](const Eigen::VectorXd* q, const Built* built) {
    std::ostringstream bodies, rest;
    bodies << "[scene]\nlength = 1\n" << std::setprecision(17);
    rest << std::setprecision(17);
    for (std::size_t i = 0; i < n; ++i) {
      const auto body = [&](std::size_t k) {
        return k % n == 0 ? std::string("ground") : std::string("b") + std::to_string(k);
      };
      if (i > 0) bodies << "[[body]]\nname = '" << body(i) << "'\n";
      rest << "[[joint]]\nname = 'j" << i << "'\ntype = '" << joints[i].type
           << "'\ninlet = " << frame_text(body(i), inlets[i]) << "\noutlet = " << frame_text(body(i + 1), outlets[i])
           << "\n";
      if (joints[i].driven.empty() || q == nullptr) continue;
      const std::string name = std::string("j") + std::to_string(i) + "." + joints[i].driven;
      rest << "[[drive]]\nof = '" << name << "'\ntype = 'constant'\nvalue = " << (*q)[built->coordinate(name)] << "\n";
    }
    return bodies.str() + rest.str();
  };
  const Built open(write(nullptr, nullptr));
  RandomLoop result;
  result.known = random_position(*open, random, 1.5);
  Pose round;
  for (std::size_t i = 0; i < n; ++i) {
    const Joint& joint = open->joints[i];
    Pose moved;
    EXPECT_TRUE(joint.pose(result.known.data() + joint.q, moved));
    round = round * inlets[i] * moved;
    if (i + 1 == n) outlets[i] = round;  // on the ground, whose frame is the world
    round = round * outlets[i].inverse();
  }
  result.text = write(&result.known, &open);
  return result;
}

}  // namespace koppel::test

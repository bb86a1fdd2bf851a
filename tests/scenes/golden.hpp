// golden.toml as data; the head of that file tells what stands in it.
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace koppel::test {

/// What a scene or variant is known to be.
struct Facts {
  std::string scene;
  std::uint32_t bodies = 0, joints = 0, loops = 0, freedoms = 0;
  std::int32_t count = 0;  ///< Gruebler, spatial
  std::uint32_t rank = 0;
  std::int32_t mobility = 0;
  bool closes = false;  ///< at every step of its own run; false: not known to
};

/// The value of a coordinate, in SI units; a quaternion has four numbers.
struct Setting {
  std::string coordinate;
  std::vector<double> values;
};

struct Expectation {
  std::string quantity, name, unit;
  std::vector<double> values;  ///< in `unit`
  int digits = 0;
};

struct Case {
  std::string name;  ///< of the test
  std::string scene, source;
  bool closes = true;
  std::vector<Setting> inputs;
  std::optional<std::vector<Setting>> start;
  std::vector<Setting> speeds;
  std::vector<Expectation> expect;
};

struct Variant {
  std::string name, of;
  std::vector<std::pair<std::string, std::string>> replace;
};

struct Golden {
  std::vector<Facts> scenes;
  std::vector<Variant> variants;
  std::vector<Case> cases;

  const Facts& facts(const std::string& scene) const;
  /// The scene's text: a variant's is made by replacing, other files stand in apps/scenes or beside golden.toml.
  std::string text(const std::string& scene) const;
};

// How GoogleTest writes them.
inline void PrintTo(const Facts& facts, std::ostream* out) { *out << facts.scene; }
inline void PrintTo(const Case& described, std::ostream* out) { *out << described.name; }

/// The one in this folder. Throws std::runtime_error where it is not as its head says.
Golden read_golden();

}  // namespace koppel::test

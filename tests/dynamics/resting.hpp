// Scenes closed at their start, on their way to rest and to linear equations.
#pragma once

#include <stdexcept>
#include <string>

#include "../mechanism/built.hpp"
#include "closure/close.hpp"
#include "dynamics/equilibrium.hpp"
#include "dynamics/linearisation.hpp"

namespace koppel::test {

struct Started {
  explicit Started(const std::string& text) : built(text), work(built.mechanism), state(*built.mechanism) {
    Report report;
    if (close(work, state, {}, report) < 0) throw std::runtime_error("the scene does not close");
  }

  Eigen::Index q(const std::string& name) const { return built.coordinate(name); }
  /// Number of a rate.
  std::uint32_t v(const std::string& name) const {
    for (std::uint32_t i = 0; i < built->nv; ++i) {
      if (built->rate_names[i].name == name) return i;
    }
    throw std::runtime_error("no rate " + name);
  }

  Result<Equilibrium> rest(const EquilibriumOptions& options = {}) const {
    return find_equilibrium(built.mechanism, state, options);
  }
  /// One that must be there.
  Equilibrium found(const EquilibriumOptions& options = {}) const {
    auto result = rest(options);
    if (!result) throw std::runtime_error(koppel::render(result.error()));
    if (!result->found) throw std::runtime_error(result->why);
    return std::move(*result);
  }
  /// Goes to an equilibrium.
  void take(const Equilibrium& equilibrium) { take_place(*built.mechanism, equilibrium, state); }
  Linearisation linear(const LinearisationOptions& options = {}) const {
    auto result = linearise(built.mechanism, state, options);
    if (!result) throw std::runtime_error(koppel::render(result.error()));
    return std::move(*result);
  }

  Built built;
  Work work;
  State state;
};

/// A point mass of 2 kg at 0.5 m on a pivot about z; it hangs at -90 deg.
inline std::string pendulum(const std::string& start, const std::string& more = "") {
  return "[scene]\ngravity = [0, -9.81, 0]\nlength = 1\n[[body]]\nname = 'bob'\nmass = 2\ncentre_of_mass = [0.5, 0, "
         "0]\n"
         "[[joint]]\nname = 'pivot'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'bob'\nstart = { angle = " +
         start + " }\n" + more;
}

}  // namespace koppel::test

#include "dynamics/formulation.hpp"

#include <algorithm>
#include <array>

namespace koppel {
namespace {

constexpr std::array all{
    FormulationName{Formulation::minimal, "minimal", "independent coordinates, loops closed at every evaluation"},
    FormulationName{Formulation::projected, "projected",
                    "all coordinates of the tree and multipliers (index 1), projected after every step"},
    FormulationName{Formulation::baumgarte, "baumgarte",
                    "the same with Baumgarte's stabilisation: quick, and open by about the tolerance"},
};

}  // namespace

std::span<const FormulationName> formulations() { return all; }

const FormulationName* find_formulation(std::string_view name) {
  const auto* found = std::find_if(all.begin(), all.end(), [&](const FormulationName& x) { return x.name == name; });
  return found == all.end() ? nullptr : found;
}

}  // namespace koppel

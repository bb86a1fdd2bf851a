// How loops enter the equations of motion, and the ways by name.
#pragma once

#include <span>
#include <string_view>

namespace koppel {

enum class Formulation { minimal, projected, baumgarte };

struct FormulationName {
  Formulation kind;
  std::string_view name;
  std::string_view description;  ///< a line
};

/// All of them; the first is what is taken where none is named.
std::span<const FormulationName> formulations();
/// Null: there is none of this name.
const FormulationName* find_formulation(std::string_view name);

}  // namespace koppel

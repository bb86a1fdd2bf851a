// How loops enter the equations of motion, and the ways by name: scenes name them, core/dynamics has the equations.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/integrators.hpp"

namespace koppel {

enum class Formulation { minimal, projected, baumgarte, ggl, index3 };

struct FormulationName {
  Formulation kind;
  std::string_view name;
  std::optional<IntegratorKind> integrator;  ///< the only one that solves it; nothing: those of differential equations
  std::string_view description;              ///< a line
};

/// All of them; the first is what is taken where none is named.
std::span<const FormulationName> formulations();
/// Null: there is none of this name.
const FormulationName* find_formulation(std::string_view name);
/// The one that an integrator is made for; the first if it is for differential equations.
const FormulationName& formulation_for(IntegratorKind integrator);
/// "there is no formulation `x`", and the choices as advice.
std::string no_such_formulation(std::string_view name);
std::string formulation_choices();

/// Why an integrator does not solve a formulation, and what to take instead.
struct FormulationClash {
  std::string why, advice;
};
/// Nothing: it solves it.
std::optional<FormulationClash> clash(const IntegratorName& integrator, const FormulationName& formulation);

}  // namespace koppel

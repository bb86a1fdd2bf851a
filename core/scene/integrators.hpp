// The integrators by name: scenes name them, core/dynamics makes them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace koppel {

enum class StepControl { tolerance, step };

enum class IntegratorKind {
#define KOPPEL_INTEGRATOR(name, type, control, description) name,
#include "scene/integrators.inc"
#undef KOPPEL_INTEGRATOR
};

struct IntegratorName {
  IntegratorKind kind;
  std::string_view name;
  StepControl control;
  std::string_view description;  ///< a line
};

/// All of them.
std::span<const IntegratorName> integrators();
/// Null: there is none of this name.
const IntegratorName* find_integrator(std::string_view name);
/// What is taken where none is named.
const IntegratorName& default_integrator(StepControl control);
/// "there is no integrator `x`", and the choices as advice.
std::string no_such_integrator(std::string_view name);
std::string integrator_choices(std::string_view misspelt);

}  // namespace koppel

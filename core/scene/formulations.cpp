#include "scene/formulations.hpp"

#include <algorithm>
#include <array>

namespace koppel {
namespace {

constexpr std::array all{
    FormulationName{Formulation::minimal, "minimal", {}, "independent coordinates, loops closed at every evaluation"},
    FormulationName{Formulation::projected,
                    "projected",
                    {},
                    "all coordinates of the tree and multipliers (index 1), projected after every step"},
    FormulationName{Formulation::baumgarte,
                    "baumgarte",
                    {},
                    "the same with Baumgarte's stabilisation: quick, and open by about the tolerance"},
    FormulationName{Formulation::ggl, "ggl", IntegratorKind::ida,
                    "multipliers for positions and for rates beside the equations (index 2; Gear, Gupta, Leimkuhler)"},
    FormulationName{Formulation::index3, "index3", IntegratorKind::generalised_alpha,
                    "multipliers for positions beside the equations (index 3): fixed steps, stiff forces"},
};

}  // namespace

std::span<const FormulationName> formulations() { return all; }

const FormulationName* find_formulation(std::string_view name) {
  const auto* found = std::find_if(all.begin(), all.end(), [&](const FormulationName& x) { return x.name == name; });
  return found == all.end() ? nullptr : found;
}

const FormulationName& formulation_for(IntegratorKind integrator) {
  const auto* found = std::find_if(all.begin(), all.end(), [&](const auto& x) { return x.integrator == integrator; });
  return found == all.end() ? all.front() : *found;
}

std::string no_such_formulation(std::string_view name) { return "there is no formulation `" + std::string(name) + "`"; }

std::string formulation_choices() {
  std::string list;
  for (const FormulationName& x : all) list += (list.empty() ? "there are: " : ", ") + std::string(x.name);
  return list;
}

std::optional<FormulationClash> clash(const IntegratorName& integrator, const FormulationName& formulation) {
  const FormulationName& own = formulation_for(integrator.kind);
  const bool solves = formulation.integrator ? formulation.integrator == integrator.kind : !own.integrator;
  if (!solves) {
    const std::string_view other = formulation.integrator
                                       ? integrators()[static_cast<std::size_t>(*formulation.integrator)].name
                                       : default_integrator(integrator.control).name;
    return FormulationClash{
        "does not solve the formulation " + std::string(formulation.name),
        "take the formulation " + std::string(own.name) + ", or the integrator " + std::string(other)};
  }
  if (formulation.kind == Formulation::projected && integrator.kind == IntegratorKind::cvode) {
    return FormulationClash{"goes on from what it remembers, not from what is projected",
                            "take the formulation minimal or baumgarte"};
  }
  return std::nullopt;
}

}  // namespace koppel

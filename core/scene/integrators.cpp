#include "scene/integrators.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "base/error.hpp"

namespace koppel {
namespace {

constexpr std::array all{
#define KOPPEL_INTEGRATOR(name, type, control, description) \
  IntegratorName{IntegratorKind::name, #name, StepControl::control, description},
#include "scene/integrators.inc"
#undef KOPPEL_INTEGRATOR
};

}  // namespace

std::span<const IntegratorName> integrators() { return all; }

const IntegratorName* find_integrator(std::string_view name) {
  const auto* found = std::find_if(all.begin(), all.end(), [&](const IntegratorName& x) { return x.name == name; });
  return found == all.end() ? nullptr : found;
}

const IntegratorName& default_integrator(StepControl control) {
  return *std::find_if(all.begin(), all.end(), [&](const IntegratorName& x) { return x.control == control; });
}

std::string no_such_integrator(std::string_view name) { return "there is no integrator `" + std::string(name) + "`"; }

std::string integrator_choices(std::string_view misspelt) {
  std::vector<std::string> names;
  std::string list;
  for (const IntegratorName& x : all) {
    names.emplace_back(x.name);
    list += (list.empty() ? "" : ", ") + names.back();
  }
  const auto near = nearest_name(misspelt, names);
  return (near ? "did you mean `" + *near + "`? " : std::string()) + "there are: " + list;
}

}  // namespace koppel

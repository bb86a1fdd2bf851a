#include "closure/loop_cut.hpp"

#include <cmath>

namespace koppel {

Place<double> place(const Variable& variable, const double* q) {
  const double* at = q + variable.q;
  switch (variable.kind) {
    case VariableKind::turn: return {std::cos(*at), std::sin(*at), 0.0, 0.0};
    case VariableKind::slide: return {*at, 0.0, 0.0, 0.0};
    case VariableKind::ball: return {at[0], at[1], at[2], at[3]};
  }
  return {};
}

std::vector<Place<double>> places(std::span<const Variable> variables, const double* q) {
  std::vector<Place<double>> result;
  result.reserve(variables.size());
  for (const Variable& variable : variables) result.push_back(place(variable, q));
  return result;
}

}  // namespace koppel

// Directions of motion, matrices and places of rest, as commands show them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/model.hpp"

namespace koppel::app {

/// The rates that take the greatest part in a direction, with their parts: lengths over the scene's.
inline std::string participants(const Model& model, const std::vector<double>& rates) {
  constexpr std::size_t most = 4;
  constexpr double least = 0.05;
  const double length = model.settings().length;
  std::vector<std::pair<double, std::size_t>> parts;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const double scale = model.unit(KOPPEL_KIND_RATE, i) == "m/s" ? length : 1.0;
    if (std::abs(rates[i]) / scale >= least) parts.emplace_back(rates[i] / scale, i);
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  std::string text;
  for (std::size_t k = 0; k < std::min(most, parts.size()); ++k) {
    char number[32];
    std::snprintf(number, sizeof number, " %+.3f", parts[k].first);
    text += (k == 0 ? "" : ", ") + model.name(KOPPEL_KIND_RATE, parts[k].second) + number;
  }
  return parts.size() > most ? text + " and others" : text;
}

/// The finding that there is no equilibrium.
inline koppel_error no_rest(const Model& model, const koppel_equilibrium* equilibrium) {
  auto error = sized<koppel_error>();
  error.status = KOPPEL_NOT_CLOSED;
  error.severity = KOPPEL_SEVERITY_ERROR;
  std::snprintf(error.code, sizeof error.code, "E1101");
  std::snprintf(error.element, sizeof error.element, "scene %s", model.name(KOPPEL_KIND_SCENE, 0).c_str());
  koppel_equilibrium_why(equilibrium, error.message, sizeof error.message, nullptr);
  std::snprintf(error.advice, sizeof error.advice,
                "hold what is driven away by a drive, a spring or a stop, or start nearer to where it should rest");
  return error;
}

/// Row by row.
inline nlohmann::ordered_json json_of_matrix(const std::vector<double>& values, std::size_t rows, std::size_t columns) {
  auto matrix = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < rows; ++i) {
    auto row = nlohmann::ordered_json::array();
    for (std::size_t j = 0; j < columns; ++j) row.push_back(values[i * columns + j]);
    matrix.push_back(std::move(row));
  }
  return matrix;
}

}  // namespace koppel::app

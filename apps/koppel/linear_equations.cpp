#include "koppel/linear_equations.hpp"

#include "koppel/resting.hpp"

namespace koppel::app {

LinearNumbers linear_numbers(const koppel_linearisation* linearisation, std::int32_t kind, std::size_t count,
                             const std::vector<std::string>& wanted) {
  LinearNumbers result;
  const auto text = [&](auto* of, std::size_t i) {
    return text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
      return of(linearisation, kind, i, buffer, size, needed);
    });
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = text(koppel_linearisation_name, i);
    bool shown = wanted.empty();
    for (const std::string& start : wanted) shown = shown || name == start || name.rfind(start + " ", 0) == 0;
    if (!shown) continue;
    result.shown.push_back(i);
    result.names.push_back(name);
    result.units.push_back(text(koppel_linearisation_unit, i));
  }
  return result;
}

LinearMode linear_mode(const koppel_linearisation* linearisation, std::size_t i, std::size_t rates) {
  LinearMode result;
  result.real.resize(rates);
  result.imaginary = result.real;
  auto found = sized<koppel_eigenmode>();
  koppel_linearisation_mode(linearisation, i, &found, result.real.data(), result.imaginary.data(), result.real.size());
  result.eigenvalue = {found.real, found.imaginary};
  result.error = found.error;
  return result;
}

nlohmann::ordered_json json_of_linear_matrix(const koppel_linearisation* linearisation, std::int32_t what,
                                             const LinearNumbers& rows, std::size_t all_rows,
                                             const LinearNumbers& columns, std::size_t all_columns) {
  std::vector<double> values(all_rows * all_columns), errors(values);
  koppel_linearisation_matrix(linearisation, what, values.data(), errors.data(), values.size());
  const auto picked = [&](const std::vector<double>& from) {
    std::vector<double> result;
    for (const std::size_t i : rows.shown) {
      for (const std::size_t j : columns.shown) result.push_back(from[i * all_columns + j]);
    }
    return json_of_matrix(result, rows.shown.size(), columns.shown.size());
  };
  return {{"values", picked(values)}, {"errors", picked(errors)}};
}

nlohmann::ordered_json json_of_numbers(const LinearNumbers& numbers) {
  auto list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < numbers.names.size(); ++i) {
    list.push_back({{"name", numbers.names[i]}, {"unit", numbers.units[i]}});
  }
  return list;
}

nlohmann::ordered_json json_of_mode(const Model& model, const LinearMode& mode) {
  nlohmann::ordered_json document{{"real", mode.eigenvalue.real()},
                                  {"imaginary", mode.eigenvalue.imag()},
                                  {"error", mode.error},
                                  {"frequency", mode.frequency()},
                                  {"damping_ratio", nullptr},
                                  {"shape", nlohmann::ordered_json::object()}};
  if (!mode.is_zero()) document["damping_ratio"] = mode.damping();
  for (std::size_t i = 0; i < mode.real.size(); ++i) {
    document["shape"][model.name(KOPPEL_KIND_RATE, i)] = {mode.real[i], mode.imaginary[i]};
  }
  return document;
}

}  // namespace koppel::app

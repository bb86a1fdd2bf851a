// Linear equations of motion as commands show them: read from the library, and as JSON.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/model.hpp"

namespace koppel::app {

/// Eigenvalue, its error, and the displacements along all rates.
struct LinearMode {
  std::complex<double> eigenvalue;
  double error = 0.0;
  std::vector<double> real, imaginary;

  bool is_zero() const { return std::abs(eigenvalue) <= error; }
  /// Of a pair the second one.
  bool is_conjugate() const { return eigenvalue.imag() < 0.0; }
  double frequency() const { return std::abs(eigenvalue) / (2.0 * std::numbers::pi); }
  double damping() const { return 0.0 - eigenvalue.real() / std::abs(eigenvalue); }
};

/// Where the numbers of x, u or y stand that are shown, and what they are called.
struct LinearNumbers {
  std::vector<std::size_t> shown;
  std::vector<std::string> names, units;
};

/// kind: KOPPEL_LINEAR_STATE etc., of which there are `count`. wanted: names that may go on with a blank; empty: all.
LinearNumbers linear_numbers(const koppel_linearisation* linearisation, std::int32_t kind, std::size_t count,
                             const std::vector<std::string>& wanted);

/// The i-th one, with its displacements along as many rates.
LinearMode linear_mode(const koppel_linearisation* linearisation, std::size_t i, std::size_t rates);

/// Values and errors of a matrix, KOPPEL_MATRIX_A etc., in the rows and columns shown; it has so many of each.
nlohmann::ordered_json json_of_linear_matrix(const koppel_linearisation* linearisation, std::int32_t what,
                                             const LinearNumbers& rows, std::size_t all_rows,
                                             const LinearNumbers& columns, std::size_t all_columns);
nlohmann::ordered_json json_of_numbers(const LinearNumbers& numbers);
nlohmann::ordered_json json_of_mode(const Model& model, const LinearMode& mode);

}  // namespace koppel::app

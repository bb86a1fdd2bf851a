// The inputs of an operation, and what must come out.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "spatial/types.hpp"

namespace koppel::bench {

/// Unit quaternions from which all inputs are made.
using Rotations = std::vector<Vector4T<long double>>;

/// Uniform over the group, the same ones in every run.
Rotations random_rotations(std::size_t count);
/// 1e-9 [rad] away from what is singular for one kind of coordinates or another: identity, half turns, gimbal lock.
Rotations special_rotations(std::size_t count);

/// How far the worst result is from the right one: the length of the difference, relative to the length of the right
/// result if that is more than one, in units of rounding, 2^-53.
struct Errors {
  double error = 0;
  double by_condition = 0;  ///< the same after division by the condition of each input
};

struct Problem {
  std::vector<double> inputs;  ///< numbers of all, one input after the other
  /// For each input its right results: several if they are the same rotation, such as q and -q.
  std::vector<std::vector<Eigen::VectorX<long double>>> answers;
  /// For each input how much an error of rounding in it is enlarged by the operation itself, at least 1. Known of
  /// conversions; else 1.
  std::vector<double> conditions;
  Eigen::Index angles = 0;  ///< so many of the last numbers of a result are angles: full turns do not count

  /// A result that is not a number is infinitely wrong.
  Errors errors(const std::vector<double>& results) const;
};

struct Operation {
  std::string name;
  std::function<Problem(const Rotations&)> problem;
};

/// All, in the order of operations.hpp.
std::vector<Operation> operations();

}  // namespace koppel::bench

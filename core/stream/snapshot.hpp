// What a stream is made of: the names that are told once, and the numbers that follow.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace koppel {

struct NameAndUnit {
  std::string name;
  std::string unit;
};

/// The meaning of the numbers in every snapshot of a stream.
struct StreamModel {
  std::string scene;
  std::string title;
  std::string version;  ///< of the library
  double length = 1;    ///< [m] characteristic length
  std::uint64_t hash = 0;
  std::vector<NameAndUnit> coordinates;
  std::vector<NameAndUnit> rates;
  std::vector<std::string> joints;
  std::vector<std::string> bodies;  ///< ground included
};

/// How a closure went: koppel_report of koppel.h and the status that came with it.
struct ClosureFigures {
  std::int32_t verdict = 0;
  std::int32_t solver = 0;
  std::int32_t status = 0;
  std::uint32_t iterations = 0;
  std::uint32_t rank = 0;
  std::uint32_t equations = 0;
  std::uint32_t unknowns = 0;
  double residual = 0;
  double condition = 0;
  double coordinate_error = 0;
};

/// A borrowed view of where a mechanism stands; read during the call it is given to.
struct Snapshot {
  double time = 0;                          ///< [s] simulated
  std::span<const double> q;                ///< as many as StreamModel::coordinates
  std::span<const double> v;                ///< as many as StreamModel::rates
  std::span<const double> a;                ///< as many as StreamModel::rates
  std::span<const double> poses;            ///< 12 for each body: rotation matrix row by row, then the position [m]
  const ClosureFigures* closure = nullptr;  ///< may be missing
};

}  // namespace koppel

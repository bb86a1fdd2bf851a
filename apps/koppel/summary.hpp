// What a run was like: accuracy, effort and time of its steps.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "koppel/command.hpp"

namespace koppel::app {

/// A median and the half width of its 95 % interval.
struct Median {
  double value = 0.0;
  double error = 0.0;
};

/// Median of a sample. The interval is that of a notched box plot, 1.57 times the interquartile range over the root of
/// the sample's size (McGill, Tukey, Larsen 1978).
Median median(std::vector<double> sample);

/// Takes in the report of the first closure and of each step after it.
class Summary {
 public:
  void assemble(koppel_status status, const koppel_report& report, double seconds);
  /// seconds: what the step took by the wall clock.
  void add(double time, koppel_status status, const koppel_report& report, double seconds);

  /// names: of the coordinates, one in a line. Only the first call counts.
  void leave_limits(double time, std::string names);

  /// count: of positions where branches meet, passed in one step; time: of the drives at the last of them.
  void pass_change_points(std::uint32_t count, double time);
  /// limit: where the drives turned back in the step that ends at `time`.
  void pass_limits(double time, nlohmann::ordered_json limit);

  std::uint32_t steps() const { return static_cast<std::uint32_t>(seconds_.size()); }
  void print(std::FILE* out) const;
  void write(nlohmann::ordered_json& document) const;

 private:
  void take_in(double time, koppel_status status, const koppel_report& report);

  std::vector<double> seconds_;
  double assembly_seconds_ = 0.0;
  std::uint32_t assembly_iterations_ = 0;
  double worst_residual_ = 0.0;
  double worst_time_ = 0.0;
  double worst_coordinate_error_ = 0.0;
  double least_condition_ = 0.0;
  double greatest_condition_ = 0.0;
  std::uint64_t iterations_ = 0;
  std::uint32_t most_iterations_ = 0;
  std::uint32_t ceres_steps_ = 0;
  koppel_status remarks_ = KOPPEL_OK;
  std::optional<double> branch_changed_time_;  ///< the first one
  double limit_time_ = 0.0;                    ///< the first at which a coordinate was outside its limits
  std::string limit_names_;                    ///< then
  bool assembled_ = false;
  std::uint64_t change_points_ = 0;
  double change_point_time_ = 0.0;  ///< of the first step that passed one
  nlohmann::ordered_json limits_ = nlohmann::ordered_json::array();
};

}  // namespace koppel::app

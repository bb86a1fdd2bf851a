#include "koppel/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace koppel::app {
namespace {

double quantile(const std::vector<double>& sorted, double fraction) {
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// The value, or null where it would mean nothing.
nlohmann::ordered_json unless(bool missing, nlohmann::ordered_json value) {
  return missing ? nullptr : std::move(value);
}

bool has(koppel_status remarks, koppel_status bit) { return (remarks & bit) != 0; }

}  // namespace

Median median(std::vector<double> sample) {
  if (sample.empty()) return {};
  std::sort(sample.begin(), sample.end());
  const double range = quantile(sample, 0.75) - quantile(sample, 0.25);
  return {quantile(sample, 0.5), 1.57 * range / std::sqrt(static_cast<double>(sample.size()))};
}

void Summary::take_in(double time, koppel_status status, const koppel_report& report) {
  if (report.residual > worst_residual_) {
    worst_residual_ = report.residual;
    worst_time_ = time;
  }
  worst_coordinate_error_ = std::max(worst_coordinate_error_, report.coordinate_error);
  remarks_ |= status;
  if (!branch_changed_time_ && has(status, KOPPEL_BRANCH_CHANGED)) branch_changed_time_ = time;
}

void Summary::assemble(koppel_status status, const koppel_report& report, double seconds) {
  take_in(0.0, status, report);
  least_condition_ = greatest_condition_ = report.condition;
  assembled_ = true;
  assembly_seconds_ = seconds;
  assembly_iterations_ = report.iterations;
}

void Summary::add(double time, koppel_status status, const koppel_report& report, double seconds) {
  take_in(time, status, report);
  least_condition_ = std::min(least_condition_, report.condition);
  greatest_condition_ = std::max(greatest_condition_, report.condition);
  iterations_ += report.iterations;
  most_iterations_ = std::max(most_iterations_, report.iterations);
  if (report.solver == KOPPEL_SOLVER_CERES) ++ceres_steps_;
  seconds_.push_back(seconds);
}

void Summary::leave_limits(double time, std::string names) {
  if (!limit_names_.empty()) return;
  limit_time_ = time;
  std::replace(names.begin(), names.end(), '\n', ' ');
  limit_names_ = std::move(names);
}

void Summary::pass_change_points(std::uint32_t count, double time) {
  if (change_points_ == 0) change_point_time_ = time;
  change_points_ += count;
}

void Summary::pass_limits(double time, nlohmann::ordered_json limit) {
  limit["at"] = time;
  limits_.push_back(std::move(limit));
}

void Summary::print(std::FILE* out) const {
  std::fprintf(out, "assembly    %u iterations, %.3g ms\n", assembly_iterations_, 1e3 * assembly_seconds_);
  std::fprintf(out, "residual    at most %.1e, at t = %.6g s; coordinates within %.1e\n", worst_residual_, worst_time_,
               worst_coordinate_error_);
  if (steps() > 0) {
    std::fprintf(out, "iterations  %.2f a step, at most %u; %u steps needed Ceres\n",
                 static_cast<double>(iterations_) / steps(), most_iterations_, ceres_steps_);
  }
  std::fprintf(out, "condition   %.3g to %.3g\n", least_condition_, greatest_condition_);
  if (steps() > 0) {
    const Median step = median(seconds_);
    std::fprintf(out,
                 "step        %.2f +- %.2f us (median and its 95 %% interval; position, velocity and acceleration)\n",
                 1e6 * step.value, 1e6 * step.error);
  }
  if (has(remarks_, KOPPEL_REDUNDANT)) std::fputs("remark      some closure equations follow from the others\n", out);
  if (has(remarks_, KOPPEL_NEAR_SINGULAR)) std::fputs("remark      passes a badly conditioned position\n", out);
  if (branch_changed_time_) {
    std::fprintf(out, "remark      changes its branch first at t = %.6g s: use more steps\n", *branch_changed_time_);
  }
  if (change_points_ > 0) {
    std::fprintf(out, "remark      passes %llu change points, where branches meet, first at t = %.9f s\n",
                 static_cast<unsigned long long>(change_points_), change_point_time_);
  }
  if (!limits_.empty()) {
    const nlohmann::ordered_json& first = limits_.front();
    std::fprintf(out, "remark      passes %zu limits of its drives, first of %s, at t = %.9f s of the drives\n",
                 limits_.size(), first["drive"].get<std::string>().c_str(), first["time"].get<double>());
  }
  if (!limit_names_.empty()) {
    std::fprintf(out, "remark      leaves the limits of %s first at t = %.6g s\n", limit_names_.c_str(), limit_time_);
  }
}

void Summary::write(nlohmann::ordered_json& document) const {
  const Median step = median(seconds_);
  document["steps"] = steps();
  document["max_residual"] = unless(!assembled_, worst_residual_);
  document["max_residual_time"] = unless(!assembled_, worst_time_);
  document["max_coordinate_error"] = unless(!assembled_, worst_coordinate_error_);
  document["iterations"] = {{"total", iterations_}, {"max", most_iterations_}, {"steps_with_ceres", ceres_steps_}};
  document["condition"] = unless(!assembled_, {{"min", least_condition_}, {"max", greatest_condition_}});
  document["assembly"] = unless(!assembled_, {{"iterations", assembly_iterations_}, {"seconds", assembly_seconds_}});
  document["seconds_per_step"] = unless(steps() == 0, step.value);
  document["seconds_per_step_error"] = unless(steps() == 0, step.error);
  document["branch_changed_time"] = unless(!branch_changed_time_, branch_changed_time_.value_or(0.0));
  document["change_points"] = change_points_;
  document["change_point_time"] = unless(change_points_ == 0, change_point_time_);
  document["limits"] = limits_;
  document["remarks"] = {{"redundant", has(remarks_, KOPPEL_REDUNDANT)},
                         {"near_singular", has(remarks_, KOPPEL_NEAR_SINGULAR)},
                         {"branch_changed", has(remarks_, KOPPEL_BRANCH_CHANGED)},
                         {"limit_exceeded", has(remarks_, KOPPEL_LIMIT_EXCEEDED)},
                         {"change_point", has(remarks_, KOPPEL_CHANGE_POINT)}};
}

}  // namespace koppel::app

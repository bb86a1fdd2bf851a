// The search for a place where forces balance: along them, or straight to a root.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "dynamics/statics.hpp"

namespace koppel {

/// Moves the statics, which it borrows, from where they stand.
class RestSearch {
 public:
  RestSearch(const Mechanism& mechanism, Statics& statics, std::uint32_t max_iterations);

  /// Along the forces, to where their work is greatest. False: why() tells.
  bool descend();
  /// To a root near by, by Levenberg's and Marquardt's method.
  bool find_root();

  double force_scale() const { return std::max(weight_, stiffest_); }
  double residual() const;
  double error() const { return newton_.size() == 0 ? 0.0 : newton_.lpNorm<Eigen::Infinity>(); }
  const Eigen::VectorXd& r() const { return place_.r; }
  std::uint32_t iterations() const { return iterations_; }
  const std::string& why() const { return why_; }
  /// A plugin failed, or nothing could be evaluated.
  bool broken() const { return broken_; }

 private:
  /// What acts where the search stands, and how it changes beside it.
  struct Place {
    Eigen::VectorXd r;         ///< forces along the coordinates [J], rates of the states
    Eigen::MatrixXd jacobian;  ///< dr/dz
  };

  bool look();
  bool advance();
  bool plugin_failed(bool evaluated);
  bool is_balanced() const;
  bool polish();
  Eigen::VectorXd step_within(double radius) const;
  bool fail(std::string why);
  std::string strongest() const;
  double most_radius() const;

  const Mechanism& mechanism_;
  Statics& statics_;
  std::uint32_t most_, iterations_ = 0;
  double weight_, stiffest_ = 0.0;
  Place place_;
  Eigen::VectorXd newton_;  ///< what would take the forces away
  std::string why_;
  bool broken_ = false;
};

}  // namespace koppel

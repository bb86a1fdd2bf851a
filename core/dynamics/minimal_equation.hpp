// The equations of motion in independent coordinates: the loops are closed exactly wherever they are evaluated.
#pragma once

#include "dynamics/motion_equation.hpp"

namespace koppel {

/// Dependent coordinates of y only tell where closing starts.
class MinimalEquation final : public MotionEquation {
 public:
  using MotionEquation::MotionEquation;

  bool place(double time, const Eigen::VectorXd& y) override {
    delta_ = y.head(rates_);
    independent_ = rates_of(y);
    return motion_.close(chart_, time, delta_) && motion_.velocities(independent_);
  }
  /// Takes over the dependent coordinates as they were closed where the motion stands.
  bool settle(double /*time*/, Eigen::VectorXd& y) override {
    y.head(rates_) = delta_;
    return true;
  }

 protected:
  const std::vector<std::uint32_t>& integrated() const override { return motion_.independent(); }

 private:
  Eigen::VectorXd independent_;
};

}  // namespace koppel

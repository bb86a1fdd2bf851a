// The equations of motion as a differential equation in independent coordinates.
#pragma once

#include <limits>

#include "dynamics/chart.hpp"
#include "dynamics/differential_equation.hpp"
#include "dynamics/equations_of_motion.hpp"

namespace koppel {

/// y: local coordinates of all rates (nv), of which the dependent ones only tell where closing starts; the independent
/// rates; internal states of the forces; the work done from outside less what was dissipated.
class MinimalEquation final : public DifferentialEquation {
 public:
  explicit MinimalEquation(EquationsOfMotion& motion);

  /// Makes y for a position with its rates, of which the independent ones count. False: the motion tells why.
  bool start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double time, const Eigen::VectorXd& states,
             Eigen::VectorXd& y);
  /// Closes the loops at y and gives them rates: the motion then stands there.
  bool place(double time, const Eigen::VectorXd& y);
  /// The same, and accelerations.
  bool realise(double time, const Eigen::VectorXd& y);
  /// The choice of coordinates or the chart has come near its limit where the motion stands.
  bool is_worn() const;
  /// y where the motion stands, in a chart about it and in independent coordinates chosen there anew.
  bool renew(double time, Eigen::VectorXd& y);
  /// Takes over the dependent coordinates as they were closed where the motion stands.
  void take_closed(Eigen::VectorXd& y) const;

  /// What counts as one joule for the tolerance of the work; it is not controlled otherwise.
  void set_energy_scale(double joules);

  double work(const Eigen::VectorXd& y) const { return y[size_ - 1]; }
  const double* states(const Eigen::VectorXd& y) const { return y.data() + states_; }

  Eigen::Index size() const override { return size_; }
  const Eigen::VectorXd& scales() const override { return scales_; }
  bool rate(double time, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) override;

 private:
  void lay_out();
  void write(const Eigen::VectorXd& v, Eigen::VectorXd& y) const;

  EquationsOfMotion& motion_;
  Chart chart_;
  double energy_scale_ = std::numeric_limits<double>::infinity();
  Eigen::Index rates_ = 0, states_ = 0, size_ = 0;
  Eigen::VectorXd scales_, delta_, delta_rate_, y_rate_, independent_, start_q_, start_v_;
};

}  // namespace koppel

// The equations of motion as a differential equation: what its formulations have in common.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "dynamics/archive.hpp"
#include "dynamics/chart.hpp"
#include "dynamics/differential_equation.hpp"
#include "dynamics/equations_of_motion.hpp"
#include "scene/formulations.hpp"

namespace koppel {

/// y: local coordinates of all rates (nv); the rates that are integrated; internal states of the forces; the work done
/// from outside less what was dissipated.
class MotionEquation : public DifferentialEquation {
 public:
  explicit MotionEquation(EquationsOfMotion& motion);

  /// Makes y for a position with its rates, of which those that are integrated count. False: the motion tells why.
  bool start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double time, const Eigen::VectorXd& states,
             Eigen::VectorXd& y);
  /// The motion then stands at y, with rates.
  virtual bool place(double time, const Eigen::VectorXd& y) = 0;
  /// The loops closed at y, rates that fit, and accelerations.
  virtual bool realise(double time, const Eigen::VectorXd& y) { return rate(time, y, y_rate_); }
  /// The choice of coordinates or the chart has come near its limit where the motion stands.
  bool is_worn() const;
  /// y where the motion stands, in a chart about it and in independent coordinates chosen there anew.
  bool renew(double time, Eigen::VectorXd& y);
  /// What becomes of y at the end of a step; the motion stands there. False: as place().
  virtual bool settle(double time, Eigen::VectorXd& y) = 0;

  /// Tells the chart and the choice of coordinates. False: what is read does not fit.
  bool exchange(Archive& archive);

  /// What counts as one joule for the tolerance of the work; it is not controlled otherwise.
  void set_energy_scale(double joules);

  double work(const Eigen::VectorXd& y) const { return y[size_ - 1]; }
  const double* states(const Eigen::VectorXd& y) const { return y.data() + states_; }

  Eigen::Index size() const override { return size_; }
  const Eigen::VectorXd& scales() const override { return scales_; }
  bool rate(double time, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) override;
  double rounding() const override;
  Eigen::Index positions() const override { return rates_; }
  bool position_rates(double time, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) override;

 protected:
  /// Rates (in v) that are integrated.
  virtual const std::vector<std::uint32_t>& integrated() const = 0;
  /// Those of y, in their order.
  auto rates_of(const Eigen::VectorXd& y) const {
    return y.segment(rates_, static_cast<Eigen::Index>(integrated().size()));
  }
  void write(const Eigen::VectorXd& v, Eigen::VectorXd& y) const;

  EquationsOfMotion& motion_;
  Chart chart_;
  Eigen::Index rates_ = 0;
  Eigen::VectorXd delta_;  ///< where the motion stands

 private:
  bool choose(const Eigen::VectorXd& q, double time);
  void lay_out();

  double chosen_at_ = 0.0;  ///< [s] when the base became the base, and coordinates were chosen there
  double energy_scale_ = std::numeric_limits<double>::infinity();
  Eigen::Index states_ = 0, size_ = 0;
  Eigen::VectorXd scales_, delta_rate_, y_rate_, start_q_, start_v_;
};

std::unique_ptr<MotionEquation> make_equation(Formulation formulation, EquationsOfMotion& motion);

}  // namespace koppel

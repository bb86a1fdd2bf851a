// What integrators by SUNDIALS have in common.
#pragma once

#include <memory>

#include "dynamics/integrator.hpp"
#include "dynamics/sundials.hpp"

namespace koppel {

/// Steps with a memory of SUNDIALS. What that remembers of past steps is its own: where a step is shortened,
/// coordinates change or it pauses, it starts again.
class SundialsIntegrator : public Integrator {
 public:
  SundialsIntegrator(const SundialsIntegrator&) = delete;
  SundialsIntegrator& operator=(const SundialsIntegrator&) = delete;

  StepStatus step(double limit) override;
  bool shorten(double t) override;
  void interpolate(double t, Eigen::VectorXd& y) override;
  bool restart(double t, const Eigen::VectorXd& y) override { return start(t, y); }
  bool pause(double t) override { return t < time_ ? shorten(t) : start(time_, Eigen::VectorXd(y_)); }
  bool exchange(Archive& archive) override;

 protected:
  using Integrator::Integrator;

  /// One step from where the vectors stand, no further than the limit and, if that can be told, no shorter than
  /// `least`. t: where it ends. Returns what SUNDIALS does: negative if it failed.
  virtual int advance(double limit, double least, double& t) = 0;
  /// Steps that were rejected or could not be solved, since the start.
  virtual long failures() const = 0;
  /// Of the method in the last step, and derivatives of the vector at its end. False: there is none.
  virtual int last_order() const = 0;
  virtual bool derivative(int k, N_Vector into) = 0;
  /// y from the unknowns of SUNDIALS at t.
  virtual bool unfold(double t, const Eigen::VectorXd& unknowns, Eigen::VectorXd& y) = 0;

  std::unique_ptr<SundialsVectors> vectors_;

 private:
  StepPolynomial polynomial_;
  int creeping_ = 0;             ///< steps in a row that hardly went on
  Eigen::VectorXd raw_, moved_;  ///< as SUNDIALS has it; y
};

/// Of differential equations y' = f(t, y) whose method needs the Jacobian of f, by difference quotients.
class SundialsOde : public SundialsIntegrator {
 public:
  void settle(const Eigen::VectorXd& y) override;

 protected:
  using SundialsIntegrator::SundialsIntegrator;

  /// Vectors that stand at y; false if there were some of this size already.
  bool make_vectors(const Eigen::VectorXd& y);
  bool unfold(double t, const Eigen::VectorXd& unknowns, Eigen::VectorXd& y) override;

  /// For SUNDIALS; `of` is this.
  static int rate(realtype t, N_Vector y, N_Vector y_rate, void* of);
  static int weights(N_Vector y, N_Vector weights, void* of);
  static int jacobian(realtype t, N_Vector y, N_Vector y_rate, SUNMatrix matrix, void* of, N_Vector, N_Vector,
                      N_Vector);

  Eigen::VectorXd rate_;

 private:
  Eigen::VectorXd argument_;
};

}  // namespace koppel

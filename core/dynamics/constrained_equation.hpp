// The equations of motion with the loops' conditions beside them: a differential-algebraic system, solved as it stands.
#pragma once

#include <vector>

#include "dynamics/multiplier_equation.hpp"

namespace koppel {

/// In the unknowns u: positions (n, local coordinates) and rates (n) of all coordinates of the tree that are not
/// driven; internal states of the forces (s); the work. With the mass matrix M, efforts f, conditions g(q, t) = 0 of
/// the loops and G their derivative along the rates:
///
///   positions' = T (v - W G^T mu),  M v' = f + G^T lambda,  g = 0,  G v + dg/dt = 0
///
/// T: from rates to local coordinates. W: squares of the rates' scales. With mu and the last condition the system has
/// the index 2 (Gear, Leimkuhler, Gupta, Automatic integration of Euler-Lagrange equations with constraints, 1985),
/// without them the index 3. Conditions that follow from others have no multiplier: their loops bear nothing.
class ConstrainedEquation final : public MultiplierEquation {
 public:
  explicit ConstrainedEquation(EquationsOfMotion& motion);

  /// n, s, m: coordinates, internal states, conditions; they change where the equation is started or renewed.
  struct Sizes {
    Eigen::Index coordinates = 0, states = 0, conditions = 0;
    Eigen::Index unknowns() const { return 2 * coordinates + states + 1; }
  };
  Sizes sizes() const;

  /// u of y.
  void gather(const Eigen::VectorXd& y, Eigen::VectorXd& u) const;
  /// y of u; what is driven stands as the drives want it at the time. False: as place().
  bool spread(double time, const Eigen::VectorXd& u, Eigen::VectorXd& y);
  /// u' and lambda (m) at y, where positions are closed and rates fit. False: as place().
  bool begin(double time, const Eigen::VectorXd& y, Eigen::VectorXd& u_rate, Eigen::VectorXd& lambda);

  /// What is missing to the system, in its order: n, n, s, 1, m, m. False: as place().
  bool residual(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& u_rate, const Eigen::VectorXd& lambda,
                const Eigen::VectorXd& mu, Eigen::VectorXd& missing);

  /// The size of one of each unknown: of the rates and local coordinates their scales; infinite where none counts.
  void unknown_scales(Eigen::VectorXd& scales) const;

  /// Lets positions go on from those of u along the rates, by an increment (n) of a motion in a straight line of the
  /// group: turns add up as turns.
  void move(const Eigen::VectorXd& increment, Eigen::VectorXd& u);
  /// Second derivatives (n) of local coordinates about u's position, of a motion whose rates are u's and constant.
  void bend(const Eigen::VectorXd& u, Eigen::VectorXd& bending);

 private:
  bool stand(double time, const Eigen::VectorXd& u);
  void go_near(const Eigen::VectorXd& u);
  void take(const Eigen::VectorXd& of_rates, double* to) const;
  void put(const double* from, Eigen::VectorXd& of_rates) const;

  Chart near_;  ///< about a position on the way
  Eigen::VectorXd rates_now_, accelerations_, multipliers_, opening_, efforts_, moved_, moved_rate_, position_, y_rate_;
};

}  // namespace koppel

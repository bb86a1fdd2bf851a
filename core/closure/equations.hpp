// The closure equations of a mechanism: residuals, Jacobian, and the terms that velocities and accelerations add. Rows
// in metres are divided by the mechanism's length, rates of lengths multiplied by it: everything has the size of an
// angle.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "mechanism/kinematics.hpp"
#include "mechanism/mechanism.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// Calls visit(row, rate) for every entry of a relation's own Jacobian, row by row: those of its path, then its coupled
/// ones.
template <typename Visit>
void for_each_entry(const Relation& relation, const Visit& visit) {
  for (std::uint32_t row = relation.first_row; row < relation.first_row + relation.rows; ++row) {
    for (const auto* rates : {&relation.path, &relation.coupled}) {
      for (const PathRate& rate : *rates) visit(row, rate);
    }
  }
}

/// Evaluates the equations at one position after another; scratch of one thread. A function that returns false met a
/// plugin that failed; culprit() then tells which.
class Equations {
 public:
  explicit Equations(const Mechanism& mechanism);

  const Mechanism& mechanism;
  Kinematics kinematics;
  Eigen::VectorXd residual;  ///< rows, scaled
  /// Rows x columns, scaled: unknowns first, then driven rates. Its pattern stays.
  Eigen::SparseMatrix<double> jacobian;

  /// Forward kinematics and residuals at q.
  bool evaluate(const Eigen::VectorXd& q, double time);
  /// The Jacobian at the position last evaluated.
  void evaluate_jacobian();
  /// One relation's rows of it in its own columns, in the order of for_each_entry(). Rates are not scaled here.
  void relation_jacobian(std::size_t relation, double* block) const;
  /// Frames of a relation in the world, at the position last evaluated.
  const Pose& frame_a(std::size_t relation) const { return locals_[relation].a; }
  const Pose& frame_b(std::size_t relation) const { return locals_[relation].b; }
  /// The wrench on frame b, about its origin and in world axes, by multipliers of a relation's scaled rows (all rows
  /// are given).
  Wrench reaction(std::size_t relation, const Eigen::VectorXd& multipliers) const;
  /// The greatest scaled residual.
  double error() const { return residual.size() == 0 ? 0.0 : residual.lpNorm<Eigen::Infinity>(); }

  /// Coordinates of the joints at which loops are cut, into q, at the closed position last evaluated.
  bool cut_coordinates(Eigen::VectorXd& q);
  /// dr/dt with everything at rest, scaled.
  bool time_rate(Eigen::VectorXd& rate);
  /// Velocities and accelerations of all nodes.
  bool motion(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a);
  /// Rates of the cut joints into v; after motion() with the rates of all others.
  bool cut_rates(const Eigen::VectorXd& q, Eigen::VectorXd& v);
  /// Scaled d2r/dt2 without the terms linear in accelerations; after motion() with zero accelerations, v complete.
  bool bias(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& bias);
  /// Accelerations of the cut joints into a; after motion() with the accelerations of all others, v complete.
  bool cut_accelerations(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& a);

  /// "joint crank of type acme.hinge": whose function failed last.
  std::string culprit() const;
  /// Makes a drive the culprit.
  void blame(const Input& input);

 private:
  /// Where one relation stands, and its own Jacobian, unscaled.
  struct Local {
    Pose a, b;                     ///< its frames in the world
    Pose relative;                 ///< b in a
    std::vector<double> by_twist;  ///< rows x 6
    std::vector<double> by_rate;   ///< rows x coordinates, of a constraint
    std::vector<double> q, v;      ///< its coordinates and rates, of a constraint
    std::vector<double> out;       ///< rows
  };

  void lay_out_jacobian();
  bool evaluate_relation(const Relation& relation, Local& local, const Eigen::VectorXd& q);
  bool evaluate_constraint(const Relation& relation, Local& local);
  koppel_configuration configuration(const Relation& relation, const Local& local, bool with_rates);
  RelativeTwist relation_motion(const Relation& relation, const Local& local) const;
  bool joint_failed(JointId joint);
  bool constraint_failed(std::uint32_t constraint);

  double time_ = 0.0;
  std::vector<Local> locals_;
  std::vector<double> block_;        ///< of one relation's Jacobian
  std::vector<Eigen::Index> order_;  ///< where its entries go in that of all, one relation after another
  std::array<double, 12> pose_array_{};
  std::array<double, 6> twist_array_{};
  std::string (*culprit_kind_)(const Mechanism&, std::uint32_t) = nullptr;
  std::uint32_t culprit_index_ = 0;
};

}  // namespace koppel

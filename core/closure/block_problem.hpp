// A numerical block of a flow as a family of systems over the complex numbers, for continuation. All lengths are in
// units of the mechanism's.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "closure/continuation.hpp"
#include "closure/flow.hpp"

namespace koppel {

/// Unknowns: those of the step. Equations: its conditions, whose values the parameters shift; and, of a loop that
/// enters as a whole, that the way round leads back, to where the parameters displace its end. Parameters zero: the
/// mechanism as it is.
class BlockProblem final : public ContinuationProblem {
 public:
  enum class Family {
    these_measures,  ///< mechanisms with the same measures
    all_measures     ///< the parameters displace the joints of a single loop, or the ends of six rods, too: all
                     ///< mechanisms of the kind. Mechanisms with special measures may have fewer solutions.
  };
  /// q: the state in which everything that the step is given is set. all_measures is these_measures if the number of
  /// solutions of all is not known.
  BlockProblem(const Flow& flow, const FlowStep& step, const Eigen::VectorXd& q, Family family);

  /// As many independent equations as unknowns.
  bool is_square() const { return square_; }
  /// How many solutions the mechanisms of all_measures have, where that is known; else 0. A single loop: 16 with at
  /// most one slide, 8 with two, 2 with three (Primrose 1986, Lee and Liang 1988; Mavroidis and Roth 1994). A body on
  /// six points that keep their distances from six others: 40 (Ronga and Vust 1992, Lazard 1993); a condition that
  /// keeps a point in a plane is a limit of that.
  Eigen::Index known_count() const { return known_count_; }
  /// Writes the real part of a solution into q; angles nearest to those in q.
  void read(const ComplexVector& x, Eigen::VectorXd& q) const;
  /// Whether two positions have the same unknowns, to half the digits.
  bool equal(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  Eigen::Index unknowns() const override { return tangents_; }
  Eigen::Index point_size() const override { return numbers_; }
  Eigen::Index parameters() const override { return parameters_; }
  void evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                const ComplexVector* dp, ComplexVector* along_dp) override;
  void move(const ComplexVector& x, const ComplexVector& delta, ComplexVector& result) const override;
  void lift(const ComplexVector& x, const ComplexVector& rate, ComplexVector& derivative,
            ComplexVector& scratch) const override;
  void fingerprint(const ComplexVector& x, ComplexVector& print) const override;
  bool seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) override;

 private:
  struct Unknown {
    std::uint32_t variable = 0;
    VariableKind kind = VariableKind::turn;
    Eigen::Index number = 0;   ///< first, in a point
    Eigen::Index tangent = 0;  ///< first
  };
  struct Row {
    ClosureCondition condition;
    Way lower, upper;
  };
  using Columns = std::vector<WayColumn<Complex>>;

  void set_places(const ComplexVector& x);
  void conditions(const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian, const ComplexVector* dp,
                  ComplexVector* along_dp);
  void whole_loop(std::size_t index, const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                  const ComplexVector* dp, ComplexVector* along_dp);
  void combine(ComplexVector& residual, ComplexMatrix* jacobian, ComplexVector* along_dp) const;
  bool has_unknowns(const Way& way) const;
  Eigen::Index count_solutions(const Flow& flow, const FlowStep& step) const;

  std::vector<Variable> variables_;
  std::vector<Row> rows_;
  std::vector<Way> whole_;  ///< once round each loop that enters as a whole
  std::vector<Unknown> unknowns_;
  std::vector<Place<Complex>> at_;
  std::vector<std::int32_t> unknown_of_;  ///< of each variable, -1: known
  Eigen::Index tangents_ = 0, numbers_ = 0, parameters_ = 0, equations_ = 0;
  Eigen::Index known_count_ = 0;
  bool square_ = false;
  bool displaces_joints_ = false;
  bool displaces_points_ = false;
  double length_ = 1.0;
  ComplexMatrix combination_;  ///< tangents x equations, if there are more equations
  ComplexVector all_residual_, all_along_;
  ComplexMatrix all_jacobian_;
  Columns columns_;
};

}  // namespace koppel

// Following a moving mechanism by its solution flow: every coordinate with its rate and acceleration from closed forms,
// or by Newton's method in one unknown or two, in the order of the flow. Nothing is allocated or factorised; of each
// closed form the solution is taken that continues the motion.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "closure/flow.hpp"
#include "closure/moving_walk.hpp"
#include "closure/product_form.hpp"
#include "mechanism/mechanism.hpp"

namespace koppel {

/// What a step of the tracker tells of its accuracy, in the units of the report.
struct TrackedAccuracy {
  double residual = 0.0;
  double condition = 1.0;         ///< greatest ratio of a condition's amplitude to its slope in its unknown
  double coordinate_error = 0.0;  ///< estimated, from rounding in the conditions carried through the flow
};

class FlowTracker {
 public:
  /// Nothing if a step must be solved numerically or has a choice (a link that may spin), or if the inputs leave
  /// freedoms.
  static std::optional<FlowTracker> of(const Mechanism& mechanism, const Flow& flow);

  /// On which side of its singular positions each step stands in a closed position: the sign of the slope that it
  /// divides by, and the number of the condition that has it. Between two positions of one side, none was passed.
  using Sides = std::vector<std::int8_t>;
  void find_sides(const Eigen::VectorXd& q, Sides& sides);

  /// q: start values near the solution, with the inputs at their targets; v and a: those of the inputs. All are
  /// completed. sides: of the position that the motion comes from. False: near a singular position or past one, or the
  /// solution that continues the motion is not certain; q, v and a are spoilt then.
  bool follow(Eigen::VectorXd& q, Eigen::VectorXd& v, Eigen::VectorXd& a, const Sides& sides,
              TrackedAccuracy& accuracy);

  /// Of the closure's equations where the mechanism is not singular; for whoever follows, who finds it at the first
  /// position that the tracker has reached.
  std::optional<std::uint32_t> regular_rank;

 private:
  /// A condition: written out if few coordinates enter it, walked along if not.
  struct Row {
    ClosureCondition condition;
    std::optional<ProductForm> form;
    Way lower, upper;
  };
  struct Step {
    StepKind kind = StepKind::one_unknown;
    std::vector<std::uint32_t> unknowns;
    std::vector<std::uint32_t> given;
    std::vector<Row> rows;
    Way around;                 ///< of a joint: from behind it to before it
    bool against = false;       ///< of a joint: its slide points against its turn
    std::vector<bool> inverse;  ///< of a joint: of each unknown that is a ball
  };
  FlowTracker(const Mechanism& mechanism, const Flow& flow);

  bool compile(const Flow& flow, const FlowStep& from, Step& step) const;
  void compile_joint(const Flow& flow, const FlowStep& from, Step& step) const;

  bool solve_one(const Step& step, std::int8_t side);
  bool solve_turn(const LastVariable& form, std::uint32_t variable);
  bool solve_slide(const LastVariable& form, std::uint32_t variable);
  bool solve_form(const Row& row, std::uint32_t variable);
  bool solve_walk(const Row& row, std::uint32_t variable);
  bool solve_two(const Step& step, std::int8_t side);
  std::int8_t side_of(const Step& step);
  Eigen::Matrix2d jacobian_of(const Step& step) const;
  std::size_t steepest(const Step& step);
  void read_joint(const Step& step);
  void read_ball(const MovingPose& before, bool inverse, std::uint32_t variable);

  double slope(const Row& row, std::uint32_t variable);
  void place(std::uint32_t variable, double x);
  void place_turn(std::uint32_t variable, double x, double cosine, double sine);
  void set_motion(std::uint32_t variable, double v, double a);
  double error_through(const ProductForm& form, std::uint32_t unknown, double slope) const;
  double error_through(const Row& row, std::uint32_t unknown, double slope) const;
  void take_error(std::uint32_t variable, double error);

  double length_ = 1.0;
  std::vector<Variable> variables_;
  std::vector<std::uint32_t> inputs_;
  std::vector<Step> steps_;
  // Of the call that is going on; of each variable.
  std::vector<CoordinateBasis> bases_;
  std::vector<MovingPlace> places_;
  std::vector<double> errors_;  ///< [rad, m]; of balls none are carried on
  Eigen::VectorXd *q_ = nullptr, *v_ = nullptr, *a_ = nullptr;
  TrackedAccuracy accuracy_;
};

}  // namespace koppel

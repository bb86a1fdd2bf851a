// Following a moving mechanism by its solution flow: every coordinate with its rate and acceleration from closed forms,
// or by Newton's method in the few unknowns of a block, in the order of the flow. Nothing is allocated; of each closed
// form the solution is taken that continues the motion.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "closure/flow.hpp"
#include "closure/product_form.hpp"
#include "closure/tracked_way.hpp"
#include "mechanism/kinematics.hpp"
#include "mechanism/mechanism.hpp"

namespace koppel {

/// What a step of the tracker tells of its accuracy, in the units of the report.
struct TrackedAccuracy {
  double residual = 0.0;
  double condition = 1.0;  ///< greatest ratio of a condition's amplitude to its slope in its unknown, or of a block
  double coordinate_error = 0.0;  ///< estimated, from rounding in the conditions carried through the flow
};

class FlowTracker {
 public:
  /// Nothing if a block is large, or enters with whole loops, if a step has a choice (a link that may spin), or if the
  /// inputs leave freedoms.
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
    TrackedWay lower, upper;
    std::array<double, 2> rigid{};  ///< the condition's values on ways without motions
  };
  /// An angle as a sum of others.
  struct TurnSum {
    double constant = 0.0;
    std::vector<std::pair<std::uint32_t, double>> terms;  ///< variables, +-1
  };
  struct Step {
    StepKind kind = StepKind::one_unknown;
    std::vector<std::uint32_t> unknowns;
    std::vector<std::uint32_t> given;
    std::vector<Row> rows;
    TrackedWay around;                ///< of a joint: from behind it to before it
    std::optional<TurnSum> sum;       ///< of a joint that is a turn among parallel ones: instead of the way around
    bool against = false;             ///< of a joint: its slide points against its turn
    std::vector<bool> inverse;        ///< of a joint: of each unknown that is a ball
    std::vector<int> column;          ///< of a block: of each variable the first column, -1: given or not there
    Eigen::Index size = 0;            ///< of a block
    std::vector<std::uint32_t> runs;  ///< known with it
  };
  static constexpr int most_unknowns = 12;  ///< rates of a block
  using BlockMatrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_unknowns, most_unknowns>;
  using BlockVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_unknowns, 1>;
  /// A walked condition: how far it is open, how fast given variables open it, and by how much it is uncertain; over
  /// its size.
  struct Linear {
    double open = 0.0, given = 0.0, uncertain = 0.0;
  };
  struct BlockLinear {
    explicit BlockLinear(Eigen::Index n) : open(n), given(n), uncertain(n) {}
    BlockVector open, given, uncertain;
  };
  /// The bodies of an imaginary joint, and its coordinates.
  struct Imaginary {
    Node a = 0, b = 0;
    std::uint32_t first = 0;  ///< variable
  };
  FlowTracker(const Mechanism& mechanism, const Flow& flow);

  bool compile(const Flow& flow, const FlowStep& from, std::vector<Place<double>>& places, Step& step) const;
  void compile_joint(const Flow& flow, const FlowStep& from, Step& step) const;
  static std::optional<TurnSum> sum_of_turns(const TrackedWay& around);
  void compile_runs();

  bool follow_steps(const Sides& sides);
  bool solve_one(Step& step, std::int8_t side);
  bool solve_turn(const LastVariable& form, std::uint32_t variable);
  bool solve_slide(const LastVariable& form, std::uint32_t variable);
  bool solve_form(const Row& row, std::uint32_t variable, double& slope);
  bool solve_walk(Row& row, std::uint32_t variable, double& slope);
  bool solve_harmonic(Row& row, std::uint32_t variable);
  bool solve_by_slopes(Row& row, std::uint32_t variable);
  bool solve_two(const Step& step, std::int8_t side);
  bool solve_block(Step& step, std::int8_t side);
  template <typename Unknown>
  Linear linearise(const Row& row, const Unknown& unknown);
  template <typename Unknown>
  void linearise(const TrackedWay& way, const ConditionSlope<double>& slope, const Unknown& unknown, Linear& at) const;
  double walked_slope(Row& row, std::uint32_t variable) const;
  void place_runs(const Step& step);
  void finish_runs(std::span<const std::uint32_t> runs);
  void linearise(Step& step, BlockMatrix& jacobian, BlockLinear& at);
  void shift_block(const Step& step, const BlockVector& by);
  void set_block_motion(const Step& step, const BlockVector& v, const BlockVector& a);
  double bending(const Row& row);
  void start_imaginary();
  std::int8_t side_of(Step& step);
  Eigen::Matrix2d jacobian_of(const Step& step) const;
  std::size_t steepest(Step& step);
  void read_joint(Step& step);
  void read_sum(const TurnSum& sum, std::uint32_t variable);
  void read_ball(const Pose& before, const WayMotion& motion, bool inverse, std::uint32_t variable);

  double slope(Row& row, std::uint32_t variable);
  void place(std::uint32_t variable, double x);
  void place_turn(std::uint32_t variable, double x, double cosine, double sine);
  void place_ball(std::uint32_t variable, const Vector4& quaternion);
  void set_motion(std::uint32_t variable, double v, double a);
  void set_ball_motion(std::uint32_t variable, const Vector3& v, const Vector3& a);
  double unit(std::uint32_t variable) const { return variables_[variable].kind == VariableKind::slide ? length_ : 1.0; }
  double error_through(const ProductForm& form, std::uint32_t unknown, double slope) const;
  void take_error(std::uint32_t variable, double error);

  double length_ = 1.0;
  std::vector<Variable> variables_;
  std::vector<std::uint32_t> inputs_;
  std::vector<Step> steps_;
  // Of the call that is going on; of each variable.
  std::vector<CoordinateBasis> bases_;
  TrackedPlaces places_;
  std::vector<double> errors_;  ///< [rad, m]
  const Mechanism* mechanism_ = nullptr;
  std::vector<Imaginary> imaginary_;
  Kinematics kinematics_;                    ///< tells where imaginary joints start
  std::array<Eigen::VectorXd, 3> extended_;  ///< q, v, a, those of imaginary joints behind the mechanism's
  std::vector<std::uint32_t> first_runs_;    ///< of inputs alone
  Eigen::VectorXd *q_ = nullptr, *v_ = nullptr, *a_ = nullptr;
  TrackedAccuracy accuracy_;
};

}  // namespace koppel

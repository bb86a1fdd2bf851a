#include "closure/ceres_closure.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "mechanism/coordinates.hpp"

namespace koppel {
namespace {

/// Core's own integrate and difference as a Ceres manifold.
class BlockManifold final : public ceres::Manifold {
 public:
  explicit BlockManifold(BlockKind kind) : kind_(kind) {}

  int AmbientSize() const override { return static_cast<int>(coordinate_count(kind_)); }
  int TangentSize() const override { return static_cast<int>(rate_count(kind_)); }
  bool Plus(const double* x, const double* delta, double* result) const override {
    integrate_block(kind_, x, delta, result);
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    tangent_block(kind_, x, jacobian);
    return true;
  }
  bool Minus(const double* y, const double* x, double* delta) const override {
    difference_block(kind_, x, y, delta);
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    std::array<double, 12> tangent{};
    tangent_block(kind_, x, tangent.data());
    const std::size_t n = coordinate_count(kind_), t = rate_count(kind_);
    for (std::size_t i = 0; i < t; ++i) {
      for (std::size_t k = 0; k < n; ++k) jacobian[i * n + k] = pseudo_inverse_factor(kind_) * tangent[k * t + i];
    }
    return true;
  }

  /// The columns of the tangent map are orthogonal and of equal length: its pseudo-inverse is a multiple of its
  /// transpose.
  static double pseudo_inverse_factor(BlockKind kind) { return kind == BlockKind::quaternion ? 4.0 : 1.0; }

 private:
  BlockKind kind_;
};

/// Forward kinematics, residuals and Jacobian once for all residual blocks of an evaluation.
class Evaluation final : public ceres::EvaluationCallback {
 public:
  explicit Evaluation(Work& work) : work_(work) {}

  void PrepareForEvaluation(bool jacobians, bool new_point) override {
    if (new_point) usable = work_.equations.evaluate(work_.q, time);
    if (jacobians && usable) work_.equations.evaluate_jacobian();
  }

  double time = 0.0;
  bool usable = true;

 private:
  Work& work_;
};

/// One relation; its parameter blocks are the coordinate blocks it depends on.
class RelationCost final : public ceres::CostFunction {
 public:
  RelationCost(const Work& work, const Evaluation& evaluation, const Relation& relation,
               std::vector<const StateBlock*> blocks)
      : work_(work), evaluation_(evaluation), relation_(relation), blocks_(std::move(blocks)) {
    set_num_residuals(static_cast<int>(relation.rows));
    for (const StateBlock* block : blocks_) {
      mutable_parameter_block_sizes()->push_back(static_cast<int>(coordinate_count(block->kind)));
    }
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals, double** jacobians) const override {
    if (!evaluation_.usable) return false;
    const Equations& equations = work_.equations;
    for (std::uint32_t i = 0; i < relation_.rows; ++i) residuals[i] = equations.residual[relation_.first_row + i];
    if (jacobians == nullptr) return true;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (jacobians[b] != nullptr) block_jacobian(*blocks_[b], jacobians[b]);
    }
    return true;
  }

 private:
  /// Our Jacobian is along rates; Ceres wants it along the numbers of the block.
  void block_jacobian(const StateBlock& block, double* out) const {
    const Mechanism& mechanism = work_.equations.mechanism;
    const std::size_t n = coordinate_count(block.kind), t = rate_count(block.kind);
    std::array<double, 12> tangent{};
    tangent_block(block.kind, work_.q.data() + block.q, tangent.data());
    const double factor = BlockManifold::pseudo_inverse_factor(block.kind);
    for (std::uint32_t row = 0; row < relation_.rows; ++row) {
      for (std::size_t k = 0; k < n; ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < t; ++i) {
          const std::uint32_t rate = block.v + static_cast<std::uint32_t>(i);
          sum += work_.equations.jacobian.coeff(relation_.first_row + row, mechanism.column_of_rate[rate]) /
                 mechanism.rate_scale[rate] * tangent[k * t + i];
        }
        out[row * n + k] = factor * sum;
      }
    }
  }

  const Work& work_;
  const Evaluation& evaluation_;
  const Relation& relation_;
  std::vector<const StateBlock*> blocks_;
};

/// Keeps Ceres' logger, which is one for the whole process, quiet while any thread is in scope; then it is as before.
class QuietLog {
 public:
  QuietLog() {
    const std::lock_guard lock(mutex_);
    if (users_++ > 0) return;
    before_ = FLAGS_minloglevel;
    FLAGS_minloglevel = google::GLOG_FATAL;
  }
  ~QuietLog() {
    const std::lock_guard lock(mutex_);
    if (--users_ == 0) FLAGS_minloglevel = before_;
  }
  QuietLog(const QuietLog&) = delete;
  QuietLog& operator=(const QuietLog&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int users_ = 0;
  static inline int before_ = 0;
};

}  // namespace

struct CeresClosure::Impl {
  explicit Impl(Work& w) : work(w), evaluation(w), problem(options(evaluation)) {
    const Mechanism& mechanism = *work.mechanism;
    std::map<std::uint32_t, const StateBlock*> block_of_rate;
    for (const StateBlock& block : mechanism.blocks) {
      for (std::uint32_t i = 0; i < rate_count(block.kind); ++i) block_of_rate[block.v + i] = &block;
    }
    for (const Relation& relation : mechanism.relations) {
      std::set<const StateBlock*> used;  // blocks lie in one array: this is their order
      for (const PathRate& rate : relation.path) used.insert(block_of_rate.at(rate.rate));
      for (const PathRate& rate : relation.coupled) used.insert(block_of_rate.at(rate.rate));
      if (used.empty() || relation.rows == 0) continue;
      std::vector<const StateBlock*> blocks(used.begin(), used.end());
      std::vector<double*> parameters;
      for (const StateBlock* block : blocks) {
        parameters.push_back(work.q.data() + block->q);
        all_blocks.insert(block);
      }
      problem.AddResidualBlock(new RelationCost(work, evaluation, relation, std::move(blocks)), nullptr, parameters);
    }
    for (const StateBlock* block : all_blocks) {
      if (!is_scalar(block->kind)) {
        problem.SetManifold(work.q.data() + block->q, new BlockManifold(block->kind));
      }
    }
  }

  static ceres::Problem::Options options(Evaluation& evaluation) {
    ceres::Problem::Options result;
    result.evaluation_callback = &evaluation;
    return result;
  }

  bool is_input(const StateBlock& block) const {
    const std::int32_t column = work.mechanism->column_of_rate[block.v];
    return column >= static_cast<std::int32_t>(work.mechanism->unknowns);
  }

  Work& work;
  Evaluation evaluation;
  ceres::Problem problem;
  std::set<const StateBlock*> all_blocks;
};

CeresClosure::CeresClosure(Work& work) : impl_(std::make_unique<Impl>(work)) {}
CeresClosure::~CeresClosure() = default;

CeresClosure::Result CeresClosure::solve(double time, std::uint32_t max_iterations, InputsAre inputs) {
  Work& work = impl_->work;
  Result result;
  work.factorised = false;
  for (const StateBlock* block : impl_->all_blocks) {
    double* at = work.q.data() + block->q;
    if (inputs == InputsAre::held && impl_->is_input(*block)) {
      impl_->problem.SetParameterBlockConstant(at);
    } else {
      impl_->problem.SetParameterBlockVariable(at);
    }
  }
  impl_->evaluation.time = time;
  if (!work.equations.evaluate(work.q, time)) return {true, 0};
  if (impl_->problem.NumResidualBlocks() > 0) {
    ceres::Solver::Options options;
    options.linear_solver_type =
        work.mechanism->columns <= largest_dense ? ceres::DENSE_QR : ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = static_cast<int>(max_iterations);
    // Stop at rounding, not at a relative change: the cost of a closed loop is zero.
    options.function_tolerance = 1e-16;
    options.parameter_tolerance = 1e-15;
    options.gradient_tolerance = 1e-18;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    {
      const QuietLog quiet;
      ceres::Solve(options, &impl_->problem, &summary);
    }
    result.iterations = static_cast<std::uint32_t>(std::max<std::size_t>(1, summary.iterations.size()) - 1);
  }
  result.plugin_failed = !work.equations.evaluate(work.q, time);
  return result;
}

}  // namespace koppel

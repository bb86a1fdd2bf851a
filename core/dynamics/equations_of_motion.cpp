#include "dynamics/equations_of_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "closure/newton.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/inverse_dynamics.hpp"

namespace koppel {
namespace {

constexpr double rounding = 1e-14;  // scaled residual at which nothing more is gained
constexpr double all_but = 1e-12;   // and below which a step that gains less than half has met rounding
constexpr int most_iterations = 12;

}  // namespace

EquationsOfMotion::EquationsOfMotion(std::shared_ptr<const Mechanism> m, Inertias inertias)
    : mechanism_(std::move(m)),
      inertias_(std::move(inertias)),
      layout_(*mechanism_),
      mass_matrix_(layout_, inertias_),
      tree_mass_(layout_),
      articulated_(layout_, inertias_),
      equations_(*mechanism_),
      forces_(*mechanism_),
      rows_(*mechanism_),
      elimination_(rows_.pattern(), mechanism_->unknowns),
      inputs_(*mechanism_),
      offsets_(Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(mechanism_->inputs.size()))),
      pushed_(Eigen::VectorXd::Zero(mechanism_->nv)),
      q_(mechanism_->nq),
      v_(Eigen::VectorXd::Zero(mechanism_->nv)),
      a_(v_),
      zero_(v_),
      step_(v_),
      step_rates_(v_),
      efforts_(v_),
      residual_efforts_(v_),
      force_efforts_(v_),
      x_(Eigen::VectorXd::Zero(mechanism_->columns)),
      b_(Eigen::VectorXd::Zero(mechanism_->rows)),
      multipliers_(b_),
      on_nodes_(mechanism_->nodes),
      carried_(mechanism_->nodes) {
  for (std::uint32_t i = 0; i < mechanism_->loops; ++i) {
    const Relation& loop = mechanism_->relations[i];
    if (loop.kind != RelationKind::cut_joint) continue;
    const Joint& joint = mechanism_->joints[loop.joint.index()];
    for (std::uint32_t k = joint.q; k < joint.q + joint.nq; ++k) cut_.push_back(k);
  }
}

bool EquationsOfMotion::fail(Obstacle obstacle) {
  obstacle_ = obstacle;
  force_failed_ = false;
  return false;
}

std::string EquationsOfMotion::culprit() const {
  switch (obstacle_) {
    case Obstacle::none: return {};
    case Obstacle::plugin: return force_failed_ ? forces_.culprit() : equations_.culprit();
    case Obstacle::open:
    case Obstacle::singular: {
      Eigen::Index row = 0;
      if (mechanism_->rows == 0) return {};
      equations_.residual.cwiseAbs().maxCoeff(&row);
      return mechanism_->equation_names[static_cast<std::size_t>(row)].name;
    }
    case Obstacle::massless: return mechanism_->rate_names[loose_].name;
  }
  return {};
}

bool EquationsOfMotion::take_inputs(double time) {
  time_ = time;
  if (mechanism_->inputs.empty()) return true;
  const Input* failed = set_time(*mechanism_, time, inputs_);
  if (failed != nullptr) {
    equations_.blame(*failed);
    return fail(Obstacle::plugin);
  }
  if (held_) {
    inputs_.input_rate.setZero();
    inputs_.input_acceleration.setZero();
  }
  inputs_.input += offsets_.row(0).transpose();
  inputs_.input_rate += offsets_.row(1).transpose();
  inputs_.input_acceleration += offsets_.row(2).transpose();
  return true;
}

bool EquationsOfMotion::choose(const Eigen::VectorXd& q, double time) {
  if (!take_inputs(time)) return false;
  if (!equations_.evaluate(q, time)) return fail(Obstacle::plugin);
  last_ = q;
  rows_.evaluate(equations_);
  elimination_.choose(rows_.values(), rows_.scales(), redundant_row);
  independent_.clear();
  for (const std::uint32_t column : elimination_.independent()) {
    independent_.push_back(mechanism_->rate_of_column[column]);
  }
  find_shared_blocks();
  const auto f = static_cast<Eigen::Index>(independent_.size());
  transfer_.resize(mechanism_->columns, f);
  inertial_.resize(mechanism_->nv, f);
  mass_.resize(f, f);
  rhs_.resize(f);
  return true;
}

/// Independent rates of quaternions of which other rates depend: in the chart they do not stay where they are not
/// turned about, but where their coordinates do not change.
void EquationsOfMotion::find_shared_blocks() {
  shared_.clear();
  for (const StateBlock& block : mechanism_->blocks) {
    if (is_scalar(block.kind)) continue;
    const auto first = std::lower_bound(independent_.begin(), independent_.end(), block.v);
    const auto last = std::lower_bound(first, independent_.end(), block.v + rate_count(block.kind));
    if (last - first < static_cast<std::ptrdiff_t>(rate_count(block.kind))) shared_.insert(shared_.end(), first, last);
  }
  const auto count = static_cast<Eigen::Index>(shared_.size());
  by_shared_.resize(count, count);
  held_back_.resize(count);
  shared_factors_ = Eigen::PartialPivLU<Eigen::MatrixXd>(count);
}

/// Turns the solution x_ of the rows' equations for b_ so that independent coordinates stay where they are in the
/// chart.
void EquationsOfMotion::hold_shared(const Chart& chart, const Eigen::VectorXd& delta) {
  const auto along = [&](const auto& use) {
    scatter(x_, step_);
    chart.rates(delta, step_, step_rates_);
    for (std::size_t i = 0; i < shared_.size(); ++i) use(static_cast<Eigen::Index>(i), step_rates_[shared_[i]]);
  };
  along([&](Eigen::Index i, double rate) { held_back_[i] = -rate; });
  for (std::size_t j = 0; j < shared_.size(); ++j) {
    x_.setZero();
    x_[mechanism_->column_of_rate[shared_[j]]] = 1.0;
    elimination_.follow(x_);
    along([&](Eigen::Index i, double rate) { by_shared_(i, static_cast<Eigen::Index>(j)) = rate; });
  }
  shared_factors_.compute(by_shared_);
  held_back_ = shared_factors_.solve(held_back_);
  x_.setZero();
  for (std::size_t j = 0; j < shared_.size(); ++j) {
    x_[mechanism_->column_of_rate[shared_[j]]] = held_back_[static_cast<Eigen::Index>(j)];
  }
  elimination_.solve(b_, x_);
}

void EquationsOfMotion::scatter(const Eigen::VectorXd& columns, Eigen::VectorXd& rates) const {
  for (std::uint32_t i = 0; i < mechanism_->columns; ++i) rates[mechanism_->rate_of_column[i]] = columns[i];
}

bool EquationsOfMotion::close(const Chart& chart, double time, Eigen::VectorXd& delta) {
  if (!take_inputs(time)) return false;
  for (std::size_t i = 0; i < mechanism_->inputs.size(); ++i) {
    const Input& input = mechanism_->inputs[i];
    delta[input.v] = inputs_.input[static_cast<Eigen::Index>(i)] - chart.base()[input.q];
  }
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    chart.position(delta, q_);
    if (!equations_.evaluate(q_, time)) return fail(Obstacle::plugin);
    if (mechanism_->rows == 0) return true;
    rows_.evaluate(equations_);
    conditioning_ = elimination_.factorise(rows_.values());
    if (!(conditioning_ > 0.0) && elimination_.rank() > 0) return fail(Obstacle::singular);
    const double error = equations_.error();
    if (!std::isfinite(error)) return fail(Obstacle::open);
    // What is left open moves the others by it over the pivot: near a singular position only rounding may be left.
    if (error <= rounding * std::min(1.0, 10.0 * conditioning_) || (error <= all_but && error > 0.5 * before)) break;
    if (i == most_iterations || (i > 3 && error > before)) {
      if (error <= closed_limit) break;
      return fail(Obstacle::open);
    }
    before = error;
    b_ = -equations_.residual;
    x_.setZero();
    elimination_.solve(b_, x_);
    if (!shared_.empty()) hold_shared(chart, delta);
    scatter(x_, step_);
    chart.rates(delta, step_, step_rates_);
    for (const std::uint32_t rate : independent_) step_rates_[rate] = 0.0;
    delta += step_rates_;
  }
  for (const std::uint32_t k : cut_) q_[k] = last_[k];
  if (!equations_.cut_coordinates(q_)) return fail(Obstacle::plugin);
  last_ = q_;
  return true;
}

bool EquationsOfMotion::velocities(const Eigen::VectorXd& rates) {
  x_.setZero();
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    x_[mechanism_->column_of_rate[independent_[i]]] = rates[static_cast<Eigen::Index>(i)];
  }
  for (std::size_t i = 0; i < mechanism_->inputs.size(); ++i) {
    x_[mechanism_->column_of_rate[mechanism_->inputs[i].v]] = inputs_.input_rate[static_cast<Eigen::Index>(i)];
  }
  if (mechanism_->rows > 0) {
    if (!equations_.time_rate(b_)) return fail(Obstacle::plugin);
    b_ = -b_;
    if (held_) b_.setZero();
    elimination_.solve(b_, x_);
  }
  scatter(x_, v_);
  if (!equations_.motion(q_, v_, zero_) || !equations_.cut_rates(q_, v_)) return fail(Obstacle::plugin);
  return true;
}

bool EquationsOfMotion::opening_rates(Eigen::VectorXd& rates) {
  if (mechanism_->rows == 0) return true;
  if (!equations_.time_rate(rates)) return fail(Obstacle::plugin);
  if (held_) rates.setZero();
  rows_.add_product(v_, rates);
  return true;
}

double EquationsOfMotion::opening() {
  return mechanism_->rows > 0 && opening_rates(b_) ? b_.lpNorm<Eigen::Infinity>() : 0.0;
}

/// Mass in the independent coordinates, and the efforts that their unit accelerations cost.
void EquationsOfMotion::reduce_mass() {
  mass_matrix_.evaluate(equations_.kinematics, tree_mass_);
  elimination_.transfer(transfer_);
  for (Eigen::Index i = 0; i < mass_.rows(); ++i) {
    x_ = transfer_.col(i);
    step_.setZero();
    scatter(x_, step_);
    tree_mass_.multiply(step_.data(), efforts_.data());
    inertial_.col(i) = efforts_;
    for (Eigen::Index j = 0; j <= i; ++j) mass_(i, j) = mass_(j, i) = along_independent(j, efforts_);
  }
}

/// What efforts do along an independent coordinate, all that follow from it included.
double EquationsOfMotion::along_independent(Eigen::Index i, const Eigen::VectorXd& efforts) const {
  double sum = 0.0;
  for (std::uint32_t c = 0; c < mechanism_->columns; ++c)
    sum += transfer_(c, i) * efforts[mechanism_->rate_of_column[c]];
  return sum;
}

/// Solves the reduced equations in place. A pivot that is but rounding of its own entry says that nothing resists.
bool EquationsOfMotion::solve_reduced() {
  const Eigen::Index f = mass_.rows();
  if (f == 0) return true;
  for (Eigen::Index i = 0; i < f; ++i) step_[i] = mass_(i, i);
  Eigen::Ref<Eigen::MatrixXd> mass(mass_);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(mass);
  const double rounding_of = 8.0 * static_cast<double>(f) * std::numeric_limits<double>::epsilon();
  for (Eigen::Index i = 0; i < f; ++i) {
    // Where the factorisation stopped, the diagonal still holds what was left of the entry.
    if (mass_(i, i) > 0.0 && mass_(i, i) * mass_(i, i) > rounding_of * step_[i]) continue;
    loose_ = independent_[static_cast<std::size_t>(i)];
    return fail(Obstacle::massless);
  }
  if (factors.info() != Eigen::Success) {
    loose_ = independent_.back();
    return fail(Obstacle::massless);
  }
  factors.solveInPlace(rhs_);
  return true;
}

/// Without loops and drives all rates are independent, and articulated bodies are quicker.
bool EquationsOfMotion::tree_accelerations() {
  if (!articulated_.evaluate(equations_.kinematics, mechanism_->gravity, on_nodes_, force_efforts_, a_)) {
    loose_ = articulated_.loose();
    return fail(Obstacle::massless);
  }
  return true;
}

bool EquationsOfMotion::drive(const Chart& chart, double time, Eigen::VectorXd& delta, Eigen::VectorXd& v) {
  if (!take_inputs(time)) return false;
  for (std::size_t i = 0; i < mechanism_->inputs.size(); ++i) {
    const Input& input = mechanism_->inputs[i];
    delta[input.v] = inputs_.input[static_cast<Eigen::Index>(i)] - chart.base()[input.q];
    v[input.v] = inputs_.input_rate[static_cast<Eigen::Index>(i)];
  }
  return true;
}

bool EquationsOfMotion::stand(const Chart& chart, double time, const Eigen::VectorXd& delta, const Eigen::VectorXd& v) {
  if (!take_inputs(time)) return false;
  chart.position(delta, q_);
  if (!equations_.evaluate(q_, time)) return fail(Obstacle::plugin);
  v_ = v;
  if (mechanism_->rows > 0) {
    rows_.evaluate(equations_);
    conditioning_ = elimination_.factorise(rows_.values());
    if (!(conditioning_ > 0.0) && elimination_.rank() > 0) return fail(Obstacle::singular);
    for (const std::uint32_t k : cut_) q_[k] = last_[k];
    if (!equations_.cut_coordinates(q_)) return fail(Obstacle::plugin);
    last_ = q_;
  }
  if (!equations_.motion(q_, v_, zero_) || !equations_.cut_rates(q_, v_)) return fail(Obstacle::plugin);
  return true;
}

/// What the right-hand sides gain where something stands open: of the drives in x_, of the rows in b_.
void EquationsOfMotion::add_pull() {
  for (std::size_t i = 0; i < mechanism_->inputs.size(); ++i) {
    const Input& input = mechanism_->inputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    x_[mechanism_->column_of_rate[input.v]] -=
        pull_ * (2.0 * (v_[input.v] - inputs_.input_rate[k]) + pull_ * (q_[input.q] - inputs_.input[k]));
  }
  multipliers_.setZero();
  if (mechanism_->explicit_time && !equations_.time_rate(multipliers_)) return;
  rows_.add_product(v_, multipliers_);
  b_ -= pull_ * (2.0 * multipliers_ + pull_ * equations_.residual);
}

/// Accelerations that remain without any of the independent coordinates, and what acts then.
bool EquationsOfMotion::leave_unaccelerated(const double* states, double* state_rates) {
  x_.setZero();
  for (std::size_t i = 0; i < mechanism_->inputs.size(); ++i) {
    x_[mechanism_->column_of_rate[mechanism_->inputs[i].v]] = inputs_.input_acceleration[static_cast<Eigen::Index>(i)];
  }
  if (mechanism_->rows > 0) {
    if (!equations_.bias(q_, v_, b_)) return fail(Obstacle::plugin);
    b_ = -b_;
    if (held_ && mechanism_->explicit_time) b_.setZero();
    if (pull_ > 0.0) add_pull();
    elimination_.solve(b_, x_);
  }
  a_.setZero();
  scatter(x_, a_);
  return take_forces(states, state_rates);
}

/// The motion with the accelerations a_, and the forces that act.
bool EquationsOfMotion::take_forces(const double* states, double* state_rates) {
  if (!equations_.motion(q_, v_, a_)) return fail(Obstacle::plugin);
  std::fill(on_nodes_.begin(), on_nodes_.end(), Wrench{});
  force_efforts_ = pushed_;
  if (!forces_.evaluate(equations_.kinematics, q_.data(), v_.data(), time_, states, on_nodes_, force_efforts_,
                        state_rates)) {
    fail(Obstacle::plugin);
    force_failed_ = true;
    return false;
  }
  return true;
}

bool EquationsOfMotion::imbalance(const double* states, const Eigen::VectorXd& a, const Eigen::VectorXd& multipliers,
                                  double* state_rates, Eigen::VectorXd& missing) {
  a_ = a;
  for (std::size_t i = 0; i < mechanism_->inputs.size(); ++i) {
    a_[mechanism_->inputs[i].v] = inputs_.input_acceleration[static_cast<Eigen::Index>(i)];
  }
  if (!take_forces(states, state_rates)) return false;
  take_inverse_dynamics();
  missing = residual_efforts_;
  rows_.subtract_transposed(multipliers, missing);
  return true;
}

/// Efforts that the accelerations left would cost, less those that act.
void EquationsOfMotion::take_inverse_dynamics() {
  inverse_dynamics(*mechanism_, inertias_, equations_.kinematics, mechanism_->gravity, on_nodes_, carried_,
                   residual_efforts_);
  residual_efforts_ -= force_efforts_;
}

bool EquationsOfMotion::efforts(const double* states, double* state_rates, Eigen::VectorXd& along) {
  if (!leave_unaccelerated(states, state_rates)) return false;
  take_inverse_dynamics();
  elimination_.transfer(transfer_);
  for (Eigen::Index i = 0; i < along.size(); ++i) along[i] = -along_independent(i, residual_efforts_);
  return true;
}

void EquationsOfMotion::mass(Eigen::MatrixXd& mass) {
  reduce_mass();
  mass = mass_;
}

bool EquationsOfMotion::accelerations(const double* states, double* state_rates) {
  if (!leave_unaccelerated(states, state_rates)) return false;
  if (mechanism_->rows == 0 && mechanism_->inputs.empty()) return tree_accelerations();
  take_inverse_dynamics();
  reduce_mass();
  for (Eigen::Index i = 0; i < rhs_.size(); ++i) rhs_[i] = -along_independent(i, residual_efforts_);
  if (!solve_reduced()) return false;
  x_.setZero();
  for (Eigen::Index i = 0; i < rhs_.size(); ++i) {
    x_ += rhs_[i] * transfer_.col(i);
    residual_efforts_ += rhs_[i] * inertial_.col(i);
  }
  step_.setZero();
  scatter(x_, step_);
  a_ += step_;
  if (!a_.allFinite()) return fail(Obstacle::massless);
  return true;
}

bool EquationsOfMotion::complete(Eigen::VectorXd& a) {
  a = a_;
  if (!equations_.motion(q_, v_, a_) || !equations_.cut_accelerations(q_, v_, a)) return fail(Obstacle::plugin);
  return true;
}

/// Efforts left in the dependent columns are carried by the loops; those in the driven ones by the drives.
const Eigen::VectorXd& EquationsOfMotion::multipliers() {
  for (std::uint32_t c = 0; c < mechanism_->columns; ++c) x_[c] = residual_efforts_[mechanism_->rate_of_column[c]];
  if (mechanism_->rows > 0) elimination_.solve_transposed(x_, multipliers_);
  return multipliers_;
}

bool EquationsOfMotion::power(const double* states, double& power) {
  power = 0.0;
  double dissipated = 0.0, external = 0.0;
  if (!mechanism_->forces.empty()) {
    if (!forces_.power(equations_.kinematics, q_.data(), v_.data(), time_, states, dissipated, external)) {
      fail(Obstacle::plugin);
      force_failed_ = true;
      return false;
    }
  }
  power = external - dissipated;
  if (mechanism_->inputs.empty()) return true;
  efforts_ = residual_efforts_;
  rows_.subtract_transposed(multipliers(), efforts_);
  for (const Input& input : mechanism_->inputs) power += efforts_[input.v] * v_[input.v];
  // What constraints with time of their own deliver.
  if (mechanism_->explicit_time && equations_.time_rate(b_)) power -= multipliers_.dot(b_);
  return true;
}

bool EquationsOfMotion::energy(const double* states, Energy& energy) {
  if (!equations_.motion(q_, v_, zero_)) return fail(Obstacle::plugin);
  energy.kinetic = kinetic_energy(inertias_, equations_.kinematics);
  energy.potential = potential_energy(inertias_, equations_.kinematics, mechanism_->gravity);
  double stored = 0.0;
  if (!mechanism_->forces.empty() && !forces_.energy(equations_.kinematics, q_.data(), time_, states, stored)) {
    fail(Obstacle::plugin);
    force_failed_ = true;
    return false;
  }
  energy.potential += stored;
  return true;
}

bool EquationsOfMotion::exchange(Archive& archive) {
  archive(last_, pull_);
  return archive.good() && last_.size() == q_.size();
}

bool EquationsOfMotion::switches(const double* states, double* values) {
  if (forces_.switches(equations_.kinematics, q_.data(), v_.data(), time_, states, values)) return true;
  fail(Obstacle::plugin);
  force_failed_ = true;
  return false;
}

}  // namespace koppel

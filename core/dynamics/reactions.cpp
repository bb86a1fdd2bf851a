#include "dynamics/reactions.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/inverse_dynamics.hpp"

namespace koppel {
namespace {

constexpr double no_longer = 10.0 * redundant_row;  // part above which a row does not follow any more
constexpr double negligible = 1e-8;                 // half the digits: of a load beside the greatest of a self-stress

}  // namespace

Reactions::Reactions(std::shared_ptr<const Mechanism> m, Inertias inertias)
    : mechanism_(std::move(m)),
      inertias_(std::move(inertias)),
      equations_(*mechanism_),
      forces_(*mechanism_),
      rows_(*mechanism_),
      elimination_(rows_.pattern(), mechanism_->unknowns),
      paths_(*mechanism_),
      outlets_(mechanism_->joints.size()),
      on_nodes_(mechanism_->nodes),
      carried_(mechanism_->nodes),
      of_steps_(mechanism_->steps.size()),
      efforts_(Eigen::VectorXd::Zero(mechanism_->nv)),
      columns_(Eigen::VectorXd::Zero(mechanism_->columns)),
      multipliers_(Eigen::VectorXd::Zero(mechanism_->rows)),
      state_rates_(mechanism_->internal_start) {
  loads_.joints.resize(mechanism_->joints.size());
  loads_.efforts = efforts_;
}

std::string Reactions::culprit() const { return force_failed_ ? forces_.culprit() : equations_.culprit(); }

/// What the tree bears if nothing closes its loops: efforts along all rates, and the wrenches of all joints.
bool Reactions::tree_efforts(const State& state) {
  force_failed_ = false;
  if (!equations_.evaluate(state.q, state.time) || !equations_.motion(state.q, state.v, state.a)) return false;
  std::fill(on_nodes_.begin(), on_nodes_.end(), Wrench{});
  loads_.efforts.setZero();
  if (!forces_.evaluate(equations_.kinematics, state.q.data(), state.v.data(), state.time, state.internal.data(),
                        on_nodes_, loads_.efforts, state_rates_.data())) {
    force_failed_ = true;
    return false;
  }
  inverse_dynamics(*mechanism_, inertias_, equations_.kinematics, mechanism_->gravity, on_nodes_, carried_, efforts_);
  joint_wrenches(*mechanism_, equations_.kinematics, carried_, of_steps_);
  efforts_ -= loads_.efforts;
  return true;
}

void Reactions::choose() {
  elimination_.choose(rows_.values(), rows_.scales(), redundant_row);
  elimination_.factorise(rows_.values());
  chosen_ = true;
}

bool Reactions::is_chosen_well() {
  if (elimination_.factorise(rows_.values()) < worn_pivot) return false;
  const RowPattern& pattern = rows_.pattern();
  double greatest = 0.0;
  for (std::size_t k = 0; k < pattern.column.size(); ++k) {
    greatest = std::max(greatest, std::abs(rows_.values()[k]) * rows_.scales()[pattern.column[k]]);
  }
  for (const std::uint32_t row : elimination_.left_out()) {
    columns_.setZero();
    for (std::uint32_t k = pattern.first[row]; k < pattern.first[row + 1]; ++k) {
      columns_[pattern.column[k]] = rows_.values()[k];
    }
    elimination_.solve_transposed(columns_, multipliers_);
    multipliers_[row] = -1.0;
    efforts_.setZero();
    rows_.subtract_transposed(multipliers_, efforts_);
    for (std::uint32_t c = 0; c < mechanism_->unknowns; ++c) {
      if (std::abs(efforts_[mechanism_->rate_of_column[c]]) * rows_.scales()[c] > no_longer * greatest) return false;
    }
  }
  return true;
}

/// What is kept small: all moments, all forces over the mechanism's length, and multipliers of constraints.
Eigen::VectorXd Reactions::stacked(const std::vector<Wrench>& joints, const Eigen::VectorXd& multipliers) const {
  const auto loads = static_cast<Eigen::Index>(6 * joints.size());
  const std::size_t loops = mechanism_->loops;
  const Eigen::Index first = loops < mechanism_->relations.size() ? mechanism_->relations[loops].first_row
                                                                  : static_cast<Eigen::Index>(mechanism_->rows);
  Eigen::VectorXd all(loads + multipliers.size() - first);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    all.segment<6>(static_cast<Eigen::Index>(6 * i)) << joints[i].moment, mechanism_->length * joints[i].force;
  }
  all.tail(multipliers.size() - first) = multipliers.tail(multipliers.size() - first);
  return all;
}

void Reactions::find_stresses() {
  std::vector<Eigen::Triplet<double>> stresses, effects;
  const RowPattern& pattern = rows_.pattern();
  const auto count = static_cast<int>(elimination_.left_out().size());
  Eigen::Index stack = 0;
  for (int n = 0; n < count; ++n) {
    const std::uint32_t row = elimination_.left_out()[static_cast<std::size_t>(n)];
    columns_.setZero();
    for (std::uint32_t k = pattern.first[row]; k < pattern.first[row + 1]; ++k) {
      columns_[pattern.column[k]] = -rows_.values()[k];
    }
    elimination_.solve_transposed(columns_, multipliers_);
    multipliers_[row] = 1.0;
    std::vector<Wrench> joints(loads_.joints.size());
    paths_.add(equations_, multipliers_, outlets_, joints);
    const Eigen::VectorXd effect = stacked(joints, multipliers_);
    stack = effect.size();
    for (int i = 0; i < multipliers_.size(); ++i) {
      if (multipliers_[i] != 0.0) stresses.emplace_back(i, n, multipliers_[i]);
    }
    for (int i = 0; i < effect.size(); ++i) {
      if (effect[i] != 0.0) effects.emplace_back(i, n, effect[i]);
    }
  }
  stresses_.resize(multipliers_.size(), count);
  stresses_.setFromTriplets(stresses.begin(), stresses.end());
  effects_.resize(stack, count);
  effects_.setFromTriplets(effects.begin(), effects.end());
}

/// Takes off the self-stress that makes the loads larger than they need to be.
void Reactions::relieve() {
  const Eigen::SparseMatrix<double> normal = effects_.transpose() * effects_;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(normal);
  std::vector<Wrench> joints = loads_.joints;
  paths_.add(equations_, multipliers_, outlets_, joints);
  // Twice: what the normal equations lose, the second solution brings back.
  for (int i = 0; i < 2; ++i) {
    const Eigen::VectorXd excess = factors.solve(effects_.transpose() * stacked(joints, multipliers_));
    multipliers_ -= stresses_ * excess;
    joints = loads_.joints;
    paths_.add(equations_, multipliers_, outlets_, joints);
  }
}

bool Reactions::evaluate(const State& state) {
  if (!tree_efforts(state)) return false;
  loads_.efforts = efforts_;
  std::fill(loads_.joints.begin(), loads_.joints.end(), Wrench{});
  for (std::size_t i = 0; i < of_steps_.size(); ++i) loads_.joints[mechanism_->steps[i].joint.index()] = of_steps_[i];
  paths_.outlets(equations_, outlets_);
  if (mechanism_->rows > 0) {
    rows_.evaluate(equations_);
    if (!chosen_ || !is_chosen_well()) choose();
    const bool stressed = !elimination_.left_out().empty();
    if (stressed) find_stresses();
    for (std::uint32_t c = 0; c < mechanism_->columns; ++c) columns_[c] = loads_.efforts[mechanism_->rate_of_column[c]];
    elimination_.solve_transposed(columns_, multipliers_);
    if (stressed) relieve();
    rows_.subtract_transposed(multipliers_, loads_.efforts);
    for (const std::uint32_t c : elimination_.dependent()) loads_.efforts[mechanism_->rate_of_column[c]] = 0.0;
    paths_.add(equations_, multipliers_, outlets_, loads_.joints);
  }
  for (std::size_t i = 0; i < outlets_.size(); ++i) {
    const Matrix3 to_outlet = outlets_[i].rotation.transpose();
    loads_.joints[i] = {to_outlet * loads_.joints[i].moment, to_outlet * loads_.joints[i].force};
  }
  return true;
}

Reactions::Determined Reactions::determined() const {
  Determined result{std::vector<std::array<bool, 6>>(outlets_.size(), {true, true, true, true, true, true}),
                    std::vector<bool>(mechanism_->nv, true)};
  if (elimination_.left_out().empty()) return result;
  for (Eigen::Index n = 0; n < stresses_.cols(); ++n) {
    const Eigen::VectorXd effect = effects_.col(n);
    const double least = negligible * effect.lpNorm<Eigen::Infinity>();
    for (std::size_t i = 0; i < outlets_.size(); ++i) {
      const Matrix3 to_outlet = outlets_[i].rotation.transpose();
      for (Eigen::Index half = 0; half < 2; ++half) {
        const Vector3 part = to_outlet * effect.segment<3>(static_cast<Eigen::Index>(6 * i) + 3 * half);
        for (Eigen::Index k = 0; k < 3; ++k) {
          if (std::abs(part[k]) > least) result.joints[i][static_cast<std::size_t>(3 * half + k)] = false;
        }
      }
    }
    Eigen::VectorXd efforts = Eigen::VectorXd::Zero(mechanism_->nv);
    rows_.subtract_transposed(stresses_.col(n), efforts);
    for (std::uint32_t c = mechanism_->unknowns; c < mechanism_->columns; ++c) {
      const std::uint32_t rate = mechanism_->rate_of_column[c];
      if (std::abs(efforts[rate]) * rows_.scales()[c] > least) result.efforts[rate] = false;
    }
  }
  return result;
}

}  // namespace koppel

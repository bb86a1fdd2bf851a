#include "dynamics/tree_dynamics.hpp"

#include "dynamics/inverse_dynamics.hpp"
#include "mechanism/coordinates.hpp"

namespace koppel {

TreeDynamics::TreeDynamics(std::shared_ptr<const Mechanism> mechanism, Inertias inertias)
    : mechanism_(std::move(mechanism)),
      inertias_(std::move(inertias)),
      layout_(*mechanism_),
      kinematics_(*mechanism_),
      carried_(mechanism_->nodes),
      matrix_(layout_),
      mass_matrix_(layout_, inertias_),
      articulated_(layout_, inertias_),
      factored_(layout_, inertias_),
      derivatives_(layout_, inertias_),
      q_(mechanism_->nq),
      rest_(Eigen::VectorXd::Zero(mechanism_->nv)),
      efforts_(rest_),
      accelerations_(rest_),
      dense_(Eigen::MatrixXd::Zero(mechanism_->nv, mechanism_->nv)),
      by_q_(dense_),
      by_v_(dense_),
      by_effort_(dense_),
      solved_(mechanism_->nv, 3 * mechanism_->nv) {}

bool TreeDynamics::place(const double* q) {
  std::copy(q, q + mechanism_->nq, q_.data());
  for (const StateBlock& block : mechanism_->blocks) normalise_block(block.kind, q_.data() + block.q);
  return forward_position(*mechanism_, q_.data(), kinematics_);
}

bool TreeDynamics::move(const double* q, const double* v, const double* a) {
  return place(q) && forward_motion(*mechanism_, q_.data(), given(v), given(a), kinematics_);
}

Error TreeDynamics::plugin_error(JointId joint) const {
  return make_error(Code::plugin_misbehaved, "joint " + mechanism_->joints[joint.index()].name,
                    "failed, or gave a number that is not finite", "report it to the author of the plugin");
}

Error TreeDynamics::loose(std::uint32_t rate) const {
  return make_error(Code::massless, "coordinate " + mechanism_->rate_names[rate].name,
                    "moves without any mass that resists", "give the bodies that it moves a mass or an inertia");
}

TreeDynamics::Obstacle TreeDynamics::inverse(const double* q, const double* v, const double* a) {
  if (!move(q, v, a)) return plugin_error(kinematics_.culprit);
  inverse_dynamics(*mechanism_, inertias_, kinematics_, mechanism_->gravity, {}, carried_, efforts_);
  return std::nullopt;
}

TreeDynamics::Obstacle TreeDynamics::forward(const double* q, const double* v, const double* efforts) {
  if (!move(q, v, nullptr)) return plugin_error(kinematics_.culprit);
  efforts_ = Eigen::Map<const Eigen::VectorXd>(given(efforts), mechanism_->nv);
  if (articulated_.evaluate(kinematics_, mechanism_->gravity, {}, efforts_, accelerations_)) return std::nullopt;
  return loose(articulated_.loose());
}

TreeDynamics::Obstacle TreeDynamics::mass(const double* q) {
  if (!place(q)) return plugin_error(kinematics_.culprit);
  mass_matrix_.evaluate(kinematics_, matrix_);
  matrix_.dense(dense_);
  return std::nullopt;
}

TreeDynamics::Obstacle TreeDynamics::energy(const double* q, const double* v) {
  if (!move(q, v, nullptr)) return plugin_error(kinematics_.culprit);
  mechanical_ = mechanical_state(inertias_, kinematics_, mechanism_->gravity);
  return std::nullopt;
}

TreeDynamics::Obstacle TreeDynamics::inverse_derivatives(const double* q, const double* v, const double* a) {
  if (!place(q)) return plugin_error(kinematics_.culprit);
  if (derivatives_.evaluate(kinematics_, mechanism_->gravity, q_.data(), given(v), given(a), by_q_, by_v_)) {
    return std::nullopt;
  }
  return plugin_error(derivatives_.culprit());
}

TreeDynamics::Obstacle TreeDynamics::forward_derivatives(const double* q, const double* v, const double* efforts) {
  if (!move(q, v, nullptr)) return plugin_error(kinematics_.culprit);
  efforts_ = Eigen::Map<const Eigen::VectorXd>(given(efforts), mechanism_->nv);
  accelerations_.setZero();
  if (!factored_.evaluate(kinematics_, mechanism_->gravity, {}, efforts_, accelerations_)) {
    return loose(factored_.loose());
  }
  if (!derivatives_.evaluate(kinematics_, mechanism_->gravity, q_.data(), given(v), accelerations_.data(), by_q_,
                             by_v_)) {
    return plugin_error(derivatives_.culprit());
  }
  const Eigen::Index n = mechanism_->nv;
  solved_.leftCols(n) = -by_q_;
  solved_.middleCols(n, n) = -by_v_;
  solved_.rightCols(n).setZero();
  for (std::uint32_t p = 0; p < layout_.rates(); ++p) solved_(layout_.rate(p), 2 * n + layout_.rate(p)) = 1.0;
  factored_.factors().solve(solved_.data(), 3 * mechanism_->nv);
  by_q_ = solved_.leftCols(n);
  by_v_ = solved_.middleCols(n, n);
  by_effort_ = solved_.rightCols(n);
  return std::nullopt;
}

}  // namespace koppel

#include "dynamics/sundials_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace koppel {
namespace {

constexpr double hardly = 1e-10;  // of the time: steps that short, so many in a row, lead nowhere
constexpr int most_creeping = 1000;

}  // namespace

StepStatus SundialsIntegrator::step(double limit) {
  before_ = time_;
  polynomial_.degree = -1;
  double t = limit;
  const double least = 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(limit), std::abs(time_));
  if (limit - time_ > 2.0 * least) {
    const long before = failures();
    const int flag = advance(limit, least, t);
    statistics_.rejected += static_cast<std::uint64_t>(failures() - before);
    creeping_ = t - time_ < hardly * std::max(std::abs(limit), std::abs(time_)) ? creeping_ + 1 : 0;
    if (flag < 0 || creeping_ > most_creeping) return StepStatus::too_small;
  }
  ++statistics_.steps;
  time_ = t;
  raw_ = values(vectors_->y);
  return unfold(time_, raw_, y_) ? StepStatus::done : StepStatus::too_small;
}

void SundialsIntegrator::interpolate(double t, Eigen::VectorXd& y) {
  if (t == time_) {
    y = y_;
    return;
  }
  if (polynomial_.degree < 0) {
    polynomial_.take(time_, last_order(), vectors_->scratch, [&](int k, N_Vector into) { return derivative(k, into); });
  }
  polynomial_.at(t, raw_);
  unfold(t, raw_, y);  // where it cannot stand, whoever reads it there is told
}

bool SundialsIntegrator::shorten(double t) {
  interpolate(t, moved_);
  const double before = before_;
  const StepPolynomial polynomial = polynomial_;
  if (!start(t, Eigen::VectorXd(moved_))) return false;
  before_ = before;
  polynomial_ = polynomial;
  return true;
}

bool SundialsIntegrator::exchange(Archive& archive) {
  if (!Integrator::exchange(archive)) return false;
  if (!archive.is_reading()) return true;
  const Statistics counted = statistics_;
  const bool defined = start(time_, Eigen::VectorXd(y_));
  statistics_ = counted;
  return defined;
}

bool SundialsOde::make_vectors(const Eigen::VectorXd& y) {
  const bool made = vectors_ == nullptr || values(vectors_->y).size() != y.size();
  if (made) {
    vectors_ = std::make_unique<SundialsVectors>(y.size());
    rate_.setZero(y.size());
  }
  values(vectors_->y) = y;
  return made;
}

void SundialsOde::settle(const Eigen::VectorXd& y) {
  y_ = y;
  values(vectors_->y) = y;
}

bool SundialsOde::unfold(double t, const Eigen::VectorXd& unknowns, Eigen::VectorXd& y) {
  y = unknowns;
  return &y != &y_ || evaluate(t, y_, rate_);
}

int SundialsOde::rate(realtype t, N_Vector y, N_Vector y_rate, void* of) {
  auto& self = *static_cast<SundialsOde*>(of);
  self.argument_ = values(y);
  if (!self.evaluate(t, self.argument_, self.rate_)) return 1;  // nearer by it may be defined
  values(y_rate) = self.rate_;
  return 0;
}

int SundialsOde::weights(N_Vector y, N_Vector weights, void* of) {
  const auto& self = *static_cast<const SundialsOde*>(of);
  set_weights(y, self.problem_->scales(), self.tolerance_, weights);
  return 0;
}

/// Difference quotients, of the components that rates depend on.
int SundialsOde::jacobian(realtype t, N_Vector y, N_Vector y_rate, SUNMatrix matrix, void* of, N_Vector, N_Vector,
                          N_Vector) {
  auto& self = *static_cast<SundialsOde*>(of);
  const Eigen::VectorXd& scales = self.problem_->scales();
  auto result = values(matrix);
  result.setZero();
  self.argument_ = values(y);
  for (Eigen::Index i = 0; i < scales.size(); ++i) {
    if (!std::isfinite(scales[i])) continue;
    const double at = self.argument_[i], size = quotient_step(at, scales[i]);
    for (const double way : {size, -size}) {
      self.argument_[i] = at + way;
      const double difference = self.argument_[i] - at;
      if (self.evaluate(t, self.argument_, self.rate_)) {
        result.col(i) = (self.rate_ - values(y_rate)) / difference;
        break;
      }
      if (way < 0.0) return 1;
    }
    self.argument_[i] = at;
  }
  return 0;
}

}  // namespace koppel

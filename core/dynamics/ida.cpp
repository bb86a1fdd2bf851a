#include "dynamics/ida.hpp"

#include <ida/ida.h>

namespace koppel {

Ida::Ida(ConstrainedEquation& problem, double tolerance, double first_step)
    : SundialsIntegrator(problem, tolerance, first_step), loops_(problem) {}

Ida::~Ida() { IDAFree(&memory_); }

void Ida::create() {
  IDAFree(&memory_);
  memory_ = IDACreate(vectors_->context);
  IDASetErrHandlerFn(memory_, say_nothing, nullptr);
  IDASetUserData(memory_, this);
  if (memory_ == nullptr || IDAInit(memory_, residual, 0.0, vectors_->y, vectors_->y_rate) < 0 ||
      IDAWFtolerances(memory_, weights) < 0 || IDASetLinearSolver(memory_, vectors_->solver, vectors_->matrix) < 0 ||
      IDASetJacFn(memory_, jacobian) < 0) {
    throw std::bad_alloc();
  }
  IDASetMaxErrTestFails(memory_, most_failures);
  IDASetMaxConvFails(memory_, most_failures);
}

int Ida::residual(realtype t, N_Vector y, N_Vector y_rate, N_Vector missing, void* of) {
  auto& self = *static_cast<Ida*>(of);
  self.unknowns_ = values(y);
  self.unknowns_rate_ = values(y_rate);
  if (!self.find_missing(t, self.unknowns_, self.unknowns_rate_)) return 1;  // nearer by it may be defined
  values(missing) = self.missing_;
  return 0;
}

int Ida::weights(N_Vector y, N_Vector weights, void* of) {
  const auto& self = *static_cast<const Ida*>(of);
  set_weights(y, self.scales_, self.tolerance_, weights);
  return 0;
}

/// Difference quotients, of unknowns and c times their rates at once; exact for the multipliers.
int Ida::jacobian(realtype t, realtype c, N_Vector y, N_Vector y_rate, N_Vector missing, SUNMatrix matrix, void* of,
                  N_Vector, N_Vector, N_Vector) {
  auto& self = *static_cast<Ida*>(of);
  auto result = values(matrix);
  const Eigen::Index work = self.sizes_.unknowns() - 1;
  self.missing_before_ = values(missing);
  self.unknowns_ = values(y);
  self.unknowns_rate_ = values(y_rate);
  for (Eigen::Index i = 0; i < result.cols(); ++i) {
    if (i == work) {  // nothing depends on it but its own rate
      result.col(i).setZero();
      result(i, i) = c;
      continue;
    }
    const double at = self.unknowns_[i], rate = self.unknowns_rate_[i];
    const double size = i < work ? quotient_step(at, self.scales_[i]) : std::max(1.0, std::abs(at));
    for (const double way : {size, -size}) {
      self.unknowns_[i] = at + way;
      const double difference = self.unknowns_[i] - at;
      self.unknowns_rate_[i] = rate + c * difference;
      if (self.find_missing(t, self.unknowns_, self.unknowns_rate_)) {
        result.col(i) = (self.missing_ - self.missing_before_) / difference;
        break;
      }
      if (way < 0.0) return 1;
    }
    self.unknowns_[i] = at;
    self.unknowns_rate_[i] = rate;
  }
  return 0;
}

bool Ida::find_missing(double t, const Eigen::VectorXd& unknowns, const Eigen::VectorXd& unknowns_rate) {
  const Eigen::Index size = sizes_.unknowns(), m = sizes_.conditions;
  u_ = unknowns.head(size);
  u_rate_ = unknowns_rate.head(size);
  lambda_ = unknowns.segment(size, m);
  mu_ = unknowns.tail(m);
  ++statistics_.evaluations;
  return loops_.residual(t, u_, u_rate_, lambda_, mu_, missing_);
}

bool Ida::start(double t, const Eigen::VectorXd& y) {
  time_ = before_ = t;
  y_ = y;
  sizes_ = loops_.sizes();
  loops_.unknown_scales(scales_);
  const Eigen::Index size = sizes_.unknowns(), count = size + 2 * sizes_.conditions;
  if (vectors_ == nullptr || values(vectors_->y).size() != count) {
    vectors_ = std::make_unique<SundialsVectors>(count);
    create();
  }
  ++statistics_.evaluations;
  if (!loops_.begin(t, y, u_rate_, lambda_)) return false;
  loops_.gather(y, u_);
  values(vectors_->y) << u_, lambda_, Eigen::VectorXd::Zero(sizes_.conditions);
  values(vectors_->y_rate) << u_rate_, Eigen::VectorXd::Zero(2 * sizes_.conditions);
  return IDAReInit(memory_, t, vectors_->y, vectors_->y_rate) == IDA_SUCCESS;
}

bool Ida::unfold(double t, const Eigen::VectorXd& unknowns, Eigen::VectorXd& y) {
  u_ = unknowns.head(sizes_.unknowns());
  return loops_.spread(t, u_, y);
}

int Ida::advance(double limit, double /*least*/, double& t) {
  IDASetStopTime(memory_, limit);
  return IDASolve(memory_, limit, &t, vectors_->y, vectors_->y_rate, IDA_ONE_STEP);
}

long Ida::failures() const {
  long rejected = 0, unsolved = 0;
  IDAGetNumErrTestFails(memory_, &rejected);
  IDAGetNumStepSolveFails(memory_, &unsolved);
  return rejected + unsolved;
}

int Ida::last_order() const {
  int order = 0;
  IDAGetLastOrder(memory_, &order);
  return order;
}

bool Ida::derivative(int k, N_Vector into) { return IDAGetDky(memory_, time_, k, into) == IDA_SUCCESS; }

}  // namespace koppel

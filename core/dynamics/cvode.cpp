#include "dynamics/cvode.hpp"

#include <cvode/cvode.h>

#include "dynamics/sundials.hpp"

namespace koppel {

struct Cvode::Memory {
  SundialsVectors of;
  void* cvode = nullptr;
  StepPolynomial polynomial;

  Memory(Cvode& self, Eigen::Index n);
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() { CVodeFree(&cvode); }

  static int rate(realtype t, N_Vector y, N_Vector y_rate, void* of);
  static int weights(N_Vector y, N_Vector weights, void* of);
  static int jacobian(realtype t, N_Vector y, N_Vector y_rate, SUNMatrix matrix, void* of, N_Vector, N_Vector,
                      N_Vector);
};

Cvode::Memory::Memory(Cvode& self, Eigen::Index n) : of(n), cvode(CVodeCreate(CV_BDF, of.context)) {
  CVodeSetErrHandlerFn(cvode, say_nothing, nullptr);
  CVodeSetUserData(cvode, &self);
  if (cvode == nullptr || CVodeInit(cvode, rate, 0.0, of.y) < 0 || CVodeWFtolerances(cvode, weights) < 0 ||
      CVodeSetLinearSolver(cvode, of.solver, of.matrix) < 0 || CVodeSetJacFn(cvode, jacobian) < 0) {
    CVodeFree(&cvode);
    throw std::bad_alloc();
  }
  CVodeSetMaxErrTestFails(cvode, 40);
  CVodeSetMaxConvFails(cvode, 40);
}

int Cvode::Memory::rate(realtype t, N_Vector y, N_Vector y_rate, void* of) {
  auto& self = *static_cast<Cvode*>(of);
  self.argument_ = values(y);
  if (!self.evaluate(t, self.argument_, self.rate_)) return 1;  // nearer by it may be defined
  values(y_rate) = self.rate_;
  return 0;
}

int Cvode::Memory::weights(N_Vector y, N_Vector weights, void* of) {
  const auto& self = *static_cast<const Cvode*>(of);
  set_weights(y, self.problem_->scales(), self.tolerance_, weights);
  return 0;
}

/// Difference quotients, of the components that rates depend on.
int Cvode::Memory::jacobian(realtype t, N_Vector y, N_Vector y_rate, SUNMatrix matrix, void* of, N_Vector, N_Vector,
                            N_Vector) {
  auto& self = *static_cast<Cvode*>(of);
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

Cvode::Cvode(DifferentialEquation& problem, double tolerance, double first_step)
    : Integrator(problem, tolerance, first_step) {}

Cvode::~Cvode() = default;

bool Cvode::start(double t, const Eigen::VectorXd& y) {
  if (memory_ == nullptr || y.size() != y_.size()) {
    memory_ = std::make_unique<Memory>(*this, y.size());
    for (Eigen::VectorXd* x : {&argument_, &rate_, &moved_}) x->setZero(y.size());
  }
  time_ = before_ = t;
  y_ = y;
  memory_->polynomial.degree = -1;
  values(memory_->of.y) = y;
  return CVodeReInit(memory_->cvode, t, memory_->of.y) == CV_SUCCESS && evaluate(t, y_, rate_);
}

bool Cvode::exchange(Archive& archive) {
  Eigen::VectorXd y = y_;
  if (!archive.is_reading()) return Integrator::exchange(archive);
  if (!Integrator::exchange(archive)) return false;
  const Statistics counted = statistics_;
  y = y_;
  y_.resize(0);
  const bool defined = start(time_, y);
  statistics_ = counted;
  return defined;
}

StepStatus Cvode::step(double limit) {
  before_ = time_;
  memory_->polynomial.degree = -1;
  double t = limit;
  const double least = 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(limit), std::abs(time_));
  if (limit - time_ > 2.0 * least) {
    long rejected = 0, unsolved = 0, rejected_before = 0, unsolved_before = 0;
    CVodeGetNumErrTestFails(memory_->cvode, &rejected_before);
    CVodeGetNumStepSolveFails(memory_->cvode, &unsolved_before);
    CVodeSetMinStep(memory_->cvode, least);
    CVodeSetStopTime(memory_->cvode, limit);
    const int flag = CVode(memory_->cvode, limit, memory_->of.y, &t, CV_ONE_STEP);
    CVodeGetNumErrTestFails(memory_->cvode, &rejected);
    CVodeGetNumStepSolveFails(memory_->cvode, &unsolved);
    statistics_.rejected += static_cast<std::uint64_t>(rejected - rejected_before + unsolved - unsolved_before);
    if (flag < 0) return StepStatus::too_small;
    y_ = values(memory_->of.y);
  }
  ++statistics_.steps;
  time_ = t;
  return evaluate(time_, y_, rate_) ? StepStatus::done : StepStatus::too_small;
}

void Cvode::interpolate(double t, Eigen::VectorXd& y) {
  if (t == time_) {
    y = y_;
    return;
  }
  StepPolynomial& polynomial = memory_->polynomial;
  if (polynomial.degree < 0) {
    int order = 0;
    CVodeGetLastOrder(memory_->cvode, &order);
    polynomial.take(time_, order, memory_->of.y,
                    [&](int k, N_Vector into) { return CVodeGetDky(memory_->cvode, time_, k, into) == CV_SUCCESS; });
  }
  polynomial.at(t, y);
}

bool Cvode::shorten(double t) {
  interpolate(t, moved_);
  const double before = before_;
  const StepPolynomial polynomial = memory_->polynomial;
  if (!start(t, moved_)) return false;
  before_ = before;
  memory_->polynomial = polynomial;
  return true;
}

}  // namespace koppel

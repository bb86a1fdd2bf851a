#include "dynamics/ida.hpp"

#include <ida/ida.h>

#include "dynamics/sundials.hpp"

namespace koppel {

struct Ida::Memory {
  SundialsVectors of;
  void* ida = nullptr;
  StepPolynomial polynomial;

  Memory(Ida& self, Eigen::Index n);
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() { IDAFree(&ida); }

  static int residual(realtype t, N_Vector y, N_Vector y_rate, N_Vector missing, void* self);
  static int weights(N_Vector y, N_Vector weights, void* self);
  static int jacobian(realtype t, realtype c, N_Vector y, N_Vector y_rate, N_Vector missing, SUNMatrix matrix,
                      void* self, N_Vector, N_Vector, N_Vector);
};

Ida::Memory::Memory(Ida& self, Eigen::Index n) : of(n), ida(IDACreate(of.context)) {
  IDASetErrHandlerFn(ida, say_nothing, nullptr);
  IDASetUserData(ida, &self);
  if (ida == nullptr || IDAInit(ida, residual, 0.0, of.y, of.y_rate) < 0 || IDAWFtolerances(ida, weights) < 0 ||
      IDASetLinearSolver(ida, of.solver, of.matrix) < 0 || IDASetJacFn(ida, jacobian) < 0) {
    IDAFree(&ida);
    throw std::bad_alloc();
  }
  IDASetMaxErrTestFails(ida, 40);
  IDASetMaxConvFails(ida, 40);
}

int Ida::Memory::residual(realtype t, N_Vector y, N_Vector y_rate, N_Vector missing, void* of) {
  auto& self = *static_cast<Ida*>(of);
  self.unknowns_ = values(y);
  self.unknowns_rate_ = values(y_rate);
  if (!self.residual(t, self.unknowns_, self.unknowns_rate_)) return 1;  // nearer by it may be defined
  values(missing) = self.missing_;
  return 0;
}

int Ida::Memory::weights(N_Vector y, N_Vector weights, void* of) {
  const auto& self = *static_cast<const Ida*>(of);
  set_weights(y, self.scales_, self.tolerance_, weights);
  return 0;
}

/// Difference quotients, of unknowns and c times their rates at once; exact for the multipliers.
int Ida::Memory::jacobian(realtype t, realtype c, N_Vector y, N_Vector y_rate, N_Vector missing, SUNMatrix matrix,
                          void* of, N_Vector, N_Vector, N_Vector) {
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
      if (self.residual(t, self.unknowns_, self.unknowns_rate_)) {
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

Ida::Ida(ConstrainedEquation& problem, double tolerance, double first_step)
    : Integrator(problem, tolerance, first_step), loops_(problem) {}

Ida::~Ida() = default;

bool Ida::residual(double t, const Eigen::VectorXd& unknowns, const Eigen::VectorXd& unknowns_rate) {
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
  if (memory_ == nullptr || values(memory_->of.y).size() != count) memory_ = std::make_unique<Memory>(*this, count);
  memory_->polynomial.degree = -1;
  ++statistics_.evaluations;
  if (!loops_.begin(t, y, u_rate_, lambda_)) return false;
  loops_.gather(y, u_);
  values(memory_->of.y) << u_, lambda_, Eigen::VectorXd::Zero(sizes_.conditions);
  values(memory_->of.y_rate) << u_rate_, Eigen::VectorXd::Zero(2 * sizes_.conditions);
  return IDAReInit(memory_->ida, t, memory_->of.y, memory_->of.y_rate) == IDA_SUCCESS;
}

bool Ida::exchange(Archive& archive) {
  if (!Integrator::exchange(archive)) return false;
  if (!archive.is_reading()) return true;
  const Statistics counted = statistics_;
  const bool defined = start(time_, Eigen::VectorXd(y_));
  statistics_ = counted;
  return defined;
}

/// y_ where the vector of unknowns stands, at t.
bool Ida::take(double t) {
  u_ = values(memory_->of.y).head(sizes_.unknowns());
  return loops_.spread(t, u_, y_);
}

StepStatus Ida::step(double limit) {
  before_ = time_;
  memory_->polynomial.degree = -1;
  double t = limit;
  const double least = 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(limit), std::abs(time_));
  if (limit - time_ > 2.0 * least) {
    void* const ida = memory_->ida;
    long rejected = 0, unsolved = 0, rejected_before = 0, unsolved_before = 0;
    IDAGetNumErrTestFails(ida, &rejected_before);
    IDAGetNumStepSolveFails(ida, &unsolved_before);
    IDASetStopTime(ida, limit);
    const int flag = IDASolve(ida, limit, &t, memory_->of.y, memory_->of.y_rate, IDA_ONE_STEP);
    IDAGetNumErrTestFails(ida, &rejected);
    IDAGetNumStepSolveFails(ida, &unsolved);
    statistics_.rejected += static_cast<std::uint64_t>(rejected - rejected_before + unsolved - unsolved_before);
    if (flag < 0) return StepStatus::too_small;
  }
  ++statistics_.steps;
  time_ = t;
  return take(time_) ? StepStatus::done : StepStatus::too_small;
}

void Ida::interpolate(double t, Eigen::VectorXd& y) {
  if (t == time_) {
    y = y_;
    return;
  }
  StepPolynomial& polynomial = memory_->polynomial;
  if (polynomial.degree < 0) {
    int order = 0;
    IDAGetLastOrder(memory_->ida, &order);
    polynomial.take(time_, order, memory_->of.y,
                    [&](int k, N_Vector into) { return IDAGetDky(memory_->ida, time_, k, into) == IDA_SUCCESS; });
  }
  polynomial.at(t, moved_);
  u_ = moved_.head(sizes_.unknowns());
  loops_.spread(t, u_, y);  // where it cannot stand, whoever reads it there is told
}

bool Ida::shorten(double t) {
  interpolate(t, moved_);
  const double before = before_;
  const StepPolynomial polynomial = memory_->polynomial;
  const Eigen::VectorXd y = moved_;
  if (!start(t, y)) return false;
  before_ = before;
  memory_->polynomial = polynomial;
  return true;
}

}  // namespace koppel

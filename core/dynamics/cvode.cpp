#include "dynamics/cvode.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double no_weight = 1e-100;  // of components that are not controlled; CVODE divides by weights

Eigen::Map<Eigen::VectorXd> values(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<Eigen::Index>(N_VGetLength(vector))};
}

void say_nothing(int, const char*, const char*, char*, void*) {}

}  // namespace

struct Cvode::Memory {
  SUNContext context = nullptr;
  void* cvode = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;

  Memory(Cvode& of, Eigen::Index n);
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() { release(); }
  void release();

  static int rate(realtype t, N_Vector y, N_Vector y_rate, void* of);
  static int weights(N_Vector y, N_Vector weights, void* of);
  static int jacobian(realtype t, N_Vector y, N_Vector y_rate, SUNMatrix matrix, void* of, N_Vector, N_Vector,
                      N_Vector);
};

Cvode::Memory::Memory(Cvode& of, Eigen::Index n) {
  SUNContext_Create(nullptr, &context);
  cvode = CVodeCreate(CV_BDF, context);
  y = N_VNew_Serial(n, context);
  matrix = SUNDenseMatrix(n, n, context);
  if (context == nullptr || cvode == nullptr || y == nullptr || matrix == nullptr) {
    release();
    throw std::bad_alloc();
  }
  N_VConst(0.0, y);
  solver = SUNLinSol_Dense(y, matrix, context);
  CVodeSetErrHandlerFn(cvode, say_nothing, nullptr);
  CVodeSetUserData(cvode, &of);
  if (solver == nullptr || CVodeInit(cvode, rate, 0.0, y) < 0 || CVodeWFtolerances(cvode, weights) < 0 ||
      CVodeSetLinearSolver(cvode, solver, matrix) < 0 || CVodeSetJacFn(cvode, jacobian) < 0) {
    release();
    throw std::bad_alloc();
  }
  CVodeSetMaxErrTestFails(cvode, 40);
  CVodeSetMaxConvFails(cvode, 40);
}

void Cvode::Memory::release() {
  if (cvode != nullptr) CVodeFree(&cvode);
  if (solver != nullptr) SUNLinSolFree(solver);
  if (matrix != nullptr) SUNMatDestroy(matrix);
  if (y != nullptr) N_VDestroy(y);
  if (context != nullptr) SUNContext_Free(&context);
}

int Cvode::Memory::rate(realtype t, N_Vector y, N_Vector y_rate, void* of) {
  auto& self = *static_cast<Cvode*>(of);
  self.argument_ = values(y);
  if (!self.evaluate(t, self.argument_, self.rate_)) return 1;  // nearer by it may be defined
  values(y_rate) = self.rate_;
  return 0;
}

/// CVODE takes the mean over all components, and errors count in the mean over those that are controlled.
int Cvode::Memory::weights(N_Vector y, N_Vector weights, void* of) {
  const auto& self = *static_cast<const Cvode*>(of);
  const Eigen::VectorXd& scales = self.problem_->scales();
  const auto at = values(y);
  auto out = values(weights);
  const auto controlled = scales.array().isFinite().count();
  const double share =
      std::sqrt(static_cast<double>(at.size()) / static_cast<double>(std::max<Eigen::Index>(controlled, 1)));
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    out[i] = std::isfinite(scales[i]) ? share / (self.tolerance_ * std::max(scales[i], std::abs(at[i]))) : no_weight;
  }
  return 0;
}

/// Difference quotients, of the components that rates depend on.
int Cvode::Memory::jacobian(realtype t, N_Vector y, N_Vector y_rate, SUNMatrix matrix, void* of, N_Vector, N_Vector,
                            N_Vector) {
  auto& self = *static_cast<Cvode*>(of);
  const Eigen::VectorXd& scales = self.problem_->scales();
  const Eigen::Index n = scales.size();
  Eigen::Map<Eigen::MatrixXd> result(SUNDenseMatrix_Data(matrix), n, n);
  result.setZero();
  self.argument_ = values(y);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!std::isfinite(scales[i])) continue;
    const double at = self.argument_[i], size = std::sqrt(eps) * std::max(scales[i], std::abs(at));
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
    for (Eigen::VectorXd& x : derivatives_) x.setZero(y.size());
  }
  time_ = before_ = t;
  y_ = y;
  degree_ = -1;
  values(memory_->y) = y;
  return CVodeReInit(memory_->cvode, t, memory_->y) == CV_SUCCESS && evaluate(t, y_, rate_);
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
  degree_ = -1;
  double t = limit;
  const double least = 16.0 * eps * std::max(std::abs(limit), std::abs(time_));
  if (limit - time_ > 2.0 * least) {
    long rejected = 0, unsolved = 0, rejected_before = 0, unsolved_before = 0;
    CVodeGetNumErrTestFails(memory_->cvode, &rejected_before);
    CVodeGetNumStepSolveFails(memory_->cvode, &unsolved_before);
    CVodeSetMinStep(memory_->cvode, least);
    CVodeSetStopTime(memory_->cvode, limit);
    const int flag = CVode(memory_->cvode, limit, memory_->y, &t, CV_ONE_STEP);
    CVodeGetNumErrTestFails(memory_->cvode, &rejected);
    CVodeGetNumStepSolveFails(memory_->cvode, &unsolved);
    statistics_.rejected += static_cast<std::uint64_t>(rejected - rejected_before + unsolved - unsolved_before);
    if (flag < 0) return StepStatus::too_small;
    y_ = values(memory_->y);
  }
  ++statistics_.steps;
  time_ = t;
  return evaluate(time_, y_, rate_) ? StepStatus::done : StepStatus::too_small;
}

/// The polynomial of the last step, by its derivatives at the end.
void Cvode::take_polynomial() {
  constexpr int highest = 5;
  int order = 0;
  CVodeGetLastOrder(memory_->cvode, &order);
  degree_ = -1;
  end_ = time_;
  for (int k = 0; k <= std::min(order, highest); ++k) {
    if (CVodeGetDky(memory_->cvode, time_, k, memory_->y) != CV_SUCCESS) break;
    derivatives_[static_cast<std::size_t>(k)] = values(memory_->y);
    degree_ = k;
  }
}

void Cvode::interpolate(double t, Eigen::VectorXd& y) {
  if (t == time_) {
    y = y_;
    return;
  }
  if (degree_ < 0) take_polynomial();
  y.setZero(y_.size());
  for (int k = degree_; k >= 0; --k) y = derivatives_[static_cast<std::size_t>(k)] + (t - end_) / (k + 1) * y;
}

bool Cvode::shorten(double t) {
  interpolate(t, moved_);
  const double before = before_, end = end_;
  const int degree = degree_;
  if (!start(t, moved_)) return false;
  before_ = before;
  end_ = end;
  degree_ = degree;
  return true;
}

}  // namespace koppel

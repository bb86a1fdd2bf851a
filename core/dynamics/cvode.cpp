#include "dynamics/cvode.hpp"

#include <cvode/cvode.h>

namespace koppel {

Cvode::~Cvode() { CVodeFree(&memory_); }

void Cvode::create() {
  CVodeFree(&memory_);
  memory_ = CVodeCreate(CV_BDF, vectors_->context);
  CVodeSetErrHandlerFn(memory_, say_nothing, nullptr);
  CVodeSetUserData(memory_, static_cast<SundialsOde*>(this));
  if (memory_ == nullptr || CVodeInit(memory_, rate, 0.0, vectors_->y) < 0 || CVodeWFtolerances(memory_, weights) < 0 ||
      CVodeSetLinearSolver(memory_, vectors_->solver, vectors_->matrix) < 0 || CVodeSetJacFn(memory_, jacobian) < 0) {
    throw std::bad_alloc();
  }
  CVodeSetMaxErrTestFails(memory_, most_failures);
  CVodeSetMaxConvFails(memory_, most_failures);
}

bool Cvode::start(double t, const Eigen::VectorXd& y) {
  if (make_vectors(y)) create();
  time_ = before_ = t;
  y_ = y;
  return CVodeReInit(memory_, t, vectors_->y) == CV_SUCCESS && evaluate(t, y_, rate_);
}

int Cvode::advance(double limit, double least, double& t) {
  CVodeSetMinStep(memory_, least);
  CVodeSetStopTime(memory_, limit);
  return CVode(memory_, limit, vectors_->y, &t, CV_ONE_STEP);
}

long Cvode::failures() const {
  long rejected = 0, unsolved = 0;
  CVodeGetNumErrTestFails(memory_, &rejected);
  CVodeGetNumStepSolveFails(memory_, &unsolved);
  return rejected + unsolved;
}

int Cvode::last_order() const {
  int order = 0;
  CVodeGetLastOrder(memory_, &order);
  return order;
}

bool Cvode::derivative(int k, N_Vector into) { return CVodeGetDky(memory_, time_, k, into) == CV_SUCCESS; }

}  // namespace koppel

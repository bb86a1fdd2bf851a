#include "dynamics/arkode.hpp"

#include <arkode/arkode_arkstep.h>

namespace koppel {

Arkode::~Arkode() { ARKStepFree(&memory_); }

void Arkode::create() {
  ARKStepFree(&memory_);
  memory_ = ARKStepCreate(nullptr, rate, 0.0, vectors_->y, vectors_->context);
  ARKStepSetErrHandlerFn(memory_, say_nothing, nullptr);
  ARKStepSetUserData(memory_, static_cast<SundialsOde*>(this));
  if (memory_ == nullptr || ARKStepSetTableNum(memory_, ARKODE_ESDIRK547L2SA_7_4_5, ARKODE_ERK_NONE) < 0 ||
      ARKStepSetInterpolantType(memory_, ARK_INTERP_HERMITE) < 0 || ARKStepSetInterpolantDegree(memory_, 5) < 0 ||
      ARKStepWFtolerances(memory_, weights) < 0 ||
      ARKStepSetLinearSolver(memory_, vectors_->solver, vectors_->matrix) < 0 ||
      ARKStepSetJacFn(memory_, jacobian) < 0) {
    throw std::bad_alloc();
  }
  ARKStepSetMaxErrTestFails(memory_, most_failures);
  ARKStepSetMaxConvFails(memory_, most_failures);
}

bool Arkode::begin(double t, const Eigen::VectorXd& y, double first_step) {
  if (make_vectors(y)) create();
  time_ = before_ = t;
  y_ = y;
  return ARKStepReInit(memory_, nullptr, rate, t, vectors_->y) == ARK_SUCCESS &&
         ARKStepSetInitStep(memory_, first_step) == ARK_SUCCESS && evaluate(t, y_, rate_);
}

bool Arkode::restart(double t, const Eigen::VectorXd& y) {
  double next = 0.0;
  ARKStepGetCurrentStep(memory_, &next);
  return begin(t, y, next);
}

void Arkode::settle(const Eigen::VectorXd& y) {
  SundialsOde::settle(y);
  ARKStepReset(memory_, time_, vectors_->y);
}

int Arkode::advance(double limit, double least, double& t) {
  ARKStepSetMinStep(memory_, least);
  ARKStepSetStopTime(memory_, limit);
  return ARKStepEvolve(memory_, limit, vectors_->y, &t, ARK_ONE_STEP);
}

long Arkode::failures() const {
  long rejected = 0, unsolved = 0;
  ARKStepGetNumErrTestFails(memory_, &rejected);
  ARKStepGetNumStepSolveFails(memory_, &unsolved);
  return rejected + unsolved;
}

bool Arkode::derivative(int k, N_Vector into) { return ARKStepGetDky(memory_, time_, k, into) == ARK_SUCCESS; }

}  // namespace koppel

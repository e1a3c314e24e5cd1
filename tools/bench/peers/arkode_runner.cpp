#include "arkode_runner.h"

#include <vector>

namespace steplap::peers {

ArkodeRunner::ArkodeRunner(const ArkodeProblem& problem, double* y, double tolerance)
    : problem_(problem), y_(problem.size, y, sundials_.context) {
  memory_ = ARKStepCreate(problem.rates, nullptr, 0.0, y_.get(), sundials_.context);
  require(ARKStepSetTableNum(memory_, ARKODE_DIRK_NONE, ARKODE_DORMAND_PRINCE_7_4_5), "SetTableNum");
  require(ARKStepSStolerances(memory_, tolerance, tolerance), "SStolerances");
  require(ARKStepSetUserData(memory_, problem.data), "SetUserData");
  require(ARKStepSetMaxNumSteps(memory_, 10000000), "SetMaxNumSteps");
  if (problem.longest_step > 0.0) require(ARKStepSetMaxStep(memory_, problem.longest_step), "SetMaxStep");
  if (problem.switches == 0) return;
  require(ARKStepRootInit(memory_, problem.switches, problem.roots), "RootInit");
  std::vector<int> falling(static_cast<std::size_t>(problem.switches), -1);
  require(ARKStepSetRootDirection(memory_, falling.data()), "SetRootDirection");
  require(ARKStepSetNoInactiveRootWarn(memory_), "SetNoInactiveRootWarn");
}

ArkodeRunner::~ArkodeRunner() { ARKStepFree(&memory_); }

int ArkodeRunner::run(double until, int task) {
  require(ARKStepSetStopTime(memory_, until), "SetStopTime");
  const int flag = ARKStepEvolve(memory_, until, y_.get(), &t_, task);
  require(flag, "Evolve");
  if (flag != ARK_ROOT_RETURN) return -1;
  std::vector<int> found(static_cast<std::size_t>(problem_.switches));
  require(ARKStepGetRootInfo(memory_, found.data()), "GetRootInfo");
  for (int i = 0; i < problem_.switches; ++i)
    if (found[static_cast<std::size_t>(i)] != 0) return i;
  return -1;
}

int ArkodeRunner::advance(double until) {
  int slot = -1;
  while (slot < 0 && t_ < until) slot = run(until, ARK_NORMAL);
  return slot;
}

int ArkodeRunner::step(double until) { return run(until, ARK_ONE_STEP); }

void ArkodeRunner::restart(double first_step) {
  past_steps_ = steps();
  past_evaluations_ = evaluations();
  double last = 0.0;
  require(ARKStepGetLastStep(memory_, &last), "GetLastStep");
  require(ARKStepReInit(memory_, problem_.rates, nullptr, t_, y_.get()), "ReInit");
  require(ARKStepSetInitStep(memory_, first_step > 0.0 ? first_step : last), "SetInitStep");
}

void ArkodeRunner::interpolate(double t, double* y) {
  const VectorView view(problem_.size, y, sundials_.context);
  require(ARKStepGetDky(memory_, t, 0, view.get()), "GetDky");
}

long ArkodeRunner::steps() const {
  long n = 0;
  require(ARKStepGetNumSteps(memory_, &n), "GetNumSteps");
  return past_steps_ + n;
}

long ArkodeRunner::evaluations() const {
  long n = 0;
  long implicit = 0;
  require(ARKStepGetNumRhsEvals(memory_, &n, &implicit), "GetNumRhsEvals");
  return past_evaluations_ + n;
}

} // namespace steplap::peers

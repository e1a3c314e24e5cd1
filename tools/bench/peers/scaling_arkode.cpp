// Integrates the hand-written scenes with ARKODE: Dormand-Prince 5(4) with fixed step.
#include "scaling.h"
#include "sundials_handles.h"

#include <arkode/arkode_arkstep.h>

namespace steplap::peers {

namespace {

int rates_of(double, N_Vector y, N_Vector dy, void* scene) {
  static_cast<ByHand*>(scene)->rates(data_of(y), data_of(dy));
  return 0;
}

} // namespace

ScalingResult run_arkode(ByHand& scene, int bodies) {
  std::vector<double> start = scene.start();
  const SundialsContext sundials;
  const VectorView y(static_cast<int>(start.size()), start.data(), sundials.context);
  void* memory = ARKStepCreate(rates_of, nullptr, 0.0, y.get(), sundials.context);
  require(ARKStepSetTableNum(memory, ARKODE_DIRK_NONE, ARKODE_DORMAND_PRINCE_7_4_5), "SetTableNum");
  require(ARKStepSetUserData(memory, &scene), "SetUserData");
  require(ARKStepSetFixedStep(memory, k_scaling_step), "SetFixedStep");
  require(ARKStepSetMaxNumSteps(memory, 1000000), "SetMaxNumSteps");
  ScalingResult result;
  double t = 0.0;
  int done = 0;
  result.step_us = least_step_us(bodies, [&](int steps) {
    for (int s = 0; s < steps; ++s) require(ARKStepEvolve(memory, 1e3, y.get(), &t, ARK_ONE_STEP), "Evolve");
    done += steps;
  });
  long explicit_rates = 0, implicit_rates = 0;
  require(ARKStepGetNumRhsEvals(memory, &explicit_rates, &implicit_rates), "GetNumRhsEvals");
  result.evaluations = static_cast<double>(explicit_rates) / done;
  result.probe = scene.probe(start.data());
  ARKStepFree(&memory);
  return result;
}

} // namespace steplap::peers

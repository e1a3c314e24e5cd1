#pragma once

// ARKODE's explicit Dormand-Prince 5(4) for the small scenes: run to a time or to
// the first root, restart after a mode change, count everything.

#include "sundials_handles.h"

#include <arkode/arkode_arkstep.h>

namespace steplap::peers {

struct ArkodeProblem {
  int size = 0;
  ARKRhsFn rates = nullptr;
  void* data = nullptr;
  int switches = 0; // number of root functions, watched for falling through zero
  ARKRootFn roots = nullptr;
  double longest_step = 0.0; // 0: no bound
};

class ArkodeRunner {
public:
  // y stays the caller's and always holds the state at time().
  ArkodeRunner(const ArkodeProblem& problem, double* y, double tolerance);
  ~ArkodeRunner();
  ArkodeRunner(const ArkodeRunner&) = delete;
  ArkodeRunner& operator=(const ArkodeRunner&) = delete;

  // Advances to the time, or to the first root before it: its slot, else −1.
  int advance(double until);
  // To be called after a change of y or of the modes; 0: the last step again.
  void restart(double first_step = 0.0);
  // Interpolated state at a time within the last step.
  void interpolate(double t, double* y);
  // As advance, but returns after every step, for sampling (−1: no root).
  int step(double until);

  [[nodiscard]] double time() const { return t_; }
  [[nodiscard]] long steps() const;
  [[nodiscard]] long evaluations() const;

private:
  int run(double until, int task);

  const ArkodeProblem problem_;
  SundialsContext sundials_;
  VectorView y_;
  void* memory_ = nullptr;
  double t_ = 0.0;
  long past_steps_ = 0;
  long past_evaluations_ = 0;
};

} // namespace steplap::peers

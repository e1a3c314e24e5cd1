#pragma once

// Explicit Dormand-Prince 5(4) of ARKODE for the small scenes: integrates to a given time or to the first root, restarts after a mode
// change, and counts steps and evaluations.

#include "sundials_handles.h"

#include <arkode/arkode_arkstep.h>

namespace steplap::peers {

struct ArkodeProblem {
  int size = 0;
  ARKRhsFn rates = nullptr;
  void* data = nullptr;
  int switches = 0; // number of event functions; an event is a change to a negative value
  ARKRootFn roots = nullptr;
  double longest_step = 0.0; // longest step, s; 0: unlimited
};

class ArkodeRunner {
public:
  // `y` belongs to the caller and always contains the state at time().
  ArkodeRunner(const ArkodeProblem& problem, double* y, double tolerance);
  ~ArkodeRunner();
  ArkodeRunner(const ArkodeRunner&) = delete;
  ArkodeRunner& operator=(const ArkodeRunner&) = delete;

  // Integrates to the time `until`, or to the first event before. Returns the index of the event function; −1 if there was none.
  int advance(double until);
  // Must be called after y or the modes were changed. `first_step` 0: starts with the last step size.
  void restart(double first_step = 0.0);
  // Returns the interpolated state at a time within the last step.
  void interpolate(double t, double* y);
  // As advance(), but returns after every step, so that the caller can sample it.
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

// Runs by time stepping, whose steps are given instead of a tolerance.
#pragma once

#include "tests/physics/scene.h"

namespace steplap::testing {

inline Run stepped(const std::string& text, double step, double end, double output_step = 0.0) {
  Run r;
  r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
  SimulationOptions o = options({"moreau", 1.0, end, output_step});
  o.settings.step = step;
  r.result = simulate(*r.system, r.system->initial_state(), o);
  return r;
}

} // namespace steplap::testing

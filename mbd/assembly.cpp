#include "mbd/assembly.h"

#include "mbd/dynamics.h"
#include "mbd/number_text.h"

#include <cmath>

namespace steplap {

State assemble(const Model& model, const System& system) {
  State state = system.initial_state();
  start_drives(system, state);
  // Friction does not assemble anything: what holds by friction is where it is.
  for (FrictionState& friction : state.friction) friction.phase = FrictionPhase::free;
  Dynamics dynamics(system);
  dynamics.set_state(state);
  std::vector<double> y(dynamics.dimension());
  dynamics.pack(state, y.data());
  try {
    dynamics.project(state.t, y.data(), model.simulation.projection_tolerance);
  } catch (const ConstraintFailure& failure) {
    const ElementEntry& entry = model.elements[failure.element];
    throw ModelError(entry.element->where,
                     entry.kind->name + " '" + entry.element->name +
                         "' cannot be assembled: with the other joints met it stays " +
                         number_text(std::abs(failure.residual)) + (failure.is_angle ? " rad" : " m") +
                         " off; move the bodies or change the joints");
  }
  dynamics.unpack(state.t, y.data(), state);
  return state;
}

} // namespace steplap

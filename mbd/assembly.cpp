#include "mbd/assembly.h"

#include "mbd/dynamics.h"
#include "mbd/number_text.h"

#include <algorithm>
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

std::vector<AssemblyMove> assembly_moves(const State& given, const State& assembled, double threshold) {
  std::vector<AssemblyMove> moves;
  for (std::size_t i = 3; i < given.q.size(); i += 3) {
    const auto change = [i](const std::vector<double>& from, const std::vector<double>& to, std::size_t k) {
      return to[i + k] - from[i + k];
    };
    AssemblyMove move;
    move.body = static_cast<int>(i / 3);
    move.shift = std::hypot(change(given.q, assembled.q, 0), change(given.q, assembled.q, 1));
    move.turn = change(given.q, assembled.q, 2);
    move.velocity = std::hypot(change(given.v, assembled.v, 0), change(given.v, assembled.v, 1));
    move.angular_velocity = change(given.v, assembled.v, 2);
    if (std::max({move.shift, std::abs(move.turn), move.velocity, std::abs(move.angular_velocity)}) > threshold)
      moves.push_back(move);
  }
  std::stable_sort(moves.begin(), moves.end(),
                   [](const AssemblyMove& x, const AssemblyMove& y) { return x.shift > y.shift; });
  return moves;
}

} // namespace steplap

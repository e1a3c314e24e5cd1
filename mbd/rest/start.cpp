#include "mbd/rest/start.h"

#include "mbd/rest/assembly.h"

#include <algorithm>

namespace steplap {

State start_of(const Model& model, const System& system) { return start_of(model, system, assemble(model, system)); }

State start_of(const Model& model, const System& system, const State& assembled) {
  if (model.simulation.initial == "equilibrium") return equilibrium_at_start(system, assembled).state;
  return assembled_start(system, assembled);
}

Equilibrium equilibrium_at_start(const System& system, const State& assembled) {
  const State given = assembled_start(system, assembled);
  State still = given;
  std::fill(still.v.begin(), still.v.end(), 0.0);
  Equilibrium found = find_equilibrium(system, still);
  found.state.v = given.v;
  return found;
}

} // namespace steplap

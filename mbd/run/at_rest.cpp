#include "mbd/run/at_rest.h"

namespace steplap {

// Returns true if motions and energies are rounding errors. No channel then has a range to which an error could be related.
bool is_at_rest(const Run& run) {
  const RunStatistics& s = run.result.statistics;
  return s.energy_exchanged <= s.energy_rounding && run.loaded->system->kinetic_energy(run.result.final_state) <= s.energy_rounding;
}

} // namespace steplap

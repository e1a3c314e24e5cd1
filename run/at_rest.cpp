#include "run/at_rest.h"

namespace steplap {

// What moves and what is exchanged is rounding: it has no range by which an error could be measured.
bool is_at_rest(const Run& run) {
  const RunStatistics& s = run.result.statistics;
  return s.energy_exchanged <= s.energy_rounding && run.loaded->system->kinetic_energy(run.result.final_state) <= s.energy_rounding;
}

} // namespace steplap

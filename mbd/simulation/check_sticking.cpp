#include "mbd/simulation/check_sticking.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_way_lock.h"
#include "mbd/system/slight_force.h"

#include <algorithm>
#include <cmath>

namespace steplap {

void check_sticking(const System& system, const State& state, const LoadSharing* sharing, double t,
                    const std::vector<double>& event_value) {
  // Limit relative to the capacity: the mode problem is accurate to 1e-9 of it, and events are located to rounding.
  constexpr double k_stuck_beyond = 1e-6;
  for (int f = 0; f < static_cast<int>(system.frictions.size()); ++f) {
    const FrictionUnit& unit = system.frictions[f];
    if (unit.friction->dimension() != 1 || unit.friction->never_slips()) continue;
    if (state.friction[f].phase != FrictionPhase::stick || (sharing && sharing->group_of(f) >= 0)) continue;
    const double one = event_value[unit.slot(FrictionWatch::first)], other = event_value[unit.slot(FrictionWatch::second)];
    const std::string& name = system.element_names[unit.element];
    if (const OneWayLock* const lock = one_way_lock(unit)) {
      const double beyond = -std::min(one, other); // the bounded side of a one-way clutch
      if (beyond <= k_stuck_beyond * lock->drag() + slight_force(system, *lock->rows(state.friction[f]))) continue;
      throw ElementFailure(
          "at t = " + number_text(t) + " s the one-way clutch '" + name + "' holds back with " + rounded_text(beyond + lock->drag()) +
              " where it drags with " + rounded_text(lock->drag()) +
              ": this is a contradiction, because it would have to slip. Try a smaller tolerance or step, or another integrator",
          {name});
    }
    if (std::min(one, other) >= -k_stuck_beyond * (std::abs(one) + std::abs(other))) continue;
    throw ElementFailure("at t = " + number_text(t) + " s '" + name + "' sticks with " + rounded_text(0.5 * std::abs(other - one)) +
                             " where it holds " + rounded_text(0.5 * (one + other)) +
                             ": the run contradicts itself, for it has to slip. Try a smaller tolerance or step, or another integrator",
                         {name});
  }
}

} // namespace steplap

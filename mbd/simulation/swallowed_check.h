// Check for bodies that lie completely inside the contact region of another body, where no contact force acts on them any more. The run
// must then stop.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/system/swallowing_contacts.h"

#include <vector>

namespace steplap {

/// Checks, at the end of each step, whether one body of a contact is completely inside the other.
class SwallowedCheck {
public:
  /// Selects the contacts of the system for which this is possible.
  explicit SwallowedCheck(const System& system);
  /// Checks the packed state y at time t, s. `modes`: modes of all units; `event_value`: all event functions. Throws ElementFailure that
  /// names the contact.
  void check(Dynamics& dynamics, double t, const double* y, const std::vector<UnitMode>& modes,
             const std::vector<double>& event_value) const;

private:
  std::vector<const SwallowingContacts*> contacts_;
};

} // namespace steplap

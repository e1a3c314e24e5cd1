// What has come to lie wholly within what it presses on feels nothing any more and would fall on for ever: no run passes over that.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/system/swallowing_contacts.h"

#include <vector>

namespace steplap {

/// Looks at each step's end whether one body of a contact lies wholly within the other.
class SwallowedCheck {
public:
  /// Of the system's contacts in which that can be.
  explicit SwallowedCheck(const System& system);
  /// In the state y at t in s, with the modes of all units and all watch values there. Throws ElementFailure that names the contact.
  void check(Dynamics& dynamics, double t, const double* y, const std::vector<UnitMode>& modes, const std::vector<double>& watch) const;

private:
  std::vector<const SwallowingContacts*> contacts_;
};

} // namespace steplap

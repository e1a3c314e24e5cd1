// Contacts in which one body can get completely inside the other, where the contact force no longer pushes it out.
#pragma once

#include "mbd/system/roles.h"

#include <functional>
#include <vector>

namespace steplap {

/// Additional interface of a group of contacts in which one body can get inside the other. The run must then stop, because the contact law
/// is not valid there.
class SwallowingContacts {
public:
  virtual ~SwallowingContacts() = default;
  /// Returns the index in System::units of the first closed contact with one body completely inside the other; −1 if there is none. `modes`
  /// has one entry per unit, `event_value` one per event function; `motion` returns the motions of all bodies and is called only if the
  /// event functions do not decide.
  [[nodiscard]] virtual int first_swallowed(const std::vector<UnitMode>& modes, const std::vector<double>& event_value,
                                            const std::function<const Motion<double>*()>& motion) const = 0;
};

} // namespace steplap

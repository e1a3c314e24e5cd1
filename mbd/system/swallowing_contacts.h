// Contacts in which one body can come to lie wholly within the other, where nothing pushes it out any more.
#pragma once

#include "mbd/system/roles.h"

#include <functional>
#include <vector>

namespace steplap {

/// A group of contacts whose law has an end: no motion may be shown that goes on beyond it.
class SwallowingContacts {
public:
  virtual ~SwallowingContacts() = default;
  /// Index in System::units of the first closed contact in which one body lies wholly within the other; −1: none. `modes`: of all
  /// units; `watch`: all watch values; `motion`: of all bodies, found where a watch value does not tell already.
  [[nodiscard]] virtual int first_swallowed(const std::vector<UnitMode>& modes, const std::vector<double>& watch,
                                            const std::function<const Motion<double>*()>& motion) const = 0;
};

} // namespace steplap

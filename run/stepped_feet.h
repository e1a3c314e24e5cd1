// Contacts that share one friction, but touch on lines at different heights: friction acts at one of them, with a lever that is
// wrong for the others.
#pragma once

#include "run/finding.h"
#include "run/loaded_model.h"

namespace steplap {

/// One for each coulomb_stick of such contacts.
[[nodiscard]] std::vector<Finding> stepped_feet(const LoadedModel& loaded);

} // namespace steplap

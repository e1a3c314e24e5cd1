// Tells whether anything moved in a run. Where nothing did, errors have no range to be measured by.
#pragma once

#include "run/run.h"

namespace steplap {

/// Nothing moved in the run but by rounding.
[[nodiscard]] bool is_at_rest(const Run& run);

} // namespace steplap

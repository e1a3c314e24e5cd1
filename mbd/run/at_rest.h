// Decides whether anything moved in a run. In a run at rest no channel has a range to which an error could be related.
#pragma once

#include "mbd/run/run.h"

namespace steplap {

/// Returns true if nothing moved in the run, apart from rounding.
[[nodiscard]] bool is_at_rest(const Run& run);

} // namespace steplap

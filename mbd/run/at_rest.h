// Tells whether anything moved in a run. In a run at rest errors cannot be related to the range of a channel.
#pragma once

#include "mbd/run/run.h"

namespace steplap {

/// Returns true if nothing moved in the run, apart from rounding.
[[nodiscard]] bool is_at_rest(const Run& run);

} // namespace steplap

// Signal kind `record`: a measured history from a CSV file (csv.h), linear between its rows. The value is scale · column in the unit given
// by `unit` (default SI). Before its first row the signal is 0. After its last row it is 0 (`after = "zero"`) or constant (`after =
// "hold"`), so a record may be shorter than the run.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

[[nodiscard]] const SignalKind& record_signal_kind();

} // namespace steplap

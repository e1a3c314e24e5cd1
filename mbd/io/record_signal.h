// The signal kind `record`: a measured history from a CSV file (csv.h), linear between its rows.
//
// Before its first row the signal is 0. After its last it is 0 (`after = "zero"`) or keeps the last
// value (`after = "hold"`), so a record may be shorter than the run. The value read is
// scale · column, in the unit that `unit` names (SI if none).
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

[[nodiscard]] const SignalKind& record_signal_kind();

} // namespace steplap

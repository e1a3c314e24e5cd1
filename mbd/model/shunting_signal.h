// Acceleration of a wagon during a buffer-to-buffer impact with another wagon.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

/// "shunting": impact of two wagons with given masses, speeds and force–travel curves of their buffers.
[[nodiscard]] const SignalKind& shunting_kind();

} // namespace steplap

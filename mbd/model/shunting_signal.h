// The acceleration that a wagon gets when another one meets it buffer to buffer.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

/// "shunting": two wagons of given masses and speeds, and the force–travel curves of their buffers.
[[nodiscard]] const SignalKind& shunting_kind();

} // namespace steplap

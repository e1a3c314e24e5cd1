// The kinds of signal that are made of others: sum, product, scaled.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

/// "sum": its parts added.
[[nodiscard]] const SignalKind& sum_kind();
/// "product": its parts multiplied.
[[nodiscard]] const SignalKind& product_kind();
/// "scaled": one signal times a factor, later by a delay.
[[nodiscard]] const SignalKind& scaled_kind();

} // namespace steplap

// The kinds of signal that are made of others: sum, product, scaled.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

[[nodiscard]] const SignalKind& sum_kind();
[[nodiscard]] const SignalKind& product_kind();
[[nodiscard]] const SignalKind& scaled_kind();

} // namespace steplap

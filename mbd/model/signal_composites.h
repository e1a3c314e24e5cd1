// Kinds of signal that combine others: sum, product, scaled.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// "sum": sum of other signals.
[[nodiscard]] const SignalKind& sum_kind();
/// Returns the names of the signals that a sum adds with a nonzero factor, or nothing if the signal is not a sum.
[[nodiscard]] std::optional<std::vector<std::string>> summands_of(const SignalEntry& entry);
/// "product": product of other signals.
[[nodiscard]] const SignalKind& product_kind();
/// "scaled": another signal times a factor, delayed.
[[nodiscard]] const SignalKind& scaled_kind();

} // namespace steplap

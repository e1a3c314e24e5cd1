// The kinds of signal that are made of others: sum, product, scaled.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// "sum": its parts added.
[[nodiscard]] const SignalKind& sum_kind();
/// Names of the signals that a sum adds with a factor other than 0, or nothing if the signal is no sum.
[[nodiscard]] std::optional<std::vector<std::string>> summands_of(const SignalEntry& entry);
/// "product": its parts multiplied.
[[nodiscard]] const SignalKind& product_kind();
/// "scaled": one signal times a factor, later by a delay.
[[nodiscard]] const SignalKind& scaled_kind();

} // namespace steplap

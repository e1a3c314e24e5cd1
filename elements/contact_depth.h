// Largest penetration for which a contact law is meaningful. Beyond it one part has passed through the other.
#pragma once

#include "mbd/model/model.h"

#include <optional>

namespace steplap {

/// Returns this penetration, m: half the width of the thinner outline (for a half-plane the whole width of the other); for circles the
/// penetration at which the direction between them is lost. Nothing for elements that are not contacts or have no thickness.
[[nodiscard]] std::optional<double> largest_depth(const Element& element, const Model& model);

} // namespace steplap

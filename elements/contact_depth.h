// How deep a contact may be pressed before its law has lost its meaning: by then something has gone through something.
#pragma once

#include "mbd/model/model.h"

#include <optional>

namespace steplap {

/// Of outlines half the width of the thinner one (of a half-plane the other's whole width), of round things the depth at
/// which the direction between them is lost. Nothing for elements that are no contacts, or have no thickness.
[[nodiscard]] std::optional<double> largest_depth(const Element& element, const Model& model);

} // namespace steplap

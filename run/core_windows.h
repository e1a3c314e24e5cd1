// The windows of a core: what stays open between neighbouring limbs and the yokes.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

/// Between neighbouring limbs of all [[core]] tables of the active part, as rings in the body's axes about its centre of
/// gravity. Only windows that the body's outline covers: an outline that leaves them open has none, and a body without
/// cores has none. A limb that is no body of its own is not known here.
/// Precondition: the model is valid.
[[nodiscard]] std::vector<std::vector<Vec2>> core_windows(const Body& active_part, const Model& model);

} // namespace steplap

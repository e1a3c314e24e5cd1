// Computes the windows of a core: the openings between neighbouring limbs and the yokes.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

/// Returns the windows between neighbouring limbs of all [[core]] tables of the active part, as closed polygons in the body's axes about
/// its centre of gravity, m. Windows that are open in the body's outline already are omitted; a body without cores has none. Limbs that are
/// not separate bodies are not considered. Precondition: the model is valid.
[[nodiscard]] std::vector<std::vector<Vec2>> core_windows(const Body& active_part, const Model& model);

} // namespace steplap

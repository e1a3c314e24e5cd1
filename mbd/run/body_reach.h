// Estimates the sizes of bodies from their outlines, their markers and the radii of the elements on them.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

/// Returns for each body of the model, in m, the largest distance from its centre of gravity to its outline, to its markers and to circles
/// of elements around these markers; 0 if the model gives only the centre of gravity.
[[nodiscard]] std::vector<double> body_reaches(const Model& model);
/// Returns the diagonal, m, of the rectangle around all bodies in their given poses, each enlarged by its value in `reaches`, and all
/// markers of the ground.
[[nodiscard]] double scene_extent(const Model& model, const std::vector<double>& reaches);

} // namespace steplap

// Sizes of bodies by what a model says of them: outlines, markers, radii of elements that touch them.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

/// Per body of the model, m: the largest distance of its outline, of its markers, and of rims round these, from its centre of gravity.
/// 0: the model says nothing but the centre.
[[nodiscard]] std::vector<double> body_reaches(const Model& model);
/// The diagonal of the rectangle that holds all bodies in the pose given, as far as `reaches` goes, and all markers of the ground, m.
[[nodiscard]] double scene_extent(const Model& model, const std::vector<double>& reaches);

} // namespace steplap

// Points at which one outline supports another, or a half-plane supports an outline.
#pragma once

#include "mbd/system/contact_description.h"

#include <vector>

namespace steplap {

/// Returns the ends of the common length of the supporting face and the outline that it carries: two points, or one if a corner touches.
/// The supporting face, of either outline, is the one that the other outline penetrates least. Corners are in ground axes, m,
/// counter-clockwise. Without `b`, b is the half-plane behind the line through `origin` with the unit normal `up`. Forces act on a along
/// the normals. Empty if `a` is empty.
[[nodiscard]] std::vector<ContactPoint> support_points(const std::vector<Vec2>& a, const std::vector<Vec2>& b, const Vec2& origin,
                                                       const Vec2& up);

} // namespace steplap

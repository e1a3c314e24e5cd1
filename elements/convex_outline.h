// Outlines as a model gives them, made ready for contact: turned counter-clockwise, corners in a straight line left out.
#pragma once

#include "elements/outline_overlap.h"

#include <stdexcept>
#include <string>

namespace steplap {

class SystemBuilder;
struct CompiledMarker;

/// Says what is wrong with an outline, in words that follow its name.
struct OutlineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// `points` in the axes of `frame`, either sense. Throws OutlineError if they are not the corners of a convex polygon.
[[nodiscard]] ConvexOutline convex_outline(const std::vector<Vec2>& points, const CompiledMarker& frame);

/// What lies behind the line through the frame's origin; `normal` in its axes, away from it.
[[nodiscard]] ConvexOutline half_plane(const Vec2& normal, const CompiledMarker& frame);

/// The least distance of two parallel lines that have the outline between them; of a half-plane infinite.
[[nodiscard]] double width_of(const ConvexOutline& outline);
/// The largest distance of a corner from the body's centre of gravity.
[[nodiscard]] double reach_of(const ConvexOutline& outline);

/// Name of the body that a marker, or a body, belongs to.
[[nodiscard]] std::string body_of(const std::string& marker, const SystemBuilder& builder);
/// Corners that the model gives this body, in the body's axes; empty if none.
[[nodiscard]] const std::vector<Vec2>& outline_of_body(const std::string& body, const SystemBuilder& builder);

} // namespace steplap

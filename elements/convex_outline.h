// Prepares the outlines of a model for contact: counter-clockwise, without corners on straight edges.
#pragma once

#include "elements/outline_overlap.h"

#include <stdexcept>
#include <string>

namespace steplap {

class SystemBuilder;
struct CompiledMarker;

/// Error in an outline. The message is the rest of a sentence that begins with the name of the outline.
struct OutlineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the outline with corners `points`, in either order, in the axes of `frame`. Throws OutlineError if they do not form a convex
/// polygon.
[[nodiscard]] ConvexOutline convex_outline(const std::vector<Vec2>& points, const CompiledMarker& frame);

/// Returns the half-plane behind the line through the origin of `frame`; `normal`, in its axes, points away from it.
[[nodiscard]] ConvexOutline half_plane(const Vec2& normal, const CompiledMarker& frame);

/// Returns the smallest distance of two parallel lines that enclose the outline, m; infinite for a half-plane.
[[nodiscard]] double width_of(const ConvexOutline& outline);
/// Returns the largest distance of a corner from the body's centre of gravity, m.
[[nodiscard]] double reach_of(const ConvexOutline& outline);

/// Returns the name of the body of a marker, or of the body itself.
[[nodiscard]] std::string body_of(const std::string& marker, const SystemBuilder& builder);
/// Returns the corners that the model gives this body, in its axes; empty if none.
[[nodiscard]] const std::vector<Vec2>& outline_of_body(const std::string& body, const SystemBuilder& builder);

} // namespace steplap

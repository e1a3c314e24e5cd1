// Describes the geometry of a model for drawings and animations: bodies with outlines, elements with the points at which they act, sheets
// of step-lap joints, and the figures that the model requests.
#pragma once

#include "mbd/io/atomic_file.h"
#include "mbd/model/model.h"
#include "mbd/run/kind_views.h"

#include <string>

namespace steplap {

/// Writes a JSON text, piece by piece. All values are SI, and all points are in the axes of their body about its centre of gravity:
///
///   bodies    name, label, pose [x, y, θ] in the reference pose, fixed, outline [[x, y], …],
///             is_outline_given; circles [x, y, radius, 1 if open inside], segments [x, y, x, y, thickness]
///             and polygons defined by elements; holes: windows of a core that the outline would cover;
///             the ground is not listed
///   ground    circles, segments, polygons fixed to the ground
///   planes    body, point, normal: half-planes of contacts, solid on the side opposite to the normal; ends:
///             coordinates of the ends, m from the point along the normal turned clockwise
///   elements  name, kind, symbol (type of the first shape, or "hidden"), at [{body, point}],
///             shapes [{type, style, quantity, at, direction, sizes, plane}] as in symbols.h,
///             contacts (names, for friction), limb and active_part (for step-lap joints)
///   sheets    joint, limb, active_part, count, yoke, limb_sheet: outlines in their bodies,
///             yoke_holes, limb_holes: one polygon for each hole, also for round ones
///   cores     name, svg: drawing of each [[core]]
///   plots     name, title, channels, bounds (patterns)
///   seen_from body to which the view is fixed, "" = chosen by the viewer
///
/// A body without a given outline gets the convex hull of its centre of gravity and of the points of elements that none of its circles
/// covers; it has no outline if there is no such point. No size is derived from masses or inertias. Precondition: the model is valid.
void write_drawing(const Model& model, const KindViews& views, const FileSink& put);
/// Returns the text of write_drawing().
[[nodiscard]] std::string drawing_json(const Model& model, const KindViews& views);

} // namespace steplap

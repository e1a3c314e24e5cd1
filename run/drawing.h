// What a machine looks like, for whoever draws its runs: bodies with outlines, elements with the places
// they act at, the sheets of step-lap joints, the figures that the model asks for.
#pragma once

#include "mbd/model/model.h"

#include <string>

namespace steplap {

/// JSON text, all in SI and all places in their body's axes about its centre of gravity:
///   bodies    name, label, pose [x, y, θ] in the reference pose, fixed, outline [[x, y], …],
///             is_outline_given; circles [x, y, radius, 1 if an open ring], segments [x, y, x, y, thickness]
///             and polygons that elements give it; holes: windows of a core that its outline would cover;
///             the ground is none of them
///   ground    circles, segments, polygons fixed in it
///   planes    body, point, normal: half-planes that contacts press on, solid on the other side of the normal; ends:
///             where one ends on either side, m from the point along the normal turned clockwise
///   elements  name, kind, symbol (of its first shape; "hidden": it has none), at [{body, point}],
///             shapes [{type, style, quantity, at, direction, sizes, plane}] as in symbols.h,
///             contacts (names, of friction), limb and active_part (of step-lap joints)
///   sheets    joint, limb, active_part, count, yoke, limb_sheet: outlines in their bodies,
///             yoke_holes, limb_holes: rings of every hole, round ones as polygons
///   cores     name, svg: each [[core]] as core_drawing.h draws it
///   plots     name, title, channels, bounds (patterns)
///   seen_from body that the drawing stands still with, "" = to be chosen
/// A body without an outline gets one: the hull of its centre of gravity and of the places where elements act on it that
/// its circles do not cover; none at all if there is no such place. No size is taken from masses or inertias.
/// Precondition: the model is valid.
[[nodiscard]] std::string drawing_json(const Model& model);

} // namespace steplap

// What a machine looks like, for whoever draws its runs: bodies with outlines, elements with the places
// they act at, the sheets of step-lap joints, the figures that the model asks for.
#pragma once

#include "mbd/model/model.h"

#include <string>

namespace steplap {

/// JSON text, all in SI and all places in their body's axes about its centre of gravity:
///   bodies    name, label, pose [x, y, θ] in the reference pose, fixed, outline [[x, y], …],
///             is_outline_given; the ground is none of them
///   elements  name, kind, symbol, at [{body, point}], direction (in the axes of the last place's
///             body), contacts (names, of friction), limb and active_part (of step-lap joints)
///   sheets    joint, limb, active_part, count, yoke, limb_sheet: outlines in their bodies,
///             yoke_holes, limb_holes: rings of every hole, round ones as polygons
///   cores     name, svg: each [[core]] as core_drawing.h draws it
///   plots     name, title, channels, bounds (patterns)
///   seen_from body that the drawing stands still with, "" = to be chosen
/// A body without an outline gets one: the hull of the places where elements act on it, or a square of
/// its radius of gyration. Precondition: the model is valid.
[[nodiscard]] std::string drawing_json(const Model& model);

} // namespace steplap

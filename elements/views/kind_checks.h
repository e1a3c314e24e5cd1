// Checks that element kinds add to `check` and `simulate`, each in the source of its name.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/loaded_model.h"
#include "mbd/run/start_scene.h"

namespace steplap {

/// far_joints.cpp: finds pins whose two ends lie far apart in the given poses because 'b' names the ground instead of a marker on it: the
/// pin is then at the ground's origin. Returns one finding for each, with the position that a marker for 'b' would need.
[[nodiscard]] std::vector<Finding> far_joints(const LoadedModel& loaded);

/// seams.cpp: finds common end points of two segments over which a circle rolls from one segment to the next: at this point both segments
/// press. Returns, for each pair of a circle and a body with segments, at most one finding: on the first such point.
[[nodiscard]] std::vector<Finding> doubled_corners(const LoadedModel& loaded);

/// stepped_feet.cpp: finds contacts at different heights that share one friction element. The friction force acts at one of them, so its
/// lever arm is wrong for the others. Returns one finding for each such coulomb_stick.
[[nodiscard]] std::vector<Finding> stepped_feet(const LoadedModel& loaded);

// start_checks.cpp: fields of contacts and stops that contradict the poses at the start of a run.
/// Checks `gap`, `interference` and `preload` of a unilateral contact against the poses, and whether its foot begins outside its face.
void check_foot(StartScene& scene, const ContactAtStart& contact);
/// Checks whether the coordinate of a limit begins beyond one of its stops.
void check_stops(StartScene& scene, const Element& element);

} // namespace steplap

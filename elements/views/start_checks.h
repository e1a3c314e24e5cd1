// Finds fields of contacts and stops that contradict the poses at the start of a run.
#pragma once

#include "mbd/run/start_scene.h"

namespace steplap {

/// Checks `gap`, `interference` and `preload` of a unilateral contact against the poses, and whether its foot begins outside its face.
void check_foot(StartScene& scene, const ContactAtStart& contact);
/// Checks whether the coordinate of a limit begins beyond one of its stops.
void check_stops(StartScene& scene, const Element& element);

} // namespace steplap

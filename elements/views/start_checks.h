// Finds fields of contacts and stops that contradict the poses at the start of a run.
#pragma once

#include "mbd/run/start_scene.h"

namespace steplap {

/// Checks `gap`, `interference` and `preload` of unilateral contacts against the poses, and whether a foot begins beside its face.
void check_feet(StartScene& scene);
/// Checks whether a coordinate begins beyond one of its stops.
void check_stops(StartScene& scene);

} // namespace steplap

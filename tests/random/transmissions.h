// Belts, bands, cams, one-way clutches, gears with losses and parts of beams, beside whatever else a random scene has.
#pragma once

#include "tests/random/scene_writer.h"

namespace steplap::random {

/// One of them, with bodies of its own, far from all others.
void add_transmission(SceneWriter& w, RandomNumber own);

} // namespace steplap::random

// Overlaps of the two sheets of a lap, with a cache: a study builds the same core for each sample, with other pressures and friction.
#pragma once

#include "transformer/core/core_geometry.h"

namespace steplap {

/// Computes area, centroid and vertices of the overlap of lap.yoke and lap.limb; nothing for sheets with fewer than three corners. Results
/// are cached per thread by the bits of the coordinates. Throws PolygonError as make_outline() does.
void find_overlap(Lap& lap);

} // namespace steplap

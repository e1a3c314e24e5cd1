// Where the two sheets of a lap overlap. A study builds the same core for each of its samples, with other pressures and other
// friction: overlaps of sheets that were asked for lately are known.
#pragma once

#include "transformer/core/core_geometry.h"

namespace steplap {

/// Area, middle and vertices of where lap.yoke and lap.limb overlap; none of sheets of fewer than three corners. What each thread has
/// found is found again by the bits of the sheets' coordinates. Throws PolygonError as make_outline() does.
void find_overlap(Lap& lap);

} // namespace steplap

#include "mbd/integrators/lane_try_of.h"

namespace steplap {

unsigned try_in_four_lanes(const LaneTryData& data) { return LaneTryOf<4>::run(data); }

} // namespace steplap

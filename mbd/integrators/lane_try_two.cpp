#include "mbd/integrators/lane_try_of.h"

namespace steplap {

unsigned try_in_two_lanes(const LaneTryData& data) { return LaneTryOf<2>::run(data); }

} // namespace steplap

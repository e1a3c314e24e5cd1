#include "mbd/integrators/lane_try_of.h"

namespace steplap {

unsigned try_in_eight_lanes(const LaneTryData& data) { return LaneTryOf<8>::run(data); }

} // namespace steplap

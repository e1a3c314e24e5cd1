// Built without machine code: nothing makes tries in lanes, and nobody asks for one (LaneColumns).
#include "mbd/integrators/lane_try_data.h"

namespace steplap {

unsigned try_in_two_lanes(const LaneTryData&) { return 0; }
unsigned try_in_four_lanes(const LaneTryData&) { return 0; }
unsigned try_in_eight_lanes(const LaneTryData&) { return 0; }

} // namespace steplap

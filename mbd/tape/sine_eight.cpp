#include "mbd/tape/sine_lanes.h"
#include "mbd/tape/sine_lanes_of.h"

namespace steplap {

void sin_cos_of_eight(const double* x, double* sines, double* cosines) { sin_cos_of<8>(x, sines, cosines); }

} // namespace steplap

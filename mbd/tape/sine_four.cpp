#include "mbd/tape/sine_lanes.h"
#include "mbd/tape/sine_lanes_of.h"

namespace steplap {

void sin_cos_of_four(const double* x, double* sines, double* cosines) { sin_cos_of<4>(x, sines, cosines); }

} // namespace steplap

#include "mbd/tape/sine_lanes.h"
#include "mbd/tape/sine_lanes_of.h"

namespace steplap {

void sin_cos_of_two(const double* x, double* sines, double* cosines) { sin_cos_of<2>(x, sines, cosines); }

} // namespace steplap

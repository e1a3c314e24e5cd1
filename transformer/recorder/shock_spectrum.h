// Shock response spectrum: the greatest absolute acceleration of an oscillator on a base that moves as recorded, over its natural frequency.
//
// Smallwood's ramp-invariant recursive filter (Shock and Vibration Bulletin 51, 1981): exact for a base acceleration that is straight
// between samples. The greatest value is looked for at the samples, so frequencies end at a tenth of the rate, where a peak between
// two samples is missed by 5 % at most. After the last sample the base is at rest for one period.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace steplap {

struct ShockPoint {
  double frequency = 0.0;    ///< Hz
  double acceleration = 0.0; ///< greatest size, in the unit of the samples
};

/// Greatest size of the absolute acceleration of one oscillator. `quality` Q = 1/(2ζ); infinity: undamped.
[[nodiscard]] double shock_response(std::span<const double> samples, double rate, double frequency, double quality);
/// From the lowest frequency that the length of the samples resolves (1 Hz at least) to a tenth of the rate, twelve to an octave.
[[nodiscard]] std::vector<ShockPoint> shock_spectrum(std::span<const double> samples, double rate, double quality = 10.0);

} // namespace steplap

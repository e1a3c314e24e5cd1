// Computes the shock response spectrum: the largest absolute acceleration of an oscillator on a moving base as a function of its natural
// frequency.
//
// Uses Smallwood's ramp-invariant recursive filter (Shock and Vibration Bulletin 51, 1981), which is exact for a base acceleration that is
// linear between samples. The maximum is taken at sample times, so frequencies end at a tenth of the sampling rate, where a peak between
// two samples is underestimated by at most 5 %. After the last sample the base is at rest for one period.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace steplap {

/// A point of the spectrum.
struct ShockPoint {
  double frequency = 0.0;    ///< natural frequency, Hz
  double acceleration = 0.0; ///< largest magnitude, in the unit of the samples
};

/// Returns the largest absolute acceleration of one oscillator, as magnitude in the unit of the samples. `rate`, `frequency`: Hz;
/// `quality`: Q = 1/(2ζ), infinite for no damping.
[[nodiscard]] double shock_response(std::span<const double> samples, double rate, double frequency, double quality);
/// Returns twelve points per octave from the lowest frequency that the duration resolves (at least 1 Hz) to a tenth of the sampling rate.
[[nodiscard]] std::vector<ShockPoint> shock_spectrum(std::span<const double> samples, double rate, double quality = 10.0);

} // namespace steplap

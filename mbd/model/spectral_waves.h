// Sums of harmonic waves with a given spectral density, for roads and random vibrations.
//
// The frequency range is divided into bands, each represented by one wave. Half the square of its amplitude is the integral of the density
// over the band; its frequency is drawn from the density within the band, its phase is uniformly distributed. Random frequencies avoid a
// common period, and the expected spectrum equals the density at every frequency. Source: M. Shinozuka, G. Deodatis, Simulation of
// stochastic processes by spectral representation, Appl. Mech. Rev. 44 (1991) 191. A seed gives the same bits on every machine
// (counter_random.h, portable_math.h).
#pragma once

#include "mbd/model/signal.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace steplap {

/// Largest ratio of the highest to the lowest frequency. A wider range needs too many waves and is refused.
inline constexpr double k_widest_band = 1e6;

/// One-sided power spectral density: linear between its points in a log-log plot, zero outside.
struct SpectralDensity {
  std::vector<double> frequencies; ///< ascending, > 0, at least two
  std::vector<double> values;      ///< > 0, signal unit squared over frequency unit
};

/// Rules for dividing a density into bands.
struct WaveRules {
  double relative_width = 0.01; ///< width of a band relative to its frequency
  double least_width = 0.0;     ///< smallest width of a band, in the unit of frequencies
  /// True: amplitudes are drawn from Rayleigh's distribution, as for a Gaussian process. False: amplitudes are the root-mean-square values
  /// of their bands.
  bool is_gaussian = false;
  std::uint64_t seed = 1;   ///< seed of all random numbers
  std::uint32_t stream = 0; ///< random stream; use a different one for each purpose of the same seed
};

/// Returns the waves in ascending order of frequency, in rad per unit: 2π times the frequencies of `density`.
[[nodiscard]] std::vector<Signal::Harmonic> waves_of(const SpectralDensity& density, const WaveRules& rules);

/// Factor of a signal: rises as ½ − ½ cos(π τ / rise) from `start` on, holds, and falls in the same way. Without `hold` it never falls.
struct Envelope {
  double start = 0.0;         ///< s
  double rise = 0.0;          ///< s
  std::optional<double> hold; ///< s
  double fall = 0.0;          ///< s, after `hold`
};

/// Returns Σ waves · envelope, with phases counted from the start of the envelope. The result consists of harmonics, so its derivatives and
/// integrals are closed forms.
[[nodiscard]] Signal enveloped(const std::vector<Signal::Harmonic>& waves, const Envelope& envelope);

} // namespace steplap

// Waves that have a given spectral density: what roads and random vibrations are made of.
//
// The density's range is cut into bands. One wave stands for each: its power, half of the square of its amplitude, is the
// integral of the density over the band, its frequency is drawn within the band as the density is distributed there, its phase is
// uniform. So no two waves have a common period, and the expected spectrum is the density itself, at every frequency.
// Source: M. Shinozuka, G. Deodatis, Simulation of stochastic processes by spectral representation, Appl. Mech. Rev. 44 (1991)
// 191. Numbers are drawn by counter and found by functions of mbd/base: a seed gives the same bits everywhere.
#pragma once

#include "mbd/model/signal.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace steplap {

/// Largest frequency over the smallest one: kinds refuse more, for which there would be too many waves.
inline constexpr double k_widest_band = 1e6;

/// One-sided density over frequency, straight between its points where both axes are logarithmic, zero outside of them.
struct SpectralDensity {
  std::vector<double> frequencies; ///< ascending, > 0, at least two
  std::vector<double> values;      ///< > 0, of the signal's unit squared over that of frequencies
};

/// How a density is cut into waves.
struct WaveRules {
  double relative_width = 0.01; ///< of a band, of its frequency
  double least_width = 0.0;     ///< of a band, in the unit of frequencies
  /// Amplitudes as they are drawn from Rayleigh's distribution, as a Gaussian process has them; else each is the root of its mean
  /// square.
  bool is_gaussian = false;
  std::uint64_t seed = 1;   ///< of all that is drawn
  std::uint32_t stream = 0; ///< tells apart what one seed is used for
};

/// In ascending order; frequencies are in rad for one cycle: 2π times those of `density`.
[[nodiscard]] std::vector<Signal::Harmonic> waves_of(const SpectralDensity& density, const WaveRules& rules);

/// Grows from zero within `rise` as ½ − ½ cos(π τ / rise), holds, and falls in the same way; for ever if it does not hold for a
/// time.
struct Envelope {
  double start = 0.0;         ///< s
  double rise = 0.0;          ///< s
  std::optional<double> hold; ///< s
  double fall = 0.0;          ///< s, behind `hold`
};

/// Σ waves · envelope; phases count from the envelope's start. Harmonics again, so derivatives and integrals are closed forms.
[[nodiscard]] Signal enveloped(const std::vector<Signal::Harmonic>& waves, const Envelope& envelope);

} // namespace steplap

#include "mbd/model/spectral_waves.h"

#include "mbd/base/counter_random.h"
#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_flat = 1e-5; // limit of |g ln(b/a)| below which a power series is used; truncation error below 1e-15

double log_of(double x) { return portable::log10(x) * std::numbers::ln10; }

// Density S(f) = value (f / from)^exponent between two points of the table.
struct PowerLaw {
  double from = 1.0, value = 1.0, exponent = 0.0;

  // Returns ∫ S df from a to b: S(a) a ((b/a)^g − 1)/g with g = exponent + 1.
  [[nodiscard]] double integral(double a, double b) const {
    const double g = exponent + 1.0, r = log_of(b / a), at_a = value * portable::pow(a / from, exponent);
    if (std::abs(g * r) < k_flat) return at_a * a * r * (1.0 + g * r * (0.5 + g * r / 6.0));
    return at_a * a * (portable::pow(b / a, g) - 1.0) / g;
  }
  // Returns the frequency below which the fraction u of the integral from a to b lies.
  [[nodiscard]] double quantile(double a, double b, double u) const {
    const double g = exponent + 1.0;
    if (std::abs(g * log_of(b / a)) < k_flat) return a * portable::pow(b / a, u);
    return a * portable::pow(1.0 + u * (portable::pow(b / a, g) - 1.0), 1.0 / g);
  }
};

Signal::Piece level(double start, double value) {
  Signal::Piece piece;
  piece.start = start;
  piece.c[0] = value;
  return piece;
}

// Returns the waves with their phases advanced by the time τ.
std::vector<Signal::Harmonic> later(const std::vector<Signal::Harmonic>& waves, double tau) {
  std::vector<Signal::Harmonic> result = waves;
  for (Signal::Harmonic& h : result) h.phase += h.frequency * tau;
  return result;
}

// Returns the piece (½ + ½ sign cos Ωτ) Σ A cos(ωτ + φ), Ω = π/length. The products are expanded: each wave gets two neighbours with
// frequencies ω ± Ω.
Signal::Piece ramp(double start, double length, double sign, const std::vector<Signal::Harmonic>& waves) {
  Signal::Piece piece = level(start, 0.0);
  const double turn = k_pi / length;
  for (const Signal::Harmonic& h : waves) {
    piece.harmonics.push_back({0.5 * h.amplitude, h.frequency, h.phase});
    for (const double side : {turn, -turn}) {
      const double frequency = h.frequency + side, amplitude = 0.25 * sign * h.amplitude;
      if (frequency != 0.0) piece.harmonics.push_back({amplitude, frequency, h.phase});
      else piece.c[0] += amplitude * portable::cos(h.phase);
    }
  }
  return piece;
}

} // namespace

std::vector<Signal::Harmonic> waves_of(const SpectralDensity& density, const WaveRules& rules) {
  constexpr double k_sliver = 0.5; // of a band width: a shorter remainder is added to the last band
  std::vector<Signal::Harmonic> waves;
  for (std::size_t k = 0; k + 1 < density.frequencies.size(); ++k) {
    const double begin = density.frequencies[k], end = density.frequencies[k + 1];
    const double exponent = log_of(density.values[k + 1] / density.values[k]) / log_of(end / begin);
    const PowerLaw law{begin, density.values[k], exponent};
    for (double a = begin; a < end;) {
      const double width = std::max(rules.relative_width * a, rules.least_width);
      const double b = a + (1.0 + k_sliver) * width < end ? a + width : end;
      const auto drawn = [&, index = waves.size()](std::uint32_t which) { return counter_uniform(rules.seed, rules.stream, index, which); };
      const double size = rules.is_gaussian ? std::sqrt(-2.0 * log_of(drawn(2))) : std::numbers::sqrt2;
      waves.push_back({size * std::sqrt(law.integral(a, b)), 2.0 * k_pi * law.quantile(a, b, drawn(0)), 2.0 * k_pi * drawn(1)});
      a = b;
    }
  }
  return waves;
}

Signal enveloped(const std::vector<Signal::Harmonic>& waves, const Envelope& envelope) {
  std::vector<Signal::Piece> pieces;
  double t = envelope.start;
  if (envelope.rise > 0.0) pieces.push_back(ramp(t, envelope.rise, -1.0, waves));
  t = envelope.start + envelope.rise;
  if (!envelope.hold || *envelope.hold > 0.0) {
    pieces.push_back(level(t, 0.0));
    pieces.back().harmonics = later(waves, t - envelope.start);
  }
  if (!envelope.hold) return Signal(std::move(pieces));
  t += *envelope.hold;
  if (envelope.fall > 0.0) pieces.push_back(ramp(t, envelope.fall, 1.0, later(waves, t - envelope.start)));
  pieces.push_back(level(t + envelope.fall, 0.0));
  return Signal(std::move(pieces));
}

} // namespace steplap

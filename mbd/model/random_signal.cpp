// A stationary Gaussian vibration multiplied by an envelope: Σ A_i cos(2π f_i τ + φ_i). The A_i are drawn from Rayleigh's distribution; the
// mean of A_i² is twice the integral of the power spectral density over frequency band i.
//
// The width of a band is 0.1 % of its frequency, but at least the reciprocal of the duration, because narrower bands cannot be
// distinguished within it. The resonance of a system with damping ratio ζ has the relative bandwidth 2 ζ. For ζ ≥ 0.02 it contains at least
// forty waves, so the random amplitudes add no significant scatter to its response.
#include "mbd/model/load_signals.h"
#include "mbd/model/spectral_waves.h"

#include "mbd/base/number_text.h"

#include <cmath>

namespace steplap {

namespace {

constexpr double k_band = 0.001;
constexpr std::uint32_t k_stream =
    0x72616e64; // random stream of this kind of signal, independent of those of other kinds with the same seed

struct Random : SignalDefinition {
  std::vector<double> frequencies, densities; // Hz; unit²/Hz
  double factor = 1.0;
  double start = 0.0, duration = 0.0; // s
  std::optional<double> rise, fall;   // s
  long seed = 1;
};

Signal build_random(const SignalDefinition& definition) {
  const auto& random = static_cast<const Random&>(definition);
  const auto fail = [&](const std::string& what) { throw ModelError(random.where, "random '" + random.name + "': " + what); };
  const std::vector<double>& f = random.frequencies;
  if (f.size() < 2 || f.size() != random.densities.size())
    fail("'frequencies' and 'densities' must be equally many, at least two, got " + std::to_string(f.size()) + " and " +
         std::to_string(random.densities.size()));
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (!(f[i] > (i > 0 ? f[i - 1] : 0.0)))
      fail("'frequencies' must be greater than 0 and ascend, got " + (i > 0 ? number_text(f[i - 1]) + " and then " : "") +
           number_text(f[i]));
    if (!(random.densities[i] > 0.0))
      fail("'densities' must be greater than 0, got " + number_text(random.densities[i]) + "; end the table where the vibration ends");
  }
  if (!(f.back() <= k_widest_band * f.front()))
    fail("the last of 'frequencies' is more than " + number_text(k_widest_band) + " times the first");
  constexpr double k_usual = 0.1; // default rise and fall relative to the duration
  const double rise = random.rise.value_or(k_usual * random.duration), fall = random.fall.value_or(k_usual * random.duration);
  if (rise + fall > random.duration)
    fail("'rise' and 'fall' take " + number_text(rise + fall) + " s, more than 'duration', " + number_text(random.duration) + " s");
  std::vector<Signal::Harmonic> waves = waves_of({f, random.densities}, {.relative_width = k_band,
                                                                         .least_width = 1.0 / random.duration,
                                                                         .is_gaussian = true,
                                                                         .seed = static_cast<std::uint64_t>(random.seed),
                                                                         .stream = k_stream});
  for (Signal::Harmonic& wave : waves) wave.amplitude *= random.factor;
  return enveloped(waves, {.start = random.start, .rise = rise, .hold = random.duration - rise - fall, .fall = fall});
}

} // namespace

const SignalKind& random_kind() {
  static const SignalKind kind = [] {
    SignalKind k;
    k.name = "random";
    k.doc = "Stationary Gaussian vibration by a table of its one-sided power spectral density, straight between its points on "
            "logarithmic axes. "
            "It rises, holds and falls within its duration.";
    k.holds<Random>();
    k.build = build_random;
    FieldTable& f = k.fields;
    f.add("frequencies", &Random::frequencies).in("Hz").required().doc("of the table, ascending");
    f.add("densities", &Random::densities).required().doc("at these frequencies, in the unit of factor squared per Hz");
    f.add("factor", &Random::factor).in("*").positive().doc("on the values: \"1 gravity\" where densities are in g^2/Hz");
    f.add("start", &Random::start).in("s").doc("time at which the vibration begins");
    f.add("duration", &Random::duration).in("s").positive().required().doc("of all of it, with rise and fall");
    f.add("rise", &Random::rise).in("s").not_negative().doc("until it is stationary, as half a wave; a tenth of the duration if not given");
    f.add("fall", &Random::fall).in("s").not_negative().doc("at the end; a tenth of the duration if not given");
    f.add("seed", &Random::seed).not_negative().doc("chooses the vibration");
    return k;
  }();
  return kind;
}

} // namespace steplap

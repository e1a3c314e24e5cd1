// Height of a road profile at constant speed v: z(t) = Σ A_i cos(2π n_i v τ + φ_i), where A_i² / 2 is the integral of the displacement
// spectral density Gd(n) = Gd(n0) (n/n0)^−w over wave number band i.
//
// The width of a band is 1.25 % of its wave number: 444 bands from 0.011/m to 2.83/m. A resonance with damping ratio ζ ≥ 0.02 contains at
// least three waves. Amplitudes follow the density; only phases and wave numbers within the bands are random, so that every seed has the
// roughness of its class. The profile is a function of position: another speed gives the same road, another class scales it. Neglected:
// footprint of the tyre, changes of speed.
#include "mbd/model/load_signals.h"
#include "mbd/model/spectral_waves.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"

#include <array>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_band = 0.0125;
constexpr std::uint32_t k_stream =
    0x726f6164; // random stream of this kind of signal, independent of those of other kinds with the same seed

struct Road : SignalDefinition {
  std::optional<std::string> road_class;
  std::optional<double> roughness; // m³
  double reference = 0.1;          // 1/m
  double exponent = 2.0;
  double from = 0.011, to = 2.83; // 1/m
  double speed = 0.0;             // m/s
  long seed = 1;
  double start = 0.0;   // s
  double run_in = 20.0; // m
};

const std::vector<std::string>& classes() {
  static const std::vector<std::string> letters{"A", "B", "C", "D", "E", "F", "G", "H"};
  return letters;
}

// Returns the geometric mean of Gd(n0) for an ISO 8608 class; each is four times that of the class before.
double roughness_of(const std::string& letter) {
  double value = 16e-6;
  for (const std::string& other : classes()) {
    if (other == letter) break;
    value *= 4.0;
  }
  return value;
}

Signal build_road(const SignalDefinition& definition) {
  const auto& road = static_cast<const Road&>(definition);
  const auto fail = [&](const std::string& what) { throw ModelError(road.where, "road '" + road.name + "': " + what); };
  if (road.road_class.has_value() == road.roughness.has_value())
    fail(road.roughness ? "give 'class' or 'roughness', not both" : "needs 'class', \"A\" to \"H\", or 'roughness'");
  if (!(road.from < road.to))
    fail("the band from " + number_text(road.from) + "/m to " + number_text(road.to) + "/m is empty: 'from' must be less than 'to'");
  if (!(road.to <= k_widest_band * road.from)) fail("'to' is more than " + number_text(k_widest_band) + " times 'from'");
  const double roughness = road.roughness ? *road.roughness : roughness_of(*road.road_class);
  const auto density = [&](double n) { return roughness * portable::pow(n / road.reference, -road.exponent); };
  std::vector<Signal::Harmonic> waves =
      waves_of({{road.from, road.to}, {density(road.from), density(road.to)}},
               {.relative_width = k_band, .seed = static_cast<std::uint64_t>(road.seed), .stream = k_stream});
  for (Signal::Harmonic& wave : waves) wave.frequency *= road.speed;
  return enveloped(waves, {.start = road.start, .rise = road.run_in / road.speed, .hold = {}});
}

} // namespace

const SignalKind& road_kind() {
  static const SignalKind kind = [] {
    SignalKind k;
    k.name = "road";
    k.doc = "Height of a road that is passed at a constant speed: waves of random phase with the spectral density roughness (n / "
            "reference)^-exponent "
            "over the wave number n (ISO 8608). An axle behind the first one sees it later: `scaled` with `behind`.";
    k.holds<Road>();
    k.build = build_road;
    FieldTable& f = k.fields;
    f.add("class", &Road::road_class).one_of(classes()).doc("class of ISO 8608, with the geometric mean of its roughness");
    f.add("roughness", &Road::roughness).in("m^3").positive().doc("spectral density at the reference, instead of a class");
    f.add("reference", &Road::reference).in("1/m").positive().doc("wave number at which the roughness is given");
    f.add("exponent", &Road::exponent).at_least(-10.0).at_most(10.0).doc("by which the density falls towards short waves");
    f.add("from", &Road::from).in("1/m").positive().doc("smallest wave number");
    f.add("to", &Road::to).in("1/m").positive().doc("largest wave number");
    f.add("speed", &Road::speed).in("m/s").positive().required().doc("at which the road is passed");
    f.add("seed", &Road::seed).not_negative().doc("chooses the road; the same one at every speed");
    f.add("start", &Road::start).in("s").doc("time at which the rough road begins; it is level before");
    f.add("run_in", &Road::run_in).in("m").positive().doc("length over which the roughness grows from zero");
    return k;
  }();
  return kind;
}

} // namespace steplap

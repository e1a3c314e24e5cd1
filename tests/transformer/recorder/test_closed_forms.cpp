// Spectra, filter and events against what is known in closed form.
#include "transformer/recorder/conditioner.h"
#include "transformer/recorder/dominant_frequency.h"
#include "transformer/recorder/events.h"
#include "transformer/recorder/filter.h"
#include "transformer/recorder/shock_spectrum.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

using namespace steplap;
using std::numbers::pi;

namespace {

std::vector<double> half_sine(double duration, double rate, double peak, double before, double after) {
  std::vector<double> samples;
  const auto count = static_cast<std::size_t>(std::lround((before + duration + after) * rate)) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / rate - before;
    samples.push_back(t < 0.0 || t > duration ? 0.0 : peak * std::sin(pi * t / duration));
  }
  return samples;
}

double greatest_response(double quality) {
  const double duration = 0.01, rate = 400'000.0; // 4000 samples a pulse: straight between them to 1e-7
  const std::vector<double> pulse = half_sine(duration, rate, 1.0, 0.0, 0.0);
  double greatest = 0.0;
  for (double share = 0.7; share < 0.95; share += 0.001)
    greatest = std::max(greatest, shock_response(pulse, rate, share / duration, quality));
  return greatest;
}

} // namespace

TEST_CASE("a half sine has the known maxima in its shock response spectrum") {
  // Greatest values of the closed forms over f T: 1.76846 at 0.810 undamped (the formula of the next test), 1.65163 at 0.823 for Q = 10.
  CHECK(std::abs(greatest_response(std::numeric_limits<double>::infinity()) - 1.7685) < 1e-4);
  CHECK(std::abs(greatest_response(10.0) - 1.6516) < 1e-4);
}

TEST_CASE("the undamped response to a half sine follows its closed form at every frequency") {
  // While the pulse lasts, y = (sin(πt/T) − r sin(ωt))/(1 − r²) with r = π/(ωT); its greatest value where cos(πt/T) = cos(ωt) is at t = 2πk/(ω + π/T).
  const double duration = 0.01, rate = 400'000.0;
  const std::vector<double> pulse = half_sine(duration, rate, 1.0, 0.0, 0.0);
  for (const double share : {0.6, 0.8, 1.0, 1.2, 1.4}) { // f T: the greatest value lies within the pulse, once
    const double w = 2.0 * pi * share / duration, r = pi / (w * duration), t = 2.0 * pi / (w + pi / duration);
    const double expected = (std::sin(pi * t / duration) - r * std::sin(w * t)) / (1.0 - r * r);
    CHECK(shock_response(pulse, rate, share / duration, std::numeric_limits<double>::infinity()) ==
          doctest::Approx(expected).epsilon(1e-5));
  }
}

TEST_CASE("a spectrum has twelve frequencies to an octave, up to a tenth of the rate") {
  const auto points = shock_spectrum(half_sine(0.05, 2000.0, 1.0, 0.1, 0.3), 2000.0);
  REQUIRE(points.size() > 24);
  CHECK(points[12].frequency / points[0].frequency == doctest::Approx(2.0).epsilon(1e-12));
  CHECK(points.back().frequency <= 200.0);
  CHECK(points.back().frequency > 200.0 / std::exp2(1.0 / 12.0));
}

TEST_CASE("the filter of a channel class has the gain of its definition and no phase") {
  const double rate = 2000.0, cfc = 60.0, f0 = 2.0775 * cfc;
  const ChannelFilter filter(cfc, rate);
  for (const double frequency : {5.0, 20.0, 60.0, 100.0, 150.0, 300.0}) {
    const std::size_t count = 8000;
    std::vector<double> samples(count);
    for (std::size_t i = 0; i < count; ++i) samples[i] = std::sin(2.0 * pi * frequency * static_cast<double>(i) / rate);
    filter.apply(samples);
    double in_phase = 0.0, across = 0.0; // over whole periods in the middle, where the ends have died away
    for (std::size_t i = 2000; i < 6000; ++i) {
      const double angle = 2.0 * pi * frequency * static_cast<double>(i) / rate;
      in_phase += samples[i] * std::sin(angle) / 2000.0;
      across += samples[i] * std::cos(angle) / 2000.0;
    }
    const double ratio = std::tan(pi * frequency / rate) / std::tan(pi * f0 / rate), gain = 1.0 / (1.0 + std::pow(ratio, 4));
    CAPTURE(frequency);
    CHECK(in_phase == doctest::Approx(gain).epsilon(1e-9));
    CHECK(std::abs(across) < 1e-9);
  }
  const double edge = std::tan(pi * filter.bandwidth() / rate) / std::tan(pi * f0 / rate);
  CHECK(1.0 / (1.0 + std::pow(edge, 4)) == doctest::Approx(std::sqrt(0.5)).epsilon(1e-12));
  CHECK(filter.bandwidth() == doctest::Approx(1.667 * cfc).epsilon(0.01)); // bent by the tangent where the rate is low
}

TEST_CASE("the filter leaves a constant and the mirror symmetry of a pulse as they are") {
  const ChannelFilter filter(60.0, 2000.0);
  std::vector<double> constant(500, 9.81);
  filter.apply(constant);
  for (const double value : constant) CHECK(value == doctest::Approx(9.81).epsilon(1e-12));
  std::vector<double> pulse(2001, 0.0);
  pulse[1000] = 1.0;
  filter.apply(pulse);
  for (std::size_t i = 1; i <= 200; ++i) CHECK(std::abs(pulse[1000 - i] - pulse[1000 + i]) < 1e-12);
}

namespace {

// Keeps one axis of what a Conditioner makes.
struct OneAxis : SignalSink {
  std::vector<double> plain, filtered;
  void begin(const RecordLayout&, double) override {}
  void begin_segment(std::size_t) override {}
  void put(double, const double* a, const double* b) override {
    plain.push_back(*a);
    filtered.push_back(*b);
  }
  void end_segment() override {}
};

OneAxis conditioned(const std::vector<double>& samples, double rate, const Conditioning& conditioning,
                    std::vector<std::array<double, 3>>* means = nullptr) {
  RecordLayout layout;
  layout.axes.resize(1);
  layout.time.rate = rate;
  OneAxis sink;
  Conditioner conditioner(conditioning, sink);
  conditioner.begin(layout);
  conditioner.begin_segment(1);
  for (std::size_t i = 0; i < samples.size(); ++i) conditioner.put(static_cast<double>(i) / rate, &samples[i]);
  conditioner.end_segment();
  if (means) *means = conditioner.segment_means();
  return sink;
}

} // namespace

TEST_CASE("the high-pass has the gain of a Butterworth filter run twice, no phase, and nothing of a constant; across its blocks, too") {
  const double rate = 200.0, edge = 0.5;
  Conditioning conditioning;
  conditioning.high_pass = edge;
  const std::size_t count = 150'000; // two blocks and more
  for (const double frequency : {0.1, 0.5, 2.0, 20.0}) {
    std::vector<double> samples(count);
    for (std::size_t i = 0; i < count; ++i) samples[i] = 9.81 + std::sin(2.0 * pi * frequency * static_cast<double>(i) / rate);
    const OneAxis out = conditioned(samples, rate, conditioning);
    REQUIRE(out.filtered.size() == count);
    // r: of the tangents to that of the frequency where the gain is 1/2; at `edge` the gain is 1/√2.
    const double half = edge / std::pow(1.0 / (std::sqrt(2.0) - 1.0), 0.25),
                 r = std::tan(pi * frequency / rate) / std::tan(pi * half / rate), gain = std::pow(r, 4) / (1.0 + std::pow(r, 4));
    double worst = 0.0;
    for (std::size_t i = 20'000; i < count - 20'000; ++i)
      worst = std::max(worst, std::abs(out.filtered[i] - gain * std::sin(2.0 * pi * frequency * static_cast<double>(i) / rate)));
    CAPTURE(frequency);
    CHECK(worst < 1e-9); // rounding of 1e5 steps of the filter, and its ends, which have died away to 1e-12
    if (frequency == edge) CHECK(gain == doctest::Approx(std::sqrt(0.5)).epsilon(1e-4)); // the tangents bend
  }
}

TEST_CASE("a segment less its mean ends with the velocity with which it began") {
  const double rate = 200.0;
  std::vector<double> samples = half_sine(0.1, rate, 20.0, 1.0, 3.0);
  for (double& value : samples) value += 0.02;
  std::vector<std::array<double, 3>> means;
  static_cast<void>(conditioned(samples, rate, {}, &means));
  REQUIRE(means.size() == 1);
  CHECK(means[0][0] > 0.02);
  Conditioning conditioning;
  conditioning.segment_offsets = means;
  static_cast<void>(conditioned(samples, rate, conditioning, &means));
  CHECK(std::abs(means[0][0]) < 1e-15);
}

namespace {

std::vector<ShockEvent> events_of(const std::vector<double>& samples, double rate, const EventRules& rules,
                                  const Conditioning& conditioning = {}) {
  RecordLayout layout;
  layout.axes.resize(1);
  layout.time.rate = rate;
  std::vector<ShockEvent> events;
  ShockFinder finder(rules, [&](const ShockEvent& event, const Window&) { events.push_back(event); });
  Conditioner conditioner(conditioning, finder);
  conditioner.begin(layout);
  conditioner.begin_segment(1);
  for (std::size_t i = 0; i < samples.size(); ++i) conditioner.put(static_cast<double>(i) / rate, &samples[i]);
  conditioner.end_segment();
  return events;
}

} // namespace

TEST_CASE("events have the time, peak, duration and velocity change of the pulses that made them") {
  const double rate = 2000.0, duration = 0.05, peak = 30.0;
  std::vector<double> samples = half_sine(duration, rate, peak, 1.0, 1.0);
  const std::vector<double> second = half_sine(0.1, rate, -20.0, 1.0, 1.0);
  samples.insert(samples.end(), second.begin(), second.end());
  const auto events = events_of(samples, rate, {});
  REQUIRE(events.size() == 2);
  const AxisEvent& first = events[0].axes[0];
  CHECK(first.peak == doctest::Approx(peak).epsilon(1e-9)); // a sample lies on the peak
  CHECK(first.peak_time == doctest::Approx(1.025).epsilon(1e-9));
  // Beyond a tenth of the peak from asin(0.1)/π to 1 − asin(0.1)/π of the pulse; chords of 100 samples err by (π/100)²/12.
  const double edge = std::asin(0.1) / pi;
  CHECK(first.duration == doctest::Approx(duration * (1.0 - 2.0 * edge)).epsilon(1e-4));
  CHECK(first.velocity_change == doctest::Approx(2.0 * peak * duration / pi * std::cos(pi * edge)).epsilon(1e-4));
  CHECK(events[0].begin == doctest::Approx(first.peak_time - duration * (0.5 - std::asin(9.80665 / peak) / pi) - 0.1).epsilon(1e-3));
  const AxisEvent& other = events[1].axes[0];
  CHECK(other.peak == doctest::Approx(-20.0).epsilon(1e-9));
  CHECK(other.peak_time == doctest::Approx(static_cast<double>(samples.size() - second.size()) / rate + 1.05).epsilon(1e-9));
  CHECK(other.velocity_change == doctest::Approx(-2.0 * 20.0 * 0.1 / pi * std::cos(pi * edge)).epsilon(1e-4));
}

TEST_CASE("what stays below the threshold is no event, and what follows soon is the same one") {
  const double rate = 1000.0;
  CHECK(events_of(half_sine(0.05, rate, 9.8, 0.5, 0.5), rate, {}).empty());
  std::vector<double> two = half_sine(0.05, rate, 30.0, 0.5, 0.2);
  const std::vector<double> next = half_sine(0.05, rate, 30.0, 0.0, 0.8);
  two.insert(two.end(), next.begin(), next.end());
  CHECK(events_of(two, rate, {}).size() == 1);
  EventRules rules;
  rules.merge = rules.after = 0.05;
  CHECK(events_of(two, rate, rules).size() == 2);
}

TEST_CASE("the signal drawn between the samples of uneven times keeps a straight line and makes no new peaks") {
  RecordLayout layout;
  layout.axes.resize(1);
  layout.time.rate = 100.0;
  struct Sink : SignalSink {
    void begin(const RecordLayout&, double) override {}
    void begin_segment(std::size_t) override {}
    void put(double t, const double* plain, const double*) override { times.push_back(t), values.push_back(*plain); }
    void end_segment() override {}
    std::vector<double> times, values;
  };
  for (const bool is_line : {true, false}) {
    Sink sink;
    Conditioner conditioner({}, sink);
    conditioner.begin(layout);
    conditioner.begin_segment(1);
    for (int i = 0; i < 60; ++i) {
      const double t = 0.01 * (i + 0.2 * std::sin(3.0 * i)), a = is_line ? 5.0 * t : i % 9 == 4 ? 3.0 : 0.0;
      conditioner.put(t, &a);
    }
    conditioner.end_segment();
    REQUIRE(sink.values.size() > 50);
    for (std::size_t i = 0; i < sink.values.size(); ++i) {
      if (is_line) CHECK(sink.values[i] == doctest::Approx(5.0 * sink.times[i]).epsilon(1e-9));
      else CHECK((sink.values[i] >= -1e-12 && sink.values[i] <= 3.0 + 1e-12));
    }
  }
}

TEST_CASE("a half sine has the frequency of a sine with this half period, whatever silence surrounds it") {
  const double duration = 0.05, rate = 4000.0;
  for (const auto& [before, after] : {std::pair{0.0, 0.0}, {0.1, 0.3}, {0.01, 3.0}, {2.0, 0.02}})
    for (const double peak : {30.0, -30.0}) {
      CAPTURE(before);
      // Straight between samples the crossing of the level is off by (ωh)²/8 of the level, 3e-6 of the duration; a tenth of the peak sample's own
      // error comes on top.
      CHECK(dominant_frequency(half_sine(duration, rate, peak, before, after), rate) ==
            doctest::Approx(1.0 / (2.0 * duration)).epsilon(1e-4));
    }
}

TEST_CASE("a burst has the frequency of its sine, however few its periods are") {
  const double frequency = 20.0, rate = 2000.0;
  for (int half_periods = 1; half_periods <= 16; ++half_periods) {
    std::vector<double> samples(4000, 0.0);
    const auto last = static_cast<std::size_t>(std::lround(half_periods * rate / (2.0 * frequency)));
    for (std::size_t i = 0; i <= last; ++i) samples[500 + i] = 9.81 * std::sin(2.0 * pi * frequency * static_cast<double>(i) / rate);
    CAPTURE(half_periods);
    CHECK(dominant_frequency(samples, rate) == doctest::Approx(frequency).epsilon(1e-4));
  }
}

TEST_CASE("ringing has the frequency at which it crosses zero") {
  // A damped oscillator after a blow. Only the two outer crossings are shifted by the damping, together by less than 0.01 of one of five half
  // periods.
  const double frequency = 30.0, damping = 0.05, rate = 4000.0, decay = 2.0 * pi * frequency * damping;
  std::vector<double> samples(4000, 0.0);
  for (std::size_t i = 400; i < samples.size(); ++i) {
    const double t = static_cast<double>(i - 400) / rate;
    samples[i] = 25.0 * std::exp(-decay * t) * std::sin(2.0 * pi * frequency * t);
  }
  CHECK(dominant_frequency(samples, rate) == doctest::Approx(frequency).epsilon(2e-3));
}

TEST_CASE("noise, an offset and a second, smaller shock leave the frequency of the largest pulse") {
  const double duration = 0.05, rate = 1000.0;
  std::vector<double> samples = half_sine(duration, rate, 30.0, 0.2, 1.0);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += 0.3 + 0.6 * std::sin(1e5 * static_cast<double>(i));
  for (std::size_t i = 0; i < 20; ++i) samples[800 + i] -= 12.0 * std::sin(pi * static_cast<double>(i) / 20.0);
  // The sum of noise and offset moves a crossing by up to 0.9/30 of 1/π of the duration: together 2 %.
  CHECK(dominant_frequency(samples, rate) == doctest::Approx(1.0 / (2.0 * duration)).epsilon(0.02));
  CHECK(dominant_frequency(std::vector<double>(100, 0.0), rate) == 0.0);
}

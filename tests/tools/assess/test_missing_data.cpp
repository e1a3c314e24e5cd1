// What a record does not show, or a user leaves out, never becomes "energise".
#include "driven_scene.h"

#include "tools/assess/vibration.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

const std::string k_only_models =
    "name = \"models\"\n[[criterion]]\nname = \"what the models ask\"\nquantity = \"acceptance\"\noutcome = \"inspect\"\n";
const std::string k_peak =
    "name = \"peaks\"\n[[criterion]]\nname = \"3 g\"\nquantity = \"peak\"\nat_most = \"3 gravity\"\noutcome = \"inspect\"\n";
const std::string k_slip = "name = \"slip\"\n[[criterion]]\nname = \"slip\"\nquantity = \"slip\"\noutcome = \"inspect\"\n";

double half_sine(double t, double start, double duration, double peak) {
  return t < start || t > start + duration ? 0.0 : peak * std::sin(std::numbers::pi * (t - start) / duration);
}
double shock(double t) { return half_sine(t, 0.5, 0.1, 1.2 * k_gravity); }

/// A record, a block that holds whatever comes, and criteria.
struct Case {
  explicit Case(const std::string& criteria = k_only_models, const std::string& record_text = record_csv(1000.0, 2.0, shock)) {
    options.reading.gravity = "z";
    options.sampling.samples = 0;
    options.estimating = Estimating::never;
    options.accepted = {Evidence::coverage}; // these tests are of everything else
    options.criteria = folder.file("criteria.toml");
    assess_test::write(options.criteria, criteria);
    assess_test::write(record, record_text);
    block(block_text(0.5, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 m\"\n"));
  }
  void block(const std::string& text) const { assess_test::write(model, text); }
  [[nodiscard]] Assessment made() const { return assess::assess({record}, {model}, options); }
  [[nodiscard]] Decision decision() const { return made().decision; }
  /// Open, and energise once the fault is accepted.
  void check_missing(Evidence item) {
    CAPTURE(name_of(item));
    const Assessment a = made();
    CHECK(missing(a) == std::vector<Evidence>{item});
    CHECK(a.decision == Decision::open);
    options.accepted.push_back(item);
    CHECK(decision() == Decision::energise);
  }
  // But for coverage.
  [[nodiscard]] static std::vector<Evidence> missing(const Assessment& a) {
    std::vector<Evidence> items;
    for (const MissingEvidence& each : a.missing)
      if (each.item != Evidence::coverage) items.push_back(each.item);
    return items;
  }

  Folder folder;
  std::string record = folder.file("shock.csv"), model = folder.file("block.toml");
  AssessmentOptions options;
};

// Rows of which `row` makes what it likes.
template <class Row> std::string rows(double rate, double duration, Row row, const std::string& head = "time [s],x [g],y [g],z [g]\n") {
  std::string text = head;
  for (long i = 0; i < std::lround(duration * rate); ++i) text += row(static_cast<double>(i) / rate);
  return text;
}
std::string row_of(double t, double x, double y, double z) {
  char text[96];
  std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f,%.6f\n", t, x, y, z);
  return text;
}
double noise(double t) { return 1e-4 * std::sin(1e5 * t); }

} // namespace

TEST_CASE("a record that is whole and a machine that holds: energise") { CHECK(Case().decision() == Decision::energise); }

TEST_CASE("a record that is cut, or that ends because a battery was empty, leaves the decision open") {
  const std::string whole = record_csv(1000.0, 2.0, shock);
  Case(k_only_models, whole.substr(0, whole.size() - 12)).check_missing(Evidence::cut);
  for (const char* end : {";stopped, low battery\n", "# memory full\n", "; Vbat below limit\n"})
    Case(k_only_models, whole + end).check_missing(Evidence::cut);
  CHECK(Case(k_only_models, whole + ";stopped, by button\n").decision() == Decision::energise);
}

TEST_CASE("a fall leaves the decision open, though no sample is beyond the threshold") {
  const auto falling = [](double from, double to) {
    return rows(1000.0, 2.0, [=](double t) {
      return t >= from && t < to ? row_of(t, noise(t), noise(t), noise(t)) : row_of(t, noise(t), noise(t), 1.0 - noise(t));
    });
  };
  Case(k_only_models, falling(1.2, 1.4)).check_missing(Evidence::fall);
  CHECK(Case::missing(Case(k_only_models, falling(1.2, 1.25)).made()).empty()); // 1.2 cm
}

TEST_CASE("an axis that did not measure leaves the decision open") {
  Case(k_only_models, rows(1000.0, 2.0, [](double t) { return row_of(t, shock(t) / k_gravity, 0.0, 1.0 - noise(t)); }))
      .check_missing(Evidence::dead);
}

TEST_CASE("a record of 50 Hz leaves the decision open, one of 100 Hz does not") {
  Case(k_only_models, record_csv(50.0, 2.0, shock)).check_missing(Evidence::bandwidth);
  CHECK(Case(k_only_models, record_csv(100.0, 2.0, shock)).decision() == Decision::energise);
}

TEST_CASE("a limit on every axis is open where an axis is not in the record") {
  Case some(k_peak);
  CHECK(some.decision() == Decision::energise);
  some.options.reading.read.x = "2", some.options.reading.read.z = "4";
  CHECK(some.decision() == Decision::open);
}

TEST_CASE("neither a filter nor a threshold hides a peak from a limit in g") {
  // 1.2 g with 8 g at 150 Hz on it.
  const auto ringing = [](double t) {
    return shock(t) + half_sine(t, 0.5, 0.1, 8.0 * k_gravity) * std::sin(2.0 * std::numbers::pi * 150.0 * (t - 0.5));
  };
  Case wide(k_peak, record_csv(4000.0, 2.0, ringing));
  CHECK(wide.decision() == Decision::inspect);
  wide.options.reading.frequency_class = 10.0;
  CHECK(wide.decision() == Decision::inspect);
  wide.options.reading.rules.threshold = 50.0 * k_gravity;
  CHECK(wide.decision() == Decision::inspect);
  wide.options.reading.frequency_class = 60.0; // the greatest below the threshold is an event as well
  CHECK(wide.decision() == Decision::inspect);
}

TEST_CASE("what stays below the threshold is run where it is greatest") {
  // 0.6 g for 0.1 s, which moves a block with a friction of 0.2 by 9.8 mm and more; the threshold is 1 g.
  Case quiet(k_only_models, record_csv(1000.0, 3.0, [](double t) { return half_sine(t, 1.5, 0.1, 0.6 * k_gravity); }));
  quiet.block(block_text(0.2, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 mm\"\n"));
  const Assessment a = quiet.made();
  REQUIRE(a.events.size() >= 1);
  CHECK(a.records[0].events[a.events[0].event].is_below);
  CHECK(a.decision == Decision::inspect);
  // A record in which nothing happens is run as well, and the machine holds.
  CHECK(Case(k_only_models, record_csv(1000.0, 3.0, [](double t) { return 1e-3 * std::sin(1e5 * t); })).decision() == Decision::energise);
}

// A tick of 10 ms beyond the threshold, then braking at 0.24 g for 3 s: friction of 0.2 leaves 0.04 g, which moves the block by metres. Two
// halvings of the threshold find nothing but the tick.
TEST_CASE("braking below the threshold is run, although the event beyond it changes nothing for two halvings") {
  const auto ramp = [](double t) { return std::clamp(std::min(2.0 * (t - 1.0), 2.0 * (5.0 - t)), 0.0, 1.0); };
  const auto tick_and_brake = [&](double t) { return half_sine(t, 0.5, 0.01, 1.14 * k_gravity) - 0.24 * k_gravity * ramp(t); };
  Case braking(k_only_models, record_csv(500.0, 6.0, tick_and_brake));
  const auto slides_less_than = [](const std::string& way) {
    return block_text(0.2, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"" + way + "\"\n");
  };
  braking.block(slides_less_than("30 mm"));
  const Assessment a = braking.made();
  CHECK(a.decision == Decision::inspect);
  CHECK(a.events.size() == 2);
  braking.block(slides_less_than("10 m"));
  CHECK(braking.decision() == Decision::energise);
}

TEST_CASE("an axis that drives no model is missing where it pushes for long, though another reads more than twice as much") {
  const auto record = [](double duration) {
    return rows(1000.0, 4.0, [=](double t) {
      return row_of(t, half_sine(t, 0.5, 0.1, 2.0) + noise(t), half_sine(t, 1.0, duration, 0.9) + noise(2.0 * t), 1.0 - noise(t));
    });
  };
  Case(k_only_models, record(1.0)).check_missing(Evidence::axis);
  // 0.9 g for 20 ms is 0.06 g in the mean over 0.2 s, as a recorder reads of a shock along x that sits a little askew.
  CHECK(Case(k_only_models, record(0.02)).decision() == Decision::energise);
}

// Three half sines of 0.5 g and 50 ms, apart by 50 ms, change the velocity by 3 · 2/π · 0.5 g · 50 ms in all, each by a third of it.
TEST_CASE("a change of velocity is that of pulses that follow each other") {
  const std::string limit = "name = \"change\"\n[[criterion]]\nname = \"change\"\nquantity = \"velocity_change\"\naxis = \"x\"\n"
                            "outcome = \"inspect\"\nat_most = ";
  const auto pulses = [](double t) {
    double x = 0.0;
    for (const double start : {0.5, 0.6, 0.7}) x += half_sine(t, start, 0.05, 1.2 * k_gravity);
    return x;
  };
  const double change = 3.0 * 2.0 / std::numbers::pi * 1.2 * k_gravity * 0.05;
  const std::string record = record_csv(1000.0, 2.0, pulses);
  CHECK(Case(limit + std::to_string(0.99 * change) + "\n", record).decision() == Decision::inspect); // the trapezoidal rule: 1e-4
  CHECK(Case(limit + std::to_string(1.01 * change) + "\n", record).decision() == Decision::energise);
}

TEST_CASE("a filter that decides about a peak leaves the decision open") {
  // 8 g for 2 ms, of which CFC 60 leaves less than 3 g, and CFC 120 more.
  Case filtered(k_peak, record_csv(5000.0, 2.0, [](double t) { return half_sine(t, 0.5, 0.002, 8.0 * k_gravity); }));
  filtered.options.reading.frequency_class = 60.0;
  const Assessment a = filtered.made();
  CHECK(a.decision == Decision::open);
  CHECK(Case::missing(a) == std::vector<Evidence>{Evidence::bandwidth});
  filtered.options.reading.frequency_class = 120.0;
  CHECK(filtered.decision() == Decision::inspect);
}

TEST_CASE("a record that rests for 30 ms before its shock does not begin within it") {
  const auto begins = [](double rest) {
    return record_csv(1000.0, 2.0, [=](double t) { return half_sine(t, rest, 0.1, 1.2 * k_gravity); });
  };
  CHECK(Case(k_only_models, begins(0.03)).decision() == Decision::energise);
  Case(k_only_models, begins(-0.02)).check_missing(Evidence::cut);
}

TEST_CASE("events at any number of halvings hold all that is beyond their thresholds, once, and begin and end at rest") {
  const auto x = [](double t) {
    return (0.3 + 0.25 * std::sin(0.37 * t) + (std::fmod(t, 40.0) < 0.05 ? 0.9 : 0.0)) * k_gravity * std::sin(40.0 * t);
  };
  constexpr double k_rate = 200.0, k_duration = 400.0;
  const Case many(k_only_models, record_csv(k_rate, k_duration, x));
  RecordEvents record = read_without_events(many.record, many.options.reading);
  for (int halvings = 0; halvings < 4; ++halvings) {
    CAPTURE(halvings);
    const EventRules rules = rules_at(record, "xz", halvings);
    const double threshold = rules.each->at(0);
    CHECK(threshold == doctest::Approx(k_gravity / std::exp2(halvings)));
    REQUIRE(find_events(many.options.reading, rules, 1e9, record));
    std::size_t beyond = 0, expected = 0;
    for (long i = 0; i < std::lround(k_duration * k_rate); ++i) expected += std::abs(x(static_cast<double>(i) / k_rate)) > threshold;
    for (std::size_t i = 0; i < record.events.size(); ++i) {
      const Window& window = record.events[i].window;
      if (i > 0) CHECK(record.events[i].event.begin > record.events[i - 1].event.end);
      for (std::size_t k = 0; k < window.times.size(); ++k) {
        beyond += std::abs(window.filtered[0][k]) > threshold;
        if (k < window.lead || k + window.tail >= window.times.size()) CHECK(std::abs(window.filtered[0][k]) <= rules.release * threshold);
      }
    }
    CHECK(beyond == expected);
  }
}

TEST_CASE("a recorder that sat otherwise than the model says is refused by the gravity that it reads") {
  const auto upside_down = [](double t) { return row_of(t, shock(t) / k_gravity, noise(t), -1.0 - noise(t)); };
  Case turned(k_only_models, rows(1000.0, 2.0, upside_down));
  turned.options.reading.gravity = "-z";
  CHECK_THROWS_WITH_AS(static_cast<void>(turned.made()), doctest::Contains("would read 1 g at rest if it sat as"), FileError);
  std::string model = block_text(0.5, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 m\"\n");
  model.replace(model.find("y = \"z\""), 7, "y = \"-z\"");
  turned.block(model);
  CHECK(turned.decision() == Decision::energise);
  // On its side: x reads gravity, and the model has x along the track.
  Case aside(k_only_models, rows(1000.0, 2.0, [](double t) { return row_of(t, 1.0 + noise(t), noise(t), noise(t)); }));
  aside.options.reading.gravity = "x";
  CHECK_THROWS_WITH_AS(static_cast<void>(aside.made()), doctest::Contains("correct the axes there"), FileError);
  // Gravity that the recorder took away itself shows nothing, which is said.
  Case without(k_only_models, rows(1000.0, 2.0, [](double t) { return row_of(t, shock(t) / k_gravity, noise(t), noise(t)); }));
  without.options.reading.gravity = "none";
  const Assessment a = without.made();
  CHECK(a.assumptions.front().find("could not be seen") != std::string::npos);
}

TEST_CASE("a model without a joint does not say that no joint slips") { CHECK(Case(k_slip).decision() == Decision::open); }

TEST_CASE("peaks without a waveform decide nothing about a machine, accepted or not") {
  const std::string list = "Timestamp;X Peak [g];Y Peak [g];Z Peak [g];Duration [ms]\n2016-01-04 10:25:17;1.20;0.10;1.02;50\n2016-01-04 "
                           "10:25:20;1.60;0.16;1.01;120\n";
  for (const std::string& criteria : {k_only_models, k_slip}) {
    Case peaks(criteria, list);
    peaks.options.reading.gravity.reset();
    CHECK(peaks.decision() == Decision::open);
    peaks.options.accepted.push_back(Evidence::peaks);
    CHECK(peaks.decision() == Decision::open);
  }
}

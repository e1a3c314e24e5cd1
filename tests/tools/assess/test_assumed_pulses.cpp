// Lists of peaks: pulses of an assumed shape do what such pulses do, and what a list does not tell is asked for.
#include "driven_scene.h"

#include "tools/assess/assumed_pulse.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

constexpr double k_pi = std::numbers::pi;
const std::string k_only_models =
    "name = \"models\"\n[[criterion]]\nname = \"what the models ask\"\nquantity = \"acceptance\"\noutcome = \"inspect\"\n";
const std::string k_axes_head = "Timestamp;X Peak [g];Y Peak [g];Z Peak [g];Duration [ms];Velocity change [m/s]\n";

/// A block on a driven tank, and a list of peaks.
struct Case {
  explicit Case(const std::string& list, double friction = 0.3, const std::string& within = "1 m") {
    options.reading.pulse = parse_assumed_pulse("half-sine");
    options.reading.gravity = "none";
    options.sampling.samples = 0;
    options.estimating = Estimating::never;
    options.accepted = {Evidence::peaks, Evidence::coverage};
    options.criteria = folder.file("criteria.toml");
    assess_test::write(options.criteria, k_only_models);
    assess_test::write(record, list);
    assess_test::write(model,
                       block_text(friction, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"" + within + "\"\n"));
  }
  [[nodiscard]] Assessment made() const { return assess::assess({record}, {model}, options); }

  Folder folder;
  std::string record = folder.file("peaks.csv"), model = folder.file("block.toml");
  AssessmentOptions options;
};

double slide_of(const Assessment& a, std::size_t event) { return a.events.at(event).passages.at(0).clearances.at(0).value; }

// How far a block slides on a tank that a half sine of height A (above friction mu g) and length T shakes, by integrating
// A sin(pi t/T) - mu g from where it is above zero until the block is caught, after the pulse.
double slide_under_half_sine(double height, double length, double grip) {
  const double w = k_pi / length, t1 = std::asin(grip / height) / w, rest = length - t1;
  const double v = height / w * (std::cos(w * t1) + 1.0) - grip * rest;
  REQUIRE(v > 0.0);
  return height / w * std::cos(w * t1) * rest + height / (w * w) * std::sin(w * t1) - 0.5 * grip * rest * rest + 0.5 * v * v / grip;
}

} // namespace

TEST_CASE("a half sine of peak and duration slides a block as far as the closed form says, one way and back") {
  const double peak = 6.0, length = 0.1;
  for (const double told : {peak, -peak}) { // with signs: one event, in that direction
    CAPTURE(told);
    Case list(k_axes_head + "2016-01-04 10:25:17;" + std::to_string(told / k_gravity) + ";-0.0001;0;100;\n");
    const Assessment a = list.made();
    REQUIRE(a.events.size() == 1);
    // Six digits of the list; straight lines of the pulse, 3e-5 of it; feet that give by 1e-5 m.
    CHECK(slide_of(a, 0) == doctest::Approx((told > 0 ? -1.0 : 1.0) * slide_under_half_sine(peak, length, 0.3 * 9.81)).epsilon(1e-3));
    CHECK(a.decision == Decision::energise);
  }
  // Without a sign both ways are run, one after the other.
  Case unsigned_list(k_axes_head + "2016-01-04 10:25:17;" + std::to_string(peak / k_gravity) + ";;;100;\n");
  const Assessment a = unsigned_list.made();
  REQUIRE(a.events.size() == 2);
  CHECK(std::abs(slide_of(a, 0)) == doctest::Approx(slide_under_half_sine(peak, length, 0.3 * 9.81)).epsilon(1e-3));
  REQUIRE(a.histories[0][0].x.size() == a.histories[0][1].x.size());
  for (std::size_t i = 0; i < a.histories[0][0].x.size(); ++i) CHECK(a.histories[0][0].x[i] == -a.histories[0][1].x[i]);
}

TEST_CASE("a pulse has the velocity change that its shape has, and of that change the duration follows") {
  for (const auto& [shape, area] : {std::pair{"half-sine", 2.0 / k_pi}, {"haversine", 0.5}, {"triangle", 0.5}}) {
    CAPTURE(shape);
    // Peak 2 g; the duration from a change of 1 m/s, or 40 ms as assumed.
    Case list(k_axes_head + "2016-01-04 10:25:17;-2;;;;1\n2016-01-04 10:26:17;2;;;;\n");
    list.options.reading.pulse = parse_assumed_pulse(std::string(shape) + " 40 ms");
    const Assessment a = list.made();
    REQUIRE(a.records.at(0).events.size() == 2);
    const Window &first = a.records[0].events[0].window, &second = a.records[0].events[1].window;
    CHECK(first.times.back() - first.times.front() == doctest::Approx(1.0 / (area * 2.0 * k_gravity)).epsilon(1e-12));
    CHECK(second.times.back() - second.times.front() == doctest::Approx(0.04).epsilon(1e-12));
    double change = 0.0; // trapezoids of the window: of a smooth shape they miss h^2/12 of its slopes at the ends, 1e-5
    for (std::size_t i = 1; i < first.times.size(); ++i) change += 0.5 * (first.plain[0][i - 1] + first.plain[0][i]) / first.rate;
    CHECK(change == doctest::Approx(-1.0).epsilon(1e-4));
  }
  CHECK_FALSE(parse_assumed_pulse("square").has_value());
  CHECK_FALSE(parse_assumed_pulse("half-sine 50").has_value());
  CHECK_FALSE(parse_assumed_pulse("half-sine -50 ms").has_value());
  CHECK_FALSE(parse_assumed_pulse("half-sine 50 kg").has_value());
}

TEST_CASE("what is assumed leaves the decision open unless it is accepted, and stands among the assumptions") {
  const Case slides(k_axes_head + "2016-01-04 10:25:17;1.2;;;100;\n", 0.5, "1 mm");
  CHECK(slides.made().decision == Decision::inspect); // 1.2 g on a friction of 0.5: it slides centimetres
  Case held(k_axes_head + "2016-01-04 10:25:17;1.2;;;100;\n", 1.5, "1 mm");
  CHECK(held.made().decision == Decision::energise);
  held.options.accepted.clear();
  CHECK(held.made().decision == Decision::open);
  bool is_said = false;
  for (const std::string& text : held.made().assumptions) is_said |= text.find("taken for a half-sine") != std::string::npos;
  CHECK(is_said);
  // A list of nothing but small shocks is run where it is greatest.
  Case quiet(k_axes_head + "2016-01-04 10:25:17;0.2;;;100;\n2016-01-04 10:26:17;0.4;;;100;\n2016-01-04 10:27:17;0.3;;;100;\n", 0.3);
  const Assessment a = quiet.made();
  REQUIRE(a.events.size() == 2); // both ways
  CHECK(a.records[0].events[0].is_below);
  CHECK(a.records[0].events[0].event.line == 3);
}

TEST_CASE("gravity in a list is taken away where the user says so") {
  Case list(k_axes_head + "2016-01-04 10:25:17;3;;1.5;100;\n", 5.0);
  list.options.reading.gravity = "z";
  const Assessment a = list.made();
  REQUIRE(a.events.size() == 4); // two axes, both ways each
  for (const RecordedEvent& event : a.records[0].events)
    CHECK(std::abs(event.event.axes[2].peak) == doctest::Approx(0.5 * k_gravity).epsilon(1e-9));
}

TEST_CASE("what a list does not tell is asked for") {
  const auto refusal = [](const Case& list) -> std::string {
    try {
      static_cast<void>(list.made());
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  };
  Case gravity(k_axes_head + "2016-01-04 10:25:17;3;;1.5;100;\n");
  gravity.options.reading.gravity.reset();
  CHECK(refusal(gravity).find("say that gravity is in none of them, or the axis that it is in") != std::string::npos);
  const Case duration(k_axes_head + "2016-01-04 10:25:17;3;;1.5;;\n");
  CHECK(refusal(duration).find("line 2") != std::string::npos);
  CHECK(refusal(duration).find("a pulse of \"half-sine 50 ms\"") != std::string::npos);
  Case direction("Timestamp;Max [g];Strength [m/s];Duration [ms]\n2016-01-04 10:25:17;3.12;0.970;50\n");
  CHECK(refusal(direction).find("along which axis") != std::string::npos);
  direction.options.reading.pulse->axis = 'x';
  CHECK(refusal(direction).empty());
  direction.options.reading.gravity = "z";
  CHECK(refusal(direction).find("no peaks of that axis") != std::string::npos);
  for (const char* axis : {"q", "", "-", "xy"}) {
    gravity.options.reading.gravity = axis;
    CHECK(refusal(gravity).find("no peaks of that axis") != std::string::npos);
  }
  const Case nothing(k_axes_head + "2016-01-04 10:25:17;3;;1.5;100;\n2016-01-04 10:26:17;;;;100;\n");
  CHECK(refusal(nothing).find("line 3") != std::string::npos);
  CHECK(refusal(nothing).find("has no peak:") != std::string::npos);
  const Case waves(record_csv(1000.0, 2.0, [](double) { return 0.0; }));
  CHECK(refusal(waves).find("assume none") != std::string::npos);
}

// Judged runs of scenes in which an even motion passes something within one step of its own.
#include "mbd/run/report.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace steplap;

namespace {

Report run_of(const std::string& name, const std::string& method, std::optional<double> step = std::nullopt) {
  RunOptions options;
  options.method = method;
  options.step = step;
  return judged_run(load_model(std::string(STEPLAP_TEST_DATA) + "/passings/" + name + ".toml"), options);
}

double first_event(const Report& report, const std::string& element) {
  for (const Event& event : report.run.result.events)
    if (event.element == element) return event.t;
  return std::nan("");
}

const char* const k_adaptive[] = {"auto", "dop853", "tsit5", "rodas5p"};

} // namespace

TEST_CASE("a lobe that an even cam turns under its follower lifts it, by every method") {
  for (const char* method : k_adaptive) {
    CAPTURE(method);
    const Report report = run_of("cam_lobe_90_whole_turn", method);
    CHECK(report.judgement.verdict == Verdict::reject);
    // The lobe of 10 mm reaches beyond a gap of 0.2 mm; the follower of 1 kg on 1e5 N/m goes 9.81e-3 m and what it swings by.
    CHECK(report.find("f.y")->high.value > 1.009);
  }
  CHECK(run_of("cam_lobe_beside_tyre", "auto").judgement.verdict == Verdict::reject);
}

TEST_CASE("a fixed step in which a cam turns further than a radian is divided, and a note says so") {
  const Report report = run_of("cam_lobe_90_whole_turn", "rk4", 3.0);
  const auto note =
      std::find_if(report.findings.begin(), report.findings.end(), [](const Finding& f) { return f.code == "steps_divided"; });
  REQUIRE(note != report.findings.end());
  CHECK(note->level == FindingLevel::note);
  CHECK(note->text.find("'cam' turns against the ground") != std::string::npos);
  CHECK(first_event(report, "c") > 0.0);
  const Report usual = run_of("cam_lobe_90_whole_turn", "rk4", 1e-3);
  CHECK(std::none_of(usual.findings.begin(), usual.findings.end(), [](const Finding& f) { return f.code == "steps_divided"; }));
}

TEST_CASE("a lift table that leaves out its last point comes again every turn") {
  const Report report = run_of("cam_lift_not_periodic", "auto");
  const ChannelRange& lift = *report.find("c.lift");
  CHECK(std::abs(lift.high.value - 0.02) < 1e-4); // a little beyond the point of 20 mm, as a smooth curve is
  CHECK(std::abs(lift.final - 0.0) < 1e-4);       // after two turns
}

TEST_CASE("the end of an arm touches a circle of 0.12 mm in its first turn") {
  for (const char* method : k_adaptive) {
    CAPTURE(method);
    CHECK(std::abs(first_event(run_of("spin_circle", method), "c") - 0.506704918514) < 1e-10); // by hand, twelve digits
  }
}

TEST_CASE("a condition by formula that is true for a hundredth of a millisecond ends the run") {
  for (const char* method : k_adaptive) {
    CAPTURE(method);
    const Report sensor = run_of("sensor_missed", method);
    CHECK(sensor.judgement.verdict == Verdict::reject);
    CHECK(std::abs(first_event(sensor, "q") - 0.37891086433) < 1e-10);
    const Report gauss = run_of("prox_exp", method);
    CHECK(gauss.judgement.verdict == Verdict::reject);
    CHECK(std::abs(first_event(gauss, "q") - 0.0115742188219) < 1e-11);
  }
}

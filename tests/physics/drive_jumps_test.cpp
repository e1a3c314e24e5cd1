// A drive whose place or velocity would jump is refused, whatever the signal; what is accepted keeps all joints closed
// through its breakpoints.
#include "mbd/base/number_text.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Stretched out at `angle`, where a position has to begin.
std::string arm(const std::string& signal, const std::string& level, const std::string& end, double angle = 0.0) {
  const auto at = [angle](double r) { return "[" + number_text(r * std::cos(angle)) + ", " + number_text(r * std::sin(angle)) + "]"; };
  const std::string turned = "; angle = " + number_text(angle);
  return k_no_gravity + "[simulation]\nend = " + end + "\n" + signal +
         body("upper", "mass = 2.0; inertia = 0.1; position = " + at(0.5) + turned) +
         body("fore", "mass = 1.0; inertia = 0.1; position = " + at(1.5) + turned) +
         element("revolute", "shoulder", "a = { body = 'upper', at = [0.0, 0.0] }; b = { body = 'ground', at = [0.0, 0.0] }") +
         element("revolute", "elbow", "a = { body = 'fore', at = " + at(1.0) + " }; b = { body = 'upper', at = " + at(1.0) + " }") +
         element("prescribed_motion", "drive", "a = 'upper'; coordinate = 'angle'; signal = 's'; as = '" + level + "'");
}

struct Kind {
  std::string name, fields;
  bool as_position, as_velocity; ///< accepted
  double begins = 0.0;           ///< at t = 0
};

const std::vector<Kind> k_kinds = {
    {"constant", "value = 0.3", true, true, 0.3},
    {"haversine", "peak = 0.4; start = 0.1; duration = 0.2", true, true},
    {"half_sine", "peak = 0.4; start = 0.1; duration = 0.2", false, true},
    {"triangle", "peak = 0.4; start = 0.1; duration = 0.2", false, true},
    {"trapezoid", "peak = 0.4; start = 0.1; duration = 0.2; rise = 0.05; fall = 0.05", false, true},
    {"trapezoid", "peak = 0.4; start = 0.1; duration = 0.2; rise = 0.0; fall = 0.05", false, false},
    {"rectangle", "peak = 0.4; start = 0.1; duration = 0.2", false, false},
    {"harmonics", "amplitudes = [0.2]; frequencies = [2.0]", true, true, 0.2},
    // 0.2 (1 − cos): two whole periods begin and end at rest
    {"harmonics", "offset = 0.2; amplitudes = [-0.2]; frequencies = [10.0]; start = 0.1; duration = 0.2", true, true},
    {"harmonics", "offset = 0.2; amplitudes = [-0.2]; frequencies = [10.0]; start = 0.1; duration = 0.17", false, false},
    {"harmonics", "amplitudes = [0.2]; frequencies = [10.0]; phases = [-1.5707963267948966]; start = 0.1", false, true},
    {"harmonics", "amplitudes = [0.2]; frequencies = [10.0]; start = 0.1", false, false}};

} // namespace

TEST_CASE("every kind of signal at every level: refused where a velocity would jump, else joints stay closed") {
  for (const Kind& kind : k_kinds)
    for (const std::string level : {"position", "velocity", "acceleration"}) {
      CAPTURE(kind.name);
      CAPTURE(kind.fields);
      CAPTURE(level);
      const std::string text = arm(signal_entry(kind.name, "s", kind.fields), level, "0.4", level == "position" ? kind.begins : 0.0);
      const bool is_accepted = level == "acceleration" || (level == "velocity" ? kind.as_velocity : kind.as_position);
      if (!is_accepted) {
        CHECK_THROWS_AS(static_cast<void>(compile(scene(text))), ModelError);
        continue;
      }
      for (const Settings& settings :
           {Settings{"dop853", 1e-11, 0.4, 0.005}, Settings{"rodas5p", 1e-10, 0.4, 0.005}, Settings{"auto", 1e-11, 0.4, 0.005}}) {
        CAPTURE(settings.integrator);
        const Run r = run(scene(text), settings);
        const std::vector<double> x = r.series("upper.x"), y = r.series("upper.y"), a = r.series("upper.theta"), fx = r.series("fore.x"),
                                  fy = r.series("fore.y"), b = r.series("fore.theta");
        // Projected to 1e-12 at the ends of steps; between them dense output is as good as the tolerance.
        for (std::size_t i = 0; i < x.size(); ++i) {
          CHECK(std::hypot(x[i] - 0.5 * std::cos(a[i]), y[i] - 0.5 * std::sin(a[i])) < 1e-9);
          CHECK(std::hypot(fx[i] - 0.5 * std::cos(b[i]) - std::cos(a[i]), fy[i] - 0.5 * std::sin(b[i]) - std::sin(a[i])) < 1e-9);
        }
        CHECK(r.result.statistics.energy_residual < 1e-7 * std::max(1.0, r.result.statistics.energy_exchanged));
      }
    }
}

TEST_CASE("the message says where, when and what to do") {
  const std::string kink = signal_entry("triangle", "s", "peak = 0.4; start = 0.1; duration = 0.2");
  try {
    (void)compile(scene(arm(kink, "position", "0.4")));
    FAIL("accepted");
  } catch (const ModelError& error) {
    REQUIRE(error.diagnostics().size() == 1);
    const std::string message = error.diagnostics()[0].message;
    CHECK(message.find("prescribed_motion 'drive': the rate of signal 's' jumps from 0 to 4") != std::string::npos);
    CHECK(message.find("at t = 0.1 s, so it cannot be a position") != std::string::npos);
    CHECK(message.find("as = \"velocity\"") != std::string::npos);
  }
}

TEST_CASE("a jump at or beyond the end of the run does no harm, but no run may pass it") {
  const std::string kink = signal_entry("triangle", "s", "peak = 0.4; start = 0.1; duration = 0.2");
  const Model model = scene(arm(kink, "position", "0.1"));
  const Run r = run(model, {"dop853", 1e-10, 0.1, 0.01});
  CHECK(r.last("upper.theta") == 0.0);
  CHECK(r.last("upper.omega") == 0.0);
  CHECK_THROWS_AS(run(model, {"dop853", 1e-10, 0.4, 0.01}), NumericalFailure);
}

TEST_CASE("a drive that is under way at the start takes its body and all that hangs on it along") {
  const std::string moving = signal_entry("triangle", "s", "peak = 0.4; start = 0.0; duration = 0.2");
  const Run r = run(scene(arm(moving, "position", "0.1")), {"dop853", 1e-11, 0.1, 0.005});
  CHECK(std::abs(r.series("upper.omega")[0] - 4.0) < 1e-12); // though its velocity was given as 0
  CHECK(std::abs(r.series("upper.vy")[0] - 2.0) < 1e-12);
  // The blow that sets it going passes the pin: about it the fore arm's angular momentum stays 0.
  CHECK(std::abs(0.1 * r.series("fore.omega")[0] + 0.5 * r.series("fore.vy")[0]) < 1e-12);
  CHECK(std::abs(r.series("fore.vy")[0] - 0.5 * r.series("fore.omega")[0] - 4.0) < 1e-12);
  CHECK(r.result.statistics.energy_residual < 1e-8);
}

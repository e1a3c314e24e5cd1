// What a run evaluates, and what it does not: nobody looks into most steps, and an event is evaluated once for each set of
// modes. Evaluations are counted, not timed.
#include "tests/physics/model_text.h"
#include "tests/physics/paper_runs.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace steplap;
using namespace steplap::testing;

namespace {

SimulationOptions unlooked(const std::string& integrator, double tolerance, double end) {
  SimulationOptions o = options({integrator, tolerance, end});
  o.output_step = 0.0;
  return o;
}

// dop853 evaluates eleven stages, and the end of a step that is accepted.
long of_steps(const RunStatistics& s) { return 12 * s.steps + 11 * s.rejections; }

// Before the first step: friction is let go, contacts decided, the mode problem, the start itself, and the first step's
// length, which is tried up to twelve times.
constexpr long k_of_start = 17;

} // namespace

// A dense output would take three evaluations more of each step; whoever samples asks for it.
TEST_CASE("steps that nobody looks into have no dense output") {
  const Model model = scene(k_no_gravity + body("mass", "mass = 1.0; inertia = 1.0") +
                            element("bushing", "spring", "a = 'mass'; stiffness = [100.0, 100.0]; damping = [0.1, 0.1]") +
                            signal_entry("trapezoid", "pull", "peak = 1.0; start = 0.5; duration = 2.0; rise = 0.5; fall = 0.5") +
                            element("load", "pull", "at = 'mass'; force_x = 'pull'") + "[simulation]\nstep = 1e-3\n");
  const auto system = compile(model);
  SimulationOptions o = unlooked("dop853", 1e-9, 4.0);
  const RunStatistics s = simulate(*system, system->initial_state(), o).statistics;
  // At each of the signal's corners the modes are decided, which is where the next step begins, and its length is tried.
  const long corners = 4;
  CHECK(s.steps > 40);
  CHECK(s.evaluations <= of_steps(s) + 2 * corners + k_of_start);
  o.output_step = 4.0;
  const RunStatistics looked = simulate(*system, system->initial_state(), o).statistics;
  CHECK(looked.evaluations >= of_steps(looked) + 3 * looked.steps);
}

// Columns of 17 masses on springs, beside each other, let go. At first accelerations change by less than what places above 16 m are
// rounded by makes of them, which no curve goes through: to follow that for each mass apart would take as many evaluations as there
// are columns.
TEST_CASE("the extremes of many channels take no more evaluations than those of some") {
  long evaluations[2];
  for (const int part : {0, 1}) {
    const int columns = part == 0 ? 8 : 40, height = 17;
    std::string text = "[simulation]\nstep = 1e-3\n";
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < height; ++j) {
        const auto name = [i](int at) { return "m " + std::to_string(i) + " " + std::to_string(at); };
        const std::string below = j > 0 ? "'" + name(j - 1) + "'" : "{ body = 'ground', point = [" + std::to_string(i) + ".0, 0.0] }";
        text += body(name(j), "mass = 1.0; inertia = 0.01; position = [" + std::to_string(i) + ".0, " + std::to_string(j + 1) + ".0]");
        for (const auto& [kind, axis] : {std::pair{"up ", "[0.0, 1.0]"}, {"shear ", "[1.0, 0.0]"}})
          text += element("spring_damper", kind + name(j),
                          "a = '" + name(j) + "'; b = " + below + "; axis = " + axis + "; stiffness = 1e4; damping = 1.0");
      }
    const auto system = compile(scene(text));
    SimulationOptions o = unlooked("tsit5", 1e-7, 0.05);
    o.has_extremes = true;
    const RunResult run = simulate(*system, system->initial_state(), o);
    evaluations[part] = run.statistics.evaluations;
    // All columns do the same; an extreme is found to a millionth of its range.
    const std::string top = " 16.y";
    const ChannelRange* first = nullptr;
    for (const ChannelRange& range : run.ranges) {
      if (!range.channel->name.ends_with(top)) continue;
      if (!first) first = &range;
      const double close = 2e-6 * (first->high.value - first->low.value);
      CHECK(std::abs(range.low.value - first->low.value) <= close);
      CHECK(std::abs(range.high.value - first->high.value) <= close);
    }
    REQUIRE(first != nullptr);
    CHECK(first->high.value - first->low.value > 1e-3); // it fell
  }
  CHECK(evaluations[1] <= evaluations[0] + evaluations[0] / 4);
}

// Of an event: three of the dense output, some six looks until it is known to a millionth of the tolerance, the modes before
// and behind it, a velocity set to rest, the length of the step behind it; what only touches, or has just begun, is followed
// by a dozen looks. The bound is what this takes (14.2 for each event) with a little to spare.
TEST_CASE("an event of the paper's scene takes fewer than sixteen evaluations besides those of its step") {
  for (const Condition condition : {Condition::no_interference, Condition::interference}) {
    const auto system = compile(paper_model(condition));
    const RunStatistics s = simulate(*system, system->initial_state(), unlooked("dop853", 1e-6, 0.8)).statistics;
    CAPTURE(name_of(condition));
    CAPTURE(s.evaluations);
    CHECK(s.events >= 20);
    CHECK(s.evaluations <= of_steps(s) + 16 * s.events + k_of_start);
  }
}

// Whether somebody looks into its steps changes which of them are refused, nothing else: the same events, to what the
// tolerance leaves of their times. Errors of 1e-9 in displacements and velocities grow by the blows of 0.8 s; the reference
// of this scene is met to 1e-6 of the ranges at this tolerance, and so are the times, 1e-6 of the run.
TEST_CASE("the events of a run do not hang on whether its steps are looked into") {
  for (const Condition condition : {Condition::no_interference, Condition::interference}) {
    const auto system = compile(paper_model(condition));
    SimulationOptions o = unlooked("dop853", 1e-9, 0.8);
    const RunResult plain = simulate(*system, system->initial_state(), o);
    o.output_step = 0.8;
    const RunResult looked = simulate(*system, system->initial_state(), o);
    REQUIRE(plain.events.size() == looked.events.size());
    for (std::size_t i = 0; i < plain.events.size(); ++i) {
      CAPTURE(i);
      CHECK(plain.events[i].element == looked.events[i].element);
      CHECK(plain.events[i].kind == looked.events[i].kind);
      CHECK(std::abs(plain.events[i].t - looked.events[i].t) < 0.8e-6);
    }
    for (std::size_t i = 0; i < plain.final_state.q.size(); ++i)
      CHECK(std::abs(plain.final_state.q[i] - looked.final_state.q[i]) < 1e-8); // m, rad: 1e-6 of centimetres
  }
}

// The sledge of "what nothing excites stays at rest", which a damper of 1e5/s holds across its way, meets a buffer where
// x = F (t − sin(ωt)/ω)/ω of a push F sin(ωt) is known. First steps there are up to hundreds of the damper's times long, and
// dense output is off across by up to any velocity: looked into for the event, such a step has to be withdrawn. Velocities
// are known to 6e-10 m/s at ends, in between by the documented factor of at most 300 less well; the time to 1e-11 m over the
// speed, 8 µm/s at 0.1 ms.
TEST_CASE("a step that an event is looked for in is withdrawn where its dense output is not as good as its end") {
  const double omega = 0.5 * std::numbers::pi;
  for (const char* integrator : {"dop853", "auto"})
    for (const auto& [met, across] : std::vector<std::pair<double, const char*>>{
             {1e-4, "1e-9"}, {1e-4, "1e-18"}, {1e-4, "1e-19"}, {1e-4, "1e-20"}, {3e-4, "1e-17"}, {3e-4, "1e-18"}, {1e-3, "1e-18"}}) {
      const double way = 1e3 * (met - std::sin(omega * met) / omega) / omega;
      const Model model = scene(k_no_gravity + body("sledge", "mass = 1.0; inertia = 1.0; position = [0.0, 0.0]") +
                                element("bushing", "rail", "a = 'sledge'; damping = [0.0, 1e5]") +
                                element("load", "push", "at = 'sledge'; force_x = 'along'; force_y = 'across'") +
                                signal_entry("half_sine", "along", "peak = 1e3; duration = 2.0") +
                                signal_entry("half_sine", "across", "peak = " + std::string(across) + "; duration = 2.0") +
                                element("unilateral_contact", "buffer",
                                        "a = { body = 'sledge', at = [0.0, 0.0] }; b = { body = 'ground', at = "
                                        "[0.0, 0.0] }; normal = [-1.0, 0.0]; stiffness = 1e3; gap = " +
                                            std::to_string(1e6 * way) + "e-6") +
                                "[simulation]\nstep = 1e-3\n");
      const auto system = compile(model);
      Simulation simulation(*system, system->initial_state(), unlooked(integrator, 1e-8, 0.06));
      while (simulation.events().empty() && simulation.advance()) {}
      CAPTURE(std::string(integrator));
      CAPTURE(met);
      CAPTURE(std::string(across));
      REQUIRE(simulation.events().size() == 1);
      CHECK(std::abs(simulation.events()[0].t - met) < 2e-6); // the gap is written to 1e-12 m: 1e-7 s
      CHECK(std::abs(simulation.state().v[4]) < 300 * 6e-10);
    }
}

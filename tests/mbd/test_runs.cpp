// Runs as such: the same twice, side by side on one system, and nothing of friction or contact in scenes
// that have none.
#include "mbd/dynamics/dynamics.h"
#include "tests/physics/paper_runs.h"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <stdexcept>
#include <thread>

using namespace steplap;
using namespace steplap::testing;

namespace {

bool are_identical(const RunResult& a, const RunResult& b) {
  if (a.trajectory->size() != b.trajectory->size() || a.events.size() != b.events.size()) return false;
  for (std::size_t i = 0; i < a.trajectory->size(); ++i)
    for (std::size_t k = 0; k < a.trajectory->channels().size(); ++k) {
      const double x = a.trajectory->value(i, k), y = b.trajectory->value(i, k);
      if (std::memcmp(&x, &y, sizeof x) != 0) return false;
    }
  for (std::size_t i = 0; i < a.events.size(); ++i)
    if (a.events[i].t != b.events[i].t || a.events[i].kind != b.events[i].kind || a.events[i].element != b.events[i].element) return false;
  return a.final_state.q == b.final_state.q && a.final_state.v == b.final_state.v;
}

SimulationOptions paper_options(const char* integrator) {
  return options({integrator, std::string(integrator) == "rk4" ? 2e-4 : 1e-8, 0.4, 1e-3});
}

// Bodies, joints and loads of a kind that needs neither friction nor contact.
const char* k_smooth = R"(
[simulation]
step = 1e-3
[[signal]]
name = "wave"
kind = "harmonics"
amplitudes = [3.0]
frequencies = [1.0]
[[body]]
name = "cart"
mass = 2.0
inertia = 0.5
[[body]]
name = "bob"
mass = 1.0
inertia = 0.1
position = [0.0, -1.0]
[[element]]
kind = "prismatic"
name = "rail"
a = "cart"
[[element]]
kind = "distance"
name = "rod"
a = "bob"
b = "cart"
[[element]]
kind = "spring_damper"
name = "spring"
a = "cart"
axis = [1.0, 0.0]
stiffness = 50.0
damping = 1.0
[[element]]
kind = "load"
name = "push"
at = "cart"
force_x = "wave"
)";

} // namespace

// Of a library's caller: what a model file cannot say.
TEST_CASE("a run that cannot be is refused before it begins") {
  const auto system = compile(scene(k_smooth));
  const State start = system->initial_state();
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN(), k_infinite = std::numeric_limits<double>::infinity();
  const auto is_refused = [&](const State& state, const auto& change) {
    SimulationOptions options;
    options.settings.step = 1e-3;
    change(options);
    CHECK_THROWS_AS(static_cast<void>(simulate(*system, state, options)), std::invalid_argument);
  };
  const auto as_it_is = [](SimulationOptions&) {};
  for (const double bad : {k_nan, k_infinite, -1.0}) {
    CAPTURE(bad);
    is_refused(start, [bad](SimulationOptions& o) { o.end = bad; });
    is_refused(start, [bad](SimulationOptions& o) { o.output_step = bad; });
    is_refused(start, [bad](SimulationOptions& o) { o.settings.tolerance = bad; });
    is_refused(start, [bad](SimulationOptions& o) { o.settings.step = bad; });
    is_refused(start, [bad](SimulationOptions& o) { o.settings.max_step = bad; });
    is_refused(start, [bad](SimulationOptions& o) { o.storm_step = bad; });
  }
  is_refused(start, [](SimulationOptions& o) { o.max_events = 0; });
  is_refused(State{}, as_it_is);
  for (const double bad : {k_nan, k_infinite}) {
    State state = start;
    state.q.back() = bad;
    is_refused(state, as_it_is);
    state = start;
    state.v.back() = bad;
    is_refused(state, as_it_is);
    state = start;
    state.t = bad;
    is_refused(state, as_it_is);
  }
  State longer = start;
  longer.q.push_back(0.0);
  is_refused(longer, as_it_is);
}

TEST_CASE("two runs of one model are identical to the last bit") {
  for (const Condition condition : {Condition::no_interference, Condition::interference})
    for (const char* integrator : {"rk4", "tsit5", "dop853"}) {
      const auto one = compile(paper_model(condition)), other = compile(paper_model(condition));
      const RunResult a = simulate(*one, one->initial_state(), paper_options(integrator));
      const RunResult b = simulate(*other, other->initial_state(), paper_options(integrator));
      CHECK(are_identical(a, b));
    }
}

TEST_CASE("one const system carries several runs side by side") {
  const auto system = compile(paper_model(Condition::no_interference));
  const RunResult alone = simulate(*system, system->initial_state(), paper_options("dop853"));
  // Taking turns, one step each, with different methods.
  Simulation first(*system, system->initial_state(), paper_options("dop853"));
  Simulation second(*system, system->initial_state(), paper_options("rk4"));
  while (first.advance()) second.advance();
  CHECK(are_identical(std::move(first).result(), alone));
  // In threads.
  std::vector<RunResult> results(4);
  std::vector<std::thread> threads;
  for (RunResult& result : results)
    threads.emplace_back([&] { result = simulate(*system, system->initial_state(), paper_options("dop853")); });
  for (std::thread& thread : threads) thread.join();
  for (const RunResult& result : results) CHECK(are_identical(result, alone));
}

TEST_CASE("a scene without friction and contact has nothing of that machinery, and pays for none") {
  const auto system = compile(scene(k_smooth));
  CHECK(system->units.empty());
  CHECK(system->frictions.empty());
  CHECK(system->contact_count == 0);
  CHECK(system->event_count == 0); // so that the event finder returns before it looks at anything
  const Layout layout = make_layout(*system, system->initial_state());
  CHECK(layout.sliding.empty());
  CHECK(layout.holding.empty());
  CHECK(layout.merged.empty());
  // Four evaluations a step, one of them at its end; at the start one for the modes, one to begin with.
  // An event search would cost evaluations of its own.
  SimulationOptions o = options({"rk4", 1e-3, 1.0});
  o.output_step = 0.0;
  const RunStatistics s = simulate(*system, system->initial_state(), o).statistics;
  CHECK(s.events == 0);
  CHECK(s.steps == 1000);
  CHECK(s.evaluations <= 4 * s.steps + 4);
}

TEST_CASE("the same bodies with springs only cost the plain steps") {
  // The paper's scene without contacts and friction: no event, no search, whatever moves.
  Model model = paper_model(Condition::no_interference);
  std::erase_if(model.elements, [](const ElementEntry& entry) {
    return entry.kind->name == "coulomb_stick" || entry.kind->name == "unilateral_contact" || entry.kind->name == "step_lap_joint" ||
           entry.kind->name == "step_lap_interface";
  });
  const auto system = compile(model);
  CHECK(system->event_count == 0);
  SimulationOptions o = options({"rk4", 1e-4, 0.2});
  o.output_step = 0.0;
  const RunStatistics s = simulate(*system, system->initial_state(), o).statistics;
  // A restart at each of the pulse's two breakpoints and the middle between: a few evaluations more.
  CHECK(s.evaluations <= 4 * s.steps + 16);
}

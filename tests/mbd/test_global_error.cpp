// Global error estimates against problems whose solution is known: an estimate has to be neither
// smaller than the error nor much larger.
#include "mbd/trust/accuracy_study.h"
#include "mbd/trust/event_match.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/reference_runs.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// 1 kg on 100 N/m, drawn by 0.1 m and let go: x = 0.1 cos 10 t.
const char* k_oscillator = R"(
gravity = [0, 0]
[simulation]
step = 1e-3
[[body]]
name = "mass"
mass = 1.0
inertia = 1.0
position = [0.1, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
preload = -10.0
stiffness = 100.0
)";

// The same on a belt of 0.2 m/s, μ = 0.3: sticks, slips, sticks no more
// (tests/physics/stick_slip_test.cpp).
const char* k_belt = R"(
[simulation]
step = 1e-3
[[signal]]
name = "speed"
kind = "constant"
value = 0.2
[[body]]
name = "mass"
mass = 1.0
inertia = 1.0
[[body]]
name = "belt"
mass = 5.0
inertia = 1.0
[[element]]
kind = "prismatic"
name = "rollers"
a = "belt"
[[element]]
kind = "prescribed_motion"
name = "motor"
a = "belt"
signal = "speed"
as = "velocity"
[[element]]
kind = "prismatic"
name = "guide"
a = "mass"
[[element]]
kind = "spring_damper"
name = "spring"
a = "mass"
axis = [1.0, 0.0]
stiffness = 100.0
[[element]]
kind = "unilateral_contact"
name = "sole"
a = "mass"
b = "belt"
stiffness = 1e5
preload = 9.81
[[element]]
kind = "coulomb_stick"
name = "friction"
contacts = ["sole"]
static_friction = 0.3
)";

// Slides from rest on the belt with 2.943 N: x = a (1 − cos ωt); sticks at t₁ where v = 0.2 m/s;
// slips again where the spring holds 2.943 N; from there about x = a with amplitude 0.2/ω.
double on_belt(double t) {
  const double omega = 10.0, a = 0.02943, speed = 0.2;
  const double t1 = std::asin(speed / (a * omega)) / omega, x1 = a * (1.0 - std::cos(omega * t1));
  const double t2 = t1 + (a - x1) / speed;
  if (t < t1) return a * (1.0 - std::cos(omega * t));
  if (t < t2) return x1 + speed * (t - t1);
  return a + speed / omega * std::sin(omega * (t - t2));
}

struct Honesty {
  double error = 0.0, estimate = 0.0;
};

// `exact` is mass.x; both errors relative to its range.
Honesty honesty(const std::string& text, const std::function<double(double)>& exact, const SimulationOptions& options) {
  const auto system = compile(scene(text));
  const State initial = system->initial_state();
  const RunResult run = simulate(*system, initial, options);
  const std::vector<double> x = run.trajectory->series("mass.x");
  double low = INFINITY, high = -INFINITY;
  Honesty h;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double e = exact(run.trajectory->times()[i]);
    h.error = std::max(h.error, std::abs(x[i] - e));
    low = std::min(low, e);
    high = std::max(high, e);
  }
  h.error /= high - low;
  h.estimate = estimate_global_error(*system, initial, options, run).error.of(ErrorKind::position).value;
  return h;
}

} // namespace

TEST_CASE("an estimated global error is honest where the solution is known") {
  struct Problem {
    const char* name;
    const char* text;
    double (*exact)(double);
  };
  for (const Problem& p :
       {Problem{"oscillator", k_oscillator, [](double t) { return 0.1 * std::cos(10.0 * t); }}, Problem{"belt", k_belt, on_belt}})
    for (const Settings& s :
         {Settings{"tsit5", 1e-4, 10.0, 0.05}, Settings{"tsit5", 1e-7, 10.0, 0.05}, Settings{"dop853", 1e-4, 10.0, 0.05},
          Settings{"dop853", 1e-7, 10.0, 0.05}, Settings{"rk4", 1e-2, 10.0, 0.05}, Settings{"rk4", 2e-3, 10.0, 0.05}}) {
      CAPTURE(std::string(p.name));
      CAPTURE(s.integrator);
      CAPTURE(s.step_or_tolerance);
      const Honesty h = honesty(p.text, p.exact, options(s));
      CAPTURE(h.error);
      CAPTURE(h.estimate);
      CHECK(h.error > 1e-12); // something to estimate
      // The second run's error, a hundredth of the first's, or a third of what it differs from a reference by, may have either sign.
      CHECK(h.estimate > 0.9 * h.error);
      CHECK(h.estimate < 2.5 * h.error); // half as much again is added, and a third for the reference
    }
}

TEST_CASE("runs are compared by events too: a run without the last ones misses them") {
  const auto system = compile(scene(k_belt));
  const State initial = system->initial_state();
  const RunResult whole = simulate(*system, initial, options({"dop853", 1e-10, 1.0, 0.01}));
  const RunResult part = simulate(*system, initial, options({"tsit5", 1e-10, 0.1, 0.01}));
  const RunDifference d = compare_runs(*system, part, whole);
  CHECK(whole.events.size() == 3); // slips from the start, sticks, slips
  CHECK(d.unmatched_events == 1);
  CHECK(d.compared_until == doctest::Approx(0.1));
  CHECK(d.of(ErrorKind::event_time).value < 1e-9); // that of "sticks"
}

TEST_CASE("the worst position is not that of a channel whose whole range is rounding") {
  // One swings by 0.1 m; one hangs 150 km away, a ten-billionth of a metre beside its rest: ten times what its place is rounded to.
  const auto system = compile(scene(R"(
[simulation]
step = 1e-3
[[body]]
name = "near"
mass = 1.0
inertia = 1.0
position = [0.1, 0.0]
[[body]]
name = "far"
mass = 3.0
inertia = 1.0
position = [123456.7, 89012.3000000001]
[[marker]]
name = "hook"
body = "ground"
at = [123456.7, 89013.3]
[[element]]
kind = "spring_damper"
name = "swing"
a = "near"
axis = [1.0, 0.0]
free_length = 0.0
stiffness = 400.0
[[element]]
kind = "spring_damper"
name = "hang"
a = "far"
b = "hook"
stiffness = 70000.0
free_length = 0.99957957142857145
)"));
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    SimulationOptions o = options({"dop853", tolerance, 1.0, 0.01});
    o.has_extremes = true;
    const RunResult run = simulate(*system, system->initial_state(), o);
    const GlobalErrorEstimate estimate = estimate_global_error(*system, system->initial_state(), o, run);
    CHECK(estimate.error.of(ErrorKind::position).where == "near.x");
    CHECK(estimate.error.of(ErrorKind::position).value < 1e3 * tolerance);
  }
}

TEST_CASE("reactions that diverge at a singular position have no error that is known; those that do not have one") {
  Model model = read_model(std::string(STEPLAP_MODELS) + "/benchmarks/hard/singular_parallelogram.toml", transformer_catalog());
  const auto system = compile(model);
  for (const Settings& settings :
       {Settings{"dop853", 1e-6}, Settings{"dop853", 1e-10}, Settings{"tsit5", 1e-8}, Settings{"rodas5p", 1e-8}}) {
    CAPTURE(settings.integrator);
    SimulationOptions o = options({settings.integrator, settings.step_or_tolerance, 3.0, 0.05});
    o.has_extremes = true;
    const RunResult run = simulate(*system, system->initial_state(), o);
    const GlobalErrorEstimate estimate = estimate_global_error(*system, system->initial_state(), o, run);
    for (std::size_t c = 0; c < system->channels.size(); ++c) {
      const std::string& name = system->channels[c].name;
      CAPTURE(name);
      if (name.ends_with(".force_x")) CHECK((std::isnan(estimate.channels[c].low) && std::isnan(estimate.channels[c].high)));
      // Finite, however much rounding beside the position adds to them.
      if (name.ends_with(".force_y") || name == "motor.reaction")
        CHECK((std::isfinite(estimate.channels[c].low) && std::isfinite(estimate.channels[c].high)));
    }
  }
}

TEST_CASE("a study: cheapest setting, Pareto set, slopes, failures") {
  const auto system = compile(scene(k_belt));
  const State initial = system->initial_state();
  SimulationOptions base = options({"dop853", 1e-8, 1.0, 0.01});
  AccuracyOptions study_options;
  study_options.ladder = usual_ladder(*system, {"tsit5", "dop853"}, 1e-3);
  study_options.repeats = 1;
  const AccuracyStudy study = study_accuracy(*system, initial, base, study_options);
  REQUIRE(study.entries.size() == 20);
  for (const WorstError& worst : study.resolution.worst) {
    CAPTURE(worst.where);
    CAPTURE(worst.t);
    // The sole's 1e5 N/m makes 1e-10 N of 1e-15 m of rounding, and the rollers' force hardly varies
    // otherwise.
    CHECK(worst.value < 1e-7);
  }
  const AccuracyEntry* cheapest = study.cheapest(1e-6);
  REQUIRE(cheapest != nullptr);
  CHECK(study.error_of(*cheapest) <= 1e-6);
  for (const AccuracyEntry& e : study.entries) {
    CHECK(e.failure.empty());
    if (study.error_of(e) <= 1e-6) CHECK(e.cpu_seconds >= cheapest->cpu_seconds);
  }
  CHECK(std::any_of(study.entries.begin(), study.entries.end(), [](const AccuracyEntry& e) { return e.is_pareto; }));
  CHECK(study.cheapest(1e-16) == nullptr); // no setting is better than the reference can tell

  study_options.ladder = {{"tsit5", 1e-8}};
  study_options.cpu_limit = 1e-9; // not even the reference
  CHECK_THROWS_AS((void)study_accuracy(*system, initial, base, study_options), NumericalFailure);
}

// A pencil on its tip, held by nothing: e-folding of 0.14 s magnifies rounding 1e15 times in 5 s.
TEST_CASE("where two methods do not agree nothing is said") {
  const auto system = compile(scene(R"(
[simulation]
step = 1e-3
[[body]]
name = "pencil"
mass = 1.0
inertia = 0.01
position = [0.0, 0.2]
[[element]]
kind = "revolute"
name = "tip"
a = { body = "pencil", at = [0.0, 0.0] }
[[signal]]
name = "nudge"
kind = "harmonics"
amplitudes = [1e-9]
frequencies = [0.7]
[[element]]
kind = "load"
name = "breath"
at = "pencil"
force_x = "nudge"
)"));
  AccuracyOptions study_options;
  study_options.first_reference = {"dop853", 1e-4};
  study_options.second_reference = {"tsit5", 1e-4};
  SimulationOptions base = options({"dop853", 1e-8, 20.0, 0.01});
  CHECK_THROWS_AS((void)study_accuracy(*system, system->initial_state(), base, study_options), NumericalFailure);
}

TEST_CASE("events pair so that their times differ least; what is left over has no partner") {
  const auto at = [](std::vector<double> times) {
    std::vector<Event> events;
    for (const double t : times) events.push_back({t, "foot", EventKind::opens});
    return events;
  };
  // One in the middle that the other run has not: those before and after it keep theirs.
  const std::vector<Event> mine = at({1.0, 2.0, 2.5, 3.0}), theirs = at({1.001, 2.001, 3.001});
  const EventMatch match = match_events(mine, theirs);
  REQUIRE(match.pairs.size() == 3);
  CHECK(match.pairs[2].mine == 3);
  CHECK(match.pairs[2].reference == 2);
  CHECK(match.only_mine == std::vector<std::size_t>{2});
  CHECK(match.only_reference.empty());
  const EventMatch turned = match_events(theirs, mine);
  CHECK(turned.only_reference == std::vector<std::size_t>{2});
  CHECK(match_events(mine, {}).only_mine.size() == 4);
  const BetweenEvents between(match, mine, theirs);
  CHECK(between.holds(1.0005));
  CHECK(between.holds(3.0));
  CHECK_FALSE(between.holds(2.5));
  CHECK_FALSE(between.holds(0.5));
}

TEST_CASE("finer runs are given up beyond the evaluations granted, wherever these end") {
  const auto system = compile(scene(k_belt));
  const State initial = system->initial_state();
  SimulationOptions coarse = options({"tsit5", 1e-6, 10.0, 0.05});
  coarse.has_extremes = true;
  const RunResult run = simulate(*system, initial, coarse);
  const auto needed = static_cast<double>(estimate_global_error(*system, initial, coarse, run).cost.evaluations);
  CHECK_NOTHROW((void)estimate_global_error(*system, initial, coarse, run, {}, needed));
  for (const double share : {0.0, 0.1, 0.5})
    CHECK_THROWS_AS((void)estimate_global_error(*system, initial, coarse, run, {}, share * needed), EvaluationBudgetExceeded);
}

// Below 1e-14 rounding makes the steps: there is no finer tolerance.
TEST_CASE("where no run is finer all errors are unknown but those of what never changes") {
  const auto system = compile(scene(k_oscillator));
  const State initial = system->initial_state();
  SimulationOptions finest = options({"dop853", 1e-14, 1.0, 0.1});
  finest.has_extremes = true;
  const RunResult run = simulate(*system, initial, finest);
  const GlobalErrorEstimate estimate = estimate_global_error(*system, initial, finest, run);
  CHECK_FALSE(estimate.reason_unknown.empty());
  CHECK(std::isnan(estimate.error.of(ErrorKind::position).value));
  for (std::size_t c = 0; c < run.ranges.size(); ++c) {
    if (run.ranges[c].channel->name == "mass.x") CHECK(std::isnan(estimate.channels[c].high));
    if (run.ranges[c].channel->name == "mass.y") CHECK(estimate.channels[c].high == 0.0);
  }
}

// A contact that hovers by a hair bounces for a microsecond at an instant that is chance.
TEST_CASE("a brief event is no partner of another one far away, however well their numbers fit") {
  const auto bounces = [](double first, double lasts) {
    std::vector<Event> events;
    for (const double t : {first, 0.4}) {
      events.push_back({t, "press", EventKind::closes});
      if (t < 0.4) events.push_back({t + lasts, "press", EventKind::opens});
    }
    return events;
  };
  for (double lasts = 1e-9; lasts < 1e-3; lasts *= 10.0)
    for (const double apart : {0.5, 5.0, 20.0, 100.0}) {
      CAPTURE(lasts);
      CAPTURE(apart);
      const EventMatch match = match_events(bounces(0.01, lasts), bounces(0.01 + apart * lasts, lasts));
      CHECK(match.pairs.size() == (apart < 10.0 ? 3 : 1));
      CHECK(match.only_mine.size() == match.only_reference.size());
    }
  // Several at one instant are no neighbours of each other, and one alone has none.
  const std::vector<Event> early{{0.1, "foot", EventKind::slips_forward}, {0.1, "foot", EventKind::changes_foot}};
  const std::vector<Event> late{{0.2, "foot", EventKind::slips_forward}, {0.2, "foot", EventKind::changes_foot}};
  CHECK(match_events(early, late).pairs.size() == 2);
}

// The belt at a tolerance so large that it slips and sticks where it should not (tsit5 at 1e-4 has two events too many).
TEST_CASE("an event that a finer run has not has an unknown time, not a small error") {
  const auto system = compile(scene(k_belt));
  const State initial = system->initial_state();
  SimulationOptions coarse = options({"tsit5", 1e-4, 10.0, 0.05});
  coarse.has_extremes = true;
  const RunResult run = simulate(*system, initial, coarse);
  const GlobalErrorEstimate estimate = estimate_global_error(*system, initial, coarse, run);
  REQUIRE(estimate.event_times.size() == run.events.size());
  const EventMatch match = match_events(run.events, estimate.finest.events);
  for (const std::size_t alone : match.only_mine) CHECK(std::isnan(estimate.event_times[alone]));
  for (const EventPair& pair : match.pairs) CHECK(estimate.event_times[pair.mine] < 1e-3);
  CHECK(estimate.error.unmatched_events == static_cast<int>(match.only_mine.size() + match.only_reference.size()));
  if (estimate.error.unmatched_events > 0) CHECK(std::isnan(estimate.error.of(ErrorKind::event_time).value));
}

// x = 0.1 cos 10 t sampled once a period: every sample is 0.1 m, and their range is the error itself.
TEST_CASE("an error is measured against the range of the whole run, not of samples that fall on one phase") {
  const auto system = compile(scene(k_oscillator));
  const State initial = system->initial_state();
  SimulationOptions once = options({"tsit5", 1e-5, 2.0 * M_PI, 2.0 * M_PI / 10.0});
  once.has_extremes = true;
  const RunResult run = simulate(*system, initial, once);
  const GlobalErrorEstimate estimate = estimate_global_error(*system, initial, once, run);
  double error = 0.0;
  for (const double x : run.trajectory->series("mass.x")) error = std::max(error, std::abs(x - 0.1));
  // 10 periods of 1e-5 a step and of some 20 steps each: at most 2e-3. Against the samples' range it would be above 1.
  CHECK(estimate.error.of(ErrorKind::position).value < 2e-3);
  CHECK(estimate.error.of(ErrorKind::position).value * 0.2 >= 0.9 * error);
  // Extremes: those of a conservative oscillator are 0.1 m and 1 m/s for ever.
  for (const char* name : {"mass.x", "mass.vx"})
    for (std::size_t c = 0; c < run.ranges.size(); ++c) {
      if (run.ranges[c].channel->name != name) continue;
      const double exact = name == std::string("mass.x") ? 0.1 : 1.0;
      CHECK(std::abs(run.ranges[c].high.value - exact) <= estimate.channels[c].high);
      CHECK(std::abs(run.ranges[c].low.value + exact) <= estimate.channels[c].low);
      CHECK(estimate.channels[c].high < 1e-3 * exact);
    }
}

TEST_CASE("dissipated energy has an error") {
  const auto system = compile(scene(k_belt));
  const State initial = system->initial_state();
  SimulationOptions coarse = options({"tsit5", 1e-5, 3.0, 0.05}), exact = options({"dop853", 1e-12, 3.0, 0.05});
  coarse.has_extremes = exact.has_extremes = true;
  const RunResult run = simulate(*system, initial, coarse), truth = simulate(*system, initial, exact);
  const GlobalErrorEstimate estimate = estimate_global_error(*system, initial, coarse, run);
  const double error = std::abs(run.statistics.dissipated - truth.statistics.dissipated);
  CHECK(error > 0.0);
  CHECK(error <= estimate.dissipated);
  CHECK(estimate.dissipated <= 10.0 * error + 1e-6 * run.statistics.energy_scale); // not out of all proportion
}

// x = 0.1 cos 10 t: rk4 turns 5th order terms of each step into (ωh)⁴/120 a radian, from 1e-3 to 1e-11 of the amplitude.
TEST_CASE("fixed steps are measured by a reference that is exact enough for them") {
  const auto system = compile(scene(k_oscillator));
  const State initial = system->initial_state();
  double tightest = 1.0;
  for (const double step : {5e-2, 2e-2, 5e-3, 2e-3, 5e-4, 1e-4}) {
    CAPTURE(step);
    SimulationOptions fixed = options({"rk4", step, 10.0, 0.05});
    fixed.has_extremes = true;
    const RunResult run = simulate(*system, initial, fixed);
    const GlobalErrorEstimate estimate = estimate_global_error(*system, initial, fixed, run);
    CHECK_FALSE(estimate.references.empty());
    CHECK(estimate.finer.back().integrator == "auto");
    tightest = std::min(tightest, estimate.finer.back().settings.tolerance);
    const auto c = static_cast<std::size_t>(
        std::find_if(run.ranges.begin(), run.ranges.end(), [](const ChannelRange& r) { return r.channel->name == "mass.x"; }) -
        run.ranges.begin());
    const std::vector<double> x = run.trajectory->series("mass.x");
    double error = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) error = std::max(error, std::abs(x[i] - 0.1 * std::cos(10.0 * run.trajectory->times()[i])));
    CAPTURE(error);
    CAPTURE(estimate.channels[c].curve);
    CHECK(estimate.channels[c].curve >= error);
    // 1.5 (1 + 1/3) of it, and what no run knows: a hundred times the tolerance of the reference.
    CHECK(estimate.channels[c].curve <= 2.0 * error + 100.0 * estimate.finer.back().settings.tolerance * 0.2);
  }
  CHECK(tightest < 5e-12); // for errors of 1e-11 a reference at 1e-11 is none
}

// Two rods, let go from the horizontal: neighbouring motions part tenfold about every two seconds, so that 1e-13 becomes a hundredth
// within some 25 s.
std::unique_ptr<System> chaotic() {
  return compile(read_model(std::string(STEPLAP_MODELS) + "/benchmarks/double_pendulum.toml", transformer_catalog()));
}

TEST_CASE("from where two references part errors are unknown, however well the run agrees with one of them") {
  const auto system = chaotic();
  const State initial = system->initial_state();
  const auto estimate_to = [&](double end) {
    SimulationOptions fixed = options({"rk4", 1e-3, end, 0.02});
    fixed.has_extremes = true;
    const RunResult run = simulate(*system, initial, fixed);
    return estimate_global_error(*system, initial, fixed, run);
  };
  const GlobalErrorEstimate early = estimate_to(1.0), late = estimate_to(40.0);
  CHECK(early.reason_unknown.empty());
  CHECK_FALSE(early.references.empty());
  CHECK(early.error.of(ErrorKind::position).value < 1e-6);
  CHECK(late.reason_unknown.find("part at t = ") != std::string::npos);
  CHECK(late.references.empty());
  CHECK(std::isnan(late.error.of(ErrorKind::position).value));
  for (const ChannelError& error : late.channels)
    if (error.high != 0.0) CHECK(std::isnan(error.high)); // what never changes is known all the same
}

TEST_CASE("two references are alike until they part") {
  const auto system = chaotic();
  const State initial = system->initial_state();
  SimulationOptions fine = options({"dop853", 1e-12, 30.0, 0.02}), rough = options({"dop853", 1e-8, 30.0, 0.1});
  fine.has_extremes = true;
  const RunResult a = simulate(*system, initial, rough), b = simulate(*system, initial, fine);
  double before = 0.0;
  for (const double share : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) { // a share is reached the later the larger it is
    const std::optional<double> t = parts_at(*system, a, b, 5, share);
    REQUIRE(t);
    CHECK(*t >= before);
    before = *t;
  }
  CHECK_FALSE(parts_at(*system, b, b, 1, 1e-12));
}

TEST_CASE("references that are too dear, or fail, leave the estimate to half and quarter steps") {
  const auto system = compile(scene(k_belt));
  const State initial = system->initial_state();
  SimulationOptions fixed = options({"rk4", 2e-3, 2.0, 0.05});
  fixed.has_extremes = true;
  const RunResult run = simulate(*system, initial, fixed);
  EvaluationBudget budget(1e9);
  CHECK_FALSE(reference_runs(*system, initial, fixed, run, {}, 100.0, budget));
  CHECK(budget.spent().evaluations >= 100); // what was tried counts
  CHECK(budget.spent().evaluations < 10000);
  const std::optional<ReferenceRuns> pair = reference_runs(*system, initial, fixed, run, {}, 1e9, budget);
  REQUIRE(pair);
  CHECK(pair->reference.statistics.steps > pair->coarse.statistics.steps);
  CHECK_FALSE(pair->parted_at);
  // Time stepping has no references at all.
  SimulationOptions stepped = options({"moreau", 1e-3, 1.0, 0.05});
  stepped.settings.step = 1e-3;
  stepped.has_extremes = true;
  const RunResult steps = simulate(*system, initial, stepped);
  CHECK(estimate_global_error(*system, initial, stepped, steps).finer.back().integrator == "moreau");
}

// Rows 0, 3, 6, … and the end belong together.
TEST_CASE("samples of a run that has fewer of them are compared with those at the same times") {
  const auto system = compile(scene(k_oscillator));
  const State initial = system->initial_state();
  for (const double end : {0.9, 1.0, 0.1}) { // 1.0: the end is no multiple of the longer interval
    CAPTURE(end);
    SimulationOptions often = options({"dop853", 1e-12, end, 0.1}), rarely = options({"dop853", 1e-6, end, 0.3});
    const RunResult a = simulate(*system, initial, rarely), b = simulate(*system, initial, often);
    const RowPairs rows(*a.trajectory, *b.trajectory, 3);
    CHECK(rows.size() == a.trajectory->size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      CHECK(a.trajectory->time(i) == doctest::Approx(b.trajectory->time(rows.theirs(i))).epsilon(1e-12));
    // A cosine of 10 rad/s changes by tenths from one row to the next: rows of other times would differ by that.
    CHECK(compare_runs(*system, a, b, {}, 3).of(ErrorKind::position).value < 1e-4);
  }
}

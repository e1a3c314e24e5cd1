// What the paper reports of its transformer (paper_model: behaviours 1 to 8), computed from runs.
#include "tests/physics/paper_runs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

struct Phase {
  double begin, end;
};

struct Observed {
  Run run;
  std::vector<double> t, angle, friction, normal, slide, top, bottom; ///< angle: θ1 − θ5
  std::vector<Phase> slips;

  [[nodiscard]] std::size_t index(double time) const { return static_cast<std::size_t>(std::lround(time / 1e-3)); }
};

Observed observe(Condition condition, double friction_factor = 1.0) {
  std::vector<std::string> overrides;
  if (friction_factor != 1.0) overrides.push_back("element.tank bottom.static_friction=" + std::to_string(0.35 * friction_factor));
  const Model model = read_model(std::string(STEPLAP_MODELS) + "/paper/" + name_of(condition) + ".toml", transformer_catalog(), overrides);
  Observed o;
  o.run = run(model, {"dop853", 1e-9, 0.8, 1e-3});
  o.t = o.run.times();
  o.angle = o.run.series("active part.theta");
  const std::vector<double> tank = o.run.series("lower tank.theta");
  for (std::size_t i = 0; i < tank.size(); ++i) o.angle[i] -= tank[i];
  o.friction = o.run.series("tank bottom.friction");
  o.normal = o.run.series("tank bottom.normal");
  o.slide = o.run.series("tank bottom.slide");
  o.top = o.run.series("top arresting.force");
  o.bottom = o.run.series("bottom arresting.force");
  for (const Event& e : o.run.result.events) {
    if (e.element != "tank bottom") continue;
    if (is_slip(e.kind)) o.slips.push_back({e.t, 0.8});
    if (e.kind == EventKind::sticks) o.slips.back().end = e.t;
  }
  return o;
}

// Slips with less than 20 ms of sticking between them belong to one window.
std::vector<Phase> windows(const std::vector<Phase>& slips) {
  std::vector<Phase> result;
  for (const Phase& slip : slips) {
    if (!result.empty() && slip.begin - result.back().end < 0.02) result.back().end = slip.end;
    else result.push_back(slip);
  }
  return result;
}

double largest(const std::vector<double>& series, std::size_t from, std::size_t to) {
  double most = 0.0;
  for (std::size_t i = from; i < to; ++i) most = std::max(most, std::abs(series[i]));
  return most;
}

// Local extremes of the rate at which a series changes.
int waves(const std::vector<double>& series, std::size_t from, std::size_t to) {
  int count = 0;
  for (std::size_t i = from + 2; i < to; ++i) {
    const double before = series[i - 1] - 2.0 * series[i - 2] + series[i - 3];
    const double now = series[i] - 2.0 * series[i - 1] + series[i - 2];
    if (before * now < 0.0) ++count;
  }
  return count;
}

constexpr double k_peak = 0.1; // s, of the load, which lasts from 0.05 s to 0.15 s
const Observed& without() {
  static const Observed o = observe(Condition::no_interference);
  return o;
}
const Observed& with() {
  static const Observed o = observe(Condition::interference);
  return o;
}

} // namespace

TEST_CASE("1. near the strongest load the relative angle oscillates, with stick-slip") {
  for (const Observed* o : {&without(), &with()}) {
    REQUIRE(!o->slips.empty());
    CHECK(o->slips[0].begin < k_peak);
    CHECK(o->slips[0].end > k_peak);
    CHECK(o->slips[0].end < 0.15);
    CHECK(waves(o->angle, o->index(0.08), o->index(0.15)) >= 3);
  }
}

TEST_CASE("2. the active part pitches nose down on the tank floor, less with interference") {
  const auto lowest = [](const Observed& o) { return *std::min_element(o.angle.begin(), o.angle.end()); };
  CHECK(lowest(without()) < -0.5e-3);
  CHECK(lowest(with()) < -0.25e-3);
  CHECK(lowest(with()) > 0.7 * lowest(without()));
  for (const Observed* o : {&without(), &with()}) // still so when the load has passed
    CHECK(o->angle[o->index(0.15)] < -0.1e-3);
  CHECK(with().angle[with().index(0.15)] > without().angle[without().index(0.15)]);
}

TEST_CASE("3. the friction force oscillates in two separate windows, with opposite signs") {
  for (const Observed* o : {&without(), &with()}) {
    const std::vector<Phase> w = windows(o->slips);
    REQUIRE(w.size() == 2);
    CHECK(w[1].begin - w[0].end > 0.04); // it sticks for longer than either window's shortest slip
    CHECK(o->friction[o->index(0.5 * (w[0].begin + w[0].end))] < 0.0);
    CHECK(o->friction[o->index(0.5 * (w[1].begin + w[1].end))] > 0.0);
  }
}

TEST_CASE("4. in the first window the active part slides on the floor and sticks again") {
  for (const Observed* o : {&without(), &with()}) {
    const Phase first = windows(o->slips)[0];
    CHECK(largest(o->slide, 0, o->index(first.begin)) < 1e-12);
    const std::size_t from = o->index(first.end) + 1, to = o->index(windows(o->slips)[1].begin);
    CHECK(o->slide[from] > 0.7e-3);
    // The same foot is held: the front foot's coordinate changes only as the part tilts about the rear.
    for (std::size_t i = from; i < to; ++i) CHECK(std::abs(o->slide[i] - o->slide[from]) < 2e-3 * o->slide[from]);
  }
}

TEST_CASE("5. the second window comes when a foot that had lifted touches down again") {
  for (const Observed* o : {&without(), &with()}) {
    const std::vector<Phase> w = windows(o->slips);
    const std::vector<double> lifts = o->run.event_times("rear foot", "opens"), lands = o->run.event_times("rear foot", "closes");
    REQUIRE(lifts.size() == 1);
    REQUIRE(lands.size() == 1);
    CHECK(lifts[0] < w[0].end);
    CHECK(lands[0] > w[0].end);
    CHECK(lands[0] < w[1].begin);
    CHECK(w[1].begin - lands[0] < 0.035);
    // It is the touch-down that turns the friction force round.
    const std::size_t at = o->index(lands[0]);
    CHECK(o->friction[at - 1] < 0.0);
    CHECK(*std::max_element(o->friction.begin() + at, o->friction.begin() + at + 10) > 0.08 * o->normal[at]);
  }
}

TEST_CASE("6. the arresting devices carry next to nothing until sliding starts") {
  for (const Observed* o : {&without(), &with()}) {
    const std::size_t onset = o->index(o->slips[0].begin), end = o->t.size();
    CHECK(largest(o->bottom, 0, onset) < 0.05 * largest(o->bottom, 0, end));
    // The top ones also take part in the tank's own shear: not nothing, but little.
    CHECK(largest(o->top, 0, onset) < 0.3 * largest(o->top, 0, end));
    CHECK(largest(o->top, 0, onset) < 0.1 * largest(o->friction, 0, onset));
  }
}

TEST_CASE("7. the bottom arresting devices' reaction is slightly higher with interference") {
  const double a = largest(without().bottom, 0, without().t.size()), b = largest(with().bottom, 0, with().t.size());
  CHECK(b > a);
  CHECK(b < 1.1 * a);
}

TEST_CASE("8. a small change of a design parameter changes the response markedly") {
  // Two percent more friction: where the active part comes to rest changes by a quarter and more.
  for (const Condition condition : {Condition::no_interference, Condition::interference}) {
    const double rest = (condition == Condition::interference ? with() : without()).slide.back();
    const double changed = observe(condition, 1.02).slide.back();
    CHECK(std::abs(changed - rest) > 0.25 * std::abs(rest));
  }
}

// What the paper reports of its transformer (paper_model: behaviours 1 to 8), computed from runs.
#include "mbd/model/model_path.h"
#include "tests/physics/paper_runs.h"
#include "tests/physics/turning_points.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
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

Observed observe(const std::string& name, double friction_factor = 1.0, double tolerance = 1e-9) {
  const std::string field = "element.tank bottom.static_friction", path = std::string(STEPLAP_MODELS) + "/paper/" + name + ".toml";
  Model model = read_model(path, transformer_catalog());
  if (friction_factor != 1.0)
    model = read_model(path, transformer_catalog(), {field + "=" + std::to_string(friction_factor * number_of(model, field))});
  Observed o;
  o.run = run(model, {"dop853", tolerance, 0.8, 1e-3});
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

// Turning points of the relative angle near the strongest load. A swing counts beyond ten times the error of the angle, estimated by a run
// at another tolerance, and beyond 1 % of the angle's range there.
int turns_of_angle(const Observed& o, const Observed& other) {
  const std::size_t from = o.index(0.06), to = o.index(0.15);
  const auto [low, high] =
      std::minmax_element(o.angle.begin() + static_cast<std::ptrdiff_t>(from), o.angle.begin() + static_cast<std::ptrdiff_t>(to) + 1);
  double error = 0.0;
  for (std::size_t i = from; i <= to; ++i) error = std::max(error, std::abs(o.angle[i] - other.angle[i]));
  return turning_points(o.angle, from, to, std::max(10.0 * error, 0.01 * (*high - *low)));
}

constexpr double k_peak = 0.1; // s, of the load, which lasts from 0.05 s to 0.15 s
const Observed& without() {
  static const Observed o = observe(name_of(Condition::no_interference));
  return o;
}
const Observed& with() {
  static const Observed o = observe(name_of(Condition::interference));
  return o;
}

} // namespace

// The paper's angle oscillates there; with the reference values it turns once (see "as reported" below).
TEST_CASE("1. near the strongest load the active part slips and sticks; the relative angle turns once") {
  for (const Observed* o : {&without(), &with()}) {
    REQUIRE(!o->slips.empty());
    CHECK(o->slips[0].begin < k_peak);
    CHECK(o->slips[0].end > k_peak);
    CHECK(o->slips[0].end < 0.15);
  }
  CHECK(turns_of_angle(without(), observe(name_of(Condition::no_interference), 1.0, 1e-8)) == 1);
  CHECK(turns_of_angle(with(), observe(name_of(Condition::interference), 1.0, 1e-8)) == 1);
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
    const double changed = observe(name_of(condition), 1.02).slide.back();
    CHECK(std::abs(changed - rest) > 0.25 * std::abs(rest));
  }
}

namespace {

// A run and one at another tolerance, from which its errors are estimated.
struct Checked {
  Observed run, other;
};

const std::array<Checked, 2>& as_reported() { // without and with interference
  static const std::array<Checked, 2> runs = {Checked{observe("as_reported"), observe("as_reported", 1.0, 1e-8)},
                                              Checked{observe("as_reported_interference"), observe("as_reported_interference", 1.0, 1e-8)}};
  return runs;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t from, std::size_t to) {
  double most = 0.0;
  for (std::size_t i = from; i <= to; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

// First time after `begin` at which a foot touches down.
double landing_after(const Observed& o, double begin) {
  double first = 0.8;
  for (const char* foot : {"front foot", "rear foot"})
    for (const double t : o.run.event_times(foot, "closes"))
      if (t > begin) first = std::min(first, t);
  return first;
}

constexpr double k_load_begin = 0.05, k_load_end = 0.15; // s
constexpr double k_swing = 5e3;                          // N, of the friction force: 3 % of its largest value

} // namespace

// Turning points as in claim 1 above. Swings are small: 1 % of the range at the onset of the first slip, 100 % at the strongest load.
TEST_CASE("as reported, 1: near the strongest load the relative angle oscillates, with stick-slip") {
  for (const Checked& c : as_reported()) {
    CHECK(turns_of_angle(c.run, c.other) >= 3);
    REQUIRE(c.run.slips.size() >= 2);
    for (const Phase& slip : c.run.slips) {
      CHECK(slip.begin > 0.05);
      CHECK(slip.end < 0.165);
    }
  }
}

TEST_CASE("as reported, 2: the active part pitches nose down after the load, less with interference") {
  std::array<double, 2> lowest{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [run, other] = as_reported()[i];
    const std::size_t from = run.index(k_load_end), to = run.t.size() - 1;
    lowest[i] = *std::min_element(run.angle.begin() + static_cast<std::ptrdiff_t>(from), run.angle.end());
    CHECK(lowest[i] < -0.05e-3);
    CHECK(10.0 * largest_difference(run.angle, other.angle, from, to) < 0.05e-3);
  }
  CHECK(lowest[0] < lowest[1] - 0.05e-3);
}

TEST_CASE("as reported, 3 and 5: friction oscillates in two windows; the second begins when a foot lands, without slip") {
  for (const auto& [run, other] : as_reported()) {
    const double end = run.slips.back().end, landing = landing_after(run, end);
    CHECK(run.run.event_times("rear foot", "opens").at(0) < end); // a foot has lifted while it slid
    const std::size_t first = run.index(k_load_begin), quiet = run.index(end), again = run.index(landing), last = run.index(landing + 0.1);
    CHECK(turning_points(run.friction, first, quiet, k_swing) >= 2);
    CHECK(turning_points(run.friction, quiet, again, k_swing) == 0);
    CHECK(turning_points(run.friction, again, last, k_swing) >= 4);
    CHECK(10.0 * largest_difference(run.friction, other.friction, first, last) < k_swing);
  }
}

TEST_CASE("as reported, 4: the active part slides on the floor while friction first oscillates, not before") {
  for (const auto& [run, other] : as_reported()) {
    const double slide = largest(run.slide, 0, run.t.size());
    CHECK(largest(run.slide, 0, run.index(run.slips[0].begin)) < 1e-12);
    CHECK(slide > 0.1e-3);
    CHECK(largest_difference(run.slide, other.slide, 0, run.t.size() - 1) < 1e-3 * slide);
  }
}

TEST_CASE("as reported, 6 and 7: arresting devices carry little until sliding starts, the bottom ones slightly more with interference") {
  std::array<double, 2> bottom{};
  double error = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [run, other] = as_reported()[i];
    const std::size_t onset = run.index(run.slips[0].begin), end = run.t.size();
    bottom[i] = largest(run.bottom, 0, end);
    error = std::max(error, largest_difference(run.bottom, other.bottom, 0, end - 1));
    CHECK(largest(run.bottom, 0, onset) < 0.05 * bottom[i]);
    CHECK(largest(run.top, 0, onset) < 0.3 * largest(run.top, 0, end));
  }
  CHECK(bottom[1] > bottom[0] + 10.0 * error);
  CHECK(bottom[1] < 1.1 * bottom[0]);
}

// Markedly: by more than twice the change of the parameter.
TEST_CASE("as reported, 8: two percent more friction change where the active part comes to rest by more than four percent") {
  for (const char* name : {"as_reported", "as_reported_interference"}) {
    const double rest = observe(name).slide.back();
    CHECK(std::abs(observe(name, 1.02).slide.back() - rest) > 0.04 * std::abs(rest));
  }
}

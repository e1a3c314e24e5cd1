// The paper's transformer against an independent program: minimal coordinates, events located, relative
// tolerance 1e-11; histories at 1 kHz written with 12 digits, event times with nine decimals.
#include "tests/physics/paper_runs.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// What the reference's 12 digits leave open, relative to a column's range: half a unit of the last digit
// of its largest number (y1 = 1.95 m varies by no more than 0.1 mm).
double resolution(const std::vector<double>& column) {
  const auto [least, most] = std::minmax_element(column.begin(), column.end());
  const double size = std::max(std::abs(*least), std::abs(*most));
  return 0.5e-11 * std::pow(10.0, std::floor(std::log10(size))) / (*most - *least);
}

void check_channels(const Run& r, Condition condition, double tolerance) {
  const CsvTable reference = paper_reference(condition);
  REQUIRE(r.times().size() == reference.columns[0].size() + 1); // and the start
  for (const Common& common : common_channels()) {
    const std::vector<double>& column = reference.columns[reference.column(common.column, {})];
    const auto [least, most] = std::minmax_element(column.begin(), column.end());
    CAPTURE(common.column);
    if (*most == *least) { // the front block never touches without interference
      for (const double value : r.series(common.channel)) CHECK(value == *least);
      continue;
    }
    CHECK(relative_difference(r, reference, common) < tolerance + resolution(column));
  }
}

struct Expected {
  double t;
  const char* element;
  EventKind kind;
};

// The table of events, and the kinds that it does not list: the force-zero kinks of feet and blocks and
// the blocks' contacts. Changes of the last contact foot are left out on both sides: most happen in the
// decaying oscillation after the stop and move with it.
std::vector<Expected> expected_events(Condition condition) {
  if (condition == Condition::interference)
    return {{0.087731010, "tank bottom", EventKind::slips_forward},
            {0, "front block", EventKind::force_reaches_zero},
            {0, "front block", EventKind::opens},
            {0, "rear foot", EventKind::force_reaches_zero},
            {0.117362519, "rear foot", EventKind::opens},
            {0.128858040, "tank bottom", EventKind::sticks},
            {0.146934030, "rear foot", EventKind::closes},
            {0, "front block", EventKind::closes},
            {0.177926029, "tank bottom", EventKind::slips_backward},
            {0.222288679, "tank bottom", EventKind::sticks}};
  return {{0.085142652, "tank bottom", EventKind::slips_forward},
          {0.106601580, "rear foot", EventKind::force_reaches_zero},
          {0.106695207, "rear foot", EventKind::opens},
          {0, "rear block", EventKind::closes},
          {0.121825119, "tank bottom", EventKind::sticks},
          {0, "rear block", EventKind::force_reaches_zero},
          {0, "rear block", EventKind::opens},
          {0.163733674, "rear foot", EventKind::closes},
          {0.174526638, "tank bottom", EventKind::slips_backward},
          {0.185520080, "tank bottom", EventKind::sticks},
          {0.190738509, "tank bottom", EventKind::slips_backward},
          {0, "front foot", EventKind::force_reaches_zero},
          {0.194969330, "front foot", EventKind::opens},
          {0.201341052, "front foot", EventKind::closes},
          {0, "front foot", EventKind::force_reaches_zero},
          {0.211802680, "front foot", EventKind::opens},
          {0.230884490, "tank bottom", EventKind::sticks},
          {0.237777207, "front foot", EventKind::closes}};
}

// A time of 0 in the table: the reference gives none, only that it happens there in the sequence.
void check_events(const Run& r, Condition condition, double tolerance) {
  std::vector<Event> events = r.result.events;
  std::erase_if(events, [](const Event& e) { return e.kind == EventKind::changes_foot; });
  const std::vector<Expected> expected = expected_events(condition);
  REQUIRE(events.size() == expected.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    CAPTURE(expected[i].t);
    CHECK(events[i].element == expected[i].element);
    CHECK(events[i].kind == expected[i].kind);
    if (expected[i].t > 0.0) CHECK(std::abs(events[i].t - expected[i].t) < tolerance);
  }
}

} // namespace

TEST_CASE("paper's transformer with rk4 at 1e-4 s: histories, events, energy, constraints") {
  for (const Condition condition : {Condition::no_interference, Condition::interference}) {
    CAPTURE(name_of(condition));
    const Run r = paper_run(condition, "rk4", 1e-4);
    check_channels(r, condition, 1e-6);
    check_events(r, condition, 1e-7);
    const RunStatistics& s = r.result.statistics;
    CHECK(s.energy_residual < 1e-8 * s.energy_exchanged);
    CHECK(s.max_position_residual < 1e-10);
  }
}

TEST_CASE("paper's transformer with the adaptive methods at tight tolerance") {
  for (const Condition condition : {Condition::no_interference, Condition::interference})
    for (const char* integrator : {"tsit5", "dop853"}) {
      CAPTURE(name_of(condition));
      CAPTURE(integrator);
      const Run r = paper_run(condition, integrator, 1e-11);
      check_channels(r, condition, 1e-8);
      // The table's nine decimals, and a contact whose force grows from zero amplifies an error of its
      // start about tenfold.
      check_events(r, condition, 3e-9);
      const RunStatistics& s = r.result.statistics;
      CHECK(s.energy_residual < 1e-10 * s.energy_exchanged);
      CHECK(s.max_position_residual < 1e-12);
    }
}

// Events located on dense output that is good enough leave the method its fourth order: halving the step
// divides the error by 16. A step more or less before an event makes the factor scatter by a third.
TEST_CASE("rk4 keeps its order across the events of the paper's transformer") {
  for (const Condition condition : {Condition::no_interference, Condition::interference}) {
    CAPTURE(name_of(condition));
    const CsvTable reference = paper_reference(condition);
    const Run coarse = paper_run(condition, "rk4", 2e-4), middle = paper_run(condition, "rk4", 1e-4),
              fine = paper_run(condition, "rk4", 5e-5);
    double product = 1.0;
    int count = 0;
    for (const Common& common : common_channels()) {
      // y1, y5: the reference's digits end at the error of the fine run; blocks: touch only for a moment
      const std::string name = common.column;
      if (name == "x1" || name == "y1" || name == "y5" || name == "wood_front" || name == "wood_rear") continue;
      const double e0 = relative_difference(coarse, reference, common), e1 = relative_difference(middle, reference, common),
                   e2 = relative_difference(fine, reference, common);
      CAPTURE(name);
      CHECK(e0 / e1 > 8.0);
      CHECK(e1 / e2 > 8.0);
      product *= e0 / e2;
      ++count;
    }
    const double factor = std::pow(product, 0.5 / count); // geometric mean of one halving
    CHECK(std::log2(factor) == doctest::Approx(4.0).epsilon(0.05));
  }
}

// The same for the adaptive methods, their error control put out of action so that they keep the longest step
// allowed; against the run at the tightest tolerance, for their errors go below the digits of the files.
TEST_CASE("tsit5 and dop853 keep their orders across the events of the paper's transformer") {
  struct Case {
    const char* integrator;
    double order, step;
  };
  const std::vector<std::string> channels = {"active part.theta", "lower tank.theta", "bottom arresting.force", "tank flexibility.force"};
  const auto fixed = [&channels](const System& system, const Case& c, double step) {
    SimulationOptions options;
    options.end = 0.8;
    options.integrator = c.integrator;
    options.settings.tolerance = 1e6;
    options.settings.step = options.settings.max_step = step;
    options.output_step = 1e-3;
    options.channels = channels;
    return simulate(system, system.initial_state(), options);
  };
  for (const Case& c : {Case{"tsit5", 5.0, 1e-3}, Case{"dop853", 8.0, 4e-3}}) {
    CAPTURE(c.integrator);
    double product = 1.0;
    int count = 0;
    for (const Condition condition : {Condition::no_interference, Condition::interference}) {
      const Model model = paper_model(condition);
      const auto system = compile(model);
      const RunResult exact = fixed(*system, {"dop853", 8.0, 0.0}, 5e-4), coarse = fixed(*system, c, c.step),
                      fine = fixed(*system, c, 0.25 * c.step);
      for (const std::string& channel : channels) {
        const auto difference = [&](const RunResult& r) {
          const std::vector<double> a = r.trajectory->series(channel), b = exact.trajectory->series(channel);
          double worst = 0.0;
          for (std::size_t i = 0; i < b.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
          return worst;
        };
        product *= difference(coarse) / difference(fine);
        ++count;
      }
    }
    // Two halvings; a step more or less before an event makes single ones scatter.
    CHECK(std::abs(std::log2(std::pow(product, 0.5 / count)) - c.order) < 0.2);
  }
}

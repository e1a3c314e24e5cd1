// A core whose sheets butt from the start: parallel lines of a corner bear as one bed, so that events are those of corners, not of
// each kind of interface, and what edges bear goes over into cores with a hair's clearance.
#include "mbd/io/reader.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/simulation/simulation.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;

namespace {

struct Run {
  std::unique_ptr<System> system;
  RunResult result;

  Run(const std::string& clearance, const std::string& bands, bool from_equilibrium, double end, const std::string& tolerance = "1e-8") {
    const Model model = read_model(STEPLAP_TEST_DATA "/cores/edges_in_touch.toml", transformer_catalog(),
                                   {"core.core.clearance=" + clearance + " mm", "core.core.bands=" + bands,
                                    "simulation.end=" + std::to_string(end), "simulation.tolerance=" + tolerance});
    system = compile(model);
    State start = assembled_start(*system, assemble(model, *system));
    if (from_equilibrium) start = find_equilibrium(*system, start).state;
    result = simulate(*system, start, options_of(model));
  }
  [[nodiscard]] long count(EventKind kind) const {
    return std::count_if(result.events.begin(), result.events.end(), [kind](const Event& e) { return e.kind == kind; });
  }
  [[nodiscard]] double least(const std::string& channel) const {
    for (const ChannelRange& range : result.ranges)
      if (range.channel->name == channel) return range.low.value;
    return std::nan("");
  }
};

} // namespace

TEST_CASE("edges that butt from the start: a core at rest on them has the events of its corners alone" *
          doctest::skip(testing::k_is_sanitized)) { // the law itself: step_lap_edges_test.cpp
  // Two limbs, two corners each: of a bump of 3 g each corner may let go and close again once, with the moments at which all of it
  // bears. Line by line these were hundreds.
  const Run butting("0", "each", true, 0.065);
  CHECK(butting.result.events.size() <= 4 * 4);
  CHECK(butting.count(EventKind::opens) >= 1); // the edges did bear, and the bump takes some off

  // The joint that bears beside the edges, 5.16e10 N/m, takes what the limb moves on before they close: across a mitre of 45°.
  constexpr double k_stiffness = 5.15889e10, k_error = 1e-4; // of the force, what steps at 1e-8 and the search leave
  const double force = butting.least("limb A joint.fx");
  REQUIRE(force < -5e4);
  for (const auto& [text, clearance] : {std::pair{"0.0001", 1e-7}, {"0.000001", 1e-9}}) {
    CAPTURE(text);
    const Run apart(text, "each", true, 0.065);
    CHECK(apart.result.events.size() <= 4 * 4);
    CHECK(std::abs(apart.least("limb A joint.fx") - force) < std::sqrt(2.0) * k_stiffness * clearance - k_error * force);
  }
  // A hundredth of a millimetre is more than the joint yields by.
  CHECK(Run("0.01", "each", true, 0.065).result.events.empty());
}

TEST_CASE("a core that rattles on its edges has as many events with all kinds of interface as with their means" *
          doctest::skip(testing::k_is_sanitized)) {
  // Weight comes at once, and nothing damps what follows: the corners bounce at a kilohertz. Twelve kinds of interface a corner are
  // one bed as the three means are.
  const Run each("0", "each", false, 0.004, "1e-12"), mean("0", "mean", false, 0.004, "1e-12");
  REQUIRE(mean.count(EventKind::closes) > 5);
  CHECK(each.result.events.size() < 2 * mean.result.events.size());
  // No energy is made where lines of a bed close one after another: some 60 events and 3000 steps at 1e-12 leave less than this.
  CHECK(each.result.statistics.energy_residual < 1e-6 * each.result.statistics.energy_exchanged);
}

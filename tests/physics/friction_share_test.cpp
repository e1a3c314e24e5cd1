// The share of friction that is used, and ties: which of two frictions slips first. Truths are closed forms of masses on rails.
#include "mbd/rest/start.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string body(const std::string& name, double mass) {
  return "[[body]]\nname = \"" + name + "\"\nmass = " + number(mass) + "\ninertia = " + number(0.1 * mass) + "\n";
}

std::string on_rail(const std::string& name, double mass) {
  return body(name, mass) + "[[element]]\nkind = \"prismatic\"\nname = \"rail of " + name + "\"\na = \"" + name + "\"\n";
}

std::string driven_deck(const std::string& signal) {
  return "gravity = [0.0, -9.81]\n" + signal + on_rail("deck", 10.0) +
         "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"deck\"\nsignal = \"pulse\"\n";
}

Run run_with_extremes(const std::string& text, SimulationOptions o) {
  Run r;
  r.system = compile(scene(text + "\n[simulation]\nstep = 1e-3\n"));
  o.has_extremes = true;
  r.result = simulate(*r.system, r.system->initial_state(), o);
  return r;
}

const ChannelRange& range_of(const Run& r, const std::string& channel) {
  for (const ChannelRange& range : r.result.ranges)
    if (range.channel->name == channel) return range;
  FAIL("no channel " << channel);
  return r.result.ranges.front();
}

} // namespace

TEST_CASE("the share of friction is what the load is of the bound, wherever rows are written") {
  random::RandomNumber draw(38);
  for (int i = 0; i < 240; ++i) {
    const double mass = draw.decades(0.0, 4.0), share = 1.0 - draw.decades(-5.0, -0.3), duration = draw.decades(-2.0, 0.0);
    const double start = draw.between(0.0, 1.0) * duration, bound = 0.45 * mass * 9.81;
    static constexpr const char* methods[] = {"auto", "dop853", "tsit5", "rodas5p"};
    const char* const method = methods[i % 4];
    const int kind = i / 4 % 3;
    CAPTURE(i);
    CAPTURE(kind);
    CAPTURE(method);
    CAPTURE(share);
    std::string text = driven_deck("[[signal]]\nkind = \"half_sine\"\nname = \"pulse\"\npeak = " + number(share * bound / mass) +
                                   "\nstart = " + number(start) + "\nduration = " + number(duration) +
                                   "\n[[signal]]\nkind = \"constant\"\nname = \"half\"\nvalue = 0.5\n") +
                       on_rail("block", mass);
    if (kind == 0)
      text +=
          "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot\"\na = \"block\"\nb = \"deck\"\nstiffness = " + number(1e6 * mass) +
          "\npreload = " + number(9.81 * mass) +
          "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"friction\"\ncontacts = [\"foot\"]\nstatic_friction = 0.45\n";
    else if (kind == 1)
      text += "[[element]]\nkind = \"joint_friction\"\nname = \"friction\"\na = \"block\"\nb = \"deck\"\ncoordinate = \"x\"\nsignal = "
              "\"half\"\nholds = " +
              number(2.0 * bound) + "\n";
    else
      text +=
          "[[element]]\nkind = \"skate\"\nname = \"friction\"\na = \"block\"\nb = \"deck\"\naxis = [0.0, 1.0]\ngrip = " + number(bound) +
          "\n";
    const Run r = run_with_extremes(text, options({method, 1e-8, start + 3.0 * duration}));
    CHECK(r.result.events.empty());
    const ChannelRange& range = range_of(r, "friction.share");
    // Extremes are located to a millionth of a channel's range; what is flat there is located in time to the root of that.
    CHECK(std::abs(range.high.value - share) <= 2e-6 * share);
    CHECK(std::abs(range.high.t - (start + 0.5 * duration)) <= 2e-3 * duration);
    CHECK(range.low.value == 0.0);
  }
}

TEST_CASE("friction that slips has the share 1, and one that takes nothing 0") {
  const auto text = [](double peak) {
    return driven_deck("[[signal]]\nkind = \"half_sine\"\nname = \"pulse\"\npeak = " + number(peak) + "\nstart = 0.1\nduration = 0.1\n") +
           on_rail("block", 2.0) +
           "[[element]]\nkind = \"joint_friction\"\nname = \"friction\"\na = \"block\"\nb = \"deck\"\ncoordinate = \"x\"\nholds = "
           "10\ndrags = 6\n";
  };
  const Run slips = run_with_extremes(text(7.0), options({"dop853", 1e-9, 1.0}));
  CHECK(slips.event_times("friction").size() == 2);
  CHECK(range_of(slips, "friction.share").high.value == doctest::Approx(1.0).epsilon(1e-12)); // a bound may be passed by its slack
  CHECK(range_of(run_with_extremes(text(0.0), options({"dop853", 1e-9, 1.0})), "friction.share").high.value == 0.0);
}

// A mass m₁ on a mass m₀ on a deck whose acceleration grows evenly: at a = A the lower friction of (m₀ + m₁)A is at its bound, the upper
// one of m₁A(1 + ε) at the share 1/(1 + ε) of its own. What slips first relieves the other, which then holds.
TEST_CASE("ties are noted with share and rate, and the other outcome is that of the other one slipping") {
  random::RandomNumber draw(36);
  for (int i = 0; i < 200; ++i) {
    const double m0 = draw.decades(-1.0, 3.0), m1 = m0 * draw.decades(-0.5, 0.5), a = draw.decades(-1.0, 1.0),
                 rise = draw.decades(-1.0, 1.0);
    const double size = draw.decades(-8.0, -3.3), epsilon = draw.between(0.0, 1.0) < 0.5 ? size : -size;
    static constexpr const char* methods[] = {"auto", "dop853", "tsit5", "rodas5p"};
    const char* const method = methods[i % 4];
    CAPTURE(i);
    CAPTURE(method);
    CAPTURE(epsilon);
    const double bound0 = (m0 + m1) * a, bound1 = m1 * a * (1.0 + epsilon);
    const std::string text =
        driven_deck("[[signal]]\nkind = \"trapezoid\"\nname = \"pulse\"\npeak = " + number(1.2 * a) + "\nduration = " + number(2.0 * rise) +
                    "\nrise = " + number(rise) + "\nfall = 0.0\n") +
        on_rail("m0", m0) + on_rail("m1", m1) +
        "[[element]]\nkind = \"joint_friction\"\nname = \"f0\"\na = \"m0\"\nb = \"deck\"\ncoordinate = \"x\"\nholds = " + number(bound0) +
        "\ndrags = " + number(0.7 * bound0) +
        "\n[[element]]\nkind = \"joint_friction\"\nname = \"f1\"\na = \"m1\"\nb = \"m0\"\ncoordinate = \"x\"\nholds = " + number(bound1) +
        "\ndrags = " + number(0.7 * bound1) + "\n";
    SimulationOptions o = options({method, 1e-9, 0.9 * rise});
    const Run r = run_with_extremes(text, o);
    const std::string slips = epsilon > 0.0 ? "f0" : "f1", sticks = epsilon > 0.0 ? "f1" : "f0";
    REQUIRE(r.event_times(slips).size() == 1);
    CHECK(r.event_times(sticks).empty());
    REQUIRE(r.result.ties.size() == 1);
    const SimultaneousSlip& tie = r.result.ties.front();
    CHECK(tie.slips == slips);
    CHECK(tie.sticks == sticks);
    CHECK(1.0 - tie.share ==
          doctest::Approx(size).epsilon(2e-3)); // its square is 5e-4 of it; times are known to 1e-13 of a second and less
    CHECK(tie.rate == doctest::Approx(1.2 / rise).epsilon(1e-3));
    o.other_slip = tie;
    const Run other = run_with_extremes(text, o);
    CHECK(other.event_times(slips).empty());
    REQUIRE(other.event_times(sticks).size() == 1);
    CHECK(other.event_times(sticks).front() == tie.t);
  }
}

TEST_CASE("what is far from its bound is no tie") {
  const std::string text =
      driven_deck("[[signal]]\nkind = \"trapezoid\"\nname = \"pulse\"\npeak = 6.0\nduration = 2.0\nrise = 1.0\nfall = 0.0\n") +
      on_rail("m0", 2.0) + on_rail("m1", 1.0) +
      "[[element]]\nkind = \"joint_friction\"\nname = \"f0\"\na = \"m0\"\nb = \"deck\"\ncoordinate = \"x\"\nholds = 15\ndrags = 10\n"
      "[[element]]\nkind = \"joint_friction\"\nname = \"f1\"\na = \"m1\"\nb = \"m0\"\ncoordinate = \"x\"\nholds = 5.01\n";
  const Run r = run_with_extremes(text, options({"auto", 1e-9, 0.9}));
  CHECK(r.event_times("f0").size() == 1);
  CHECK(r.result.ties.empty());
}

// Both crates need the same share of g. With 0.39996 the upper one gives way, 4.8e-6 before the lower one would; 4.8e-6 more friction turns
// this round, and the crate that slides does so by 0.286 m. Either run shows the outcome of the other one.
TEST_CASE("two crates on an edge: each run has the other one's outcome") {
  for (const double mu_top : {0.39996, 0.3999619}) {
    CAPTURE(mu_top);
    std::unique_ptr<System> system;
    const std::string file = std::string(STEPLAP_TEST_DATA) + "/defects/crates_on_an_edge.toml";
    const Model model = read_model(file, transformer_catalog(), {"parameters.mu_top=" + number(mu_top)});
    system = compile(model);
    const State start = start_of(model, *system);
    const auto way = [&](const RunResult& r, const std::string& crate) {
      for (const ChannelRange& range : r.ranges)
        if (range.channel->name == "way of the " + crate + " crate") return range.high.value;
      return -1.0;
    };
    SimulationOptions o = options_of(model);
    o.has_extremes = true;
    const RunResult r = simulate(*system, start, o);
    const bool is_upper = mu_top < 0.39996001;
    const std::string slides = is_upper ? "upper" : "lower", holds = is_upper ? "lower" : "upper";
    REQUIRE(r.ties.size() == 1);
    CHECK(1.0 - r.ties.front().share < 1e-5);
    CHECK(way(r, slides) == doctest::Approx(0.28594).epsilon(1e-4));
    CHECK(way(r, holds) < 1e-6); // by which the contacts give way
    o.other_slip = r.ties.front();
    const RunResult other = simulate(*system, start, o);
    CHECK(way(other, holds) == doctest::Approx(0.28594).epsilon(1e-4));
    CHECK(way(other, slides) < 1e-6);
  }
}

// Rigid blows: what they go through has an impulse, 2 m g h for a mass that falls into a rope, and no force that a limit could be held to.
#include "mbd/base/counter_random.h"
#include "mbd/base/number_text.h"
#include "mbd/run/report.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;

namespace {

double drawn(std::uint32_t stream, std::uint64_t n) { return counter_uniform(2, stream, n, 0); }
std::string number(double value) { return number_text(value); }

Report run_of(const std::string& text) {
  RunOptions options;
  options.estimating = Estimating::never;
  return judged_run(load_model_text(text, "blow.toml"), options);
}

std::string limit_on(const std::string& channel) {
  return "[[acceptance]]\nname = \"" + channel + "\"\nchannel = \"" + channel + "\"\nwithin = 1e9\nconsequence = \"reject\"\n";
}

Verdict outcome_of(const Report& report, const std::string& name) {
  for (const CriterionResult& c : report.judgement.criteria)
    if (c.name == name) return c.outcome;
  return Verdict::reject;
}

const Extreme& largest(const Report& report, const std::string& channel) { return report.find(channel)->largest(); }

// A mass that hangs below 'anchor', which a pin holds, and falls into its rope over the slack.
std::string falling(double mass, double slack, const std::string& rope) {
  return "[simulation]\nend = 1.5\n[[body]]\nname = \"load\"\nmass = " + number(mass) +
         "\ninertia = 1.0\nposition = [0.0, -1.0]\n[[body]]\nname = \"arm\"\nmass = 5.0\ninertia = 1.0\n"
         "[[body]]\nname = \"other\"\nmass = 1.0\ninertia = 0.1\nposition = [5.0, 0.0]\n"
         "[[element]]\nkind = \"revolute\"\nname = \"anchor\"\na = \"arm\"\n"
         "[[element]]\nkind = \"revolute\"\nname = \"far pin\"\na = { body = \"other\", at = [5.5, 0.0] }\nb = { body = \"ground\", at = "
         "[5.5, 0.0] }\n"
         "[[element]]\nkind = \"rope\"\nname = \"r\"\na = \"load\"\nb = \"arm\"\nslack = " +
         number(slack) + "\n" + rope + "[[channel]]\nname = \"both\"\nexpression = \"anchor.force_y + 2 * r.tension\"\n" +
         limit_on("r.tension") + limit_on("anchor.force_y") + limit_on("load.ay") + limit_on("both") + limit_on("load.y") +
         limit_on("far pin.force_y");
}

} // namespace

TEST_CASE("limits on a rope's force, and on what is joined to it, are open behind a blow; others are not") {
  for (std::uint64_t n = 0; n < 20; ++n) {
    const double mass = 1.0 + 100.0 * drawn(0, n), slack = 0.05 + 0.5 * drawn(1, n), gravity = 9.81;
    CAPTURE(mass);
    CAPTURE(slack);
    const Report rigid = run_of(falling(mass, slack, "inextensible = true\n"));
    CHECK(largest(rigid, "r.impulse").value == doctest::Approx(mass * std::sqrt(2.0 * gravity * slack)).epsilon(1e-6)); // m v
    for (const char* const channel : {"r.tension", "anchor.force_y", "load.ay", "both"}) {
      CAPTURE(std::string(channel));
      CHECK(outcome_of(rigid, channel) == Verdict::open);
    }
    CHECK(outcome_of(rigid, "load.y") == Verdict::hold);          // places do not jump
    CHECK(outcome_of(rigid, "far pin.force_y") == Verdict::hold); // nothing joins it to the rope but the ground
    CHECK(rigid.judgement.verdict == Verdict::open);
    CHECK(rigid.judgement.criteria.front().doubt.find("a rigid impact at t = " +
                                                      std::to_string(std::sqrt(2.0 * slack / gravity)).substr(0, 6)) != std::string::npos);
    const Report elastic = run_of(falling(mass, slack, "stiffness = 1e6\ndamping = 1e3\n"));
    for (const CriterionResult& c : elastic.judgement.criteria) {
      CAPTURE(c.name);
      CHECK(c.outcome == Verdict::hold);
    }
  }
}

TEST_CASE("a rope that becomes taut without a blow, or never, leaves its limit as it is") {
  CHECK(outcome_of(run_of(falling(10.0, 0.0, "inextensible = true\n")), "r.tension") == Verdict::hold); // taut from the start
  CHECK(outcome_of(run_of(falling(10.0, 20.0, "inextensible = true\n")), "r.tension") == Verdict::hold);
}

TEST_CASE("a clutch that locks at once is struck, one with a bound is not") {
  for (const auto& [holds, outcome] : {std::pair{"", Verdict::open}, std::pair{"holds = 5.0\n", Verdict::hold}}) {
    const Report report = run_of(std::string("gravity = [0.0, 0.0]\n[simulation]\nend = 1.0\n[[body]]\nname = \"b\"\nmass = 1.0\n"
                                             "inertia = 1.0\nangular_velocity = -50.0\n[[element]]\nkind = \"revolute\"\nname = \"pin\"\n"
                                             "a = \"b\"\n[[element]]\nkind = \"freewheel\"\nname = \"f\"\na = \"b\"\n") +
                                 holds + limit_on("f.couple") + limit_on("b.omega"));
    CHECK(outcome_of(report, "f.couple") == outcome);
    CHECK(outcome_of(report, "b.omega") == Verdict::hold);
  }
}

TEST_CASE("a latch that catches a moving cart takes a blow, one that closes at rest takes none") {
  for (std::uint64_t n = 0; n < 20; ++n) {
    const double mass = 1.0 + 20.0 * drawn(2, n), other = 1.0 + 20.0 * drawn(3, n), v = n % 4 == 0 ? 0.0 : 4.0 * drawn(4, n) - 2.0;
    CAPTURE(v);
    const auto cart = [](const char* name, double m, const std::string& rest) {
      return std::string("[[body]]\nname = \"") + name + "\"\nmass = " + number(m) + "\ninertia = 1.0\n" + rest +
             "[[element]]\nkind = \"prismatic\"\nname = \"rail of " + name + "\"\na = { body = \"" + name +
             "\", at = [0.0, 0.0] }\nb = { body = \"ground\", at = [0.0, 0.0] }\n";
    };
    const Report report = run_of("gravity = [0.0, 0.0]\n[simulation]\nend = 1.0\n" +
                                 cart("cart", mass, "velocity = [" + number(v) + ", 0.0]\n") + cart("other", other, "") +
                                 "[[element]]\nkind = \"weld\"\nname = \"latch\"\na = { body = \"cart\", at = [0.0, 0.0] }\nb = { body = "
                                 "\"other\", at = [0.0, 0.0] }\nactive = false\n[[action]]\nname = \"catch\"\nwhen = \"0.5 s\"\n"
                                 "do = [\"hold latch\"]\n" +
                                 limit_on("latch.force_x") + limit_on("cart.x"));
    CHECK(outcome_of(report, "latch.force_x") == (v == 0.0 ? Verdict::hold : Verdict::open));
    CHECK(outcome_of(report, "cart.x") == Verdict::hold);
    // Momentum is kept: both go on with m v/(m + M), and m M v²/(2 (m + M)) is lost.
    CHECK(report.run.result.final_state.v[3] == doctest::Approx(mass * v / (mass + other)).epsilon(1e-6));
    CHECK(report.run.result.statistics.dissipated == doctest::Approx(0.5 * mass * other / (mass + other) * v * v).epsilon(1e-4));
    const std::string words = report.run.result.events.front().words();
    CHECK(words.ends_with(" J lost in a blow") == (v != 0.0));
  }
}

// How near friction came to what it holds, and verdicts that depend on which friction slips first.
#include "mbd/run/overview.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace steplap;

namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

Report run_file(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return judged_run(load_model(std::string(STEPLAP_TEST_DATA) + "/defects/" + name, overrides));
}

const Utilisation* use_of(const Overview& overview, const std::string& name) {
  for (const Utilisation& u : overview.utilisations)
    if (u.name == name) return &u;
  return nullptr;
}

const Finding* tie_of(const Report& report) {
  for (const Finding& finding : report.findings)
    if (finding.code == "slip_tie") return &finding;
  return nullptr;
}

// A body of `mass` on a rail, held by friction of one kind on a deck whose acceleration is half a sine; at its peak it takes `share` of
// what the friction holds.
std::string held_on_deck(const std::string& kind, double mass, double share, double start, double duration, double rows) {
  const double mu = 0.45, bound = mu * mass * 9.81, peak = share * bound / mass;
  std::string text = "gravity = [0.0, -9.81]\n[simulation]\nend = " + number(start + 3.0 * duration) +
                     "\n[output]\nstep = " + number(rows) + "\n[[signal]]\nkind = \"half_sine\"\nname = \"pulse\"\npeak = " + number(peak) +
                     "\nstart = " + number(start) + "\nduration = " + number(duration) +
                     "\n[[signal]]\nkind = \"constant\"\nname = \"half\"\nvalue = 0.5\n";
  text += "[[body]]\nname = \"deck\"\nmass = 10.0\ninertia = 1.0\noutline = [[-2.0, -0.1], [2.0, -0.1], [2.0, 0.0], [-2.0, "
          "0.0]]\n[[body]]\nname = \"block\"\nmass = " +
          number(mass) + "\ninertia = " + number(0.1 * mass) +
          "\nposition = [0.0, 0.1]\noutline = [[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1]]\n"
          "[[element]]\nkind = \"prismatic\"\nname = \"road\"\na = \"deck\"\n"
          "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive\"\na = \"deck\"\nsignal = \"pulse\"\n";
  const std::string rail = "[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"block\"\n";
  if (kind == "coulomb_stick")
    text += rail +
            "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot\"\na = { body = \"block\", point = [0.0, -0.1] }\nb = "
            "\"deck\"\nstiffness = " +
            number(1e6 * mass) + "\npreload = " + number(9.81 * mass) +
            "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"friction\"\ncontacts = [\"foot\"]\nstatic_friction = " + number(mu) + "\n";
  else if (kind == "joint_friction")
    text += rail +
            "[[element]]\nkind = \"joint_friction\"\nname = \"friction\"\na = \"block\"\nb = \"deck\"\ncoordinate = \"x\"\nsignal = "
            "\"half\"\nholds = " +
            number(2.0 * bound) + "\n";
  else
    text += "[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"block\"\n[[element]]\nkind = \"skate\"\nname = \"friction\"\na = "
            "\"block\"\nb = \"deck\"\naxis = [0.0, 1.0]\ngrip = " +
            number(bound) + "\n";
  return text + "[[acceptance]]\nname = \"holds\"\nevent = \"slips*\"\nelement = \"friction\"\nconsequence = \"reject\"\n";
}

} // namespace

TEST_CASE("the largest share is shown, whatever the rows") {
  for (const char* const kind : {"coulomb_stick", "joint_friction", "skate"}) {
    CAPTURE(std::string(kind));
    const Report report = judged_run(load_model_text(held_on_deck(kind, 7.0, 0.9931, 0.3, 0.1, 0.4), "share.toml"));
    CHECK(report.judgement.verdict == Verdict::hold);
    const Overview overview = overview_of(report);
    const Utilisation* const use = use_of(overview, "friction: friction");
    REQUIRE(use != nullptr);
    CHECK(use->share == doctest::Approx(0.9931).epsilon(2e-6)); // located to a millionth
    CHECK_FALSE(use->beyond);
  }
}

TEST_CASE("a guided block of rubber on a damped foot runs to its end") {
  const Report report = run_file("jerked_block_of_rubber.toml");
  CHECK_FALSE(report.run.failure.has_value());
  REQUIRE(report.run.result.events.size() == 2);
  CHECK(report.run.result.events.back().t == doctest::Approx(0.01 + 1.6 / (1.2 * 9.81)).epsilon(1e-9)); // 1.6 m/s at 1.2 g
}

TEST_CASE("what was said to be far from slipping and was near") {
  const Report half = run_file("holds_by_half_a_percent.toml");
  CHECK(half.judgement.verdict == Verdict::hold);
  const Overview shown = overview_of(half);
  REQUIRE(use_of(shown, "friction: friction") != nullptr);
  CHECK(use_of(shown, "friction: friction")->share == doctest::Approx(4.885 / (0.5 * 9.81)).epsilon(1e-3)); // the deck's pitch
  const Overview brake = overview_of(run_file("brake_at_part_pressure.toml", {"parameters.pressure=0.46"}));
  REQUIRE(use_of(brake, "brake: friction") != nullptr);
  CHECK(use_of(brake, "brake: friction")->share == doctest::Approx(45.0 / 46.0).epsilon(1e-12));
}

TEST_CASE("friction that slips is at its limit, and one without load uses nothing") {
  const Report report = judged_run(load_model_text(held_on_deck("coulomb_stick", 3.0, 1.3, 0.1, 0.1, 0.01), "share.toml"));
  CHECK(report.judgement.verdict == Verdict::reject);
  const Overview overview = overview_of(report);
  REQUIRE(use_of(overview, "friction: friction") != nullptr);
  CHECK(use_of(overview, "friction: friction")->share == 1.0);
  CHECK(use_of(overview, "friction: friction")->beyond);
  const Report idle = judged_run(load_model_text(held_on_deck("coulomb_stick", 3.0, 0.0, 0.1, 0.1, 0.01), "share.toml"));
  CHECK(use_of(overview_of(idle), "friction: friction") == nullptr);
}

// Both crates need the same share of g; with 0.39996 the upper one gives way first and relieves the lower one, with 0.3999619 the lower.
TEST_CASE("a verdict that depends on which crate slips first names both, whichever does") {
  const Report hold = run_file("crates_on_an_edge.toml");
  REQUIRE(tie_of(hold) != nullptr);
  CHECK(tie_of(hold)->text.find("'upper on lower' slips") != std::string::npos);
  CHECK(tie_of(hold)->text.find("'lower on deck' is within") != std::string::npos);
  CHECK(tie_of(hold)->text.find("the verdict is \"reject\" instead of \"hold\"") != std::string::npos);
  CHECK(hold.judgement.verdict == Verdict::open);
  const Report reject = run_file("crates_on_an_edge.toml", {"parameters.mu_top=0.3999619"});
  REQUIRE(tie_of(reject) != nullptr);
  CHECK(tie_of(reject)->text.find("'lower on deck' slips") != std::string::npos);
  CHECK(tie_of(reject)->text.find("the verdict is \"hold\" instead of \"reject\"") != std::string::npos);
  CHECK(reject.judgement.verdict == Verdict::reject);
  const Report far = run_file("crates_on_an_edge.toml", {"parameters.mu_top=0.399"});
  CHECK(tie_of(far) == nullptr);
  CHECK(far.judgement.verdict == Verdict::hold);
}

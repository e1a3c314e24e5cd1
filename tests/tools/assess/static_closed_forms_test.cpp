// Static proofs against closed forms, and what they must not claim.
#include "tests/tools/assess/static_scene.h"

#include "elements/step_lap/patch/required_pressure.h"
#include "elements/step_lap/step_lap_friction.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::assess;
using steplap::testing::block_on_deck;
using steplap::testing::machine;
using steplap::testing::one_load;

namespace {

constexpr double k_g = 9.81, k_pi = std::numbers::pi;
constexpr double k_stiffness = 1e9; // of a foot, N/m

StaticProofOptions directions(int count) {
  StaticProofOptions options;
  options.directions = count;
  return options;
}

StaticProof proof_of(const std::string& text, const Vec2& pull = {0.1, 0.0}, int count = 0) {
  return prove_statically(*machine(text), one_load(pull), directions(count));
}

const StaticLimit* first_of(const StaticRay& ray, LimitKind kind) {
  for (const StaticLimit& limit : ray.limits)
    if (limit.kind == kind) return &limit;
  return nullptr;
}

} // namespace

// A pull a at φ gives a cos φ along the deck and leaves g − a sin φ of the weight: per mass n. The block slides where a cos φ = μ n,
// and tips about its front foot where h a cos φ = b n. That foot then bears all of m n and has sunk by δ = m n/k, the block has
// turned by θ = δ/2b: b and h are those about the foot as it stands, b − h θ and h + δ/2, to second order in θ.
struct ClosedForm {
  double a = 0.0, steepness = 0.0, turned = 0.0;
};
ClosedForm block_limit(double b, double h, double mu, double angle) {
  const double along = std::abs(std::cos(angle)), up = std::sin(angle);
  const auto at = [&](double ratio) { return ratio * k_g / (along + ratio * up); };
  if (mu < b / h) return {at(mu), std::abs(up / (along + mu * up)), 0.0};
  ClosedForm form{at(b / h), std::abs(up / (along + b / h * up)), 0.0};
  for (int i = 0; i < 20 && form.a > 0.0; ++i) {
    const double sunk = 1000.0 * (k_g - form.a * up) / k_stiffness;
    form.turned = sunk / (2.0 * b);
    form.a = at((b - h * form.turned) / (h + 0.5 * sunk));
  }
  return form;
}

TEST_CASE("a block slides or tips at the closed form in every direction") {
  for (const auto& [b, h, mu] : {std::array{0.5, 1.0, 0.3}, {0.3, 1.0, 0.6}, {0.8, 0.6, 0.5}, {0.5, 1.0, 0.51}}) {
    const StaticProof proof = proof_of(block_on_deck(b, h, mu), {0.1, 0.0}, 36);
    REQUIRE(proof.polar.size() == 36);
    for (const StaticDirection& direction : proof.polar) {
      const ClosedForm form = block_limit(b, h, mu, direction.angle);
      CAPTURE(b);
      CAPTURE(mu);
      CAPTURE(direction.angle * 180.0 / k_pi);
      if (!(form.a > 0.0) || form.a > 98.1) { // straight down, or nearly so: friction grows with the pull
        CHECK(direction.ray.limits.empty());
        CHECK(direction.ray.largest == 98.1);
        continue;
      }
      REQUIRE_FALSE(direction.ray.limits.empty());
      const StaticLimit& first = direction.ray.limits.front();
      const double second_order = 4.0 * form.turned * form.turned * (h / b + b / h);
      CHECK(std::abs(first.acceleration / form.a - 1.0) <
            (1.0 + form.steepness * form.a / k_g) * (1e-9 + second_order) + 2.0 * first.error / form.a);
      if (std::abs(std::cos(direction.angle)) < 1e-9) CHECK(first.kind == LimitKind::lifts); // weightless
      else CHECK(first.kind == (mu < b / h ? LimitKind::slides : LimitKind::lifts));
      CHECK(direction.ray.limits.back().kind == LimitKind::ends);
      CHECK(direction.ray.is_explained);
    }
  }
}

// The pressure of the edge of a box is triangular where it tips: the overlap m g/k = b² θ/2 has a base b and the resultant is b/3 from the
// corner. With the lean θ the pull holds while a/g (h/2) <= w/2 - b/3 - θ h/2, whose maximum over b is at b³ = 6 h m g/k.
TEST_CASE("a box on its polygon is rejected where it tips, although no limit of an element is reached before") {
  const double w = 0.6, h = 2.0, overlap = 1000.0 * k_g / k_stiffness, base = std::cbrt(6.0 * h * overlap);
  const double tips = k_g * (w / 2 - base / 3 - h * overlap / (base * base)) / (h / 2);
  const std::string box = "[[body]]\nname = 'box'\nmass = 1000\ninertia = 363\nposition = [0, 1]\n"
                          "outline = [[-0.3, -1], [0.3, -1], [0.3, 1], [-0.3, 1]]\n"
                          "[[element]]\nkind = 'polygon_contact'\nname = 'deck'\na = 'box'\nstiffness = 1e9\ndissipation = 1\n"
                          "static_friction = 0.5\n";
  const double lean_error = 1e-2; // the closed form is of first order in the lean, 8e-3
  for (const double sign : {1.0, -1.0}) {
    CHECK(proof_of(box, {sign * tips * (1.0 - lean_error), 0.0}).verdict == Verdict::hold);
    const StaticProof tipped = proof_of(box, {sign * tips * (1.0 + lean_error), 0.0});
    CHECK(tipped.verdict == Verdict::reject);
    CHECK(tipped.reason.find(sign > 0.0 ? "('box' turning clockwise" : "('box' turning counter-clockwise") != std::string::npos);
  }
}

TEST_CASE("a load beyond the limit is rejected by what gives way, one below holds") {
  const std::string slides = block_on_deck(0.5, 1.0, 0.3), tips = block_on_deck(0.3, 1.0, 0.6);
  for (const double sign : {1.0, -1.0}) {
    CHECK(proof_of(slides, {sign * 0.299 * k_g, 0.0}).verdict == Verdict::hold);
    const StaticProof slid = proof_of(slides, {sign * 0.301 * k_g, 0.0});
    CHECK(slid.verdict == Verdict::reject);
    CHECK(slid.reason.find("'deck' slides away at 2.943") != std::string::npos);
    CHECK(proof_of(tips, {sign * 0.299 * k_g, 0.0}).verdict == Verdict::hold);
    const StaticProof tipped = proof_of(tips, {sign * 0.301 * k_g, 0.0});
    CHECK(tipped.verdict == Verdict::reject);
    CHECK(tipped.reason.find("tips over as '" + std::string(sign > 0.0 ? "rear" : "front") + " foot' lifts at 2.94") != std::string::npos);
  }
}

TEST_CASE("a symmetric machine has a symmetric picture") {
  const StaticProof proof = proof_of(block_on_deck(0.4, 0.9, 0.35), {0.1, 0.0}, 24);
  for (std::size_t i = 0; i < 24; ++i) {
    const StaticRay& ray = proof.polar[i].ray;
    const StaticRay& mirrored = proof.polar[(36 - i) % 24].ray; // 180° − angle
    REQUIRE(ray.limits.size() == mirrored.limits.size());
    for (std::size_t k = 0; k < ray.limits.size(); ++k) {
      CHECK(ray.limits[k].kind == mirrored.limits[k].kind);
      CHECK(ray.limits[k].acceleration == doctest::Approx(mirrored.limits[k].acceleration).epsilon(3e-6)); // both intervals
    }
  }
}

// The limb is held by its joint alone: what the joint bears is −m (g + p), whatever the rest of the machine does; the active part
// turns by some 1e-4 rad under it, which turns the wrench in its axes as much.
TEST_CASE("a joint slips where its limit surface says by itself") {
  const auto loaded = load_model(STEPLAP_MODELS "/paper/interference.toml");
  StaticMachine asked(*loaded);
  const auto* const friction = [&]() -> const StepLapFriction* {
    for (const FrictionUnit& unit : asked.system().frictions)
      if (const auto* own = dynamic_cast<const StepLapFriction*>(unit.friction.get())) return own;
    return nullptr;
  }();
  REQUIRE(friction);
  const double mass = 9000.0;
  for (const double angle : {-90.0, -60.0, 0.0, 45.0, 180.0}) {
    const Vec2 direction(std::cos(angle * k_pi / 180.0), std::sin(angle * k_pi / 180.0));
    const StaticRay ray = grow_pull(asked, direction, 98.1);
    const StaticLimit* const slips = first_of(ray, LimitKind::slips);
    REQUIRE_MESSAGE(slips, angle);
    const Vec2 load = mass * (slips->acceleration * direction + Vec2(0.0, -k_g));
    const Probe there = asked.ramped(0.999 * slips->acceleration * direction);
    std::vector<Motion<double>> motion;
    place_bodies(there.rest->state.q, there.rest->state.v, motion);
    const Patch patch = friction->patch_at(friction->pose_of(motion.data()), GripLaw::holding);
    CHECK_MESSAGE(required_pressure(patch, Vec3(load.x(), load.y(), 0.0)).u == doctest::Approx(1.0).epsilon(1e-3), angle);
  }
}

TEST_CASE("what a rest cannot prove is open") {
  SUBCASE("weightless, nothing holds the block") {
    const StaticProof proof = proof_of(block_on_deck(0.5, 1.0, 0.3), {0.0, k_g});
    CHECK(proof.verdict == Verdict::open);
    CHECK(proof.reason.find("nothing holds 'block'") != std::string::npos);
  }
  SUBCASE("nothing holds the vehicle") {
    const StaticProof proof = proof_of("[[body]]\nname = 'sledge'\nmass = 1000\ninertia = 100\n[[element]]\nkind = 'prismatic'\nname = "
                                       "'rail'\na = 'sledge'\nb = 'ground'\naxis = [1, 0]\n",
                                       {1.0, 0.0});
    CHECK(proof.verdict == Verdict::open);
    CHECK(proof.reason.find("Hold its vehicle by a drive") != std::string::npos);
  }
  SUBCASE("nothing is asked") {
    const StaticProof proof =
        proof_of("[[body]]\nname = 'post'\nmass = 10\ninertia = 1\n[[element]]\nkind = 'weld'\nname = 'foot'\na = 'post'\nb = 'ground'\n",
                 {1.0, 0.0});
    CHECK(proof.verdict == Verdict::open);
    CHECK(proof.reason.find("nothing was asked") != std::string::npos);
  }
  SUBCASE("a stop bears with friction or without it") {
    // Friction μ m g = 3.9 kN of the 5.9 kN that pull; the spring bears the rest, or after a shake all of it.
    const std::string stop = "[[element]]\nkind = 'spring_damper'\nname = 'stop'\na = { body = 'block', at = [0, 0.1] }\nb = { body = "
                             "'ground', at = [0, 0.1] }\n"
                             "axis = [1, 0]\nstiffness = 1e7\ndamping = 1e4\n[[acceptance]]\nname = 'stop'\nchannel = "
                             "'stop.force'\nconsequence = 'reject'\nwithin = ";
    const std::string block = block_on_deck(0.9, 0.5, 0.4);
    const Vec2 pull(0.6 * k_g, 0.0);
    CHECK(proof_of(block + stop + "1e3\n", pull).verdict == Verdict::reject);
    const StaticProof between = proof_of(block + stop + "4e3\n", pull);
    CHECK(between.verdict == Verdict::open);
    CHECK(between.reason.find("friction allows several rests") != std::string::npos);
    const StaticProof enough = proof_of(block + stop + "6e3\n", pull);
    CHECK(enough.verdict == Verdict::hold);
    const auto reaction = std::find_if(enough.cases[0].reactions.begin(), enough.cases[0].reactions.end(),
                                       [](const StaticReaction& r) { return r.name == "stop.force"; });
    REQUIRE(reaction != enough.cases[0].reactions.end());
    // The worst of the ways is the one without friction; the spring's end is off the feet's line, so that the block turns a little.
    CHECK(std::abs(reaction->value) == doctest::Approx(0.6 * 1000.0 * k_g).epsilon(1e-3));
    CHECK(reaction->allowed == 6e3);
  }
}

TEST_CASE("joints that would slip are rejected with their margin") {
  const auto loaded = load_model(STEPLAP_MODELS "/paper/interference.toml", {"core.core.pressure=0.02 MPa"});
  const StaticProof proof = prove_statically(*loaded, one_load({0.0, -k_g}), directions(0));
  CHECK(proof.verdict == Verdict::reject);
  REQUIRE(proof.cases[0].joints.size() == 2);
  // 411.9 kN at 0.1 MPa; two weights of 9 t. The limb's own lever arms are none in translation.
  for (const StaticJoint& joint : proof.cases[0].joints)
    CHECK(joint.margin == doctest::Approx(0.2 * 411894.0 / (2.0 * 9000.0 * k_g)).epsilon(1e-3));
}

// An elastic joint yields before it slides, in the search as in a run: where it lets go is its limit surface's matter alone.
TEST_CASE("an elastic joint slips where a rigid one does") {
  const std::string file = STEPLAP_MODELS "/paper/weak_clamping.toml";
  const auto slip = [&](const std::vector<std::string>& overrides) {
    const auto loaded = load_model(file, overrides);
    StaticMachine asked(*loaded);
    const StaticRay ray = grow_pull(asked, {0.0, -1.0}, 20.0);
    const StaticLimit* const limit = first_of(ray, LimitKind::slips);
    REQUIRE(limit);
    return limit->acceleration;
  };
  const double rigid = slip({});
  // The limb sinks by its weight over the stiffness, 0.1 mm; friction in translation does not change with the place of the overlap.
  CHECK(slip({"element.front joint.tangential_stiffness=1e9", "element.back joint.tangential_stiffness=1e9"}) ==
        doctest::Approx(rigid).epsilon(1e-5));
}

// Friction at its bound and the stop share the pull: F = m (a − μ g). Feet a hundred times stiffer than the stop make the symmetric
// part of the stiffness indefinite while it slides, and the rest is stable all the same.
TEST_CASE("what slides comes to rest where the stop bears what friction does not") {
  for (const double stiffness : {1e6, 1e7, 1e8, 1e9})
    for (const double mu : {0.1, 0.4, 0.55})
      for (const double sign : {1.0, -1.0}) {
        const std::string stop = "[[element]]\nkind = 'spring_damper'\nname = 'stop'\na = { body = 'block', at = [0, 0.1] }\nb = { body = "
                                 "'ground', at = [0, 0.1] }\naxis = [1, 0]\nstiffness = " +
                                 std::to_string(stiffness) + "\ndamping = 1e4\n";
        const auto loaded = machine(block_on_deck(0.9, 0.5, mu, stop));
        StaticMachine asked(*loaded);
        const Probe probe = asked.ramped({sign * 0.6 * k_g, 0.0});
        CAPTURE(stiffness);
        CAPTURE(mu);
        REQUIRE(probe.rest);
        CHECK(probe.rest->slid.size() == 1);
        // The stop has been strained by what friction gave before it slid, with the block's turn of 1e-6: a millionth.
        CHECK(asked.value(probe, "stop.force") == doctest::Approx(-sign * 1000.0 * (0.6 - mu) * k_g).epsilon(1e-4));
        CHECK(asked.value(probe, "deck.friction") == doctest::Approx(-sign * 1000.0 * mu * k_g).epsilon(1e-4));
      }
}

// A block on feet 2 b apart, its centre of gravity h above them, tips at b/h g if friction holds. EN 12195-1 asks for 0.6 g sideways of
// what may tip. The feet sink by micrometres, so tipping starts within 1e-4 of b/h, far less than the distance of 0.58 and 0.62 from 0.6.
TEST_CASE("the road asks for 0.6 g to both sides of a load that may tip") {
  StaticProofOptions transverse;
  transverse.plane = Plane::transverse;
  for (const double b : {0.55, 0.58}) {
    const StaticProof tips = prove_statically(*machine(block_on_deck(b, 1.0, 0.8)), static_preset("road"), transverse);
    CHECK(tips.verdict == Verdict::reject);
    REQUIRE(tips.cases.size() == 4);
    for (const StaticCase& load : tips.cases) CHECK((load.verdict == Verdict::hold) == (load.load.pull.norm() < b * k_g));
  }
  CHECK(prove_statically(*machine(block_on_deck(0.62, 1.0, 0.8)), static_preset("road"), transverse).verdict == Verdict::hold);
}

namespace {

// A block of 1 t on a rail with friction of 300 N.
std::string block_on_rail(const std::string& more) {
  return "[[body]]\nname = 'block'\nmass = 1000\ninertia = 100\nposition = [0, 0.5]\n"
         "[[element]]\nkind = 'prismatic'\nname = 'rail'\na = 'block'\nb = { body = 'ground', at = [0, 0.5] }\n" +
         more;
}
std::string brake(double holds) {
  return "[[element]]\nkind = 'joint_friction'\nname = 'brake'\na = 'block'\nb = { body = 'ground', at = [0, 0.5] }\ncoordinate = 'x'\n"
         "holds = " +
         std::to_string(holds) + "\n";
}
std::string tie(double strength, const std::string& more = "") {
  return "[[element]]\nkind = 'tie'\nname = 'bolt'\na = 'block'\nb = { body = 'ground', at = [-1, 0.5] }\nacts = 'both'\n"
         "stiffness = 1e7\nstrength = " +
         std::to_string(strength) + "\n" + more;
}

} // namespace

TEST_CASE("a tie gives way at its strength") {
  const StaticProof held = proof_of(block_on_rail(tie(1000.0)), {0.99, 0.0}, 4), broken = proof_of(block_on_rail(tie(1000.0)), {1.01, 0.0});
  CHECK(held.verdict == Verdict::hold);
  const StaticLimit* const limit = first_of(held.polar[0].ray, LimitKind::breaks);
  REQUIRE(limit);
  CHECK(limit->acceleration == doctest::Approx(1.0).epsilon(1e-5));
  CHECK(broken.verdict == Verdict::reject);
  CHECK(broken.reason.find("does not break") != std::string::npos);
  // Without a criterion of its own the rest is that of a machine which does not exist.
  CHECK(proof_of(block_on_rail(tie(1000.0, "consequence = 'none'\n")), {1.01, 0.0}).verdict == Verdict::open);
}

TEST_CASE("actions: a proof does not follow them, and says so where one would act") {
  const auto action = [](const std::string& when) {
    return block_on_rail(brake(300.0)) + "[[action]]\nname = 'worn'\nwhen = \"" + when + "\"\ndo = ['release brake']\n";
  };
  CHECK(proof_of(action("block.x > '1 m'"), {0.2, 0.0}).verdict == Verdict::hold); // the condition is met nowhere
  for (const char* when : {"0 s", "5 s", "t >= '0 s'", "block.x < '1 m'", "brake slips forward"}) {
    CAPTURE(when);
    const StaticProof proof = proof_of(action(when), {0.2, 0.0});
    CHECK(proof.verdict == Verdict::open);
    CHECK(proof.reason.find("action 'worn'") != std::string::npos);
  }
}

TEST_CASE("criteria that forbid slip or lifting are judged, and findings of a run cap a proof") {
  const std::string deck = block_on_deck(0.5, 1.0, 0.3), chain = "[[element]]\nkind = 'spring_damper'\nname = 'chain'\na = 'block'\n"
                                                                 "b = { body = 'ground', at = [-1, 1] }\nstiffness = 1e7\n";
  const std::string never = "[[acceptance]]\nname = 'no slip'\nelement = 'deck'\nevent = 'slips*'\nconsequence = 'reject'\n";
  CHECK(proof_of(deck + chain, {0.5 * k_g, 0.0}).verdict == Verdict::hold);
  const StaticProof slid = proof_of(deck + chain + never, {6.0 * k_g, 0.0});
  CHECK(slid.verdict == Verdict::reject);
  CHECK(slid.reason.find("no 'slips*' of 'deck'") != std::string::npos);
  CHECK(slid.unasked.empty());
  const StaticProof still = proof_of(deck + never, {0.2 * k_g, 0.0});
  CHECK(still.verdict == Verdict::hold);
  CHECK(still.cases[0].criteria.size() == 1);
  const StaticProof rubber = proof_of(block_on_deck(0.5, 0.2, 3.0));
  CHECK(rubber.verdict == Verdict::open);
  REQUIRE_FALSE(rubber.caps.empty());
  CHECK(rubber.reason.find("unlike any dry contact") != std::string::npos);
}

// A bushing that is unloaded in the given pose holds the block there at 1 g upwards: the feet open or touch, as rounding will.
TEST_CASE("an event that is forbidden is open within rounding of its limit") {
  const std::string bushed = block_on_deck(0.5, 1.0, 0.3,
                                           "[[element]]\nkind = 'bushing'\nname = 'mount'\na = 'block'\nstiffness = [1e5, 1e5]\n"
                                           "rotational_stiffness = 1e5\nb = { body = 'ground', at = [0, 1] }\n"),
                    never = "[[acceptance]]\nname = 'stands'\nelement = '* foot'\nevent = 'opens'\nconsequence = 'reject'\n";
  CHECK(proof_of(bushed + never, {0.0, 0.999 * k_g}).verdict == Verdict::hold);
  const StaticProof at_limit = proof_of(bushed + never, {0.0, k_g});
  CHECK(at_limit.verdict == Verdict::open);
  CHECK(at_limit.reason.find("within rounding of its limit") != std::string::npos);
  CHECK(proof_of(bushed, {0.0, k_g}).verdict == Verdict::hold);
  CHECK(proof_of(bushed + never, {0.0, 1.001 * k_g}).verdict == Verdict::reject);
}

TEST_CASE("a foot beyond the edge of what carries it proves nothing") {
  const std::string pallet = "[[body]]\nname = 'pallet'\nmass = 100\ninertia = 10\nposition = [0, -0.1]\n"
                             "outline = [[-0.4, -0.1], [0.4, -0.1], [0.4, 0.1], [-0.4, 0.1]]\n"
                             "[[element]]\nkind = 'weld'\nname = 'fixed'\na = 'pallet'\n";
  std::string deck = block_on_deck(0.5, 1.0, 0.3);
  for (std::size_t at = 0; (at = deck.find("body = 'ground'", at)) != std::string::npos;) deck.replace(at, 15, "body = 'pallet'");
  const StaticProof proof = proof_of(pallet + deck);
  CHECK(proof.verdict == Verdict::open);
  CHECK(proof.reason.find("beyond the edge of 'pallet'") != std::string::npos);
}

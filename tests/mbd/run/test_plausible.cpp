// Values that are hardly meant, each found by its own rule; and ordinary scenes, in which none is found.
#include "mbd/base/counter_random.h"
#include "mbd/base/number_text.h"
#include "mbd/run/findings.h"
#include "mbd/run/report.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace steplap;

namespace {

RunOptions without_errors() {
  RunOptions options;
  options.estimating = Estimating::never;
  return options;
}

Report run_of(const std::string& text) { return judged_run(load_model_text(text, "scene.toml"), without_errors()); }
Report low_loader(const std::vector<std::string>& overrides) {
  return judged_run(load_model(std::string(STEPLAP_TEST_DATA) + "/loads/low_loader.toml", overrides), without_errors());
}

const Finding* found(const std::vector<Finding>& findings, const std::string& code) {
  const auto at = std::find_if(findings.begin(), findings.end(), [&](const Finding& f) { return f.code == code; });
  return at == findings.end() ? nullptr : &*at;
}

// The n-th number of a stream, in (0, 1).
double drawn(std::uint32_t stream, std::uint64_t n, std::uint32_t index = 0) { return counter_uniform(1, stream, n, index); }

std::string number(double value) { return number_text(value); }

// Two bodies that are joined by an element with friction.
std::string scene_with_friction(const std::string& kind, double friction, const std::string& source) {
  const std::string mu = number(friction), from = source.empty() ? "" : "source = \"" + source + "\"\n";
  const std::string bodies = "[[body]]\nname = \"a\"\nmass = 1.0\ninertia = 1.0\nposition = [0.0, 0.5]\n"
                             "outline = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]\n"
                             "[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\nposition = [3.0, 0.5]\n";
  if (kind == "coulomb_stick")
    return bodies + "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot\"\na = \"a\"\nstiffness = 1e6\n" +
           "[[element]]\nkind = \"coulomb_stick\"\nname = \"x\"\ncontacts = [\"foot\"]\nstatic_friction = " + mu + "\n" + from;
  if (kind == "polygon_contact")
    return bodies + "[[element]]\nkind = \"polygon_contact\"\nname = \"x\"\na = \"a\"\nnormal = [0.0, 1.0]\nstiffness = 1e8\n" +
           "static_friction = " + mu + "\n" + from;
  if (kind == "band")
    return bodies + "[[element]]\nkind = \"band\"\nname = \"x\"\na = \"a\"\nb = { body = \"ground\", at = [3.0, -2.0] }\ndrum = \"b\"\n" +
           "radius = 0.1\nstiffness = 1e4\ndamping = 10.0\nfriction = " + mu + "\n" + from;
  return bodies + "[[element]]\nkind = \"belt\"\nname = \"x\"\na = \"a\"\nb = \"b\"\nradius_a = 0.2\nradius_b = 0.3\nstiffness = 1e4\n" +
         "damping = 10.0\nfriction_a = 0.3\nfriction_b = " + mu + "\n" + from;
}

} // namespace

TEST_CASE("friction that dry contacts do not have needs a source, whatever element has it") {
  for (const char* const kind : {"coulomb_stick", "polygon_contact", "band", "belt"})
    for (std::uint64_t n = 0; n < 40; ++n) {
      const double mu = 0.05 + 3.0 * drawn(0, n, kind[0]);
      const std::string source = drawn(1, n, kind[0]) < 0.3 ? "measured on the dock" : "";
      CAPTURE(std::string(kind));
      CAPTURE(mu);
      CAPTURE(source);
      const std::vector<Finding> findings = findings_before(*load_model_text(scene_with_friction(kind, mu, source), "scene.toml"));
      const Finding *const high = found(findings, "high_friction"), *const implausible = found(findings, "implausible_friction");
      const Finding* const by_source = found(findings, "friction_by_source");
      CHECK((by_source != nullptr) == (mu > 0.8 && !source.empty()));
      CHECK((high != nullptr) == (mu > 0.8 && mu < 1.2 && source.empty()));
      CHECK((implausible != nullptr) == (mu >= 1.2 && source.empty()));
      if (by_source) {
        CHECK(by_source->level == FindingLevel::note);
        CHECK(by_source->text.ends_with("Its source: measured on the dock"));
      }
      if (high) CHECK_FALSE(caps_verdict(*high));
      if (implausible) CHECK(caps_verdict(*implausible));
    }
}

TEST_CASE("gravity of no planet caps the verdict") {
  const std::string body = "[[body]]\nname = \"a\"\nmass = 1.0\ninertia = 1.0\n";
  for (const auto& [gravity, is_found] : {std::pair("[0, -9.81]", false),
                                          {"[0, 0]", false},
                                          {"[6.9, -6.9]", false},
                                          {"[0, -1.62]", false},
                                          {"[0, -98.1]", true},
                                          {"[0, -0.3]", false}}) {
    CAPTURE(gravity);
    const std::vector<Finding> findings =
        findings_before(*load_model_text("gravity = " + std::string(gravity) + "\n" + body, "scene.toml"));
    const Finding* const finding = found(findings, "implausible_gravity");
    CHECK((finding != nullptr) == is_found);
    if (finding) CHECK(caps_verdict(*finding));
  }
}

TEST_CASE("gravity that points upwards caps the verdict, except where the pull of a load case lifts") {
  const std::string scene = "[[body]]\nname = \"a\"\nmass = 1.0\ninertia = 1.0\n[[case]]\nname = \"heave\"\npull = [0.0, 12.0]\nsource = "
                            "\"a code\"\n";
  const auto is_found = [&](const std::string& gravity, const std::vector<std::string>& overrides) {
    const std::vector<Finding> findings =
        findings_before(*load_model_text("gravity = " + gravity + "\n" + scene, "scene.toml", overrides, program_catalogue()));
    const Finding* const finding = found(findings, "gravity_upwards");
    if (finding) CHECK(caps_verdict(*finding));
    return finding != nullptr;
  };
  CHECK(is_found("[0, 9.81]", {}));
  CHECK_FALSE(is_found("[-1.7, 9.66]", {})); // a scene turned upside down and more
  CHECK_FALSE(is_found("[0, -9.81]", {}));
  CHECK_FALSE(is_found("[0, 0]", {}));
  CHECK_FALSE(is_found("[9.81, 0.1]", {}));
  CHECK_FALSE(is_found("[0, -9.81]", {"gravity=[0, 2.19]"})); // −9.81 + 12
  CHECK(is_found("[0, 9.81]", {"gravity=[0, 21.81]"}));       // 9.81 + 12
  CHECK(is_found("[0, -9.81]", {"gravity=[0, 12.5]"}));       // more than the pull lifts
}

TEST_CASE("a load to which nothing gives a value leaves the verdict open, one of zero that is stated does not") {
  const auto run = [](const std::string& fields, const std::string& more = "") {
    return run_of("[[body]]\nname = \"a\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"spring_damper\"\nname = \"s\"\na = \"a\"\n"
                  "axis = [0.0, 1.0]\nstiffness = 1e4\n[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"a\"\n" +
                  fields + "[[acceptance]]\nname = \"stays\"\nchannel = \"a.y\"\nwithin = 1.0\n" + more);
  };
  const Report silent = run("");
  CHECK(silent.judgement.verdict == Verdict::open);
  CHECK(found(silent.findings, "load_without_value"));
  for (const char* const fields : {"force = [0, 0]\n", "couple = 0.0\n", "force = [0, -1.0]\n"}) {
    CAPTURE(fields);
    const Report report = run(fields);
    CHECK(report.judgement.verdict == Verdict::hold);
    CHECK_FALSE(found(report.findings, "load_without_value"));
  }
  CHECK_FALSE(found(run("", "[[action]]\nname = \"on\"\nwhen = \"t > '0.1 s'\"\ndo = [\"set push.force = [0 N, -1 N]\"]\n").findings,
                    "load_without_value"));
}

TEST_CASE("a pulse that nothing uses leaves the verdict open where nothing else loads the machine") {
  const auto run = [](const std::string& more) {
    return run_of("[[body]]\nname = \"a\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"spring_damper\"\nname = \"s\"\na = \"a\"\n"
                  "axis = [0.0, 1.0]\nstiffness = 1e4\n[[signal]]\nname = \"jolt\"\nkind = \"half_sine\"\npeak = 1.0\nduration = 0.1\n"
                  "[[acceptance]]\nname = \"stays\"\nchannel = \"a.y\"\nwithin = 1.0\n" +
                  more);
  };
  const std::string load = "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"a\"\n";
  const Report idle = run("");
  CHECK(found(idle.findings, "no_load"));
  CHECK(idle.judgement.verdict == Verdict::open);
  for (const std::string& used : {load + "force_y = \"jolt\"\n", load + "force = [0.0, 1.0]\n",
                                  std::string("[[element]]\nkind = \"force\"\nname = \"push\"\na = \"a\"\ncoordinate = \"y\"\n"
                                              "formula = \"jolt * '1 N'\"\n")}) {
    CAPTURE(used);
    CHECK_FALSE(found(run(used).findings, "no_load"));
  }
}

TEST_CASE("every kind with a coefficient of friction can say where it comes from, but tyres and sheets") {
  // Treads of tyres grip with more than 1; sheets of cores have ranges of their own.
  const std::set<std::string> exempt = {"tyre", "step_lap_interface"};
  std::size_t count = 0;
  for (const ElementKind* const kind : program_catalogue().elements) {
    const auto is_coefficient = [](const Field& field) {
      return field.type == FieldType::number && field.unit.empty() && field.name.find("friction") != std::string::npos;
    };
    const std::vector<Field>& fields = kind->fields.fields();
    if (std::none_of(fields.begin(), fields.end(), is_coefficient)) continue;
    ++count;
    CAPTURE(kind->name);
    CHECK((kind->fields.find("source") != nullptr) == (exempt.count(kind->name) == 0));
  }
  CHECK(count >= 5);
}

TEST_CASE("a load that does not slide by an implausible friction is no load that holds") {
  for (const char* const mu : {"1.2", "3", "30"})
    CHECK(low_loader({std::string("element.floor friction.static_friction=") + mu}).judgement.verdict == Verdict::open);
  CHECK(low_loader({"element.floor friction.static_friction=0.9"}).judgement.verdict == Verdict::hold); // a warning
  CHECK(low_loader({"element.floor friction.static_friction=3", "element.floor friction.source=rubber"}).judgement.verdict ==
        Verdict::hold);
  CHECK(low_loader({}).findings.empty());
}

TEST_CASE("friction that an action sets is held to the same") {
  const auto scene = [](const std::string& mu) {
    return load_model_text(scene_with_friction("coulomb_stick", 0.3, "") +
                               "[[action]]\nname = \"q\"\nwhen = \"0.1 s\"\ndo = [\"set "
                               "x.static_friction = " +
                               mu + "\"]\n[simulation]\nend = 1.0\n",
                           "scene.toml");
  };
  CHECK(found(findings_before(*scene("3")), "implausible_friction"));
  CHECK(found(findings_before(*scene("0.9")), "high_friction"));
  CHECK_FALSE(found(findings_before(*scene("0.4")), "high_friction"));
}

TEST_CASE("a radius of gyration far beyond all that is known of a body is found, and none of an ordinary body is") {
  CHECK(low_loader({"body.tank.mass=40"}).judgement.verdict == Verdict::open);
  // A body on two springs of random distance; its radius of gyration is between a tenth and three times that of the springs' ends.
  const auto scene = [](double arm, double gyration, const std::string& more) {
    return "[[body]]\nname = \"b\"\nmass = 10.0\ninertia = " + number(10.0 * gyration * gyration) + "\nposition = [0.0, 1.0]\n" +
           "[[element]]\nkind = \"spring_damper\"\nname = \"left\"\na = { body = \"b\", at = [" + number(-arm) +
           ", 1.0] }\nb = { body = \"ground\", at = [" + number(-arm) + ", 0.0] }\nstiffness = 1e5\ndamping = 100.0\n" +
           "[[element]]\nkind = \"spring_damper\"\nname = \"right\"\na = { body = \"b\", at = [" + number(arm) +
           ", 1.0] }\nb = { body = \"ground\", at = [" + number(arm) + ", 0.0] }\nstiffness = 1e5\ndamping = 100.0\n" + more;
  };
  for (std::uint64_t n = 0; n < 60; ++n) {
    const double arm = std::pow(10.0, -1.0 + 2.0 * drawn(2, n)), ratio = std::pow(10.0, -1.0 + 1.5 * drawn(3, n));
    CAPTURE(arm);
    CAPTURE(ratio);
    const auto code_of = [&](double gyration, const std::string& more = "") {
      return found(findings_before(*load_model_text(scene(arm, gyration, more), "scene.toml")), "inertia_beyond_places") != nullptr;
    };
    CHECK_FALSE(code_of(arm * ratio));
    const double far = 40.0 * (arm + 1.0) * (1.0 + drawn(4, n)); // the scene is 2 arm wide and 1 m high
    CHECK(code_of(far));
    // A guide that does not let a body turn leaves its inertia nothing to act on.
    CHECK_FALSE(code_of(far, "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"b\"\nb = { body = \"ground\", at = [0.0, 1.0] }\n"
                             "axis = [0.0, 1.0]\n"));
  }
  // A flywheel that is known by its crank pin alone, 20 times nearer than its radius of gyration, with a rod of ordinary length.
  CHECK_FALSE(found(findings_before(*load_model_text("[[body]]\nname = \"wheel\"\nmass = 100.0\ninertia = 25.0\n"
                                                     "[[element]]\nkind = \"revolute\"\nname = \"shaft\"\na = \"wheel\"\n"
                                                     "[[element]]\nkind = \"spring_damper\"\nname = \"rod\"\na = { body = \"wheel\", at = "
                                                     "[0.025, 0.0] }\nb = { body = \"ground\", at = [0.6, 0.0] }\nstiffness = 1e4\n",
                                                     "scene.toml")),
                    "inertia_beyond_places"));
}

TEST_CASE("a pad whose modulus is assumed is noted, one with a document is not, and neither caps a verdict") {
  const auto pad = [](const std::string& material) {
    return "[[body]]\nname = \"b\"\nmass = 10.0\ninertia = 1.0\n[[element]]\nkind = \"spring_damper\"\nname = \"pad\"\na = \"b\"\n"
           "axis = [0.0, 1.0]\narea = 0.01\nthickness = 0.02\nmaterial = \"" +
           material + "\"\n";
  };
  const std::vector<Finding> findings = findings_before(*load_model_text(pad("rubber"), "scene.toml"));
  const Finding* const note = found(findings, "assumed_pad");
  REQUIRE(note);
  CHECK(note->text.starts_with("'pad': the modulus of 'rubber', 4 MPa, is assumed"));
  CHECK_FALSE(caps_verdict(*note));
  CHECK_FALSE(found(findings_before(*load_model_text(pad("densified wood"), "scene.toml")), "assumed_pad"));
}

TEST_CASE("degrees without their unit, limits in another unit and a rest far from the poses are noted, and cap nothing") {
  const Report turned = low_loader({"body.active part.angle=30"});
  const Finding* const turn = found(turned.findings, "more_than_a_turn");
  REQUIRE(turn);
  CHECK(turn->text.starts_with("body.active part.angle = 30 rad is 4.77 turns"));
  CHECK_FALSE(caps_verdict(*turn));
  CHECK_FALSE(found(low_loader({"body.active part.angle=30 deg"}).findings, "more_than_a_turn"));
  CHECK_FALSE(found(low_loader({"body.active part.angle=390 deg"}).findings, "more_than_a_turn")); // a unit was given
  const Report far = low_loader({"acceptance.slide of the load.within=20"});
  CHECK(far.judgement.verdict == Verdict::hold);
  CHECK(found(far.findings, "limit_far_beyond"));
  for (const char* const limit : {"0.02", "20 mm", "20 m"}) // near, or with the unit that is meant
    CHECK_FALSE(found(low_loader({std::string("acceptance.slide of the load.within=") + limit}).findings, "limit_far_beyond"));
  // A mass on a spring sinks by m g / k = 98.1 mm and 0.981 mm: the body is 2 m large by its radius of gyration of 1 m.
  for (const auto& [stiffness, is_far] : {std::pair{"1e3", true}, std::pair{"1e5", false}}) {
    const Report report = run_of(std::string("[simulation]\nend = 0.01\ninitial = \"equilibrium\"\n[[body]]\nname = \"b\"\nmass = 10.0\n"
                                             "inertia = 10.0\n[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"b\"\n"
                                             "axis = [0.0, 1.0]\n[[element]]\nkind = \"spring_damper\"\nname = \"s\"\na = \"b\"\n"
                                             "b = { body = \"ground\", at = [0.0, -1.0] }\naxis = [0.0, 1.0]\nstiffness = ") +
                                 stiffness + "\n");
    const Finding* const rest = found(report.findings, "rest_far_from_poses");
    CHECK((rest != nullptr) == is_far);
    if (rest) CHECK(rest->text.find("'b': it moves by 98.1 mm and turns by 0 rad") != std::string::npos);
  }
}

TEST_CASE("a part that slides out through the wall of the part it began in has left the range of the model") {
  // On a floor without ends it slides v²/(2 µ g) far, from the middle of a box whose wall is 1 m away; it is 0.4 m wide.
  const double mu = 0.25, gravity = 9.81;
  for (const double way : {0.2, 0.6, 0.79, 0.85, 1.4, 3.0}) {
    CAPTURE(way);
    const Report report =
        run_of("[simulation]\nend = 3.0\n[[body]]\nname = \"tank\"\nfixed = true\n"
               "outline = [[-1.0, -0.1], [1.0, -0.1], [1.0, 1.0], [0.9, 1.0], [0.9, 0.0], [-0.9, 0.0], [-0.9, 1.0], [-1.0, 1.0]]\n"
               "[[body]]\nname = \"limb\"\nmass = 100.0\ninertia = 5.0\nposition = [0.0, 0.2]\nvelocity = [" +
               number(std::sqrt(2.0 * mu * gravity * way)) +
               ", 0.0]\noutline = [[-0.2, -0.15], [0.2, -0.15], [0.2, 0.2], [-0.2, 0.2]]\n"
               "[[element]]\nkind = \"unilateral_contact\"\nname = \"left\"\na = { body = \"limb\", at = [-0.2, 0.05] }\nb = { body = "
               "\"ground\", at = [0.0, 0.05] }\nnormal = [0.0, 1.0]\nstiffness = 1e8\ndamping = 1e5\npreload = 490.5\n"
               "[[element]]\nkind = \"unilateral_contact\"\nname = \"right\"\na = { body = \"limb\", at = [0.2, 0.05] }\nb = { body = "
               "\"ground\", at = [0.0, 0.05] }\nnormal = [0.0, 1.0]\nstiffness = 1e8\ndamping = 1e5\npreload = 490.5\n"
               "[[element]]\nkind = \"coulomb_stick\"\nname = \"floor\"\ncontacts = [\"left\", \"right\"]\nstatic_friction = 0.25\n"
               "[[acceptance]]\nname = \"upright\"\nchannel = \"limb.theta\"\nwithin = 0.1\n");
    const Finding* const outside = found(report.findings, "part_outside");
    // Its edge, 0.2 m before its middle, is beyond the wall's outer face by more than a hundredth of the box, whose diagonal is 2.28 m.
    CHECK((outside != nullptr) == (way > 0.8 + 0.0228));
    if (outside) CHECK(report.judgement.verdict == Verdict::open);
    else CHECK(report.judgement.verdict == Verdict::hold);
  }
}

TEST_CASE("a model that asks for nothing is not open about anything") {
  // Its inertia is that of nothing real, which would cap a verdict.
  const std::string scene = "[simulation]\nend = 0.1\n[[body]]\nname = \"b\"\nmass = 40.0\ninertia = 60000.0\n[[element]]\nkind = "
                            "\"spring_damper\"\nname = \"s\"\na = { body = \"b\", at = [0.5, 0.0] }\nb = { body = \"ground\", at = [0.5, "
                            "1.0] }\nstiffness = 1e6\n";
  const Report nothing = run_of(scene);
  CHECK(found(nothing.findings, "inertia_beyond_places"));
  CHECK(nothing.judgement.caps.empty());
  const Report asked = run_of(scene + "[[acceptance]]\nname = \"turn\"\nchannel = \"b.theta\"\nwithin = 1.0\n");
  CHECK(asked.judgement.caps.size() == 1);
  CHECK(asked.judgement.verdict == Verdict::open);
}

TEST_CASE("a tolerance so small that no finer run could tell its error is raised, and that is noted") {
  const auto run = [](const std::string& tolerance, const std::string& integrator) {
    return judged_run(load_model_text("[simulation]\nend = 1.0\nstep = 1e-3\ntolerance = " + tolerance + "\nintegrator = \"" + integrator +
                                          "\"\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 0.1\nposition = [0.5, 0.0]\n"
                                          "[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = { body = \"b\", at = [0.0, 0.0] }\n",
                                      "scene.toml"));
  };
  for (const char* const integrator : {"auto", "dop853", "tsit5", "rodas5p"}) {
    CAPTURE(integrator);
    const Report least = run("1e-14", integrator);
    const Finding* const raised = found(least.findings, "tolerance_below_rounding");
    REQUIRE(raised);
    CHECK(raised->text.find("tolerance = 1e-14 lies below rounding, and is taken as 1e-13") != std::string::npos);
    REQUIRE(least.estimate.errors);
    CHECK(least.estimate.errors->reason_unknown == "");
    CHECK_FALSE(found(run("1e-10", integrator).findings, "tolerance_below_rounding"));
  }
  CHECK_FALSE(found(run("1e-14", "rk4").findings, "tolerance_below_rounding")); // it has no use for a tolerance
}

// ω at the centre of gravity of an arm about a pin without the velocity ω r: assembly keeps the angular momentum about the pin.
TEST_CASE("a velocity that the joints do not permit caps the verdict, one that they permit does not") {
  const std::string arm = "simulation.end = 0.1\n[[body]]\nname = \"arm\"\nmass = 2.0\ninertia = 0.5\nposition = [1.0, 0.0]\n",
                    pin = "[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = { body = \"arm\", at = [0.0, 0.0] }\n"
                          "[[acceptance]]\nname = \"swing\"\nchannel = \"arm.omega\"\nwithin = \"10 rad/s\"\n";
  const Report changed = run_of(arm + "angular_velocity = 2.0\n" + pin);
  REQUIRE(found(changed.findings, "velocity_changed"));
  CHECK(found(changed.findings, "velocity_changed")->text.find("2 rad/s") != std::string::npos);
  CHECK(changed.judgement.verdict == Verdict::open);
  CHECK_FALSE(found(run_of(arm + "angular_velocity = 2.0\nvelocity = [0.0, 2.0]\n" + pin).findings, "velocity_changed"));
  CHECK_FALSE(found(run_of("simulation.velocity = [2.0, 0.0]\n" + arm + pin).findings, "velocity_changed")); // common to all bodies
}

TEST_CASE("a rest that is found by overturning a body caps the verdict") {
  const auto box = [](double pull) {
    std::string text = "gravity = [" + number(pull) +
                       ", -9.81]\nsimulation = { end = 0.1, initial = \"equilibrium\" }\n"
                       "[[body]]\nname = \"box\"\nmass = 1000.0\ninertia = 500.0\nposition = [0.0, 1.0]\n";
    for (const std::string x : {"-0.4", "0.4"})
      text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot " + x + "\"\na = { body = \"box\", at = [" + x +
              ", 0.0] }\nstiffness = 1e7\ndamping = 1e5\n";
    return text + "[[element]]\nkind = \"coulomb_stick\"\nname = \"floor\"\ncontacts = [\"foot -0.4\", \"foot 0.4\"]\n"
                  "static_friction = 0.8\n[[acceptance]]\nname = \"stays\"\nchannel = \"box.x\"\nwithin = \"5 m\"\n";
  };
  const Report overturned = run_of(box(6.0));
  CHECK(found(overturned.findings, "start_overturned"));
  CHECK(overturned.judgement.verdict == Verdict::open);
  CHECK_FALSE(found(run_of(box(2.0)).findings, "start_overturned"));
}

// A rope with a pretension beyond the friction of a box of 100 kg, 0.3 m g = 294 N, pulls it until it is as slack as friction holds.
TEST_CASE("friction that slides in the search for the rest is told, and caps the verdict where slips are forbidden") {
  const auto box = [](double pretension, const std::string& criterion) {
    std::string text = "simulation = { end = 0.1, initial = \"equilibrium\" }\n"
                       "[[body]]\nname = \"box\"\nmass = 100.0\ninertia = 10.0\nposition = [0.0, 0.5]\n";
    for (const std::string x : {"-0.5", "0.5"})
      text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot " + x + "\"\na = { body = \"box\", at = [" + x +
              ", 0.0] }\nstiffness = 1e7\ndamping = 1e4\n";
    return text +
           "[[element]]\nkind = \"coulomb_stick\"\nname = \"floor\"\ncontacts = [\"foot -0.5\", \"foot 0.5\"]\n"
           "static_friction = 0.3\n[[element]]\nkind = \"rope\"\nname = \"rope\"\na = \"box\"\n"
           "b = { body = \"ground\", at = [-2.0, 0.5] }\nstiffness = 1e5\npretension = " +
           number(pretension) + "\n[[acceptance]]\nname = \"held\"\n" + criterion;
  };
  const std::string no_slip = "event = \"slips*\"\n", place = "channel = \"box.y\"\nwithin = \"1 m\"\n";
  const Report forbidden = run_of(box(400.0, no_slip)), allowed = run_of(box(400.0, place)), held = run_of(box(200.0, no_slip));
  REQUIRE(found(forbidden.findings, "start_slid"));
  CHECK(found(forbidden.findings, "start_slid")->level == FindingLevel::warning);
  CHECK(forbidden.judgement.verdict == Verdict::open);
  REQUIRE(found(allowed.findings, "start_slid"));
  CHECK(found(allowed.findings, "start_slid")->level == FindingLevel::note);
  CHECK(allowed.judgement.verdict == Verdict::hold);
  CHECK_FALSE(found(held.findings, "start_slid"));
  CHECK(held.judgement.verdict == Verdict::hold);
}

TEST_CASE("a pulse that jumps exactly at the start of a run from rest is told, since it is no blow there") {
  const auto mass = [](const std::string& signal, const std::string& load = "kind = \"load\"\nat = \"A\"\nforce_x = \"push\"\n") {
    return "gravity = [0.0, 0.0]\nsimulation = { end = 1.5, initial = \"equilibrium\" }\n"
           "[[body]]\nname = \"A\"\nmass = 2.0\ninertia = 1.0\n[[element]]\nkind = \"bushing\"\nname = \"mount\"\na = \"A\"\n"
           "stiffness = [200.0, 200.0]\ndamping = [2.0, 2.0]\nrotational_stiffness = 10.0\n"
           "[[acceptance]]\nname = \"travel\"\nchannel = \"A.x\"\nwithin = \"75 mm\"\n[[element]]\nname = \"acts\"\n" +
           load + signal;
  };
  const auto pulse = [](const std::string& kind, const std::string& more) {
    return "[[signal]]\nname = \"push\"\nkind = \"" + kind + "\"\n" + more;
  };
  const std::string step = "peak = 10.0\nduration = 0.5\n";
  const Report hidden = run_of(mass(pulse("rectangle", step)));
  REQUIRE(found(hidden.findings, "pulse_at_rest"));
  CHECK(hidden.judgement.verdict == Verdict::open);
  // From rest without load it swings to nearly 2 F/k = 100 mm; let go from F/k = 50 mm it stays within.
  const Report later = run_of(mass(pulse("rectangle", step + "start = 0.001\n"))),
               before = run_of(mass(pulse("rectangle", "peak = 10.0\nduration = 1.5\nstart = -1.0\n")));
  CHECK_FALSE(found(later.findings, "pulse_at_rest"));
  CHECK(later.judgement.verdict == Verdict::inspect);
  CHECK_FALSE(found(before.findings, "pulse_at_rest"));
  CHECK(before.judgement.verdict == Verdict::hold);
  // A load that is continuous at the start, or that is no pulse, acts at rest without a finding.
  for (const std::string& signal :
       {pulse("trapezoid", step + "rise = 0.1\nfall = 0.1\n"), pulse("half_sine", step), pulse("constant", "value = 10.0\n")})
    CHECK_FALSE(found(run_of(mass(signal)).findings, "pulse_at_rest"));
  CHECK(found(run_of(mass(pulse("sum", "signals = [\"part\"]\n") + "[[signal]]\nname = \"part\"\nkind = \"rectangle\"\n" + step)).findings,
              "pulse_at_rest"));
  // The pressure of a brake has to act in the search.
  const std::string brake = "kind = \"joint_friction\"\na = \"A\"\nholds = 10.0\nsignal = \"push\"\n";
  CHECK_FALSE(found(run_of(mass(pulse("rectangle", step), brake)).findings, "pulse_at_rest"));
}

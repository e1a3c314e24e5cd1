// Runs that end before their loads have acted, and what is still going on at their end: verdicts and findings.
#include "mbd/run/report.h"
#include "tests/mbd/run/load_cases.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

RunOptions without_errors() {
  RunOptions options;
  options.estimating = Estimating::never;
  return options;
}

Report run_of(const std::string& text) { return judged_run(load_model_text(text, "loads.toml"), without_errors()); }
Report run_file(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return judged_run(load_model(std::string(STEPLAP_TEST_DATA) + "/loads/" + name, overrides), without_errors());
}

bool has(const Report& report, const std::string& code) {
  return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& f) { return f.code == code; });
}

std::string text_of(const Report& report, const std::string& code) {
  for (const Finding& finding : report.findings)
    if (finding.code == code) return finding.text;
  return "";
}

std::string codes_of(const Report& report) {
  std::string codes;
  for (const Finding& finding : report.findings) codes += finding.code + " ";
  for (const std::string& cap : report.judgement.caps) codes += "| " + cap;
  return codes;
}

} // namespace

TEST_CASE("a run that ends before its loads have acted is open, and says which and why") {
  struct Row {
    const char* file;
    std::vector<std::string> overrides;
    const char *code, *words;
  };
  const std::vector<Row> rows = {
      {"end_inside_load.toml", {}, "load_cut_off", "signal 'p' lasts from t = 0.5 s to 0.7 s, but the run ends at 0.51 s"},
      {"stop_before_load.toml", {}, "load_never_acts", "signal 'p' begins at t = 0.5 s, but action 'q' ends the run at 0.2 s"},
      {"load_waits_for_action.toml", {}, "load_never_acts", "signal 'p' has never acted on 'l': action 'q' did not happen"},
      {"load_released_before.toml", {}, "load_never_acts", "but action 'q' releases 'l' at 0.2 s"},
      {"signal_set_away.toml", {}, "load_never_acts", "but action 'q' sets another signal of 'l' at 0.2 s"},
      {"falls_beside.toml", {}, "nothing_carries", "nothing carries body 'other', which moves by 4.905 m"},
      {"pushed_box.toml", {"simulation.end=0.35"}, "criterion_still_grows", "'slide' is met so far"},
      {"pushed_box.toml", {"simulation.end=0.35"}, "load_cut_off", "signal 'push' lasts from t = 0.1 s to 0.6 s"},
      {"low_loader_wet.toml", {"simulation.end=0.15"}, "load_cut_off", "signal 'braking' lasts from t = 0.05 s to 0.25 s"},
      {"low_loader.toml", {"signal.braking.duration=200"}, "load_cut_off", "but the run ends at 0.8 s"},
  };
  for (const Row& row : rows) {
    CAPTURE(row.file);
    const Report report = run_file(row.file, row.overrides);
    CAPTURE(codes_of(report));
    CHECK(report.judgement.verdict == Verdict::open);
    CHECK(text_of(report, row.code).find(row.words) != std::string::npos);
    CHECK(!report.judgement.caps.empty());
  }
}

TEST_CASE("the same runs are judged when their loads have acted") {
  CHECK(run_file("end_inside_load.toml", {"simulation.end=1.0"}).judgement.verdict == Verdict::reject); // 500 N against 300 N
  CHECK(run_file("pushed_box.toml").judgement.verdict == Verdict::reject);
  CHECK(run_file("low_loader_wet.toml").judgement.verdict == Verdict::reject);
  CHECK(run_file("low_loader.toml").judgement.verdict == Verdict::hold);
  CHECK(run_file("falls_beside.toml", {"body.other.fixed=true"}).judgement.verdict == Verdict::hold);
}

TEST_CASE("of every kind of load: a run is called \"hold\" where the load has acted, and open where it has not") {
  const std::vector<LoadCase> cases = load_cases();
  CHECK(cases.size() > 500);
  std::size_t holds = 0;
  for (const LoadCase& one : cases) {
    CAPTURE(one.name);
    const Report report = run_of(one.text);
    CAPTURE(codes_of(report));
    CHECK(report.judgement.verdict == (one.is_hold ? Verdict::hold : Verdict::open));
    holds += one.is_hold ? 1 : 0;
  }
  CHECK(holds > 200);
}

namespace {

// A mass of 1 kg on a spring of period T, pulled by 1 N from t = 0.1 s on: x swings between 0 and 2 N/k.
std::string swing(double period, double damping, double end, double limit, const std::string& load) {
  const double omega = 2.0 * 3.14159265358979 / period, stiffness = omega * omega;
  return "gravity = [0.0, 0.0]\n[simulation]\nend = " + std::to_string(end) + "\n[output]\nstep = 0.1\n" + R"([[body]]
name = "m"
mass = 1.0
inertia = 1.0
[[element]]
kind = "prismatic"
name = "rail"
a = "m"
axis = [1.0, 0.0]
[[element]]
kind = "spring_damper"
name = "spring"
a = "m"
axis = [1.0, 0.0]
stiffness = )" +
         std::to_string(stiffness) + "\ndamping = " + std::to_string(2.0 * damping * omega) + R"(
[[element]]
kind = "load"
name = "pull"
at = "m"
force_x = "f"
[[acceptance]]
name = "way"
channel = "m.x"
at_most = )" +
         std::to_string(limit) + "\n" + load;
}
const std::string k_step =
    "[[signal]]\nname = \"one\"\nkind = \"constant\"\nvalue = 1.0\n[[signal]]\nname = \"f\"\nkind = \"scaled\"\nsignal = \"one\"\n"
    "delay = 0.1\n";
std::string sine(double period) {
  return "[[signal]]\nname = \"f\"\nkind = \"harmonics\"\namplitudes = [1.0]\nfrequencies = [" + std::to_string(1.0 / period) +
         "]\nphases = [-1.5707963267948966]\n";
}

} // namespace

TEST_CASE("a level has acted when what it moves rests, or has long been at its worst") {
  // Period 1 s, damping ratio 0.2: the first swing reaches (1 + exp(−π 0.2/√0.96)) N/k = 1.5266 N/k half a period after the step.
  const double static_way = 1.0 / std::pow(2.0 * 3.14159265358979, 2);
  const double limit = 2.0 * static_way;
  CHECK(run_of(swing(1.0, 0.2, 0.3, limit, k_step)).judgement.verdict == Verdict::open);  // it still swings out
  CHECK(run_of(swing(1.0, 0.2, 3.0, limit, k_step)).judgement.verdict == Verdict::hold);  // the first swing was the worst
  CHECK(run_of(swing(1.0, 0.2, 30.0, limit, k_step)).judgement.verdict == Verdict::hold); // it rests
  CHECK(run_of(swing(1.0, 0.2, 3.0, 1.5 * static_way, k_step)).judgement.verdict == Verdict::inspect);
  CHECK(has(run_of(swing(100.0, 0.2, 1.0, 1e4 * static_way, k_step)), "load_too_short")); // slow beside the run
}

TEST_CASE("a sine has acted after ten periods, or after two if its response repeats") {
  // Far below the natural frequency the response is the static one, in phase: each period is like the one before.
  const double static_way = 1.0 / std::pow(2.0 * 3.14159265358979 / 0.1, 2);
  CHECK(run_of(swing(0.1, 0.2, 1.5, 1.5 * static_way, sine(1.0))).judgement.verdict == Verdict::open);
  CHECK(run_of(swing(0.1, 0.2, 3.0, 1.5 * static_way, sine(1.0))).judgement.verdict == Verdict::hold);
  // Undamped at resonance the amplitude grows by π N/k with each period: a limit of 40 N/k is passed after 12.7 periods.
  const double at_resonance = 1.0 / std::pow(2.0 * 3.14159265358979, 2);
  for (const double periods : {3.0, 8.0, 11.0}) {
    CAPTURE(periods);
    CHECK(run_of(swing(1.0, 0.0, periods, 40.0 * at_resonance, sine(1.0))).judgement.verdict == Verdict::open);
  }
  CHECK(run_of(swing(1.0, 0.0, 15.0, 40.0 * at_resonance, sine(1.0))).judgement.verdict == Verdict::inspect);
  CHECK(run_of(swing(1.0, 0.1, 15.0, 40.0 * at_resonance, sine(1.0))).judgement.verdict == Verdict::hold); // 1/(2 · 0.1) = 5 N/k
}

TEST_CASE("a formula of the time that begins behind the end has not acted") {
  const auto scene = [](const std::string& formula) {
    return "[simulation]\nend = 1.0\n[[body]]\nname = \"b\"\nmass = 100.0\ninertia = 10.0\n[[element]]\nkind = \"prismatic\"\nname = "
           "\"rail\"\na = "
           "\"b\"\naxis = [1.0, 0.0]\n[[element]]\nkind = \"joint_friction\"\nname = \"f\"\na = \"b\"\ncoordinate = \"x\"\nholds = 300.0\n"
           "[[element]]\nkind = \"force\"\nname = \"push\"\na = \"b\"\ncoordinate = \"x\"\nformula = \"" +
           formula + "\"\n[[acceptance]]\nname = \"stays\"\nchannel = \"b.x\"\nwithin = 0.001\n";
  };
  const std::string state = "[[state]]\nname = \"s\"\nrate = \"t > '5 s' ? '1 1/s' : '0 1/s'\"\n";
  CHECK(has(run_of(scene("s * '500 N'") + state), "load_behind_end"));
  for (const char* const late : {"t > '5 s' ? '200 N' : '0 N'", "t < '2 s' ? '0 N' : '10 N/s' * (t - '2 s')",
                                 "'10 N' - '1 N s/m' * rate + (t > '300 s' ? '200 N' : '0 N')"}) {
    CAPTURE(late);
    const Report report = run_of(scene(late));
    CHECK(report.judgement.verdict == Verdict::open);
    CHECK(has(report, "load_behind_end"));
  }
  for (const char* const grows :
       {"min('100 N/s' * t, '250 N')", "t < '0.999 s' ? '0 N' : t < '2 s' ? min('250 N', '5000 N/s' * (t - '0.999 s')) : '0 N'"}) {
    CAPTURE(grows);
    const Report report = run_of(scene(grows));
    CHECK(report.judgement.verdict == Verdict::open);
    CHECK(has(report, "load_still_grows"));
  }
  // A ramp without an end has no full size.
  for (const char* const seen :
       {"min('400 N/s' * t, '250 N')", "t > '0.5 s' ? '200 N' : '0 N'", "'100 N/s' * t", "'100 N'", "-'5 N s/m' * rate"}) {
    CAPTURE(seen);
    CHECK(run_of(scene(seen)).judgement.verdict == Verdict::hold);
  }
}

namespace {

// 100 kg on a rail with friction of 300 N; what `load` does is up to it.
std::string box_on_rail(double end, double within, const std::string& load) {
  return "[simulation]\nend = " + std::to_string(end) + R"(
[[body]]
name = "b"
mass = 100.0
inertia = 10.0
[[element]]
kind = "prismatic"
name = "rail"
a = "b"
axis = [1.0, 0.0]
[[element]]
kind = "joint_friction"
name = "f"
a = "b"
coordinate = "x"
holds = 300.0
[[acceptance]]
name = "stays"
channel = "b.x"
within = )" +
         std::to_string(within) + "\n" + load;
}

} // namespace

TEST_CASE("a load, a motor or a force that waits for an action which does not happen has not acted") {
  const auto scene = [](const std::string& element, const std::string& step) {
    return box_on_rail(1.0, 0.001, "[[element]]\nname = \"l\"\n" + element) +
           "\n[[action]]\nname = \"never\"\nwhen = \"b.x > '1 m'\"\ndo = [\"" + step + "\"]\n";
  };
  const std::string load = "kind = \"load\"\nat = \"b\"\n", motor = "kind = \"motor\"\na = \"b\"\ncoordinate = \"x\"\n",
                    force = "kind = \"force\"\na = \"b\"\ncoordinate = \"x\"\n", waits = "active = false";
  const std::pair<std::string, std::string> unheard[] = {{load + "force = [500.0, 0.0]\n" + waits, "hold l"},
                                                         {load, "set l.force = [500 N, 0]"},
                                                         {motor + "constant_effort = 500.0\n" + waits, "hold l"},
                                                         {force + "formula = \"'500 N'\"\n" + waits, "hold l"}};
  for (const auto& [element, step] : unheard) {
    CAPTURE(element);
    const Report report = run_of(scene(element, step));
    CHECK(report.judgement.verdict == Verdict::open);
    CHECK(has(report, "load_never_acts"));
  }
  // Brakes and drags that wait for a motion which does not come are no loads, nor is a load that would only be taken away.
  const std::pair<std::string, std::string> sound[] = {{force + "formula = \"-'5 N s/m' * rate\"\n" + waits, "hold l"},
                                                       {load + "force = [200.0, 0.0]", "release l"},
                                                       {load + "force = [200.0, 0.0]", "set l.force = [0, 0]"},
                                                       {motor + "constant_effort = 200.0", "set l.constant_effort = 0 N"}};
  for (const auto& [element, step] : sound) {
    CAPTURE(element);
    CHECK(run_of(scene(element, step)).judgement.verdict == Verdict::hold);
  }
}

namespace {

std::string action(const std::string& step, const std::string& more = "") {
  return "[[action]]\nname = \"q\"\nwhen = \"5 ms\"\ndo = [\"" + step + "\"]\n" + more;
}

} // namespace

TEST_CASE("a constant load that an action or the end cuts off while what it moves still moves has not acted") {
  // 500 N against 300 N: 2 m/s² for 5 ms, then 3 m/s² against it: 42 µm in all. Without the action it would slide 1 m within 1 s.
  const std::string element = "[[element]]\nname = \"l\"\n", steady = "[[signal]]\nname = \"p\"\nkind = \"constant\"\nvalue = 500.0\n";
  const std::string load = element + "kind = \"load\"\nat = \"b\"\nforce = [500.0, 0.0]\n";
  const std::pair<std::string, std::string> ways[] = {
      {load, "release l"},
      {load, "set l.force = [0, 0]"},
      {load, "stop"},
      {steady + element + "kind = \"load\"\nat = \"b\"\nforce_x = \"p\"\n", "release l"},
      {element + "kind = \"motor\"\na = \"b\"\ncoordinate = \"x\"\nconstant_effort = 500.0\n", "release l"},
      {element + "kind = \"force\"\na = \"b\"\ncoordinate = \"x\"\nformula = \"'500 N'\"\n", "release l"}};
  for (const auto& [one, step] : ways) {
    CAPTURE(one);
    CAPTURE(step);
    const Report report = run_of(box_on_rail(1.0, 0.1, one + action(step)));
    CHECK(report.judgement.verdict == Verdict::open);
    CHECK(has(report, "load_too_short"));
    CHECK(run_of(box_on_rail(1.0, 0.1, one + action(step, "reason = \"the tug lasts 5 ms\"\n"))).judgement.verdict == Verdict::hold);
  }
  CHECK(has(run_of(box_on_rail(0.005, 0.1, load)), "load_too_short"));
  // The mass of 1 kg swings out within half a period of 1 s: at 5 ms it has hardly begun to, after 20 s it rests.
  const double static_way = 1.0 / std::pow(2.0 * 3.14159265358979, 2);
  const std::string one = "[[signal]]\nname = \"f\"\nkind = \"constant\"\nvalue = 1.0\n";
  CHECK(has(run_of(swing(1.0, 0.2, 30.0, 2.0 * static_way, one + action("release pull"))), "load_too_short"));
  const std::string late = "[[action]]\nname = \"q\"\nwhen = \"20 s\"\ndo = [\"release pull\"]\n";
  CHECK(run_of(swing(1.0, 0.2, 30.0, 2.0 * static_way, one + late)).judgement.verdict == Verdict::hold);
}

TEST_CASE("a load that an action takes away at the start has not acted") {
  const std::string pulse = "kind = \"half_sine\"\npeak = 500.0\nstart = 0.3\nduration = 0.2\n";
  const std::string load = "[[signal]]\nname = \"p\"\n" + pulse +
                           "[[signal]]\nname = \"low\"\nkind = \"half_sine\"\npeak = 100.0\nduration = 0.2\n" +
                           "[[element]]\nkind = \"load\"\nname = \"l\"\nat = \"b\"\nforce_x = \"p\"\n[[action]]\nname = \"q\"\nwhen = "
                           "\"b.x > '-1 m'\"\ndo = [\"";
  for (const char* const step : {"set l.force_x = low", "release l"}) {
    CAPTURE(step);
    const Report report = run_of(box_on_rail(1.0, 0.001, load + step + "\"]\n"));
    CHECK(report.judgement.verdict == Verdict::open);
    CHECK(has(report, "load_never_acts"));
  }
}

TEST_CASE("a slide that a constant force keeps up is open whatever its limit") {
  // A force of 400 N on 100 kg and friction of 300 N: 0.5 t² m, 0.125 m at the end.
  const auto slide = [](double within) {
    return run_of(box_on_rail(0.5, within,
                              "[[signal]]\nname = \"p\"\nkind = \"constant\"\nvalue = 400.0\n[[signal]]\nname = \"w\"\nkind = "
                              "\"half_sine\"\npeak = 1e-9\nduration = 0.1\n[[signal]]\nname = \"s\"\nkind = \"sum\"\nsignals = [\"p\", "
                              "\"w\"]\nfactors = [1.0, 1.0]\n[[element]]\nkind = \"load\"\nname = \"l\"\nat = \"b\"\nforce_x = \"s\"\n"));
  };
  CHECK(has(slide(0.45), "criterion_still_grows"));
  CHECK(has(slide(0.6), "criterion_still_grows"));
  CHECK(has(slide(100.0), "criterion_still_grows"));
}

TEST_CASE("a slide that is braked when the run ends is open if it stops beyond its limit, be it of a channel or of a formula") {
  // 2 m/s against 300 N on 100 kg: stops after 0.667 m; at 0.1 s it is at 0.185 m, and at 1.7 m/s 0.355 m away within as long again.
  const auto slides = [](const std::string& channel, double within) {
    const std::string moving = "velocity = [2.0, 0.0]\n";
    std::string text = box_on_rail(0.1, within, "[[channel]]\nname = \"way\"\nexpression = \"b.x\"\n");
    text.insert(text.find("mass"), moving);
    text.replace(text.find("channel = \"b.x\""), 15, "channel = \"" + channel + "\"");
    return run_of(text);
  };
  for (const char* const channel : {"b.x", "way"}) {
    CAPTURE(channel);
    const Report beyond = slides(channel, 0.6), within = slides(channel, 0.7);
    CHECK(has(beyond, "criterion_still_grows"));
    CHECK(beyond.judgement.verdict == Verdict::open);
    CHECK_FALSE(has(within, "criterion_still_grows"));
    CHECK_FALSE(has(within, "open_at_end")); // a criterion asks for this slide
  }
}

TEST_CASE("a limit on a place of a body that slides on its contacts, or that such a body carries, is judged as that of the slide") {
  // 2 m/s against mu g = 0.3 g: stops after 0.680 m. At 0.1 s it is at 0.185 m, and within as long again it would be at 0.35 m.
  const auto slides = [](const std::string& channel, double within) {
    return run_of(R"([simulation]
end = 0.1
[[body]]
name = "box"
mass = 90.0
inertia = 10.0
position = [0.0, 0.5]
velocity = [2.0, 0.0]
[[body]]
name = "cargo"
mass = 10.0
inertia = 1.0
position = [0.0, 0.5]
velocity = [2.0, 0.0]
[[element]]
kind = "weld"
name = "bolts"
a = "cargo"
b = "box"
[[element]]
kind = "unilateral_contact"
name = "rear"
a = { body = "box", point = [-0.5, -0.5] }
preload = 490.5
stiffness = 1e7
damping = 1e4
[[element]]
kind = "unilateral_contact"
name = "front"
a = { body = "box", point = [0.5, -0.5] }
preload = 490.5
stiffness = 1e7
damping = 1e4
[[element]]
kind = "coulomb_stick"
name = "feet"
contacts = ["rear", "front"]
static_friction = 0.3
[[acceptance]]
name = "stays"
channel = ")" + channel +
                  "\"\nwithin = " + std::to_string(within) + "\n");
  };
  for (const char* const channel : {"box.x", "cargo.x", "feet.slide"}) {
    CAPTURE(channel);
    const Report beyond = slides(channel, 0.6), within = slides(channel, 0.75);
    CHECK(has(beyond, "criterion_still_grows"));
    CHECK(beyond.judgement.verdict == Verdict::open);
    CHECK_FALSE(has(within, "criterion_still_grows"));
    CHECK(has(within, "open_at_end") == (channel == std::string("cargo.x"))); // no criterion asks for the box or its slide
  }
}

TEST_CASE("second derivatives at the end are those of the motion, however many periods the run has") {
  // x'' = −ω² x, 3200 periods: a ten-thousandth of the run is a third of a period.
  const Report report =
      run_of("gravity = [0.0, 0.0]\nsimulation = { end = 200.3 }\noutput = { step = 1.0 }\n[[body]]\nname = \"b\"\nmass = "
             "1.0\ninertia = 1.0\nvelocity = [50.0, 0.0]\n[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = "
             "\"b\"\n[[element]]\nkind = \"spring_damper\"\nname = \"s\"\na = \"b\"\naxis = [1.0, 0.0]\nstiffness = "
             "1e4\nfree_length = 0.0\n[[acceptance]]\nname = \"stays\"\nchannel = \"b.x\"\nwithin = 0.9\n");
  const auto& ranges = report.ranges();
  const auto x = std::find_if(ranges.begin(), ranges.end(), [](const ChannelRange& range) { return range.channel->name == "b.x"; });
  REQUIRE(x != ranges.end());
  CHECK(std::abs(x->final_bend + 1e4 * x->final) < 0.1 * 1e4 * 0.5); // over a tenth of a step accelerations change by less
}

TEST_CASE("a swing that builds up by itself is open until it repeats") {
  // x'' − 2 x' + 100 x = 0 from 1 mm/s: amplitude 0.1 mm exp(t), 14.8 mm at 5 s. With 2 x' instead it decays from the first swing on.
  const auto scene = [](const std::string& push, double within) {
    return "gravity = [0.0, 0.0]\n[simulation]\nend = 5.0\n[[body]]\nname = \"b\"\nmass = 100.0\ninertia = 10.0\nvelocity = [0.001, 0.0]\n"
           "[[element]]\nkind = \"prismatic\"\nname = \"rail\"\na = \"b\"\n[[element]]\nkind = \"spring_damper\"\nname = \"s\"\na = \"b\"\n"
           "axis = [1.0, 0.0]\nstiffness = 1e4\nfree_length = 0.0\n[[element]]\nkind = \"force\"\nname = \"push\"\na = \"b\"\ncoordinate = "
           "\"x\"\n"
           "formula = \"" +
           push + " * rate\"\n[[acceptance]]\nname = \"stays\"\nchannel = \"b.x\"\nwithin = " + std::to_string(within) + "\n";
  };
  const Report grows = run_of(scene("'200 N s/m'", 0.02));
  CHECK(grows.judgement.verdict == Verdict::open);
  CHECK(has(grows, "criterion_still_grows"));
  CHECK_FALSE(has(run_of(scene("'200 N s/m'", 1.0)), "criterion_still_grows")); // too far to come near it within 5 s at this rate
  CHECK_FALSE(has(run_of(scene("-'200 N s/m'", 1.001e-4)), "criterion_still_grows"));
}

TEST_CASE("friction that slips at the end is noted where no criterion asks for it, and caps nothing") {
  const std::string text = R"([simulation]
end = 1.0
[[body]]
name = "b"
mass = 100.0
inertia = 10.0
[[element]]
kind = "prismatic"
name = "rail"
a = "b"
axis = [1.0, 0.0]
[[element]]
kind = "joint_friction"
name = "f"
a = "b"
coordinate = "x"
holds = 300.0
drags = 1.0
[[signal]]
name = "shove"
kind = "half_sine"
peak = 400.0
duration = 0.5
[[element]]
kind = "load"
name = "push"
at = "b"
force_x = "shove"
[[acceptance]]
name = "speed"
channel = "b.vx"
at_most = 100.0
)";
  const Report report = run_of(text);
  CHECK(report.judgement.verdict == Verdict::hold);
  CHECK(text_of(report, "open_at_end") == "when the run ends 'f' slips, and no criterion asks for it");
  CHECK_FALSE(has(run_of(text + "[[acceptance]]\nname = \"its force\"\nchannel = \"f.friction\"\nwithin = 1e6\n"), "open_at_end"));
}

TEST_CASE("a body that falls is no fault where a criterion, a force or a drive names it, or something has caught it") {
  const auto text = [](const std::string& more) {
    return "[simulation]\nend = 1.0\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\nposition = [0.0, 1.0]\n[[body]]\nname = "
           "\"other\"\nmass = 1.0\n"
           "inertia = 1.0\nposition = [9.0, 1.0]\n[[element]]\nkind = \"weld\"\nname = \"held\"\na = \"b\"\n[[acceptance]]\nname = "
           "\"stays\"\nchannel = "
           "\"b.x\"\nwithin = 0.001\n" +
           more;
  };
  const auto contact = [](const std::string& gap) {
    return "[[element]]\nkind = \"unilateral_contact\"\nname = \"floor\"\na = \"other\"\nnormal = [0.0, 1.0]\nstiffness = 1e5\ndamping = "
           "1e2\ngap = " +
           gap + "\n";
  };
  CHECK(has(run_of(text("")), "nothing_carries"));
  CHECK(has(run_of(text(contact("20.0"))), "nothing_carries")); // the floor lies 20 m below
  CHECK_FALSE(has(run_of(text(contact("1.0"))), "nothing_carries"));
  CHECK_FALSE(has(run_of(text("[[acceptance]]\nname = \"fall\"\nchannel = \"other.vy\"\nwithin = 20.0\n")), "nothing_carries"));
  CHECK(has(run_of(text("[[acceptance]]\nname = \"turn\"\nchannel = \"other.theta\"\nwithin = 1.0\n")), "nothing_carries"));
  CHECK(has(run_of(text(contact("20.0") + "[[acceptance]]\nname = \"lifts\"\nevent = \"opens\"\n")), "nothing_carries"));
  CHECK_FALSE(
      has(run_of(text(
              "[[element]]\nkind = \"force\"\nname = \"drag\"\na = \"other\"\ncoordinate = \"y\"\nformula = \"-'0.1 N s/m' * rate\"\n")),
          "nothing_carries"));
  CHECK_FALSE(has(run_of("gravity = [0.0, 0.0]\n" + text("")), "nothing_carries"));
  // Two that hang together fall together.
  const std::string third =
      "[[body]]\nname = \"third\"\nmass = 1.0\ninertia = 1.0\nposition = [9.0, 2.0]\n[[element]]\nkind = \"weld\"\nname = \"tied\"\na = "
      "\"third\"\nb = \"other\"\n";
  const Report both = run_of(text(third));
  CHECK(std::count_if(both.findings.begin(), both.findings.end(), [](const Finding& f) { return f.code == "nothing_carries"; }) == 2);
  CHECK(both.judgement.verdict == Verdict::open);
}

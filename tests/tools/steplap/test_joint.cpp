// steplap joint: what the joints of a model can bear.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

const std::string k_paper = STEPLAP_MODELS "/paper/no_interference.toml";

} // namespace

TEST_CASE("joint tells area, interfaces and capacity of every joint") {
  const Outcome outcome = steplap_does({"joint", k_paper});
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  for (const char* part :
       {"front joint: 'front limb' on 'active part'", "back joint: 'back limb'", "7071.0678 mm²", "1165", "2330  16.4756 m²", "100 kPa"})
    CHECK_MESSAGE(has(outcome.out, part), part);
  // 2 · 1165 · 0.25 · 0.1 MPa · 10 mm · √0.5 m, the same along both axes and for one force alone
  CHECK(has(outcome.out, "along x      411.89 kN     411.89 kN\n"));
  CHECK(has(outcome.out, "along y      411.89 kN     411.89 kN\n"));
  CHECK_FALSE(has(outcome.out, "p_req"));
}

TEST_CASE("joint inverts a wrench to the required pressure") {
  // at rest the joint carries the limb's weight, 9 t: 21.4354 kPa
  const Outcome rest = steplap_does({"joint", k_paper, "--joint", "front joint", "--wrench", "0,-88.29 kN,0"});
  CHECK(rest.code == 0);
  CHECK_FALSE(has(rest.out, "back joint"));
  for (const char* part : {"0.214354: holds", "21.4354 kPa of 100 kPa", "4.66519", "at infinity"}) CHECK_MESSAGE(has(rest.out, part), part);
  const Outcome couple = steplap_does({"joint", k_paper, "--joint", "back joint", "--wrench=0, 0, 600000"});
  CHECK(couple.code == 0);
  CHECK(has(couple.out, ": slides"));
  CHECK(has(couple.out, "centre of rotation  (-1."));
  const Outcome nothing = steplap_does({"joint", k_paper, "--wrench", "0,0,0"});
  CHECK(nothing.code == 0);
  CHECK(has(nothing.out, "u                   0: holds"));
}

TEST_CASE("joint looks at the model as laid over") {
  const Outcome outcome = steplap_does(
      {"joint", k_paper, "--wrench", "0,-88.29 kN,0", "--set", "core.core.pressure=20 kPa", "--set", "element.front joint.mode=monitor"});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "1.07177: slides")); // 21.4354/20
  CHECK(has(outcome.out, "'active part', never slides (monitor)"));
}

TEST_CASE("joint counts the pressure that relaxation and the signal leave at the start") {
  // 428.974 kN along x without either; 0.6 and 0.3 of it.
  const std::string core = STEPLAP_MODELS "/layouts/three_limb.toml";
  const std::vector<std::string> rest = {"joint",    core,         "--joint", "front joint",
                                         "--wrench", "100 kN,0,0", "--set",   "core.core.pressure_loss=0.4"};
  const Outcome lost = steplap_does(rest);
  CHECK(lost.code == 0);
  for (const char* part : {"along x     257.384 kN    257.384 kN\n", " of 60 kPa"})
    CHECK_MESSAGE(has(lost.out, part), lost.out << lost.err);
  const Workbench bench;
  const std::string halved = bench.write("halved.toml", "extends = \"" + core +
                                                            "\"\n[[signal]]\nkind = \"constant\"\nname = \"half\"\nvalue = 0.5\n"
                                                            "[[core]]\nname = \"core\"\npressure_signal = \"half\"\npressure_loss = 0.4\n");
  const Outcome both = steplap_does({"joint", halved, "--joint", "front joint", "--wrench", "100 kN,0,0"});
  CHECK(both.code == 0);
  for (const char* part : {"along x     128.692 kN    128.692 kN\n", " of 30 kPa"})
    CHECK_MESSAGE(has(both.out, part), both.out << both.err);
}

TEST_CASE("a joint without interfaces holds whatever it takes") {
  const Workbench bench;
  const std::string model =
      bench.write("a.toml", std::string(k_oscillator) + "[[body]]\nname = \"limb\"\nmass = 1\ninertia = 1\n[[element]]\nname = \"joint\"\n"
                                                        "kind = \"step_lap_joint\"\nlimb = \"limb\"\nactive_part = \"mass\"\n");
  const Outcome outcome = steplap_does({"joint", model, "--wrench", "1,2,3"});
  CHECK(outcome.code == 0);
  CHECK(has(outcome.out, "no interfaces: holds whatever it takes"));
}

TEST_CASE("joint refuses what it cannot answer") {
  const Workbench bench;
  CHECK(steplap_does({"joint"}).code == 2);
  const Outcome none = steplap_does({"joint", bench.write("a.toml", k_oscillator)});
  CHECK(none.code == 2);
  CHECK(has(none.err, "has no step-lap joint"));
  const Outcome name = steplap_does({"joint", k_paper, "--joint", "front jiont"});
  CHECK(name.code == 2);
  CHECK(has(name.err, "did you mean 'front joint'?"));
  for (const char* wrench : {"1,2", "1,2,3,4", "1,2,", "a,b,c", "1 kg,0,0", "0,0,1 N", "nan,0,0", ""}) {
    CAPTURE(wrench);
    const Outcome wrong = steplap_does({"joint", k_paper, "--wrench", wrench});
    CHECK(wrong.code == 2);
    CHECK(has(wrong.err, "--wrench"));
  }
  const Outcome model = steplap_does({"joint", k_paper, "--set", "core.core.yoke_height=2"});
  CHECK(model.code == 3);
  CHECK(has(model.err, "leave no window"));
}

TEST_CASE("a joint says whose its capacity is: alone until it slides, or shared with what is beside it") {
  const std::string model = STEPLAP_SOURCE "/docs/examples/ratcheting.toml";
  CHECK(steplap_does({"joint", model}).out.find("shares its load with 'tie plate' (tie): the capacity is the joint's part alone") !=
        std::string::npos);
  CHECK(steplap_does({"joint", k_paper}).out.find("elastic") == std::string::npos);
}

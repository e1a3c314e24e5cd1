// steplap core: what came of a core's dimensions, and its drawing; what check finds unusual.
#include "tests/tools/steplap/workbench.h"

#include <doctest/doctest.h>

using namespace steplap::testing;

namespace {

const std::string k_layout = STEPLAP_MODELS "/layouts/three_limb.toml";

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

} // namespace

TEST_CASE("core tells sheets, layers, interfaces, overlaps, capacity and masses") {
  const Outcome outcome = steplap_does({"core", k_layout});
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  // 0.48 m · 0.96/0.27 mm = 1706 sheets; 1705 interfaces; 5.07 t of 1.44 m² a sheet; a trapezoid's centre is 25 mm off
  for (const char* part : {"saw-tooth book of 5 steps of 5 mm across the mitre, 1 sheet in a layer, clearance 0.5 mm",
                           "1706    1706  0.848528 m    45°", "interfaces between layers: 1705", "middle joint: 'middle limb', T-joint",
                           "5072.56 kg      5070 kg", "24.9983 mm", "top front", "yokes: "})
    CHECK_MESSAGE(has(outcome.out, part), part);
  CHECK_FALSE(has(outcome.out, "warning"));
  const Outcome paper = steplap_does({"core", STEPLAP_MODELS "/paper/no_interference.toml"});
  CHECK(has(paper.out, "counted overlaps of 10 mm, 1165 a corner; strips with square ends"));
  CHECK(has(paper.out, "411.89 kN")); // the joint's capacity, as steplap joint has it
}

TEST_CASE("core tells yokes that two tables share, compliance, edges and what acceleration across does") {
  CHECK(has(steplap_does({"core", STEPLAP_MODELS "/layouts/five_limb.toml"}).out,
            "yokes: 20089.2 kg of the 85350 kg of 'active part', those of all its tables together\n"));
  const Outcome outcome =
      steplap_does({"core", k_layout, "--set", "core.core.tangential_stiffness=2e10", "--set", "core.core.edge_stiffness=1e11", "--set",
                    "core.core.allowed_line_load=2e7", "--set", "core.core.transverse_acceleration=rail humping", "--set",
                    "core.core.transverse_support=front", "--set", "core.core.transverse_slices=2"});
  CHECK(outcome.code == 0);
  // 7650 · 0.27 mm · 1706 sheets = 3524 kg/m²: a quarter and three quarters of it, 881 and 2643, lean on the middles of
  // the two slices; interfaces of one kind lie some sheets off the middle in the mean.
  for (const char* part : {"yields by 2e+10 N/m before it slides", "once 0.5 mm have closed, allowed 2e+07 N/m, 43.4",
                           "pressed by 879 to 2644 Pa more for every m/s²"})
    CHECK_MESSAGE(has(outcome.out, part), part);
  CAPTURE(outcome.out);
  CHECK(outcome.err == "");
}

TEST_CASE("core draws elevation, section, corner and book") {
  const Workbench bench;
  const Outcome outcome = steplap_does({"core", k_layout, "--svg", bench.at("core.svg"), "--set", "core.core.book=zig_zag"});
  CHECK(outcome.code == 0);
  const std::string svg = text_of(bench.at("core.svg"));
  for (const char* part : {"<svg xmlns=", "</svg>\n", "Elevation", "Section of a limb", "Corner: mitre", "Book across the mitre", "zig-zag",
                           "600 × 480, 1706 sheets", "Ø 768.4", "fill factor"})
    CHECK_MESSAGE(has(svg, part), part);
  CHECK(count_of(svg, "class='cut'") == 5);  // lines of the book
  CHECK(count_of(svg, "class='lap'") == 16); // of 17 layers, two periods, every neighbours overlap
  const Outcome counted = steplap_does({"core", STEPLAP_MODELS "/paper/no_interference.toml", "--svg", bench.at("paper.svg")});
  CHECK(counted.code == 0);
  CHECK_FALSE(has(text_of(bench.at("paper.svg")), "Section of a limb"));
  CHECK(steplap_does({"core", k_layout, "--svg", bench.at("no/such/folder.svg")}).code == 2);
}

TEST_CASE("a report shows the core's drawing") {
  const Workbench bench;
  const Outcome run = steplap_does(
      {"simulate", k_layout, "--set", "simulation.end=0.01", "--set", "output.step=1e-3", "-o", bench.at("out"), "--no-estimate"});
  REQUIRE((run.code == 0 || run.code == 5));
  CHECK(has(text_of(bench.at("out/three_limb/drawing.json")), "\"cores\":[{\"name\":\"core\",\"svg\":\"<svg xmlns="));
  CHECK(steplap_does({"report", bench.at("out/three_limb"), "-o", bench.at("page.html")}).code == 0);
  const std::string page = text_of(bench.at("page.html"));
  CHECK(has(page, "id: 'cores'"));
  CHECK(has(page, "Book across the mitre"));
}

TEST_CASE("core of what has none, or by a wrong name, is refused") {
  const Outcome none = steplap_does({"core", STEPLAP_MODELS "/layouts/joint_apart.toml"});
  CHECK(none.code == 2);
  CHECK(has(none.err, "has no [[core]]"));
  const Outcome wrong = steplap_does({"core", k_layout, "--core", "cor"});
  CHECK(wrong.code == 2);
  CHECK(has(wrong.err, "has no core 'cor' (did you mean 'core'?)"));
}

TEST_CASE("check warns of what no core is like, with what is usual, and of masses that hardly agree") {
  struct Case {
    std::vector<std::string> set;
    const char* said;
  };
  const Case cases[] = {
      {{"core.core.static_friction=20"}, "'static_friction' = 20 is unusual: 0.1 to 0.3 are usual (assumed: no value for coated sheets"},
      {{"core.core.pressure=100 MPa"}, "'pressure' = 1e+08 Pa is unusual: 0.05 MPa to 0.4 MPa are usual"},
      {{"core.core.sheets_per_layer=4"}, "'sheets_per_layer' = 4 is unusual: 1 or 2 are usual (Cogent Power"},
      {{"core.core.steps=12"}, "'steps' = 12 is unusual: 3 to 7"},
      {{"core.core.sheet_thickness=0.5 mm"}, "'sheet_thickness' = 5e-04 m is unusual: 0.18 mm to 0.35 mm"},
      {{"core.core.clearance=0.0"}, "'clearance' = 0 m is unusual"},
      {{"body.front limb.mass=4500"}, "'mass' = 4500 kg, the sheets of core 'core' make it 5073 kg: too light"},
      {{"body.front limb.mass=5800"}, "'mass' = 5800 kg, the sheets of core 'core' make it 5073 kg: more than tie plates"},
      {{"body.front limb.cg=[0.05,0.0]"}, "'cg' = [0.05, 0] m, the sheets of core 'core' have theirs at [0.025, "},
      {{"core.core.core_height=300", "body.front limb.mass=608000", "body.rear limb.mass=608000", "body.middle limb.mass=608000",
        "body.front limb.inertia=4.5e9", "body.rear limb.inertia=4.5e9", "body.middle limb.inertia=4.5e9"},
       "'core_height' = 300 m is unusual: 0.8 m to 6 m"}};
  for (const Case& c : cases) {
    std::vector<std::string> line = {"check", k_layout};
    for (const std::string& set : c.set) line.insert(line.end(), {"--set", set});
    const Outcome outcome = steplap_does(line);
    CAPTURE(outcome.err);
    CAPTURE(outcome.out);
    CHECK(outcome.code == 0);
    CHECK_MESSAGE(has(outcome.out, c.said), c.said);
  }
  // A limb of 5 mm holds no book, a sheet of 0.27 µm makes a stack of more sheets than there are.
  const Outcome narrow = steplap_does({"check", k_layout, "--set", "core.core.limb_width=5 mm", "--set", "core.core.yoke_height=5 mm"});
  CHECK(narrow.code == 3);
  CHECK(has(narrow.err, "is wider than the sheets: where a limb of 0.005 m"));
  const Outcome thin = steplap_does({"check", k_layout, "--set", "core.core.sheet_thickness=0.27 µm"});
  CHECK(has(thin.out + thin.err, "'sheet_thickness' = 2.7e-07 m is unusual"));
}

// Results read back, thinned, made into a page and into images.
#include "mbd/io/reader.h"
#include "mbd/run/drawing.h"
#include "mbd/run/result_files.h"
#include "mbd/run/results.h"
#include "mbd/run/sketch.h"
#include "tests/tools/steplap/workbench.h"
#include "tools/pages/figure.h"
#include "tools/pages/load_case.h"
#include "tools/pages/report_data.h"
#include "tools/pages/report_page.h"
#include "tools/pages/thinning.h"
#include "tools/steplap/command.h"
#include "transformer/program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A run of `rows` samples of two channels, as if read from a folder.
Results made_results(std::size_t rows) {
  Results results;
  results.folder = "out/made";
  results.name = "made";
  results.channels = {{"mass.x", "m", {}}, {"spring.force", "N", {}}};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 1e-4 * static_cast<double>(i);
    results.times.push_back(t);
    results.channels[0].values.push_back(0.1 * t);
    results.channels[1].values.push_back(std::sin(40.0 * t));
  }
  results.model = "title = \"made\"\n";
  results.drawing = R"({"bodies":[],"elements":[],"sheets":[],"plots":[],"seen_from":""})";
  results.summary = R"({"extremes":{"mass.x":{"max":1},"spring.force":{"max":1}},"final_state":{}})";
  return results;
}

std::string usage_error(const std::string& folder) {
  try {
    static_cast<void>(read_results(folder));
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

bool is_gnuplot_there() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; } // NOLINT: constant

} // namespace

TEST_CASE("thinning keeps first, last, every peak and the gaps") {
  std::vector<double> values(10000, 0.0);
  values[4321] = 7.0;
  values[4322] = -3.0;
  values[9000] = std::numeric_limits<double>::quiet_NaN();
  const auto kept = thinned(values, 100);
  CHECK(kept.size() <= 302);
  CHECK(std::is_sorted(kept.begin(), kept.end()));
  for (const std::size_t i : {0U, 4321U, 4322U, 9000U, 9999U}) CHECK(std::count(kept.begin(), kept.end(), i) == 1);
  CHECK(thinned(values, 4999).size() == values.size());
  CHECK(thinned({}, 10).empty());
}

TEST_CASE("results are read back to the last bit, names with quotes and commas too") {
  const Workbench bench;
  std::string text = k_bouncer;
  text.replace(text.find("\"floor\""), 7, "'floor, \"hard\"'");
  REQUIRE(steplap_does({"simulate", bench.write("a.toml", text), "-q", "-o", bench.at("out")}).code == 0);
  const Results results = read_results(bench.at("out/a"));
  const Run run = run_model(load_model(bench.at("a.toml")));
  const Trajectory& trajectory = *run.result.trajectory;
  CHECK(results.name == "a");
  CHECK(results.times == trajectory.times());
  REQUIRE(results.channels.size() == trajectory.channels().size());
  for (std::size_t i = 0; i < results.channels.size(); ++i) {
    CHECK(results.channels[i].name == trajectory.channels()[i]->name);
    CHECK(results.channels[i].unit == trajectory.channels()[i]->unit);
    CHECK(results.channels[i].values == trajectory.series(results.channels[i].name));
  }
  REQUIRE(results.events.size() == run.result.events.size());
  CHECK(results.events.front().t == run.result.events.front().t);
  CHECK(results.events.front().element == "floor, \"hard\"");
}

TEST_CASE("folders without results and damaged files are told apart") {
  const Workbench bench;
  CHECK(has(usage_error(bench.at("nothing")), "is not a folder"));
  bench.write("empty/notes.txt", "mine");
  CHECK(has(usage_error(bench.at("empty")), "holds no results"));
  REQUIRE(steplap_does({"simulate", bench.write("a.toml", k_bouncer), "-q", "-o", bench.at("out")}).code == 0);
  fs::remove(bench.at("out/a/drawing.json"));
  CHECK(has(usage_error(bench.at("out/a")), "drawing.json' is missing"));
}

TEST_CASE("names and titles stay text: no markup of a model reaches the page") {
  const Workbench bench;
  std::string text = k_bouncer;
  text.replace(text.find("a bouncing mass"), 15, "</script><script>alert(1)</script>");
  text.replace(text.find("\"floor\""), 7, "\"<img src=x onerror=alert(2)>\"");
  REQUIRE(steplap_does({"simulate", bench.write("<b>a.toml", text), "-q", "-o", bench.at("out"), "--report"}).code == 0);
  const std::string page = text_of(bench.at("out/<b>a/report.html"));
  CHECK_FALSE(has(page, "alert(1)</script>"));
  CHECK_FALSE(has(page, "<img"));
  CHECK_FALSE(has(page, "<b>a"));
  CHECK(has(page, "\\u003cimg src=x onerror=alert(2)>"));
  CHECK(has(page, "<title>steplap: &lt;b&gt;a</title>"));
}

TEST_CASE("a page needs no other file and no network") {
  const std::string page = report_page({made_results(10)});
  for (const char* reference : {" src=\"", "<link rel=\"stylesheet", "@import", "url(http", "sourceMappingURL"})
    CHECK_MESSAGE(!has(page, reference), reference);
  CHECK(has(page, "default-src 'none'")); // and a browser is told to make no request
}

TEST_CASE("large results make a page below 5 MB, with the peaks of every curve") {
  Results results = made_results(240000);
  results.channels[1].values[123456] = 17.0;
  for (int i = 0; i < 60; ++i) results.channels.push_back({"more" + std::to_string(i) + ".force", "N", results.channels[1].values});
  const std::string page = report_page({results});
  CHECK(page.size() < 5000000);
  const auto json = nlohmann::json::parse(report_data({results}));
  CHECK(json["runs"][0]["is_thinned"] == true);
  CHECK(json["runs"][0]["channels_left_out"] == 0);
  CHECK(json["runs"][0]["channels"].size() == 62);
}

TEST_CASE("with more channels than a page can hold, those of plots stay") {
  Results results = made_results(300);
  results.drawing =
      R"({"bodies":[],"elements":[],"sheets":[],"plots":[{"name":"p","title":"","channels":["spring.f*"],"bounds":[]}],"seen_from":""})";
  for (int i = 0; i < 9000; ++i)
    results.channels.insert(results.channels.begin(), {"body" + std::to_string(i) + ".vx", "m/s", results.channels[0].values});
  const std::string data = report_data({results});
  CHECK(data.size() < 4800000);
  const auto json = nlohmann::json::parse(data);
  CHECK(json["runs"][0]["channels_left_out"] > 0);
  bool is_kept = false;
  for (const auto& channel : json["runs"][0]["channels"]) is_kept = is_kept || channel["name"] == "spring.force";
  CHECK(is_kept);
}

TEST_CASE("short runs keep all samples, as single precision differences from the first") {
  const auto json = nlohmann::json::parse(report_data({made_results(100)}));
  const auto& channel = json["runs"][0]["channels"][0];
  CHECK(channel["zero"] == 0.0);
  CHECK_FALSE(channel.contains("times"));
  CHECK(channel["values"].get<std::string>().size() == 4 * ((100 * sizeof(float) + 2) / 3));
  // SHA-256 of the bytes `title = "made"\n`, as sha256sum tells it.
  CHECK(json["runs"][0]["model_sha256"] == "5d99dbae019bc0b8ec2fcdf902c8ceb419ff0f476f8ca724e4ca4c278f9ac6e1");
}

TEST_CASE("bodies without an outline get one from where elements act and from their inertia") {
  const auto drawing = [](const std::string& text) {
    return nlohmann::json::parse(drawing_json(parse_model(text, "a.toml", program_catalogue()), *program_catalogue().views));
  };
  const auto pendulum = drawing(R"(
simulation = { step = 1e-3 }
[[body]]
name = "rod"
mass = 1
inertia = 0.5
position = [2, 0]
[[element]]
kind = "revolute"
name = "pivot"
a = { body = "rod", at = [0, 0] }
b = "ground"
)");
  // A slender rod would have J = 1.3 kg m²: this one stays a line.
  CHECK(pendulum["bodies"][0]["outline"] == nlohmann::json({{-2.0, 0.0}, {0.0, 0.0}}));
  CHECK(pendulum["bodies"][0]["is_outline_given"] == false);
  CHECK(pendulum["elements"][0]["symbol"] == "pin");
  // Feet at x = ±1, 0.5 below the centre of gravity: 1 high, and J = m (a² + b²)/12 makes it 3 long.
  const auto box = drawing(R"(
simulation = { step = 1e-3 }
[[body]]
name = "box"
mass = 12
inertia = 10
position = [0, 0.5]
[[element]]
kind = "unilateral_contact"
name = "left"
a = { body = "box", at = [-1, 0] }
b = "ground"
stiffness = 1
[[element]]
kind = "unilateral_contact"
name = "right"
a = { body = "box", at = [1, 0] }
b = "ground"
stiffness = 1
)");
  CHECK(box["bodies"][0]["outline"] == nlohmann::json({{-1.5, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {-1.5, 0.5}}));
  // Nothing says how large it is, whatever its inertia.
  const auto free = drawing("simulation = { step = 1e-3 }\n[[body]]\nname = \"stone\"\nmass = 1\ninertia = 0.5\n");
  CHECK(free["bodies"][0]["outline"].empty());
}

namespace {

nlohmann::json drawing_of(const std::string& elements) {
  const std::string bodies = "simulation = { step = 1e-3 }\n[[body]]\nname = \"ball\"\nmass = 1\ninertia = 1e6\nposition = [1, 2]\n"
                             "[[body]]\nname = \"slab\"\nmass = 1\ninertia = 1\nangle = \"90 deg\"\n";
  return nlohmann::json::parse(drawing_json(parse_model(bodies + elements, "a.toml", program_catalogue()), *program_catalogue().views));
}

bool is_near(const nlohmann::json& numbers, const std::vector<double>& wanted) {
  bool is = numbers.size() == wanted.size();
  for (std::size_t i = 0; is && i < wanted.size(); ++i) is = std::abs(numbers[i].get<double>() - wanted[i]) < 1e-14; // roundings of 3
  return is;
}

} // namespace

TEST_CASE("round contacts give bodies and the ground their circles and segments, in the bodies' axes, each once") {
  const auto drawing = drawing_of(R"(
[[element]]
kind = "segment_contact"
name = "on the slab"
a = "ball"
b = { body = "slab", point = [0.5, 0], angle = "90 deg" }
radius = 0.3
from = [1, 0]
to = [3, 0]
thickness = 0.1
stiffness = 1e6
[[element]]
kind = "circle_contact"
name = "in the drum"
a = "ball"
b = { body = "ground", at = [1, 2] }
radius_a = 0.3
radius_b = 2
inside = true
stiffness = 1e6
)");
  const auto& ball = drawing["bodies"][0];
  REQUIRE(ball["circles"].size() == 1);
  CHECK(is_near(ball["circles"][0], {0.0, 0.0, 0.3, 0.0}));
  CHECK(ball["outline"].empty()); // its circle covers where elements act
  REQUIRE(drawing["bodies"][1]["segments"].size() == 1);
  CHECK(is_near(drawing["bodies"][1]["segments"][0], {0.5, 1.0, 0.5, 3.0, 0.1}));
  REQUIRE(drawing["ground"]["circles"].size() == 1);
  CHECK(is_near(drawing["ground"]["circles"][0], {1.0, 2.0, 2.0, 1.0}));
  CHECK(drawing["elements"][0]["shapes"][0]["type"] == "edge_touch");
  CHECK(drawing["elements"][1]["shapes"][0]["type"] == "touch");
}

TEST_CASE("a wheel is drawn on its road, a flat one without ends, and a skate along the way in which it runs") {
  const std::string rest =
      "stiffness = 1e6\nfriction = 0.8\nslip_stiffness = 1e4\nrelaxation_length = 0.2\ntread_damping = 50\nradius = 0.3\n";
  const auto drawing = drawing_of("[[element]]\nkind = \"tyre\"\nname = \"flat\"\na = \"ball\"\n" + rest +
                                  "[[element]]\nkind = \"tyre\"\nname = \"hilly\"\na = \"ball\"\nroad = [[-2, 0], [0, 0.1], [2, 0]]\n" +
                                  rest + "[[element]]\nkind = \"skate\"\nname = \"edge\"\na = \"slab\"\naxis = [0, 2]\n");
  const auto& flat = drawing["elements"][0]["shapes"][0];
  CHECK(flat["style"] == "flat");
  CHECK(is_near(flat["sizes"], {0.3, -300.0, 0.0, 300.0, 0.0, 0.0}));
  const auto& hilly = drawing["elements"][1]["shapes"][0]["sizes"];
  REQUIRE(hilly.size() == 20); // the radius, the first end, eight more, and the thickness
  CHECK(hilly[3].get<double>() == doctest::Approx(-1.5));
  CHECK(hilly[5] == 0.0);
  CHECK(hilly[18].get<double>() == doctest::Approx(2.0));
  CHECK(drawing["ground"]["segments"].size() == 8); // of the hills alone
  const auto& edge = drawing["elements"][2]["shapes"][0];
  CHECK(edge["type"] == "rail");
  CHECK(edge["style"] == "skate");
  CHECK(edge["at"].size() == 1);
  CHECK(is_near(edge["direction"], {0.0, 1.0}));
}

TEST_CASE("contacts on one line share a half-plane, whose normal points away from what is solid") {
  const auto contact = [](const std::string& name, const std::string& at, const std::string& normal) {
    return "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + name + "\"\na = \"ball\"\nb = { body = \"ground\", at = " + at +
           " }\nnormal = " + normal + "\nstiffness = 1e6\n";
  };
  const auto drawing =
      drawing_of(contact("left", "[-1, 0.5]", "[0, 2]") + contact("right", "[7, 0.5]", "[0, 1]") + contact("wall", "[-3, 0]", "[1, 0]"));
  REQUIRE(drawing["planes"].size() == 2);
  CHECK(drawing["planes"][0]["body"] == "ground");
  CHECK(is_near(drawing["planes"][0]["normal"], {0.0, 1.0}));
  CHECK(is_near(drawing["planes"][1]["normal"], {1.0, 0.0}));
  CHECK(drawing["elements"][0]["shapes"][0]["plane"] == 0);
  CHECK(drawing["elements"][1]["shapes"][0]["plane"] == 0);
  CHECK(drawing["elements"][2]["shapes"][0]["plane"] == 1);
}

TEST_CASE("ropes go over their pulleys, motors are arcs about what they turn, dampers are no springs") {
  const auto drawing = drawing_of(R"(
[[marker]]
name = "pulley"
body = "ground"
at = [0, 5]
[[element]]
kind = "rope"
name = "rope"
a = "ball"
b = "slab"
over = ["pulley"]
stiffness = 1e5
[[element]]
kind = "motor"
name = "drive"
a = "slab"
constant_effort = 1
[[element]]
kind = "spring_damper"
name = "damper"
a = "slab"
b = "ball"
damping = 3
)");
  const auto& rope = drawing["elements"][0]["shapes"][0];
  CHECK(rope["type"] == "rope");
  REQUIRE(rope["at"].size() == 3);
  CHECK(is_near(rope["at"][1]["point"], {0.0, 5.0}));
  CHECK(rope["quantity"] == "tension");
  const auto& motor = drawing["elements"][1]["shapes"][0];
  CHECK(motor["type"] == "arc");
  CHECK(motor["style"] == "motor");
  CHECK(motor["at"][0]["body"] == "slab");
  CHECK(drawing["elements"][2]["shapes"][0]["style"] == "damper");
}

namespace {

struct Faces : Element {
  std::string a = "slab", b = "ground";
  std::vector<Vec2> outline_a, outline_b;
  std::optional<Vec2> normal;
  double static_friction = 0.0;
};

// As elements of outlines name their fields; markers are turned by a quarter, at (1, 0).
std::vector<Shape> shapes_of(const Faces& faces, std::map<std::string, BodyGeometry>& geometry) {
  ElementKind kind;
  kind.name = "polygon_contact";
  kind.fields.add("a", &Faces::a).as(FieldType::marker);
  kind.fields.add("b", &Faces::b).as(FieldType::marker);
  kind.fields.add("outline_a", &Faces::outline_a);
  kind.fields.add("outline_b", &Faces::outline_b);
  kind.fields.add("normal", &Faces::normal);
  kind.fields.add("static_friction", &Faces::static_friction);
  kind.holds<Faces>();
  const ElementEntry entry(&kind, std::make_shared<Faces>(faces));
  Sketch sketch(
      entry,
      [](const std::string& name) {
        return MarkerPlace{name, Vec2(1.0, 0.0), 0.5 * M_PI};
      },
      [&](const std::string& body) -> BodyGeometry& { return geometry[body]; });
  draw_element(sketch, program_catalogue().views->of(*program_catalogue().find_element(kind.name)).draw);
  return sketch.shapes();
}

} // namespace

TEST_CASE("outlines that press on each other are their bodies' polygons; on a half-plane their corners are its feet") {
  Faces faces;
  faces.outline_a = {{0.0, 0.0}, {2.0, 0.0}, {0.0, 1.0}};
  faces.normal = Vec2(0.0, 3.0);
  faces.static_friction = 0.3;
  std::map<std::string, BodyGeometry> geometry;
  const std::vector<Shape> shapes = shapes_of(faces, geometry);
  REQUIRE(shapes.size() == 2);
  CHECK(shapes[0].type == "faces");
  REQUIRE(shapes[0].at.size() == 4); // three corners, the plane
  CHECK((shapes[0].at[1].point - Vec2(1.0, 2.0)).norm() < 1e-15);
  REQUIRE(shapes[0].direction);
  CHECK((*shapes[0].direction - Vec2(-1.0, 0.0)).norm() < 1e-15);
  CHECK(shapes[1].type == "friction");
  REQUIRE(geometry["slab"].polygons.size() == 1);
  CHECK(geometry["slab"].polygons.begin()->size() == 3);
  CHECK(geometry["ground"].polygons.empty());
  // Without corners of its own the body's outline is meant.
  Faces on_body;
  on_body.b = "ball";
  const std::vector<Shape> own = shapes_of(on_body, geometry);
  REQUIRE(own.size() == 1);
  CHECK(own[0].at.size() == 2);
  CHECK_FALSE(own[0].direction);
  // The ground without corners is what lies below its marker.
  const std::vector<Shape> ground = shapes_of(Faces(), geometry);
  REQUIRE(ground[0].direction);
  CHECK((*ground[0].direction - Vec2(-1.0, 0.0)).norm() < 1e-15);
}

TEST_CASE("every kind of element of the catalogue has its own symbol; one that has none is drawn by something neutral") {
  for (const ElementKind* kind : program_catalogue().elements) {
    CAPTURE(kind->name);
    const ElementEntry entry(kind, kind->create());
    BodyGeometry geometry;
    Sketch sketch(
        entry,
        [](const std::string&) {
          return MarkerPlace{"ground", Vec2::Zero(), 0.0};
        },
        [&](const std::string&) -> BodyGeometry& { return geometry; });
    draw_element(sketch, program_catalogue().views->of(*kind).draw);
    for (const Shape& shape : sketch.shapes()) CHECK(shape.type != "neutral");
  }
  ElementKind unheard_of = *program_catalogue().find_element("distance");
  unheard_of.name = "unheard_of";
  const ElementEntry entry(&unheard_of, unheard_of.create());
  BodyGeometry geometry;
  Sketch sketch(
      entry,
      [](const std::string&) {
        return MarkerPlace{"ground", Vec2::Zero(), 0.0};
      },
      [&](const std::string&) -> BodyGeometry& { return geometry; });
  draw_element(sketch, program_catalogue().views->of(unheard_of).draw);
  REQUIRE(sketch.shapes().size() == 1);
  CHECK(sketch.shapes()[0].type == "neutral");
}

TEST_CASE("the drawing has the holes of sheets, round ones and cutouts, each in its body's axes") {
  // The limb's centre of gravity is at (3, 4) and it is turned by a quarter: what is at (3, 4) + (a, b) on the ground is
  // at (b, -a) in its axes.
  const auto sheets = [](const std::string& more) {
    return nlohmann::json::parse(drawing_json(parse_model(R"(
simulation = { step = 1e-3 }
[[body]]
name = "yokes"
fixed = true
[[body]]
name = "limb"
mass = 1
inertia = 1
position = [3, 4]
angle = "90 deg"
[[element]]
kind = "step_lap_joint"
name = "joint"
limb = "limb"
active_part = "yokes"
[[element]]
kind = "step_lap_interface"
name = "corner"
joint = "joint"
yoke = [[2, 3], [4, 3], [4, 5], [2, 5]]
limb = [[2, 3], [4, 3], [4, 5], [2, 5]]
pressure = 1
static_friction = 0.5
)" + more,
                                                          "a.toml", program_catalogue()),
                                              *program_catalogue().views))["sheets"][0];
  };
  const auto ring_is = [](const nlohmann::json& ring, const std::vector<std::vector<double>>& wanted) {
    REQUIRE(ring.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      for (const int c : {0, 1}) CHECK(std::abs(ring[i][c].get<double>() - wanted[i][c]) < 1e-14); // a few roundings of 5
  };
  const auto whole = sheets("");
  CHECK(whole["yoke_holes"].empty());
  CHECK(whole["limb_holes"].empty());
  const auto pierced = sheets("yoke_cutouts = [[[2.5, 3.5], [3, 3.5], [3, 4]], [[3.5, 4.5], [3.75, 4.5], [3.5, 4.75]]]\n"
                              "limb_cutouts = [[[3, 4], [3.5, 4], [3.5, 4.25], [3, 4.25]]]\n"
                              "limb_holes = [[2.5, 4]]\nhole_diameter = 0.5\nhole_sides = 4\n");
  REQUIRE(pierced["yoke_holes"].size() == 2);
  ring_is(pierced["yoke_holes"][0], {{2.5, 3.5}, {3, 3.5}, {3, 4}});
  ring_is(pierced["yoke_holes"][1], {{3.5, 4.5}, {3.75, 4.5}, {3.5, 4.75}});
  REQUIRE(pierced["limb_holes"].size() == 2);
  const double r = 0.5 * 0.5 * std::sqrt(0.5 * M_PI); // a square of the circle's area: 2 r² = π d²/4
  ring_is(pierced["limb_holes"][0], {{r, 0.5}, {0, 0.5 + r}, {-r, 0.5}, {0, 0.5 - r}});
  ring_is(pierced["limb_holes"][1], {{0, 0}, {0, -0.5}, {0.25, -0.5}, {0.25, 0}});
}

TEST_CASE("a page holds no more channels than a reader could ask for, those of plots first") {
  Results results = made_results(3);
  for (int i = 0; i < 12000; ++i) results.channels.push_back({"body " + std::to_string(i) + ".omega", "rad/s", {0.0, 0.0, 0.0}});
  results.channels.push_back({"asked for.omega", "rad/s", {0.0, 1.0, 2.0}});
  results.drawing =
      R"({"bodies":[],"elements":[],"sheets":[],"plots":[{"name":"p","title":"","channels":["asked*"],"bounds":[]}],"seen_from":""})";
  const auto run = nlohmann::json::parse(report_data({results}))["runs"][0];
  CHECK(run["channels"].size() == 10000);
  CHECK(run["channels_left_out"] == 12003 - 10000);
  CHECK(run["is_thinned"] == false);
  bool is_kept = false;
  for (const auto& channel : run["channels"]) is_kept = is_kept || channel["name"] == "asked for.omega";
  CHECK(is_kept);
}

TEST_CASE("modes --report: a page that stands alone, names are text, nothing is overwritten unasked") {
  const Workbench bench;
  std::string text = k_oscillator;
  const std::string file = bench.write("a.toml", text.replace(text.find("a mass"), 6, "</script><b>bold</b>"));
  const Outcome done = steplap_does({"modes", file, "--report", bench.at("modes.html"), "-q"});
  CAPTURE(done.err);
  REQUIRE(done.code == 0);
  const std::string page = text_of(bench.at("modes.html"));
  CHECK(has(page, "\\u003c/script>\\u003cb>bold\\u003c/b>"));
  CHECK_FALSE(has(page, "<b>bold"));
  CHECK_FALSE(has(page, "@DATA@"));
  CHECK(steplap_does({"modes", file, "--report", bench.at("modes.html"), "-q"}).code == 2);
  CHECK(steplap_does({"modes", file, "--report", bench.at("modes.html"), "-q", "-f"}).code == 0);
}

TEST_CASE("an element's drawing hint is read, checked and kept") {
  const Workbench bench;
  std::string text = k_oscillator;
  text += "draw = \"hidden\"\n";
  CHECK(
      has(drawing_json(read_model(bench.write("a.toml", text), program_catalogue()), *program_catalogue().views), "\"symbol\":\"hidden\""));
  const Outcome outcome = steplap_does({"check", bench.write("b.toml", std::string(k_oscillator) + "draw = \"sprung\"\n")});
  CHECK(outcome.code == 3);
  CHECK(has(outcome.err, "draw"));
  CHECK(has(outcome.err, "did you mean 'spring'?"));
  const Outcome unknown = steplap_does({"check", bench.write("c.toml", std::string(k_oscillator) + "drew = \"spring\"\n")});
  CHECK(unknown.code == 3);
  CHECK(unknown.err.find("'drew'") == unknown.err.rfind("'drew'")); // once, though two tables are read
}

TEST_CASE("the load case of a run: gravity, speed, drives and their signals, but no other element or signal") {
  const std::string model = R"(
source = "drawing 4711"
gravity = [0.0, -9.81]
simulation = { end = 1.0, velocity = ["1.1 km/h", 0.0] }
[[element]]
name = "drive"
kind = "prescribed_motion"
a = { body = "lorry", at = [0, 1] }
signal = "braking"
[[element]]
name = "foot"
kind = "unilateral_contact"
[[signal]]
name = "braking"
kind = "table"
times = [0, 1, 2, 3, 4, 5, 6, 7, 8]
peak = "-0.8 gravity"
[[signal]]
name = "humping"
kind = "half_sine"
peak = "2 gravity"
)";
  const auto drawing = nlohmann::ordered_json::parse(
      R"({"elements": [{"name": "drive", "shapes": [{"type": "arrow"}]}, {"name": "foot", "shapes": [{"type": "contact"}]}]})");
  const auto rows = load_case_json(model, drawing).get<std::vector<std::pair<std::string, std::string>>>();
  const std::vector<std::pair<std::string, std::string>> wanted{
      {"gravity", "[0, -9.81]"},
      {"initial velocity", "[1.1 km/h, 0]"},
      {"element 'drive'", "prescribed_motion, a = {body = lorry, at = [0, 1]}, signal = braking"},
      {"signal 'braking'", "table, times = 9 values, peak = -0.8 gravity"},
      {"source of the values", "drawing 4711"}};
  CHECK(rows == wanted);
}

TEST_CASE("report --sheet: one result, beside it, and gone with it") {
  const Workbench bench;
  const std::string a = bench.write("a.toml", k_bouncer);
  REQUIRE(steplap_does({"simulate", a, "-q", "-o", bench.at("out")}).code == 0);
  REQUIRE(steplap_does({"report", bench.at("out/a"), "--sheet"}).code == 0);
  CHECK(bench.content("out/a").count("sheet.html") == 1);
  CHECK(steplap_does({"report", bench.at("out/a"), "--sheet"}).code == 2); // nothing is overwritten unasked
  const Outcome two = steplap_does({"report", bench.at("out/a"), bench.at("out/a"), "--sheet"});
  CHECK(two.code == 2);
  CHECK(has(two.err, "name one folder instead of 2"));
  // A sheet of earlier results is not left beside new ones.
  REQUIRE(steplap_does({"simulate", a, "-q", "-o", bench.at("out"), "-f"}).code == 0);
  CHECK(bench.content("out/a").count("sheet.html") == 0);
}

TEST_CASE("report: places, refusals and the page of simulate") {
  const Workbench bench;
  const std::string a = bench.write("a.toml", k_bouncer), b = bench.write("b.toml", k_oscillator);
  REQUIRE(steplap_does({"simulate", a, b, "-q", "-o", bench.at("out"), "--report"}).code == 0);
  CHECK(bench.content("out").count("report.html") == 1);
  const Outcome again = steplap_does({"report", bench.at("out/a"), bench.at("out/b")});
  CHECK(again.code == 2);
  CHECK(has(again.err, "exists already"));
  CHECK(steplap_does({"report", bench.at("out/a"), bench.at("out/b"), "--force"}).code == 0);
  CHECK(steplap_does({"report", bench.at("out/a") + "/"}).code == 0);
  CHECK(bench.content("out/a").count("report.html") == 1);
  // A report of results that are gone goes with them.
  CHECK(steplap_does({"simulate", a, "-q", "-o", bench.at("out"), "--force"}).code == 0);
  CHECK(bench.content("out/a").count("report.html") == 0);
  // Told before the run, not after it: there are no results then.
  bench.write("new/a/report.html", "mine");
  const Outcome refused = steplap_does({"simulate", a, "-o", bench.at("new"), "--report"});
  CHECK(refused.code == 2);
  CHECK(has(refused.err, "is there already"));
  CHECK(bench.content("new/a") == std::set<std::string>{"report.html"});
}

TEST_CASE("a hold that is required and not given is exit code 5; the results are there") {
  const Workbench bench;
  const auto code = [&](const std::string& limit) {
    const std::string model =
        bench.write("a.toml", std::string(k_bouncer) + "[[acceptance]]\nname = \"height\"\nchannel = \"ball.y\"\n" + limit);
    return steplap_does({"simulate", model, "-q", "-f", "-o", bench.at("out"), "--require-hold"}).code;
  };
  CHECK(code("at_most = 0.11\n") == 0); // it falls from 0.1 m
  CHECK(code("at_most = 0.09\n") == 5);
  CHECK(has(text_of(bench.at("out/a/summary.json")), "\"verdict\": \"inspect\""));
  CHECK(steplap_does({"simulate", bench.write("b.toml", k_bouncer), "-q", "-o", bench.at("out"), "--require-hold"}).code == 5);
}

TEST_CASE("gnuplot scripts: names are text, units have prefixes, panels of one unit") {
  const std::vector<double> t{0, 1, 2}, v{0, -2500, std::numeric_limits<double>::infinity()};
  Figure figure;
  figure.panels = {{"it's `rm -rf /`", "N", {{"a'b\n", &t, &v, 0, 0, 1.0}}}};
  const std::string script = gnuplot_script(figure, "svg", "/x/it's.svg");
  CHECK(has(script, "set title 'it''s `rm -rf /`'"));
  CHECK(has(script, "set output '/x/it''s.svg'"));
  CHECK(has(script, "title 'a''b '"));
  CHECK(has(script, "'[kN]'"));
  CHECK(has(script, "\n1 -2.5\n2 NaN\n"));
}

TEST_CASE("plot: images of channels, and what cannot be plotted") {
  const Workbench bench;
  const std::string a = bench.write("a.toml", k_bouncer), out = bench.at("out/a");
  REQUIRE(steplap_does({"simulate", a, "-q", "-o", bench.at("out")}).code == 0);
  const auto error = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "plot");
    const Outcome outcome = steplap_does(arguments);
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(has(error({out, "--channels", "ball.y", "-o", bench.at("x.gif")}), ".svg, .png or .pdf"));
  CHECK(has(error({out, "--channels", "bell.y", "-o", bench.at("x.svg")}), "did you mean 'ball.y'?"));
  CHECK(has(error({out, "--channels", "ball.y", "--channels", "ball.vy", "-o", bench.at("x.svg")}), "plot them apart"));
  CHECK(has(error({out, "-o", bench.at("x.svg")}), "either --channels or --plot"));
  CHECK(has(error({out, "--plot", "Fig. 1", "-o", bench.at("x.svg")}), "has no plot 'Fig. 1'"));
  CHECK(bench.content("").count("x.svg") == 0);
  if (!is_gnuplot_there()) return;
  CHECK(steplap_does({"plot", out, "--channels", "ball.y", "-o", bench.at("y.svg")}).code == 0);
  CHECK(has(text_of(bench.at("y.svg")), "</svg>"));
  CHECK(has(text_of(bench.at("y.svg")), "ball.y"));
  CHECK(has(error({out, "--channels", "ball.y", "-o", bench.at("y.svg")}), "exists already"));
}

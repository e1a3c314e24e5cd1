// Model files that are well formed: what the model holds after reading, inheritance, overrides.
#include "mbd/io/reader.h"
#include "mbd/model/signal_network.h"
#include "mbd/model/validate.h"
#include "tests/mbd/small_catalogue.h"

#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

using namespace steplap;
using steplap::testing::Pusher;
using steplap::testing::small_catalogue;
using steplap::testing::Spring;

namespace {

const std::string k_plain = R"(
title = "a test"
gravity = [0, "-1 gravity"]

[simulation]
end = "800 ms"
step = 1e-4
velocity = ["1.1 km/h", 0]

[output]
channels = ["a.*"]

[[body]]
name = "tank"
mass = "47 t"
inertia = 65200
position = [1, "1950 mm"]
angle = "90 deg"
cg = [0.5, 0]

[[body]]
name = "wall"
fixed = true

[[marker]]
name = "foot"
body = "tank"
point = [0, -1]

[[signal]]
name = "brake"
kind = "haversine"
peak = "-0.6 gravity"
start = 0.05
duration = "0.1 s"

[[element]]
name = "rope"
kind = "spring"
a = "foot"
b = { body = "ground", at = [1, 2], angle = "0.1 rad" }
stiffness = "200 MN/m"
damping = "5 kN s/mm"
table = [["0 mm", 0], ["1 mm", "2 kN"]]

[[element]]
name = "strut"
kind = "spring"
a = "tank"
b = "ground"
stiffness = 5

[[element]]
name = "push"
kind = "pusher"
body = "tank"
signal = "brake"
against = ["rope", "strut"]
offsets = [1, "2 cm"]
)";

const std::string k_two = "[simulation]\nstep = 1e-3\n[[body]]\nname = \"a.b c\"\nmass = 1\ninertia = 1\n"
                          "[[element]]\nname = \"rope\"\nkind = \"spring\"\na = \"a.b c\"\n"
                          "b = { body = \"ground\", at = [1, 2] }\nstiffness = 1\n";

const Spring& spring(const Model& model, std::size_t index) { return dynamic_cast<const Spring&>(*model.elements.at(index).element); }

const Marker& marker_named(const Model& model, const std::string& name) {
  for (const Marker& marker : model.markers)
    if (marker.name == name) return marker;
  FAIL("no marker " << name);
  return model.markers.front();
}

// A folder of its own for files that extend each other.
class Folder {
public:
  Folder() : path_(std::filesystem::temp_directory_path() / "steplap_test_reader") {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ / "below");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

private:
  std::filesystem::path path_;
};

} // namespace

TEST_CASE("a model file becomes a model") {
  const Model model = parse_model(k_plain, "plain.toml", small_catalogue());
  CHECK(model.header.title == "a test");
  CHECK(model.header.gravity.y() == doctest::Approx(-9.80665).epsilon(1e-15));
  CHECK(model.simulation.end == doctest::Approx(0.8).epsilon(1e-15));
  CHECK(model.simulation.velocity.x() == doctest::Approx(1.1 / 3.6).epsilon(1e-15));
  CHECK(model.output.channels == std::vector<std::string>{"a.*"});
  REQUIRE(model.bodies.size() == 2);
  const Body& tank = model.bodies[0];
  CHECK(tank.mass == 47000.0);
  CHECK(tank.angle == doctest::Approx(1.5707963267948966).epsilon(1e-15));
  CHECK(tank.reference_pose().isApprox(Vec3(1.0, 2.45, 1.5707963267948966), 1e-14));
  CHECK(tank.where.line == 13);
  CHECK(model.bodies[1].fixed);

  CHECK(spring(model, 0).stiffness == 2e8);
  CHECK(*spring(model, 0).damping == doctest::Approx(5e6).epsilon(1e-15));
  CHECK(spring(model, 0).table.at(1).isApprox(Vec2(1e-3, 2000.0), 1e-15));
  CHECK_FALSE(spring(model, 1).damping);
  CHECK(spring(model, 1).turns == 3);
  const auto& push = dynamic_cast<const Pusher&>(*model.elements.at(2).element);
  CHECK(push.against == std::vector<std::string>{"rope", "strut"});
  CHECK(push.offsets == std::vector<double>{1.0, 0.02});
  const SignalEntry& brake = model.signals.at(0);
  CHECK(brake.kind->build(*brake.definition).value(0.1) == doctest::Approx(-0.6 * 9.80665).epsilon(1e-14));
}

TEST_CASE("every marker of an element is there after reading, and has a place") {
  const Model model = parse_model(k_plain, "plain.toml", small_catalogue());
  CHECK(spring(model, 0).a == "foot");
  CHECK(spring(model, 0).b == "rope.b");
  CHECK(marker_named(model, "rope.b").at->isApprox(Vec2(1, 2)));
  CHECK(marker_named(model, "rope.b").angle == 0.1);
  CHECK(spring(model, 1).a == "tank");
  CHECK(marker_named(model, "tank").body == "tank");
  CHECK(*marker_named(model, "tank").point == Vec2(0.5, 0.0));
  CHECK(*marker_named(model, "ground").point == Vec2(0.0, 0.0));
  for (const Marker& marker : model.markers) CHECK(marker.point.has_value() != marker.at.has_value());
}

TEST_CASE("extends lays a file over another") {
  const Folder folder;
  const std::string base = folder.write("base.toml", k_plain);
  const std::string middle = folder.write("below/middle.toml", R"(
extends = "../base.toml"
title = "middle"
[simulation]
end = 0.5
[[element]]
name = "rope"
stiffness = 7
b = "tank"
)");
  const std::string top = folder.write("top.toml", R"(
extends = "below/middle.toml"
[simulation]
unset = ["velocity"]
[[element]]
name = "push"
remove = true
[[element]]
name = "new"
kind = "spring"
a = "tank"
b = "wall"
stiffness = 1
[[body]]
name = "tank"
mass = 3
)");
  const Model model = read_model(top, small_catalogue());
  CHECK(model.header.title == "middle");
  CHECK(model.simulation.end == 0.5);
  CHECK(model.simulation.step == 1e-4);
  CHECK(model.simulation.velocity == Vec2(0, 0));
  REQUIRE(model.elements.size() == 3);
  CHECK(spring(model, 0).stiffness == 7.0);
  CHECK(spring(model, 0).a == "foot");
  CHECK(spring(model, 0).b == "tank");
  CHECK(model.elements[2].element->name == "new");
  CHECK(model.bodies[0].mass == 3.0);
  CHECK(model.bodies[0].inertia == 65200.0);

  const std::string text = model_source_text(top);
  CHECK(text.find("# ---- top.toml ----") == 0);
  CHECK(text.find("# ---- middle.toml ----") < text.find("# ---- base.toml ----"));
  CHECK(text.find("name = \"wall\"") != std::string::npos);
}

TEST_CASE("an entry drops a key that it inherits") {
  const Folder folder;
  folder.write("base.toml", k_plain);
  const std::string top = folder.write("top.toml", R"(
extends = "base.toml"
[[element]]
name = "rope"
unset = ["damping"]
preload = 5
)");
  const Model base = read_model(top, small_catalogue(), {"element.rope.damping=7"});
  CHECK(spring(base, 0).damping == 7.0);
  const Model model = read_model(top, small_catalogue());
  CHECK_FALSE(spring(model, 0).damping.has_value());
  CHECK(spring(model, 0).preload == 5.0);
}

TEST_CASE("an entry of another kind replaces the one that it inherits") {
  const Folder folder;
  folder.write("base.toml", k_plain);
  const std::string top = folder.write("top.toml", R"(
extends = "base.toml"
[output]
replace = true
step = 0.01
[[element]]
name = "rope"
kind = "pin"
replace = true
a = "tank"
b = "wall"
[[signal]]
name = "brake"
kind = "scaled"
replace = true
signal = "slow"
factor = "0.5 gravity"
[[signal]]
name = "slow"
kind = "rectangle"
peak = 1
duration = 0.3
)");
  const Model model = read_model(top, small_catalogue());
  CHECK(model.elements.at(0).element->name == "rope"); // in its place
  CHECK(model.elements.at(0).kind->name == "pin");
  CHECK(model.output.channels.empty());
  CHECK(model.output.step == 0.01);
  CHECK(model.signals.at(0).kind->name == "scaled");
  SignalNetwork signals(model);
  CHECK(signals.build("brake")->value(0.1) == doctest::Approx(0.5 * 9.80665).epsilon(1e-14));
  // What it gives can be changed as ever.
  CHECK(read_model(top, small_catalogue(), {"element.rope.b=ground"}).elements.at(0).kind->name == "pin");
}

TEST_CASE("the command line unsets what a file gives") {
  const Model model = parse_model(k_plain, "plain.toml", small_catalogue(),
                                  {"simulation.velocity=unset", "element.rope.damping=unset", "title=unset", "output.channels=unset"});
  CHECK(model.simulation.velocity == Vec2(0, 0));
  CHECK_FALSE(spring(model, 0).damping.has_value());
  CHECK(model.header.title.empty());
  CHECK(model.output.channels.empty());
  CHECK(parse_model(k_plain, "plain.toml", small_catalogue(), {"title=\"unset\""}).header.title == "unset");
  CHECK(parse_model(k_plain, "plain.toml", small_catalogue(), {"title=unset", "title=new"}).header.title == "new");
}

TEST_CASE("step and tolerance may both be given, whatever the integrator") {
  const std::string text = "[simulation]\nstep = 1e-3\ntolerance = 1e-9\n[[body]]\nname = \"a\"\n"
                           "mass = 1\ninertia = 1\n";
  for (const char* integrator : {"rk4", "tsit5", "dop853"}) {
    const Model model = parse_model(text, "both.toml", small_catalogue(), {std::string("simulation.integrator=") + integrator});
    CHECK(model.simulation.step == 1e-3);
    CHECK(model.simulation.tolerance == 1e-9);
  }
}

TEST_CASE("overrides from the command line") {
  const Model model = parse_model(k_two, "two.toml", small_catalogue(),
                                  {"simulation.step=2e-4", "simulation.end=\"2 s\"", "body.a.b c.mass=48 t", "element.rope.preload=-3",
                                   "element.rope.b.at.1=5", "element.rope.law=table", "gravity=[0, 0]", "output.step=0.01",
                                   "element.rope.is_on=false", "title=x = y"});
  CHECK(model.simulation.step == 2e-4);
  CHECK(model.simulation.end == 2.0);
  CHECK(model.bodies[0].mass == 48000.0);
  CHECK(spring(model, 0).preload == -3.0);
  CHECK(spring(model, 0).law == "table");
  CHECK_FALSE(spring(model, 0).is_on);
  CHECK(*marker_named(model, "rope.b").at == Vec2(1, 5));
  CHECK(model.header.gravity == Vec2(0, 0));
  CHECK(model.output.step == 0.01);
  CHECK(model.header.title == "x = y");
}

TEST_CASE("overrides that lead nowhere") {
  const auto message = [](const std::string& text) -> std::string {
    try {
      static_cast<void>(parse_model(k_two, "two.toml", small_catalogue(), {text}));
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message("element.rope.c.at=3") == "override element.rope.c.at=3: error: there is no 'c' to set 'at' of");
  CHECK(message("element.rope.b.at.7=3") == "override element.rope.b.at.7=3: error: '7' is not an item of a list");
  CHECK(message("simulation=3") == "override simulation=3: error: name a key of 'simulation', as in simulation.key=value");
  CHECK(message("=3") == "override =3: error: expected path=value, for example simulation.step=1e-4");
  CHECK(message("element.rope.stifness=3") == "override element.rope.stifness=3: error: unknown key 'stifness' in spring 'rope' (did you "
                                              "mean 'stiffness'?)");
}

TEST_CASE("tables of another room add to the model") {
  const Model model = parse_model("[simulation]\nstep = 1e-3\n[[pair]]\nname = \"p\"\nspacing = 4\n"
                                  "[[element]]\nname = \"e\"\nkind = \"spring\"\na = \"ground\"\nb "
                                  "= \"ground\"\nstiffness = 1\n",
                                  "pair.toml", small_catalogue());
  REQUIRE(model.bodies.size() == 2);
  CHECK(model.bodies[1].name == "p right");
  CHECK(model.bodies[1].position.x() == 2.0);
}

TEST_CASE("records are found beside the file that names them") {
  const Folder folder;
  folder.write("below/stop.csv", "t;a\n0;0\n0,1;-0,6\n0,2;0,3\n");
  folder.write("below/base.toml", k_two + "[[signal]]\nname = \"s\"\nkind = \"record\"\n"
                                          "file = \"stop.csv\"\nunit = \"gravity\"\noffset = \"1 s\"\n");
  const std::string top = folder.write("top.toml", "extends = \"below/base.toml\"\n[[signal]]\nname = \"s\"\nafter = \"hold\"\n");
  const Model model = read_model(top, small_catalogue());
  const Signal s = model.signals.at(0).kind->build(*model.signals.at(0).definition);
  const double g = 9.80665;
  CHECK(s.value(0.9) == 0.0);
  CHECK(s.value(1.05) == doctest::Approx(-0.3 * g).epsilon(1e-13));
  CHECK(s.value(1.15) == doctest::Approx(-0.15 * g).epsilon(1e-12));
  CHECK(s.value(5.0) == doctest::Approx(0.3 * g).epsilon(1e-13));
  CHECK(s.breakpoints().size() == 3);
}

TEST_CASE("a model built in code is checked alike") {
  Model model;
  CHECK(validate(model).at(0).message == "the model has no body: add at least one [[body]]");
  Body& body = model.bodies.emplace_back();
  body.name = "a";
  body.mass = body.inertia = 1.0;
  model.simulation.step = 1e-3;
  CHECK(validate(model).empty());
  body.mass = -1.0;
  model.markers.push_back({"m", "nowhere", {}, {}, 0.0, {}});
  const auto problems = validate(model);
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].message == "'mass' of body 'a' must be greater than 0 kg, got -1");
  CHECK(problems[1].message == "'body' of marker 'm': there is no body 'nowhere'");
  body.mass = 1.0;
  model.markers.clear();
  for (const std::string first : {"=", "+", "-", "@"}) { // names are cells of CSV files, which spreadsheets read
    body.name = first + "1+1";
    CHECK(validate(model).at(0).message ==
          "a body '" + body.name + "': the name must not begin with '" + first + "', which a spreadsheet takes for a formula");
  }
}

TEST_CASE("reading is linear in the number of bodies") {
  std::string text = "[simulation]\nstep = 1e-3\n";
  constexpr int k_bodies = 20000;
  for (int i = 0; i < k_bodies; ++i) {
    const std::string n = std::to_string(i);
    text += "[[body]]\nname = \"b" + n + "\"\nmass = \"1 t\"\ninertia = 1\nposition = [" + n + ", 0]\n";
    text += "[[element]]\nname = \"e" + n + "\"\nkind = \"spring\"\na = \"b" + n + "\"\nb = \"ground\"\nstiffness = 1\n";
  }
  const auto start = std::chrono::steady_clock::now();
  const Model model = parse_model(text, "large.toml", small_catalogue());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  CHECK(model.bodies.size() == k_bodies);
  CHECK(model.markers.size() == k_bodies + 1);
  MESSAGE("read " << k_bodies << " bodies and elements in " << took.count() << " s");
  CHECK(took.count() < 60.0); // a quadratic reader would take many minutes under a sanitizer
}

// Blanks beyond ASCII share blocks of code points with letters: those are letters.
TEST_CASE("letters beyond ASCII are told from blanks wherever they stand") {
  for (const char* const given : {"µ", "°", "é", "ÿ", "\u1681", "\u180F", "\u2010", "\u2070", "\u3001", "\uFEFE"}) {
    const std::string letter = given;
    CAPTURE(letter);
    CHECK(parse_model("title = \"a" + letter + " " + letter + "\"\n[simulation]\nstep = 1e-3\n[[body]]\nname = \"" + letter +
                          "\"\nmass = \"1 t\"\ninertia = 1\n",
                      "a.toml", small_catalogue())
              .header.title == "a" + letter + " " + letter);
    for (const std::string& text :
         {"title =" + letter + "\"a\"\n", letter + "title = \"a\"\n", "title = \"a\"" + letter + "\n", "[" + letter + "simulation]\n"})
      CHECK_THROWS_AS((void)parse_model(text, "a.toml", small_catalogue()), ModelError);
  }
}

namespace {

// A kind whose key "rate" was renamed to "stiffness".
struct Strut : Element {
  std::string a;
  double stiffness = 0.0;
};

const Catalogue& catalogue_with_renamed_key() {
  static const ElementKind kind = [] {
    ElementKind k;
    k.name = "strut";
    k.holds<Strut>();
    k.fields.add("a", &Strut::a).as(FieldType::marker).required();
    k.fields.add("stiffness", &Strut::stiffness).in("N/m").positive().required().renamed_from("rate");
    return k;
  }();
  static const Catalogue catalogue{{&kind}, {}, {}};
  return catalogue;
}

std::string strut_model(const std::string& keys) {
  return "[[body]]\nname = \"mass\"\nmass = 1\ninertia = 1\n[[element]]\nkind = \"strut\"\nname = \"prop\"\na = \"mass\"\n" + keys;
}

std::string error_of(const std::string& text) {
  try {
    (void)parse_model(text, "m.toml", catalogue_with_renamed_key());
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("each file of a model states its format") {
  const Folder folder;
  folder.write("base.toml", k_plain);
  const std::string top = folder.write("top.toml", "format = 1\nextends = \"base.toml\"\n");
  const Model model = read_model(top, small_catalogue());
  REQUIRE(model.files_without_format.size() == 1);
  CHECK(std::filesystem::path(model.files_without_format[0]).filename() == "base.toml");
  folder.write("base.toml", "format = 1\n" + k_plain);
  CHECK(read_model(top, small_catalogue()).files_without_format.empty());

  CHECK(error_of("format = 2\n" + strut_model("stiffness = 5\n")) ==
        "m.toml:1:10: error: 'format' is 2, and this version of steplap reads format 1: use a later version of steplap");
  for (const char* wrong : {"0", "-1", "1.0", "\"1\"", "true", "[1]"})
    CHECK_MESSAGE(error_of("format = " + std::string(wrong) + "\n" + strut_model("stiffness = 5\n"))
                      .starts_with("m.toml:1:10: error: 'format' must be 1, the version of the file format"),
                  wrong);
}

TEST_CASE("a key may be given by its earlier name, and the model remembers where") {
  const Model model = parse_model(strut_model("rate = \"5 kN/m\"\n"), "m.toml", catalogue_with_renamed_key());
  CHECK(static_cast<const Strut&>(*model.elements[0].element).stiffness == 5000.0);
  REQUIRE(model.renamed_keys.size() == 1);
  const RenamedKey& key = model.renamed_keys[0];
  CHECK(key.earlier == "rate");
  CHECK(key.name == "stiffness");
  CHECK(key.subject == "strut 'prop'");
  CHECK(key.where.line == 9);
  CHECK(key.where.column == 1);
  CHECK(parse_model(strut_model("stiffness = 5\n"), "m.toml", catalogue_with_renamed_key()).renamed_keys.empty());

  CHECK(error_of(strut_model("rate = 5\nstiffness = 6\n")) ==
        "m.toml:9:1: error: 'rate' of strut 'prop' is the earlier name of 'stiffness', which is given as well: leave 'rate' out");
  CHECK(error_of(strut_model("")).find("stiffness") != std::string::npos);
}

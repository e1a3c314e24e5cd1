// [[part]] and `repeat`: models with parts run like the same models written out, to the bit; what cannot be is refused with file,
// line, column and remedy.
#include "mbd/io/look.h"
#include "mbd/io/parts.h"
#include "mbd/io/reader.h"
#include "mbd/io/toml_writer.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "mbd/simulation/simulation.h"
#include "mbd/system/instance.h"
#include "tests/mbd/part_tree.h"
#include "tests/random/random_number.h"
#include "tests/sanitized.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

using namespace steplap;

namespace {

// A folder of files, gone when the case ends.
class Folder {
public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("steplap_parts_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)))) {
    std::filesystem::create_directories(path_ / "sub");
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }

private:
  std::filesystem::path path_;
};

// All that a run says, as bytes.
struct RunBytes {
  std::vector<std::string> channels;
  std::vector<double> values;

  bool operator==(const RunBytes& other) const {
    return channels == other.channels && values.size() == other.values.size() &&
           std::memcmp(values.data(), other.values.data(), values.size() * sizeof(double)) == 0;
  }
};

RunBytes run_of(const Model& given) {
  const auto system = instantiate(given, {});
  const RunResult result = simulate(*system, system->initial_state(), options_of(given));
  RunBytes bytes;
  for (const Channel* channel : result.trajectory->channels()) bytes.channels.push_back(channel->name + " " + channel->unit);
  for (std::size_t row = 0; row < result.trajectory->size(); ++row) {
    bytes.values.push_back(result.trajectory->time(row));
    for (std::size_t k = 0; k < bytes.channels.size(); ++k) bytes.values.push_back(result.trajectory->value(row, k));
  }
  return bytes;
}

Model read(const std::string& path, const std::vector<std::string>& overrides = {}) {
  return read_given_model(path, transformer_catalog(), overrides);
}

std::string refusal_of(const std::string& path, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(read(path, overrides));
  } catch (const ModelError& error) {
    std::string all;
    for (const Diagnostic& d : error.diagnostics()) all += d.text() + "\n";
    return all;
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const char* const k_head =
    "gravity = [0.0, -9.81]\n[simulation]\nend = 0.05\nintegrator = \"dop853\"\ntolerance = 1e-9\n[output]\nstep = 0.005\n";

// A rod that hangs: its pin is at the origin of its file.
const char* const k_rod = R"toml([parameters]
length = { value = "1 m", range = ["0.1 m", "3 m"], meaning = "of the rod" }
mass = "2 kg"
[[body]]
name = "rod"
mass = "= mass"
inertia = "= mass*length^2/12"
position = ["= length/2", 0.0]
[[marker]]
name = "pin"
body = "rod"
at = [0.0, 0.0]
[[marker]]
name = "end"
body = "rod"
at = ["= length", 0.0]
)toml";

} // namespace

TEST_CASE("models of parts in parts run like the same models written out, to the bit") {
  int deepest = 0, parts = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const testing::PartTree tree = testing::random_part_tree(seed);
    const Folder folder;
    for (const auto& [name, text] : tree.files) folder.write(name, text);
    CAPTURE(seed);
    CAPTURE(tree.files.at("model.toml"));
    CAPTURE(tree.written_out);
    const Model made = read(folder / "model.toml"), written = parse_given_model(tree.written_out, "written.toml", transformer_catalog());
    const RunBytes bytes = run_of(written);
    REQUIRE(run_of(made) == bytes);
    REQUIRE(bytes.values.size() > 11 * 7); // rows of a body's pose and velocity, and more
    // The text that results keep is the model, without its parts' files.
    const std::string text = effective_model_text(folder / "model.toml", transformer_catalog());
    CHECK(!has(text, "[[part]]"));
    if (seed % 10 == 0) CHECK(run_of(parse_given_model(text, "text.toml", transformer_catalog())) == bytes);
    deepest = std::max(deepest, tree.depth);
    parts += tree.parts;
  }
  CHECK(deepest >= 3); // else the generator has lost its point
  CHECK(parts > 600);
}

TEST_CASE("a part that is turned with gravity moves as one that is not, turned") {
  // Independent of how places are worked out: mechanics does not know the angle of the ground.
  const Folder folder;
  folder.write("rod.toml", std::string(k_rod) + "[[element]]\nkind = \"revolute\"\nname = \"hinge\"\na = \"pin\"\n[[element]]\nkind = "
                                                "\"load\"\nname = \"wind\"\nat = \"end\"\nforce = [3.0, 5.0]\n");
  const double turn = 0.7, c = std::cos(turn), s = std::sin(turn), x = 2.5, y = -1.25;
  const auto model = [&](bool is_turned) {
    const double gx = is_turned ? 9.81 * s : 0.0, gy = is_turned ? -9.81 * c : -9.81;
    return "gravity = [" + std::to_string(gx) + ", " + std::to_string(gy) + "]\n" +
           std::string(k_head).substr(std::string(k_head).find('\n') + 1) + "[[part]]\nname = \"a\"\nfile = \"rod.toml\"\n" +
           (is_turned ? "x = \"2.5 m\"\ny = -1.25\nangle = 0.7\n" : "");
  };
  folder.write("straight.toml", model(false));
  folder.write("turned.toml", model(true));
  const auto end_of = [&](const std::string& name) {
    const auto system = instantiate(read(folder / name), {});
    return simulate(*system, system->initial_state(), options_of(read(folder / name))).final_state;
  };
  const State straight = end_of("straight.toml"), turned = end_of("turned.toml");
  // Gravity is written with six digits: 1e-6 of it for 0.05 s moves a body by 1e-9 m.
  REQUIRE(turned.q.size() == 6);         // the ground, then the rod
  CHECK(std::abs(straight.q[5]) > 1e-3); // it has swung
  CHECK(turned.q[3] == doctest::Approx(x + c * straight.q[3] - s * straight.q[4]).epsilon(1e-8));
  CHECK(turned.q[4] == doctest::Approx(y + s * straight.q[3] + c * straight.q[4]).epsilon(1e-8));
  CHECK(turned.q[5] == doctest::Approx(straight.q[5] + turn).epsilon(1e-8));
}

TEST_CASE("angles against a part's ground turn with it: those of springs and of positions that a drive follows") {
  const Folder folder;
  const double begin = 0.3, turn = 1.5, stiffness = 40.0;
  const std::string rod =
      "format = 1\n[simulation]\nend = 0.05\n[[body]]\nname = \"rod\"\nmass = 2.0\ninertia = 3.0\nposition = [0.0, 0.0]\n"
      "angle = 0.3\n[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = \"rod\"\n";
  const auto turned = [&](const std::string& element) {
    folder.write("part.toml", rod + element);
    folder.write("whole.toml",
                 "format = 1\ngravity = [0.0, 0.0]\n[simulation]\nend = 0.05\n[[part]]\nname = \"P\"\nfile = \"part.toml\"\nangle = 1.5\n");
    return read(folder / "whole.toml");
  };
  // At the free angle the rod rests; half a radian from it, it turns by ½ ω² ½ t² to leading order, ω² = k/J, whichever end is the ground's.
  for (const char* ends : {"a = \"rod\"\n", "a = \"ground\"\nb = \"rod\"\n"}) {
    const double sign = ends[5] == 'r' ? 1.0 : -1.0; // the angle of the ground against the rod is the negative one
    for (const double off : {0.0, 0.5}) {
      const Model model = turned("[[element]]\nkind = \"rotational_spring_damper\"\nname = \"spring\"\nstiffness = 40.0\n" +
                                 std::string(ends) + "free_angle = " + std::to_string(sign * (begin + off)) + "\n");
      const auto system = instantiate(model, {});
      const double end = simulate(*system, system->initial_state(), options_of(model)).final_state.q[5] - turn - begin;
      const double swing = off * (1.0 - std::cos(std::sqrt(stiffness / 3.0) * 0.05));
      CHECK(std::abs(end - swing) < 1e-8); // the tolerance of the run
    }
  }
  const Model driven = turned("[[signal]]\nname = \"way\"\nkind = \"constant\"\nvalue = 0.3\n[[element]]\nkind = \"prescribed_motion\"\n"
                              "name = \"drive\"\na = \"rod\"\ncoordinate = \"angle\"\nas = \"position\"\nsignal = \"way\"\n");
  const auto system = instantiate(driven, {});
  CHECK(std::abs(simulate(*system, system->initial_state(), options_of(driven)).final_state.q[5] - turn - begin) < 1e-12);
}

TEST_CASE("repeat writes out what it stands for") {
  const Folder folder;
  folder.write("repeated.toml", std::string(k_head) + R"toml([parameters]
pitch = "0.5 m"
[[body]]
name = "rod"
mass = "= '1 kg' * (1 + i)"
inertia = 0.1
position = ["= (i + 0.5)*pitch", 0.0]
repeat = 4
[[element]]
kind = "revolute"
name = "first"
a = { body = "rod 0", at = [0.0, 0.0] }
[[element]]
kind = "revolute"
name = "pin {2*i + 1}"
a = { body = "rod {i}", at = ["= (i + 1)*pitch", 0.0] }
b = { body = "rod {i+1}", at = ["= (i + 1)*pitch", 0.0] }
repeat = 3
)toml");
  std::string text = k_head;
  for (int i = 0; i < 4; ++i)
    text += "[[body]]\nname = \"rod " + std::to_string(i) + "\"\nmass = " + std::to_string(1 + i) + "\ninertia = 0.1\nposition = [" +
            std::to_string((i + 0.5) * 0.5) + ", 0.0]\n";
  text += "[[element]]\nkind = \"revolute\"\nname = \"first\"\na = { body = \"rod 0\", at = [0.0, 0.0] }\n";
  for (int i = 0; i < 3; ++i) {
    const std::string at = ", at = [" + std::to_string((i + 1) * 0.5) + ", 0.0] }\n";
    text += "[[element]]\nkind = \"revolute\"\nname = \"pin " + std::to_string(2 * i + 1) + "\"\na = { body = \"rod " + std::to_string(i) +
            "\"" + at + "b = { body = \"rod " + std::to_string(i + 1) + "\"" + at;
  }
  CHECK(run_of(read(folder / "repeated.toml")) == run_of(parse_given_model(text, "text.toml", transformer_catalog())));
  CHECK(read(folder / "repeated.toml", {"body.rod 3.mass=9"}).bodies[3].mass == 9.0);
  folder.write("none.toml",
               std::string(k_head) +
                   "[[body]]\nname = \"b\"\nmass = 1\ninertia = 1\n[[body]]\nname = \"c {i}\"\nmass = 1\ninertia = 1\nrepeat = 0\n");
  CHECK(read(folder / "none.toml").bodies.size() == 1);
}

TEST_CASE("a chain of parts by repeat swings like the rods written one by one") {
  const Folder folder;
  folder.write("sub/rod.toml", k_rod);
  folder.write("chain.toml", std::string(k_head) + R"toml([parameters]
length = "0.5 m"
[[part]]
name = "link"
file = "sub/rod.toml"
x = "= i*length"
parameters = { length = "= length", mass = "= '1 kg' + i*'0.25 kg'" }
repeat = 6
[[element]]
kind = "revolute"
name = "hook"
a = "link 0.pin"
[[element]]
kind = "revolute"
name = "pin {i}"
a = "link {i+1}.pin"
b = "link {i}.end"
repeat = 5
)toml");
  std::string
      bodies = k_head,
      elements =
          "[[element]]\nkind = \"revolute\"\nname = \"hook\"\na = { body = \"link 0.rod\", name = \"link 0.pin\", at = [0.0, 0.0] }\n";
  for (int i = 0; i < 6; ++i) {
    const double length = 0.5, mass = 1 + i * 0.25;
    bodies += "[[body]]\nname = \"link " + std::to_string(i) + ".rod\"\nmass = " + std::to_string(mass) +
              "\ninertia = \"= " + std::to_string(mass) + "*'1 kg'*'0.5 m'^2/12\"\nposition = [" + std::to_string(i * length + length / 2) +
              ", 0.0]\n";
    if (i == 0) continue;
    elements += "[[element]]\nkind = \"revolute\"\nname = \"pin " + std::to_string(i - 1) + "\"\na = { body = \"link " + std::to_string(i) +
                ".rod\", at = [" + std::to_string(i * length) + ", 0.0] }\nb = { body = \"link " + std::to_string(i - 1) +
                ".rod\", at = [" + std::to_string((i - 1) * length + length) + ", 0.0] }\n";
  }
  const Model chain = read(folder / "chain.toml");
  CHECK(run_of(chain) == run_of(parse_given_model(bodies + elements, "text.toml", transformer_catalog())));
  // What is set in memory is what is read anew: places, masses and inertias of six parts follow from one length.
  Model set = chain;
  set_value(set, "parameters.length", 0.7);
  const Model anew = read(folder / "chain.toml", {"parameters.length=0.7 m"});
  CHECK(number_of(set, "body.link 5.rod.position.0") == number_of(anew, "body.link 5.rod.position.0"));
  CHECK(run_of(set) == run_of(anew));
  // A parameter of one part has its own name, and so has the part.
  CHECK(number_of(read(folder / "chain.toml", {"parameters.link 2.mass=7 kg"}), "body.link 2.rod.mass") == 7.0);
  CHECK(read(folder / "chain.toml", {"part.link.repeat=6", "part.link.x== 2*i*length"}).bodies[1].position.x() == 1.25);
}

TEST_CASE("an upper file gives an inherited part another place") {
  const Folder folder;
  folder.write("rod.toml", k_rod);
  folder.write("base.toml", std::string(k_head) +
                                "[[part]]\nname = \"a\"\nfile = \"rod.toml\"\n[[element]]\nkind = \"weld\"\nname = \"w\"\na = \"a.rod\"\n");
  folder.write("sub/over.toml", "extends = \"../base.toml\"\n[[part]]\nname = \"a\"\ny = \"3 m\"\nparameters = { length = \"2 m\" }\n");
  CHECK(read(folder / "base.toml").bodies[0].position == Vec2(0.5, 0.0));
  CHECK(read(folder / "sub/over.toml").bodies[0].position == Vec2(1.0, 3.0));
}

TEST_CASE("an entry with the long name of something in a part is laid over that") {
  const Folder folder;
  folder.write("rod.toml", std::string(k_rod) +
                               "[[element]]\nkind = \"spring_damper\"\nname = \"hanger\"\na = \"end\"\nstiffness = 100.0\npreload = 3.0\n");
  folder.write("frame.toml", R"toml([[body]]
name = "beam"
mass = 5.0
inertia = 1.0
[[part]]
name = "rod"
file = "rod.toml"
x = 1.0
[[element]]
name = "rod.hanger"
a = "beam"
stiffness = 250.0
)toml");
  folder.write("model.toml", std::string(k_head) + R"toml([[part]]
name = "left"
file = "frame.toml"
y = 2.0
[[body]]
name = "left.rod.rod"
mass = "9 kg"
position = [7.0, 7.0]
[[element]]
name = "left.rod.hanger"
unset = ["preload"]
damping = 4.0
)toml");
  const Model m = read(folder / "model.toml");
  CHECK(number_of(m, "body.left.rod.rod.mass") == 9.0);
  CHECK(m.find_body("left.rod.rod")->position == Vec2(7.0, 7.0)); // the model says it in its own axes
  CHECK(number_of(m, "element.left.rod.hanger.stiffness") == 250.0);
  CHECK(number_of(m, "element.left.rod.hanger.damping") == 4.0);
  CHECK(std::get<std::string>(value_of(m, "element.left.rod.hanger.a")) == "left.beam"); // a name of the file that says so
  CHECK(value_of(m, "element.left.rod.hanger.preload") == FieldValue(std::string()));
  // The spring without an end b hangs on the origin of its own file, and still does.
  CHECK(number_of(m, "marker.left.rod.hanger.b.at.0") == 1.0);
  CHECK(number_of(m, "marker.left.rod.hanger.b.at.1") == 2.0);
  folder.write("less.toml", "extends = \"model.toml\"\n[[element]]\nname = \"left.rod.hanger\"\nremove = true\n");
  CHECK(read(folder / "less.toml").elements.empty());
  CHECK(read(folder / "less.toml").bodies.size() == 2);
  folder.write("typing.toml", "extends = \"model.toml\"\n[[element]]\nname = \"left.rod.hangr\"\nstiffness = 1.0\n");
  CHECK(
      has(refusal_of(folder / "typing.toml"),
          "typing.toml:3:8: error: a name with the name of a part before a point is that of something in the part, but there is no element "
          "'left.rod.hangr' (did you mean 'left.rod.hanger'?)"));
}

TEST_CASE("what a part brings to be looked at is the part's") {
  const Folder folder;
  folder.write("rod.toml", std::string(k_rod) + R"toml([[element]]
kind = "revolute"
name = "hinge"
a = "pin"
[[channel]]
name = "pull"
expression = "hypot({hinge.force_x}, hinge.force_y)"
[[plot]]
name = "pin"
channels = ["hinge.force_*"]
bounds = ["pull"]
[[acceptance]]
name = "soft"
channel = "pull"
at_most = "= mass * '100 m/s^2'"
[[acceptance]]
name = "quiet"
event = "breaks"
[simulation]
end = 77.0
)toml");
  folder.write("model.toml", std::string(k_head) + "[[part]]\nname = \"left {i}\"\nfile = \"rod.toml\"\nx = \"= i*'2 m'\"\nrepeat = 2\n");
  const Model m = read(folder / "model.toml");
  CHECK(m.simulation.end == 0.05);
  CHECK(std::get<std::string>(value_of(m, "channel.left 1.pull.expression")) == "hypot({left 1.hinge.force_x}, {left 1.hinge.force_y})");
  CHECK(std::get<std::vector<std::string>>(value_of(m, "plot.left 0.pin.channels")) == std::vector<std::string>{"left 0.hinge.force_*"});
  CHECK(std::get<std::string>(value_of(m, "acceptance.left 1.soft.channel")) == "left 1.pull");
  CHECK(std::get<std::string>(value_of(m, "acceptance.left 1.soft.at_most")) == "200 N");
  CHECK(std::get<std::string>(value_of(m, "acceptance.left 0.quiet.element")) == "left 0.*");
}

namespace {

struct RefusedPart {
  const char *part, *place, *message;
};

const RefusedPart k_refused_parts[] = {
    {"name = \"a\"\nfile = \"rood.toml\"", "m.toml:10:8", "part 'a': "},
    {"name = \"a\"\nfile = \"\"", "m.toml:10:8", "expected the name of a model file, got an empty string"},
    {"name = \"a\"", "m.toml:8:1", "part 'a' needs 'file'"},
    {"file = \"rod.toml\"", "m.toml:8:1", "a part needs 'name'"},
    {"name = \"a*\"\nfile = \"rod.toml\"", "m.toml:9:8", "is no name of a part"},
    {"name = \"a\"\nfile = \"rod.toml\"\nanlge = 1", "m.toml:11:1", "unknown key 'anlge' in part 'a' (did you mean 'angle'?)"},
    {"name = \"a\"\nfile = \"rod.toml\"\nx = \"3 kg\"", "m.toml:11:5", "'x' of part 'a'"},
    {"name = \"a\"\nfile = \"rod.toml\"\nx = \"= 3\"", "m.toml:11:5",
     "'x' of part 'a': the formula gives a number without a unit, but a unit like 'm' is needed"},
    {"name = \"a\"\nfile = \"rod.toml\"\nx = \"= pitsch\"", "m.toml:11:5", "'x' of part 'a': formula: there is no parameter 'pitsch'"},
    {"name = \"a\"\nfile = \"rod.toml\"\nx = true", "m.toml:11:5", "'x' of part 'a': expected a number"},
    {"name = \"a\"\nfile = \"rod.toml\"\nparameters = { lenght = \"1 m\" }", "m.toml:11:16",
     "'rod.toml' has no parameter 'lenght' (did you mean 'length'?)"},
    {"name = \"a\"\nfile = \"rod.toml\"\nparameters = { length = 2.0 }", "m.toml:11:25",
     "parameter 'length' of part 'a' is a number without a unit, but has a unit like 'm' there, '1 m'"},
    {"name = \"a\"\nfile = \"rod.toml\"\nparameters = { length = \"5 m\" }", "m.toml:11:25",
     "parameter 'a.length' is 5 m, above its range"},
    {"name = \"a\"\nfile = \"rod.toml\"\nparameters = 3", "m.toml:11:14", "'parameters' of part 'a' must be a table"},
    {"name = \"a\"\nfile = \"bare.toml\"\nparameters = { k = 3 }", "m.toml:11:16", "has no parameter 'k', nor any other"},
    {"name = \"a\"\nfile = \"m.toml\"", "m.toml:10:8", "parts go round in circles: m.toml -> m.toml"},
    {"name = \"a\"\nfile = \"ring.toml\"", "back.toml:3:8", "parts go round in circles: ring.toml -> back.toml -> ring.toml"},
    {"name = \"a\"\nfile = \"broken.toml\"", "broken.toml:2:", "part 'a': not valid TOML"},
    {"name = \"a\"\nfile = \"twice.toml\"", "twice.toml:18:8", "a marker named 'a.end' exists already"},
    {"name = \"a\"\nfile = \"nest.toml\"", "bare.toml:3:8", "must be greater than 0 kg, got -1 (part 'in', "},
    {"name = \"a\"\nfile = \"nest.toml\"", "nest.toml:1:1, of part 'a', ", "m.toml:8:1"},
    {"name = \"a\"\nfile = \"windy.toml\"\nangle = 0.1", "windy.toml:25:11",
     "acts along an axis of the ground and cannot turn with its part"},
    {"name = \"a\"\nfile = \"odd.toml\"", "odd.toml:17:", "unknown key 'bdy' in the file of a part (did you mean 'body'?)"},
    {"name = \"a\"\nfile = \"sure.toml\"", "sure.toml:17:1", "[[uncertain]] concerns the whole model"},
    {"name = \"a\"\nfile = \"rod.toml\"\n[[part]]\nname = \"a\"\nfile = \"rod.toml\"", "m.toml:12:8",
     "a part named 'a' exists already (line 8)"},
    {"name = \"a\"\nfile = \"rod.toml\"\n[[element]]\nkind = \"weld\"\nname = \"w\"\na = \"a.edn\"", "m.toml:14:5",
     "there is no marker or body 'a.edn' (did you mean 'a.end'?)"},
    {"name = \"a\"\nfile = \"rod.toml\"\nrepeat = 1000000", "m.toml:11:10",
     "1000000 repetitions are more than the 100000 entries that a model may have: is a digit too many?"},
    {"name = \"a\"\nfile = \"rod.toml\"\nrepeat = 100000", ":1", "parts and repetitions make more than 100000 entries"},
    {"name = \"a\"\nfile = \"rod.toml\"\nrepeat = -1", "m.toml:11:10", "expected a whole number, 0 or larger, got -1"},
    {"name = \"a\"\nfile = \"rod.toml\"\nrepeat = 2.5", "m.toml:11:10", "expected a whole number"},
    {"name = \"a\"\nfile = \"rod.toml\"\nrepeat = \"= 3\"", "m.toml:11:10", "a formula cannot say how many there are"},
    {"name = \"a {k}\"\nfile = \"rod.toml\"\nrepeat = 3", "m.toml:9:8",
     "'{k}': in a name only the index i and numbers make a number, not 'k'"},
    {"name = \"a {i/2}\"\nfile = \"rod.toml\"\nrepeat = 3", "m.toml:9:8", "'{i/2}' is 0.5 where i is 1: a name takes a whole number"},
    {"name = \"a {i\"\nfile = \"rod.toml\"\nrepeat = 3", "m.toml:9:8", "lacks a '}'"},
    {"name = \"a {0*i}\"\nfile = \"rod.toml\"\nrepeat = 3", "m.toml:9:8", "a part named 'a 0' exists already"},
};

} // namespace

TEST_CASE("parts that cannot be are refused with file, line, column and remedy") {
  const Folder folder;
  folder.write("rod.toml", k_rod);
  folder.write("ring.toml", "[[part]]\nname = \"r\"\nfile = \"back.toml\"\n");
  folder.write("back.toml", "[[part]]\nname = \"b\"\nfile = \"ring.toml\"\n");
  folder.write("broken.toml", "[[body]]\nname = \"b\nmass = 1\n");
  folder.write("twice.toml", std::string(k_rod) + "[[marker]]\nname = \"end\"\nbody = \"rod\"\n");
  folder.write("bare.toml", "[[body]]\nname = \"b\"\nmass = -1.0\ninertia = 1.0\n");
  folder.write("nest.toml", "[[part]]\nname = \"in\"\nfile = \"bare.toml\"\n");
  folder.write("windy.toml", std::string(k_rod) + "[[signal]]\nname = \"gust\"\nkind = \"constant\"\nvalue = 1.0\n[[element]]\nkind = "
                                                  "\"load\"\nname = \"wind\"\nat = \"end\"\nforce_x = \"gust\"\n");
  folder.write("odd.toml", std::string(k_rod) + "[[bdy]]\nname = \"x\"\n");
  folder.write("sure.toml", std::string(k_rod) + "[[uncertain]]\nname = \"m\"\npaths = [\"body.rod.mass\"]\n");
  for (const RefusedPart& c : k_refused_parts) {
    folder.write("m.toml", std::string(k_head) + "[[part]]\n" + c.part + "\n");
    const std::string text = refusal_of(folder / "m.toml");
    CAPTURE(c.part);
    CAPTURE(text);
    CHECK(has(text, c.message));
    CHECK(has(text, c.place));
    // A repeated name is told for each that has it; all else is one cause and one message.
    if (!has(c.message, "'a 0' exists")) CHECK(std::count(text.begin(), text.end(), '\n') == 1);
  }
}

TEST_CASE("what all repetitions of a part have in common is told once") {
  const Folder folder;
  folder.write("rod.toml", std::string(k_rod) + "[[element]]\nkind = \"revolute\"\nname = \"hinge\"\na = \"pim\"\n");
  folder.write("m.toml", std::string(k_head) + "[[part]]\nname = \"a\"\nfile = \"rod.toml\"\nrepeat = 40\n");
  const std::string text = refusal_of(folder / "m.toml");
  CAPTURE(text);
  CHECK(std::count(text.begin(), text.end(), '\n') == 1);
  CHECK(has(text, "rod.toml:20:5"));
  CHECK(has(text, "there is no marker or body 'a 0.pim' (did you mean 'a 0.pin'?)"));
  CHECK(has(text, "and 39 more like it"));
}

TEST_CASE("a chain of a thousand links is a chain, by repeat and by a part with parameters; how long it takes to read is printed") {
  if (testing::k_is_sanitized) return; // ten to twenty times slower
  const Folder folder;
  folder.write("rod.toml", k_rod);
  const std::string ends = "repeat = 1000\n[[element]]\nkind = \"revolute\"\nname = \"pin {i}\"\na = \"link {i+1}";
  folder.write("parts.toml", std::string(k_head) +
                                 "[parameters]\nlength = \"0.5 m\"\n[[part]]\nname = \"link\"\nfile = \"rod.toml\"\nx = \"= "
                                 "i*length\"\nparameters = { length = \"= length\" }\n" +
                                 ends + ".pin\"\nb = \"link {i}.end\"\nrepeat = 999\n");
  folder.write("repeated.toml", std::string(k_head) +
                                    "[[body]]\nname = \"link\"\nmass = 1.0\ninertia = 0.1\nposition = [\"= i*'0.5 m'\", 0.0]\n" + ends +
                                    "\"\nb = { body = \"link {i}\", point = [0.5, 0.0] }\nrepeat = 999\n");
  for (const char* const name : {"repeated.toml", "parts.toml"}) {
    double best = 1e9; // processor time: others may be at work
    for (int k = 0; k < 5; ++k) {
      const std::clock_t begin = std::clock();
      const Model model = read(folder / name);
      REQUIRE(model.bodies.size() == 1000);
      REQUIRE(model.elements.size() == 999);
      best = std::min(best, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    MESSAGE(std::string(name) << ": " << best << " s");
  }
}

TEST_CASE("a train of carriages of wheels: contacts, shapes, channels and criteria in parts of turned parts") {
  const std::string path = STEPLAP_SOURCE "/tests/data/parts/train.toml";
  const Model train = read(path);
  CHECK(completed(train).bodies.size() == 9);
  // A disc of 0.8 m with two holes of 0.1 m, 0.2 m off its centre.
  const double plate = 7850.0 * 0.08, disc = std::numbers::pi * 0.16, hole = std::numbers::pi * 0.0025;
  const Body wheel = *completed(train).find_body("car 3.wheel 2.wheel");
  CHECK(wheel.mass == doctest::Approx(plate * (disc - 2 * hole)).epsilon(1e-13));
  CHECK(wheel.inertia == doctest::Approx(plate * (disc * 0.08 - 2 * hole * (0.00125 + 0.04))).epsilon(1e-13)); // some roundings
  const double slope = std::numbers::pi / 180.0;
  // From the train's origin down the slope by two pitches, along it by half a base, up from it by a radius.
  CHECK(wheel.position.x() == doctest::Approx(-12.0 * std::cos(slope) + 1.5 * std::cos(slope) - 0.4 * std::sin(slope)).epsilon(1e-14));
  CHECK(wheel.position.y() == doctest::Approx(-12.0 * std::sin(slope) + 1.5 * std::sin(slope) + 0.4 * std::cos(slope)).epsilon(1e-13));
  CHECK(number_of(train, "element.car 2.wheel 1.tread.stiffness") == 8e6);
  CHECK(number_of(train, "element.car 2.wheel 2.tread.stiffness") == doctest::Approx(50 * 4e5).epsilon(1e-15));
  const RunBytes bytes = run_of(train);
  CHECK(run_of(parse_given_model(effective_model_text(path, transformer_catalog()), "text.toml", transformer_catalog())) == bytes);
  CHECK(std::count(bytes.channels.begin(), bytes.channels.end(), "car 1.wheel 2.press ") == 1); // a number has no unit
}

TEST_CASE("what the page on models written once shows is a chain") {
  std::ifstream page(STEPLAP_SOURCE "/docs/how-to/models_written_once.md");
  std::vector<std::string> blocks;
  bool is_inside = false;
  for (std::string line; std::getline(page, line);) {
    const bool begins = line == "```toml";
    if (begins) blocks.emplace_back();
    else if (line != "```" && is_inside) blocks.back() += line + "\n";
    if (begins || line == "```") is_inside = begins;
  }
  REQUIRE(blocks.size() == 3);
  const Folder folder;
  folder.write("link.toml", blocks[0]);
  folder.write("chain.toml", blocks[1]);
  folder.write("rollers.toml", blocks[2]);
  const Model chain = completed(read(folder / "chain.toml"));
  REQUIRE(chain.bodies.size() == 40);
  CHECK(chain.elements.size() == 40);
  const Body& last = *chain.find_body("link 40.rod");
  CHECK(last.position.x() == doctest::Approx(39.5 * 0.25).epsilon(1e-14)); // some roundings
  const double mass = 7850.0 * 0.01 * 0.25 * 0.04;
  CHECK(last.mass == doctest::Approx(mass).epsilon(1e-13));
  CHECK(last.inertia == doctest::Approx(mass * (0.25 * 0.25 + 0.04 * 0.04) / 12).epsilon(1e-12)); // differences of squares
  CHECK(completed(read(folder / "link.toml")).bodies.front().outline.size() == 4);                // the part alone is a model
  CHECK(read(folder / "chain.toml", {"body.link 7.rod.cg=[0.01, 0]"}).bodies[6].cg.x() == 0.01);
  CHECK(read(folder / "chain.toml", {"parameters.link 7.length=0.3 m"}).bodies[6].position.x() ==
        doctest::Approx(6 * 0.25 + 0.15).epsilon(1e-14));
  CHECK(read(folder / "chain.toml", {"part.link {i+1}.repeat=60", "element.pin {i+1}.repeat=59"}).elements.size() == 60);
  CHECK(has(refusal_of(folder / "chain.toml", {"part.link {i+1}.repeat=20"}),
            "there is no marker or body 'link 21.left'")); // the pins are of 40
  CHECK(read(folder / "rollers.toml").bodies.size() == 12);
}

TEST_CASE("each field of every kind is known to turn with a part or not to") {
  // A new field with a vector, a list of points or of texts, or a kind with a `frame`, is looked at once and added here.
  std::string found;
  const auto look = [&](const std::string& kind, const FieldTable& fields) {
    for (const Field& field : fields.fields()) {
      static constexpr const char* k_words[] = {"", "name", "place", "direction", "fixed axis"};
      const PartTreatment treatment = part_treatment(fields, field);
      if (treatment != PartTreatment::none) found += kind + "." + field.name + " " + k_words[static_cast<int>(treatment)] + "\n";
    }
  };
  for (const ElementKind* kind : transformer_catalog().elements) look(kind->name, kind->fields);
  for (const SignalKind* kind : transformer_catalog().signals) look(kind->name, kind->fields);
  for (const TableKind* kind : transformer_catalog().tables)
    if (is_allowed_in_part(*kind)) look(kind->name, kind->fields);
  CHECK(found ==
        "step_lap_interface.yoke place\nstep_lap_interface.limb place\nstep_lap_interface.yoke_holes place\nstep_lap_interface.limb_holes "
        "place\n"
        "step_lap_interface.yoke_cutouts place\nstep_lap_interface.limb_cutouts place\nstep_lap_interface.pressure_gradient direction\n"
        "step_lap_interface.across direction\nrope.over name\nload.force direction\nload.force_x fixed axis\nload.force_y fixed axis\n"
        "beam.from place\nbeam.to place\naction.do name\nplot.channels name\nplot.bounds name\ncore.limbs name\ncore.middle_limbs "
        "name\ncore.joints name\n");
  std::string alone;
  for (const TableKind* kind : transformer_catalog().tables)
    if (!is_allowed_in_part(*kind)) alone += kind->name + " ";
  CHECK(alone == "contacts case clamp recorder uncertain ");
}

TEST_CASE("a road of a part lies where the part stands, and wheels stay on their body") {
  const Folder folder;
  folder.write(
      "cart.toml",
      "[[body]]\nname = \"axle\"\nmass = 1\ninertia = 1\n"
      "[[look]]\nname = \"wheel {i+1}\"\nbody = \"axle\"\ndraw = \"wheel\"\nradius = 0.4\nat = [\"= i*'0.5 m'\", 0.25]\nrepeat = 3\n"
      "[[look]]\nname = \"road\"\nbody = \"ground\"\ndraw = \"road\"\nat = [0.0, -0.5]\n"
      "[[look]]\nname = \"rail\"\nbody = \"ground\"\ndraw = \"rail\"\n");
  const std::string part = "[[part]]\nname = \"cart\"\nfile = \"cart.toml\"\nx = 4.0\ny = 2.0\n";
  folder.write("placed.toml", part);
  const Model model = read_model(folder / "placed.toml", transformer_catalog());
  std::map<std::string, Vec2> places;
  for (const TableEntry& entry : model.tables) places[entry.table->name] = places_of(static_cast<const Look&>(*entry.table)).front();
  REQUIRE(places.size() == 5);
  // Halves and quarters, so all sums are exact.
  for (int i = 0; i < 3; ++i) CHECK(places["cart.wheel " + std::to_string(i + 1)] == Vec2(0.5 * i, 0.25));
  CHECK(places["cart.road"] == Vec2(4.0, 1.5));
  CHECK(places["cart.rail"] == Vec2(4.0, 2.0)); // no 'at': the part's origin

  folder.write("turned.toml", part + "angle = 0.1\n");
  CHECK(has(refusal_of(folder / "turned.toml"), "'cart.road' lies level on the ground and cannot turn with its part"));
}

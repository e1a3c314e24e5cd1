// What stands, and how far it is from tipping over, against closed forms.
#include "mbd/io/reader.h"
#include "mbd/run/tipping.h"
#include "tests/machines/machine.h"
#include "transformer/program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>
#include <utility>
#include <vector>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81, k_degree = 3.14159265358979323846 / 180.0;

std::shared_ptr<const LoadedModel> loaded_from(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() / ("steplap_tipping_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << text;
  auto loaded = load_model(file.string(), {});
  std::filesystem::remove(file);
  return loaded;
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

// 0.4 m wide, 1 m high, lying on a plane through the origin that falls to the right by `slope`; its weight as gravity
// turned: the plane is the x axis.
std::string block(double slope, const std::string& contact) {
  return "gravity = [" + number(k_g * std::sin(slope)) + ", " + number(-k_g * std::cos(slope)) + "]\n[simulation]\nend = 1.0\n" +
         "[[body]]\nname = \"block\"\nmass = 30.0\ninertia = 2.9\nposition = [0.0, 0.5]\n"
         "outline = [[-0.2, -0.5], [0.2, -0.5], [0.2, 0.5], [-0.2, 0.5]]\n" +
         contact;
}

const std::string k_outline = "[[element]]\nkind = \"polygon_contact\"\nname = \"floor\"\na = \"block\"\nstiffness = 1e12\n"
                              "static_friction = 0.9\n";

std::string foot(const std::string& name, double x) {
  return "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + name + "\"\na = { body = \"block\", point = [" + number(x) +
         ", -0.5] }\nstiffness = 1e8\ndamping = 1e4\n";
}

const std::string k_feet =
    foot("left", -0.2) + foot("right", 0.2) +
    "[[element]]\nkind = \"coulomb_stick\"\nname = \"grip\"\ncontacts = [\"left\", \"right\"]\nstatic_friction = 0.9\n";

} // namespace

// tan α = b/h = 0.4. Under 294 N feet of 1e8 N/m give way by 3 µm, which turns it by 7.5e-6 rad; an outline that stands near
// its corner on 24 mm of an edge of 1e12 N/m² turns by less. tan has a slope of at most 1.2 there.
TEST_CASE("a block on an incline tips at atan(b/h), on feet and on its outline") {
  const double limit = std::atan(0.4);
  for (const double slope : {0.0, 8.0 * k_degree, 21.0 * k_degree, -10.0 * k_degree}) {
    for (const std::string& contact : {k_outline, k_feet}) {
      CAPTURE(slope);
      CAPTURE(contact);
      const auto loaded = loaded_from(block(slope, contact));
      const Equilibrium rest = equilibrium_of(*loaded);
      const auto found = tipping_of(*loaded, rest.state);
      REQUIRE(found.size() == 1);
      CHECK(std::abs(found[0].margin - (limit - std::abs(slope))) < 1e-5);
      REQUIRE(found[0].slope);
      CHECK(std::abs(std::abs(*found[0].slope_at_most) - limit) < 1e-5);
      // On the level: a = g b/h. On a slope the acceleration across gravity turns its direction by the same angle.
      CHECK(std::abs(found[0].acceleration - k_g * std::tan(limit - std::abs(slope))) < 1.2e-5 * k_g);
      if (slope > 0.0) {
        CHECK(found[0].about == (contact == k_feet ? "right" : "floor (right end)"));
        CHECK(found[0].lifts == (contact == k_feet ? "left" : "floor (left end)"));
        CHECK(found[0].is_clockwise);
      }
      if (slope < 0.0) {
        CHECK(found[0].about == (contact == k_feet ? "left" : "floor (left end)"));
        CHECK_FALSE(found[0].is_clockwise);
      }
      CHECK(tipping_over(*loaded, loaded->assembled).empty());
    }
  }
}

TEST_CASE("a block on a steeper incline tips over as it is given, and it is told from which angle on") {
  for (const std::string& contact : {k_outline, k_feet}) {
    const auto loaded = loaded_from(block(24.0 * k_degree, contact));
    const auto found = tipping_of(*loaded, loaded->assembled);
    REQUIRE(found.size() == 1);
    CHECK(found[0].margin == doctest::Approx(std::atan(0.4) - 24.0 * k_degree).epsilon(1e-6));
    const auto texts = tipping_over(*loaded, loaded->assembled);
    REQUIRE(texts.size() == 1);
    CHECK(texts[0].find("up to 21.8°, this one has 24°") != std::string::npos);
  }
}

// Of truck, forks and load together: b and h from the front wheels' point; a = g b/h.
TEST_CASE("the forklift tips over its front wheels at g b/h") {
  const double mass = 2800.0 + 1100.0 + 60.0;
  const double b = (2800.0 * 0.95 - 1100.0 * 0.7 - 60.0 * 0.65) / mass, h = (2800.0 * 0.65 + 1100.0 * 2.3 + 60.0 * 1.82) / mass;
  const auto loaded = machine("forklift");
  const auto found = tipping_of(*loaded, equilibrium_of(*loaded).state);
  REQUIRE(found.size() == 1);
  CHECK(found[0].others == 2);
  CHECK(found[0].about == "front wheels");
  CHECK(found[0].lifts == "rear wheels");
  CHECK(found[0].margin == doctest::Approx(std::atan(b / h)).epsilon(1e-3)); // tyres give by a millimetre
  CHECK(found[0].acceleration == doctest::Approx(k_g * b / h).epsilon(1e-3));
  CHECK(tipping_over(*loaded, loaded->assembled).empty());
  // With its counterweight gone it tips as it is: b < 0.
  const auto light = machine("forklift", {"body.truck.mass=\"700 kg\""});
  const auto texts = tipping_over(*light, light->assembled);
  REQUIRE(texts.size() == 1);
  CHECK(texts[0].find("'load' with 2 others tips over 'front wheels', and 'rear wheels' lifts") != std::string::npos);
}

// Of three blocks each on two feet, the lowest carries the others: each part tips about its own feet.
TEST_CASE("each of stacked blocks tips with what stands on it, a ladder away from its wall") {
  const auto ladder = machine("ladder");
  const auto found = tipping_of(*ladder, equilibrium_of(*ladder).state);
  REQUIRE(found.size() == 1);
  CHECK(found[0].about == "foot");
  CHECK(found[0].lifts == "head");
  // Its middle stands over the foot when it is turned by 90° - its own angle to the floor.
  CHECK(found[0].margin == doctest::Approx(0.5 * 3.14159265358979323846 - 1.07884411545309).epsilon(1e-3));

  const auto lower = [](double half) {
    return "[[body]]\nname = \"lower\"\nmass = 50.0\ninertia = 5.0\nposition = [0.0, 0.2]\noutline = [[" + number(-half) + ", -0.2], [" +
           number(half) + ", -0.2], [" + number(half) + ", 0.2], [" + number(-half) +
           ", 0.2]]\n"
           "[[body]]\nname = \"upper\"\nmass = 20.0\ninertia = 1.0\nposition = [0.1, 0.7]\noutline = [[-0.2, -0.3], [0.2, -0.3], [0.2, "
           "0.3], [-0.2, 0.3]]\n"
           "[[element]]\nkind = \"polygon_contact\"\nname = \"ground face\"\na = \"lower\"\nstiffness = 1e10\nstatic_friction = 0.9\n"
           "[[element]]\nkind = \"polygon_contact\"\nname = \"middle face\"\na = \"upper\"\nb = \"lower\"\nstiffness = "
           "1e10\nstatic_friction = 0.9\n";
  };
  const auto stack = loaded_from("[simulation]\nend = 1.0\n" + lower(0.5));
  const auto parts = tipping_of(*stack, equilibrium_of(*stack).state);
  REQUIRE(parts.size() == 2);
  const double x = 20.0 * 0.1 / 70.0, y = (50.0 * 0.2 + 20.0 * 0.7) / 70.0;
  CHECK(parts[0].others == 1);
  CHECK(parts[0].margin == doctest::Approx(std::atan((0.5 - x) / y)).epsilon(1e-3));
  CHECK(parts[1].others == 0);
  CHECK(parts[1].margin == doctest::Approx(std::atan(0.2 / 0.3)).epsilon(1e-3));
  CHECK(parts[1].about.find("middle face") == 0);
}

namespace {

// A mast of 100 kg, its centre 2 m up, on feet 0.8 m to either side; an arm reaches to a point 0.3 m to the right, 5 m
// up.
constexpr double k_half = 0.8, k_mast = 100.0, k_high = 2.0, k_arm = 0.3, k_top = 5.0, k_load = 60.0;

std::string mast(const std::string& more) {
  const auto stand = [](const char* name, double x) {
    return "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + std::string(name) + "\"\na = { body = \"mast\", at = [" + number(x) +
           ", 0.0] }\nstiffness = 1e9\n[[element]]\nkind = \"coulomb_stick\"\nname = \"" + name + " grip\"\ncontacts = [\"" + name +
           "\"]\nstatic_friction = 0.9\n";
  };
  return "[simulation]\nend = 1.0\n[[body]]\nname = \"mast\"\nmass = 100.0\ninertia = 300.0\nposition = [0.0, 2.0]\n"
         "[[marker]]\nname = \"top\"\nbody = \"mast\"\nat = [0.3, 5.0]\n" +
         stand("left", -k_half) + stand("right", k_half) + more;
}

std::string table(const std::string& array, const std::string& fields) {
  std::string text = "[[" + array + "]]\n" + fields + "\n";
  std::replace(text.begin(), text.end(), ';', '\n');
  return text;
}

std::string load_at(double x, double y, double mass = k_load, const std::string& name = "load") {
  return table("body",
               "name = '" + name + "'; mass = " + number(mass) + "; inertia = 2.0; position = [" + number(x) + ", " + number(y) + "]");
}

// The weight of what hangs pulls at the point that it hangs from, however that is tilted.
double mast_margin(double weight_at_top) {
  return std::atan((k_mast * k_half + weight_at_top * (k_half - k_arm)) / (k_mast * k_high + weight_at_top * k_top));
}

} // namespace

// Feet of 1e9 N/m under 1.6 kN give way by µm, over 1.6 m, and the mast turns by some 1e-6.
TEST_CASE("a mast tips with its hanging load as if that were in the point that it hangs from") {
  const std::string below = load_at(k_arm, 3.0), hook = "a = { body = 'load', point = [0.0, 0.0] }; b = 'top'";
  const std::string winch = table("marker", "name = 'winch'; body = 'mast'; at = [-0.4, 0.5]");
  const std::vector<std::pair<const char*, std::string>> ways{
      {"rod", below + table("element", "kind = 'distance'; name = 'hook'; " + hook)},
      {"pin", below + table("element", "kind = 'revolute'; name = 'hook'; a = { body = 'load', at = [0.3, 5.0] }; b = 'top'")},
      {"rope", below + table("element", "kind = 'rope'; name = 'hook'; inextensible = true; " + hook)},
      {"elastic rope", below + table("element", "kind = 'rope'; name = 'hook'; stiffness = 1e6; " + hook)},
      {"spring", below + table("element", "kind = 'spring_damper'; name = 'hook'; stiffness = 1e6; " + hook)},
      {"rope to a winch",
       below + winch + table("element", "kind = 'rope'; name = 'hook'; inextensible = true; a = 'load'; over = ['top']; b = 'winch'")},
      {"elastic rope to a winch",
       below + winch + table("element", "kind = 'rope'; name = 'hook'; stiffness = 1e7; a = 'winch'; over = ['top']; b = 'load'")},
      {"two in a chain", load_at(k_arm, 4.0, 20.0, "block") + load_at(k_arm, 3.0, 40.0) +
                             table("element", "kind = 'distance'; name = 'upper'; a = 'block'; b = 'top'") +
                             table("element", "kind = 'distance'; name = 'lower'; a = 'load'; b = 'block'")}};
  for (const auto& [name, how] : ways) {
    CAPTURE(std::string(name));
    const auto loaded = loaded_from(mast(how));
    const auto found = tipping_of(*loaded, equilibrium_of(*loaded).state);
    REQUIRE(found.size() == 1);
    CHECK(loaded->system->bodies[found[0].body].name == "mast");
    CHECK(found[0].about == "right");
    CHECK(found[0].is_clockwise);
    CHECK(std::abs(found[0].margin - mast_margin(k_load)) < 1e-5);
    CHECK(std::abs(found[0].acceleration - k_g * std::tan(mast_margin(k_load))) < 1e-4);
    // As given, before any rope is drawn tight: the same.
    const auto given = tipping_of(*loaded, loaded->assembled);
    REQUIRE(given.size() == 1);
    CHECK(std::abs(given[0].margin - mast_margin(k_load)) < 1e-5);
  }
  // Given swung out it hangs from the same point.
  const auto swung = loaded_from(mast(load_at(k_arm + 1.2, 3.4) + table("element", "kind = 'distance'; name = 'hook'; " + hook)));
  const auto found = tipping_of(*swung, swung->assembled);
  REQUIRE(found.size() == 1);
  CHECK(std::abs(found[0].margin - mast_margin(k_load)) < 1e-5);
  // Without it the same mast has more.
  const auto bare = loaded_from(mast(""));
  CHECK(std::abs(tipping_of(*bare, equilibrium_of(*bare).state)[0].margin - std::atan(k_half / k_high)) < 1e-5);
  // A load that no tilt would let hang freely is not one that hangs: its motor holds it.
  const auto held =
      loaded_from(mast(below + table("element", "kind = 'revolute'; name = 'hook'; a = { body = 'load', at = [0.3, 5.0] }; b = 'top'") +
                       table("element", "kind = 'rotational_spring_damper'; name = 'motor'; a = 'load'; b = 'mast'; stiffness = 1e4")));
  CHECK(tipping_of(*held, equilibrium_of(*held).state).empty());
}

// Of a load whose rope runs on to the ground the mast bears both falls: its weight M g below the pulley, and M g
// towards the winch. Moments about the foot that it turns about, with down turned by the margin, are zero.
TEST_CASE("a rope that runs over the mast to a winch on the ground pulls it towards there") {
  const double light = 20.0;
  for (const double at : {-6.0, 5.0}) {
    CAPTURE(at);
    const auto loaded =
        loaded_from(mast(load_at(k_arm, 3.0, light) + table("marker", "name = 'winch'; body = 'ground'; at = [" + number(at) + ", 0.0]") +
                         table("element", "kind = 'rope'; name = 'hoist'; stiffness = 1e7; a = 'load'; over = ['top']; b = 'winch'")));
    const auto found = tipping_of(*loaded, equilibrium_of(*loaded).state);
    REQUIRE(found.size() == 1);
    const double turn = found[0].is_clockwise ? found[0].margin : -found[0].margin; // of down, counter-clockwise
    const double foot = found[0].about == "right" ? k_half : -k_half;
    CHECK((at > 0.0) == found[0].is_clockwise);
    const double down_x = std::sin(turn), down_y = -std::cos(turn), length = std::hypot(at - k_arm, k_top);
    const auto moment = [&](double x, double y, double fx, double fy) { return (x - foot) * fy - y * fx; };
    const double sum = moment(0.0, k_high, k_mast * down_x, k_mast * down_y) + moment(k_arm, k_top, light * down_x, light * down_y) +
                       moment(k_arm, k_top, light * (at - k_arm) / length, -light * k_top / length);
    CHECK(std::abs(sum) < 1e-4 * k_mast * k_high);
  }
}

// A stay that does not stretch lets the mast turn one way only; two hold it.
TEST_CASE("a mast with a taut stay tips the other way") {
  const auto stay = [](const char* name, double x) {
    return table("element", "kind = 'rope'; name = '" + std::string(name) +
                                "'; inextensible = true; a = 'top'; b = { body = 'ground', at = [" + number(x) + ", 0.0] }");
  };
  const auto left = loaded_from(mast(stay("stay", -4.0)));
  const auto found = tipping_of(*left, left->assembled);
  REQUIRE(found.size() == 1);
  CHECK(found[0].about == "left"); // away from there the stay would have to be longer
  const auto both = loaded_from(mast(stay("one stay", -4.0) + stay("other stay", 4.0)));
  CHECK(tipping_of(*both, both->assembled).empty());
}

namespace {

// Columns 2b (the right one 2b') wide and 2h high, 4 m apart, and a beam over both, lying on their faces, its centre at
// beam_x.
std::string portal(double slope, double b, double h, double column, double beam, double right_b = 0.0, double beam_x = 0.0) {
  if (right_b == 0.0) right_b = b;
  const auto box = [](const std::string& name, double mass, double x, double y, double half_width, double half_height) {
    const std::string w = number(half_width), l = number(half_height);
    return table("body", "name = '" + name + "'; mass = " + number(mass) +
                             "; inertia = " + number(mass * (half_width * half_width + half_height * half_height) / 3.0) +
                             "; position = [" + number(x) + ", " + number(y) + "]; outline = [[-" + w + ", -" + l + "], [" + w + ", -" + l +
                             "], [" + w + ", " + l + "], [-" + w + ", " + l + "]]");
  };
  const auto face = [](const std::string& name, const std::string& on) {
    return table("element", "kind = 'polygon_contact'; name = '" + name + "'; " + on + "; stiffness = 1e11; static_friction = 0.8");
  };
  return "gravity = [" + number(k_g * std::sin(slope)) + ", " + number(-k_g * std::cos(slope)) + "]\n[simulation]\nend = 1.0\n" +
         box("left column", column, -2.0, h, b, h) + box("right column", column, 2.0, h, right_b, h) +
         box("beam", beam, beam_x, 2.0 * h + 0.2, 4.0, 0.2) + face("left base", "a = 'left column'") +
         face("right base", "a = 'right column'") + face("left head", "a = 'beam'; b = 'left column'") +
         face("right head", "a = 'beam'; b = 'right column'");
}

} // namespace

// Both columns turn about the corners of their bases, and the beam rides on the opposite corners of their heads: it
// goes as far and rises as much as a point at that corner, twice as far and as much as a column's own centre. So it
// takes b/h, as for one column alone, whatever the beam weighs (N. Makris, M. F. Vassiliou, Earthquake Engng Struct.
// Dyn. 42 (2013) 2015, of colonnades).
TEST_CASE("columns under a beam tip at the angle of a single column, whatever the beam weighs") {
  for (const double beam : {10.0, 400.0, 5000.0}) {
    CAPTURE(beam);
    const double limit = std::atan(0.3 / 1.5);
    for (const double slope : {0.0, 0.1, -0.05}) {
      CAPTURE(slope);
      const auto loaded = loaded_from(portal(slope, 0.3, 1.5, 800.0, beam));
      const auto found = tipping_of(*loaded, equilibrium_of(*loaded).state);
      REQUIRE(!found.empty());
      const auto nearest =
          std::min_element(found.begin(), found.end(), [](const Tipping& one, const Tipping& other) { return one.margin < other.margin; });
      CHECK(nearest->others == 2);
      // Faces of 1e11 N/m² under 1e4 N/m give way by 1e-7 m.
      CHECK(std::abs(nearest->margin - (limit - std::abs(slope))) < 1e-5);
      if (slope != 0.0) CHECK(nearest->is_clockwise == (slope > 0.0));
      CHECK(tipping_over(*loaded, loaded->assembled).empty());
    }
    // Beyond it they come down as they are given: told, and no rest as given is found.
    const auto steep = loaded_from(portal(1.05 * limit, 0.3, 1.5, 800.0, beam));
    const auto texts = tipping_over(*steep, steep->assembled);
    REQUIRE(texts.size() == 1);
    CHECK(texts[0].find("up to 11.3°") != std::string::npos);
  }
}

// Of unequal columns the corner of the wider one lifts the beam more, which so turns. Clockwise about corners at right:
// the beam lies on corners at left, and each of these goes 2h along and as much up as its column is wide.
TEST_CASE("unequal columns under a beam that lies askew tip as the power of all weights has it") {
  const double b = 0.3, wide = 0.45, h = 1.5, column = 800.0, beam = 700.0;
  for (const double x : {-0.8, 0.0, 1.2}) {
    CAPTURE(x);
    const auto tilt = [&](double from, double left_rise, double to, double right_rise, double sense) {
      const double turns = (right_rise - left_rise) / (to - from); // of the beam, per rate of the columns
      const double rise = column * (b + wide) + beam * (left_rise + turns * (x - from));
      const double along = 2.0 * column * h + beam * (2.0 * h - sense * turns * 0.2); // its centre is 0.2 m above its face
      return std::atan(rise / along);
    };
    const double clockwise = tilt(-2.0 - b, 2.0 * b, 2.0 - wide, 2.0 * wide, 1.0),
                 counter = tilt(-2.0 + b, 2.0 * b, 2.0 + wide, 2.0 * wide, -1.0);
    const auto loaded = loaded_from(portal(0.0, b, h, column, beam, wide, x));
    const auto found = tipping_of(*loaded, equilibrium_of(*loaded).state);
    REQUIRE(!found.empty());
    const auto nearest =
        std::min_element(found.begin(), found.end(), [](const Tipping& one, const Tipping& other) { return one.margin < other.margin; });
    CHECK(std::abs(nearest->margin - std::min(clockwise, counter)) < 1e-5);
    CHECK(nearest->is_clockwise == (clockwise < counter));
    // And the way of statics: up to there it stands where it is, beyond it comes down.
    for (const double share : {0.97, 1.03}) {
      const double sense = nearest->is_clockwise ? 1.0 : -1.0;
      const auto tilted = loaded_from(portal(sense * share * nearest->margin, b, h, column, beam, wide, x));
      bool stands = false;
      try {
        const Equilibrium rest = equilibrium_of(*tilted);
        stands = rest.moved < 0.01;
      } catch (const NumericalFailure&) {}
      CHECK(stands == (share < 1.0));
    }
  }
}

// Where nothing else stops it there is no rest, and the failure says what tips: a wagon's wheels run on a rail that ends
// beside the front wheel. (On a longer one it turns over and hangs by that wheel.)
TEST_CASE("a search that finds no rest says what tips over") {
  const std::string wheels = "[[body]]\nname = \"crane\"\nmass = 100.0\ninertia = 20.0\nposition = [0.7, 1.0]\n";
  const auto wheel = [](const char* name, double x) {
    return std::string("[[element]]\nkind = \"segment_contact\"\nname = \"") + name + "\"\na = { body = \"crane\", at = [" + number(x) +
           ", 0.25] }\nradius = 0.25\nfrom = [-1.0, 0.0]\nto = [0.6, 0.0]\nstiffness = 1e7\n[[element]]\nkind = \"coulomb_stick\"\nname = "
           "\"" +
           name + " grip\"\ncontacts = [\"" + name + "\"]\nstatic_friction = 0.5\n";
  };
  const auto loaded = loaded_from("[simulation]\nend = 1.0\n" + wheels + wheel("rear", -0.5) + wheel("front", 0.5));
  std::string message;
  try {
    static_cast<void>(equilibrium_of(*loaded));
  } catch (const NumericalFailure& failure) {
    message = failure.what();
  }
  // Its centre is 0.2 m beyond the front wheel, 1 m high.
  CHECK(message.find("no static equilibrium") != std::string::npos);
  CHECK(message.find("'crane' tips over 'front', and 'rear' lifts: the line of its loads passes 11.3° outside") != std::string::npos);
}

// A lift's cage on a truck: held by a servo it is no rigid part of it, levelled by a drive against the ground it cannot turn.
TEST_CASE("what stands and is not judged says why") {
  const std::string lift = foot("left", -0.2) + foot("right", 0.2) +
                           "[[body]]\nname = \"cage\"\nmass = 5.0\ninertia = 0.5\nposition = [0.0, 1.2]\n"
                           "[[element]]\nkind = \"revolute\"\nname = \"hinge\"\na = { body = \"cage\", at = [0.0, 1.0] }\nb = { body = "
                           "\"block\", at = [0.0, 1.0] }\n";
  const std::string servo = "[[element]]\nkind = \"motor\"\nname = \"level\"\na = \"cage\"\nb = \"block\"\ncoordinate = "
                            "\"angle\"\nproportional = 1e5\nderivative = 1e3\n";
  const std::string drive =
      "[[signal]]\nname = \"zero\"\nkind = \"constant\"\nvalue = 0.0\n[[element]]\nkind = \"prescribed_motion\"\nname = \"level\"\n"
      "a = \"cage\"\ncoordinate = \"angle\"\nsignal = \"zero\"\nas = \"position\"\nzero = \"reference\"\n"
      "[[element]]\nkind = \"weld\"\nname = \"rigid\"\na = { body = \"cage\", at = [0.0, 1.0] }\nb = { body = \"block\", at = [0.0, 1.0] "
      "}\n";
  const auto held = loaded_from(block(0.0, lift + servo));
  const auto by_servo = not_judged_for_tipping(*held, equilibrium_of(*held).state);
  REQUIRE(by_servo.size() == 1);
  CHECK(by_servo[0].why.find("joints let parts of it move") != std::string::npos);
  const std::string without_hinge = lift.substr(0, lift.find("[[element]]\nkind = \"revolute\""));
  const auto levelled = loaded_from(block(0.0, without_hinge + drive));
  const auto by_drive = not_judged_for_tipping(*levelled, equilibrium_of(*levelled).state);
  REQUIRE(by_drive.size() == 1);
  CHECK(by_drive[0].why.find("keep it from turning over") != std::string::npos);
  const auto plain = loaded_from(block(0.0, k_feet));
  CHECK(not_judged_for_tipping(*plain, equilibrium_of(*plain).state).empty());
}

TEST_CASE("a ball, a pendulum and a crane's arm have nothing to tip over") {
  for (const std::string name : {"ball_on_incline", "cradle", "crane_arm"}) {
    const auto loaded = machine(name);
    CHECK(tipping_of(*loaded, loaded->assembled).empty());
  }
}

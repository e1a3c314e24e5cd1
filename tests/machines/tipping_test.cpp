// What stands, and how far it is from tipping over, against closed forms.
#include "mbd/io/reader.h"
#include "tests/machines/machine.h"
#include "tools/steplap/tipping.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

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
         "outline = [[-0.2, -0.5], [0.2, -0.5], [0.2, 0.5], [-0.2, 0.5]]\n" + contact;
}

const std::string k_outline = "[[element]]\nkind = \"polygon_contact\"\nname = \"floor\"\na = \"block\"\nstiffness = 1e12\n"
                              "static_friction = 0.9\n";

std::string foot(const std::string& name, double x) {
  return "[[element]]\nkind = \"unilateral_contact\"\nname = \"" + name + "\"\na = { body = \"block\", point = [" + number(x) +
         ", -0.5] }\nstiffness = 1e8\ndamping = 1e4\n";
}

const std::string k_feet = foot("left", -0.2) + foot("right", 0.2) +
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
           number(half) + ", -0.2], [" + number(half) + ", 0.2], [" + number(-half) + ", 0.2]]\n"
           "[[body]]\nname = \"upper\"\nmass = 20.0\ninertia = 1.0\nposition = [0.1, 0.7]\noutline = [[-0.2, -0.3], [0.2, -0.3], [0.2, 0.3], [-0.2, 0.3]]\n"
           "[[element]]\nkind = \"polygon_contact\"\nname = \"ground face\"\na = \"lower\"\nstiffness = 1e10\nstatic_friction = 0.9\n"
           "[[element]]\nkind = \"polygon_contact\"\nname = \"middle face\"\na = \"upper\"\nb = \"lower\"\nstiffness = 1e10\nstatic_friction = 0.9\n";
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

// Where nothing else stops it there is no rest, and the failure says what tips: a wagon's wheels run on a rail that ends.
TEST_CASE("a search that finds no rest says what tips over") {
  const std::string wheels = "[[body]]\nname = \"crane\"\nmass = 100.0\ninertia = 20.0\nposition = [0.7, 1.0]\n";
  const auto wheel = [](const char* name, double x) {
    return std::string("[[element]]\nkind = \"segment_contact\"\nname = \"") + name + "\"\na = { body = \"crane\", at = [" + number(x) +
           ", 0.25] }\nradius = 0.25\nfrom = [-1.0, 0.0]\nto = [1.0, 0.0]\nstiffness = 1e7\n[[element]]\nkind = \"coulomb_stick\"\nname = \"" + name +
           " grip\"\ncontacts = [\"" + name + "\"]\nstatic_friction = 0.5\n";
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

TEST_CASE("a ball, a pendulum and a crane's arm have nothing to tip over") {
  for (const std::string name : {"ball_on_incline", "cradle", "crane_arm"}) {
    const auto loaded = machine(name);
    CHECK(tipping_of(*loaded, loaded->assembled).empty());
  }
}

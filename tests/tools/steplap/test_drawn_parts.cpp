// What elements draw of the bodies that they act on: outlines and circles that their fields make.
#include "mbd/io/reader.h"
#include "mbd/run/drawing.h"
#include "transformer/program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

using namespace steplap;

namespace {

// A ball, and a slab that lies turned by a right angle at the origin.
nlohmann::json drawing_of(const std::string& elements) {
  const std::string bodies = "simulation = { step = 1e-3 }\n[[body]]\nname = \"ball\"\nmass = 1\ninertia = 1e6\nposition = [1, 2]\n"
                             "[[body]]\nname = \"slab\"\nmass = 1\ninertia = 1\nangle = \"90 deg\"\n";
  return nlohmann::json::parse(drawing_json(parse_model(bodies + elements, "a.toml", program_catalogue()), *program_catalogue().views));
}

} // namespace

TEST_CASE("a cam has the outline that lifts its follower's point, and gears that turn against each other their pitch circles") {
  // An eccentric of 30 mm, 10 mm out of its axis: a pointed follower above it is at 10 mm cos φ + √(30² − (10 sin φ)²) mm.
  const auto digits = [](double value) { return nlohmann::json(value).dump(); };
  const auto height = [](double angle) { return 0.01 * std::cos(angle) + std::sqrt(9e-4 - 1e-4 * std::sin(angle) * std::sin(angle)); };
  std::string lift;
  const int count = 72;
  for (int i = 0; i <= count; ++i)
    lift += (i ? ", [" : "[") + digits(2.0 * M_PI * i / count) + ", " + digits(height(2.0 * M_PI * (i % count) / count)) + "]";
  const double start = 40.0 * M_PI / 180.0;
  const auto outline_of = [&](double above) { // of a follower's point above the slab's centre
    return drawing_of("[[element]]\nkind = \"cam\"\nname = \"cam\"\ncam = \"slab\"\nstiffness = 1e6\naxis = [0, 1]\nlift = [" + lift +
                      "]\nstart_angle = \"40 deg\"\na = { body = \"ball\", at = [0, " + digits(above) + "] }\n")["bodies"][1]["polygons"];
  };
  const auto polygons = outline_of(height(start));
  REQUIRE(polygons.size() == 1);
  REQUIRE(polygons[0].size() == 180);
  // All of them on the circle, whose middle is 40 degrees before the follower; in the slab's axes, which are turned by a right angle. The
  // spline through points 5 degrees apart is off by 5/384 of the fourth power of that times the fourth derivative, some 0.02 m.
  const double middle_x = 0.01 * std::cos(start), middle_y = 0.01 * std::sin(start);
  for (const auto& corner : polygons[0])
    CHECK(std::abs(std::hypot(corner[0].get<double>() - middle_x, corner[1].get<double>() - middle_y) - 0.03) < 3e-8);
  CHECK(outline_of(0.0).empty()); // its point would pass the cam's axis

  const auto geared = [](const std::string& ratio) {
    return drawing_of("[[element]]\nkind = \"lossy_gear\"\nname = \"gear\"\na = \"ball\"\nb = \"slab\"\nstiffness = 1e6\nratio = " + ratio +
                      "\n");
  };
  const auto meshed = geared("-3");
  REQUIRE(meshed["bodies"][0]["circles"].size() == 1);
  REQUIRE(meshed["bodies"][1]["circles"].size() == 1);
  const double radius_a = meshed["bodies"][0]["circles"][0][2], radius_b = meshed["bodies"][1]["circles"][0][2];
  CHECK(radius_b == doctest::Approx(3.0 * radius_a));
  CHECK(radius_a + radius_b == doctest::Approx(std::sqrt(5.0))); // from centre to centre
  CHECK(meshed["elements"][0]["shapes"].size() == 2);
  CHECK(geared("3")["bodies"][0]["circles"].empty());
}

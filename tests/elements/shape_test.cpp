// [[shape]]: masses, centres and inertias of outlines against closed forms, and what makes no sense.
#include "elements/shape.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace steplap;

namespace {

const char* const k_body = "[[body]]\nname = \"part\"\n";

Model read(const std::string& text) { return parse_model(text, "m.toml", transformer_catalog()); }

Body body_of(const std::string& shape, const std::string& body = k_body) { return read(body + shape).bodies.front(); }

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

// Sums of a few products of numbers of one size: some roundings.
doctest::Approx near(double x) { return doctest::Approx(x).epsilon(1e-13); }

std::string list_of(const std::vector<Vec2>& points) {
  std::string text;
  for (const Vec2& p : points) {
    char digits[80];
    std::snprintf(digits, sizeof digits, "%s[%.17g, %.17g]", text.empty() ? "" : ", ", p.x(), p.y());
    text += digits;
  }
  return "[" + text + "]";
}

} // namespace

TEST_CASE("rectangle, either sense, far from the origin") {
  for (const char* const outline :
       {"[[100.0, 50.0], [100.4, 50.0], [100.4, 50.3], [100.0, 50.3]]", "[[100.0, 50.3], [100.4, 50.3], [100.4, 50.0], [100.0, 50.0]]"}) {
    const Body b = body_of(std::string("[[shape]]\nname = \"s\"\nbody = \"part\"\noutline = ") + outline +
                           "\ndensity = \"7850 kg/m^3\"\nthickness = \"20 mm\"\n");
    const double mass = 7850.0 * 0.02 * 0.4 * 0.3;
    // The corners themselves are rounded to 1e-14 of their distance: 1e-12 of the sides.
    CHECK(b.mass == doctest::Approx(mass).epsilon(1e-12));
    CHECK(b.inertia == doctest::Approx(mass * (0.16 + 0.09) / 12).epsilon(1e-11));
    CHECK(b.cg.x() == near(100.2));
    CHECK(b.cg.y() == near(50.15));
    CHECK(b.outline.size() == 4);
  }
}

TEST_CASE("disc and ring") {
  const Body disc = body_of("[[shape]]\nname = \"s\"\nbody = \"part\"\ncentre = [1.0, 2.0]\ndiameter = 0.6\nmass = 3.0\n");
  CHECK(disc.mass == 3.0);
  CHECK(disc.inertia == near(3.0 * 0.09 / 2));
  CHECK(disc.cg == Vec2(1.0, 2.0));
  const Body ring = body_of("[[shape]]\nname = \"s\"\nbody = \"part\"\ndiameter = 0.6\nhole_centres = [[0.0, 0.0]]\nhole_diameters = "
                            "[0.4]\narea_density = 100.0\n");
  const double mass = 100.0 * std::numbers::pi * (0.09 - 0.04);
  CHECK(ring.mass == near(mass));
  CHECK(ring.inertia == near(mass * (0.09 + 0.04) / 2));
}

TEST_CASE("an L by Steiner, as one outline and as two shapes") {
  // A lying leg of 0.5 × 0.1 and a standing one of 0.1 × 0.3 on its left end.
  const double lying = 0.05, standing = 0.03, density = 40.0;
  const Vec2 c1(0.25, 0.05), c2(0.05, 0.25);
  const Vec2 centre = (lying * c1 + standing * c2) / (lying + standing);
  const double inertia =
      density * (lying * (0.26 / 12 + (c1 - centre).squaredNorm()) + standing * (0.1 / 12 + (c2 - centre).squaredNorm()));
  for (const char* const shapes :
       {"[[shape]]\nname = \"s\"\nbody = \"part\"\noutline = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.1], [0.1, 0.1], [0.1, 0.4], [0.0, "
        "0.4]]\narea_density = 40.0\n",
        "[[shape]]\nname = \"a\"\nbody = \"part\"\noutline = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.1], [0.0, 0.1]]\narea_density = 40.0\n"
        "[[shape]]\nname = \"b\"\nbody = \"part\"\noutline = [[0.0, 0.1], [0.1, 0.1], [0.1, 0.4], [0.0, 0.4]]\nmass = 1.2\n"}) {
    const Body b = body_of(shapes);
    CHECK(b.mass == near(density * 0.08));
    CHECK(b.inertia == near(inertia));
    CHECK((b.cg - centre).norm() < 1e-15); // m, a rounding of 0.3 m
  }
}

TEST_CASE("regular polygons by Green's theorem") {
  // About the centre J/m = R²/6 · (2 + cos 2π/n) for corners on a circle of radius R.
  for (int n = 3; n <= 12; ++n) {
    std::vector<Vec2> corners;
    for (int k = 0; k < n; ++k)
      corners.emplace_back(0.3 + 0.7 * std::cos(2 * std::numbers::pi * k / n + 0.1),
                           -0.2 + 0.7 * std::sin(2 * std::numbers::pi * k / n + 0.1));
    const Body b = body_of("[[shape]]\nname = \"s\"\nbody = \"part\"\noutline = " + list_of(corners) + "\nmass = 5.0\n");
    CHECK(b.inertia == near(5.0 * 0.49 / 6 * (2 + std::cos(2 * std::numbers::pi / n))));
    CHECK(b.cg.x() == near(0.3));
    CHECK(b.cg.y() == near(-0.2));
  }
}

TEST_CASE("holes of any shape are taken off, the mass given is of what is left") {
  // A square of 1 m with a square hole of 0.2 m about (0.3, 0) and a round one of 0.2 m about (-0.3, 0.1).
  const double hole = 0.04, round = std::numbers::pi * 0.01, left = 1.0 - hole - round;
  const Vec2 centre = -(hole * Vec2(0.3, 0.0) + round * Vec2(-0.3, 0.1)) / left;
  const double polar = 1.0 / 6 - hole * (0.08 / 12 + 0.09) - round * (0.01 / 2 + 0.1) - left * centre.squaredNorm();
  const Body b = body_of("[[shape]]\nname = \"s\"\nbody = \"part\"\nholes = [[[0.2, -0.1], [0.2, 0.1], [0.4, 0.1], [0.4, "
                         "-0.1]]]\nhole_centres = [[-0.3, 0.1]]\nhole_diameters = [0.2]\nmass = 7.0\n",
                         std::string(k_body) + "outline = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]\n");
  CHECK(b.mass == 7.0);
  CHECK(b.inertia == near(7.0 * polar / left));
  CHECK((b.cg - centre).norm() < 1e-15); // m, some roundings of centimetres
}

TEST_CASE("what a body gives itself holds, and is told where it contradicts its shape") {
  const std::string shape = "[[shape]]\nname = \"s\"\nbody = \"part\"\noutline = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.2], [0.0, 0.2]]\n";
  const Body b = body_of(shape, std::string(k_body) + "mass = 6.0\n");
  CHECK(b.inertia == near(6.0 * 0.4 / 12));
  CHECK(b.cg.x() == near(0.3));
  CHECK(contradicted_shapes(read(std::string(k_body) + "mass = 6.0\n" + shape)).empty());
  CHECK(contradicted_shapes(read(std::string(k_body) + "mass = 6.05\ninertia = 0.2\n" + shape + "area_density = 50.0\n"))
            .empty()); // by less than a hundredth
  const auto remarks =
      contradicted_shapes(read(std::string(k_body) + "mass = 7.0\ninertia = 0.4\ncg = [0.3, 0.15]\n" + shape + "area_density = 50.0\n"));
  REQUIRE(remarks.size() == 3);
  CHECK(remarks[0].text ==
        "'mass' of body 'part', 7 kg, contradicts its shape, which makes it 6 kg: leave 'mass' out to take it from the shape");
  CHECK(remarks[1].text.find("'inertia' of body 'part', 0.4 kg m², contradicts its shape, which makes it 0.233333 kg m²") == 0); // of 7 kg
  CHECK(remarks[2].text.find("'cg' of body 'part', [0.3, 0.15] m, contradicts its shape, whose centre is [0.3, 0.1] m") == 0);
  CHECK(remarks[0].where.line == 1);
}

TEST_CASE("a parameter of the outline carries the mass with it") {
  const std::string text = "[parameters]\nwidth = \"0.4 m\"\n" + std::string(k_body) +
                           "[[shape]]\nname = \"s\"\nbody = \"part\"\noutline = [[0.0, 0.0], [\"= width\", 0.0], [\"= width\", 0.5], [0.0, "
                           "0.5]]\narea_density = 10.0\n";
  Model given = parse_given_model(text, "m.toml", transformer_catalog());
  set_value(given, "parameters.width", 0.8);
  CHECK(completed(given).bodies.front().mass == near(4.0));
}

TEST_CASE("shapes that are none are refused with their place") {
  struct Case {
    const char *shape, *message;
  };
  const std::string square = "outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]\n";
  const Case cases[] = {
      {"mass = 1.0\n", "needs 'outline' or 'diameter', since body 'part' has no outline"},
      {"outline = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]\nmass = 1.0\n", "m.toml:6:11: error: shape 's': "},
      {"outline = [[0.0, 0.0], [1.0, 0.0]]\nmass = 1.0\n", "m.toml:6:11: error: shape 's': "},
      {"#square\n", "needs 'mass', 'area_density' or 'density' with 'thickness', since body 'part' has no mass either"},
      {"#square\ndensity = 7850\n", "m.toml:7:11: error: shape 's': 'density' and 'thickness' go together"},
      {"#square\nmass = 1\narea_density = 1\n", "gives both 'mass' and a density"},
      {"#square\nmass = 1\ndiameter = 1\n", "gives both 'outline' and 'diameter'"},
      {"#square\nmass = 1\ncentre = [1, 1]\n", "'centre' goes with 'diameter'"},
      {"#square\nmass = 1\nhole_centres = [[0.5, 0.5], [0.2, 0.2]]\n", "has 2 hole centres and 0 diameters"},
      {"#square\nmass = 1\nhole_centres = [[0.9, 0.5]]\nhole_diameters = [0.4]\n", "round hole 1"},
      {"#square\nmass = 1\nholes = [[[2.0, 2.0], [3.0, 2.0], [3.0, 3.0]]]\n", "hole 1"},
      {"#square\nmass = 0\n", "must be greater than 0 kg"},
  };
  for (const Case& c : cases) {
    std::string shape = c.shape;
    if (shape.starts_with("#square\n")) shape = square + shape.substr(8);
    const std::string text = refusal(std::string(k_body) + "[[shape]]\nname = \"s\"\nbody = \"part\"\n" + shape);
    CAPTURE(c.shape);
    CAPTURE(text);
    CHECK(text.find(c.message) != std::string::npos);
    CHECK(text.find("m.toml:") != std::string::npos);
  }
  CHECK(refusal(std::string(k_body) + "[[shape]]\nname = \"s\"\nbody = \"ground\"\ndiameter = 1\nmass = 1\n")
            .find("the ground has no mass") != std::string::npos);
  const std::string two =
      "[[shape]]\nname = \"s\"\nbody = \"part\"\ndiameter = 1\nmass = 1\n[[shape]]\nname = \"t\"\nbody = \"part\"\ndiameter = 1\n";
  CHECK(refusal(k_body + two)
            .find("shape 't': needs 'mass', 'area_density' or 'density' with 'thickness', as every shape of a body that has several") !=
        std::string::npos);
}

// [[drawing]]: outlines from DXF drawings, their units, and drawings that are refused with their line.
#include "mbd/io/dxf.h"
#include "mbd/io/reader.h"
#include "transformer/catalog.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

using namespace steplap;

namespace {

const std::string k_file = STEPLAP_TEST_DATA "/drawings/unit.dxf";

std::string drawing_text() {
  std::ifstream file(k_file);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string model_text(const std::string& fields, const std::string& body = "") {
  return "[[body]]\nname = \"tank\"\nmass = 1\ninertia = 1\n" + body + "[[drawing]]\nname = \"d\"\nbody = \"tank\"\nfile = \"" + k_file +
         "\"\n" + fields;
}

std::vector<Vec2> outline_of(const std::string& fields) {
  return parse_model(model_text(fields), "m.toml", transformer_catalog()).bodies.front().outline;
}

template <class Read> std::string refusal(const Read& read) {
  try {
    (void)read();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

} // namespace

// Multiplying by 0.001 and subtracting rounds twice: 1e-15 of 5 m.
TEST_CASE("both kinds of closed polylines are outlines in metres, from the origin that the model states") {
  const std::vector<Vec2> tank = outline_of("layer = \"TANK\"\norigin = [\"3 m\", \"500 mm\"]\n");
  const std::vector<Vec2> expected = {{-2.0, 0.0}, {2.0, 0.0}, {2.0, 3.0}, {-2.0, 3.0}};
  REQUIRE(tank.size() == expected.size());
  for (std::size_t i = 0; i < tank.size(); ++i) CHECK((tank[i] - expected[i]).norm() < 1e-14);
  const std::vector<Vec2> beam = outline_of("layer = \"BEAM\"\n");
  REQUIRE(beam.size() == 4);
  CHECK(beam[2] == Vec2(2.5, 0.2));
  CHECK(outline_of("layer = \"RETURNS\"\n").size() == 3); // its last corner is its first
}

TEST_CASE("the unit is that of the drawing, or that of the model where the drawing states none") {
  const Location where{"m.toml", 1, 1};
  const auto width = [&](const std::string& text, const std::string& unit) {
    return parse_dxf_outline(text, "d.dxf", "BEAM", unit, where)[1].x();
  };
  const std::string stated = "$INSUNITS\n 70\n4\n", text = drawing_text();
  CHECK(width(text, "") == 2.5);
  CHECK(width(text, "mm") == 2.5);
  CHECK(width(replaced(text, stated, "$INSUNITS\n 70\n6\n"), "") == 2500.0);
  CHECK(width(replaced(text, stated, "$INSUNITS\n 70\n1\n"), "") == doctest::Approx(63.5).epsilon(1e-15));
  const std::string none = replaced(text, stated, "$INSUNITS\n 70\n0\n");
  CHECK(width(none, "cm") == 25.0);
  CHECK(has(refusal([&] { return width(none, ""); }), "does not state its unit"));
  CHECK(has(refusal([&] { return width(text, "m"); }), "'unit' is m, and 'd.dxf' is in mm"));
  std::string windows; // with line ends of another system
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(width(windows, "") == 2.5);
}

TEST_CASE("drawings that are no outline are refused, with one error and the line of the drawing") {
  struct Wrong {
    std::string layer, message;
  };
  const Wrong all[] = {
      {"OPEN", "an open LWPOLYLINE"},
      {"ROUND", "with arcs"},
      {"TWO", "has a POLYLINE on layer 'TWO', after another in line"},
      {"FLAT", "of 2 corners"},
      {"SPACE", "not drawn in the plane"},
      {"MIXED", "has a CIRCLE on layer 'MIXED'"},
      {"TANC", "did you mean 'TANK'"},
  };
  const std::string text = drawing_text();
  for (const Wrong& wrong : all) {
    CAPTURE(wrong.layer);
    const std::string message = refusal([&] { return outline_of("layer = \"" + wrong.layer + "\"\n"); });
    CAPTURE(message);
    CHECK(has(message, wrong.message));
    CHECK(!has(message, "\n"));
    if (wrong.layer != "TANC") CHECK(has(message, "unit.dxf:"));
  }
  const Location where{"m.toml", 7, 1};
  const auto read = [&](const std::string& drawing) {
    return refusal([&] { return parse_dxf_outline(drawing, "d.dxf", "TANK", "", where); });
  };
  CHECK(has(read("AutoCAD Binary DXF\r\n\x1a"), "binary"));
  CHECK(has(read("a picture\n"), "d.dxf:1:1: error: the drawing has 'a picture' where a group code"));
  CHECK(has(read(""), "m.toml:7:1"));
  CHECK(has(read(text.substr(0, text.find("  0\nSECTION\n  2\nENTITIES"))), "no section ENTITIES"));
  CHECK(has(read(replaced(text, "5.0E3", "wide")), "'wide' where a number is expected"));
  CHECK(has(read(replaced(text, "$INSUNITS\n 70\n4\n", "$INSUNITS\n 70\n1e300\n")), "'1e300' where a whole number is expected"));
  const std::string begin = "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nTANK\n70\n1\n10\n0\n20\n0\n10\n1\n20\n0\n10\n1\n",
                    end = "0\nENDSEC\n0\nEOF\n", unit = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n";
  CHECK(read(unit + begin + "20\n1\n" + end) == "");
  CHECK(has(read(unit + begin + end), "a corner that lacks a coordinate"));
  CHECK(has(refusal([] {
              return parse_model(model_text("layer = \"TANK\"\n", "outline = [[0, 0], [1, 0], [0, 1]]\n"), "m.toml", transformer_catalog());
            }),
            "has an outline already"));
  CHECK(has(refusal([] { return outline_of("layer = \"TANK\"\nsha256 = \"0\"\n"); }), "is not the one that was meant"));
}

TEST_CASE("a file may give its outlines in millimetres, and only plain numbers are meant") {
  const std::string body = "[[body]]\nname = \"tank\"\nmass = 1\ninertia = 1\noutline = [[0, 0], [2500, 0.0], [\"2.5 m\", 200.0]]\n";
  const auto read = [&](const std::string& unit) {
    return parse_model(unit + body, "m.toml", transformer_catalog()).bodies.front().outline;
  };
  CHECK(read("outline_unit = \"mm\"\n") == std::vector<Vec2>{{0.0, 0.0}, {2.5, 0.0}, {2.5, 0.2}});
  CHECK(read("")[1].x() == 2500.0);
  for (const char* unit : {"\"kg\"", "\"\"", "3", "\"of mine\""})
    CHECK(has(refusal([&] { return read("outline_unit = " + std::string(unit) + "\n"); }),
              "m.toml:1:16: error: 'outline_unit' must be a unit of length"));
}

// A plate with a round hole and a square one, and a disc with a hole, once in millimetres and once in metres.
TEST_CASE("all plain lengths of a shape are in the unit of the outlines") {
  const auto read = [](const std::string& head, const std::string& plate, const std::string& disc) {
    return parse_model(head + "[[body]]\nname = \"a\"\n[[shape]]\nname = \"plate\"\nbody = \"a\"\ndensity = 3.0\n" + plate +
                           "[[shape]]\nname = \"disc\"\nbody = \"a\"\narea_density = 2.0\n" + disc,
                       "m.toml", transformer_catalog())
        .bodies.front();
  };
  const Body small = read("outline_unit = \"mm\"\n",
                          "outline = [[0, 0], [2000, 0], [2000, 1000], [0, 1000]]\nholes = [[[1500, 500], [1600, 500], [1600, 600], [1500, "
                          "600]]]\nhole_centres = [[500, 500]]\nhole_diameters = [400]\nthickness = 10\n",
                          "centre = [3000, 0]\ndiameter = 600\nhole_centres = [[3000, 0]]\nhole_diameters = [\"0.2 m\"]\n"),
             large = read("",
                          "outline = [[0, 0], [2, 0], [2, 1], [0, 1]]\nholes = [[[1.5, 0.5], [1.6, 0.5], [1.6, 0.6], [1.5, "
                          "0.6]]]\nhole_centres = [[0.5, 0.5]]\nhole_diameters = [0.4]\nthickness = 0.01\n",
                          "centre = [3, 0]\ndiameter = 0.6\nhole_centres = [[3, 0]]\nhole_diameters = [0.2]\n");
  constexpr double k_rounding = 1e-13; // of lengths times 0.001, in areas and second moments
  const double pi = std::numbers::pi;
  CHECK(small.mass == doctest::Approx(0.03 * (2.0 - 0.01 - pi * 0.04) + 2.0 * pi * (0.09 - 0.01)).epsilon(k_rounding));
  CHECK(small.mass == doctest::Approx(large.mass).epsilon(k_rounding));
  CHECK(small.inertia == doctest::Approx(large.inertia).epsilon(k_rounding));
  CHECK((small.cg - large.cg).norm() < k_rounding * 3.0);
}

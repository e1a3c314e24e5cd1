// Elastic beams from rigid segments: closed forms of deflections, frequencies and buckling, with the order of what n segments leave.
#include "elements/machinery/section.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/rest/modes.h"
#include "mbd/system/instance.h"
#include "tests/physics/rest_scene.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

using namespace steplap;
using namespace steplap::testing;

namespace {

// A slender one, so that neither the inertia of its cross section nor its stretch is seen: I/(A L²) = 1e-9.
constexpr double k_length = 4.0, k_bending = 2e4, k_area = 1e-2, k_per_length = 8.0;
constexpr double k_second_moment = 1.6e-10;

std::string beam(int n, const std::string& more = "") {
  return "[[beam]]\nname = \"beam\"\nfrom = [0.0, 0.0]\nto = [4.0, 0.0]\nsegments = " + std::to_string(n) +
         "\nmodulus = " + number(k_bending / k_second_moment) + "\nsecond_moment = " + number(k_second_moment) +
         "\narea = " + number(k_area) + "\nmass_per_length = 8.0\n" + more;
}
const std::string k_clamp = element("weld", "clamp", "a = 'beam.start'; b = { body = 'ground', at = [0.0, 0.0] }");
const std::string k_pins =
    element("revolute", "pin", "a = 'beam.start'; b = { body = 'ground', at = [0.0, 0.0] }") +
    element("point_on_line", "roller", "a = 'beam.end'; b = { body = 'ground', at = [4.0, 0.0] }; axis = [1.0, 0.0]");

Found rest_of(const std::string& text) { return settle(scene(text + k_head)); }

struct Tip {
  double x, y, angle;
};
// Of its end marker, from the end of the straight beam.
Tip tip_of(const Found& found, int n) {
  const int body = n + 1; // the ground is the first
  const double h = k_length / n, angle = found.q(body, 2);
  return {found.q(body, 0) + 0.25 * h * std::cos(angle) - k_length, found.q(body, 1) + 0.25 * h * std::sin(angle), angle};
}

std::vector<double> frequencies(const std::string& text, int count) {
  const auto system = compile(scene(k_no_gravity + text + k_head));
  const VibrationModes found = vibration_modes(*system, system->initial_state());
  std::vector<double> omega;
  for (int i = 0; i < count; ++i) omega.push_back(2.0 * k_pi * found.modes[static_cast<std::size_t>(i)].natural_frequency());
  return omega;
}

} // namespace

TEST_CASE("masses and moments of inertia of the segments add up to the beam's") {
  for (const int n : {1, 2, 7, 40}) {
    CAPTURE(n);
    const Model model = scene(k_head + "[[beam]]\nname = \"beam\"\nfrom = [1.0, 2.0]\nto = [-2.0, 6.0]\nsegments = " + std::to_string(n) +
                              "\nmaterial = \"steel\"\nwidth = 0.1\nheight = 0.3\n" +
                              element("weld", "clamp", "a = 'beam.start'; b = { body = 'ground', at = [1.0, 2.0] }"));
    const double mass = 7850.0 * 0.03 * 5.0, inertia = mass * 25.0 / 12.0 + 7850.0 * 0.1 * 0.027 / 12.0 * 5.0;
    REQUIRE(model.bodies.size() == static_cast<std::size_t>(n) + 1);
    double sum = 0.0, about = 0.0;
    Vec2 moment = Vec2::Zero();
    for (const Body& body : model.bodies) {
      const Vec3 pose = body.reference_pose();
      sum += body.mass;
      moment += body.mass * pose.head<2>();
      about += body.inertia + body.mass * (pose.head<2>() - Vec2(-0.5, 4.0)).squaredNorm();
    }
    // Sums of n numbers, of places of some metres.
    CHECK(sum == doctest::Approx(mass).epsilon(1e-14));
    CHECK((moment / mass - Vec2(-0.5, 4.0)).norm() < 1e-13);
    CHECK(about == doctest::Approx(inertia).epsilon(1e-13));
  }
}

TEST_CASE("a cantilever under a force or a couple at its end bends as the elastic line does, whatever the number of segments") {
  // Small: 2e-5 of its length, so that what large deflections change is below 1e-9 of it, and places known to 1e-15 m show 1e-11.
  const double force = 0.1, couple = 0.1;
  for (const int n : {1, 2, 5, 16}) {
    CAPTURE(n);
    const Tip by_force =
        tip_of(rest_of(k_no_gravity + beam(n) + k_clamp + element("load", "pull", "at = 'beam.end'; force = [0.0, 0.1]")), n);
    CHECK(by_force.y == doctest::Approx(force * std::pow(k_length, 3) / (3.0 * k_bending)).epsilon(1e-7));
    CHECK(by_force.angle == doctest::Approx(force * k_length * k_length / (2.0 * k_bending)).epsilon(1e-7));
    const Tip by_couple = tip_of(rest_of(k_no_gravity + beam(n) + k_clamp + element("load", "turn", "at = 'beam.end'; couple = 0.1")), n);
    CHECK(by_couple.y == doctest::Approx(couple * k_length * k_length / (2.0 * k_bending)).epsilon(1e-7));
    CHECK(by_couple.angle == doctest::Approx(couple * k_length / k_bending).epsilon(1e-7));
  }
}

TEST_CASE("shear adds P L over its stiffness, and a pull stretches by P L/(E A)") {
  const Tip sheared = tip_of(
      rest_of(k_no_gravity + beam(5, "shear_stiffness = 3e4\n") + k_clamp + element("load", "pull", "at = 'beam.end'; force = [0.0, 0.1]")),
      5);
  CHECK(sheared.y == doctest::Approx(0.1 * std::pow(k_length, 3) / (3.0 * k_bending) + 0.1 * k_length / 3e4).epsilon(1e-7));
  const double stretch = 1e6 * k_length / (k_bending / k_second_moment * k_area);
  const Tip pulled = tip_of(rest_of(k_no_gravity + beam(5) + k_clamp + element("load", "pull", "at = 'beam.end'; force = [1e6, 0.0]")), 5);
  CHECK(pulled.x == doctest::Approx(stretch).epsilon(1e-6)); // 3e-6 m of places known to 1e-12 m
}

TEST_CASE("a pinned beam sags under its weight by 5 w L^4/(384 E I), with an error of 2/(5 n²)") {
  // What half a segment weighs over a support turns it by w h²/8 instead of w h²/12, which lifts nothing but sags the middle by w h² L²/(192 E I).
  const double sag = 5.0 * k_per_length * k_g * std::pow(k_length, 4) / (384.0 * k_bending);
  for (const int n : {4, 8, 16, 32}) {
    CAPTURE(n);
    const Found found = rest_of("gravity = [0.0, -0.00981]\n" + beam(n) + k_pins); // a thousandth: nothing large
    const double middle = -1000.0 * found.q(n / 2 + 1, 1);
    CHECK(middle == doctest::Approx(sag * (1.0 + 0.4 / (n * n))).epsilon(1e-6));
  }
}

TEST_CASE("frequencies come down on those of the elastic line with the square of the segments' length") {
  const double unit = std::sqrt(k_bending / k_per_length) / (k_length * k_length);
  const std::array<double, 3> roots = {1.875104068711961, 4.694091132974175, 7.854757438237613};
  std::array<std::array<double, 3>, 2> before{};
  for (const int n : {8, 16, 32}) {
    CAPTURE(n);
    const std::vector<double> pinned = frequencies(beam(n) + k_pins, 3), clamped = frequencies(beam(n) + k_clamp, 3);
    for (std::size_t j = 0; j < 3; ++j) {
      CAPTURE(j);
      const double k = (static_cast<double>(j) + 1.0) * k_pi;
      const std::array<double, 2> off = {pinned[j] / (k * k * unit) - 1.0, clamped[j] / (roots[j] * roots[j] * unit) - 1.0};
      // The segments' own inertia counts once more in what turns: (k/n)²/24, to its square.
      CHECK(off[0] == doctest::Approx(-k * k / (24.0 * n * n)).epsilon(0.6 * k * k / (n * n) + 1e-3));
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(std::abs(off[i]) < 0.1);
        if (n > 8) CHECK(before[i][j] / off[i] == doctest::Approx(4.0).epsilon(0.15));
        before[i][j] = off[i];
      }
    }
  }
}

TEST_CASE("a force along it lowers its frequency and would buckle it at Euler's load") {
  const double euler = k_pi * k_pi * k_bending / (k_length * k_length);
  double before = 0.0;
  for (const int n : {4, 8, 16}) {
    CAPTURE(n);
    const std::string load = element("load", "press", "at = 'beam.end'; force = [" + number(-0.5 * euler) + ", 0.0]");
    const auto system = compile(scene(k_no_gravity + beam(n) + k_pins + load + k_head));
    const VibrationModes pressed = vibration_modes(*system, find_equilibrium(*system, system->initial_state()).state);
    const double free = frequencies(beam(n) + k_pins, 1).front(), under = 2.0 * k_pi * pressed.modes.front().natural_frequency();
    const double off = 0.5 * euler / (1.0 - under * under / (free * free)) / euler - 1.0; // ω² falls in a line with the force
    CHECK(std::abs(off) < 2.0 / std::pow(n, 4));
    if (n > 4) CHECK(before / off == doctest::Approx(16.0).epsilon(0.2)); // the order h⁴
    before = off;
  }
}

TEST_CASE("a couple bends it into an arc: each part turns by M h/(E I), however far") {
  const int n = 12;
  const double turn = 0.5 * k_pi / n, couple = turn * k_bending * n / k_length, h = k_length / n;
  const Tip tip =
      tip_of(rest_of(k_no_gravity + beam(n) + k_clamp + element("load", "turn", "at = 'beam.end'; couple = " + number(couple))), n);
  const double chord =
      h * (std::cos(0.5 * turn) + turn * turn / 12.0); // what the part stretches by in its middle, so that the bent line does not
  Vec2 node(-k_length, 0.0);
  for (int i = 0; i < n; ++i) node += chord * Vec2(std::cos((i + 0.5) * turn), std::sin((i + 0.5) * turn));
  CHECK(tip.angle == doctest::Approx(0.5 * k_pi).epsilon(1e-9));
  CHECK(std::abs(tip.x - node.x()) < 1e-8);
  CHECK(std::abs(tip.y - node.y()) < 1e-8);
  CHECK(tip.y ==
        doctest::Approx(2.0 * k_length / k_pi).epsilon(std::pow(turn, 4) / 400.0)); // the arc's radius: chords are off by turn⁴/480
}

TEST_CASE("a pull stiffens it as it stiffens the elastic line, also far beyond what its parts hold across") {
  // E I y'''' = N y'': under N and a force Q at its end a cantilever gives by Q/N (L - tanh(k L)/k), k² = N/(E I).
  for (const double pull : {1e3, 1e5}) {
    CAPTURE(pull);
    double before = 0.0;
    for (const int n : {5, 10, 20, 40}) {
      CAPTURE(n);
      const Tip tip = tip_of(
          rest_of(k_no_gravity + beam(n) + k_clamp + element("load", "pull", "at = 'beam.end'; force = [" + number(pull) + ", 0.1]")), n);
      const double k = std::sqrt(pull / k_bending), expected = 0.1 / pull * (k_length - std::tanh(k * k_length) / k),
                   off = std::abs(tip.y / expected - 1.0);
      CHECK(off < 2e-3 * std::pow(k * k_length / n, 4) + 1e-6); // the order h⁴, above what rest is found to
      if (pull == 1e5 && n > 5) CHECK(before / off > 10.0);
      before = off;
    }
  }
  // Without the squares in q its parts would slide across each other from k_v h = 12 E I/h² on, 3.75e5 N here.
  const Tip taut = tip_of(rest_of(k_no_gravity + beam(5) + k_clamp + element("load", "pull", "at = 'beam.end'; force = [2e6, 0.0]")), 5);
  CHECK(std::abs(taut.y) < 1e-9);
}

TEST_CASE("damping: a mode has the ratio that is asked for at its frequency, others in proportion to theirs") {
  const double first = frequencies(beam(10) + k_clamp, 1).front();
  const std::string damped = beam(10, "damping_ratio = 0.02\ndamping_frequency = " + number(first / (2.0 * k_pi)) + "\n") + k_clamp;
  const auto system = compile(scene(k_no_gravity + damped + k_head));
  const VibrationModes found = vibration_modes(*system, system->initial_state());
  for (int i = 0; i < 3; ++i) {
    const VibrationMode& mode = found.modes[static_cast<std::size_t>(i)];
    CHECK(mode.damping_ratio() == doctest::Approx(0.02 * 2.0 * k_pi * mode.natural_frequency() / first).epsilon(1e-6));
  }
  const auto same = compile(scene(k_no_gravity + beam(10, "damping_time = " + number(2.0 * 0.02 / first) + "\n") + k_clamp + k_head));
  const VibrationModes by_time = vibration_modes(*same, same->initial_state());
  CHECK(by_time.modes.front().damping_ratio() == doctest::Approx(found.modes.front().damping_ratio()).epsilon(1e-9));
}

TEST_CASE("other values of a beam are those of a model that was written with them") {
  const auto text = [&](const char* span, const char* thick) {
    return k_head + "[parameters]\nspan = \"" + span + "\"\nthick = \"" + thick + "\"\n" +
           "[[beam]]\nname = \"beam\"\nfrom = [0.0, 0.0]\nto = [\"= span\", 0.0]\nmaterial = \"steel\"\nwidth = 0.1\nheight = \"= "
           "thick\"\nsegments = 6\n" +
           k_clamp;
  };
  const Model given = parse_given_model(text("4 m", "0.2 m"), "scene.toml", transformer_catalog());
  Variants variants(given, {"parameters.span", "parameters.thick"});
  const auto varied = variants.make({5.0, 0.3});
  const auto written = compile(scene(text("5 m", "0.3 m")));
  REQUIRE(varied->bodies.size() == written->bodies.size());
  for (std::size_t i = 0; i < varied->bodies.size(); ++i) {
    CHECK(varied->bodies[i].mass == written->bodies[i].mass);
    CHECK(varied->bodies[i].inertia == written->bodies[i].inertia);
  }
  CHECK(varied->initial_state().q == written->initial_state().q);
}

TEST_CASE("a beam in a part lies where the part lies, and is made of the same") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "steplap_beam_part";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "jib.toml")
      << k_head
      << "[[beam]]\nname = \"arm\"\nfrom = [0.0, 0.0]\nto = [2.0, 0.0]\nsegments = 4\nmaterial = \"steel\"\nwidth = 0.1\nheight = 0.2\n"
      << element("weld", "clamp", "a = 'arm.start'");
  std::ofstream(folder / "crane.toml") << k_head << "[[part]]\nname = \"jib\"\nfile = \"jib.toml\"\nx = 1.0\ny = 3.0\nangle = \"90 deg\"\n";
  const Model alone = read_model((folder / "jib.toml").string(), transformer_catalog()),
              part = read_model((folder / "crane.toml").string(), transformer_catalog());
  REQUIRE(part.bodies.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(part.bodies[i].name == "jib." + alone.bodies[i].name);
    CHECK(part.bodies[i].mass == doctest::Approx(alone.bodies[i].mass).epsilon(1e-14));
    CHECK(part.bodies[i].inertia == doctest::Approx(alone.bodies[i].inertia).epsilon(1e-14));
    const Vec3 here = part.bodies[i].reference_pose(), there = alone.bodies[i].reference_pose();
    CHECK((here - Vec3(1.0 - there.y(), 3.0 + there.x(), there.z() + 0.5 * k_pi)).norm() < 1e-14);
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("rolled sections have the values of the tables of EN 10365") {
  // cm², cm⁴ as printed, with three and four digits.
  const std::vector<std::array<double, 2>> printed = {
      {7.64, 80.1}, {10.3, 171},  {13.2, 318},   {16.4, 541},   {20.1, 869},   {23.9, 1317},  {28.5, 1943}, {33.4, 2772}, {39.1, 3892},
      {45.9, 5790}, {53.8, 8356}, {62.6, 11770}, {72.7, 16270}, {84.5, 23130}, {98.8, 33740}, {116, 48200}, {134, 67120}, {156, 92080}};
  const std::vector<std::string> names = profile_names();
  REQUIRE(names.size() == printed.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    CAPTURE(names[i]);
    const SectionValues found = profile_section(names[i]).value();
    CHECK(1e4 * found.area == doctest::Approx(printed[i][0]).epsilon(0.005));
    CHECK(1e8 * found.second_moment == doctest::Approx(printed[i][1]).epsilon(0.001));
  }
  CHECK(tubular_section(0.2, 0.1).second_moment == doctest::Approx(k_pi / 64.0 * std::pow(0.2, 4)).epsilon(1e-14)); // solid
  CHECK_FALSE(profile_section("IPE 310").has_value());
}

TEST_CASE("what is wrong with a beam is told where it stands") {
  const auto complaint = [](const std::string& fields) {
    try {
      (void)scene(k_head + "[[beam]]\nname = \"beam\"\nfrom = [0.0, 0.0]\n" + fields + element("weld", "clamp", "a = 'beam.start'"));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::string steel = "material = \"steel\"\n", shape = "width = 0.1\nheight = 0.2\n", to = "to = [1.0, 0.0]\n";
  CHECK(complaint(to + steel + shape) == "nothing");
  const auto says = [&](const std::string& fields, const std::string& part) {
    const std::string text = complaint(fields);
    CHECK_MESSAGE(text.find(part) != std::string::npos, text);
  };
  says("to = [0.0, 0.0]\n" + steel + shape, "scene.toml:6:6: error: beam 'beam': 'from' and 'to' are one place");
  says(to + steel, "give its cross section once");
  says(to + steel + shape + "diameter = 0.1\nwall = 0.01\n", "give its cross section once");
  says(to + steel + "height = 0.1\n", "give both 'width' and 'height'");
  says(to + steel + "area = 0.1\n", "give both 'area' and 'second_moment'");
  says(to + steel + "profile = \"IPE 310\"\n", "did you mean 'IPE 3");
  says(to + steel + "diameter = 0.1\nwall = 0.06\n", "at most half of 'diameter'");
  says(to + shape, "give either its 'material' or its 'modulus'");
  says(to + shape + steel + "modulus = 1e9\n", "give either its 'material' or its 'modulus'");
  says(to + shape + "modulus = 1e9\n", "give its 'density' or its 'mass_per_length'");
  says(to + shape + steel + "damping_ratio = 0.1\n", "give both 'damping_ratio' and 'damping_frequency'");
  says(to + shape + steel + "segments = 0\n", "segments");
  says(to + shape + steel + "segments = 1000000\n", "segments");
  says(to + shape + "material = \"stone\"\n", "material");
}

// Clamping pressures that vary over a corner, through the stack and in time: what holds, and when it slips.
#include "elements/step_lap/step_lap_friction.h"
#include "tests/elements/step_lap/step_lap_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace step_lap_scene;
using steplap::Vec2;
using steplap::Vec3;

namespace {

constexpr double k_capacity = 400.0; // N: 0.02 m² · 1e5 Pa · 0.2

const std::vector<Vec2> k_yoke = rectangle(-1, -1, 1, 1), k_limb = rectangle(-0.1, -0.05, 0.1, 0.05);

std::string scene(const std::string& simulation, double output_step, const std::string& joint_fields, const std::string& interface_fields,
                  const std::string& more, const Vec2& at = Vec2::Zero()) {
  return header(simulation, output_step) + body("limb", 10.0, 1.0, at) + joint("limb", "ground", joint_fields) +
         interface(k_yoke, k_limb, 1e5, 0.2, interface_fields) + more;
}

std::string pull(double force) {
  return "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"limb\"\nforce = [" + number(force) + ", 0.0]\n";
}

/// Falls from 1 to 0 in 10 s, straight.
const std::string k_fading = "[[signal]]\nname = \"fading\"\nkind = \"trapezoid\"\npeak = 1.0\nstart = -10.0\nrise = "
                             "5.0\nfall = 10.0\nduration = 20.0\n";

std::string tilting(double peak, double end) { // grows evenly
  return "[[signal]]\nname = \"across\"\nkind = \"triangle\"\npeak = " + number(peak) + "\nduration = " + number(2.0 * end) + "\n";
}

} // namespace

TEST_CASE("a joint whose pressure fades slips when what is left is just enough, at every stiffness") {
  // 250 N of 400 N: at a factor of 0.625, t = 3.75 s.
  for (const char* joint_fields : {"pressure_signal = \"fading\"", "pressure_signal = \"fading\"\ntangential_stiffness = 1e7"})
    for (const char* integrator : {"dop853", "rodas5p"}) {
      CAPTURE(joint_fields);
      CAPTURE(integrator);
      const bool is_elastic = std::string(joint_fields).find("tangential") != std::string::npos;
      // From rest: a load that is there at once makes the elastic joint swing about its strain, by as much again.
      const std::string load = "[[signal]]\nname = \"load\"\nkind = \"trapezoid\"\npeak = 250.0\nrise = 2.0\nfall = 1.0\nduration = 20.0\n"
                               "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"limb\"\nforce_x = \"load\"\n";
      const Run r = run_text(
          scene(std::string("end = 3.9\nintegrator = \"") + integrator + "\"\ntolerance = 1e-9", 3.9, joint_fields, "", k_fading + load));
      REQUIRE(r.times("joint", "slips").size() >= 1);
      // The elastic one still swings by Ṗ/ω of its load, 125/1000 N: 0.5 ms of fading at 40 N/s, three times that here.
      CHECK(std::abs(r.times("joint", "slips")[0] - 3.75) < (is_elastic ? 1e-2 : 1e-9));
      if (!is_elastic) CHECK(r.last("joint.fx") == doctest::Approx(-k_capacity * 0.61).epsilon(1e-9)); // slides with the present pressure
      CHECK(r.last("joint.pressure") == doctest::Approx(0.61e5).epsilon(1e-9));
      CHECK(r.relative_energy_residual() < 1e-7);
    }
}

TEST_CASE("margin and required pressure follow the present pressure, and what relaxation has left") {
  const Run r = run_text(
      scene("end = 2.0\nintegrator = \"dop853\"", 1.0, "pressure_signal = \"fading\"\npressure_loss = 0.1", "", k_fading + pull(100.0)));
  const auto margin = r.series("joint.margin"), need = r.series("joint.p_req"), pressure = r.series("joint.pressure");
  for (std::size_t i = 0; i < margin.size(); ++i) {
    const double factor = 0.9 * (1.0 - 0.1 * static_cast<double>(i));
    CHECK(margin[i] == doctest::Approx(4.0 * factor).epsilon(1e-12));
    CHECK(need[i] == doctest::Approx(0.25e5).epsilon(1e-12)); // what it takes does not change with what there is
    CHECK(pressure[i] == doctest::Approx(1e5 * factor).epsilon(1e-12));
  }
}

// Outlines that have been made are kept for the next scene: for one with the same corners, and no other.
TEST_CASE("scenes compiled one after the other have the sheets of their own corners and cutouts") {
  const auto margin = [](double half_width, const std::string& more) {
    const std::vector<Vec2> limb = rectangle(-half_width, -0.05, half_width, 0.05);
    return run_text(header("end = 1e-3\nintegrator = \"dop853\"\ntolerance = 1e-6", 1e-3) + body("limb", 10.0, 1.0, Vec2::Zero()) +
                    joint("limb", "ground") + interface(k_yoke, limb, 1e5, 0.2, more) + pull(100.0))
        .last("joint.margin");
  };
  const std::string cutout = "limb_cutouts = [" + points(rectangle(-0.01, -0.01, 0.01, 0.01)) + "]";
  // Area times pressure and friction, over the load; an integral over polygons, to rounding.
  const auto expected = [](double half_width, double lost) { return (0.2 * half_width - lost) * 1e5 * 0.2 / 100.0; };
  CHECK(margin(0.1, "") == doctest::Approx(expected(0.1, 0.0)).epsilon(1e-11));
  CHECK(margin(0.1, cutout) == doctest::Approx(expected(0.1, 4e-4)).epsilon(1e-11));
  CHECK(margin(0.1, "") == doctest::Approx(expected(0.1, 0.0)).epsilon(1e-11));
  for (int i = 0; i < 70; ++i) CHECK(margin(0.1 + 1e-3 * i, "") == doctest::Approx(expected(0.1 + 1e-3 * i, 0.0)).epsilon(1e-11));
  CHECK(margin(0.1, cutout) == doctest::Approx(expected(0.1, 4e-4)).epsilon(1e-11));
}

TEST_CASE("a pressure that grows along the joint shifts its centre: capacities are integrals of the field") {
  // p = 1e5 (1 + 8 x) over ±0.1 m: a force through the centroid of the pressure meets all of it. x̄ = 8 · 0.2²/12.
  const auto system =
      steplap::compile(steplap::parse_model(scene("end = 1.0\nintegrator = \"auto\"", 1.0, "", "pressure_gradient = [8e5, 0.0]", ""),
                                            "scene.toml", steplap::transformer_catalog()));
  const auto& friction = dynamic_cast<const steplap::StepLapFriction&>(*system->frictions[0].friction);
  const steplap::Patch patch = friction.patch_at({0, 0, 0}, steplap::GripLaw::holding);
  const double shift = 8.0 * 0.04 / 12.0;
  CHECK(patch.force() == doctest::Approx(k_capacity).epsilon(1e-12));
  CHECK(patch.centroid().x() == doctest::Approx(shift).epsilon(1e-12));
  CHECK(steplap::required_pressure(patch, {0.0, 100.0, 100.0 * shift}).u == doctest::Approx(0.25).epsilon(1e-12));
  // Turning about a place outside: the sum over 400 × 400 places.
  const Vec3 turn(-0.2, 0.3, 1.0);
  double h = 0.0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = -0.1 + 0.2 * (i + 0.5) / n, y = -0.05 + 0.1 * (j + 0.5) / n;
      h += 0.2 * 1e5 * (1.0 + 8.0 * x) * std::hypot(turn[0] - y, turn[1] + x) * 0.02 / (n * n);
    }
  CHECK(steplap::evaluate(patch, turn).h == doctest::Approx(h).epsilon(1e-6)); // the sum's own error
}

TEST_CASE("a linear pressure stays where it is in the yoke while the limb slides through it") {
  const auto system =
      steplap::compile(steplap::parse_model(scene("end = 1.0\nintegrator = \"auto\"", 1.0, "", "pressure_gradient = [5e5, 0.0]", ""),
                                            "scene.toml", steplap::transformer_catalog()));
  const auto& friction = dynamic_cast<const steplap::StepLapFriction&>(*system->frictions[0].friction);
  CHECK(friction.patch_at({0.02, 0.0, 0.0}, steplap::GripLaw::holding).force() == doctest::Approx(k_capacity * 1.1).epsilon(1e-12));
}

TEST_CASE("acceleration across the stack: one packet gains what another loses") {
  // Two packets of half the interfaces, ± 2000 Pa per m/s² (a half stack of 0.26 m of steel): as a whole nothing
  // changes, until one of them is loose, at 1e5/2000 = 50 m/s². One packet alone slips at 400 (1 − a/50) = 250 N: a
  // = 18.75 m/s².
  const std::string other = interface(k_yoke, k_limb, 1e5, 0.2, "count = 0.5\ntransverse_pressure = -2000.0", "far packet");
  const std::string joint_fields = "transverse_acceleration = \"across\"";
  const Run both = run_text(scene("end = 10.0\nintegrator = \"dop853\"", 5.0, joint_fields, "count = 0.5\ntransverse_pressure = 2000.0",
                                  other + tilting(40.0, 10.0) + pull(250.0)));
  for (const double margin : both.series("joint.margin")) CHECK(margin == doctest::Approx(1.6).epsilon(1e-12));
  const Run one = run_text(scene("end = 10.0\nintegrator = \"dop853\"\ntolerance = 1e-9", 10.0, joint_fields,
                                 "transverse_pressure = -2000.0", tilting(40.0, 10.0) + pull(250.0)));
  REQUIRE(one.times("joint", "slips").size() >= 1);
  CHECK(std::abs(one.times("joint", "slips")[0] - 18.75 / 4.0) < 1e-9);
}

// 1e5 Pa at the middle, 5e5 Pa/m along 0.2 m: 5e4 Pa at the weak edge, of which 2000 Pa for each m/s² go. The middle has half of its pressure
// when the edge has none.
TEST_CASE("the weak edge of a pressure with a gradient loses as much as the middle by acceleration across the stack") {
  const Run r = run_text(scene("end = 10.0\nintegrator = \"dop853\"", 2.5, "transverse_acceleration = \"across\"",
                               "pressure_gradient = [5e5, 0.0]\ntransverse_pressure = -2000.0", tilting(40.0, 10.0)));
  const std::vector<double> least = r.series("joint.least_pressure"), middle = r.series("joint.pressure");
  for (std::size_t i = 0; i < least.size(); ++i) {
    const double lost = 2000.0 * 10.0 * static_cast<double>(i);
    CHECK(least[i] == doctest::Approx(std::max(0.0, 5e4 - lost)).epsilon(1e-12));
    CHECK(middle[i] == doctest::Approx(1e5 - lost).epsilon(1e-12));
  }
}

TEST_CASE("an elastic joint that yields under a turning load follows fading and tilting pressures on the surface") {
  const std::string more = k_fading + tilting(20.0, 1.0) +
                           interface(k_yoke, k_limb, 0.5e5, 0.2, "transverse_pressure = -1500.0", "far packet") +
                           "[[signal]]\nname = \"along\"\nkind = \"harmonics\"\namplitudes = [1e-3]\nfrequencies = "
                           "[1.0]\nphases = [-1.5707963267948966]\n"
                           "[[signal]]\nname = \"turn\"\nkind = \"harmonics\"\namplitudes = [8e-3]\nfrequencies = "
                           "[0.7]\nphases = [-1.5707963267948966]\n"
                           "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive x\"\na = \"limb\"\ncoordinate = "
                           "\"x\"\nsignal = \"along\"\nas = \"position\"\n"
                           "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive turn\"\na = \"limb\"\ncoordinate "
                           "= \"angle\"\nsignal = \"turn\"\nas = \"position\"\n";
  const auto wrench = [&](const std::string& how) {
    const Run r = run_text(scene("end = 0.45\n" + how, 0.05,
                                 "tangential_stiffness = 1e6\npressure_signal = \"fading\"\ntransverse_acceleration = \"across\"",
                                 "transverse_pressure = 3000.0\npressure_gradient = [2e5, 1e5]", more));
    REQUIRE(r.times("joint", "slips").size() >= 1);
    const auto u = r.series("joint.u"), mode = r.series("joint.mode");
    for (std::size_t i = 0; i < u.size(); ++i)
      if (mode[i] == 2.0) CHECK(u[i] == doctest::Approx(1.0).epsilon(1e-7)); // between the steps' ends, where it is settled
    return Vec3(r.last("joint.fx"), r.last("joint.fy"), r.last("joint.m") / 0.06);
  };
  const Vec3 exact = wrench("integrator = \"dop853\"\ntolerance = 1e-12");
  CHECK((wrench("integrator = \"tsit5\"\ntolerance = 1e-10") - exact).norm() < 1e-6 * k_capacity);
  const double coarse = (wrench("integrator = \"rk4\"\nstep = 1e-3") - exact).norm(),
               fine = (wrench("integrator = \"rk4\"\nstep = 2.5e-4") - exact).norm();
  CHECK(fine < coarse / std::pow(4.0, 3.5)); // without ḣ in the flow it would be of the first order
}

TEST_CASE("pressures that jump, are negative somewhere, or end are refused with the reason") {
  const auto refusal = [](const std::string& joint_fields, const std::string& interface_fields, const std::string& more) -> std::string {
    try {
      run_text(scene("end = 15.0\nintegrator = \"auto\"", 1.0, joint_fields, interface_fields, more));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("pressure_signal = \"step\"", "", "[[signal]]\nname = \"step\"\nkind = \"rectangle\"\npeak = 1.0\nduration = 1.0\n")
            .find("jumps at t") != std::string::npos);
  CHECK(refusal("", "pressure_gradient = [2e6, 0.0]", "").find("is negative somewhere") != std::string::npos);
  CHECK(refusal("pressure_signal = \"fading\"", "", k_fading).find("has to stay above zero") != std::string::npos);
  CHECK(refusal("transverse_acceleration = \"fading\"", "", k_fading).find("give its step_lap_interface") != std::string::npos);
}

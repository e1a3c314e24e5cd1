// One sliding joint against exact values: closed forms, Coulomb's block, the disc that slides and spins.
#include "elements/step_lap/step_lap_friction.h"
#include "tests/elements/step_lap/step_lap_scene.h"
#include "tests/sanitized.h"

#include <doctest/doctest.h>

using namespace step_lap_scene;
using steplap::Vec2;

namespace {

// Adaptive, tight: what is left is rounding.
const char* const k_tight = "end = 4.0\nintegrator = \"tsit5\"\ntolerance = 1e-11";

std::string on_ground(const std::vector<Vec2>& sheet, double mass, double inertia, const Vec2& velocity, double spin, double friction_force,
                      double area, const std::string& simulation, double output_step, const std::string& more = "") {
  return header(simulation, output_step) + body("slider", mass, inertia, {0.0, 0.0}, velocity, spin) + joint("slider", "ground") +
         interface(rectangle(-10, -10, 10, 10), sheet, friction_force / area / 0.25, 0.25) + more;
}

// Limit of v/(Rω) as a uniform disc comes to rest; `sides`: of the polygon that stands for it. The limit is
// approached as a power of the time left, so that three times in a geometric row give it (Aitken).
double last_ratio(int sides, double velocity, double spin) {
  const Run r = run_text(on_ground(disc(1.0, sides), 1.0, 0.5, {velocity, 0.0}, spin, 1.0, M_PI,
                                   "end = 1.8\nintegrator = \"tsit5\"\ntolerance = 1e-11", 1e-5));
  const auto stop = r.times("joint", "sticks");
  REQUIRE(stop.size() == 1);
  const auto v = r.series("slider.vx"), w = r.series("slider.omega");
  double ratio[3];
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>((stop[0] - 4e-3 * std::pow(0.1, k)) * 1e5);
    ratio[k] = v[i] / w[i];
  }
  const double first = ratio[1] - ratio[0], second = ratio[2] - ratio[1];
  return ratio[2] - second * second / (second - first);
}

} // namespace

TEST_CASE("slip along x alone is Coulomb's block: path and time of stopping") {
  // a = F/m = 2: stops after v/a = 1.5 s and v²/2a = 2.25 m
  const Run r = run_text(on_ground(rectangle(-0.5, -0.3, 0.5, 0.3), 3.0, 1.0, {3.0, 0.0}, 0.0, 6.0, 0.6, k_tight, 0.25));
  const auto stop = r.times("joint", "sticks");
  REQUIRE(stop.size() == 1);
  CHECK(std::abs(stop[0] - 1.5) < 1e-13);
  CHECK(r.last("joint.dx") == doctest::Approx(2.25).epsilon(1e-13));
  CHECK(std::abs(r.last("joint.dy")) < 1e-14);
  CHECK(std::abs(r.last("joint.theta_acc")) < 1e-14);
  CHECK(r.last("joint.mode") == 1.0);
  const auto x = r.series("slider.x"), f = r.series("joint.fx");
  for (std::size_t i = 0; i < 6; ++i) {
    const double t = 0.25 * static_cast<double>(i);
    CHECK(x[i] == doctest::Approx(3.0 * t - t * t).epsilon(1e-13));
    CHECK(f[i] == doctest::Approx(-6.0).epsilon(1e-13));
  }
  CHECK(r.result.statistics.dissipated == doctest::Approx(13.5).epsilon(1e-14));
}

TEST_CASE("a disc that slides and spins stops both at once, v/(Rω) → 0.653") {
  // Farkas, Bartels, Unger, Wolf, Phys. Rev. Lett. 90 (2003) 248302: 0.653 whatever the start.
  for (const auto& [velocity, spin] : {std::pair{1.0, 0.5}, std::pair{0.7, 1.4}}) {
    if (steplap::testing::k_is_sanitized && spin > 1.0) continue;
    CAPTURE(spin);
    const double r12 = last_ratio(12, velocity, spin), r24 = last_ratio(24, velocity, spin);
    const double extrapolated = r24 + (r24 - r12) / 3.0; // the polygon's error falls as 1/sides²
    CHECK(std::abs(extrapolated - 0.653) < 1e-3);        // the digits given, and what Aitken leaves
  }
}

TEST_CASE("the energy lost is the integral of h, and −W·ν = h at every instant") {
  const double k_area = 0.4 * 0.2;
  const Run r = run_text(on_ground(rectangle(-0.2, -0.1, 0.2, 0.1), 2.0, 0.05, {0.8, 0.3}, 6.0, 5.0, k_area, k_tight, 0.01));
  const double kinetic = 0.5 * 2.0 * (0.64 + 0.09) + 0.5 * 0.05 * 36.0;
  CHECK(r.last("joint.mode") == 1.0);
  CHECK(r.result.statistics.dissipated == doctest::Approx(kinetic).epsilon(1e-9));
  CHECK(r.relative_energy_residual() < 1e-9);
  const auto* joint = dynamic_cast<const steplap::StepLapFriction*>(r.system->frictions[0].friction.get());
  REQUIRE(joint);
  const auto vx = r.series("slider.vx"), vy = r.series("slider.vy"), w = r.series("slider.omega");
  const auto x = r.series("slider.x"), y = r.series("slider.y"), a = r.series("slider.theta");
  const auto fx = r.series("joint.fx"), fy = r.series("joint.fy"), m = r.series("joint.m");
  const auto mode = r.series("joint.mode"), u = r.series("joint.u");
  for (std::size_t i = 0; mode[i] == 2.0; ++i) {
    const steplap::Patch patch = joint->patch_at({x[i], y[i], a[i]}, steplap::GripLaw::sliding);
    const double h = steplap::evaluate(patch, {vx[i], vy[i], w[i]}).h;
    CHECK(-(fx[i] * vx[i] + fy[i] * vy[i] + m[i] * w[i]) == doctest::Approx(h).epsilon(1e-12));
    // what the joint says of itself is the slip law's; that its wrench is on the bound is found by a search
    CHECK(u[i] == 1.0);
    CHECK(steplap::required_pressure(patch, {fx[i], fy[i], m[i]}).u == doctest::Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("a rectangle's stopping time and turning angle converge under refinement") {
  const auto at = [](const std::string& simulation) {
    const Run r = run_text(on_ground(rectangle(-0.3, -0.05, 0.3, 0.05), 2.0, 0.06, {0.5, 0.2}, 5.0, 4.0, 0.06, simulation, 0.5));
    REQUIRE(r.times("joint", "sticks").size() == 1);
    return Vec2(r.times("joint", "sticks")[0], r.last("slider.theta"));
  };
  const Vec2 exact = at("end = 4.0\nintegrator = \"dop853\"\ntolerance = 1e-12");
  double before = 1.0;
  for (const char* tolerance : {"1e-5", "1e-7", "1e-9"}) {
    const double error = (at(std::string("end = 4.0\nintegrator = \"tsit5\"\ntolerance = ") + tolerance) - exact).norm();
    CHECK(error < before);
    before = error;
  }
  CHECK(before < 1e-8); // ten steps of 1e-9 each
  // A fixed step shrinks with the time left.
  const double coarse = (at("end = 4.0\nintegrator = \"rk4\"\nstep = 1e-3") - exact).norm();
  const double fine = (at("end = 4.0\nintegrator = \"rk4\"\nstep = 2.5e-4") - exact).norm();
  CHECK(coarse < 1e-9);        // it was half a step early
  CHECK(fine < coarse / 16.0); // steps are as short as the slip's direction asks for: less than order 4 is seen of them
}

TEST_CASE("after an onset |ν| = α τ², α = n·Ẇ/(2 nᵀMn)") {
  // A force through a point off the centre grows with time, so that the bound is met by force and couple.
  const double mass = 2.0, inertia = 0.05, rate = 1.0;
  const Run r = run_text(on_ground(rectangle(-0.2, -0.1, 0.2, 0.1), mass, inertia, {0.0, 0.0}, 0.0, 5.0, 0.08,
                                   "end = 20.0\nintegrator = \"tsit5\"\ntolerance = 1e-12", 1e-3,
                                   "[[signal]]\nname = \"ramp\"\nkind = \"triangle\"\npeak = 100.0\nduration = 200.0\n"
                                   "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = { body = \"slider\", at = [0.05, 0.15] }\n"
                                   "force_x = \"ramp\"\n"));
  const auto onset = r.times("joint", "slips");
  REQUIRE(onset.size() == 1);
  const auto* joint = dynamic_cast<const steplap::StepLapFriction*>(r.system->frictions[0].friction.get());
  const steplap::Patch patch = joint->patch_at({0, 0, 0}, steplap::GripLaw::holding);
  const steplap::Vec3 drive(rate, 0.0, -0.15 * rate); // Ẇ of the load; the joint's wrench is its opposite
  const auto need = steplap::required_pressure(patch, drive * onset[0]);
  CHECK(need.u == doctest::Approx(1.0).epsilon(1e-12));
  const steplap::Vec3 n = need.direction;
  const double alpha = n.dot(drive) / (2.0 * (mass * (n[0] * n[0] + n[1] * n[1]) + inertia * n[2] * n[2]));
  const auto vx = r.series("slider.vx"), w = r.series("slider.omega");
  std::size_t i = 0;
  while (1e-3 * static_cast<double>(i) < onset[0]) ++i;
  for (const std::size_t k : {i + 5, i + 20}) {
    const double tau = 1e-3 * static_cast<double>(k) - onset[0];
    // next term: the direction turns by about τ/t, here 1 % at most
    CHECK(vx[k] == doctest::Approx(alpha * tau * tau * n[0]).epsilon(0.02));
    CHECK(w[k] == doctest::Approx(alpha * tau * tau * n[2]).epsilon(0.02));
  }
  const double t1 = 1e-3 * static_cast<double>(i + 5) - onset[0], t2 = 1e-3 * static_cast<double>(i + 20) - onset[0];
  CHECK(std::log(vx[i + 20] / vx[i + 5]) / std::log(t2 / t1) == doctest::Approx(2.0).epsilon(0.01));
}

TEST_CASE("kinetic friction below static: holds up to one, slides with the other") {
  const auto scene = [](double force) {
    return header("end = 0.5\nintegrator = \"tsit5\"\ntolerance = 1e-10", 0.5) + body("slider", 1.0, 0.1, {0.0, 0.0}) +
           joint("slider", "ground") +
           interface(rectangle(-9, -9, 9, 9), rectangle(-0.5, -0.5, 0.5, 0.5), 100.0, 0.5, "kinetic_friction = 0.3") +
           "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"slider\"\nforce = [" + number(force) + ", 0.0]\n";
  };
  CHECK(run_text(scene(49.999)).last("joint.mode") == 1.0);
  const Run r = run_text(scene(50.001));
  CHECK(r.last("joint.mode") == 2.0);
  CHECK(r.last("joint.fx") == doctest::Approx(-30.0).epsilon(1e-12));
  CHECK(r.last("slider.vx") == doctest::Approx(10.0005).epsilon(1e-9));
  CHECK(r.last("joint.u") == doctest::Approx(0.6).epsilon(1e-12));
}

// --- shrinking overlap ------------------------------------------------------------------------------------

namespace {

// A sheet that overlaps the yoke's by `lap` along x is pulled off by a constant force: with F(x) = F₀ (1 − x/l)
// m ẍ = P − F₀ + F₀ x/l, x = (P − F₀) l/F₀ (cosh(t √(F₀/ml)) − 1).
std::string pulled_off(const std::string& joint_fields, const std::string& simulation) {
  return header(simulation, 0.01) + body("slider", 4.0, 0.2, {0.5, 0.0}) + joint("slider", "ground", joint_fields) +
         interface(rectangle(-1, -0.1, 0.2, 0.1), rectangle(0.1, -0.1, 0.9, 0.1), 20.0 / (0.02 * 0.25), 0.25) +
         "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"slider\"\nforce = [25.0, 0.0]\n";
}

} // namespace

TEST_CASE("a joint comes apart when the closed form says") {
  const double apart = std::acosh(1.0 + 20.0 / 5.0) / std::sqrt(20.0 / (4.0 * 0.1));
  for (const char* method : {"\"tsit5\"\ntolerance = 1e-11", "\"dop853\"\ntolerance = 1e-11", "\"rk4\"\nstep = 1e-3"}) {
    CAPTURE(method);
    const Run r = run_text(pulled_off("", std::string("end = 1.0\nintegrator = ") + method));
    const auto event = r.times("joint", "comes apart");
    REQUIRE(event.size() == 1);
    // the onset layer of a fixed step does not matter along a line
    CHECK(event[0] == doctest::Approx(apart).epsilon(1e-9));
    CHECK(r.result.stop_reason == "'joint' came apart");
    CHECK(r.result.final_state.t == event[0]);
    CHECK(r.relative_energy_residual() < 1e-9);
  }
  const Run r = run_text(pulled_off("on_apart = \"continue\"", "end = 1.0\nintegrator = \"tsit5\"\ntolerance = 1e-11"));
  CHECK(r.result.stop_reason.empty());
  CHECK(r.last("joint.mode") == 3.0);
  CHECK(r.last("joint.fx") == 0.0);
  CHECK(r.last("joint.area") == 0.0);
  CHECK(r.last("slider.ax") == doctest::Approx(25.0 / 4.0).epsilon(1e-13));
  CHECK(r.relative_energy_residual() < 1e-9);
}

TEST_CASE("a polygon that shrinks and turns while it slides keeps the energy balance") {
  const Run r = run_file("layouts/joint_apart.toml", {"element.joint.on_apart=continue"});
  REQUIRE(r.times("joint", "loses an interface").size() == 1);
  REQUIRE(r.times("joint", "comes apart").size() == 1);
  CHECK(std::abs(r.last("joint.theta_acc")) > 1e-3);
  CHECK(r.relative_energy_residual() < 1e-9);
}

TEST_CASE("holes count") {
  const Run r = run_text(header("end = 0.1\nintegrator = \"tsit5\"\ntolerance = 1e-9", 0.1) + body("slider", 1.0, 1.0, {0, 0}) +
                         joint("slider", "ground") +
                         interface(rectangle(-1, -1, 1, 1), rectangle(-0.5, -0.5, 0.5, 0.5), 100.0, 0.5,
                                   "limb_holes = [[0.25, 0.25], [-0.25, -0.25]]\nhole_diameter = 0.2"));
  CHECK(r.last("joint.area") == doctest::Approx(1.0 - 2.0 * M_PI * 0.01).epsilon(1e-13));
}

TEST_CASE("cutouts of any shape count, in either sense, and move with their sheet") {
  // A square of side 0.5 in the yoke, a triangle in the limb that stays on the yoke; after 0.1 s the limb has moved by
  // 0.1 m less what friction takes.
  const Run r = run_text(header("end = 0.1\nintegrator = \"tsit5\"\ntolerance = 1e-9", 0.1) + body("slider", 1.0, 1.0, {0, 0}, {1.0, 0.0}) +
                         joint("slider", "ground") +
                         interface(rectangle(-2, -2, 2, 2), rectangle(-0.5, -0.5, 0.5, 0.5), 1.0, 0.5,
                                   "yoke_cutouts = [[[0.25, -0.25], [0.75, -0.25], [0.75, 0.25], [0.25, 0.25]], "
                                   "[[1.5, 1.5], [1.5, 1.6], [1.6, 1.5]]]\n"
                                   "limb_cutouts = [[[-0.4, 0.3], [-0.3, 0.3], [-0.3, 0.4]]]"));
  const double triangle = 0.005, moved = r.last("slider.x");
  CHECK(r.series("joint.area").front() == doctest::Approx(1.0 - 0.125 - triangle).epsilon(1e-13));
  CHECK(moved > 0.09);
  CHECK(r.series("slider.theta").back() != 0.0); // what is left is not symmetrical
  // The limb's edge has passed over more of the hole; it has hardly turned.
  CHECK(r.last("joint.area") == doctest::Approx(1.0 - 0.5 * (0.25 + moved) - triangle).epsilon(1e-4));
  CHECK(r.relative_energy_residual() < 1e-9);
}

TEST_CASE("a cross with a square hole slides as far as its area lets it") {
  // All of it stays on the yoke and its centre is the body's, so that it does not turn: friction is μ p A.
  const double v = 1.0, mass = 2.0, pressure = 100.0, mu = 0.25, area = 5 * 0.04 - 0.01;
  const std::vector<steplap::Vec2> cross{{0.1, -0.3}, {0.1, -0.1}, {0.3, -0.1}, {0.3, 0.1},   {0.1, 0.1},   {0.1, 0.3},
                                         {-0.1, 0.3}, {-0.1, 0.1}, {-0.3, 0.1}, {-0.3, -0.1}, {-0.1, -0.1}, {-0.1, -0.3}};
  const double deceleration = mu * pressure * area / mass;
  const Run r = run_text(
      header("end = 0.6\nintegrator = \"tsit5\"\ntolerance = 1e-9", 0.1) + body("slider", mass, 1.0, {0, 0}, {0.6 * v, 0.8 * v}) +
      joint("slider", "ground") +
      interface(rectangle(-3, -3, 3, 3), cross, pressure, mu, "limb_cutouts = [" + points(rectangle(-0.05, -0.05, 0.05, 0.05)) + "]"));
  CHECK(r.last("joint.area") == doctest::Approx(area).epsilon(1e-13));
  const double distance = v * v / (2.0 * deceleration); // at rest from 0.42 s on
  CHECK(std::hypot(r.last("slider.x"), r.last("slider.y")) == doctest::Approx(distance).epsilon(1e-9));
  CHECK(std::abs(r.last("slider.theta")) < 1e-9);
}

TEST_CASE("cutouts that cannot be meant are named with their place in the file") {
  const auto message = [](const std::string& rings) -> std::string {
    try {
      static_cast<void>(run_text(header("end = 0.1\nintegrator = \"tsit5\"\ntolerance = 1e-9", 0.1) + body("slider", 1.0, 1.0, {7, 0}) +
                                 joint("slider", "ground") +
                                 interface(rectangle(5, -2, 9, 2), rectangle(6, -1, 8, 1), 1.0, 0.1,
                                           "limb_holes = [[7.5, 0.5]]\nhole_diameter = 0.2\nlimb_cutouts = " + rings)));
    } catch (const steplap::ModelError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string good = "[[6.25, -0.5], [6.5, -0.5], [6.5, -0.25]]";
  CHECK(message("[" + good + "]") == "accepted");
  CHECK(message("[" + good + ", [[6.75, -0.5], [7.0, -0.5], [7.0, -0.25]]]") == "accepted");
  const auto refuses = [&](const std::string& rings, const std::string& ring, const std::string& what, const std::string& place) {
    const std::string text = message(rings);
    CAPTURE(text);
    CHECK(text.find("'limb': " + ring) != std::string::npos);
    CHECK(text.find(what) != std::string::npos);
    CHECK(text.find(place) != std::string::npos);
  };
  refuses("[" + good + ", [[8.25, 0], [8.5, 0], [8.5, 0.25]]]", "'limb_cutouts[1]'", "lies outside the outer ring", "(8.5");
  refuses("[[[5, -2], [9, -2], [9, 2], [5, 2]]]", "'limb_cutouts[0]'", "lies outside the outer ring", "(5, 2)");
  refuses("[[[7.75, 0], [8.5, 0], [8.5, 0.25]]]", "outer ring", "meets 'limb_cutouts[0]''s", "(7.75");
  refuses("[[[7.75, 0], [8, 0], [7.75, 0.25]]]", "outer ring", "must not cross or touch", "(8, 0)");
  refuses("[[[6.25, 0], [6.5, 0.25], [6.5, 0], [6.25, 0.25]]]", "'limb_cutouts[0]'", "must not cross or touch itself", "(6.25");
  refuses("[[[6.25, 0], [6.5, 0.25], [6.75, 0.5]]]", "'limb_cutouts[0]'", "has no area", "(6.25");
  refuses("[[[6.25, 0], [6.5, 0.25]]]", "'limb_cutouts[0]'", "has no area", "(6.25");
  refuses("[[]]", "'limb_cutouts[0]'", "has no area", "three vertices");
  refuses("[[[7.4, 0.5], [7.6, 0.55], [7.5, 0.9]]]", "'limb_holes[0]'", "meets 'limb_cutouts[0]''s", "(7.5");
  refuses("[[[6.3, -0.45], [6.25, -0.5], [6.5, -0.5], [6.5, -0.25]], [[6.45, -0.45], [6.475, -0.45], [6.475, -0.4]]]", "'limb_cutouts[1]'",
          "lies inside 'limb_cutouts[0]'", "(6.475");
}

TEST_CASE("models that cannot be meant are refused with the place and the reason") {
  const auto message = [](const std::string& text) -> std::string {
    try {
      static_cast<void>(run_text(text));
    } catch (const steplap::ModelError& error) {
      return error.what();
    }
    return "";
  };
  const std::string start =
      header("end = 0.1\nintegrator = \"tsit5\"\ntolerance = 1e-9", 0.1) + body("slider", 1.0, 1.0, {0, 0}) + joint("slider", "ground");
  CHECK(message(start + interface(rectangle(1, 1, 2, 2), rectangle(3, 3, 4, 4), 1.0, 0.1)).find("do not overlap") != std::string::npos);
  CHECK(message(start + interface(rectangle(-1, -1, 2, 2), {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 1.0, 0.1)).find("'limb': outer ring") !=
        std::string::npos);
  CHECK(message(start + interface(rectangle(-1, -1, 2, 2), rectangle(0, 0, 1, 1), 1.0, 0.1, "kinetic_friction = 0.2"))
            .find("must not exceed") != std::string::npos);
  CHECK(message(start + interface(rectangle(-1, -1, 2, 2), rectangle(0, 0, 1, 1), 1e308, 100.0)).find("traction that is no number") !=
        std::string::npos);
}

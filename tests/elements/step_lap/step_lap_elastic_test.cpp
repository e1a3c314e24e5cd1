// Elastic step-lap joints: springs that yield on the limit surface, against closed forms, the joint that sticks
// exactly, and implicit steps of return mapping made here.
#include "elements/step_lap/patch/admissible_projection.h"
#include "elements/step_lap/step_lap_friction.h"
#include "tests/elements/step_lap/step_lap_scene.h"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include <algorithm>
#include <numbers>

using namespace step_lap_scene;
using steplap::Vec2;
using steplap::Vec3;

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_capacity = 400.0; // N: 0.02 m² · 1e5 Pa · 0.2

std::string elastic(const std::string& simulation, double output_step, const Vec2& velocity, const std::string& stiffness,
                    const std::string& more = "") {
  return header(simulation, output_step) + body("limb", 10.0, 1.0, {0.0, 0.0}, velocity) + joint("limb", "ground", stiffness) +
         interface(rectangle(-1, -1, 1, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 1e5, 0.2) + more;
}

std::string k_of(double stiffness) { return "tangential_stiffness = " + number(stiffness); }

std::string driven(const std::string& coordinate, const std::string& signal) {
  return "[[element]]\nkind = \"prescribed_motion\"\nname = \"drive " + coordinate + "\"\na = \"limb\"\ncoordinate = \"" + coordinate +
         "\"\nsignal = \"" + signal + "\"\nas = \"position\"\n";
}

std::string harmonic(const std::string& name, double amplitude, double frequency) {
  return "[[signal]]\nname = \"" + name + "\"\nkind = \"harmonics\"\namplitudes = [" + number(amplitude) + "]\nfrequencies = [" +
         number(frequency) + "]\nphases = [" + number(-0.5 * k_pi) + "]\n"; // a sine
}

std::string with(const std::string& integrator, const std::string& how, double end) {
  return "end = " + number(end) + "\nintegrator = \"" + integrator + "\"\n" + how;
}

/// A path of the limb that turns while it slides to and fro: yields along a curve of the limit surface.
std::string looping(const std::string& simulation, double output_step) {
  return elastic(simulation, output_step, Vec2::Zero(), k_of(1e6),
                 harmonic("along", 1e-3, 1.0) + harmonic("across", 0.7e-3, 1.5) + harmonic("turn", 8e-3, 0.7) + driven("x", "along") +
                     driven("y", "across") + driven("angle", "turn"));
}

Vec3 path(double t) {
  const double w = 2.0 * k_pi * t;
  return {1e-3 * std::sin(w), 0.7e-3 * std::sin(1.5 * w), 8e-3 * std::sin(0.7 * w)};
}

} // namespace

TEST_CASE("a driven patch: force, cycle and its area are the elastic-plastic closed form") {
  // x = A sin ωt, A = 1 mm, strain at the bound 0.4 mm: after the first yielding the force is a parallelogram of x.
  const double a = 1e-3, k = 1e6, reach = k_capacity / k;
  const Run r = run_text(elastic(with("dop853", "tolerance = 1e-11", 3.25), 0.25, Vec2::Zero(), k_of(k),
                                 harmonic("to and fro", a, 1.0) + driven("x", "to and fro")));
  const double onset = std::asin(reach / a) / (2.0 * k_pi);                      // K x = F₀
  const double again = (k_pi - std::asin(1.0 - 2.0 * reach / a)) / (2.0 * k_pi); // turns at A, yields 2 F₀/K farther
  const auto slips = r.times("joint", "slips"), sticks = r.times("joint", "sticks");
  REQUIRE(slips.size() >= 3);
  REQUIRE(sticks.size() >= 2);
  CHECK(std::abs(slips[0] - onset) < 1e-12); // rounding of t
  CHECK(std::abs(sticks[0] - 0.25) < 1e-8);  // the rate vanishes there: √ of rounding
  CHECK(std::abs(slips[1] - again) < 1e-11);
  CHECK(std::abs(slips[2] - (again + 0.5)) < 1e-11);
  CHECK(r.last("joint.fx") == doctest::Approx(-k_capacity).epsilon(1e-10)); // at t = 3.25: x = A
  CHECK(r.last("joint.dx") == doctest::Approx(a - reach).epsilon(1e-10));
  CHECK(r.last("joint.strain_x") == doctest::Approx(reach).epsilon(1e-10));
  CHECK(std::abs(r.last("joint.dy")) < 1e-12); // the direction of slip is known to 1e-10
  CHECK(r.last("joint.u") == doctest::Approx(1.0).epsilon(1e-10));
  // First quarter F₀ (A − F₀/K), then each half cycle 2 F₀ (A − F₀/K): six of them.
  CHECK(r.result.statistics.dissipated == doctest::Approx(13.0 * k_capacity * (a - reach)).epsilon(1e-10));
  CHECK(r.relative_energy_residual() < 1e-9);
}

TEST_CASE("a patch pulled and let go within its bound comes back, and loses nothing") {
  const Run r = run_text(elastic(with("dop853", "tolerance = 1e-11", 0.5), 0.01, {0.1, 0.0}, k_of(1e6)));
  // v/ω = 0.316 mm < 0.4 mm: swings for ever
  CHECK(r.times("joint", "slips").empty());
  const auto x = r.series("limb.x");
  const double w = std::sqrt(1e5);
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK(std::abs(x[i] - 0.1 / w * std::sin(w * 0.01 * static_cast<double>(i))) < 1e-12); // 50 periods, 1e-11 each of 0.3 mm
  CHECK(r.result.statistics.dissipated == 0.0);
}

TEST_CASE("a block thrown onto an elastic patch: onset, stop, slid distance") {
  const double m = 10.0, k = 1e6, v = 0.5, w = std::sqrt(k / m);
  const double t1 = std::asin(k_capacity / k * w / v) / w, v1 = std::sqrt(v * v - k_capacity * k_capacity / (m * k));
  const double stop = t1 + m * v1 / k_capacity, slid = 0.5 * m * v1 * v1 / k_capacity;
  for (const auto& [integrator, how, bound] : {std::tuple{"rk4", "step = 5e-5", 1e-9},
                                               {"tsit5", "tolerance = 1e-10", 1e-9},
                                               {"dop853", "tolerance = 1e-12", 1e-11},
                                               {"rodas5p", "tolerance = 1e-9", 1e-8},
                                               {"auto", "tolerance = 1e-10", 1e-9}}) {
    CAPTURE(integrator);
    // Ends just after the stop: the swing back would only touch the bound on its other side.
    const Run r = run_text(elastic(with(integrator, how, stop + 1e-3), stop + 1e-3, {v, 0.0}, k_of(k)));
    REQUIRE(r.times("joint", "slips").size() == 1);
    REQUIRE(r.times("joint", "sticks").size() == 1);
    CHECK(std::abs(r.times("joint", "slips")[0] - t1) < bound);
    CHECK(std::abs(r.times("joint", "sticks")[0] - stop) < bound);
    CHECK(std::abs(r.last("joint.dx") - slid) < bound);
    CHECK(r.relative_energy_residual() < 1e-9);
  }
}

TEST_CASE("along any path of the limb: implicit return mapping of small steps") {
  // Its steps are of the first order: extrapolated from two. Whatever K is, the flow is the same closest point.
  const Run r = run_text(looping(with("dop853", "tolerance = 1e-11", 0.9), 0.9));
  REQUIRE(r.times("joint", "slips").size() >= 1);
  const auto* joint = dynamic_cast<const steplap::StepLapFriction*>(r.system->frictions[0].friction.get());
  REQUIRE(joint);
  const steplap::Mat3 compliance = joint->stiffness().inverse();
  const auto march = [&](int steps) {
    Vec3 p = Vec3::Zero(), w = Vec3::Zero();
    for (int i = 1; i <= steps; ++i) {
      const Vec3 s = path(0.9 * i / steps);
      const steplap::Patch patch = joint->patch_at({p[0], p[1], p[2]}, steplap::GripLaw::holding);
      w = steplap::admissible_wrench(patch, compliance, Vec3(s - p)).wrench; // on the limb
      p = s + compliance * w;
    }
    return w;
  };
  const Vec3 coarse = march(2000), fine = march(4000), expected = 2.0 * fine - coarse;
  const double error = (fine - coarse).norm() / expected.norm();
  CHECK(error < 1e-2);
  // What extrapolation leaves is of the second order, and modes change within single steps.
  const Vec3 found(r.last("joint.fx"), r.last("joint.fy"), r.last("joint.m"));
  CHECK(std::abs(found[0] - expected[0]) < 2e-3 * k_capacity);
  CHECK(std::abs(found[1] - expected[1]) < 2e-3 * k_capacity);
  CHECK(std::abs(found[2] - expected[2]) < 2e-3 * k_capacity * 0.06); // gyration
}

TEST_CASE("all methods find the same path through the limit surface, at their orders") {
  const auto wrench = [](const std::string& integrator, const std::string& how) {
    const Run r = run_text(looping(with(integrator, how, 0.9), 0.9));
    // rodas5p takes the work of drives, which is all there is here, by a quadrature on its dense output of order 4.
    if (integrator != "rk4" && integrator != "rodas5p") CHECK(r.relative_energy_residual() < 1e-9);
    return Vec3(r.last("joint.fx"), r.last("joint.fy"), r.last("joint.m") / 0.06);
  };
  const Vec3 exact = wrench("dop853", "tolerance = 1e-12");
  CHECK((wrench("tsit5", "tolerance = 1e-10") - exact).norm() < 1e-6 * k_capacity);
  CHECK((wrench("rodas5p", "tolerance = 1e-9") - exact).norm() < 1e-5 * k_capacity);
  CHECK((wrench("auto", "tolerance = 1e-10") - exact).norm() < 1e-6 * k_capacity);
  const double coarse = (wrench("rk4", "step = 8e-3") - exact).norm(), fine = (wrench("rk4", "step = 1e-3") - exact).norm();
  CHECK(fine < coarse / std::pow(8.0, 3.5)); // order 4: 8⁴; directions are known to 1e-10, the fine one's error is 2e-9
}

TEST_CASE("energy balances to 1e-9 while a free limb slides and turns on its spring") {
  for (const char* integrator : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(integrator);
    const Run r =
        run_text(header(with(integrator, "tolerance = 1e-11", 0.2), 0.2) + body("limb", 10.0, 0.05, {0.0, 0.0}, {0.5, 0.2}, 4.0) +
                 joint("limb", "ground", k_of(1e6)) + interface(rectangle(-1, -1, 1, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 1e5, 0.2));
    CHECK(r.times("joint", "slips").size() > 0);
    CHECK(r.relative_energy_residual() < 1e-9);
    CHECK(r.result.statistics.dissipated > 0.9 * 0.5 * (10.0 * 0.29 + 0.05 * 16.0));
  }
}

TEST_CASE("stiffer and stiffer: the joint that sticks exactly, at first order of the compliance") {
  // A pulse of force beside a constant one (which keeps the swing after the stop off the bound's other side): the slid
  // distance against the rigid joint's, about 4 mm; F₀/K = 10, 1, 0.1 µm.
  const std::string pulse = "[[signal]]\nname = \"pulse\"\nkind = \"haversine\"\npeak = 800.0\nstart = 0.0\nduration = 0.02\n"
                            "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"limb\"\nforce_x = \"pulse\"\n"
                            "[[element]]\nkind = \"load\"\nname = \"bias\"\nat = \"limb\"\nforce = [100.0, 0.0]\n";
  const auto slid = [&](const std::string& stiffness) {
    const Run r = run_text(elastic(with("auto", "tolerance = 1e-10", 0.05), 0.05, Vec2::Zero(), stiffness, pulse));
    CHECK(r.last("joint.mode") == 1.0);
    return r.last("joint.dx");
  };
  const double exact = slid("");
  REQUIRE(exact > 1e-3);
  const double soft = std::abs(slid(k_of(4e7)) - exact), stiff = std::abs(slid(k_of(4e8)) - exact),
               rigid = std::abs(slid(k_of(4e9)) - exact);
  CAPTURE(soft);
  CAPTURE(stiff);
  CAPTURE(rigid);
  // First order in 1/K, up to the phase of the swing at the onset, whose share falls as 1/√K.
  CHECK(stiff < soft / 3.0);
  CHECK(std::log10(stiff / rigid) == doctest::Approx(1.0).epsilon(0.1));
}

TEST_CASE("a spring beside the joint takes its share before the joint slides") {
  // Slowly growing load P: joint K, spring k. It slides at P = F₀ (K + k)/K, a rigid one at F₀: to that the spring
  // gives nothing.
  const double k = 1e6, beside = 5e5;
  const std::string load = "[[signal]]\nname = \"ramp\"\nkind = \"triangle\"\npeak = 1000.0\nduration = 20.0\n"
                           "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"limb\"\nforce_x = \"ramp\"\n"
                           "[[element]]\nkind = \"spring_damper\"\nname = \"plate\"\na = \"limb\"\naxis = [1.0, 0.0]\nstiffness = " +
                           number(beside) + "\ndamping = 1e3\n";
  const Run r = run_text(elastic(with("auto", "tolerance = 1e-9", 8.0), 4.0, Vec2::Zero(), k_of(k), load));
  const auto slips = r.times("joint", "slips");
  REQUIRE(slips.size() >= 1);
  CHECK(std::abs(slips[0] - 6.0) < 1e-2); // 600 N at 100 N/s; the damper lags by 0.7 ms
  const auto joint_force = r.series("joint.fx"), plate = r.series("plate.force");
  CHECK(joint_force[1] == doctest::Approx(-400.0 * k / (k + beside)).epsilon(1e-3)); // at 400 N
  CHECK(plate[1] == doctest::Approx(-400.0 * beside / (k + beside)).epsilon(1e-3));
  CHECK(joint_force[2] == doctest::Approx(-k_capacity).epsilon(1e-6)); // at 800 N
  CHECK(plate[2] == doctest::Approx(-400.0).epsilon(1e-3));
  const Run rigid = run_text(elastic(with("auto", "tolerance = 1e-9", 8.0), 4.0, Vec2::Zero(), "", load));
  REQUIRE(rigid.times("joint", "slips").size() >= 1);
  CHECK(std::abs(rigid.times("joint", "slips")[0] - 4.0) < 1e-9);
}

TEST_CASE("a limb that slides off its yoke comes apart where its sheets have parted") {
  // Thrown at 0.4 m/s from 20 mm of overlap, 40 N: 40 N · 20 mm/2 = 0.4 J of 0.8 J.
  {
    const char* const spin = "0.01";
    const auto scene = [&](const std::string& stiffness) {
      return header("end = 0.5\nintegrator = \"rodas5p\"\ntolerance = 1e-8", 0.5) +
             body("limb", 10.0, 1.0, {0.0, 0.0}, {0.4, 0.0}, std::stod(spin)) + joint("limb", "ground", stiffness) +
             interface(rectangle(-1, -1, -0.08, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 1e5, 0.2);
    };
    const Run elastic_one = run_text(scene(k_of(4e5))), rigid = run_text(scene(""));
    REQUIRE(elastic_one.times("joint", "comes apart").size() == 1);
    REQUIRE(rigid.times("joint", "comes apart").size() == 1);
    // It counts as parted with a hundredth of the overlap left, 0.2 mm at 0.3 m/s, and 1e-4/2 of the work.
    CHECK(std::abs(elastic_one.times("joint", "comes apart")[0] + 0.7e-3 - rigid.times("joint", "comes apart")[0]) < 3e-4);
    CHECK(elastic_one.relative_energy_residual() < 1e-6); // at a tolerance of 1e-8
    CHECK(elastic_one.result.statistics.dissipated == doctest::Approx(rigid.result.statistics.dissipated).epsilon(5e-4));
  }
}

TEST_CASE("a shaken limb ratchets down its joint, and shakes down onto a tie plate") {
  // The example of docs/explanation/step_lap_joint.md: its table.
  const auto slid = [](const char* plate) {
    const Run r = run(steplap::read_model(std::string(STEPLAP_MODELS) + "/../docs/examples/ratcheting.toml", steplap::transformer_catalog(),
                                          {std::string("element.tie plate.stiffness=") + plate}));
    const auto dy = r.series("joint.dy");
    return std::vector<double>{-dy[10], -dy[20], -dy[30]};
  };
  const auto alone = slid("1.0"), beside = slid("5e7");
  CHECK(alone[0] == doctest::Approx(0.249e-3).epsilon(0.01));
  CHECK(alone[1] == doctest::Approx(0.561e-3).epsilon(0.01));
  CHECK(alone[2] == doctest::Approx(0.901e-3).epsilon(0.01));
  CHECK(beside[0] == doctest::Approx(0.033e-3).epsilon(0.01));
  CHECK(beside[2] == beside[1]); // nothing slides any more
}

TEST_CASE("stiffness of sheets in shear and contact, spread over the overlap, about the limb's centre") {
  const auto matrix = [](const std::string& stiffness) {
    const steplap::Model model = steplap::parse_model(
        header("end = 1.0\nintegrator = \"auto\"", 1.0) + body("limb", 10.0, 1.0, {0.3, 0.0}) + joint("limb", "ground", stiffness) +
            interface(rectangle(-1, -1, 1, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 1e5, 0.2, "count = 50"),
        "scene.toml", steplap::transformer_catalog());
    const auto system = steplap::compile(model);
    return dynamic_cast<const steplap::StepLapFriction&>(*system->frictions[0].friction).stiffness();
  };
  // k = 2e10 N/m³ of contact in series with t/G = 0.3 mm/80 GPa; A = 50 · 0.02 m²
  const double k = 1.0 / (1.0 / 2e10 + 0.3e-3 / 80e9);
  const auto found = matrix("contact_stiffness = 2e10\nsheet_thickness = 0.3e-3\nshear_modulus = 80e9");
  const double polar = (0.2 * 0.2 + 0.1 * 0.1) / 12.0;
  CHECK(found(0, 0) == doctest::Approx(k).epsilon(1e-12));
  CHECK(found(1, 2) == doctest::Approx(-0.3 * k).epsilon(1e-12));
  CHECK(found(2, 2) == doctest::Approx(k * (polar + 0.09)).epsilon(1e-12));
  CHECK(matrix("tangential_stiffness = 5e8")(0, 0) == doctest::Approx(5e8).epsilon(1e-12));
}

TEST_CASE("what an elastic joint cannot be is refused with the reason") {
  const auto refusal = [](const std::string& simulation, const std::string& stiffness, const std::string& friction) -> std::string {
    try {
      run_text(header(simulation, 1.0) + body("limb", 10.0, 1.0, {0.0, 0.0}) + joint("limb", "ground", stiffness) +
               interface(rectangle(-1, -1, 1, 1), rectangle(-0.1, -0.05, 0.1, 0.05), 1e5, 0.2, friction));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  const std::string stepping = refusal("end = 1.0\nstep = 1e-3\nintegrator = \"moreau\"", k_of(1e6), "");
  CHECK(stepping.find("'moreau' does not follow") != std::string::npos);
  CHECK(stepping.rfind("scene.toml:16:1: error: step_lap_joint 'joint'", 0) == 0); // where the joint stands, before a run begins
  CHECK(refusal("end = 1.0", k_of(1e6), "kinetic_friction = 0.1").find("one friction coefficient") != std::string::npos);
  CHECK(refusal("end = 1.0", k_of(1e6) + "\ncontact_stiffness = 1e9", "").find("not both") != std::string::npos);
  CHECK(refusal("end = 1.0", k_of(1e6) + "\nmode = \"monitor\"", "").find("cannot be a monitor") != std::string::npos);
}

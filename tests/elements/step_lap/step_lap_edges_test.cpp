// Edges of core sheets that bear on each other, against closed forms of a Winkler bed and a sum over the line.
#include "elements/step_lap/step_lap_assessment.h"
#include "elements/step_lap/step_lap_edges.h"
#include "mbd/dynamics/dynamics.h"
#include "tests/elements/step_lap/step_lap_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

using namespace step_lap_scene;
using steplap::Vec2;

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_line = 0.5; // m, length of the mitre: the limb's end, at y = 0.01 under a yoke that begins at y = 0

const std::vector<Vec2> k_yoke = rectangle(-0.5, 0.0, 0.5, 0.4), k_limb = rectangle(-0.25, -1.0, 0.25, 0.01);

std::string limb_at_yoke(const std::string& simulation, double output_step, const std::string& joint_fields, double pressure,
                         double clearance, const Vec2& velocity, const std::string& more = "", double spin = 0.0) {
  return header(simulation, output_step) + body("limb", 10.0, 1.0, {0.0, -0.5}, velocity, spin) + joint("limb", "ground", joint_fields) +
         interface(k_yoke, k_limb, pressure, 0.2, "clearance = " + number(clearance)) + more;
}

const std::string k_loose = "tangential_stiffness = 1e-3\n";
const char* const k_upwards = "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"limb\"\nb = \"ground\"\naxis = [0.0, 1.0]\n";

} // namespace

TEST_CASE("a limb thrown at the yoke bounces off its edges like a mass on a spring") {
  // Hardly any friction: 1e-6 Pa, on a spring of 1 mN/m. Clearance c, speed v: bears from c/v on for half a period,
  // √(m/(k l)) π.
  const double k = 2e8, c = 0.5e-3, v = 0.1, w = std::sqrt(k * k_line / 10.0);
  for (const auto& [integrator, how] : {std::pair{"dop853", "tolerance = 1e-11"},
                                        {"rk4", "step = 5e-6"},
                                        {"rodas5p", "tolerance = 1e-10"},
                                        {"auto", "tolerance = 1e-11"}}) {
    CAPTURE(integrator);
    const double bound = std::string(integrator) == "rodas5p" ? 1e-7 : 1e-9; // what a step's error is here, m and s
    const Run r = run_text(limb_at_yoke(std::string("end = 0.008\nintegrator = \"") + integrator + "\"\n" + how, 5e-5,
                                        k_loose + ("edge_stiffness = " + number(k)), 1e-6, c, {0.0, v}, k_upwards));
    const auto closes = r.times("joint", "closes"), opens = r.times("joint", "opens");
    REQUIRE(closes.size() == 1);
    REQUIRE(opens.size() == 1);
    CHECK(std::abs(closes[0] - c / v) < bound);
    CHECK(std::abs(opens[0] - c / v - k_pi / w) < bound);
    CHECK(r.last("limb.vy") == doctest::Approx(-v).epsilon(1e-6));
    const auto force = r.series("joint.edge_force_1"), start = r.series("joint.edge_load_1_start"), y = r.series("limb.y");
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double depth = std::max(0.0, y[i] + 0.5 - c);
      CHECK(force[i] == doctest::Approx(k * k_line * depth).epsilon(1e-9));
      CHECK(start[i] == doctest::Approx(k * depth).epsilon(1e-9));
    }
    CHECK(r.relative_energy_residual() < 1e-9 * (std::string(integrator) == "rodas5p" ? 100.0 : 1.0));
  }
}

TEST_CASE("a limb that turns bears along a part of the line: force, moment and energy are sums over it") {
  // 20 000 points of the line, their depths and a midpoint rule: good to 1e-8 of the whole.
  const auto system = steplap::compile(
      steplap::parse_model(limb_at_yoke("end = 1.0\nintegrator = \"auto\"", 1.0, "edge_stiffness = 3e8", 1e3, 0.2e-3, Vec2::Zero()),
                           "scene.toml", steplap::transformer_catalog()));
  steplap::Dynamics dynamics(*system);
  const double k = 3e8, c = 0.2e-3;
  constexpr int k_points = 20000;
  const Vec2 poses[] = {{0.5e-3, 1e-3}, {0.1e-3, 2e-3}, {-0.1e-3, -3e-3}, {0.21e-3, 0.0}, {0.3e-3, -4e-4}};
  for (const Vec2& pose : poses) {
    steplap::State state = system->initial_state();
    state.q[4] += pose.x();
    state.q[5] = pose.y();
    state.friction[0].phase = steplap::FrictionPhase::free;
    dynamics.set_state(state);
    std::vector<double> y(dynamics.dimension()), dy(y.size());
    dynamics.pack(state, y.data());
    dynamics.rates(0.0, y.data(), dy.data());
    for (std::size_t u = 0; u < system->units.size(); ++u)
      state.mode[u] = system->units[u].group->initial_mode(system->units[u].index, dynamics.evaluation());
    dynamics.set_state(state);
    dynamics.rates(0.0, y.data(), dy.data());
    double force = 0.0, moment = 0.0, stored = 0.0;
    for (int i = 0; i < k_points; ++i) {
      const Vec2 arm = steplap::rotated({-0.25 + (i + 0.5) * k_line / k_points, 0.51}, pose.y());
      const double depth = std::max(0.0, arm.y() - 0.5 + pose.x() - 0.01 - c), q = k * depth * k_line / k_points;
      force -= q;
      moment -= q * arm.x();
      stored += 0.5 * q * depth;
    }
    const int n = dynamics.coordinate_count();
    CHECK(10.0 * dy[n + 1] == doctest::Approx(force).epsilon(1e-7).scale(1.0));
    CHECK(1.0 * dy[n + 2] == doctest::Approx(moment).epsilon(1e-7).scale(1.0));
    CHECK(dynamics.mechanical_energy(0.0, y.data()) == doctest::Approx(stored).epsilon(1e-7));
  }
}

TEST_CASE("thrown askew it rocks on its edges, and no energy is made") {
  for (const char* integrator : {"dop853", "rodas5p"}) {
    CAPTURE(integrator);
    const Run r = run_text(limb_at_yoke(std::string("end = 0.008\nintegrator = \"") + integrator + "\"\ntolerance = 1e-11", 0.008,
                                        k_loose + "edge_stiffness = 2e8", 1e-6, 0.5e-3, {0.02, 0.3}, "", 0.4));
    REQUIRE(r.times("joint", "closes").size() >= 1);
    REQUIRE(r.times("joint", "opens").size() >= 1);
    const double before = 0.5 * 10.0 * (0.02 * 0.02 + 0.3 * 0.3) + 0.5 * 0.16;
    const double vx = r.last("limb.vx"), vy = r.last("limb.vy"), w = r.last("limb.omega");
    // Friction of 1e-6 Pa takes 1e-11 J.
    CHECK(5.0 * (vx * vx + vy * vy) + 0.5 * w * w == doctest::Approx(before).epsilon(1e-9));
    CHECK(std::abs(w - 0.4) > 0.1); // it has turned round
  }
}

TEST_CASE("pressed towards the yoke the overlap stops growing where the edges bear") {
  // Capacity F = 0.2 · 1e5 · 0.005 = 100 N; a load of 600 N comes within 50 ms, and is damped by a tie beside it.
  const std::string push = "[[signal]]\nname = \"push\"\nkind = \"trapezoid\"\npeak = 600.0\nrise = 0.05\nfall = 0.1\nduration = 10.0\n"
                           "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"limb\"\nforce_y = \"push\"\n"
                           "[[element]]\nkind = \"spring_damper\"\nname = \"damper\"\na = \"limb\"\naxis = [0.0, 1.0]\ndamping = 2e4\n";
  const auto depth = [&](const std::string& edges) {
    return run_text(limb_at_yoke("end = 0.5\nintegrator = \"auto\"\ntolerance = 1e-9", 0.5, edges, 1e5, 0.5e-3, Vec2::Zero(),
                                 std::string(push) + k_upwards));
  };
  const double k = 2e6;
  const Run r = depth("edge_stiffness = " + number(k) + "\nallowed_line_load = 900.0");
  // Comes to rest where friction, which still points back, and the edges bear the load together (its area grows a
  // little).
  const double moved = r.last("limb.y") + 0.5, friction = -r.last("joint.fy");
  CHECK(r.last("joint.edge_force_1") == doctest::Approx(k * k_line * (moved - 0.5e-3)).epsilon(1e-9));
  CHECK(friction + r.last("joint.edge_force_1") == doctest::Approx(600.0).epsilon(1e-3)); // what the damper leaves after 0.45 s
  CHECK(r.last("joint.edge_share") == doctest::Approx(r.last("joint.edge_load") / 900.0).epsilon(1e-12));
  CHECK(r.last("joint.edge_load") == doctest::Approx(r.last("joint.edge_force_1") / k_line).epsilon(1e-9));
  CHECK(moved < 1.1e-3);
  CHECK(depth("").last("limb.y") + 0.5 > 4e-3); // it went on
}

TEST_CASE("after a bump that the edges bear the core sits as before") {
  // Sheets that butt from the start, an elastic joint: of the bump the edges take k l/(K + k l) = 5/6, and the joint,
  // which alone would slide at 100 N, holds 400 N/6.
  const std::string bump = "[[signal]]\nname = \"bump\"\nkind = \"haversine\"\npeak = 400.0\nstart = 0.0\nduration = 0.2\n"
                           "[[element]]\nkind = \"load\"\nname = \"bump\"\nat = \"limb\"\nforce_y = \"bump\"\n";
  const auto after = [&](const std::string& fields) {
    return run_text(limb_at_yoke("end = 0.4\nintegrator = \"auto\"\ntolerance = 1e-10", 0.4, fields, 1e5, 0.0, Vec2::Zero(),
                                 std::string(bump) + k_upwards));
  };
  const Run with = after("tangential_stiffness = 2e7\nedge_stiffness = 2e8");
  CHECK(with.times("joint", "slips").empty());
  CHECK(with.last("joint.dy") == 0.0);
  CHECK(std::abs(with.last("limb.y") + 0.5) < 1e-7); // swings with the micrometre that the bump's end leaves
  const Run without = after("tangential_stiffness = 2e7");
  CHECK(without.last("joint.dy") > 1e-3);
}

TEST_CASE("crushed edges reject a joint; a closed clearance does no more") {
  const auto verdict = [](const std::string& fields) {
    const steplap::Model model = steplap::parse_model(
        limb_at_yoke("end = 0.008\nintegrator = \"dop853\"\ntolerance = 1e-9", 1e-3, k_loose + fields, 1e-6, 0.5e-3, {0.0, 0.1}, k_upwards),
        "scene.toml", steplap::transformer_catalog());
    const Run r = run(model);
    return steplap::assess_joints(model, r.result).at(0);
  };
  // depth v/ω = 0.1/√(1e8/10) = 31.6 µm: 6325 N/m
  CHECK(verdict("edge_stiffness = 2e8\nallowed_line_load = 6000.0").has_crushed_edges());
  const auto borne = verdict("edge_stiffness = 2e8\nallowed_line_load = 7000.0");
  CHECK(!borne.has_crushed_edges());
  CHECK(borne.edge_share.value == doctest::Approx(0.1 * std::sqrt(2e8 * 10.0 / k_line) / 7000.0).epsilon(1e-5));
  CHECK(!borne.has_left_range());
  CHECK(verdict("").has_left_range());
}

// A yoke that reaches far to one side: from its middle the limb's seems to lie beside it. `across` says where it lies.
TEST_CASE("the line where edges bear is found by the direction that the interface gives") {
  const auto press = [](const std::string& more) {
    const auto system = steplap::compile(steplap::parse_model(
        header("end = 1.0", 1.0) + body("limb", 10.0, 1.0, {0.0, -0.5}) + joint("limb", "ground", "edge_stiffness = 2e8") +
            interface(rectangle(-10.0, 0.0, 0.3, 0.4), k_limb, 1e5, 0.2, "clearance = 0.0\n" + more),
        "scene.toml", steplap::transformer_catalog()));
    steplap::Dynamics dynamics(*system);
    steplap::State state = system->initial_state();
    state.q[4] += 1e-4; // towards the yoke, 0.1 mm
    state.friction[0].phase = steplap::FrictionPhase::free;
    dynamics.set_state(state);
    std::vector<double> y(dynamics.dimension()), dy(y.size());
    dynamics.pack(state, y.data());
    dynamics.rates(0.0, y.data(), dy.data());
    return dynamics.mechanical_energy(0.0, y.data());
  };
  CHECK(press("across = [0.0, -1.0]") == doctest::Approx(0.5 * 2e8 * k_line * 1e-8).epsilon(1e-9));
  CHECK(press("across = [1.0, 0.0]") == doctest::Approx(0.0).scale(1.0).epsilon(1e-12)); // beside it: nothing closes
}

// The same, the yoke a fixed body turned by an angle, with corners and direction in the frames of the bodies or in that of the ground.
TEST_CASE("edges of a fixed yoke bear alike at any angle of the yoke") {
  for (const double angle : {0.0, 0.1, 0.5 * k_pi, k_pi, 4.0})
    for (const bool is_in_body : {true, false}) {
      CAPTURE(angle);
      CAPTURE(is_in_body);
      const auto turned = [angle](std::vector<Vec2> ring) {
        for (Vec2& p : ring) p = steplap::rotated(p, angle);
        return ring;
      };
      const Vec2 at = steplap::rotated({0.0, -0.5}, angle), across = is_in_body ? Vec2(0.0, -1.0) : steplap::rotated({0.0, -1.0}, angle);
      std::vector<Vec2> yoke = rectangle(-10.0, 0.0, 0.3, 0.4), limb = k_limb;
      if (is_in_body)
        for (Vec2& p : limb) p.y() += 0.5; // from the limb's origin
      const std::string angles = "angle = " + number(angle) + "\n";
      const auto system =
          steplap::compile(steplap::parse_model(header("end = 1.0", 1.0) + "[[body]]\nname = \"yoke\"\nfixed = true\n" + angles +
                                                    body("limb", 10.0, 1.0, at) + angles + joint("limb", "yoke", "edge_stiffness = 2e8") +
                                                    interface(is_in_body ? yoke : turned(yoke), is_in_body ? limb : turned(limb), 1e5, 0.2,
                                                              "clearance = 0.0\nframe = \"" + std::string(is_in_body ? "body" : "ground") +
                                                                  "\"\nacross = [" + number(across.x()) + ", " + number(across.y()) + "]"),
                                                "scene.toml", steplap::transformer_catalog()));
      steplap::State state = system->initial_state();
      const Vec2 towards_yoke = steplap::rotated({0.0, 1e-4}, angle);
      state.q[3] += towards_yoke.x();
      state.q[4] += towards_yoke.y();
      steplap::Dynamics dynamics(*system);
      state.friction[0].phase = steplap::FrictionPhase::free;
      dynamics.set_state(state);
      std::vector<double> y(dynamics.dimension());
      dynamics.pack(state, y.data());
      CHECK(dynamics.mechanical_energy(0.0, y.data()) == doctest::Approx(0.5 * 2e8 * k_line * 1e-8).epsilon(1e-9));
    }
}

TEST_CASE("edges without a clearance, or an allowance without edges, are refused") {
  const auto refusal = [](const std::string& fields, const std::string& clearance) -> std::string {
    try {
      run_text(header("end = 1.0", 1.0) + body("limb", 10.0, 1.0, {0.0, -0.5}) + joint("limb", "ground", fields) +
               interface(k_yoke, k_limb, 1e5, 0.2, clearance));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("edge_stiffness = 1e8", "").find("needs the 'clearance'") != std::string::npos);
  CHECK(refusal("allowed_line_load = 1e5", "clearance = 0.0").find("needs 'edge_stiffness'") != std::string::npos);
}

// The layouts of models/layouts: they rest as they stand, momentum and energy balance, a load in the other
// direction gives the mirrored motion, and what comes out is of the size that a hand calculation gives.
#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/equilibrium.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_g = 9.81;

Model layout(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return read_model(std::string(STEPLAP_MODELS) + "/layouts/" + name + ".toml", transformer_catalog(), overrides);
}

Run run_layout(const std::string& name, double end, const std::vector<std::string>& overrides = {}) {
  return run(layout(name, overrides), {"dop853", 1e-9, end, 5e-3});
}

// Strips of road and rails are only heights; the standing wagon has its own track.
bool is_carried(const std::string& body) {
  return body.find("road") == std::string::npos && body.find("rail ") != 0 && body != "standing wagon";
}

double carried_mass(const System& system) {
  double sum = 0.0;
  for (int i = 1; i < system.body_count(); ++i)
    if (is_carried(system.bodies[i].name)) sum += system.bodies[i].mass;
  return sum;
}

std::vector<std::string> supports(const System& system) {
  std::vector<std::string> names;
  for (const std::string& name : system.element_names)
    if (name == "front axles" || name == "rear axles" || name.rfind("axle ", 0) == 0) names.push_back(name);
  return names;
}

// Σ m a of what is carried, per sample.
std::vector<double> inertia_force(const Run& r, const char* acceleration) {
  std::vector<double> sum(r.times().size(), 0.0);
  for (int i = 1; i < r.system->body_count(); ++i) {
    const BodyData& body = r.system->bodies[i];
    if (!is_carried(body.name)) continue;
    const std::vector<double> a = r.series(body.name + "." + acceleration);
    for (std::size_t k = 0; k < a.size(); ++k) sum[k] += body.mass * a[k];
  }
  return sum;
}

std::vector<double> sum_of(const Run& r, const std::vector<std::string>& elements) {
  std::vector<double> sum(r.times().size(), 0.0);
  for (const std::string& name : elements) {
    const std::vector<double> f = r.series(name + ".force");
    for (std::size_t k = 0; k < f.size(); ++k) sum[k] += f[k];
  }
  return sum;
}

double largest(const std::vector<double>& series) {
  double most = 0.0;
  for (const double x : series) most = std::max(most, std::abs(x));
  return most;
}

const char* k_layouts[] = {"single_phase_two_limb", "three_limb", "three_limb_stepped", "five_limb", "rail_wagon"};

struct Load {
  const char* model;
  const char* drive; ///< its prescribed motion along x
  double end;        ///< s: the load and what follows at once
};
const Load k_loads[] = {{"single_phase_two_limb", "drive", 0.6},
                        {"single_phase_two_limb_humping", "drive", 0.2},
                        {"single_phase_two_limb_bump", "drive", 0.6},
                        {"three_limb", "drive", 0.6},
                        {"three_limb_humping", "drive", 0.2},
                        {"three_limb_bump", "drive", 0.6},
                        {"three_limb_stepped", "drive", 0.2},
                        {"five_limb", "drive", 0.6},
                        {"five_limb_humping", "drive", 0.2},
                        {"five_limb_bump", "drive", 0.6},
                        {"rail_wagon", "brake", 0.6},
                        {"rail_wagon_bump", "brake", 0.4},
                        {"rail_wagon_humping", "", 0.4}};

} // namespace

TEST_CASE("layouts rest as they stand, and their supports carry their weight") {
  for (const char* name : k_layouts) {
    CAPTURE(std::string(name));
    const auto system = compile(layout(name));
    State still = system->initial_state();
    std::fill(still.v.begin(), still.v.end(), 0.0);
    const Equilibrium rest = find_equilibrium(*system, still);
    CHECK(rest.moved < 1e-12); // the preloads are exact in decimals: rounding over the stiffest spring
    for (const FrictionMargin& margin : rest.margins) {
      // A limb hangs by W = m g in pure translation: the share of n mu p A (limit_surface.md) that it takes.
      const std::string& element = system->element_names[system->frictions[margin.friction].element];
      if (element == "feet") CHECK(margin.used == 0.0);
      else CHECK((margin.used > 0.05 && margin.used < 0.2));
    }
    Dynamics dynamics(*system);
    dynamics.set_state(rest.state);
    std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
    dynamics.pack(rest.state, y.data());
    dynamics.rates(0.0, y.data(), dy.data());
    const Snapshot snapshot = dynamics.snapshot(dy.data());
    double carried = 0.0;
    for (const std::string& support : supports(*system)) carried += system->find_channel(support + ".force")->value(snapshot);
    CHECK(carried == doctest::Approx(carried_mass(*system) * k_g).epsilon(1e-12));
  }
}

TEST_CASE("layouts under their loads: momentum and energy balance, joints hold") {
  for (const Load& load : k_loads) {
    CAPTURE(std::string(load.model));
    const Run r = run_layout(load.model, load.end);
    const double weight = carried_mass(*r.system) * k_g;
    // Newton for all that is carried: the samples' accelerations are those of the equations, so only
    // rounding is left (a dozen forces of the size of the weight).
    const std::vector<double> up = inertia_force(r, "ay"), support = sum_of(r, supports(*r.system));
    for (std::size_t k = 0; k < up.size(); ++k) CHECK(std::abs(up[k] - (support[k] - weight)) < 1e-11 * weight);
    const std::vector<double> forward = inertia_force(r, "ax");
    const std::vector<double> pull = *load.drive ? r.series(std::string(load.drive) + ".reaction") : r.series("buffers.force");
    const double sign = *load.drive ? 1.0 : -1.0;
    for (std::size_t k = 0; k < pull.size(); ++k) CHECK(std::abs(forward[k] - sign * pull[k]) < 1e-11 * weight);
    // What the method leaves at tolerance 1e-9, a hundred steps: far below the figures that anybody reads.
    CHECK(r.result.statistics.energy_residual < 1e-7 * r.result.statistics.energy_exchanged);
    for (const Event& event : r.result.events) CHECK(event.element.find("joint") == std::string::npos);
    for (const std::string& name : r.system->element_names)
      if (name.size() > 6 && name.rfind(" joint") == name.size() - 6) CHECK(largest(r.series(name + ".p_req")) < 0.1e6);
  }
}

// All layouts are symmetric fore and aft: with load and speed reversed, front does what rear did. Stick-slip
// amplifies the integration error of either run, 1e-9, by the few dozen events.
TEST_CASE("layouts: a load in the other direction gives the mirrored motion") {
  struct Case {
    const char* model;
    std::vector<std::string> reversed;
    double end;
  };
  const Case cases[] = {{"single_phase_two_limb", {"signal.road braking.peak=0.8 gravity", "simulation.velocity=[-3.138128, 0.0]"}, 0.4},
                        {"three_limb", {"signal.road braking.peak=0.8 gravity", "simulation.velocity=[-3.138128, 0.0]"}, 0.4},
                        {"five_limb_humping", {"signal.rail humping.peak=2 gravity", "simulation.velocity=[-0.749173, 0.0]"}, 0.2},
                        {"rail_wagon", {"signal.train braking.peak=1.4", "simulation.velocity=[-1.4, 0.0]"}, 0.6}};
  for (const Case& c : cases) {
    CAPTURE(std::string(c.model));
    const Run r = run_layout(c.model, c.end), mirror = run_layout(c.model, c.end, c.reversed);
    const auto same = [&](const std::string& channel, const std::string& twin, double sign) {
      CAPTURE(channel);
      const std::vector<double> a = r.series(channel), b = mirror.series(twin);
      double worst = 0.0;
      for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::abs(a[k] - sign * b[k]));
      CHECK(worst < 1e-6 * (1e-6 + largest(a)));
    };
    same("active part.x", "active part.x", -1.0);
    same("active part.y", "active part.y", 1.0);
    same("active part.theta", "active part.theta", -1.0);
    same("front foot.force", "rear foot.force", 1.0);
    same("bottom arresting.force", "bottom arresting.force", -1.0);
    const std::string joint = "front joint", twin = "rear joint";
    same(joint + ".fy", twin + ".fy", 1.0);
    same(joint + ".fx", twin + ".fx", -1.0);
    same(joint + ".p_req", twin + ".p_req", 1.0);
  }
}

TEST_CASE("layouts: braking ends at rest, with the forces that a hand calculation gives") {
  for (const char* name : {"single_phase_two_limb", "three_limb", "five_limb"}) {
    CAPTURE(std::string(name));
    const Run r = run_layout(name, 0.7);
    // v0 = peak · (duration − half of rise and fall): the drive integrates its signal exactly.
    CHECK(std::abs(r.last("trailer.vx")) < 1e-12);
    const double mass = carried_mass(*r.system);
    const double push = largest(r.series("drive.reaction"));
    CHECK(push > 0.8 * k_g * mass); // more than the whole as one body
    CHECK(push < 1.6 * k_g * mass); // less than a step load on an undamped spring
    const std::vector<double> slide = r.series("feet.slide");
    CHECK(largest(slide) > 1e-4); // 0.8 g is more than mu = 0.3: it slides until the devices bear
    CHECK(largest(slide) < 10e-3);
  }
}

TEST_CASE("layouts: a humped wagon hands its momentum over and keeps the rest") {
  const Run r = run_layout("rail_wagon_humping", 0.6);
  const double m1 = carried_mass(*r.system), m2 = 80e3, v0 = 7.0 / 3.6;
  double momentum = 0.0;
  for (int i = 1; i < r.system->body_count(); ++i) {
    const BodyData& body = r.system->bodies[i];
    momentum += body.mass * r.last(body.name + ".vx");
  }
  CHECK(momentum == doctest::Approx(m1 * v0).epsilon(1e-12)); // linear: kept by every Runge-Kutta method
  const double after = r.last("standing wagon.vx");
  const double e = (after - (momentum - m2 * after) / m1) / v0; // coefficient of restitution
  CHECK((e > 0.4 && e < 0.9));                                  // "about half of the energy": e² about 0.5
  // A rigid wagon on undamped buffers: F = v0 √(k m), m the reduced mass. Damping and a cargo that gives
  // change it by less than a fifth.
  const double force = largest(r.series("buffers.force"));
  CHECK(force == doctest::Approx(v0 * std::sqrt(5.6e6 * m1 * m2 / (m1 + m2))).epsilon(0.2));
  CHECK(r.event_times("buffers", "opens").size() == 1);
}

TEST_CASE("layouts: a bump lifts the front first, and the heavier trailer the same way") {
  for (const char* name : {"single_phase_two_limb_bump", "five_limb_bump"}) {
    CAPTURE(std::string(name));
    const Run r = run_layout(name, 0.46);
    // Crossed within 0.36 s at 1.5 Hz: the axles' springs take it, between nothing and twice their load.
    const std::vector<double> front = r.series("front axles.force"), rear = r.series("rear axles.force");
    CHECK(*std::min_element(front.begin(), front.end()) > 0.0);
    CHECK(largest(front) < 2.0 * front.front());
    CHECK(largest(front) > 1.1 * front.front());
    CHECK(std::abs(largest(rear) / rear.front() - 1.0) < 0.5 * (largest(front) / front.front() - 1.0));
    const std::vector<double> height = r.series("front road.y"); // up by 40 mm and back
    CHECK(*std::max_element(height.begin(), height.end()) == doctest::Approx(-1.26).epsilon(1e-12));
    CHECK(r.last("front road.y") == doctest::Approx(-1.3).epsilon(1e-14));
  }
}

// Differential equations of the model's own, [[state]], against closed forms: linear ones by the exponential of a matrix, by all methods.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include "mbd/dynamics/linearization.h"
#include "mbd/system/instance.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string state(const std::string& name, const std::string& fields) { return table_text("state", "name = \"" + name + "\"\n", fields); }
std::string formula(const std::string& text) { return "formula = \"" + text + "\""; }
std::string rate(const std::string& text) { return "rate = \"" + text + "\""; }

// exp(A): the series of A/2^s, squared s times.
MatX exponential(const MatX& a) {
  constexpr int k_squarings = 20, k_terms = 12; // of a matrix of the size 1e-4: the remainder is below rounding
  const MatX small = a / std::pow(2.0, k_squarings);
  MatX sum = MatX::Identity(a.rows(), a.cols()), term = sum;
  for (int k = 1; k <= k_terms; ++k) {
    term = term * small / static_cast<double>(k);
    sum += term;
  }
  for (int i = 0; i < k_squarings; ++i) sum = sum * sum;
  return sum;
}

// z' = A z + b from z0, as one homogeneous system.
VecX linear_motion(const MatX& a, const VecX& b, const VecX& z0, double t) {
  const Eigen::Index n = z0.size();
  MatX whole = MatX::Zero(n + 1, n + 1);
  whole.topLeftCorner(n, n) = a * t;
  whole.topRightCorner(n, 1) = b * t;
  VecX start(n + 1);
  start << z0, 1.0;
  return (exponential(whole) * start).head(n);
}

// Squaring 20 times multiplies rounding by 1e6: 1e-10 of the values.
constexpr double k_tolerance = 1e-9;

// A mass that a controller with proportional, integral and derivative parts holds at a height, against its weight.
struct HeldMass {
  double m = 2.0, kp = 50.0, ki = 40.0, kd = 14.0, target = 0.5, g = 9.81;

  [[nodiscard]] static std::string text() {
    return body("load", "mass = 2; inertia = 1") + state("integral", "unit = \"m s\"; scale = 0.1;" + rate("'0.5 m' - load.y")) +
           element("force", "controller",
                   "a = \"load\"; coordinate = \"y\";" +
                       formula("'50 N/m' * ('0.5 m' - value) + '40 N/m/s' * integral - '14 N s/m' * rate"));
  }
  // (y, y', integral)
  [[nodiscard]] VecX at(double t) const {
    MatX a(3, 3);
    a << 0.0, 1.0, 0.0, -kp / m, -kd / m, ki / m, -1.0, 0.0, 0.0;
    VecX b(3);
    b << 0.0, kp / m * target - g, target;
    return linear_motion(a, b, VecX::Zero(3), t);
  }
};

// A motor: L i' = U - R i - k ω, J ω' = k i - c ω. Amperes are numbers in formulas, volts watts.
struct RlMotor {
  double l = 0.02, r = 1.5, k = 0.3, u = 24.0, inertia = 0.05, c = 0.01;

  [[nodiscard]] static std::string text() {
    return k_no_gravity + body("rotor", "mass = 1; inertia = 0.05") + element("revolute", "shaft", "a = \"rotor\"") +
           state("current", "unit = \"A\"; scale = 10;" + rate("('24 V' - '1.5 ohm' * current - '0.3 N m' * rotor.omega) / '20 mH'")) +
           element("force", "motor", "a = \"rotor\"; coordinate = \"angle\";" + formula("'0.3 N m' * current - '0.01 N m s' * rate"));
  }
  // (i, ω)
  [[nodiscard]] VecX at(double t) const {
    MatX a(2, 2);
    a << -r / l, -k / l, k / inertia, -c / inertia;
    VecX b(2);
    b << u / l, 0.0;
    return linear_motion(a, b, VecX::Zero(2), t);
  }
};

} // namespace

TEST_CASE("a mass held by a controller moves as its linear equations say, by every method that controls its error") {
  const HeldMass exact;
  for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run(HeldMass::text(), {method, 1e-12, 6.0, 0.25});
    const std::vector<double> y = r.series("load.y"), z = r.series("integral.value");
    for (std::size_t i = 0; i < y.size(); ++i) {
      const VecX now = exact.at(r.times()[i]);
      CHECK(std::abs(y[i] - now[0]) < k_tolerance);
      CHECK(std::abs(z[i] - now[2]) < k_tolerance);
    }
    CHECK(r.result.statistics.energy_residual < 1e-9 * r.result.statistics.energy_exchanged);
  }
}

TEST_CASE("a motor with inductance and inertia runs up as its linear equations say") {
  const RlMotor exact;
  for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run(RlMotor::text(), {method, 1e-12, 1.0, 0.05});
    const std::vector<double> i_now = r.series("current.value"), omega = r.series("rotor.omega");
    for (std::size_t i = 0; i < omega.size(); ++i) {
      const VecX now = exact.at(r.times()[i]);
      CHECK(std::abs(i_now[i] - now[0]) < k_tolerance * 16.0); // of 16 A
      CHECK(std::abs(omega[i] - now[1]) < k_tolerance * 80.0); // of 80 rad/s
    }
  }
}

TEST_CASE("states have the order of their method: fixed steps of rk4, and time stepping") {
  constexpr double k_end = 0.05; // before it has settled
  const VecX exact = RlMotor().at(k_end);
  const auto error = [&](const char* method, double step) {
    SimulationOptions o = options({method, 1e-9, k_end, k_end});
    o.settings.step = step;
    Run r;
    r.system = compile(scene(RlMotor::text() + "[simulation]\nstep = 1e-3\n"));
    r.result = simulate(*r.system, r.system->initial_state(), o);
    return std::abs(r.last("current.value") - exact[0]) + std::abs(r.last("rotor.omega") - exact[1]);
  };
  const double fourth = error("rk4", 5e-3) / error("rk4", 2.5e-3), first = error("moreau", 4e-4) / error("moreau", 2e-4);
  CHECK(fourth > 12.0);
  CHECK(fourth < 20.0);
  CHECK(first > 1.8);
  CHECK(first < 2.2);
}

TEST_CASE("a stiff filter costs an implicit method no more steps than a slow one: its derivatives are exact") {
  // A filter of 1 µs, thousands of times faster than the motion that it follows.
  const auto text = [](const char* time) {
    return k_no_gravity + body("a", "mass = 1; inertia = 1; position = [1.0, 0.0]") +
           state("filtered", "unit = \"m\"; start = 1.0;" + rate("(a.x - filtered) / " + std::string(time))) +
           element("force", "spring", "a = \"a\";" + formula("-'40 N/m' * filtered - '1 N s/m' * rate"));
  };
  const Run fast = run(text("'1e-6 s'"), {"rodas5p", 1e-8, 10.0, 10.0}), slow = run(text("'1e-2 s'"), {"rodas5p", 1e-8, 10.0, 10.0});
  CHECK(fast.result.statistics.steps < 2 * slow.result.statistics.steps);
  // The fast one is the spring itself, but for a delay of 1 µs: a damping of -40e-6 of 1 N s/m.
  const double c = 1.0 - 40e-6, s = 0.5 * c, w = std::sqrt(40.0 - s * s);
  CHECK(std::abs(fast.last("a.x") - std::exp(-s * 10.0) * (std::cos(w * 10.0) + s / w * std::sin(w * 10.0))) < 1e-6);
}

TEST_CASE("states follow each other, whatever their units: a temperature that a current heats, with a switch") {
  // i' = (1 - i)/τ; T' = 5 i² - (T - 300)/2 while T is below 302, without heating from there on: located, then an exponential.
  const std::string text =
      k_no_gravity + body("a", "mass = 1; inertia = 1") +
      state("warm", "unit = \"K\"; start = 300; scale = 10;" + rate("(warm < 302 ? 5 * amps^2 : 0) / '1 s' - (warm - 300) / '2 s'")) +
      state("amps", "unit = \"A\"; start = 1;" + rate("(1 - amps) / '0.1 s'"));
  // i = 1 throughout: T = 300 + 10 (1 - exp(-t/2)) reaches 302 at t1 = -2 ln 0.8.
  const double t1 = -2.0 * std::log(0.8);
  const Run r = run(text, {"dop853", 1e-10, 0.9 * t1, 0.9 * t1});
  CHECK(std::abs(r.last("warm.value") - (300.0 + 10.0 * (1.0 - std::exp(-0.45 * t1)))) < 1e-7);
}

TEST_CASE("what is wrong with a state is said with its place") {
  const auto message = [](const std::string& tables) {
    try {
      (void)run(body("load", "mass = 2; inertia = 1") + tables, {});
    } catch (const ModelError& error) {
      return error.diagnostics().front().message;
    }
    return std::string();
  };
  const auto says = [&](const std::string& tables, const std::string& expected) {
    CAPTURE(tables);
    CHECK(message(tables).find(expected) != std::string::npos);
  };
  says(state("z", "unit = \"m\";" + rate("load.y")), "has to be in 'm/s'");
  says(state("z", "unit = \"mm\";" + rate("load.vy + '1 m2/s' / load.x")), "no finite value at the start");
  says(state("z", "unit = \"furlongs per fortnight\";" + rate("load.vy")), "is not known");
  says(state("value", "unit = \"m\";" + rate("load.vy")), "mean something else");
  says(state("z", "unit = \"m\";" + rate("lod.vy")), "did you mean 'load.vy'");
  says(state("z", "unit = \"m\""), "rate");
  says(state("z", "unit = \"m\";" + rate("load.vy")) + state("z", "unit = \"m\";" + rate("load.vy")), "z");
}

TEST_CASE("formulas in parts and repetitions are those written out") {
  const Model model = read_model(STEPLAP_TEST_DATA "/formulas/row_of_carts.toml", transformer_catalog());
  const Run r = run(model, {"dop853", 1e-12, 1.0, 0.1});
  // (x, x', z): m x'' = -k x - 5 z - 0.4 x', z' = (x' - z)/0.3.
  const auto cart = [](double k, double t) {
    MatX a(3, 3);
    a << 0.0, 1.0, 0.0, -k / 2.0, -0.2, -2.5, 0.0, 1.0 / 0.3, -1.0 / 0.3;
    return linear_motion(a, VecX::Zero(3), VecX{{0.2, 0.0, 0.0}}, t);
  };
  // Beads with distances e0, e1 beyond 1 m: x0'' = p, x1'' = q - p, x2'' = -q, p = 7 e0 + 0.1 e0', q = 7 e1 + 0.2 e1'.
  MatX b(4, 4);
  b << 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -14.0, 7.0, -0.2, 0.2, 7.0, -14.0, 0.1, -0.4;
  for (std::size_t i = 0; i < r.times().size(); ++i) {
    const double t = r.times()[i];
    // The place of the right cart's rail is that of its part; `value` is counted from there.
    CHECK(std::abs(r.series("left.cart.x")[i] - cart(40.0, t)[0]) < k_tolerance);
    CHECK(std::abs(r.series("left.delayed.value")[i] - cart(40.0, t)[2]) < k_tolerance);
    CHECK(std::abs(r.series("right.cart.x")[i] - 5.0 - cart(90.0, t)[0]) < k_tolerance);
    const VecX e = linear_motion(b, VecX::Zero(4), VecX{{0.1, 0.1, 0.0, 0.0}}, t);
    CHECK(std::abs(r.series("bead 1.x")[i] - r.series("bead 0.x")[i] - 1.0 - e[0]) < k_tolerance);
    CHECK(std::abs(r.series("bead 2.x")[i] - r.series("bead 1.x")[i] - 1.0 - e[1]) < k_tolerance);
  }
}

TEST_CASE("studies vary what formulas name, also where they want a few channels only") {
  const auto text = [](const char* stiffness, const char* start) {
    return "gravity = [0.0, 0.0]\n[simulation]\nstep = 1e-3\n[parameters]\nk = \"" + std::string(stiffness) + "\"\n" +
           body("a", "mass = 1; inertia = 1; position = [1.0, 0.0]") +
           element("spring_damper", "wire", "a = \"a\"; axis = [1.0, 0.0]; stiffness = 2.0; free_length = 0.4") +
           state("seen", "unit = \"m\"; rate = \"(wire.elongation - seen) / '0.2 s'\"; start = " + std::string(start)) +
           element("force", "pull", "a = \"a\";" + formula("-k * seen"));
  };
  const Model given = parse_given_model(text("40 N/m", "0.1"), "scene.toml", transformer_catalog());
  const std::vector<std::string> wanted = {"a.x"};
  Variants few(given, {"parameters.k", "state.seen.start"}, &wanted);
  Run varied, written = run(scene(text("60 N/m", "0.3")), {"dop853", 1e-10, 1.0, 0.1});
  varied.system = few.make({60.0, 0.3});
  varied.result = simulate(*varied.system, varied.system->initial_state(), options({"dop853", 1e-10, 1.0, 0.1}));
  CHECK(varied.system->channels.size() == 1);
  CHECK(varied.series("a.x") == written.series("a.x"));
}

TEST_CASE("derivatives of states and by states are those of differences") {
  const std::string text =
      k_no_gravity + body("other", "mass = 1; inertia = 1; position = [-2.0, 0.0]") + // so that a's coordinates are not the first
      body("a", "mass = 2; inertia = 0.5; position = [0.3, 0.2]; angle = 0.4; velocity = [0.5, -0.7]; angular_velocity = 1.1") +
      state("one", "unit = \"m\"; start = 0.3;" + rate("(tip.x * tip.vy / '1 m/s' - one * two) / '0.2 s'")) +
      state("two", "start = 0.7;" + rate("(sin(a.theta) - two^2 * one / '1 m') / '0.5 s'")) +
      table_text("marker", "name = \"tip\"\n", "body = \"a\"; point = [0.2, -0.3]") +
      element("force", "pull", "a = \"tip\"; coordinate = \"y\";" + formula("-'5 N/m' * value * two - '3 N/m' * one * two"));
  const std::unique_ptr<System> system = compile(scene(text + "[simulation]\nstep = 1e-3\n"));
  Dynamics dynamics(*system);
  const State state = system->initial_state();
  dynamics.set_state(state);
  const auto size = static_cast<std::size_t>(system->largest_dimension());
  std::vector<double> y(size), ahead(size), behind(size);
  dynamics.pack(state, y.data());
  Linearization linear;
  linear.evaluate(dynamics, 0.1, y.data());
  const int n = dynamics.coordinate_count();
  REQUIRE(n == 6);
  const auto sum = [](const std::vector<Linearization::Triplet>& entries, int row, int column) {
    double total = 0.0;
    for (const auto& e : entries)
      if (e.row() == row && e.col() == column) total += e.value();
    return total;
  };
  constexpr double k_step = 1e-6; // central differences: 1e-12 of third derivatives of the order of 10, rounding 1e-10
  for (int c = 0; c < 2 * n + 2; ++c) {
    std::vector<double> moved = y;
    moved[static_cast<std::size_t>(c)] += k_step;
    dynamics.rates(0.1, moved.data(), ahead.data());
    moved[static_cast<std::size_t>(c)] -= 2.0 * k_step;
    dynamics.rates(0.1, moved.data(), behind.data());
    const auto slope = [&](int i) { return (ahead[static_cast<std::size_t>(i)] - behind[static_cast<std::size_t>(i)]) / (2.0 * k_step); };
    const auto& parts = linear.states();
    for (int z = 0; z < 2; ++z) {
      const double expected = c < n       ? sum(parts.by_pose, z, c)
                              : c < 2 * n ? sum(parts.by_velocity, z, c - n)
                                          : sum(parts.by_state, z, c - 2 * n);
      CHECK(std::abs(slope(2 * n + z) - expected) < 1e-8);
    }
    for (int i = 0; i < n && c >= 2 * n; ++i)
      CHECK(std::abs(slope(n + i) - linear.inverse_mass()[static_cast<std::size_t>(i)] * sum(parts.forces, i, c - 2 * n)) < 1e-8);
  }
}

TEST_CASE("two states that run into each other slide along each other to the end of the run") {
  // p falls with 2/s above q, which then rises with 1.5/s; below q p rises with 2/s and q falls with 3/s. They meet at 1/7 s at 17/14. From
  // then on p is above for the share λ of the time with 2 − 4 λ = 4.5 λ − 3, λ = 10/17: both fall with 6/17 per second.
  Run slide = run(body("dummy", "mass = 1; inertia = 1") + element("weld", "w", "a = \"dummy\"") +
                      state("p", "start = 1.5;" + rate("p > q ? -'2 1/s' : '2 1/s'")) +
                      state("q", "start = 1.0;" + rate("q > p ? -'3 1/s' : '1.5 1/s'")),
                  {"dop853", 1e-8, 1.0, 0.0});
  CHECK(slide.result.final_state.t == 1.0);
  // After an event the next is found from 1e-4 of the rest of the run on, so that they part by 4e-4 of it at most.
  for (const char* const channel : {"p.value", "q.value"})
    CHECK(slide.last(channel) == doctest::Approx(17.0 / 14.0 - 6.0 / 17.0 * 6.0 / 7.0).epsilon(5e-4));
}

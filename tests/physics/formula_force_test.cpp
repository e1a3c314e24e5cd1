// Forces by formula against closed forms, against the built-in elements that they can imitate, and against each other by several methods.
#include "mbd/dynamics/dynamics.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string force(const std::string& name, const std::string& fields) {
  std::string text = element("force", name, fields);
  return text;
}

std::string formula(const std::string& text) { return "formula = \"" + text + "\""; }

// Runs at a tolerance of 1e-12 a step, some hundred steps.
constexpr double k_tolerance = 1e-10;

} // namespace

TEST_CASE("a ball with quadratic drag falls as the hyperbolic tangent says, and what drag takes is heat") {
  // v' = -g + c v²/m from rest: v = -u tanh(g t/u), y = -u²/g ln cosh(g t/u), u² = m g/c.
  const std::string text =
      body("ball", "mass = 10; inertia = 1") + force("drag", "a = \"ball\"; coordinate = \"y\"; energy = \"dissipated\";" +
                                                                 formula("-0.5 * '1.2 kg/m3' * '0.05 m2' * abs(rate) * rate"));
  const double g = 9.81, m = 10.0, c = 0.5 * 1.2 * 0.05, u = std::sqrt(m * g / c);
  for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, {method, 1e-12, 20.0, 0.5});
    const std::vector<double> y = r.series("ball.y"), v = r.series("ball.vy");
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double t = r.times()[i];
      CHECK(std::abs(v[i] + u * std::tanh(g * t / u)) < k_tolerance * u);
      CHECK(std::abs(y[i] + u * u / g * std::log(std::cosh(g * t / u))) < k_tolerance * u * u / g);
    }
    CHECK(r.result.statistics.energy_residual < 1e-10 * r.result.statistics.energy_exchanged);
    CHECK(r.last("drag.power") < 0.0);
    for (const double t : r.event_times("drag")) CHECK(t < 1e-6); // the speed is zero at the start, and never again
  }
}

TEST_CASE("a magnet pulls a block in the time that the closed form of the square law says") {
  // m d'' = -c/d² from rest at d0: t(d) = sqrt(m d0³/(2 c)) (sqrt(x (1 - x)) + acos(sqrt x)), x = d/d0.
  const std::string text = k_no_gravity + body("block", "mass = 2; inertia = 1; position = [3.0, 4.0]") +
                           force("magnet", "a = \"block\"; coordinate = \"distance\";" + formula("-'8 N m2' / value^2"));
  const double m = 2.0, c = 8.0, d0 = 5.0, x = 0.3;
  const double t = std::sqrt(m * d0 * d0 * d0 / (2.0 * c)) * (std::sqrt(x * (1.0 - x)) + std::acos(std::sqrt(x)));
  for (const char* method : {"dop853", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, {method, 1e-12, t, t});
    const double d = std::hypot(r.last("block.x"), r.last("block.y"));
    CHECK(std::abs(d - x * d0) < k_tolerance * d0);
    CHECK(std::abs(r.last("magnet.force") + c / (d * d)) < k_tolerance * c / (d * d));
  }
}

TEST_CASE("a spring and damper by formula moves as the built-in one, along every coordinate") {
  struct Case {
    const char *coordinate, *built_in, *written;
  };
  const Case cases[] = {{"x", "kind = \"spring_damper\"; axis = [1.0, 0.0]; stiffness = 80; damping = 3; free_length = 0.1",
                         "-'80 N/m' * (value - '0.1 m') - '3 N s/m' * rate"},
                        {"y", "kind = \"spring_damper\"; axis = [0.0, 1.0]; stiffness = 80; damping = 3; free_length = 0.1",
                         "-'80 N/m' * (value - '0.1 m') - '3 N s/m' * rate"},
                        {"distance", "kind = \"spring_damper\"; stiffness = 80; damping = 3; free_length = 0.4",
                         "-'80 N/m' * (value - '0.4 m') - '3 N s/m' * rate"},
                        {"angle", "kind = \"rotational_spring_damper\"; stiffness = 8; damping = 0.3; free_angle = 0.2",
                         "-'8 N m/rad' * (value - 0.2) - '0.3 N m s/rad' * rate"}};
  const std::string bodies = k_no_gravity +
                             body("a", "mass = 2; inertia = 0.5; position = [0.3, 0.7]; velocity = [0.4, -0.2]; angular_velocity = 0.8") +
                             body("b", "mass = 3; inertia = 0.9; position = [-0.4, -0.3]; angle = 0.0; angular_velocity = -0.6");
  const std::string ends = "a = { body = \"a\", point = [0.2, -0.1] }; b = { body = \"b\", point = [-0.1, 0.2] };";
  for (const Case& c : cases) {
    CAPTURE(std::string(c.coordinate));
    const std::string built_in = table_text("element", "name = \"s\"\n", ends + c.built_in);
    const Run known = run(bodies + built_in, {"dop853", 1e-12, 3.0, 0.3});
    for (const char* method : {"dop853", "rodas5p"}) {
      const Run r =
          run(bodies + force("s", ends + "coordinate = \"" + c.coordinate + "\";" + formula(c.written)), {method, 1e-12, 3.0, 0.3});
      for (const char* channel : {"a.x", "a.y", "a.theta", "b.x", "b.y", "b.theta"}) {
        const std::vector<double> one = known.series(channel), other = r.series(channel);
        for (std::size_t i = 0; i < one.size(); ++i) CHECK(std::abs(one[i] - other[i]) < 1e-9); // of motions of a metre
      }
    }
  }
}

TEST_CASE("a thruster pushes along its body's own axis: a turning body with a constant thrust") {
  // θ = ω t, m x'' = F cos ω t, m y'' = F sin ω t from rest.
  const std::string text = k_no_gravity + body("craft", "mass = 2; inertia = 1; angular_velocity = 3") +
                           force("thruster", "a = \"craft\"; coordinate = \"own_x\";" + formula("'5 N'"));
  const double t = 2.0, w = 3.0, k = 5.0 / 2.0 / (w * w);
  for (const char* method : {"dop853", "rodas5p"}) {
    const Run r = run(text, {method, 1e-12, t, t});
    CHECK(std::abs(r.last("craft.x") - k * (1.0 - std::cos(w * t))) < k_tolerance);
    CHECK(std::abs(r.last("craft.y") - k * (w * t - std::sin(w * t))) < k_tolerance);
    CHECK(r.result.statistics.energy_residual < 1e-10 * r.result.statistics.energy_exchanged);
  }
}

TEST_CASE("jumps and kinks of a formula are located: motion goes on from them by closed forms") {
  SUBCASE("a push that ends at a time gives its impulse to rounding, wherever steps are") {
    const Run r =
        run(k_no_gravity + body("a", "mass = 2; inertia = 1") + force("push", "a = \"a\";" + formula("t < '0.7 s' ? '5 N' : '0 N'")),
            {"dop853", 1e-9, 3.0, 3.0});
    CHECK(std::abs(r.last("a.vx") - 5.0 * 0.7 / 2.0) < 1e-12);
    CHECK(std::abs(r.last("a.x") - (0.5 * 2.5 * 0.7 * 0.7 + 1.75 * 2.3)) < 1e-11);
    REQUIRE(r.event_times("push").size() == 1);
    CHECK(std::abs(r.event_times("push")[0] - 0.7) < 1e-12);
  }
  SUBCASE("a spring that yields at a bound: harmonic until then, a parabola after") {
    // m x'' = -min(k x, F) from x = 0 with v0: x = v0/w sin w t up to x1 = F/k.
    const double k = 50.0, m = 2.0, f = 10.0, v0 = 3.0, w = std::sqrt(k / m), x1 = f / k;
    const double t1 = std::asin(x1 * w / v0) / w, v1 = v0 * std::cos(w * t1), t = t1 + 0.4;
    for (const char* method : {"dop853", "rodas5p"}) {
      const Run r = run(k_no_gravity + body("a", "mass = 2; inertia = 1; velocity = [3.0, 0.0]") +
                            force("stop", "a = \"a\";" + formula("-min('50 N/m' * value, '10 N')")),
                        {method, 1e-12, t, t});
      CHECK(std::abs(r.last("a.x") - (x1 + v1 * 0.4 - 0.5 * f / m * 0.16)) < k_tolerance);
      REQUIRE(r.event_times("stop").size() == 1);
      CHECK(std::abs(r.event_times("stop")[0] - t1) < 1e-9);
    }
  }
  SUBCASE("a root that ends where its argument does: max keeps it at zero") {
    const Run r = run(k_no_gravity + body("a", "mass = 2; inertia = 1; position = [1.0, 0.0]; velocity = [-2.0, 0.0]") +
                          force("field", "a = \"a\";" + formula("-'3 N' * max(value / '1 m', 0)^1.5")),
                      {"dop853", 1e-12, 2.0, 2.0});
    // ½ m (v² - v0²) = 3/2.5 from x = 1 to 0; from there on the speed stays.
    CHECK(std::abs(r.last("a.vx") + std::sqrt(4.0 + 1.2)) < 1e-9);
    CHECK(r.event_times("field").size() == 1);
  }
  SUBCASE("what stands behind a question mark counts only where it is chosen") {
    // At x = 0, where the run begins, 1/x has no value: it is not asked for one. The force is 2 N up to 0.5 m, then 1 N m/x.
    const double v1 = std::sqrt(2.0 * 2.0 * 0.5 / 2.0 + 1.0), x = 2.0;
    const std::string text =
        k_no_gravity + body("a", "mass = 2; inertia = 1; velocity = [1.0, 0.0]") +
        force("push", "a = \"a\";" + formula("value > '0.5 m' ? '1 N m' / value : '2 N'")) +
        table_text(
            "channel", "name = \"energy\"\n",
            "expression = \"0.5 * '2 kg' * a.vx^2 - (a.x < '0.5 m' ? '2 N' * a.x : '1 J' + '1 J' * ln(a.x / '0.5 m'))\"; unit = \"J\"");
    const Run r = run(text, {"dop853", 1e-12, 1.5, 0.1});
    CHECK(r.last("a.x") > x);
    CHECK(r.last("a.vx") > v1);
    for (const double e : r.series("energy")) CHECK(std::abs(e - 1.0) < 1e-9); // ½ m v0²
  }
}

// A signal that jumps, or a comparison that changes, may carry others across their ends in the same instant: a piece of a formula that is chosen
// wrongly for no more than a hair of a step would show here, by a part of a step times the jump.
TEST_CASE("a force that jumps against the motion is never on the wrong side of its jump: right, or the run ends") {
  // A damper that doubles above 0.2 m/s. Where a load pushes the body beyond 0.2 m/s by less than the jump brakes it, neither side lasts.
  const struct {
    double mass, amplitude, frequency, phase;
  } cases[] = {{1.63, 6.04, 2.8, 2.79}, {2.12, 7.31, 2.88, 1.18}, {1.0, 3.0, 2.0, 0.4}, {1.5, 9.0, 1.7, 2.0}};
  int compared = 0;
  for (const auto& c : cases)
    for (const char* method : {"auto", "dop853", "tsit5"}) {
      CAPTURE(c.mass);
      CAPTURE(std::string(method));
      const auto text = [](const char* name, double value) { return std::string(name) + " = " + std::to_string(value) + "; "; };
      const std::string scene =
          k_no_gravity + body("b", text("mass", c.mass) + "inertia = 1") +
          "[[signal]]\nname = \"s\"\nkind = \"sine\"\namplitude = " + std::to_string(c.amplitude) +
          "\nfrequency = " + std::to_string(c.frequency) + "\nphase = " + std::to_string(c.phase) + "\n" +
          force("d", "a = \"b\"; energy = \"dissipated\";" + formula("-'4 N s/m' * rate * (rate > '0.2 m/s' ? 2 : 1)")) +
          element("load", "l", "at = \"b\"; force_x = \"s\"");
      try {
        const Run r = run(scene, {method, 1e-9, 2.0, 1e-3});
        const std::vector<double> rate = r.series("b.vx"), f = r.series("d.force");
        for (std::size_t i = 0; i < rate.size(); ++i) {
          if (std::abs(rate[i] - 0.2) < 1e-5) continue; // to and fro in parts of 1e-4 of a step, at some m/s²
          CHECK(std::abs(f[i] + 4.0 * rate[i] * (rate[i] > 0.2 ? 2.0 : 1.0)) < 1e-9);
          ++compared;
        }
      } catch (const NumericalFailure&) { // says that events repeat without end
      }
    }
  CHECK(compared > 1000);
}

TEST_CASE("what a jump carries across its end changes with it: signals, and comparisons within others") {
  const std::string pulse = "[[signal]]\nkind = \"rectangle\"\nname = \"drive\"\npeak = 1.0\nstart = 0.3\nduration = 0.4\n";
  const std::string at = "a = \"block\"; coordinate = \"x\";";
  const auto speed = [&](const std::string& text, const char* method, double start, double end) {
    const Run r = run(k_no_gravity + pulse +
                          body("block", "mass = 1; inertia = 1; velocity = [0.0, 1.0]; position = [0.0, " + std::to_string(start) + "]") +
                          force("push", at + formula(text)),
                      {method, 1e-10, end, end});
    return r.last("block.vx");
  };
  for (const char* method : {"dop853", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    // 0.6 s of the one and 0.4 s of the other.
    CHECK(std::abs(speed("drive > 0.5 ? '10 N' : '1 N'", method, 0.0, 1.0) - 4.6) < k_tolerance);
    CHECK(std::abs(speed("max(drive, 0.5) * '10 N'", method, 0.0, 1.0) - 7.0) < k_tolerance);
    CHECK(std::abs(speed("abs(drive - 0.25) * '4 N' + (drive < 0.5 ? '1 N' : '2 N')", method, 0.0, 1.0) - (0.6 * 2.0 + 0.4 * 5.0)) <
          k_tolerance);
    // At y = 1 m the first rises above the second.
    CHECK(std::abs(speed("min(block.y > '1 m' ? '5 N' : '1 N', '2 N')", method, 0.0, 2.0) - 3.0) < k_tolerance);
    // The same, but that the second, 2 N + 40 N/m (y - 1 m), has caught up with the first at 1.075 m, well within a step.
    CHECK(std::abs(speed("min(block.y > '1 m' ? '5 N' : '1 N', '2 N' + '40 N/m' * (block.y - '1 m'))", method, 0.98, 1.02) -
                   (0.02 + 0.2625 + 5.0 * 0.925)) < k_tolerance);
  }
}

TEST_CASE("a controller that reads other bodies has exact derivatives: a cart balances a pendulum, the same by all methods") {
  const std::string text =
      body("cart", "mass = 2; inertia = 1; position = [0.1, 0.0]") +
      body("rod", "mass = 1; inertia = 0.1; position = [0.1, 0.5]; angle = 0.05") +
      element("prismatic", "rail", "a = \"cart\"; axis = [1.0, 0.0]") +
      element("revolute", "pin", "a = { body = \"rod\", point = [0.0, -0.5] }; b = \"cart\"") +
      force("controller", "a = \"cart\";" + formula("-'90 N/rad' * pin.angle - '20 N s/rad' * pin.rate + '6 N/m' * rail.displacement + '12 "
                                                    "N s/m' * cart.vx + '0.5 N s2/m2' * rod.vx * abs(rod.vx)"));
  const Run known = run(text, {"dop853", 1e-12, 4.0, 0.2});
  const std::vector<double> exact = known.series("rod.theta");
  CHECK(std::abs(exact.back()) < 0.01); // it stands
  for (const char* method : {"tsit5", "rodas5p"}) {
    const Run r = run(text, {method, 1e-11, 4.0, 0.2});
    const std::vector<double> theta = r.series("rod.theta");
    for (std::size_t i = 0; i < theta.size(); ++i) CHECK(std::abs(theta[i] - exact[i]) < 1e-8); // errors grow as unstable motions do
  }
}

TEST_CASE("formulas name parameters, channels that are formulas, markers and signals") {
  const std::string text = k_no_gravity + "[parameters]\nk = \"40 N/m\"\ntwice = \"= 2*k\"\n" +
                           body("a", "mass = 2; inertia = 1; position = [0.2, 0.0]") +
                           table_text("marker", "name = \"tip\"\n", "body = \"a\"; point = [0.1, 0.0]") +
                           table_text("channel", "name = \"pull\"\n", "expression = \"twice * (tip.x - '0.1 m')\"") +
                           signal_entry("constant", "one", "value = 1.5") + force("spring", "a = \"a\";" + formula("-pull + one * '2 N'"));
  CHECK_THROWS_AS(run(text, {}), ModelError); // `[[channel]]` knows no parameters
  std::string plain = text;
  plain.replace(plain.find("twice * (tip"), 5, "'80 N/m'");
  const Run r = run(plain, {"dop853", 1e-12, 1.0, 0.1});
  const double w = std::sqrt(80.0 / 2.0), rest = 3.0 / 80.0;
  const std::vector<double> x = r.series("a.x");
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(std::abs(x[i] - (rest + (0.2 - rest) * std::cos(w * r.times()[i]))) < k_tolerance);
}

TEST_CASE("what a choice holds is asked for where it is chosen, also numbers that stand before its condition") {
  // Operands and parameters come first in a program; after a switch the first evaluation already has to know them.
  const std::string text = k_no_gravity + "[parameters]\nfirst = \"2 N\"\nthen = \"-3 N\"\n" +
                           body("a", "mass = 1; inertia = 1; velocity = [0.0, 1.0]") +
                           force("push", "a = \"a\";" + formula("t < '1 s' ? first * (a.vy / '1 m/s') : then * (1 + a.omega * '1 s')"));
  const auto program_of = [&] {
    const std::unique_ptr<System> system = compile(scene(text + "[simulation]\nstep = 1e-3\n"));
    State state = system->initial_state();
    Dynamics dynamics(*system);
    std::vector<double> y(static_cast<std::size_t>(system->largest_dimension())), dy(y.size()), forces;
    for (const UnitMode mode : {1U, 0U, 1U}) {
      state.mode.assign(1, mode);
      dynamics.set_state(state);
      dynamics.pack(state, y.data());
      dynamics.rates(0.5, y.data(), dy.data());
      forces.push_back(dy[static_cast<std::size_t>(dynamics.coordinate_count())]); // of 1 kg, by the first evaluation in the mode
    }
    return forces;
  };
  CHECK(program_of() == std::vector<double>{2.0, -3.0, 2.0});
  CHECK(std::abs(run(text, {"dop853", 1e-12, 2.0, 2.0}).last("a.vx") - (2.0 - 3.0)) < 1e-11);
}

TEST_CASE("what is wrong with a formula is said with its element, and what would be right") {
  const auto message = [](const std::string& written, const std::string& more = "") {
    try {
      (void)run(body("load", "mass = 2; inertia = 1") + more + force("drag", "a = \"load\";" + formula(written)), {});
    } catch (const ModelError& error) {
      return error.diagnostics().front().message;
    }
    return std::string();
  };
  const auto says = [&](const std::string& written, const std::string& expected) {
    CAPTURE(written);
    CHECK(message(written).find(expected) != std::string::npos);
  };
  const std::string along_own_axis = message("'1 N/m' * value\"; coordinate = \"own_x");
  CHECK(along_own_axis.find("there is no 'value'") != std::string::npos);
  CHECK(along_own_axis.find("did you mean") == std::string::npos); // least of all 'value'
  says("max('5 N')", "it takes 2 or more");
  says("5", "has to be in 'N', and the formula has no unit");
  says("'5 kg'", "has to be in 'N'");
  says("-'3 N s/m' * laod.vx", "there is no 'laod.vx' (did you mean 'load.vx'?)");
  says("'5 N m' / value", "no finite value at the start");
  says("'5 N' * (value == '1 m')", "compares with ==");
  says("value ? '5 N' : '0 N'", "compare it with something");
  says("'5 N' * (3 +", "ends where");
  says("'5 N s2/m' * load.ax", "no force can depend on it");
  says("'1 1' * drag.force", "there is no 'drag.force'");
}

TEST_CASE("what changes with the time as fast as a formula likes is refused, what is straight in it is not") {
  const auto compiled = [](const std::string& text) {
    (void)compile(scene(k_no_gravity + body("a", "mass = 2; inertia = 1") + force("push", "a = \"a\";" + formula(text)) +
                        "[simulation]\nstep = 1e-3\n"));
  };
  for (const char* const hidden : {"sin(200 * t / '1 s') > 0.95 ? '5 N' : '0 N'", "'5 N' * exp(-t / '1 s')", "'1 N/s2' * t * t",
                                   "'1 N/s2' * t^2", "'1 N s' / (t + '1 s')", "'1 N' * sqrt(abs(t / '1 s' - 0.5))"}) {
    CAPTURE(hidden);
    CHECK_THROWS_AS(compiled(hidden), ModelError);
  }
  for (const char* const plain : {"'3 N/s' * t", "t < '0.5 s' ? '1 N' : '2 N'", "'1 N/s' * abs(t - '0.3 s')", "'1 N' * min(t / '2 s', 1)",
                                  "'1 N/m/s' * t * value", "-(t - '1 s') * '1 N/s' / 3"}) {
    CAPTURE(plain);
    CHECK_NOTHROW(compiled(plain));
  }
}

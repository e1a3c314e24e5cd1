// Tabulated springs and dampers of any length: the answer is the table's, to rounding, and the smooth law's to what the
// straight lines between its points leave out, Δ²/8 of its second derivative.
#include "elements/spring_damper.h"
#include "elements/spring_laws.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

// Points of `law` from −reach to reach, none of them at a round place.
std::vector<Vec2> points(int count, double reach, const std::function<double(double)>& law) {
  std::vector<Vec2> table;
  for (int i = 0; i < count; ++i) {
    const double x = reach * (2.0 * i / (count - 1) - 1.0);
    table.push_back({x, law(x)});
  }
  return table;
}

std::string text_of(const char* key, const std::vector<Vec2>& table) {
  std::ostringstream text;
  text.precision(17);
  text << key << " = [";
  for (const Vec2& p : table) text << "[" << p.x() << ", " << p.y() << "],";
  text << "]\n";
  return text.str();
}

std::string spring(const std::string& gravity, const std::string& x, const std::string& tables) {
  return "gravity = " + gravity + "\n" + body("mass", "mass = 2.0; inertia = 1.0; position = [" + x + ", 0.0]") +
         element("spring_damper", "spring", "a = 'mass'; axis = [1.0, 0.0]; free_length = 0.0") + tables;
}

} // namespace

TEST_CASE("a fall through tabulated quadratic drag: 10, 400 and 10 000 points") {
  const double c = 2.0 * 9.81 / (1.333 * 1.333); // m g = c v² at 1.333 m/s
  const auto drag = [c](double v) { return c * v * std::abs(v); };
  for (const int count : {10, 400, 10000})
    for (const Settings& settings : {Settings{"dop853", 1e-10, 3.0, 0.1}, Settings{"auto", 1e-8, 3.0, 0.1},
                                     Settings{"rodas5p", 1e-10, 3.0, 0.1}, Settings{"rk4", 5e-3, 3.0, 0.1}}) {
      CAPTURE(count);
      CAPTURE(settings.integrator);
      const std::vector<Vec2> table = points(count, 2.0, drag);
      const Run r = run(spring("[9.81, 0.0]", "0.0", text_of("damping_table", table)), settings);
      // The straight line of the table that the weight is met on. 3 s are 44 time constants v/2g.
      int i = 1;
      while (table[i].y() < 2.0 * 9.81) ++i;
      const double share = (2.0 * 9.81 - table[i - 1].y()) / (table[i].y() - table[i - 1].y());
      const double terminal = table[i - 1].x() + share * (table[i].x() - table[i - 1].x());
      CHECK(std::abs(r.last("mass.vx") - terminal) < 1e-8);
      // v = 1.333 tanh(g t/1.333). The table gives too much drag, by up to c Δ²/4, over a time constant.
      const double step = 4.0 / (count - 1), left_out = 0.25 * c * step * step / 2.0 * (1.333 / (2.0 * 9.81));
      // rk4: (h/τ)⁵/120 in each of some twenty steps, τ = 0.07 s, and as much again at kinks
      const double of_method = settings.integrator == "rk4" ? 1e-6 : 1e-8;
      for (std::size_t k = 0; k < r.times().size(); ++k)
        CHECK(std::abs(r.series("mass.vx")[k] - 1.333 * std::tanh(9.81 * r.times()[k] / 1.333)) < 2.0 * left_out + of_method);
    }
}

TEST_CASE("a hardening spring from a table keeps its energy, and the smooth one's but for the table's lines") {
  const double k = 500.0, reach = 0.3;
  for (const int count : {10, 400, 10000}) {
    CAPTURE(count);
    const std::vector<Vec2> table = points(count, 0.4, [k](double x) { return k * x * x * x; });
    SimulationOptions o = options({"auto", 1e-9, 2.0, 0.05});
    o.max_events = 100; // kinks are not what this limit is for
    const auto system = compile(scene(spring("[0.0, 0.0]", "0.3", text_of("force_table", table))));
    const RunResult r = simulate(*system, system->initial_state(), o);
    CHECK(r.statistics.energy_residual < 1e-8 * r.statistics.energy_exchanged);
    const double energy = 0.25 * k * std::pow(reach, 4.0);
    // Between lines and cubic: Δ²/8 · 6 k x at most, over the way of 0.3 m, there and where it started.
    const double step = 0.8 / (count - 1), left_out = 2.0 * step * step / 8.0 * 6.0 * k * reach * reach;
    const std::vector<double> x = r.trajectory->series("mass.x"), v = r.trajectory->series("mass.vx");
    for (std::size_t i = 0; i < x.size(); ++i)
      CHECK(std::abs(v[i] * v[i] + 0.25 * k * std::pow(x[i], 4.0) - energy) < left_out + 1e-7 * energy);
  }
}

TEST_CASE("a table's segments: found in any number, and several passed at once") {
  const PiecewiseLinear table(points(60001, 3.0, [](double x) { return x * x; }));
  CHECK(table.segments() == 60000);
  for (const double x : {-5.0, -3.0, -2.99995, 0.00005, 1.23456, 2.99995, 3.0, 7.0}) {
    const int s = table.segment_at(x);
    CHECK(table.low(s) <= x);
    CHECK(x < table.high(s));
  }
  CHECK(table.segment_beyond(10, true, table.low(10)) == 11); // at the kink, to rounding
  CHECK(table.segment_beyond(10, false, table.high(10)) == 9);
  CHECK(table.segment_beyond(10, true, 1.00005) == table.segment_at(1.00005)); // a jump
  CHECK(std::abs(table.integral(2.0) - 8.0 / 3.0) < 2.0 * 1e-8 / 12.0 * 2.0 + 1e-12);
  TabulatedSpring law{table, table, 0.0, 1.0};
  const UnitMode mode = law.initial_mode(2.5, -1.5);
  CHECK(TabulatedSpring::spring_segment(mode) == table.segment_at(2.5));
  CHECK(TabulatedSpring::damper_segment(mode) == table.segment_at(-1.5));
  CHECK(std::abs(law.force(2.5, -1.5, mode) + 2.5 * 2.5 + 1.5 * 1.5) < 1e-8);
}

TEST_CASE("a table of more points than a mode can number is refused") {
  const Model model = scene(spring("[0.0, 0.0]", "0.3", "stiffness = 0.0\nforce_table = [[-1.0, -1.0], [1.0, 1.0]]\n"));
  auto& element = dynamic_cast<SpringDamper&>(*model.elements.at(0).element);
  element.force_table = points(65536, 1.0, [](double x) { return x; });
  CHECK_NOTHROW(static_cast<void>(compile(model)));
  element.force_table = points(65537, 1.0, [](double x) { return x; });
  CHECK_THROWS_AS(static_cast<void>(compile(model)), ModelError);
}

TEST_CASE("a smooth curve meets its points, bends without jumps, goes on straight, and its integral is its own") {
  for (const int count : {2, 3, 5, 40}) {
    CAPTURE(count);
    const std::vector<Vec2> table = points(count, 1.0, [](double x) { return std::sin(3.0 * x) + 0.2 * x * x; });
    const SmoothCurve curve(table);
    for (const Vec2& p : table) CHECK(std::abs(curve.value(p.x()) - p.y()) < 1e-14);
    // Second differences on both sides of a point, of steps of 1e-4, agree to the third derivative times the step.
    const auto bend = [&](double x) { return (curve.value(x + 1e-4) - 2.0 * curve.value(x) + curve.value(x - 1e-4)) / 1e-8; };
    const auto slope = [&](double x) { return (curve.value(x + 1e-6) - curve.value(x - 1e-6)) / 2e-6; };
    for (std::size_t i = 1; i + 1 < table.size(); ++i) {
      CHECK(std::abs(bend(table[i].x() + 2e-4) - bend(table[i].x() - 2e-4)) < 100.0 * 4e-4);
      const Dual<12> d = curve.value(Dual<12>::variable(table[i].x() + 0.01, 3));
      CHECK(std::abs(d.d[3] - slope(table[i].x() + 0.01)) < 1e-8);
    }
    for (const double end : {-1.0, 1.0}) {
      CHECK(std::abs(slope(end * 1.5) - slope(end * 7.0)) < 1e-8);
      CHECK(std::abs(slope(end * 1.5) - slope(end * (1.0 - 1e-5))) < 1e-3); // its curvature is zero at the end
    }
    // Simpson's rule is exact for the cubics between points that lie at its nodes, and for lines.
    for (const double x : {-2.3, -1.0, -0.37, 0.0, 0.61, 1.0, 1.9}) {
      double sum = 0.0;
      const int parts = 20000;
      const double h = x / parts;
      for (int i = 0; i < parts; ++i) sum += h / 6.0 * (curve.value(i * h) + 4.0 * curve.value((i + 0.5) * h) + curve.value((i + 1) * h));
      CHECK(std::abs(curve.integral(x) - sum) < 1e-11);
    }
  }
}

TEST_CASE("a hardening spring from a smooth curve makes no events, and moves as the law does that its points are of") {
  const double k = 500.0, reach = 0.3;
  double before = 1.0;
  for (const int count : {41, 81, 60001}) {
    CAPTURE(count);
    const std::vector<Vec2> table = points(count, 0.6, [k](double x) { return k * x * x * x; });
    double error = 0.0;
    for (const Settings& settings : {Settings{"dop853", 1e-11, 2.0, 0.05}, Settings{"rodas5p", 1e-10, 2.0, 0.05}}) {
      CAPTURE(settings.integrator);
      const Run r = run(spring("[0.0, 0.0]", "0.3", text_of("force_table", table) + "between = \"curve\"\n"), settings);
      CHECK(r.result.events.empty());
      CHECK(r.result.statistics.energy_residual < 1e-8 * r.result.statistics.energy_exchanged);
      const std::vector<double> x = r.series("mass.x"), v = r.series("mass.vx");
      for (std::size_t i = 0; i < x.size(); ++i)
        error = std::max(error, std::abs(v[i] * v[i] + 0.25 * k * std::pow(x[i], 4.0) - 0.25 * k * std::pow(reach, 4.0)));
    }
    // A cubic is its own spline but for the curvature at its ends, of which each point towards the middle leaves 0.27.
    CHECK(error < (count == 41 ? 1e-5 : 1e-9));
    CHECK(error <= before);
    before = std::max(error, 1e-9);
  }
}

TEST_CASE("a wheel between the stops of a backlash swings as a spring does, and coasts in between") {
  // Beyond the band half an oscillation of √(J/k), across it 2 h at the speed ω₀: T = 2π √(J/k) + 4 h/ω₀, the same from tables.
  const double inertia = 0.5, k = 200.0, half = 0.05, speed = 3.0, pi = 3.14159265358979323846;
  const std::string wheel = "gravity = [0.0, 0.0]\n" + body("wheel", "mass = 1.0; inertia = 0.5; angular_velocity = 3.0") +
                            element("revolute", "bearing", "a = 'wheel'");
  const double period = 2.0 * pi * std::sqrt(inertia / k) + 4.0 * half / speed;
  for (const char* spring : {"a = 'wheel'; stiffness = 200.0; gap = 0.1",
                             "a = 'wheel'; couple_table = [[-1.05, -200.0], [-0.05, 0.0], [0.05, 0.0], [1.05, 200.0]]"})
    for (const char* method : {"dop853", "rodas5p"}) {
      CAPTURE(spring);
      CAPTURE(method);
      const Run r = run(wheel + element("rotational_spring_damper", "backlash", spring), {method, 1e-11, 3.0 * period});
      CHECK(std::abs(r.last("wheel.omega") - speed) < 1e-8);
      CHECK(std::abs(r.last("wheel.theta")) < 1e-8);
      CHECK(r.result.events.size() == 12); // out of the band and into it, on two sides, three times
    }
}

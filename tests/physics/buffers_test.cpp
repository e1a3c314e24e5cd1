// Buffers: curves for loading and unloading with exact stick between them, against closed forms and against the signal of two wagons
// that meet, which integrates the same curves by a program of its own.
#include "tests/physics/stepped.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr const char* k_methods[] = {"dop853", "tsit5", "rodas5p"};

std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string wagon(const std::string& name, double mass, double x, double vx) {
  return "[[body]]\nname = \"" + name + "\"\nmass = " + digits(mass) + "\ninertia = 1.0\nposition = [" + digits(x) +
         ", 0.0]\nvelocity = [" + digits(vx) + ", 0.0]\n[[element]]\nkind = \"prismatic\"\nname = \"rails of " + name + "\"\na = \"" +
         name + "\"\naxis = [1.0, 0.0]\n";
}

std::string buffer(const std::string& fields) { return "[[element]]\nkind = \"buffer\"\nname = \"buffer\"\n" + fields; }

} // namespace

TEST_CASE("a mass that runs against straight curves comes back with the root of the ratio of their slopes") {
  // Quarter of an oscillation by k, then one by q: e = √(q/k), half of the time each.
  const double k = 4e6, q = 1e6, m = 1e4, v = 2.0;
  const std::string text = wagon("mass", m, 0.5, -v) +
                           buffer("a = \"mass\"\nloading = [[0.0, 0.0], [1.0, 4e6]]\nunloading = [[0.0, 0.0], [1.0, 1e6]]\ngap = 0.5\n");
  const double pi = 3.14159265358979323846, touch = 0.25, deepest = touch + 0.5 * pi * std::sqrt(m / k),
               parts = deepest + 0.5 * pi * std::sqrt(m / q);
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-11, 1.0});
    CHECK(r.last("mass.vx") == doctest::Approx(v * std::sqrt(q / k)).epsilon(1e-8));
    const std::vector<double> kinks = r.event_times("buffer", "passes a kink");
    REQUIRE(kinks.size() == 2); // touches and parts
    CHECK(std::abs(kinks[0] - touch) < 1e-9);
    CHECK(std::abs(kinks[1] - parts) < 1e-8);
    CHECK(std::abs(r.result.statistics.dissipated - 0.5 * m * v * v * (1.0 - q / k)) < 1e-7 * m * v * v);
    CHECK(r.last("buffer.mode") == 0.0);
  }
}

TEST_CASE("pressed in and held, it sticks until the load falls below the unloading curve, to the digit") {
  // The load rises to 30 kN and falls again. Depth 30e3/4e6 stays until the load is 30 kN·q/k, then it follows q.
  const std::string text = "gravity = [0.0, 0.0]\n" + wagon("mass", 10.0, 0.0, 0.0) +
                           "[[signal]]\nkind = \"triangle\"\nname = \"load\"\npeak = -30e3\nduration = 20.0\n"
                           "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"mass\"\nforce_x = \"load\"\n"
                           "[[element]]\nkind = \"spring_damper\"\nname = \"calm\"\na = \"mass\"\naxis = [1.0, 0.0]\ndamping = 2e3\n" +
                           buffer("a = \"mass\"\nloading = [[0.0, 0.0], [1.0, 4e6]]\nunloading = [[0.0, 0.0], [1.0, 1e6]]\n");
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r = run(text, {method, 1e-10, 20.0, 0.5});
    const std::vector<double> depth = r.series("buffer.depth"), mode = r.series("buffer.mode"), force = r.series("buffer.force");
    // The damper takes c d' = 2e3·3e3/4e6 = 1.5 N of the force, and delays by as much.
    CHECK(depth[20] == doctest::Approx(30e3 / 4e6).epsilon(1e-4));
    for (int i = 22; i <= 34; ++i) { // 11 to 17 s: it holds its depth whatever the load
      CHECK(mode[i] == 1.0);
      CHECK(std::abs(depth[i] - depth[22]) < 2e-12); // places are known to 1e-12 m
      CHECK(force[i] == doctest::Approx(30e3 - 3e3 * (0.5 * i - 10.0)).epsilon(1e-9));
    }
    const std::vector<double> slips = r.event_times("buffer", "slips forward");
    REQUIRE(slips.size() >= 1);
    CHECK(std::abs(slips.back() - (20.0 - 1e6 * depth[22] / 3e3)) < 1e-8);
    CHECK(depth[38] == doctest::Approx((3e3 * 1.0 + 2e3 * 3e3 / 1e6) / 1e6).epsilon(1e-3)); // 19 s: on the lower curve
  }
}

TEST_CASE("two wagons that meet: the pulse is that of the signal which integrates the same curves by itself") {
  // Two buffers in series at each of two places: one element of twice the travel, count 2.
  const std::string curves[] = {"[[0.0, 0.0], [0.002, 30e3], [0.06, 250e3], [0.105, 590e3]]", "[[0.0, 0.0], [0.002, 15e3], [0.105, 295e3]]",
                                "[[0.0, 0.0], [0.004, 30e3], [0.12, 250e3], [0.21, 590e3]]", "[[0.0, 0.0], [0.004, 15e3], [0.21, 295e3]]"};
  const auto pulse =
      run("gravity = [0.0, 0.0]\n" + wagon("wagon", 87e3, 0.0, 2.0) +
              "[[signal]]\nkind = \"shunting\"\nname = \"pulse\"\nmass = 87e3\nother_mass = 80e3\nspeed = 2.0\nbuffer = " + curves[0] +
              "\nunloading = " + curves[1] +
              "\nstart = 0.1\n[[signal]]\nkind = \"scaled\"\nname = \"force\"\nsignal = \"pulse\"\nfactor = 87e3\n"
              "[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"wagon\"\nforce_x = \"force\"\n",
          {"dop853", 1e-11, 1.0, 0.01});
  for (const char* method : k_methods) {
    CAPTURE(method);
    const Run r =
        run("gravity = [0.0, 0.0]\n" + wagon("wagon", 87e3, 0.0, 2.0) + wagon("other", 80e3, 10.0, 0.0) +
                buffer("a = \"other\"\nb = \"wagon\"\nloading = " + curves[2] + "\nunloading = " + curves[3] + "\ngap = 0.2\ncount = 2\n"),
            {method, 1e-11, 1.0, 0.01});
    const std::vector<double> expected = pulse.series("wagon.vx"), found = r.series("wagon.vx");
    for (std::size_t i = 0; i < found.size(); ++i)
      CHECK(std::abs(found[i] - expected[i]) < 1e-6); // 7e-9 of the peak acceleration, for 0.3 s
    CHECK(std::abs(87e3 * r.last("wagon.vx") + 80e3 * r.last("other.vx") - 87e3 * 2.0) < 1e-5);
  }
}

TEST_CASE("random curves and masses: the energy that a blow loses lies between the curves") {
  random::RandomNumber draw(5);
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    const int count = 2 + draw.below(4);
    std::string loading = "[[0.0, 0.0]", unloading = "[[0.0, 0.0]";
    std::vector<Vec2> up{{0.0, 0.0}}, down{{0.0, 0.0}};
    for (int p = 0; p < count; ++p) {
      const double depth = up.back().x() + draw.between(0.01, 0.05);
      const double force = up.back().y() + draw.between(1e4, 2e5);
      const double share = draw.between(0.1, 1.0);
      up.emplace_back(depth, force);
      down.emplace_back(depth, std::max(down.back().y(), share * force));
      loading += ", [" + digits(depth) + ", " + digits(force) + "]";
      unloading += ", [" + digits(depth) + ", " + digits(down.back().y()) + "]";
    }
    const double mass = draw.decades(3.0, 5.0);
    const double work = [&] { // up to half of the last segment, so that nothing goes beyond
      double sum = 0.0;
      for (std::size_t p = 1; p < up.size(); ++p) sum += 0.5 * (up[p].y() + up[p - 1].y()) * (up[p].x() - up[p - 1].x());
      return sum;
    }();
    const double speed = std::sqrt(2.0 * work * draw.between(0.1, 0.95) / mass);
    const std::string fields = "a = \"mass\"\nloading = " + loading + "]\nunloading = " + unloading + "]\ngap = 0.01\n";
    const std::string text = "gravity = [0.0, 0.0]\n" + wagon("mass", mass, 0.0, -speed) + buffer(fields);
    const Run r = run(text, {"dop853", 1e-10, 10.0 / speed});
    const double after = r.last("mass.vx");
    REQUIRE(after > 0.0);
    // The deepest point by the loading curve's work, what comes back by the unloading curve's.
    const auto area = [](const std::vector<Vec2>& curve, double depth) {
      double sum = 0.0;
      for (std::size_t p = 1; p < curve.size() && curve[p - 1].x() < depth; ++p) {
        const double end = std::min(depth, curve[p].x()), slope = (curve[p].y() - curve[p - 1].y()) / (curve[p].x() - curve[p - 1].x());
        const double d = end - curve[p - 1].x();
        sum += d * (curve[p - 1].y() + 0.5 * slope * d);
      }
      return sum;
    };
    double low = 0.0, high = up.back().x();
    for (int n = 0; n < 100; ++n) {
      const double middle = 0.5 * (low + high);
      (area(up, middle) < 0.5 * mass * speed * speed ? low : high) = middle;
    }
    CHECK(after == doctest::Approx(std::sqrt(2.0 * area(down, low) / mass)).epsilon(1e-7));
  }
}

TEST_CASE("time stepping comes to the same rebound, with the error of its order") {
  const std::string text = "gravity = [0.0, 0.0]\n" + wagon("mass", 1e4, 0.5, -2.0) +
                           buffer("a = \"mass\"\nloading = [[0.0, 0.0], [1.0, 4e6]]\nunloading = [[0.0, 0.0], [1.0, 1e6]]\ngap = 0.5\n");
  double before = 1.0;
  for (const double step : {1e-3, 1e-4, 1e-5}) {
    const double error = std::abs(stepped(text, step, 1.0).last("mass.vx") - 1.0);
    CHECK(error < 0.3 * before); // of the first order
    before = error;
  }
  CHECK(before < 1e-3);
}

TEST_CASE("what is no curve is refused") {
  const auto compiled = [](const std::string& fields) {
    (void)compile(scene(wagon("mass", 1.0, 0.0, 0.0) + buffer("a = \"mass\"\n" + fields) + "[simulation]\nstep = 1e-3\n"));
  };
  CHECK_NOTHROW(compiled("loading = [[0.0, 0.0], [1.0, 4.0]]\n"));
  CHECK_THROWS_AS(compiled(""), ModelError);
  CHECK_THROWS_AS(compiled("loading = [[0.0, 0.0]]\n"), ModelError);
  CHECK_THROWS_AS(compiled("loading = [[0.0, 1.0], [1.0, 4.0]]\n"), ModelError);
  CHECK_THROWS_AS(compiled("loading = [[0.0, 0.0], [1.0, 4.0], [1.0, 5.0]]\n"), ModelError);
  CHECK_THROWS_AS(compiled("loading = [[0.0, 0.0], [1.0, -4.0]]\n"), ModelError);
  CHECK_THROWS_AS(compiled("loading = [[0.0, 0.0], [1.0, 4.0]]\nunloading = [[0.0, 0.0], [1.0, 4.1]]\n"), ModelError);
  // Straight lines would cross beyond the last points: the lower one goes on parallel to the upper one.
  CHECK_NOTHROW(compiled("loading = [[0.0, 0.0], [1.0, 4.0], [2.0, 4.5]]\nunloading = [[0.0, 0.0], [1.0, 1.0], [2.0, 4.4]]\n"));
  CHECK_THROWS_AS(compiled("loading = [[0.0, 0.0], [1.0, 4.0]]\naxis = [0.0, 0.0]\n"), ModelError);
}

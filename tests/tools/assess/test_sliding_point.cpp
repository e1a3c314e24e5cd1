// A point with |F| <= mu N in the plane: closed forms, symmetry, order of convergence, and a second method.
#include "tools/assess/sliding_point.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace steplap;
using namespace steplap::assess;

namespace {

constexpr double k_g = 9.81, k_mass = 20000.0;

Vec2 towards(double azimuth, double size = 1.0) { return {size * std::cos(azimuth), size * std::sin(azimuth)}; }

PointLoad pulled(const Vec2& acceleration, double normal = k_mass * k_g) { return {k_mass * acceleration, normal}; }

// A triangle of this peak and duration along an azimuth; then rest.
double slid_by_triangle(double mu, double peak, double duration, double azimuth, double largest_step) {
  SlidingPoint point(k_mass, mu, mu, largest_step);
  const PointLoad none = pulled(Vec2::Zero()), top = pulled(towards(azimuth, peak));
  point.advance(none, top, 0.5 * duration);
  point.advance(top, none, 0.5 * duration);
  point.advance(none, none, 1.0);
  CHECK(point.rests());
  // Along the pull in a straight line.
  CHECK(std::abs(cross(point.position(), towards(azimuth))) < 1e-12);
  CHECK(point.position().norm() == doctest::Approx(point.path()).epsilon(1e-12));
  return point.path();
}

// Loads that turn and swell smoothly, in pieces of 1 ms.
std::vector<PointLoad> swirl(double size, double duration) {
  std::vector<PointLoad> loads;
  for (int i = 0; i <= std::lround(duration / 1e-3); ++i) {
    const double t = 1e-3 * i;
    loads.push_back(pulled(towards(3.0 * t + 0.5 * std::sin(7.0 * t), size * (1.0 + 0.3 * std::sin(11.0 * t))),
                           k_mass * k_g * (1.0 + 0.2 * std::cos(13.0 * t))));
  }
  return loads;
}

} // namespace

TEST_CASE("a triangle of 0.6 g for 0.1 s slides a block as Newmark's closed form says, along any azimuth") {
  // mm, by the closed form of the sliding block for this pulse (g = 9.81).
  const std::vector<std::pair<double, double>> known = {{0.1, 30.653}, {0.2, 9.787}, {0.3, 3.602}, {0.4, 1.059}, {0.5, 0.132}};
  for (const auto& [mu, millimetres] : known)
    for (const double azimuth : {0.0, 0.7, 2.5, -1.9})
      CHECK(1e3 * slid_by_triangle(mu, 0.6 * k_g, 0.1, azimuth, 1e-4) == doctest::Approx(millimetres).epsilon(1e-3)); // its digits
}

TEST_CASE("a rectangular pulse slides (A t)²/(2 mu g) (1 - mu g / A), whatever the step") {
  const double mu = 0.3, a = 0.6 * k_g, t = 0.1, exact = a * a * t * t / (2.0 * mu * k_g) * (1.0 - mu * k_g / a);
  for (const double step : {1e-3, 1e-4, 0.1}) {
    SlidingPoint point(k_mass, mu, mu, step);
    const PointLoad load = pulled(towards(0.4, a)), none = pulled(Vec2::Zero());
    point.advance(load, load, t);
    point.advance(none, none, 1.0);
    // Velocity is linear in time in both phases, which the method integrates exactly.
    CHECK(point.path() == doctest::Approx(exact).epsilon(1e-12));
    CHECK(*point.last_rest() == doctest::Approx(a * t / (mu * k_g)).epsilon(1e-12));
  }
}

TEST_CASE("what is held does not move by a bit, and the onset is where the quadratic says") {
  SlidingPoint held(k_mass, 0.3, 0.3);
  held.advance(pulled(Vec2(0.1, -0.1)), pulled(towards(1.0, 0.3 * k_g * (1.0 - 1e-12))), 0.5);
  CHECK(held.rests());
  CHECK(held.path() == 0.0);
  CHECK(held.velocity() == Vec2::Zero());
  // D = (1 + t, 2 t), mu N / m = 2 - t / 2: (1 + t)² + 4 t² = (2 - t/2)²  =>  4.75 t² + 4 t - 3 = 0.
  SlidingPoint slips(1.0, 0.5, 0.4);
  slips.advance({Vec2(1.0, 0.0), 4.0}, {Vec2(2.0, 2.0), 3.0}, 1.0);
  REQUIRE(slips.first_slip());
  CHECK(*slips.first_slip() == doctest::Approx((-4.0 + std::sqrt(16.0 + 57.0)) / 9.5).epsilon(1e-13));
  CHECK(slips.path() > 0.0);
}

TEST_CASE("a block on a slope slides when tan = mu at every azimuth, to 1e-9") {
  const double mu = 0.3, limit = std::atan(mu);
  for (int i = 0; i < 360; ++i) {
    const double azimuth = i * std::numbers::pi / 180.0;
    for (const double off : {-1e-9, 1e-9}) {
      const double slope = limit * (1.0 + off);
      SlidingPoint point(k_mass, mu, mu);
      const PointLoad load = pulled(towards(azimuth, k_g * std::sin(slope)), k_mass * k_g * std::cos(slope));
      point.advance(load, load, 0.05);
      CHECK(point.rests() == (off < 0.0));
    }
  }
}

TEST_CASE("thrown across a slope: closed forms of the time to stop, of both ways and of the path") {
  // Constant load d along x, c = mu_k N / m > d: T = (c s + d v_x) / (c² - d²). The way follows from the work, c L = d x + s²/2.
  const double c = 0.3 * k_g;
  for (const double share : {0.0, 0.3, 0.7, 0.95})
    for (const double azimuth : {0.0, 0.5, 1.5, 2.8, 3.1}) {
      const double d = share * c;
      const Vec2 v = towards(azimuth, 2.0);
      SlidingPoint point(k_mass, 0.3, 0.3, 2e-4, v);
      const PointLoad load = pulled(Vec2(d, 0.0));
      for (int i = 0; i < 2000 && !point.rests(); ++i) point.advance(load, load, 0.02);
      REQUIRE(point.last_rest());
      CHECK(*point.last_rest() == doctest::Approx((c * 2.0 + d * v.x()) / (c * c - d * d)).epsilon(1e-7)); // order 3: (2e-4)³
      CHECK(c * point.path() == doctest::Approx(d * point.position().x() + 2.0).epsilon(1e-7));
      // The same at once, by the closed form alone.
      SlidingPoint at_once(k_mass, 0.3, 0.3, 1e9, v);
      CHECK(at_once.come_to_rest(load));
      CHECK(at_once.path() == doctest::Approx(point.path()).epsilon(1e-7));
      CHECK((at_once.position() - point.position()).norm() < 1e-6);
    }
}

TEST_CASE("thrown across a slope of tan = mu it ends with half its speed, downhill") {
  // d = c: v_x + s is constant; in the end v_x = s.
  SlidingPoint point(1.0, 0.3, 0.3, 1e-3, Vec2(0.0, 2.0));
  const PointLoad load{Vec2(0.3 * k_g, 0.0), k_g};
  point.advance(load, load, 60.0);
  CHECK(point.velocity().x() == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(std::abs(point.velocity().y()) < 1e-6);
  CHECK_FALSE(point.come_to_rest(load));
}

TEST_CASE("the method is of order 3") {
  // Sliding throughout: twice the friction pulls. Pieces of 40 ms, so that steps divide them and not the other way round.
  const std::vector<PointLoad> loads = swirl(0.8 * k_g, 0.8);
  const auto run = [&](double step) {
    SlidingPoint point(k_mass, 0.3, 0.25, step, Vec2(2.0, 1.0));
    for (std::size_t i = 40; i < loads.size(); i += 40) point.advance(loads[i - 40], loads[i], 0.04);
    return Vec3(point.position().x(), point.position().y(), point.path());
  };
  const Vec3 exact = run(0.04 / 1024.0);
  double before = (run(0.04 / 4.0) - exact).norm();
  for (const double step : {0.04 / 8.0, 0.04 / 16.0, 0.04 / 32.0}) {
    const double error = (run(step) - exact).norm();
    CHECK(before / error > 6.0); // 2³, less what the next order takes
    before = error;
  }
}

TEST_CASE("turned, mirrored, with more mass and more load: the same motion") {
  const std::vector<PointLoad> loads = swirl(0.32 * k_g, 2.0);
  const auto run = [&](double mass_factor, const auto& map) {
    SlidingPoint point(mass_factor * k_mass, 0.3, 0.3);
    for (std::size_t i = 1; i < loads.size(); ++i) {
      const PointLoad a{map(Vec2(mass_factor * loads[i - 1].drive)), mass_factor * loads[i - 1].normal};
      const PointLoad b{map(Vec2(mass_factor * loads[i].drive)), mass_factor * loads[i].normal};
      point.advance(a, b, 1e-3);
    }
    return std::pair(point.position(), point.path());
  };
  const auto [position, path] = run(1.0, [](const Vec2& v) { return v; });
  CHECK(path > 0.01);
  const auto same = [&](double factor, const auto& map) {
    const auto [other, length] = run(factor, map);
    CHECK(length == doctest::Approx(path).epsilon(1e-10)); // rounding, some 10⁴ steps
    CHECK((other - map(position)).norm() < 1e-10 * path);
  };
  same(7.0, [](const Vec2& v) { return v; });
  same(1.0, [](const Vec2& v) { return Vec2(v.y(), v.x()); });
  same(1.0, [](const Vec2& v) { return Vec2(-v.x(), v.y()); });
  same(1.0, [](const Vec2& v) { return rotated(v, 1.234); });
}

TEST_CASE("shaken at random it slides as far as by time stepping with ten thousand steps a second") {
  // Moreau's catching-up, order 1: v = (1 - h mu N / |w|)+ w with w = v + h D / m. It knows no events.
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int scene = 0; scene < 40; ++scene) {
    std::vector<PointLoad> loads{pulled(Vec2::Zero())};
    Vec2 a = Vec2::Zero();
    for (int i = 0; i < 1000; ++i) {
      a += -0.02 * a + 0.25 * Vec2(normal(random), normal(random));
      loads.push_back(pulled(a, k_mass * (k_g + 0.5 * normal(random))));
    }
    SlidingPoint point(k_mass, 0.3, 0.3);
    Vec2 v = Vec2::Zero(), x = Vec2::Zero();
    double path = 0.0;
    constexpr int k_parts = 100;
    const double h = 1e-3 / k_parts;
    for (std::size_t i = 1; i < loads.size(); ++i) {
      point.advance(loads[i - 1], loads[i], 1e-3);
      for (int k = 1; k <= k_parts; ++k) {
        const double share = static_cast<double>(k) / k_parts;
        const Vec2 w = v + h / k_mass * (loads[i - 1].drive + share * (loads[i].drive - loads[i - 1].drive));
        const double bound = h / k_mass * 0.3 * (loads[i - 1].normal + share * (loads[i].normal - loads[i - 1].normal));
        const Vec2 next = w.norm() > bound ? Vec2((1.0 - bound / w.norm()) * w) : Vec2::Zero();
        path += 0.5 * h * (v + next).norm();
        x += 0.5 * h * (v + next);
        v = next;
      }
    }
    CHECK(point.path() == doctest::Approx(path).epsilon(1e-3).scale(1e-3)); // steps of 1e-5 s against slips of 10 ms and more
    CHECK((point.position() - x).norm() < 1e-3 * path + 1e-6);
  }
}

// Angles by series and links: the frames in which all elements work.
#include "mbd/system/link.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace steplap;

namespace {

Motion<double> moving(double x, double y, double theta, double vx, double vy, double omega) {
  Motion<double> m;
  m.x = x;
  m.y = y;
  m.vx = vx;
  m.vy = vy;
  m.omega = omega;
  set_angle(m, theta);
  return m;
}

} // namespace

TEST_CASE("cosine and sine by series agree with the library's to rounding, on either side of the switch") {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  Motion<double> m;
  for (int i = -3000; i <= 3000; ++i) {
    const double theta = 1e-4 * i + 1e-9;
    set_angle(m, theta);
    CHECK(std::abs(m.c - std::cos(theta)) <= epsilon); // an ulp of numbers just below 1 and half one above
    CHECK(std::abs(m.s - std::sin(theta)) <= epsilon * std::abs(theta));
  }
}

TEST_CASE("the power of a link's force is the power of the two forces it gives") {
  const Motion<double> a = moving(1.3, -0.4, 0.7, 0.2, -1.1, 2.3), b = moving(-0.6, 0.9, -2.1, 1.7, 0.4, -1.2);
  const Motion<double> link = seen_from(a, b);
  const BodyForce f{3.0, -5.0, 0.8};
  BodyForce on_a, on_b;
  add_link_force(f, link, b, on_a, on_b);
  const auto power = [](const BodyForce& w, const Motion<double>& m) { return w.fx * m.vx + w.fy * m.vy + w.m * m.omega; };
  // Only relative motion works: sums of a dozen products of order 10.
  CHECK(std::abs(power(on_a, a) + power(on_b, b) - power(f, link)) < 1e-14 * 100.0);
  CHECK(std::abs(on_a.fx + on_b.fx) + std::abs(on_a.fy + on_b.fy) < 1e-15);
}

TEST_CASE("the frame's acceleration is what a body in free flight shows to a turning observer") {
  const Motion<double> a = moving(1.3, -0.4, 0.7, 0.2, -1.1, 2.3), b = moving(-0.6, 0.9, -2.1, 1.7, 0.4, -1.2);
  const auto later = [&](double t) {
    const auto fly = [t](const Motion<double>& m) {
      return moving(m.x + t * m.vx, m.y + t * m.vy, m.theta + t * m.omega, m.vx, m.vy, m.omega);
    };
    return seen_from(fly(a), fly(b));
  };
  constexpr double h = 1e-5;
  const Pair<double> expected{(later(h).vx - later(-h).vx) / (2 * h), (later(h).vy - later(-h).vy) / (2 * h)};
  const Pair<double> found = frame_acceleration(later(0.0), b.omega);
  // Central differences: h² times third derivatives of order 10, and rounding/h.
  CHECK(std::abs(found.x - expected.x) < 1e-8);
  CHECK(std::abs(found.y - expected.y) < 1e-8);
}

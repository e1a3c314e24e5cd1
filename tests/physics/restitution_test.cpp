// `restitution` of contacts and stops: the damper that gives it, and the rebound that follows; and from where stops count.
#include "elements/restitution.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string body(const std::string& name, double mass, double inertia, double x, double y, double vx, double vy) {
  return "[[body]]\nname = \"" + name + "\"\nmass = " + number(mass) + "\ninertia = " + number(inertia) + "\nposition = [" + number(x) +
         ", " + number(y) + "]\nvelocity = [" + number(vx) + ", " + number(vy) + "]\n";
}

const std::string k_no_gravity = "gravity = [0.0, 0.0]\n";

} // namespace

TEST_CASE("the damping ratio of a restitution: limits, and the way back") {
  CHECK(restitution_of(0.0) == 1.0);
  CHECK(restitution_of(1.0) == doctest::Approx(std::exp(-2.0)).epsilon(1e-14));
  CHECK(restitution_of(1e3) == doctest::Approx(0.25e-6).epsilon(1e-5)); // 1/(4ζ²)
  CHECK(damping_for_restitution(1.0, 1e5, 3.0) == 0.0);
  for (double e = 0.999; e > 1e-4; e *= 0.83) {
    const double c = damping_for_restitution(e, 2e5, 3.0);
    CHECK(restitution_of(c / (2.0 * std::sqrt(2e5 * 3.0))) == doctest::Approx(e).epsilon(1e-12));
  }
}

TEST_CASE("random blows of two bodies along a contact give back what was asked") {
  random::RandomNumber draw(71);
  for (int i = 0; i < 200; ++i) {
    const double e = draw.between(0.05, 1.0);
    const double m = draw.decades(-1.0, 3.0);
    const double j = m * draw.decades(-2.0, 1.0);
    const double k = draw.decades(4.0, 9.0);
    const double v = draw.decades(-2.0, 1.0);
    const double side = draw.between(-0.5, 0.5);
    CAPTURE(i);
    CAPTURE(e);
    // A blow beside the centre turns the body: the gap's rate is that of the marker. It is over before the angle counts.
    const double effective = 1.0 / (1.0 / m + side * side / j), length = 3.2 * std::sqrt(effective / k); // half a period and more
    const double turned = v * length * std::abs(side) / j * effective;
    if (turned > 1e-5) continue; // a stiff blow of a heavy body, no swing
    const Run r = run(k_no_gravity + body("ball", m, j, 0.0, 0.0, 0.0, -v) +
                          "[[element]]\nkind = \"unilateral_contact\"\nname = \"floor\"\na = { body = \"ball\", at = [" + number(side) +
                          ", 0.0] }\nstiffness = " + number(k) + "\nrestitution = " + number(e) + "\n",
                      {"dop853", 1e-11, 3.0 * length, 3.0 * length});
    const double after = r.last("ball.vy") + side * r.last("ball.omega");
    CHECK(after / v == doctest::Approx(e).epsilon(1e-4)); // the lever turns by up to `turned`
  }
}

TEST_CASE("two free balls, a ball in a ring, a stop: the effective mass is that of both") {
  const double e = 0.6;
  const std::string balls = k_no_gravity + body("a", 1.0, 1.0, 0.0, 0.0, 2.0, 0.0) + body("b", 3.0, 1.0, 0.25, 0.0, -1.0, 0.0);
  const auto parting = [](const Run& r) { return r.last("b.vx") - r.last("a.vx"); };
  const Run circles = run(balls + "[[element]]\nkind = \"circle_contact\"\nname = \"c\"\na = \"a\"\nb = \"b\"\nradius_a = 0.1\nradius_b = "
                                  "0.1\nstiffness = 1e6\nrestitution = 0.6\n",
                          {"dop853", 1e-11, 0.1});
  CHECK(parting(circles) == doctest::Approx(3.0 * e).epsilon(1e-9));
  const Run stop = run(balls + "[[element]]\nkind = \"limit\"\nname = \"c\"\na = \"b\"\nb = \"a\"\ncoordinate = \"distance\"\nlower = "
                               "0.2\nstiffness = 1e6\nrestitution = 0.6\n",
                       {"dop853", 1e-11, 0.1});
  CHECK(parting(stop) == doctest::Approx(3.0 * e).epsilon(1e-9));
  const Run plane = run(balls + "[[element]]\nkind = \"unilateral_contact\"\nname = \"c\"\na = \"b\"\nb = \"a\"\nnormal = [1.0, 0.0]\ngap "
                                "= 0.05\nstiffness = 2.5e5\ncount = 4\nrestitution = 0.6\n",
                        {"dop853", 1e-11, 0.1});
  CHECK(parting(plane) == doctest::Approx(3.0 * e).epsilon(1e-9));
}

// A rod on a pin turns about it with J + m l², whatever l; what is welded or geared to a body strikes with it. Measured is the rate of
// the coordinate that the stop ends.
TEST_CASE("a stop of joined bodies gives back what was asked: pins, welds, guides and gears count") {
  random::RandomNumber draw(72);
  for (int i = 0; i < 100; ++i) {
    const double e = draw.between(0.1, 1.0), m = draw.decades(-1.0, 3.0), l = draw.decades(-2.0, 1.0),
                 j = m * l * l * draw.decades(-2.0, 1.0);
    const double rate = draw.decades(-1.0, 0.5), k = (j + m * l * l) * draw.decades(6.0, 9.0);
    CAPTURE(i);
    const std::string rod = "[[body]]\nname = \"rod\"\nmass = " + number(m) + "\ninertia = " + number(j) + "\nposition = [" + number(l) +
                            ", 0.0]\nvelocity = [0.0, " + number(l * rate) + "]\nangular_velocity = " + number(rate) +
                            "\n[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = { body = \"rod\", at = [0.0, 0.0] }\n";
    const std::string stop =
        "[[element]]\nkind = \"limit\"\nname = \"stop\"\na = \"rod\"\ncoordinate = \"angle\"\nupper = 1e-3\nstiffness = ";
    const double end = 1e-3 / rate + 4.0 * std::sqrt((j + m * l * l) / k);
    const Run pinned = run(k_no_gravity + rod + stop + number(k) + "\nrestitution = " + number(e) + "\n", {"dop853", 1e-11, end});
    CHECK(pinned.last("rod.omega") / rate == doctest::Approx(-e).epsilon(1e-6));
    // A second rod of another size, welded to it: both turn about the pin. The stop is given first, the joints behind it.
    const double m2 = m * draw.decades(-1.0, 1.0), l2 = l * draw.decades(-0.5, 0.5), j2 = m2 * l2 * l2 * draw.decades(-1.0, 1.0);
    const double all = j + m * l * l + j2 + m2 * l2 * l2;
    const std::string tip = "[[body]]\nname = \"tip\"\nmass = " + number(m2) + "\ninertia = " + number(j2) + "\nposition = [0.0, " +
                            number(l2) + "]\nvelocity = [" + number(-l2 * rate) + ", 0.0]\nangular_velocity = " + number(rate) +
                            "\n[[element]]\nkind = \"weld\"\nname = \"weld\"\na = \"tip\"\nb = \"rod\"\n";
    const Run welded = run(k_no_gravity + rod.substr(0, rod.find("[[element]]")) + stop + number(k) + "\nrestitution = " + number(e) +
                               "\n" + rod.substr(rod.find("[[element]]")) + tip,
                           {"dop853", 1e-11, 1e-3 / rate + 4.0 * std::sqrt(all / k)});
    CHECK(welded.last("rod.omega") / rate == doctest::Approx(-e).epsilon(1e-6));
  }
}

TEST_CASE("a contact of a body on a slanted guide has the mass that the guide leaves") {
  // Along the floor's normal the ball of mass m on a guide at the angle φ has m/sin² φ; it parts with e of its speed along the guide.
  for (const double angle : {0.3, 0.8, 1.4}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Run r = run(
        k_no_gravity + body("ball", 2.0, 1.0, 0.0, 1e-3, -c, -s) +
            "[[element]]\nkind = \"unilateral_contact\"\nname = \"floor\"\na = \"ball\"\ngap = 1e-3\nstiffness = 1e7\nrestitution = 0.4\n"
            "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"ball\"\naxis = [" +
            number(c) + ", " + number(s) + "]\n",
        {"dop853", 1e-11, 1e-3 / s + 4.0 * std::sqrt(2.0 / (s * s) / 1e7)});
    CHECK(r.last("ball.vy") == doctest::Approx(0.4 * s).epsilon(1e-6));
  }
}

TEST_CASE("the stiffer the floor, the nearer the heights of a bouncing ball come to e²: the weight counts less") {
  double before = 1.0;
  for (const double stiffness : {1e5, 1e7, 1e9}) {
    const Run r = run(body("ball", 1.0, 1.0, 0.0, 1.0, 0.0, 0.0) +
                          "[[element]]\nkind = \"unilateral_contact\"\nname = \"floor\"\na = \"ball\"\nstiffness = " + number(stiffness) +
                          "\nrestitution = 0.7\n",
                      {"dop853", 1e-12, 1.2});
    const std::vector<double> closes = r.event_times("floor", "closes"), opens = r.event_times("floor", "opens");
    REQUIRE(closes.size() >= 2);
    const double first = std::sqrt(2.0 / 9.81), flight = closes[1] - closes[0], error = std::abs(flight / (2.0 * first) - 0.7);
    CHECK(error < 0.2 * before);
    before = error;
  }
}

// Without a damper the stop's force is the stiffness times what is beyond it, whatever the reference pose and the markers' angles.
TEST_CASE("the channel of a stop counts from where its stops do") {
  struct Case {
    const char *coordinate, *force;
    double upper, start;
  };
  for (const Case& c : {Case{"angle", "couple", 0.3, 0.0}, Case{"x", "force", 0.2, 0.0}, Case{"y", "force", 0.1, 0.0},
                        Case{"distance", "force", 1.0, 0.9}}) {
    CAPTURE(std::string(c.coordinate));
    const std::string free =
        k_no_gravity +
        "[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 0.1\nposition = [0.54, 0.72]\nangle = 0.5\nvelocity = [0.6, 0.8]\n"
        "angular_velocity = 2.0\n[[element]]\nkind = \"limit\"\nname = \"stop\"\na = \"b\"\ncoordinate = \"" +
        std::string(c.coordinate) + "\"\nstiffness = 1e4\nupper = " + number(c.upper) + "\n";
    for (const std::string b : {"b = \"ground\"\n", "b = { body = \"ground\", angle = 0.2 }\n"}) {
      const Run r = run(free + b, {"dop853", 1e-10, 0.6, 0.001});
      const auto value = r.series("stop.value"), force = r.series(std::string("stop.") + c.force);
      CHECK(value.front() == doctest::Approx(c.start).epsilon(1e-12));
      int pressed = 0;
      for (std::size_t i = 0; i < value.size(); ++i) {
        CHECK(force[i] == doctest::Approx(-1e4 * std::max(0.0, value[i] - c.upper)).epsilon(1e-9));
        pressed += force[i] < -1.0;
      }
      CHECK(pressed > 5);
    }
  }
}

TEST_CASE("what cannot be is refused") {
  const auto text = [](const std::string& fields) {
    return body("ball", 1.0, 1.0, 0.0, 0.0, 0.0, 0.0) +
           "[[element]]\nkind = \"unilateral_contact\"\nname = \"floor\"\na = \"ball\"\nstiffness = 1e5\n" + fields +
           "[simulation]\nstep = 1e-3\n";
  };
  CHECK_THROWS_AS((void)scene(text("restitution = 0.0\n")), ModelError);
  CHECK_THROWS_AS((void)scene(text("restitution = 1.01\n")), ModelError);
  CHECK_THROWS_AS((void)compile(scene(text("restitution = 0.5\ndamping = 3.0\n"))), ModelError);
  CHECK_THROWS_AS((void)compile(scene(text("restitution = 0.5\nlaw = \"literal\"\n"))), ModelError);
  const std::string guide = "[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"ball\"\naxis = [1.0, 0.0]\n";
  CHECK_THROWS_AS((void)compile(scene(text("restitution = 0.5\n" + guide))), ModelError); // nothing moves along the normal
}

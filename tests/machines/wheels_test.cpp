// Machines on wheels of models/machines against closed forms and integrations of their own: a drawbar train from above, a car that brakes, a wheelie.
#include "tests/machines/machine.h"
#include "tests/machines/two_axles.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = std::numbers::pi, k_degree = k_pi / 180.0, k_g = 9.81;

// --- three angles of what follows the front axle, each drawn by the point before it

struct Train {
  double speed = 5.0, aside = 1.0;
  std::array<double, 3> angle{0.0, 40.0 * k_degree, 0.0}; // lorry, dolly, trailer

  [[nodiscard]] std::array<double, 3> rates(double t, const std::array<double, 3>& a) const {
    const double tau = t - 20.0, across = tau > 0.0 && tau < 7.0 ? 0.5 * aside * (1.0 - std::cos(2.0 * k_pi * tau / 7.0)) : 0.0;
    double vx = speed, vy = across;
    std::array<double, 3> d{};
    constexpr std::array<double, 3> axle{4.5, 3.0, 5.0}, next{6.0, 3.0, 5.0}; // from the front: the axle, the point that draws what follows
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = (-std::sin(a[i]) * vx + std::cos(a[i]) * vy) / axle[i];
      vx += next[i] * d[i] * std::sin(a[i]);
      vy -= next[i] * d[i] * std::cos(a[i]);
    }
    return d;
  }
  void step(double t, double h) {
    const auto moved = [&](const std::array<double, 3>& d, double by) {
      std::array<double, 3> a = angle;
      for (std::size_t i = 0; i < 3; ++i) a[i] += by * d[i];
      return a;
    };
    const auto a = rates(t, angle), b = rates(t + 0.5 * h, moved(a, 0.5 * h)), c = rates(t + 0.5 * h, moved(b, 0.5 * h)),
               d = rates(t + h, moved(c, h));
    for (std::size_t i = 0; i < 3; ++i) angle[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
};

// --- the vehicles of the two files

// As the files have it, in their order.
struct OwnTyre {
  double stiffness, damping, friction, slip_stiffness, relaxation, tread;
};

TwoAxles vehicle(double mass, double inertia, double height, const OwnTyre& tyre, const std::array<OwnWheel, 2>& wheels) {
  TwoAxles v;
  v.mass = mass;
  v.inertia = inertia;
  v.state[1] = height;
  v.stiffness = tyre.stiffness;
  v.damping = tyre.damping;
  v.friction = tyre.friction;
  v.slip_stiffness = tyre.slip_stiffness;
  v.relaxation = tyre.relaxation;
  v.tread = tyre.tread;
  v.wheel = wheels;
  return v;
}

TwoAxles car() {
  TwoAxles v = vehicle(1000.0, 1500.0, 0.5, {3e5, 4e3, 0.9, 8e4, 0.3, 3000.0},
                       {OwnWheel{1.1, -0.2, 40.0, 2.0, 1400.0}, OwnWheel{-1.4, -0.2, 40.0, 2.0, 1200.0}});
  v.drive = [](double t, double) { return t < 4.0 ? 1200.0 : 0.0; };
  v.pressure = [](double t) { return std::clamp((t - 5.0) / 0.2, 0.0, 1.0); };
  return v;
}

TwoAxles bike() {
  TwoAxles v = vehicle(250.0, 30.0, 0.65, {1.5e5, 3000.0, 1.2, 3e4, 0.2, 200.0},
                       {OwnWheel{0.75, -0.35, 12.0, 0.6, 0.0}, OwnWheel{-0.65, -0.35, 15.0, 0.8, 0.0}});
  v.road = OwnSpline({{-3, 0},     {2, 0},       {4, 0.02},     {6, -0.015}, {8.5, 0.03}, {11.5, 0},      {15, 0.025},
                      {17, -0.02}, {19.5, 0.01}, {22.5, 0.03},  {26, -0.01}, {28, 0.02},  {30.5, -0.025}, {33.5, 0.015},
                      {37, 0},     {39, 0.03},   {41.5, -0.01}, {44.5, 0},   {48, 0},     {50, 0}});
  v.drive = [](double t, double lean) { return 900.0 * std::min(1.0, t / 2.5) * (1.0 - lean / (20.0 * k_degree)); };
  return v;
}

// The other way is of the first order where a brake or a tread changes what it does: steps of 20 µs.
void follow(const MachineRun& r, TwoAxles v, const std::string& frame, double end, double close) {
  constexpr double h = 2e-5, every = 0.1;
  double next = 0.0;
  for (long n = 0; static_cast<double>(n) * h < end - 0.5 * h; ++n) {
    const double t = static_cast<double>(n) * h;
    if (t >= next - 0.5 * h) {
      CAPTURE(t);
      CHECK(std::abs(r.at(frame + ".x", t) - v.state[0]) < close);
      CHECK(std::abs(r.at(frame + ".y", t) - v.state[1]) < close);
      CHECK(std::abs(r.at(frame + ".theta", t) - v.state[2]) < close);
      CHECK(std::abs(r.at(frame + ".vx", t) - v.state[3]) < close);
      CHECK(std::abs(r.at("rear.omega", t) - v.state[7]) < 10.0 * close);
      next += every;
    }
    v.step(t, h);
  }
}

} // namespace

TEST_CASE("a drawbar train follows the front of its lorry as tractrices do") {
  const MachineRun r("drawbar_train");
  REQUIRE(r.is_complete());
  constexpr double h = 1e-3; // of the fourth order
  Train train;
  for (int n = 0; n < 40000; ++n) {
    const double t = n * h;
    if (n % 500 == 0) {
      CAPTURE(t);
      CHECK(std::abs(r.at("lorry.theta", t) - train.angle[0]) < 1e-7);
      CHECK(std::abs(r.at("dolly.theta", t) - train.angle[1]) < 1e-7);
      CHECK(std::abs(r.at("trailer.theta", t) - train.angle[2]) < 1e-7);
      // Drawn straight on: the angle of a tractrix.
      if (t < 20.0) CHECK(std::abs(std::tan(0.5 * r.at("dolly.theta", t)) - std::tan(20.0 * k_degree) * std::exp(-5.0 * t / 3.0)) < 1e-7);
    }
    train.step(t, h);
  }
  CHECK(std::abs(r.last("lorry.y") - 3.5) < 0.01); // half of 1 m/s for 7 s: the next lane
  CHECK(std::abs(r.last("trailer.y") - 3.5) < 0.01);
}

TEST_CASE("a drawbar train that is backed jack-knifes") {
  const MachineRun r("drawbar_train",
                     {"parameters.speed=-1 m/s", "parameters.turned=1 deg", "parameters.aside=0 m/s", "simulation.end=14"});
  REQUIRE(r.is_complete());
  for (double t = 0.0; t <= 14.0; t += 0.5) // errors grow as the angle does, a hundredfold
    CHECK(std::tan(0.5 * r.at("dolly.theta", t)) == doctest::Approx(std::tan(0.5 * k_degree) * std::exp(t / 3.0)).epsilon(1e-6));
  CHECK(r.last("dolly.theta") > 80.0 * k_degree);
}

TEST_CASE("a car pulls away and brakes as its equations say, and its rear wheels lock") {
  const MachineRun r("braking_car");
  REQUIRE(r.is_complete());
  follow(r, car(), "car", 9.0, 5e-3);
  CHECK(r.events("rear brake", EventKind::sticks).size() == 1); // locked, and so at rest
  REQUIRE(!r.events("rear tyre", EventKind::slips_forward).empty());
  CHECK(r.events("front tyre", EventKind::slips_forward).empty());
  CHECK(std::abs(r.last("car.vx")) < 0.01); // what is left of the swing on its bristles, e^-5 of 0.5 m/s
  CHECK(r.run.result.statistics.energy_residual < 1e-6 * r.run.result.statistics.energy_exchanged);

  // Braking steadily, by d'Alembert about the front wheel's foot; the frame dives by some millimetres.
  const double t = 6.8, deceleration = -(r.at("car.vx", t + 0.1) - r.at("car.vx", t - 0.1)) / 0.2, total = 1080.0;
  // The treads' forces act a radius below the wheels' centres, of which the front one is lower.
  const double front = r.at("front.y", t), rear = r.at("rear.y", t), foot = front - 0.3, drag = -r.at("rear tyre.friction", t);
  const double inert = 1000.0 * (r.at("car.y", t) - foot) + 40.0 * (front - foot) + 40.0 * (rear - foot) + 2.0 / 0.3;
  const double load = (1.1 * 1000.0 * k_g + 2.5 * 40.0 * k_g - deceleration * inert + drag * (rear - front)) / 2.5;
  CHECK(r.at("rear tyre.mode", t) == 2.0);
  CHECK(r.at("rear tyre.force", t) == doctest::Approx(load).epsilon(3e-3)); // a dive of half a degree
  CHECK(r.at("front tyre.force", t) == doctest::Approx(total * k_g - load).epsilon(3e-3));
}

TEST_CASE("with all wheels locked the car stops by μ g") {
  const MachineRun r("braking_car", {"parameters.front=6000 N m", "parameters.rear=6000 N m"});
  REQUIRE(r.is_complete());
  const double locked = std::max(r.events("front brake", EventKind::sticks).front(), r.events("rear brake", EventKind::sticks).front());
  const double from = std::ceil(locked / 0.02) * 0.02, speed = r.at("car.vx", from), rests = from + speed / (0.9 * k_g);
  // The frame dives and swings as it brakes, and presses by more and less than its weight.
  for (double t = from + 0.2; t < rests - 0.1; t += 0.1) CHECK(std::abs(r.at("car.vx", t) - speed + 0.9 * k_g * (t - from)) < 0.05);
  CHECK(std::abs(r.last("car.x") - r.at("car.x", from) - speed * speed / (2.0 * 0.9 * k_g)) < 0.1);
  CHECK(r.last("front tyre.mode") == 1.0); // at rest it holds
}

TEST_CASE("a motorcycle on a rough road lifts its front wheel") {
  const MachineRun r("wheelie");
  REQUIRE(r.is_complete());
  const std::vector<double> lifts = r.events("front tyre", EventKind::opens);
  REQUIRE(!lifts.empty());
  follow(r, bike(), "bike", 5.0, 2e-3);
  CHECK(r.last("front tyre.gap") > 0.02);
}

TEST_CASE("on a level road a front wheel lifts where the acceleration is g b/h") {
  const std::string flat = "=[[-3.0, 0.0], [50.0, 0.0]]";
  const MachineRun r("wheelie", {"element.front tyre.road" + flat, "element.rear tyre.road" + flat, "output.step=0.001"});
  REQUIRE(r.is_complete());
  // Of all masses about the rear wheel's foot, with the wheels' spin; the springs under it swing a little, and the load grows.
  const double lifts = r.events("front tyre", EventKind::opens).back(),
               a = (r.at("bike.vx", lifts + 0.005) - r.at("bike.vx", lifts - 0.005)) / 0.01;
  const double weights = (250.0 * 0.65 + 12.0 * 1.4) * k_g,
               way = 250.0 * r.at("bike.y", lifts) + 12.0 * r.at("front.y", lifts) + 15.0 * r.at("rear.y", lifts) + (0.6 + 0.8) / 0.3;
  CHECK(a == doctest::Approx(weights / way).epsilon(0.02));
}

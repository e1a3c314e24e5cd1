// Roads, random vibrations and the sea: continuity, seeds, axles behind each other, the lever-arm formula, and what is refused.
#include "elements/catalog.h"
#include "mbd/io/reader.h"
#include "mbd/model/signal_algebra.h"
#include "mbd/model/signal_network.h"
#include "mbd/simulation/simulation.h"
#include "tests/mbd/made_signal.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = std::numbers::pi;

Signal road(long seed, double speed = 40.0 / 3.6, const std::string& letter = "C") {
  return made_signal("road", {{"class", letter}, {"speed", speed}, {"seed", seed}});
}
Signal vibration(long seed) {
  return made_signal("random", {{"frequencies", std::vector<double>{2.0, 20.0, 80.0}},
                                {"densities", std::vector<double>{0.01, 0.1, 0.02}},
                                {"duration", 6.0},
                                {"seed", seed}});
}
Signal sea(const std::string& component, const FieldValues& more = {}) {
  FieldValues values{{"component", component}, {"place", Vec2(14.0, 9.0)}, {"heave_phase", 0.4}, {"heave_period", 8.0}};
  values.insert(values.end(), more.begin(), more.end());
  return made_signal("sea", values);
}

// Of the signal 's' with these fields, as the height of a body, or as its acceleration if it is one.
std::string problem_of(const std::string& fields) {
  const bool is_height = fields.find("\"road\"") != std::string::npos;
  try {
    const Model model =
        parse_model("[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"prescribed_motion\"\nname = \"p\"\n"
                    "a = \"b\"\ncoordinate = \"y\"\nsignal = \"s\"\nas = \"" +
                        std::string(is_height ? "position" : "acceleration") + "\"\n[[signal]]\nname = \"s\"\n" + fields,
                    "scene.toml", element_catalog());
    static_cast<void>(compile(model));
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

std::uint64_t digest(const Signal& signal) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  const auto add = [&](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001B3ULL; };
  for (const double t : {0.3, 1.7, 2.9, 5.99})
    for (const DriveLevel level : {DriveLevel::position, DriveLevel::acceleration}) {
      const SignalJet jet = signal.drive(t, level);
      add(jet.value);
      add(jet.rate);
      add(jet.acceleration);
    }
  return hash;
}

} // namespace

TEST_CASE("loads begin with nothing, go on without jumps, and their derivatives are those of their values") {
  const std::pair<const char*, Signal> signals[] = {
      {"road", road(3)}, {"random", vibration(3)}, {"sea", sea("x")}, {"heave", sea("height")}};
  for (const auto& [name, signal] : signals) {
    CAPTURE(name);
    CHECK(std::abs(signal.value(0.0)) < 1e-12);
    CHECK(std::abs(signal.drive(0.0, DriveLevel::position).rate) < 1e-10);
    CHECK_FALSE(signal.first_jump(DriveLevel::position, -1.0, 1e3));
    double size = 0.0;
    for (double t = 0.01; t < 6.0; t += 0.173) size = std::max(size, std::abs(signal.value(t)));
    for (double t = 0.01; t < 6.0; t += 0.173) {
      constexpr double h = 2e-5;
      const SignalJet jet = signal.drive(t, DriveLevel::position);
      const double before = signal.value(t - h), at = signal.value(t), after = signal.value(t + h);
      // Errors of the differences: rates and accelerations of waves of 503 rad/s times (ω h)²/6 = 2e-5, and rounding.
      const double fastest = signal.fastest_at(t);
      const SignalJet early = signal.drive(t - h, DriveLevel::acceleration), late = signal.drive(t + h, DriveLevel::acceleration);
      CHECK(std::abs((late.rate - early.rate) / (2 * h) - at) < 1e-4 * size);
      CHECK(std::abs((late.value - early.value) / (2 * h) - signal.drive(t, DriveLevel::velocity).value) < 1e-6 * size);
      CHECK(std::abs(jet.rate - (after - before) / (2 * h)) < 1e-4 * size * fastest);
      CHECK(std::abs(jet.acceleration - (after - 2 * at + before) / (h * h)) < 1e-4 * size * fastest * fastest + 1e-4 * size);
    }
  }
}

TEST_CASE("many harmonics at once have the bits of one after the other") {
  const Signal whole = road(7);
  std::vector<Signal::Piece> pieces = whole.pieces();
  double sum = 0.0, rate = 0.0;
  const double t = 17.3;
  for (const Signal::Harmonic& h : pieces.back().harmonics) {
    Signal::Piece one = pieces.back();
    one.harmonics = {h};
    const SignalJet jet = Signal({one}).drive(t, DriveLevel::position);
    sum += Signal({one}).value(t);
    rate += jet.rate;
  }
  CHECK(whole.value(t) == sum);
  CHECK(whole.drive(t, DriveLevel::position).rate == rate);
  CHECK(whole.drive(t, DriveLevel::velocity).acceleration == rate);
}

// A change here changes every run with such a load: seeds that users have noted would no longer mean what they meant.
TEST_CASE("a seed means the same signal on every machine, and another seed another one") {
  CHECK(digest(road(1)) == 17807153790366046443ULL);
  CHECK(digest(vibration(1)) == 3142371196550074735ULL);
  CHECK(digest(sea("x")) == 7446854983053314027ULL);
  CHECK(digest(road(1)) != digest(road(2)));
  CHECK(digest(vibration(1)) != digest(vibration(2)));
}

TEST_CASE("a bump may lie on a rough road, and a vibration may have an envelope of its own") {
  const Signal rough = road(1), bump = made_signal("haversine", {{"peak", 0.04}, {"start", 1.0}, {"duration", 0.3}}),
               vibrating = vibration(1);
  const Signal both = sum_of({&rough, &bump}, {1.0, 1.0}), shaped = product_of({&vibrating, &bump});
  for (double t = 0.03; t < 3.0; t += 0.17) { // phases are counted from another start: of sines of 1e3 rad
    CHECK(std::abs(both.value(t) - rough.value(t) - bump.value(t)) < 1e-13);
    CHECK(std::abs(shaped.value(t) - vibrating.value(t) * bump.value(t)) < 1e-12);
  }
}

TEST_CASE("a road belongs to places: another speed passes the same one, another class scales it") {
  const Signal slow = road(5, 3.0), fast = road(5, 12.0), rough = road(5, 3.0, "E");
  for (double x = 5.0; x < 300.0; x += 7.3) { // 1e-12: of sines of 1e4 rad
    CHECK(std::abs(slow.value(x / 3.0) - fast.value(x / 12.0)) < 1e-12);
    CHECK(std::abs(rough.value(x / 3.0) - 4.0 * slow.value(x / 3.0)) < 1e-12);
  }
}

TEST_CASE("axles see one road, each when it gets there, at the speed of the road") {
  const std::string text = "[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\n[[signal]]\nkind = \"road\"\nname = "
                           "\"front\"\nclass = \"C\"\nspeed = \"40 km/h\"\n"
                           "[[signal]]\nkind = \"scaled\"\nname = \"rear\"\nsignal = \"front\"\nbehind = 7.0\n"
                           "[[signal]]\nkind = \"scaled\"\nname = \"last\"\nsignal = \"rear\"\nbehind = 2.0\n";
  const Model model = parse_model(text, "scene.toml", element_catalog());
  SignalNetwork network(model);
  const Signal &front = *network.build("front"), &rear = *network.build("rear"), &last = *network.build("last");
  const double v = 40.0 / 3.6;
  for (double t = 0.0; t < 30.0; t += 0.37) {
    CHECK(std::abs(rear.value(t) - front.value(t - 7.0 / v)) < 1e-13);
    CHECK(std::abs(last.value(t) - front.value(t - 9.0 / v)) < 1e-13);
  }
  double best = -1.0, lag_of_best = 0.0;
  for (double lag = 0.5; lag < 0.75; lag += 0.01) {
    double product = 0.0;
    for (double t = 5.0; t < 40.0; t += 0.05) // of rates, whose correlation is narrow
      product += front.drive(t, DriveLevel::position).rate * rear.drive(t + lag, DriveLevel::position).rate;
    if (product > best) best = product, lag_of_best = lag;
  }
  CHECK(std::abs(lag_of_best - 7.0 / v) < 0.01);
}

TEST_CASE("a way behind without a speed, and one at another speed than the road's, are refused") {
  const std::string on_road = "[[signal]]\nkind = \"road\"\nname = \"r\"\nclass = \"C\"\nspeed = 10.0\n";
  CHECK(problem_of("kind = \"scaled\"\nsignal = \"r\"\nbehind = 7.0\n" + on_road) == "");
  CHECK(problem_of("kind = \"scaled\"\nsignal = \"r\"\nbehind = 7.0\nspeed = 11.0\n" + on_road).find("leave it out") != std::string::npos);
  const std::string still = "[[signal]]\nkind = \"constant\"\nname = \"c\"\nvalue = 1.0\n";
  CHECK(problem_of("kind = \"scaled\"\nsignal = \"c\"\nbehind = 7.0\n" + still).find("needs a speed") != std::string::npos);
}

// The place is at (0, h) + R(θ) r in axes that stand still; what it feels, in the vessel's axes, is its acceleration less
// gravity's.
TEST_CASE("accelerations at sea are those of the place that angle and heave move") {
  const double g = 9.81;
  const Vec2 place(14.0, 9.0);
  const Signal angle = sea("angle"), height = sea("height"), x = sea("x"), y = sea("y");
  for (double t = 10.5; t < 60.0; t += 0.77) { // grown after 10 s
    const SignalJet theta = angle.drive(t, DriveLevel::position);
    const double c = std::cos(theta.value), s = std::sin(theta.value);
    const Vec2 r(c * place.x() - s * place.y(), s * place.x() + c * place.y());
    const Vec2 a = theta.acceleration * Vec2(-r.y(), r.x()) - theta.rate * theta.rate * r +
                   Vec2(0.0, height.drive(t, DriveLevel::position).acceleration + g);
    CHECK(x.value(t) == doctest::Approx(c * a.x() + s * a.y()).epsilon(1e-11));
    CHECK(y.value(t) + g == doctest::Approx(-s * a.x() + c * a.y()).epsilon(1e-11));
  }
}

// At the largest angle: g sin θ + Y Θ ω² + H sin θ, the formula of marine practice.
TEST_CASE("the largest acceleration of the default roll is that of the lever-arm formula") {
  const double roll = 20.0 * k_pi / 180.0, omega = 2.0 * k_pi / 10.0, heave = 0.2 * 9.80665;
  const Signal x = made_signal("sea", {{"component", std::string("x")}, {"place", Vec2(0.0, 9.0)}});
  CHECK(x.value(12.5) == doctest::Approx((9.81 + heave) * std::sin(roll) + 9.0 * roll * omega * omega).epsilon(1e-12));
  CHECK(roll * omega * omega == doctest::Approx(0.14).epsilon(0.02)); // rad/s², as the guideline has it
  const Signal pitch = made_signal("sea", {{"component", std::string("angle")}, {"motion", std::string("pitch")}});
  CHECK(pitch.value(12.5) == doctest::Approx(12.5 * k_pi / 180.0).epsilon(1e-12));
}

TEST_CASE("what is no load is refused once, with what to do") {
  const std::string table = "kind = \"random\"\nduration = 5.0\n";
  const std::pair<std::string, std::string> cases[] = {
      {"kind = \"road\"\nclass = \"C\"\nspeed = -3.0\n", "speed"},
      {"kind = \"road\"\nclass = \"C\"\nspeed = nan\n", "speed"},
      {"kind = \"road\"\nspeed = 3.0\n", "needs 'class'"},
      {"kind = \"road\"\nclass = \"C\"\nroughness = 1e-4\nspeed = 3.0\n", "not both"},
      {"kind = \"road\"\nclass = \"K\"\nspeed = 3.0\n", "must be one of"},
      {"kind = \"road\"\nclass = \"C\"\nspeed = 3.0\nfrom = 0.5\nto = 0.5\n", "is empty"},
      {"kind = \"road\"\nclass = \"C\"\nspeed = 3.0\nseed = -1\n", "seed"},
      {table + "frequencies = [1.0, 2.0, 2.0]\ndensities = [1.0, 1.0, 1.0]\n", "ascend, got 2 and then 2"},
      {table + "frequencies = [0.0, 2.0]\ndensities = [1.0, 1.0]\n", "greater than 0"},
      {table + "frequencies = [1.0, 2.0]\ndensities = [1.0, 0.0]\n", "'densities' must be greater than 0"},
      {table + "frequencies = [1.0, 2.0]\ndensities = [1.0]\n", "equally many"},
      {table + "frequencies = [1.0, 2.0]\ndensities = [1.0, nan]\n", "densities"},
      {table + "frequencies = [1.0, 2.0]\ndensities = [1.0, 1.0]\nrise = 3.0\nfall = 3.0\n", "more than 'duration'"},
      {table + "frequencies = [1e-300, 1e300]\ndensities = [1.0, 1.0]\n", "1e+06 times"},
      {"kind = \"road\"\nclass = \"C\"\nspeed = 3.0\nfrom = 1e-300\n", "1e+06 times"},
      {"kind = \"road\"\nroughness = 1e300\nexponent = 10.0\nspeed = 3.0\n", "finite"},
      {"kind = \"sea\"\n", "component"},
      {"kind = \"sea\"\ncomponent = \"x\"\nperiod = 0.0\n", "period"},
      {"kind = \"sea\"\ncomponent = \"x\"\nangle = \"80 deg\"\n", "angle"},
  };
  for (const auto& [fields, wanted] : cases) {
    CAPTURE(fields);
    const std::string problem = problem_of(fields);
    CAPTURE(problem);
    CHECK(problem.find(wanted) != std::string::npos);
    CHECK(problem.find("scene.toml:") != std::string::npos);
    CHECK(problem.find('\n') == std::string::npos);
  }
}

// A road that is taken for an acceleration would be a load of nothing, and nobody would see it.
TEST_CASE("a load is refused where its unit is another one") {
  const auto problem_as = [](const std::string& fields, const std::string& coordinate, const std::string& as) {
    try {
      static_cast<void>(parse_model("[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = "
                                    "\"prescribed_motion\"\nname = \"p\"\na = \"b\"\n"
                                    "signal = \"s\"\ncoordinate = \"" +
                                        coordinate + "\"\nas = \"" + as + "\"\n[[signal]]\nname = \"s\"\n" + fields,
                                    "scene.toml", element_catalog()));
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string a_road = "kind = \"road\"\nclass = \"C\"\nspeed = 3.0\n", a_sea = "kind = \"sea\"\ncomponent = ";
  CHECK(problem_as(a_road, "y", "position") == "");
  CHECK(problem_as(a_road, "y", "acceleration").find("is in m") != std::string::npos);
  CHECK(problem_as(a_road, "angle", "position").find("is in m") != std::string::npos);
  CHECK(problem_as(a_sea + "\"angle\"\n", "angle", "position") == "");
  CHECK(problem_as(a_sea + "\"angle\"\n", "y", "position").find("is in rad") != std::string::npos);
  CHECK(problem_as(a_sea + "\"height\"\n", "y", "position") == "");
  CHECK(problem_as(a_sea + "\"x\"\n", "x", "acceleration") == "");
  CHECK(problem_as(a_sea + "\"x\"\n", "x", "position").find("is in m/s^2") != std::string::npos);
}

namespace {

// A quarter of a vehicle on a road of class C.
const std::string k_quarter = R"([[body]]
name = "body"
mass = 1000.0
inertia = 1.0
position = [0.0, 1.0]
[[body]]
name = "road"
mass = 1.0
inertia = 1.0
[[signal]]
kind = "road"
name = "rough"
class = "C"
speed = 11.0
[[element]]
kind = "prescribed_motion"
name = "height"
a = "road"
coordinate = "y"
signal = "rough"
as = "position"
[[element]]
kind = "spring_damper"
name = "spring"
a = "body"
b = "road"
axis = [0.0, 1.0]
stiffness = 9e4
damping = 3e3
preload = 9810.0
)";

double height_at_end(const std::string& integrator, double step, double tolerance) {
  const Model model = parse_model(k_quarter, "scene.toml", element_catalog());
  const auto system = compile(model);
  SimulationOptions o;
  o.end = 3.0; // behind the end of the run-in, a breakpoint
  o.integrator = integrator;
  o.settings.step = step;
  if (tolerance == 0.0) o.settings.max_step = step;
  o.settings.tolerance = tolerance > 0.0 ? tolerance : 1e30;
  return simulate(*system, system->initial_state(), o).final_state.q[4];
}

} // namespace

TEST_CASE("methods converge with their orders on a road") {
  const double exact = height_at_end("dop853", 1e-4, 0.0);
  struct Case {
    const char* integrator;
    double order, coarse;
  };
  for (const Case& c : {Case{"rk4", 4.0, 1e-3}, Case{"tsit5", 5.0, 7e-3}}) {
    CAPTURE(std::string(c.integrator));
    const double coarse = std::abs(height_at_end(c.integrator, c.coarse, 0.0) - exact),
                 fine = std::abs(height_at_end(c.integrator, 0.5 * c.coarse, 0.0) - exact);
    CAPTURE(fine);
    CHECK(fine > 1e-15);
    CHECK(std::log2(coarse / fine) > c.order - 0.5); // tsit5 comes nearer by its next order: the road is nearly all that it integrates
  }
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) CHECK(std::abs(height_at_end("dop853", 1e-3, tolerance) - exact) < 10.0 * tolerance);
}

// Friction that holds what is held anyway: several frictions of one rigid pair, friction across a guide, welded bodies with kinks
// between them. Each scene is run beside the same one with the redundancy taken out by hand: the motion is the same, and the
// number of steps is that of the motion.
#include "mbd/rest/equilibrium.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

class Random {
public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0); }
  double power(double low, double high) { return std::pow(10.0, between(low, high)); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

private:
  std::mt19937 engine_;
};

std::ostringstream precise() {
  std::ostringstream out;
  out.precision(17);
  return out;
}

const Settings k_methods[] = {{"dop853", 1e-8}, {"tsit5", 1e-8}, {"rodas5p", 1e-8}, {"auto", 1e-9}, {"dop853", 1e-10}};

// Events restart a method: each costs a few steps of its own.
void check_cost(const Run& with, const Run& without) {
  const long events = with.result.statistics.events - without.result.statistics.events;
  CHECK(with.result.statistics.steps <= 2 * without.result.statistics.steps + 12 * std::max(events, 0L) + 20);
}

// A mass falls along a guide onto an undamped floor, on which it rubs across the guide. `lean`: of the guide from the floor's
// normal, by which it may rub along. With its floor turned by `turn`.
struct Guided {
  double mass, frequency, lean, turn, drop, friction;

  [[nodiscard]] std::string text(bool rubs) const {
    std::ostringstream out = precise();
    const Vec2 up(std::cos(turn), std::sin(turn));
    const double g = 9.81;
    out << "gravity = [" << -g * up.x() << ", " << -g * up.y() << "]\n[[body]]\nname = \"mass\"\nmass = " << mass << "\ninertia = " << mass
        << "\nposition = [" << drop * up.x() << ", " << drop * up.y()
        << "]\n[[marker]]\nname = \"way\"\nbody = \"ground\"\nangle = " << turn + lean
        << "\n[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = { body = \"mass\", at = [0.0, 0.0] }\nb = \"way\"\n"
        << "[[element]]\nkind = \"unilateral_contact\"\nname = \"floor\"\na = \"mass\"\nnormal = [" << up.x() << ", " << up.y()
        << "]\ngap = " << drop << "\nstiffness = " << mass * frequency * frequency << "\n";
    if (rubs)
      out << "[[element]]\nkind = \"coulomb_stick\"\nname = \"rubs\"\ncontacts = [\"floor\"]\nstatic_friction = " << friction << "\n";
    out << "[simulation]\nstep = 1e-3\n";
    return out.str();
  }
};

// A slide on springy feet that press it against its guide is shaken along it; each foot rubs by itself, or all together.
struct ShakenSlide {
  double mass, frequency, shake, turn;
  std::vector<double> preload, coefficient;
  bool is_damped;

  [[nodiscard]] std::string text(bool is_single) const {
    std::ostringstream out = precise();
    out << "gravity = [0.0, 0.0]\n[[body]]\nname = \"mass\"\nmass = " << mass << "\ninertia = " << mass
        << "\n[[marker]]\nname = \"way\"\nbody = \"ground\"\nangle = " << turn
        << "\n[[signal]]\nname = \"shake\"\nkind = \"harmonics\"\namplitudes = [" << shake << "]\nfrequencies = [" << frequency
        << "]\n[[element]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"mass\"\nb = \"way\"\n"
        << "[[marker]]\nname = \"along\"\nbody = \"mass\"\nangle = " << turn
        << "\n[[element]]\nkind = \"load\"\nname = \"push\"\nat = \"along\"\nframe = \"body\"\nforce_x = \"shake\"\n";
    double bound = 0.0, pressed = 0.0;
    std::string feet;
    for (std::size_t i = 0; i < preload.size(); ++i) {
      const double along = 0.1 * static_cast<double>(i);
      out << "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot" << i << "\"\na = { body = \"mass\", at = ["
          << along * std::cos(turn) << ", " << along * std::sin(turn) << "] }\nb = { body = \"ground\", at = [" << along * std::cos(turn)
          << ", " << along * std::sin(turn) << "] }\nnormal = [" << -std::sin(turn) << ", " << std::cos(turn)
          << "]\nstiffness = 1e6\npreload = " << preload[i] << (is_damped ? "\ndamping = 1e3\n" : "\n");
      bound += preload[i] * coefficient[i];
      pressed += preload[i];
      feet += (i == 0 ? "\"foot" : ", \"foot") + std::to_string(i) + "\"";
      if (!is_single)
        out << "[[element]]\nkind = \"coulomb_stick\"\nname = \"rub" << i << "\"\ncontacts = [\"foot" << i
            << "\"]\nstatic_friction = " << coefficient[i] << "\n";
    }
    if (is_single)
      out << "[[element]]\nkind = \"coulomb_stick\"\nname = \"rub\"\ncontacts = [" << feet << "]\nstatic_friction = " << bound / pressed
          << "\n";
    out << "[simulation]\nstep = 1e-3\n";
    return out.str();
  }
};

// Two bodies held to each other swing on a spring; between them a spring and damper by tables whose kinks lie where they are held.
std::string pair_of_bodies(Random& random, bool has_tables, int held_by) {
  std::ostringstream out = precise();
  const double x = random.between(-0.5, 0.5), y = random.between(-0.5, 0.5), far = random.below(3) == 0 ? 100.0 : 0.0;
  const auto at = [&](double px, double py) {
    std::ostringstream p = precise();
    p << "[" << px + far << ", " << py << "]";
    return p.str();
  };
  const auto ends = [&](double px, double py, double qx, double qy) {
    return "a = { body = \"rider\", at = " + at(px, py) + " }\nb = { body = \"carrier\", at = " + at(qx, qy) + " }\n";
  };
  out << "[[body]]\nname = \"carrier\"\nmass = " << random.power(0.0, 3.0) << "\ninertia = 20.0\nposition = " << at(0.0, 0.0)
      << "\nvelocity = [" << random.between(-2.0, 2.0)
      << ", 0.5]\nangular_velocity = 0.0\n[[body]]\nname = \"rider\"\nmass = " << random.power(0.0, 2.0)
      << "\ninertia = 5.0\nposition = " << at(x, y) << "\nvelocity = [0.0, 0.0]\n"
      << "[[element]]\nkind = \"bushing\"\nname = \"bed\"\na = { body = \"carrier\", at = " << at(0.1, -0.3)
      << " }\nb = { body = \"ground\", at = " << at(0.1, -0.3) << " }\nstiffness = [" << random.power(3.0, 6.0) << ", "
      << random.power(3.0, 6.0) << "]\n";
  if (held_by == 0) out << "[[element]]\nkind = \"weld\"\nname = \"hold\"\n" << ends(x, y, x, y);
  if (held_by == 1) // two pins: one row too many
    out << "[[element]]\nkind = \"revolute\"\nname = \"pin1\"\n"
        << ends(x, y, x, y) << "[[element]]\nkind = \"revolute\"\nname = \"pin2\"\n"
        << ends(x + 0.3, y - 0.2, x + 0.3, y - 0.2);
  if (held_by == 2)
    out << "[[element]]\nkind = \"revolute\"\nname = \"pin\"\n"
        << ends(x, y, x, y) << "[[element]]\nkind = \"distance\"\nname = \"rod\"\n"
        << ends(x + 0.3, y, x - 0.2, y - 0.4);
  if (has_tables) {
    const double kink = random.power(0.0, 4.0);
    out << "[[element]]\nkind = \"spring_damper\"\nname = \"kinked\"\n" << ends(x + 0.1, y + 0.2, x - 0.4, y - 0.1);
    if (random.below(2) == 0) out << "axis = [0.6, 0.8]\n";
    const int tables = 1 + random.below(3);
    if (tables != 2) out << "damping_table = [[-1.0, " << -kink << "], [0.0, 0.0], [1.0, " << 5.0 * kink << "]]\n";
    if (tables != 1) out << "force_table = [[-0.1, " << -kink << "], [0.0, 0.0], [0.1, " << 30.0 * kink << "]]\n";
  }
  out << "[simulation]\nstep = 1e-3\n";
  return out.str();
}

// A box on feet of several stiffnesses, each of which may rub by itself: it settles by tilting, and the distance of its feet along
// the floor is another then.
std::string box_on_feet(Random& random, int feet, bool rubs) {
  std::ostringstream out = precise();
  const double mass = random.power(0.0, 4.0), height = random.between(0.1, 1.0), sag = random.power(-5.0, -2.3);
  out << "[[body]]\nname = \"box\"\nmass = " << mass << "\ninertia = " << 0.1 * mass << "\nposition = [0.0, " << height << "]\n";
  std::ostringstream friction = precise();
  for (int k = 0; k < feet; ++k) {
    const double x = -0.5 + static_cast<double>(k) / (feet - 1) + (k == 0 || k == feet - 1 ? 0.0 : random.between(-0.1, 0.1));
    out << "[[element]]\nkind = \"unilateral_contact\"\nname = \"foot" << k << "\"\na = { body = \"box\", at = [" << x
        << ", 0.0] }\nstiffness = " << random.between(1.0, 5.0) * mass * 9.81 / sag << "\n";
    friction << "[[element]]\nkind = \"coulomb_stick\"\nname = \"rub" << k << "\"\ncontacts = [\"foot" << k
             << "\"]\nstatic_friction = " << random.between(0.2, 0.9) << "\n";
  }
  if (rubs) out << friction.str();
  out << "[simulation]\nstep = 1e-3\n";
  return out.str();
}

} // namespace

TEST_CASE("a box comes to rest on feet that rub each by itself") {
  for (int i = 0; i < 100; ++i) {
    Random first(5084U + static_cast<unsigned>(i)), again(5084U + static_cast<unsigned>(i));
    CAPTURE(i);
    const int feet = 2 + i % 4;
    const auto with = compile(scene(box_on_feet(first, feet, true))), without = compile(scene(box_on_feet(again, feet, false)));
    const State rest = find_equilibrium(*with, with->initial_state()).state,
                free = find_equilibrium(*without, without->initial_state()).state;
    CHECK(std::abs(rest.q[4] - free.q[4]) < 1e-9);
    CHECK(std::abs(rest.q[5] - free.q[5]) < 1e-9);
  }
}

TEST_CASE("friction across a guide changes nothing, however nearly across it is") {
  Random random(5380);
  for (int i = 0; i < 200; ++i) {
    Guided g{random.power(-1.0, 3.0),   random.power(1.5, 4.0),   0.0,
             random.between(-3.0, 3.0), random.power(-2.5, -1.0), random.between(0.05, 0.8)};
    g.lean = random.below(5) == 0 ? 0.0 : (random.below(2) == 0 ? 1.0 : -1.0) * random.power(-16.0, -6.0);
    if (random.below(3) == 0) g.turn = 0.5 * std::numbers::pi; // where nothing but the lean is rounded
    Settings s = k_methods[i % 5];
    const double fall = std::sqrt(2.0 * g.drop / 9.81);
    s.end = 5.3 * fall;
    CAPTURE(i);
    CAPTURE(g.lean);
    CAPTURE(g.frequency);
    CAPTURE(s.integrator);
    const Run with = run(scene(g.text(true)), s), without = run(scene(g.text(false)), s);
    const double size = g.drop * (1e-7 + 100.0 * std::abs(g.lean) * g.friction);
    CHECK(std::abs(with.last("mass.x") - without.last("mass.x")) < size);
    CHECK(std::abs(with.last("mass.y") - without.last("mass.y")) < size);
    CHECK(with.result.statistics.dissipated >= -1e-10 * with.result.statistics.energy_exchanged);
    check_cost(with, without);
  }
}

namespace {

// A common friction may take its place from one foot to another, too.
long slips_and_rests(const Run& r) {
  return std::count_if(r.result.events.begin(), r.result.events.end(),
                       [](const Event& event) { return event.kind != EventKind::changes_foot; });
}

} // namespace

TEST_CASE("several frictions of one rigid pair are one friction") {
  Random random(5177);
  for (int i = 0; i < 120; ++i) {
    ShakenSlide c{random.power(-1.0, 3.0), random.between(0.5, 5.0), 0.0, random.between(-3.0, 3.0), {}, {}, random.below(2) == 0};
    const int feet = 2 + random.below(4);
    double bound = 0.0;
    for (int k = 0; k < feet; ++k) {
      c.preload.push_back(random.power(1.0, 4.0));
      c.coefficient.push_back(random.between(0.05, 1.0));
      bound += c.preload.back() * c.coefficient.back();
    }
    c.shake = bound * random.between(0.7, 3.0);
    Settings s = k_methods[i % 5];
    s.end = 2.3 / c.frequency;
    CAPTURE(i);
    CAPTURE(feet);
    CAPTURE(s.integrator);
    const Run with = run(scene(c.text(false)), s), without = run(scene(c.text(true)), s);
    const double size = c.shake / c.mass / (c.frequency * c.frequency);
    CHECK(std::abs(with.last("mass.x") - without.last("mass.x")) < 1e-6 * size);
    CHECK(std::abs(with.last("mass.y") - without.last("mass.y")) < 1e-6 * size);
    CHECK(slips_and_rests(with) == slips_and_rests(without) * feet);
    check_cost(with, without);
  }
}

TEST_CASE("kinks of a spring between bodies that are held to each other are not passed") {
  for (int i = 0; i < 120; ++i) {
    Settings s = k_methods[i % 5];
    s.end = 0.7;
    CAPTURE(i);
    CAPTURE(s.integrator);
    Random first(5658U + static_cast<unsigned>(i)), again(5658U + static_cast<unsigned>(i));
    const Run with = run(scene(pair_of_bodies(first, true, i % 3)), s), without = run(scene(pair_of_bodies(again, false, i % 3)), s);
    CHECK(with.result.events.empty());
    CHECK(std::abs(with.last("carrier.x") - without.last("carrier.x")) < 1e-6);
    CHECK(std::abs(with.last("rider.theta") - without.last("rider.theta")) < 1e-6);
    check_cost(with, without);
  }
}

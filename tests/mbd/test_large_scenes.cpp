// Scenes of some thousand bodies: what mechanics says of them as a whole, and of one of many that do not touch.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr int k_bodies = 4200;

const char* const k_header = "gravity = [0.0, -9.81]\n[simulation]\nend = 1.0\n";

std::string body(const std::string& name, double x, double y, const std::string& more = "") {
  std::ostringstream text;
  text << "[[body]]\nname = \"" << name << "\"\nmass = 1.0\ninertia = 0.1\nposition = [" << x << ", " << y << "]\n" << more;
  return text.str();
}

std::string spring(const std::string& name, const std::string& a, const std::string& b) {
  return "[[element]]\nkind = \"spring_damper\"\nname = \"" + name + "\"\na = " + a + "\nb = " + b + "\nstiffness = 1e4\ndamping = 5.0\n";
}

std::string at(const std::string& name, double x, double y) {
  std::ostringstream text;
  text << "{ body = \"" << name << "\", at = [" << x << ", " << y << "] }";
  return text.str();
}

std::string pin(const std::string& a, const std::string& b, double x, double y) {
  return "[[element]]\nkind = \"revolute\"\nname = \"" + a + " on " + b + "\"\na = " + at(a, x, y) + "\nb = " + at(b, x, y) + "\n";
}

// A net of masses, its springs fixed off the masses' centres, so that it turns them; it hangs or flies.
std::string grid(bool hangs, const std::string& more = "") {
  const int side = 66;
  std::string text = k_header;
  const auto name = [&](int row, int column) { return "m" + std::to_string(row * side + column); };
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c)
      text += body(name(r, c), c, -r, r == 0 && c == 3 ? "velocity = [3.0, 1.0]\nangular_velocity = 2.0\n" : "");
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const std::string here = at(name(r, c), c + 0.1, -r + 0.05);
      if (r > 0) text += spring("v" + name(r, c), here, at(name(r - 1, c), c - 0.1, -r + 1.0));
      else if (hangs) text += spring("g" + name(r, c), here, at("ground", c, 1.0));
      if (c > 0) text += spring("h" + name(r, c), here, at(name(r, c - 1), c - 1, -r - 0.1));
    }
  return text + more;
}

// What acts in a large scene beside springs and pins.
const char* const k_extras = R"(
[[signal]]
name = "shaking"
kind = "harmonics"
amplitudes = [0.01]
frequencies = [5.0]
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "m10"
coordinate = "x"
signal = "shaking"
[[element]]
kind = "load"
name = "pull"
at = "m2000"
force = [100.0, 50.0]
[[element]]
kind = "weld"
name = "weld"
a = { body = "m700", at = [40.0, -10.0] }
b = { body = "m701", at = [40.0, -10.0] }
[[element]]
kind = "rope"
name = "rope"
a = "m5"
over = ["m1500"]
b = "m4000"
length = 60.0
stiffness = 1e3
[[element]]
kind = "step_lap_joint"
name = "grip"
limb = "m3"
active_part = "m4"
tangential_stiffness = 1e6
[[element]]
kind = "step_lap_interface"
name = "sheets"
joint = "grip"
yoke = [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]]
limb = [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]
pressure = 1e7
static_friction = 0.5
)";

std::string chain() {
  std::string text = k_header;
  const auto name = [](int i) { return "b" + std::to_string(i); };
  for (int i = 0; i < k_bodies; ++i) text += body(name(i), i + 0.5, 0.0);
  for (int i = 0; i < k_bodies; ++i) text += pin(name(i), i == 0 ? "ground" : name(i - 1), i, 0.0);
  return text;
}

std::string linkage(int i) {
  const std::string n = std::to_string(i);
  const double x = 4.0 * i;
  return body("crank" + n, x + 0.25, 0.5) + body("coupler" + n, x + 1.5, 1.25) + body("rocker" + n, x + 2.25, 0.75) +
         pin("crank" + n, "ground", x, 0.0) + pin("coupler" + n, "crank" + n, x + 0.5, 1.0) +
         pin("rocker" + n, "coupler" + n, x + 2.5, 1.5) + pin("rocker" + n, "ground", x + 2.0, 0.0);
}

std::string linkages(int count) {
  std::string text = k_header;
  for (int i = 0; i < count; ++i) text += linkage(i);
  return text;
}

// Blocks on the floor among them: one slides on, one comes to rest, one sticks, one falls and lands.
std::string blocks_among_linkages(int count) {
  std::string text = linkages(count);
  for (int i = 0; i < 8; ++i) {
    const std::string n = "block" + std::to_string(i);
    std::ostringstream velocity;
    velocity << "velocity = [" << (i % 4 == 0 ? 3.0 : i % 4 == 1 ? 0.002 * (i + 1) : 0.0) << ", 0.0]\n";
    text += body(n, -5.0 * i, i % 4 == 3 ? 2e-4 * i : 0.0, velocity.str());
    text += "[[element]]\nkind = \"unilateral_contact\"\nname = \"sole" + n + "\"\na = \"" + n +
            "\"\nstiffness = 1e6\npreload = " + (i % 4 == 3 ? "0.0" : "9.81") +
            "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"friction" + n + "\"\ncontacts = [\"sole" + n +
            "\"]\nstatic_friction = 0.4\n";
  }
  return text;
}

struct Case {
  std::string name, text;
  Settings settings;
  Coordinates coordinates = Coordinates::automatic;
};

std::vector<Case> cases() {
  return {{"grid, fixed steps", grid(true), {"rk4", 1e-3, 5e-3}},
          {"grid with all else, chosen steps", grid(true, k_extras), {"dop853", 1e-6, 2e-2}},
          {"chain", chain(), {"rk4", 1e-3, 3e-3}},
          {"linkages, by their joints", linkages(k_bodies / 3), {"tsit5", 1e-6, 2e-2}},
          {"linkages, absolute", linkages(k_bodies / 3), {"rk4", 1e-3, 5e-3}, Coordinates::absolute},
          {"blocks among linkages", blocks_among_linkages(k_bodies / 3), {"dop853", 1e-6, 1e-2}},
          {"blocks among linkages, absolute", blocks_among_linkages(k_bodies / 3), {"tsit5", 1e-6, 6e-3}, Coordinates::absolute}};
}

RunResult run(const System& system, const Case& c) {
  SimulationOptions o = options(c.settings);
  o.coordinates = c.coordinates;
  return simulate(system, system.initial_state(), o);
}

} // namespace

TEST_CASE("the energy of large scenes is in balance") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    const auto system = compile(scene(c.text));
    const RunResult result = run(*system, c);
    CHECK(result.statistics.steps > 1);
    // Energies of all kinds are in it. The least of them, the load's work, is 2e-5 of what the drive exchanges; the methods'
    // errors are 4e-7 of that or less.
    CHECK(result.statistics.energy_residual < 1e-5 * result.statistics.energy_exchanged);
  }
}

// Forces between masses cancel in the sums of momentum and of moment of momentum, if what acts on one acts on the other.
TEST_CASE("a net that flies keeps its momentum, and the moment of it about what falls") {
  const auto system = compile(scene(grid(false)));
  const State start = system->initial_state();
  const double t = 0.02;
  const RunResult result = run(*system, {"", "", {"rk4", 1e-3, t}});
  struct Momentum {
    double x = 0.0, y = 0.0, moment = 0.0, mass = 0.0, at_x = 0.0, at_y = 0.0;
  };
  const auto momentum = [&](const State& s) {
    Momentum p;
    for (int i = 1; i < system->body_count(); ++i) {
      const BodyData& b = system->bodies[i];
      const double *q = &s.q[3 * i], *v = &s.v[3 * i];
      p.mass += b.mass;
      p.x += b.mass * v[0];
      p.y += b.mass * v[1];
      p.at_x += b.mass * q[0];
      p.at_y += b.mass * q[1];
      p.moment += b.mass * (q[0] * v[1] - q[1] * v[0]) + b.inertia * v[2];
    }
    p.moment -= (p.at_x * p.y - p.at_y * p.x) / p.mass; // about the centre of gravity
    return p;
  };
  const Momentum before = momentum(start), after = momentum(result.final_state);
  const double scale = before.mass * 9.81 * t;
  // Rounding of four thousand terms. RK4 keeps what is linear in the velocities; the moment, which is not, to its error of order 4:
  // (ω h)⁴ with ω = √(8 k/m), 0.28 rad/s·ms, a share of the moment of what moves, 3 kg m/s 30 m away.
  CHECK(std::abs(after.x - before.x) < 1e-12 * scale);
  CHECK(std::abs(after.y - before.y + scale) < 1e-12 * scale);
  CHECK(std::abs(after.moment - before.moment) < 1e-3 * std::abs(before.moment));
  CHECK(std::abs(before.moment) > 10.0);
}

// An island knows nothing of the others: in joint coordinates nothing that it is summed from differs from the scene of it alone.
// Fixed steps; projection is made for all of them if one asks for it, and moves by less than its tolerance of 1e-12.
TEST_CASE("a linkage among hundreds moves as it does alone") {
  for (const Coordinates coordinates : {Coordinates::automatic, Coordinates::absolute}) {
    const Case c{"", "", {"rk4", 1e-3, 1e-2}, coordinates};
    const auto many = compile(scene(linkages(k_bodies / 3)));
    const auto alone = compile(scene(std::string(k_header) + linkage(0)));
    const State last = run(*many, c).final_state, expected = run(*alone, c).final_state;
    double largest = 0.0;
    for (int i = 0; i < k_bodies / 3; ++i)
      for (int k = 0; k < 9; ++k) {
        const double moved = last.q[9 * i + 3 + k] - (k % 3 == 0 ? 4.0 * i : 0.0);
        // Places 5600 m from the origin are known to their rounding, 1e-12 m.
        largest = std::max(largest, std::abs(moved - expected.q[3 + k]) - 1e-11);
        largest = std::max(largest, std::abs(last.v[9 * i + 3 + k] - expected.v[3 + k]) - 1e-9);
      }
    CHECK(largest <= 0.0);
    CHECK(std::abs(expected.v[5]) > 1e-3); // it has begun to turn
  }
}

namespace {

// A deck on rails that is pulled, and blocks on it that friction takes along, those of even numbers only so fast. Soles are at the
// height of the centres of gravity: nothing tips.
std::string pulled_deck(int blocks, double force, double slippery) {
  std::ostringstream text;
  text.precision(17);
  text << k_header << "[[body]]\nname = \"deck\"\nmass = 500.0\ninertia = 2e4\n"
       << "[[element]]\nkind = \"prismatic\"\nname = \"rails\"\na = \"deck\"\n"
       << "[[element]]\nkind = \"load\"\nname = \"pull\"\nat = \"deck\"\nforce = [" << force << ", 0.0]\n";
  for (int i = 0; i < blocks; ++i) {
    const double mass = 1.0 + 0.1 * i;
    text << "[[body]]\nname = \"block" << i << "\"\nmass = " << mass << "\ninertia = 0.3\nposition = [" << i << ", 0.0]\n"
         << "[[element]]\nkind = \"unilateral_contact\"\nname = \"sole" << i << "\"\na = \"block" << i
         << "\"\nb = { body = \"deck\", point = [" << i << ", 0.0] }\nstiffness = 1e6\npreload = " << 9.81 * mass
         << "\n[[element]]\nkind = \"coulomb_stick\"\nname = \"friction" << i << "\"\ncontacts = [\"sole" << i
         << "\"]\nstatic_friction = " << (i % 2 == 0 ? slippery : 0.5) << "\n";
  }
  return text.str();
}

} // namespace

// The masses of what holds move as one; what slides takes μ N from the pull and has no more than μ g. Many rows meet in the deck,
// which has rows to the ground beside them.
TEST_CASE("blocks that friction holds on a deck move with it, each taken along by its own share of the pull") {
  constexpr int k_blocks = 150;
  constexpr double k_g = 9.81, k_t = 0.5;
  for (const double slippery : {0.5, 0.1}) {
    CAPTURE(slippery);
    double held = 500.0, slid = 0.0;
    for (int i = 0; i < k_blocks; ++i) (i % 2 == 0 && slippery < 0.2 ? slid : held) += 1.0 + 0.1 * i;
    const double acceleration = 0.3 * k_g, force = acceleration * held + slippery * k_g * slid;
    const Run r = run(scene(pulled_deck(k_blocks, force, slippery)), {"dop853", 1e-9, k_t});
    // Soles are springs without damping: what errors of steps leave of their motion is a millionth of what they bear.
    CHECK(std::abs(r.last("deck.vx") - acceleration * k_t) < 1e-5 * acceleration * k_t);
    for (int i = 0; i < k_blocks; ++i) {
      const std::string n = std::to_string(i);
      const double mass = 1.0 + 0.1 * i, own = i % 2 == 0 && slippery < 0.2 ? slippery * k_g : acceleration;
      CHECK(std::abs(r.last("block" + n + ".vx") - own * k_t) < 1e-5 * own * k_t);
      CHECK(std::abs(r.last("friction" + n + ".friction") - mass * own) < 1e-5 * mass * own);
    }
  }
}

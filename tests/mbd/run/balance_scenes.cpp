#include "balance_scenes.h"

#include "mbd/base/counter_random.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_gravity = 9.81;
// An exponent of 3 decides; scenes keep away from it by a tenth.
constexpr double k_decides = 3.0, k_away = 1.1;

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

class Draw {
public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  double between(double low, double high) { return low + (high - low) * counter_uniform(seed_, 7, 0, next_++); }
  double evenly_in_powers(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  int choice(int count) { return static_cast<int>(between(0.0, count)); }
  bool coin() { return choice(2) == 0; }

private:
  std::uint64_t seed_;
  std::uint32_t next_ = 0;
};

// Text of a model whose points and directions are turned about the origin.
class Text {
public:
  explicit Text(double angle, double gravity = k_gravity)
      : cos_(std::cos(angle)), sin_(std::sin(angle)), degrees_(angle * 180.0 / std::numbers::pi) {
    text_ = "gravity = " + turned(0.0, -gravity) + "\n";
  }
  [[nodiscard]] std::string turned(double x, double y) const {
    return "[" + number(cos_ * x - sin_ * y) + ", " + number(sin_ * x + cos_ * y) + "]";
  }
  [[nodiscard]] std::string at(const char* body, double x, double y) const {
    return std::string("{ body = \"") + body + "\", at = " + turned(x, y) + " }";
  }
  /// The same place, with the axes of the scene.
  [[nodiscard]] std::string axes_at(const char* body, double x, double y) const {
    return std::string("{ body = \"") + body + "\", at = " + turned(x, y) + ", angle = \"" + number(degrees_) + " deg\" }";
  }
  [[nodiscard]] double cosine() const { return cos_; }
  [[nodiscard]] double sine() const { return sin_; }
  [[nodiscard]] double degrees() const { return degrees_; }
  void run(double end) { text_ += "[simulation]\nend = " + number(end) + "\n[output]\nstep = " + number(end / 4.0) + "\n"; }
  void body(const char* name, double mass, double inertia, double x, double y, const std::string& more = "") {
    text_ += std::string("[[body]]\nname = \"") + name + "\"\nmass = " + number(mass) + "\ninertia = " + number(inertia) +
             "\nposition = " + turned(x, y) + "\n" + more;
  }
  void element(const char* kind, const char* name, const std::string& fields) {
    text_ += std::string("[[element]]\nkind = \"") + kind + "\"\nname = \"" + name + "\"\n" + fields + "\n";
  }
  void release(const char* element, double t) {
    text_ += std::string("[[action]]\nname = \"go\"\nwhen = \"") + number(t) + " s\"\ndo = [\"release " + element + "\"]\n";
  }
  void add(const std::string& text) { text_ += text; }
  void criterion(const char* channel, double within) {
    text_ += std::string("[[acceptance]]\nname = \"stays\"\nchannel = \"") + channel + "\"\nwithin = " + number(within) + "\n";
  }
  [[nodiscard]] std::string text() const { return text_; }

private:
  double cos_, sin_, degrees_;
  std::string text_;
};

double any_angle(Draw& draw) { return draw.between(0.0, 2.0 * std::numbers::pi); }

// A leg so long, in s, that what grows with `rate` does or does not balance; its truth in `balances`.
double leg_of(Draw& draw, double rate, bool& balances) {
  const double exponent = draw.coin() ? draw.between(k_decides * k_away, 12.0) : draw.between(0.3, k_decides / k_away);
  double leg = exponent / rate;
  if (leg < 1.0) leg = rate * k_away < k_decides || rate > k_decides * k_away ? draw.between(0.05, 1.0) : 4.0 * k_decides / rate;
  balances = rate * std::max(leg, 1.0) > k_decides;
  return leg;
}

// A rod on its end, or hanging by it; free from the start, or let go by an action from a weld or from a stay.
BalanceScene rod(Draw& draw) {
  const double length = draw.evenly_in_powers(1e-3, 300.0), mass = draw.evenly_in_powers(0.1, 1e4);
  const bool is_upright = draw.choice(3) > 0;
  const double rate = std::sqrt(1.5 * k_gravity / length);
  BalanceScene scene;
  const double leg = leg_of(draw, rate, scene.balances);
  scene.balances = scene.balances && is_upright;
  const int held = draw.choice(3); // by nothing, a weld, a stay
  const double wait = held > 0 ? draw.between(0.05, 3.0) : 0.0, side = is_upright ? 1.0 : -1.0;
  Text text(any_angle(draw));
  text.run(wait + leg);
  text.body("rod", mass, mass * length * length / 12.0, 0.0, 0.5 * side * length);
  text.element("revolute", "pin", "a = " + text.at("rod", 0.0, 0.0) + "\nb = \"ground\"");
  if (held == 1) text.element("weld", "hold", "a = \"rod\"\nb = \"ground\"");
  if (held == 2) text.element("distance", "hold", "a = " + text.at("rod", 0.0, side * length) + "\nb = " + text.at("ground", length, 0.0));
  if (held > 0) text.release("hold", wait);
  text.criterion("rod.theta", 0.1);
  scene.text = text.text();
  scene.what = std::string(is_upright ? "upright" : "hanging") + " rod of " + number(length) + " m, held " + std::to_string(held) +
               ", leg " + number(leg) + " s";
  return scene;
}

// Two links with a spring on the knee, pressed by a load P on the head, which slides along y. Aside by u the knee bends by u s,
// s = 1/l + 1/h, and the head sinks by u² s/2: it bears P = c s, and u'' m = s (P − c s) u, m = (m_l + m_h)/4 + J_l/l² + J_h/h².
BalanceScene column(Draw& draw) {
  const double l = draw.between(0.3, 2.0), h = draw.between(0.3, 2.0), c = draw.evenly_in_powers(1e2, 1e5);
  const double s = 1.0 / l + 1.0 / h, bears = c * s, share = std::array{0.5, 0.98, 1.02, 1.5}[static_cast<std::size_t>(draw.choice(4))];
  const double mass = 0.5 + 0.1 / (l * l) + 0.1 / (h * h), rate = std::sqrt(std::abs(share - 1.0) * bears * s / mass);
  BalanceScene scene;
  const double leg = leg_of(draw, rate, scene.balances);
  scene.balances = scene.balances && share > 1.0;
  const bool is_held = draw.coin();
  const double wait = is_held ? draw.between(0.05, 2.0) : 0.0;
  Text text(any_angle(draw), 0.0);
  text.run(wait + leg);
  text.body("lower", 1.0, 0.1, 0.0, 0.5 * l);
  text.body("upper", 1.0, 0.1, 0.0, l + 0.5 * h);
  text.element("revolute", "foot", "a = " + text.at("lower", 0.0, 0.0) + "\nb = \"ground\"");
  text.element("revolute", "knee", "a = " + text.at("upper", 0.0, l) + "\nb = " + text.at("lower", 0.0, l));
  text.element("bushing", "spring",
               "a = " + text.at("upper", 0.0, l) + "\nb = " + text.at("lower", 0.0, l) + "\nrotational_stiffness = " + number(c));
  text.element("point_on_line", "head",
               "a = " + text.at("upper", 0.0, l + h) + "\nb = " + text.at("ground", 0.0, l + h) + "\naxis = " + text.turned(0.0, 1.0));
  text.element("load", "press", "at = " + text.at("upper", 0.0, l + h) + "\nforce = " + text.turned(0.0, -share * bears));
  if (is_held) {
    text.element("weld", "hold", "a = \"lower\"\nb = \"ground\"");
    text.release("hold", wait);
  }
  text.criterion("lower.theta", 0.1);
  scene.text = text.text();
  scene.what = "column at " + number(share) + " of its load, leg " + number(leg) + " s";
  return scene;
}

// A mass between two springs in a line, compressed or stretched, pushed along the line: across it a spring of stiffness k, length L and free
// length L₀ pushes with k (L₀/L − 1).
BalanceScene toggle(Draw& draw) {
  const double length = draw.evenly_in_powers(0.1, 10.0), k = draw.evenly_in_powers(1e3, 1e5), mass = draw.evenly_in_powers(1.0, 100.0);
  const double free = draw.coin() ? draw.between(1.05, 1.4) : draw.between(0.6, 0.95),
               rate = std::sqrt(2.0 * k * std::abs(free - 1.0) / mass);
  BalanceScene scene;
  const double leg = rate > 2.0 * k_decides ? draw.between(0.3, 2.0) : 8.0 / rate;
  scene.balances = free > 1.0;
  Text text(any_angle(draw), 0.0);
  text.run(leg);
  text.body("bob", mass, 0.1 * mass * length * length, 0.0, 0.0);
  for (const double side : {-1.0, 1.0})
    text.element("spring_damper", side < 0.0 ? "left" : "right",
                 "a = \"bob\"\nb = " + text.at("ground", side * length, 0.0) + "\nstiffness = " + number(k) +
                     "\ndamping = " + number(draw.between(0.0, 0.1) * std::sqrt(k * mass)) + "\nfree_length = " + number(free * length));
  // A push that moves it by some hundredths of the length: the compression across stays nearly what it is.
  const double push = draw.between(0.0, 0.02) * 2.0 * k * length;
  const double duration = draw.between(0.05, 0.3);
  const auto signal = [&](const char* name, double peak) {
    text.add(std::string("[[signal]]\nname = \"") + name + "\"\nkind = \"half_sine\"\npeak = " + number(peak) +
             "\nduration = " + number(duration) + "\n");
  };
  signal("px", push * text.cosine());
  signal("py", push * text.sine());
  text.element("load", "push", "at = \"bob\"\nforce_x = \"px\"\nforce_y = \"py\"");
  text.add("[[channel]]\nname = \"away\"\nexpression = \"hypot(bob.x, bob.y)\"\nunit = \"m\"\n");
  text.criterion("away", length);
  scene.text = text.text();
  scene.what = "toggle of " + number(free) + " free lengths, rate " + number(rate) + ", leg " + number(leg) + " s";
  return scene;
}

// A smooth ball of radius r on top of another of R, or at the bottom of a ring; pressed in by its weight from the start, or dropped.
BalanceScene ball(Draw& draw) {
  const double radius = draw.evenly_in_powers(0.02, 1.0), other = radius * draw.between(2.0, 8.0), mass = draw.evenly_in_powers(0.1, 100.0);
  const bool is_on_top = draw.choice(3) > 0, is_held = draw.coin();
  const double distance = is_on_top ? radius + other : other - radius, rate = std::sqrt(k_gravity / distance);
  const double stiffness = draw.evenly_in_powers(1e5, 1e7) * mass, depth = mass * k_gravity / stiffness;
  BalanceScene scene;
  const double leg = leg_of(draw, rate, scene.balances);
  scene.balances = scene.balances && is_on_top;
  const double wait = is_held ? draw.between(0.05, 2.0) : 0.0;
  Text text(any_angle(draw));
  text.run(wait + leg);
  text.body("ball", mass, 0.4 * mass * radius * radius, 0.0, is_on_top ? distance - depth : -distance - depth);
  text.element("circle_contact", "contact",
               "a = \"ball\"\nb = \"ground\"\nradius_a = " + number(radius) + "\nradius_b = " + number(other) +
                   "\nstiffness = " + number(stiffness) + "\ndamping = " + number(draw.between(0.1, 1.0) * std::sqrt(stiffness * mass)) +
                   (is_on_top ? "" : "\ninside = true"));
  if (is_held) {
    text.element("weld", "hold", "a = \"ball\"\nb = \"ground\"");
    text.release("hold", wait);
  }
  text.add("[[channel]]\nname = \"away\"\nexpression = \"hypot(ball.x, ball.y)\"\nunit = \"m\"\n");
  text.criterion("away", 2.0 * distance);
  scene.text = text.text();
  scene.what = std::string("ball ") + (is_on_top ? "on top" : "in a ring") + " of " + number(other) + " m, leg " + number(leg) + " s";
  return scene;
}

// A box flat on a plane: it rests, slides to rest, or falls flat on it.
BalanceScene box(Draw& draw) {
  const double wide = draw.evenly_in_powers(0.1, 3.0), high = wide * draw.between(0.2, 3.0), mass = draw.evenly_in_powers(1.0, 1e4);
  const double friction = draw.between(0.1, 0.6), stiffness = draw.evenly_in_powers(1e4, 1e6) * mass / wide;
  const int does = draw.choice(3); // rests, slides, falls
  BalanceScene scene;
  Text text(any_angle(draw));
  const double leg = draw.between(0.5, 3.0);
  text.run(leg);
  // It presses with k w depth.
  const double depth = mass * k_gravity / (stiffness * wide), speed = does == 1 ? draw.between(0.2, 2.0) : 0.0;
  const double start = 0.5 * high + (does == 2 ? draw.between(1e-3, 0.1) : -depth);
  const auto corner = [&](double x, double y) { return "[" + number(x) + ", " + number(y) + "]"; };
  // Body axes turn with the scene.
  text.body("box", mass, mass * (wide * wide + high * high) / 12.0, 0.0, start,
            "angle = \"" + number(text.degrees()) + " deg\"\nvelocity = " + text.turned(speed, 0.0) + "\noutline = [" +
                corner(-0.5 * wide, -0.5 * high) + ", " + corner(0.5 * wide, -0.5 * high) + ", " + corner(0.5 * wide, 0.5 * high) + ", " +
                corner(-0.5 * wide, 0.5 * high) + "]\n");
  text.element("polygon_contact", "plane",
               "a = \"box\"\nb = \"ground\"\nnormal = " + text.turned(0.0, 1.0) + "\nstiffness = " + number(stiffness) +
                   "\ndissipation = " + number(draw.between(0.5, 5.0)) + "\nstatic_friction = " + number(friction));
  text.criterion("box.theta", 10.0);
  scene.text = text.text();
  scene.what = "box of " + number(wide) + " m x " + number(high) + " m that " +
               std::array{"rests", "slides", "falls"}[static_cast<std::size_t>(does)];
  scene.is_sound = false; // errors of rebounds may leave it open
  return scene;
}

// A rod that stands or hangs on a car which a drive moves evenly or accelerates, leaning as its weight and its inertia ask for.
BalanceScene carried(Draw& draw) {
  const double length = draw.evenly_in_powers(0.05, 20.0), mass = draw.evenly_in_powers(0.1, 1e3),
               car = mass * draw.evenly_in_powers(0.02, 100.0);
  const bool is_upright = draw.choice(3) > 0, is_even = draw.coin();
  const double acceleration = is_even ? 0.0 : draw.between(-5.0, 5.0), pull = std::hypot(k_gravity, acceleration);
  const double rate = std::sqrt(1.5 * pull / length), speed = draw.between(0.1, 20.0);
  BalanceScene scene;
  const double leg = leg_of(draw, rate, scene.balances);
  scene.balances = scene.balances && is_upright;
  const double reach = (is_upright ? 0.5 : -0.5) * length / pull;
  Text text(any_angle(draw));
  text.run(leg);
  const std::string velocity = "velocity = " + text.turned(speed, 0.0) + "\n";
  text.body("car", car, 0.1 * car, 0.0, 0.0, velocity);
  text.body("rod", mass, mass * length * length / 12.0, reach * acceleration, reach * k_gravity, velocity);
  text.element("prismatic", "road", "a = \"car\"\naxis = " + text.turned(1.0, 0.0));
  text.element("revolute", "pin", "a = " + text.at("rod", 0.0, 0.0) + "\nb = " + text.at("car", 0.0, 0.0));
  text.add("[[signal]]\nname = \"drive\"\nkind = \"constant\"\nvalue = " + number(is_even ? speed : acceleration) + "\n");
  text.element("prescribed_motion", "drive",
               "a = \"car\"\nb = " + text.axes_at("ground", 0.0, 0.0) + "\nsignal = \"drive\"\nas = \"" +
                   (is_even ? "velocity" : "acceleration") + "\"");
  text.criterion("rod.theta", 0.1);
  scene.text = text.text();
  scene.what = std::string(is_upright ? "upright" : "hanging") + " rod of " + number(length) + " m on a car with " + number(acceleration) +
               " m/s2, leg " + number(leg) + " s";
  scene.is_sound = is_even; // what has not come to its end may leave the verdict open
  return scene;
}

// A trailer on a car that is driven with v, its axle l ahead of the hitch or behind it: θ' = ± (v/l) θ.
BalanceScene trailer(Draw& draw) {
  const double length = draw.evenly_in_powers(0.2, 10.0), speed = draw.between(0.3, 20.0), rate = speed / length;
  const bool is_pushed = draw.choice(3) > 0;
  BalanceScene scene;
  const double leg = leg_of(draw, rate, scene.balances);
  scene.balances = scene.balances && is_pushed;
  const double axle = is_pushed ? length : -length;
  Text text(any_angle(draw), 0.0);
  text.run(leg);
  const std::string velocity = "velocity = " + text.turned(speed, 0.0) + "\n";
  text.body("car", 1000.0, 500.0, 0.0, 0.0, velocity);
  text.body("trailer", draw.evenly_in_powers(10.0, 1e4), draw.evenly_in_powers(1.0, 1e4), axle * draw.between(0.2, 1.2), 0.0, velocity);
  text.element("prismatic", "road", "a = \"car\"\naxis = " + text.turned(1.0, 0.0));
  text.element("revolute", "hitch", "a = " + text.at("trailer", 0.0, 0.0) + "\nb = " + text.at("car", 0.0, 0.0));
  text.element("skate", "axle", "a = " + text.at("trailer", axle, 0.0) + "\naxis = " + text.turned(1.0, 0.0));
  text.add("[[signal]]\nname = \"speed\"\nkind = \"constant\"\nvalue = " + number(speed) + "\n");
  text.element("prescribed_motion", "drive",
               "a = \"car\"\nb = " + text.axes_at("ground", 0.0, 0.0) + "\nsignal = \"speed\"\nas = \"velocity\"");
  text.criterion("trailer.theta", 0.1);
  scene.text = text.text();
  scene.what =
      std::string("trailer ") + (is_pushed ? "pushed" : "pulled") + " at " + number(rate) + " lengths a second, leg " + number(leg) + " s";
  return scene;
}

// x'' − 2 σ x' + ω² x = 0, driven (σ > 0) or damped; swinging, or not: then the faster one of both exponentials counts.
BalanceScene swing(Draw& draw) {
  const double sigma = draw.evenly_in_powers(0.5, 50.0), mass = draw.evenly_in_powers(0.1, 100.0);
  const bool is_driven = draw.coin(), swings = draw.choice(3) > 0;
  const double rate = swings ? sigma : sigma * (1.0 + std::sqrt(0.75)); // ω = σ/2
  BalanceScene scene;
  // A nudge displaces positions, and the spring at first draws an overdamped block back. With r₁ = 13.9 r₂ the displacement then grows as
  // 0.077 exp(r₁ t), which reaches half the exponent from 5.2 on.
  const double leg = swings ? leg_of(draw, rate, scene.balances) : std::max(1.0, draw.between(5.5, 12.0) / rate);
  scene.balances = (scene.balances || !swings) && is_driven;
  // Several swings within the leg, so that its growth shows.
  const double omega = swings ? std::max(sigma, 1.0 / leg) * draw.between(30.0, 60.0) : 0.5 * sigma;
  Text text(any_angle(draw), 0.0);
  text.run(leg);
  text.body("bob", mass, 0.1 * mass, 0.0, 0.0);
  text.element("prismatic", "guide", "a = \"bob\"\naxis = " + text.turned(1.0, 0.0));
  text.element("spring_damper", "spring",
               "a = \"bob\"\naxis = " + text.turned(1.0, 0.0) + "\nstiffness = " + number(mass * omega * omega) + "\nfree_length = 0.0");
  text.element("force", "drive",
               "a = \"bob\"\nb = " + text.axes_at("ground", 0.0, 0.0) + "\ncoordinate = \"x\"\nformula = \"'" +
                   number(2.0 * mass * sigma * (is_driven ? 1.0 : -1.0)) + " N s/m' * rate\"");
  text.add("[[channel]]\nname = \"away\"\nexpression = \"hypot(bob.x, bob.y)\"\nunit = \"m\"\n");
  text.criterion("away", 0.1);
  scene.text = text.text();
  scene.what =
      std::string(is_driven ? "driven" : "damped") + (swings ? " swing, " : " creep, ") + number(rate) + " 1/s, leg " + number(leg) + " s";
  return scene;
}

// A block that a driven car pulls evenly by a spring k and a damper d, over a plane whose friction falls by s for each m/s:
// x'' = 2 σ x' − ω² x with 2 σ = (s − d)/m. Friction that falls by less than the damper takes is sound.
BalanceScene pulled(Draw& draw) {
  const double sigma = draw.evenly_in_powers(0.5, 50.0), mass = draw.evenly_in_powers(0.1, 100.0), speed = draw.between(0.1, 10.0);
  const bool is_driven = draw.coin();
  BalanceScene scene;
  const double leg = leg_of(draw, sigma, scene.balances);
  scene.balances = scene.balances && is_driven;
  const double omega = std::max(sigma, 1.0 / leg) * draw.between(30.0, 60.0); // several swings within the leg
  const double damper = 2.0 * mass * sigma * draw.between(1.2, 3.0), falls = damper + (is_driven ? 2.0 : -2.0) * mass * sigma;
  const double friction = falls * speed + mass * k_gravity * draw.between(0.1, 0.5), stiffness = mass * omega * omega;
  Text text(any_angle(draw), 0.0);
  text.run(leg);
  const std::string velocity = "velocity = " + text.turned(speed, 0.0) + "\n", along = "\naxis = " + text.turned(1.0, 0.0);
  const std::string against_ground = "\nb = " + text.axes_at("ground", 0.0, 0.0);
  text.body("car", 10.0 * mass, mass, 0.0, 0.0, velocity);
  text.body("block", mass, 0.1 * mass, 0.0, 0.0, velocity);
  text.element("prismatic", "road", "a = \"car\"" + along);
  text.element("prismatic", "plane", "a = \"block\"" + along);
  text.element("spring_damper", "rod",
               "a = \"block\"\nb = \"car\"" + along + "\nstiffness = " + number(stiffness) + "\ndamping = " + number(damper) +
                   "\nfree_length = " + number(friction / stiffness));
  text.element("force", "friction",
               "a = \"block\"" + against_ground + "\ncoordinate = \"x\"\nformula = \"'" + number(falls) + " N s/m' * (rate - '" +
                   number(speed) + " m/s') - '" + number(friction) + " N'\"");
  text.add("[[signal]]\nname = \"speed\"\nkind = \"constant\"\nvalue = " + number(speed) + "\n");
  text.element("prescribed_motion", "drive", "a = \"car\"" + against_ground + "\nsignal = \"speed\"\nas = \"velocity\"");
  text.add("[[channel]]\nname = \"away\"\nexpression = \"hypot(block.x - car.x, block.y - car.y)\"\nunit = \"m\"\n");
  text.criterion("away", 0.1);
  scene.text = text.text();
  scene.what = std::string("block pulled over friction that ") + (is_driven ? "drives" : "is damped") + ", " + number(sigma) +
               " 1/s, leg " + number(leg) + " s";
  return scene;
}

// Two rods of 1 m and 1 kg, one on the other, with springs of stiffness c at the foot and at the knee, pressed by a load P that follows the
// upper one (Ziegler). M θ'' = −K θ with M = [4/3 1/2; 1/2 1/3], K = [2c − P, P − c; −c, c]: λ² follows from a quadratic equation.
BalanceScene follower(Draw& draw) {
  const double c = draw.evenly_in_powers(10.0, 1e4);
  const auto flutter = [c](double p) { // its rate, 0: none
    const double square = 4.0 / 9.0 - 1.0 / 4.0, linear = 4.0 / 3.0 * c + (2.0 * c - p) / 3.0 - 0.5 * (p - 2.0 * c), constant = c * c;
    const double inner = linear * linear - 4.0 * square * constant;
    if (inner >= 0.0) return 0.0;
    const double real = -linear / (2.0 * square), size = std::sqrt(constant / square);
    return std::sqrt(0.5 * (size + real));
  };
  double low = 0.0, high = 3.5 * c; // flutter begins between
  for (int i = 0; i < 60; ++i) (flutter(0.5 * (low + high)) > 0.0 ? high : low) = 0.5 * (low + high);
  const bool flutters = draw.coin();
  const double load = high * (flutters ? draw.between(1.1, 1.4) : draw.between(0.2, 0.95)), rate = flutter(load);
  BalanceScene scene;
  scene.balances = flutters;
  const double leg = flutters ? std::max(1.0, draw.between(4.0, 12.0) / rate) : draw.between(0.5, 3.0);
  scene.balances = flutters && rate * leg > k_decides;
  Text text(any_angle(draw), 0.0);
  text.run(leg);
  const std::string angle = "angle = \"" + number(text.degrees()) + " deg\"\n";
  text.body("lower", 1.0, 1.0 / 12.0, 0.5, 0.0, angle);
  text.body("upper", 1.0, 1.0 / 12.0, 1.5, 0.0, angle);
  text.element("revolute", "foot", "a = " + text.at("lower", 0.0, 0.0) + "\nb = \"ground\"");
  text.element("revolute", "knee", "a = " + text.at("upper", 1.0, 0.0) + "\nb = " + text.at("lower", 1.0, 0.0));
  text.element("rotational_spring_damper", "foot spring", "a = \"lower\"\nstiffness = " + number(c));
  text.element("rotational_spring_damper", "knee spring", "a = \"upper\"\nb = \"lower\"\nstiffness = " + number(c));
  text.element("load", "press",
               "at = { body = \"upper\", at = " + text.turned(2.0, 0.0) + ", angle = 0.0 }\nframe = \"body\"\nforce = [" + number(-load) +
                   ", 0.0]");
  text.add("[[channel]]\nname = \"bent\"\nexpression = \"upper.theta - lower.theta\"\nunit = \"rad\"\n");
  text.criterion("bent", 0.1);
  scene.text = text.text();
  scene.what = "column under " + number(load / high) + " of the load that follows it and lets it flutter, rate " + number(rate) + ", leg " +
               number(leg) + " s";
  return scene;
}

// A mass in the middle of a radial slot of a table that turns with Ω, on a spring: r'' = (Ω² − k/m) r. That nothing but the difference of
// runs shows, which takes an exponent of about 5 to tell it from powers of time.
BalanceScene slot(Draw& draw) {
  const double turns = draw.evenly_in_powers(0.5, 30.0), mass = draw.evenly_in_powers(0.1, 10.0);
  const double share = draw.coin() ? draw.between(0.0, 0.8) : draw.between(1.1, 4.0);
  const double rate = turns * std::sqrt(std::abs(1.0 - share));
  BalanceScene scene;
  scene.balances = share < 1.0;
  const double leg = std::max(draw.between(6.0, 12.0) / rate, 0.2);
  Text text(any_angle(draw), 0.0);
  text.run(leg);
  const std::string turning = "angular_velocity = " + number(draw.coin() ? turns : -turns) + "\n";
  text.body("table", 10.0, 5.0, 0.0, 0.0, turning);
  text.body("slider", mass, 0.1 * mass, 0.0, 0.0, turning);
  text.element("revolute", "pin", "a = \"table\"");
  text.element("prismatic", "slot", "a = \"slider\"\nb = \"table\"\naxis = " + text.turned(1.0, 0.0));
  if (share > 0.0)
    text.element("spring_damper", "spring",
                 "a = \"slider\"\nb = \"table\"\naxis = " + text.turned(1.0, 0.0) +
                     "\nstiffness = " + number(share * mass * turns * turns) + "\nfree_length = 0.0");
  text.add("[[channel]]\nname = \"away\"\nexpression = \"hypot(slider.x, slider.y)\"\nunit = \"m\"\n");
  text.criterion("away", 0.1);
  scene.text = text.text();
  scene.what = "slider on a table with " + number(turns) + " rad/s and a spring of " + number(share) + ", leg " + number(leg) + " s";
  return scene;
}

// A rod that stands or hangs and touches stops without pressing them: at one side it falls, between two it does not.
BalanceScene beside_stop(Draw& draw) {
  const double length = draw.evenly_in_powers(0.02, 50.0), mass = draw.evenly_in_powers(0.1, 1e3),
               rate = std::sqrt(1.5 * k_gravity / length);
  const bool is_upright = draw.choice(4) > 0;
  const int stops = draw.choice(6); // lower, upper, freewheel either way, rope, both stops
  BalanceScene scene;
  const double leg = leg_of(draw, rate, scene.balances);
  scene.balances = scene.balances && is_upright && stops < 5;
  const double side = is_upright ? 1.0 : -1.0;
  Text text(any_angle(draw));
  text.run(leg);
  text.body("rod", mass, mass * length * length / 12.0, 0.0, 0.5 * side * length);
  text.element("revolute", "pin", "a = " + text.at("rod", 0.0, 0.0));
  const std::string stiffness = "\nstiffness = " + number(mass * k_gravity * length * draw.evenly_in_powers(1e2, 1e5));
  if (stops == 0 || stops == 5) text.element("limit", "right", "a = \"rod\"\nlower = 0.0" + stiffness);
  if (stops == 1 || stops == 5) text.element("limit", "left", "a = \"rod\"\nupper = 0.0" + stiffness);
  if (stops == 2 || stops == 3)
    text.element("freewheel", "lock", std::string("a = \"rod\"\nfree = \"") + (stops == 2 ? "counter_clockwise" : "clockwise") + "\"");
  if (stops == 4)
    text.element("rope", "stay",
                 "a = " + text.at("rod", 0.0, side * length) + "\nb = " + text.at("ground", length, side * length) +
                     "\ninextensible = true");
  text.criterion("rod.theta", 0.1);
  scene.text = text.text();
  scene.what = std::string(is_upright ? "upright" : "hanging") + " rod of " + number(length) + " m with stops " + std::to_string(stops) +
               ", leg " + number(leg) + " s";
  scene.is_sound = stops > 1 && stops < 5; // at a stop it may move by rounding, which is then all that is known of its motion
  return scene;
}

} // namespace

BalanceScene balance_scene(std::uint64_t seed) {
  Draw draw(seed);
  constexpr std::array k_kinds = {rod, column, toggle, ball, box, carried, trailer, swing, pulled, follower, slot, beside_stop};
  return k_kinds[seed % k_kinds.size()](draw);
}

} // namespace steplap

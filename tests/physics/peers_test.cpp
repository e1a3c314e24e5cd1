// Planar tests of other programs (tests/data/peers) against truths that do not come from steplap: closed forms and
// small integrations in minimal coordinates, and against the digits that the other program keeps.
#include "tests/physics/peers_truth.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_g = 9.81, k_g_modelica = 9.80665;

/// The cranks of both windows turn alike and the couplers do not turn, so that one angle and 3 kg m² remain.
double iftomm_four_bar() {
  const auto rate = [](double, const Unknowns<2>& y) { return Unknowns<2>{y[1], -3.5 * k_g * std::cos(y[0]) / 3.0}; };
  return 0.5 * std::cos(integrate<2>(rate, {0.5 * k_pi, -1.0}, 4.0, 40000)[0]);
}

/// A ball of 0.25 kg whose centre touches at 0.05 m.
double ball(double y, double v, double k, double c, double end, int steps) {
  const auto mode = [](const Unknowns<2>& s) { return s[0] < 0.05 ? 1 : 0; };
  const auto rate = [&](int closed, const Unknowns<2>& s) {
    return Unknowns<2>{s[1], -k_g + (closed ? -k * (s[0] - 0.05) - c * s[1] : 0.0) / 0.25};
  };
  return integrate_piecewise<2>(mode, rate, {y, v}, end, steps)[0];
}
double undamped_contact() { return ball(0.06, -1.0, 2e4, 0.0, 0.5, 100000); }
double damped_contact() { return ball(0.1, 0.0, 2e6, 200.0, 0.25, 250000); }

/// Bars of 2, 5 and 5 m. The start's velocities stretch the coupler: what is left of them is their part along the
/// mechanism's only motion, in the metric of the masses.
double exudyn_four_bar() {
  const auto points = [](double q) {
    const PathPoint n1 = 2.0 * direction(q);
    return std::vector<Weight>{{3.0, n1, true}, {3.0, meeting(n1, 5.0, fixed(4.0, 0.0), 5.0, 1.0), true}};
  };
  double along = 0.0, inertia = 0.0;
  const double start_vx[] = {4.0, 10.0};
  const std::vector<Weight> start = points(0.5 * k_pi);
  for (std::size_t i = 0; i < 2; ++i) {
    along += start[i].at.x.d * start_vx[i];
    inertia += start[i].at.x.d * start[i].at.x.d + start[i].at.y.d * start[i].at.y.d;
  }
  OneFreedom m;
  m.weights = points;
  return 2.0 * std::sin(integrate(m, 0.5 * k_pi, along / inertia, 2.0, 40000));
}

Unknowns<6> exudyn_rigid_body() {
  const auto rate = [](double, const Unknowns<6>& y) {
    const double rx = -0.5 * std::cos(y[2]), ry = -0.5 * std::sin(y[2]);
    const double fx = -5e5 * (y[0] + rx + 1.0) - 5e3 * (y[3] - y[5] * ry);
    const double fy = -5e5 * (y[1] + ry - 1.0) - 5e3 * (y[4] + y[5] * rx);
    return Unknowns<6>{y[3], y[4], y[5], fx / 12.0, fy / 12.0 - k_g, rx * fy - ry * fx};
  };
  return integrate<6>(rate, {-0.5, 1.0, 0.0, 0.0, 0.0, 0.0}, 0.4, 200000);
}

double planar_four_bar() {
  OneFreedom m;
  m.gravity_y = -k_g_modelica;
  m.damping = [](double) { return 0.1; };
  m.weights = [](double q) {
    const double a = std::hypot(0.1, 1.1), b = std::hypot(0.65, 0.1);
    const PathPoint crank = direction(q), pin = 0.4 * crank, ground = fixed(-0.15, 1.0);
    const PathPoint end = meeting(pin, a, ground, b, -1.0);
    const PathPoint e2 = (1.0 / a) * (end - pin), e4 = (1.0 / b) * (end - ground);
    // Centres of gravity in the axes along and across the bodies' chords (0.1, 1.1) and (0.65, 0.1).
    const PathPoint c2 = pin + ((0.05 * 0.1 + 0.55 * 1.1) / a) * e2 + ((0.55 * 0.1 - 0.05 * 1.1) / a) * left_of(e2);
    const PathPoint c4 = ground + ((0.325 * 0.65 + 0.05 * 0.1) / b) * e4 + ((0.05 * 0.65 - 0.325 * 0.1) / b) * left_of(e4);
    return std::vector<Weight>{{7.7, 0.2 * crank, true},       {0.10427083333333337, crank, false}, {21.26231995808548, c2, true},
                               {2.166098845729958, e2, false}, {12.659710946542186, c4, true},      {0.4589145218121543, e4, false}};
  };
  return integrate(m, 0.0, 0.0, 5.0, 40000);
}

double engine() {
  OneFreedom m;
  m.gravity_x = -k_g_modelica;
  m.gravity_y = 0.0;
  m.weights = [](double q) {
    const PathPoint crank = direction(q), pin = 0.1 * crank;
    const PathPoint gudgeon = {pin.x + sqrt(Jet2{0.04} - pin.y * pin.y), {0.0}};
    return std::vector<Weight>{{3.59617239177452, 0.036546660839746455 * crank, true},
                               {1.0066274156964152, crank, false},
                               {1.848, 0.5 * (pin + gudgeon), true},
                               {0.0067144, 5.0 * (gudgeon - pin), false},
                               {6.047565858160353, gudgeon, true}};
  };
  return integrate(m, 0.0, 10.0, 5.0, 50000);
}

/// Two masses on the line between the ground and the box's end, 0.2 m from each; a damper lies along the line.
double line_force() {
  const auto line = [](double q) { return fixed(0.0, 0.3) + 0.7 * direction(q) - fixed(0.0, -0.9); };
  OneFreedom m;
  m.gravity_y = -k_g_modelica;
  m.damping = [line](double q) {
    const Jet2 length = sqrt(dot(line(q), line(q)));
    return 3.0 * length.d * length.d;
  };
  m.weights = [line](double q) {
    const PathPoint box = direction(q), e = unit(line(q));
    return std::vector<Weight>{{6.602749999999999, 0.35 * box, true},
                               {0.2702863223958332, box, false},
                               {1.0, 0.2 * e, true},
                               {1.0, 0.7 * box - 0.2 * e, true},
                               {2e-9, e, false}};
  };
  return integrate(m, 0.0, 0.0, 3.0, 40000);
}

double double_pendulum() {
  const auto rate = [](double, const Unknowns<4>& y) { // q1, q2 from the horizontal, their rates
    const double mass = 13.86, own = 0.292908, l = 0.5, c = 0.25, cosine = std::cos(y[0] - y[1]), sine = std::sin(y[0] - y[1]);
    const double a = own + mass * (c * c + l * l), b = mass * l * c * cosine, d = own + mass * c * c;
    const double f1 = -mass * k_g_modelica * (c + l) * std::cos(y[0]) - mass * l * c * sine * y[3] * y[3] - 0.1 * y[2];
    const double f2 = -mass * k_g_modelica * c * std::cos(y[1]) + mass * l * c * sine * y[2] * y[2];
    const double det = a * d - b * b;
    return Unknowns<4>{y[2], y[3], (d * f1 - b * f2) / det, (a * f2 - b * f1) / det};
  };
  return integrate<4>(rate, {0.0, 0.0, 0.0, 0.0}, 3.0, 60000)[0];
}

double spring_damper_system() {
  const auto rate = [](double, const Unknowns<6>& y) { // centre of gravity, angle, their rates
    const double rx = -0.2 * std::sin(y[2]), ry = 0.2 * std::cos(y[2]);
    const double dx = y[0] + rx - 0.3, dy = y[1] + ry, length = std::hypot(dx, dy);
    const double speed = (dx * (y[3] - y[5] * ry) + dy * (y[4] + y[5] * rx)) / length;
    const double pull = -(30.0 * (length - 0.1) + 2.0 * speed) / length;
    const double fx = pull * dx, fy = pull * dy;
    return Unknowns<6>{y[3], y[4], y[5], fx, fy - k_g_modelica, (rx * fy - ry * fx) / 0.1};
  };
  return integrate<6>(rate, {0.3, -0.4, 0.0, 0.006981317007977318, 0.0, 0.03490658503988659}, 10.0, 100000)[2];
}
double free_oscillator() { return -0.1 - k_g_modelica / 30.0 * (1.0 - std::cos(10.0 * std::sqrt(30.0))); }

/// The gear of ratio 10 adds 0.1 · 10² to the second inertia.
double first() {
  const auto rate = [](double t, const Unknowns<4>& y) {
    const double spring = 1e4 * (y[1] - y[0]);
    return Unknowns<4>{y[2], y[3], (100.0 * std::sin(10.0 * k_pi * t) + spring - 10.0 * y[2]) / 12.0, -spring / 2.0};
  };
  return integrate<4>(rate, {0.0, 0.0, 0.0, 0.0}, 1.0, 100000)[1];
}

/// Between two springs and dampers without gaps: ẍ + 3 ẋ + 20 x = 0 from 2 m.
double without_gap() {
  const double w = std::sqrt(20.0 - 2.25), t = 5.0;
  return 2.0 * std::exp(-1.5 * t) * (std::cos(w * t) + 1.5 / w * std::sin(w * t));
}
/// Between two walls at ±0.5 m that push and do not pull.
double elasto_gap() {
  const auto push = [](double depth, double rate) { return 10.0 * depth + 1.5 * rate; };
  const auto mode = [push](const Unknowns<2>& y) {
    if (y[0] > 0.5) return push(y[0] - 0.5, y[1]) > 0.0 ? 1 : 0;
    if (y[0] < -0.5) return push(-0.5 - y[0], -y[1]) > 0.0 ? 2 : 0;
    return 0;
  };
  const auto rate = [push](int side, const Unknowns<2>& y) {
    return Unknowns<2>{y[1], side == 1 ? -push(y[0] - 0.5, y[1]) : side == 2 ? push(-0.5 - y[0], -y[1]) : 0.0};
  };
  return integrate_piecewise<2>(mode, rate, {2.0, 0.0}, 5.0, 100000)[0];
}

/// Four masses of 1 kg in a row with rigid dry friction between neighbours: 0.5 N where they slip, 0.55 N where they
/// stick. The pads' springs pass on the loads' impulses entirely and are too stiff to matter in nine digits.
class Clutches {
public:
  /// The first mass's way after 1.5 s. Loads jump at the ends of spans only, and steps end there.
  double first_way() {
    const double ends[] = {0.4, 0.9, 1.25, 1.5};
    for (span_ = 0; span_ < 4; ++span_) {
      begin_slips(t_, y_);
      while (t_ < ends[span_]) advance(std::min(1e-4, ends[span_] - t_), ends[span_]);
    }
    return y_[0];
  }

private:
  using Row = Unknowns<5>; // way of the first, velocities of all

  [[nodiscard]] double load(int i, double t) const {
    if (i == 0) return span_ < 3 ? 20.0 * std::cos(0.4 * k_pi * t) : 0.0;
    return span_ >= i ? 20.0 : 0.0;
  }
  /// Rates; those of masses that stick to each other are one. `friction_` is what each contact then carries.
  Row rates(double t, const Row& y) {
    Row r{y[1]};
    for (int a = 0, b; a < 4; a = b + 1) {
      for (b = a; b < 3 && way_[b] == 0;) ++b;
      const double in = a > 0 ? friction_[a - 1] : 10.0 * std::sin(10.0 * k_pi * t);
      if (b < 3) friction_[b] = 0.5 * load(b, t) * way_[b];
      const double rate = (in - (b < 3 ? friction_[b] : 0.0)) / (b - a + 1);
      for (int i = a; i < b; ++i) friction_[i] = (i == a ? in : friction_[i - 1]) - rate;
      for (int i = a; i <= b; ++i) r[i + 1] = rate;
    }
    return r;
  }
  Row step(double h) {
    return rk4_step<5>([this](double t, const Row& y) { return rates(t, y); }, t_, y_, h);
  }
  /// The first contact that may not go on as it does, 3 if there is none.
  int violated(double t, const Row& y) {
    rates(t, y);
    for (int i = 0; i < 3; ++i)
      if (way_[i] == 0 ? std::abs(friction_[i]) > 0.55 * load(i, t) : way_[i] * (y[i + 1] - y[i + 2]) < 0.0) return i;
    return 3;
  }
  void begin_slips(double t, const Row& y) {
    for (int i = violated(t, y); i < 3 && way_[i] == 0; i = violated(t, y)) way_[i] = friction_[i] > 0.0 ? 1 : -1;
  }
  void advance(double h, double end) {
    if (violated(t_ + h, step(h)) < 3) {
      double before = 0.0;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (before + h);
        (violated(t_ + middle, step(middle)) == 3 ? before : h) = middle;
      }
      y_ = step(h);
      t_ += h;
      const int i = violated(t_, y_);
      if (i < 3 && way_[i] != 0) { // it has come to rest: their velocities are equal to rounding
        way_[i] = 0;
        y_[i + 2] = y_[i + 1];
      }
      begin_slips(t_, y_);
    } else {
      y_ = step(h);
      t_ = end - t_ <= h ? end : t_ + h;
    }
  }

  int span_ = 0;
  int way_[3] = {1, 1, 0}; ///< direction of slip; 0 sticks
  double friction_[3] = {0.0, 0.0, 0.0};
  double t_ = 0.0;
  Row y_{0.0, 10.0, 0.0, 0.0, 0.0};
};
double coupled_clutches() { return Clutches().first_way(); }

struct Peer {
  const char* file;
  const char* channel;
  double end;
  double (*truth)();
  double within; ///< of the truth
  double theirs; ///< what the other program keeps as its reference; NaN where none is noted here
  double off;    ///< most by which theirs differs from the truth: what its fixed step, or its tolerance of
                 ///< 1e-4 to 1e-6, is worth, as a power of ten above the difference found
  const char* integrator = "dop853";
  double tolerance = 1e-12;
};

// Ours is run at 1e-12 with some hundred to thousand steps, and fixed steps of the truths leave 1e-12 to 1e-10:
// 1e-9 of quantities of about one leaves room for both and for nothing else.
constexpr double k_within = 1e-9;
constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

const std::vector<Peer>& peers() {
  static const std::vector<Peer> list = {
      {"iftomm_four_bar", "b0.x", 4.0, iftomm_four_bar, k_within, 0.05815092990659491, 1e-3},             // step 0.01 s
      {"exudyn_undamped_contact", "ball.y", 0.5, undamped_contact, k_within, 0.057286638346409235, 5e-3}, // step 5 ms
      {"exudyn_damped_contact", "ball.y", 0.25, damped_contact, k_within, 0.0553131995062827, 5e-4},
      {"exudyn_four_bar", "n1.y", 2.0, exudyn_four_bar, k_within, 2.0 - 2.376335780518213, 1e-3}, // step 1 ms
      {"exudyn_rigid_body", "rigid.x", 0.4, [] { return exudyn_rigid_body()[0]; }, k_within, k_none, 0.0},
      {"exudyn_rigid_body", "rigid.y", 0.4, [] { return exudyn_rigid_body()[1]; }, k_within, k_none, 0.0},
      {"exudyn_rigid_body", "rigid.theta", 0.4, [] { return exudyn_rigid_body()[2]; }, k_within, k_none, 0.0},
      {"modelica_planar_four_bar", "b1.theta", 5.0, planar_four_bar, k_within, -0.939783, 5e-4}, // tolerance 1e-6
      {"modelica_double_pendulum", "b1.theta", 3.0, double_pendulum, k_within, -2.31792856164629, 1e-4},
      {"modelica_engine1a", "crank.theta", 5.0, engine, k_within, 53.415197349631406, 1e-3},
      {"modelica_line_force", "box.theta", 3.0, line_force, k_within, k_none, 0.0},
      {"modelica_spring_damper", "b1.theta", 10.0, spring_damper_system, k_within, k_none, 0.0},
      {"modelica_spring_damper", "b2.y", 10.0, free_oscillator, k_within, -0.493617619445844, 1e-4},
      {"modelica_first", "i3.theta", 1.0, first, k_within, 0.162860011993585, 1e-5},
      {"modelica_elasto_gap", "m1.x", 5.0, without_gap, k_within, 2.0 - 2.00035037856153, 1e-6}, // from 2 m − x
      {"modelica_elasto_gap", "m2.x", 5.0, elasto_gap, k_within, k_none, 0.0},
      // Pads of 1 mg on springs of 1 MN/m are stiff: the implicit method. The
      // pads' way of 1 µm and their 1 mg leave their mark in the tenth digit.
      {"modelica_coupled_clutches", "J1.x", 1.5, coupled_clutches, 5e-9, 7.4860922, 1e-4, "rodas5p", 1e-11}};
  return list;
}

double ours(const Peer& p) {
  const Model model = read_model(std::string(STEPLAP_TEST_DATA) + "/peers/" + p.file + ".toml", transformer_catalog());
  return run(model, {p.integrator, p.tolerance, p.end}).last(p.channel);
}

} // namespace

TEST_CASE("models of other programs end where independent equations of motion end") {
  for (const Peer& p : peers()) {
    CAPTURE(p.file);
    CAPTURE(p.channel);
    const double truth = p.truth(), here = ours(p);
    CAPTURE(truth);
    CAPTURE(here);
    CHECK(std::abs(here - truth) < p.within);
    if (!std::isnan(p.theirs)) CHECK(std::abs(p.theirs - truth) < p.off);
  }
}

TEST_CASE("the sum that stands for a rigid body's pose") {
  // Kept as one number: angle and distance from the origin, of three equal bodies; made with steps of 1 ms.
  const Unknowns<6> pose = exudyn_rigid_body();
  CHECK(std::abs(3.0 * (pose[2] + std::hypot(pose[0], pose[1])) + 0.5055295700922415) < 5e-5);
}

// Modelica's gap holds its damper's force within the spring's, either way; ours, only their sum above zero. With its
// own law the same integration gives its number: the two programs differ in the law and not in how they solve it.
TEST_CASE("the second mass of ElastoGap under the law of its own program") {
  const auto push = [](double depth, double rate) { return 10.0 * depth + std::clamp(1.5 * rate, -10.0 * depth, 10.0 * depth); };
  const auto rate = [push](double, const Unknowns<2>& y) {
    return Unknowns<2>{y[1], y[0] > 0.5 ? -push(y[0] - 0.5, y[1]) : y[0] < -0.5 ? push(-0.5 - y[0], -y[1]) : 0.0};
  };
  // The kept number, a distance from x = 2 m, is made at a tolerance of 1e-6 or so.
  CHECK(std::abs(2.0 - integrate<2>(rate, {2.0, 0.0}, 5.0, 100000)[0] - 2.70788702355764) < 1e-5);
}

// The table of docs/evidence/benchmarks.md: test_peers -ns -tc="print*".
TEST_CASE("print the table of other programs' tests" * doctest::skip()) {
  for (const Peer& p : peers()) {
    const double truth = p.truth(), here = ours(p);
    char theirs[32] = "–";
    if (!std::isnan(p.theirs)) std::snprintf(theirs, sizeof theirs, "%.8g", p.theirs);
    std::printf("| `%s` | `%s`, %g s | %s | %.12g | %.12g | %.1e |\n", p.file, p.channel, p.end, theirs, truth, here,
                std::abs(here - truth));
  }
}

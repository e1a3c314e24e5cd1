#include "tests/hard/answers.h"

#include "mbd/io/csv.h"

#include <algorithm>
#include <cmath>

namespace steplap::hard {

namespace {

constexpr double k_g = 9.81, k_pi = 3.14159265358979323846;
constexpr double k_wrong = 1.0; // events are missing or too many

// Of the first event of a kind, if it is the only one.
double time_error(const Finished& run, const std::string& element, const std::string& what, double expected) {
  const std::vector<double> times = run.event_times(element, what);
  return times.size() == 1 ? std::abs(times[0] - expected) : k_wrong;
}

// Of `count` elements that all begin to slip at one instant, and nothing else happens.
double common_slip_error(const Finished& run, std::size_t count, double expected) {
  if (run.result.events.size() != count) return k_wrong;
  double worst = 0.0;
  for (const Event& event : run.result.events)
    worst = event.kind == EventKind::slips_forward ? std::max(worst, std::abs(event.t - expected)) : k_wrong;
  return worst;
}

} // namespace

// m x₁'' = −k x₁ + r k (x₂ − x₁), m x₂'' = −r k (x₂ − x₁) + F, m = 1 kg, k = 100 N/m, from rest:
// with the modes (1, φ) of λ = ω²: φ = (k + r k − λ)/(r k), each takes part with φ F/(1 + φ²)/λ ·
// (1 − cos ω t).
Answer two_springs(double ratio) {
  return [ratio](const Finished& run) {
    const double k = 100.0, stiff = ratio * k, half = 0.5 * (k + 2.0 * stiff);
    const double high = half + std::sqrt(half * half - k * stiff),
                 low = k * stiff / high; // no cancellation
    const auto far = [&](double t) {
      double x = 1.0;
      for (const double lambda : {low, high}) {
        const double phi = stiff / (stiff - lambda); // of x₁ = 1, from the second equation
        x += 10.0 * phi * phi / (1.0 + phi * phi) / lambda * (1.0 - std::cos(std::sqrt(lambda) * t));
      }
      return x;
    };
    return run.worst("far.x", far) / 0.2; // 10 N on 100 N/m, twice
  };
}

// At the end it stands compressed by its weight, m g/k, and has dissipated what it had: m g h + (m
// g)²/(2 k).
double bounce_to_rest(const Finished& run) {
  const double k = 1e5, sunk = k_g / k, lost = k_g * 1.0 + 0.5 * k_g * k_g / k;
  return std::max(std::abs(run.last("ball.y") + sunk), std::abs(run.result.statistics.dissipated - lost) / lost);
}

// Flight √(2h/g) up and down; in contact y = −m g/k + … with ω² = k/m: half a period and what
// gravity adds, t = (2/ω)(π − atan(v ω/g)), v the speed of impact.
double bounce_for_ever(const Finished& run) {
  const double omega = std::sqrt(1e5), fall = std::sqrt(2.0 / k_g), v = k_g * fall;
  const double contact = 2.0 / omega * (k_pi - std::atan(v * omega / k_g)), period = 2.0 * fall + contact;
  const std::vector<double> closes = run.event_times("floor", "closes");
  const auto expected = static_cast<std::size_t>((run.times().back() - fall) / period) + 1;
  if (closes.size() != expected) return k_wrong;
  double worst = 0.0;
  for (std::size_t i = 0; i < closes.size(); ++i) worst = std::max(worst, std::abs(closes[i] - fall - static_cast<double>(i) * period));
  return worst / period;
}

namespace {

// y = 0.1 cos 10 t against y = −0.1 + 1e-10: below it while |10 t − π| < acos(1 − 1e-9), three
// times in 2 s. The dips found: middle and half of the time of contact.
struct Dip {
  double middle, half;
};
std::vector<Dip> dips(const Finished& run) {
  const std::vector<double> closes = run.event_times("ground", "closes"), opens = run.event_times("ground", "opens");
  std::vector<Dip> found;
  if (closes.size() != opens.size()) return found;
  for (std::size_t i = 0; i < closes.size(); ++i) found.push_back({0.5 * (closes[i] + opens[i]), 0.5 * (opens[i] - closes[i])});
  return found;
}

constexpr double k_graze_rate = 10.0, k_graze_depth = 1e-9; // rad/s; of the stroke

} // namespace

double graze_time(const Finished& run) {
  const std::vector<Dip> found = dips(run);
  if (found.size() != 3) return k_wrong;
  const double half = std::acos(1.0 - k_graze_depth) / k_graze_rate;
  double worst = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double middle = (2.0 * i + 1.0) * k_pi / k_graze_rate;
    worst = std::max(worst, std::abs(found[i].middle - middle) + std::abs(found[i].half - half));
  }
  return worst / half;
}

// How deep it must have dipped to touch for so long: 1 − cos(10 t), by the half angle.
double graze_depth(const Finished& run) {
  const std::vector<Dip> found = dips(run);
  if (found.size() != 3) return k_wrong;
  double worst = 0.0;
  for (const Dip& dip : found) {
    const double sine = std::sin(0.5 * k_graze_rate * dip.half);
    worst = std::max(worst, std::abs(2.0 * sine * sine - k_graze_depth));
  }
  return worst;
}

// About x_k = μ_k N/k: slips from Δ = (μ_s − μ_k) N/k at the belt's speed v₀ until it has that
// speed again, at −Δ, which takes (2π − 2 atan(Δω/v₀))/ω; then it is carried back by 2Δ. The first
// time it slips from rest at x = 0.
double belt_cycles(const Finished& run) {
  const double omega = 10.0, speed = 0.2, n_k = k_g / 100.0, middle = 0.3 * n_k, delta = 0.1 * n_k;
  const double first = std::asin(speed / (middle * omega)) / omega;
  const double x1 = middle * (1.0 - std::cos(omega * first));
  const double carried = (middle + delta - x1) / speed;
  const double slip = (2.0 * k_pi - 2.0 * std::atan(delta * omega / speed)) / omega, stick = 2.0 * delta / speed;
  const std::vector<double> sticks = run.event_times("friction", "sticks");
  const double cycles = (run.result.final_state.t - first - carried) / (slip + stick);
  if (std::abs(static_cast<double>(sticks.size()) - cycles) > 2.0) return k_wrong;
  double worst = std::abs(sticks[0] - first);
  for (std::size_t i = 1; i < sticks.size(); ++i) {
    const double n = static_cast<double>(i);
    worst = std::max(worst, std::abs(sticks[i] - (first + carried + n * slip + (n - 1.0) * stick)));
  }
  return worst / run.result.final_state.t;
}

Answer rests(const std::string& channel) {
  return [channel](const Finished& run) {
    if (!run.result.events.empty()) return k_wrong;
    const double start = run.series(channel).front();
    return run.worst(channel, [start](double) { return start; });
  };
}

// a = (F − μN)/m = 4.905e-12 m/s², of which double precision knows F − μN to 1e-15 N: two parts in
// ten thousand.
double slips_by_a_hair(const Finished& run) {
  const double excess = 4.905000000004905 - 4.905, t = run.times().back();
  return std::abs(run.last("block.x") / (0.5 * excess * t * t) - 1.0);
}

// F = μN − 1e-6 N + 1e-6 N/s t: passes at 1 s, then v = r (t − 1)²/(2 m). The bound may be passed
// by 1e-13 of itself, which at this rate takes 5e-7 s; and N = 1e5 N/m × gap carries the rounding
// of the block's height, 1e-17 m, as 1e-12 N.
double slow_ramp(const Finished& run) {
  const double path = 1e-6 / 6.0; // at 2 s
  return std::max(time_error(run, "friction", "slips forward", 1.0), 1e-3 * std::abs(run.last("block.x") / path - 1.0));
}

// 12 N/s against (0.3 + 0.5) 9.81 N; then x = r (t − t₁)³/(6 m). How the feet share the load before
// is nobody's to know; both let go at the onset.
double two_feet(const Finished& run) {
  const double onset = 0.8 * k_g / 12.0, path = 12.0 * std::pow(1.0 - onset, 3) / 6.0 / 2.0;
  return std::max(common_slip_error(run, 2, onset), std::abs(run.last("box.x") - path));
}

namespace {

// Blocks of 1 kg, μ = 0.5: each with its share of 4.905 N/s lets go at 1 s.
double ten_blocks(const Finished& run) {
  const double rate = 4.905, onset = 1.0, left = run.times().back() - onset;
  double worst = 0.0;
  for (int i = 1; i <= 10; ++i) {
    const std::string n = std::to_string(i);
    worst = std::max(worst, std::abs(run.last("block " + n + ".x") - 2.0 * i - rate * left * left * left / 6.0));
  }
  return std::max(worst, common_slip_error(run, 10, onset));
}

} // namespace

// Apart, or joined by rods, which make the rows of sticking blocks dependent on each other.
double ten_at_once(const Finished& run) { return ten_blocks(run); }

namespace {

// The rocking box in its two coordinates that move, y and θ, by the classical Runge–Kutta method
// with steps of 2e-6 s: the force is continuous, and across its kinks an error of order h³ remains:
// k h³/m ~ 1e-13 m/s a kink.
double rocking_angle(double end) {
  struct State {
    double y, theta, vy, omega;
  };
  const double m = 100.0, inertia = 60.0, k = 4e5, half = 0.5, height = 0.8, sunk = m * k_g / (2.0 * k);
  const auto rates = [&](const State& s) {
    State d{s.vy, s.omega, -k_g, 0.0};
    for (const double side : {-half, half}) { // the foot (side, −height) in the box's axes
      const double rx = side * std::cos(s.theta) + height * std::sin(s.theta);
      const double ry = side * std::sin(s.theta) - height * std::cos(s.theta);
      const double force = std::max(0.0, -k * (s.y + ry - sunk));
      d.vy += force / m;
      d.omega += rx * force / inertia;
    }
    return d;
  };
  const auto moved = [](const State& s, const State& d, double h) {
    return State{s.y + h * d.y, s.theta + h * d.theta, s.vy + h * d.vy, s.omega + h * d.omega};
  };
  const int steps = static_cast<int>(std::lround(end / 2e-6));
  const double h = end / steps;
  State s{height, 0.0, 0.0, 0.8};
  for (int i = 0; i < steps; ++i) {
    const State a = rates(s), b = rates(moved(s, a, 0.5 * h)), c = rates(moved(s, b, 0.5 * h)), d = rates(moved(s, c, h));
    s = moved(s,
              {a.y + 2.0 * b.y + 2.0 * c.y + d.y, a.theta + 2.0 * b.theta + 2.0 * c.theta + d.theta, a.vy + 2.0 * b.vy + 2.0 * c.vy + d.vy,
               a.omega + 2.0 * b.omega + 2.0 * c.omega + d.omega},
              h / 6.0);
  }
  return s.theta;
}

} // namespace

double rocking(const Finished& run) { return std::abs(run.last("box.theta") - rocking_angle(run.times().back())); }

// Light (1 kg) at distance 1 m from heavy (r kg), which rests while it moves at 2 m/s across: 2
// rad/s about the common centre of gravity, which moves at 2/(1 + r).
Answer dumbbell(double ratio) {
  return [ratio](const Finished& run) {
    const double omega = 2.0, arm = ratio / (1.0 + ratio), centre = 1.0 / (1.0 + ratio), drift = 2.0 / (1.0 + ratio);
    return std::max({run.worst("light.x", [&](double t) { return centre + arm * std::cos(omega * t); }),
                     run.worst("light.y", [&](double t) { return drift * t + arm * std::sin(omega * t); }),
                     run.worst("heavy.x", [&](double t) { return centre - (1.0 - arm) * std::cos(omega * t); })});
  };
}

// u = x₁ − x₂ + 1 swings with ω² = k (1 + 1/r)/m, the centre of gravity moves on.
Answer two_masses(double ratio) {
  return [ratio](const Finished& run) {
    const double k = ratio > 1.0 ? 100.0 : 1e-4, v = 0.1, omega = std::sqrt(k * (1.0 + 1.0 / ratio)), drift = v / (1.0 + ratio);
    const double arm = ratio / (1.0 + ratio), amplitude = v / omega;
    const auto light = [&](double t) { return drift * t + arm * amplitude * std::sin(omega * t); };
    const auto heavy = [&](double t) { return 1.0 + drift * t - (1.0 - arm) * amplitude * std::sin(omega * t); };
    return std::max(run.worst("light.x", light), run.worst("heavy.x", heavy)) / amplitude;
  };
}

// The first crank turns at 2 rad/s from 0.5 rad; the coupler keeps its angle, through the flat
// positions too, where both branches meet: inertia carries it on along its own.
double parallelogram(const Finished& run) {
  const auto angle = [](double t) { return 0.5 + 2.0 * t; };
  return std::max({run.worst("coupler.x", [&](double t) { return 1.0 + std::cos(angle(t)); }),
                   run.worst("coupler.y", [&](double t) { return std::sin(angle(t)); }),
                   run.worst("coupler.theta", [](double) { return 0.0; }), run.worst("second.theta", angle)});
}

// Three cranks (1 kg, 0.1 kg m², pinned at 0.5 m from their centre of gravity) and a coupler of 2
// kg that does not turn: a pendulum, (3 (0.1 + 0.25) + 2) θ'' = −(3 · 0.5 + 2) g cos θ, by the
// classical Runge–Kutta method.
double redundant_loop(const Finished& run) {
  const double c = (3.0 * 0.5 + 2.0) * k_g / (3.0 * 0.35 + 2.0), end = run.times().back(), h = 1e-5;
  double theta = -1.0, omega = 0.0;
  for (int i = 0; i < static_cast<int>(std::lround(end / h)); ++i) {
    const double k1 = -c * std::cos(theta), k2 = -c * std::cos(theta + 0.5 * h * omega),
                 k3 = -c * std::cos(theta + 0.5 * h * omega + 0.25 * h * h * k1),
                 k4 = -c * std::cos(theta + h * omega + 0.5 * h * h * k2); // Nyström's form: no velocity in the force
    theta += h * omega + h * h / 6.0 * (k1 + k2 + k3);
    omega += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return std::max(std::abs(run.last("first.theta") - theta), std::abs(run.last("third.theta") - theta));
}

namespace {

// A ramp r t against a constant capacity C and inertia m: onset at C/r, then r (t − C/r)³/(6 m).
double ramped(const Finished& run, const std::string& channel, double rate, double capacity, double inertia) {
  const double onset = capacity / rate, left = run.times().back() - onset;
  const double path = rate * left * left * left / (6.0 * inertia);
  return std::max(time_error(run, "joint", "slips", onset), std::abs(run.last(channel) / path - 1.0));
}

constexpr double k_traction = 100.0 * 0.25 * 1e5; // n μ p, Pa

} // namespace

// ∬|r| dA over a square of side a = a³ (√2 + ln(1 + √2))/6; the limb's sheet stays inside the
// yoke's.
double patch_rotation(const Finished& run) {
  const double moment = k_traction * std::pow(0.6, 3) * (std::sqrt(2.0) + std::log(1.0 + std::sqrt(2.0))) / 6.0;
  return ramped(run, "limb.theta", 4e6, moment, 700.0);
}

double patch_translation(const Finished& run) { return ramped(run, "limb.x", 1.8e7, k_traction * 0.36, 1000.0); }

// 60 kN against 50 kN (1 − x/w), w = 20 mm: u = x + w (60 − 50)/50 grows as cosh √(50 kN/(m w)) t
// until x = w.
double patch_vanishes(const Finished& run) {
  const double w = 0.02, capacity = k_traction * w, lead = w * (60e3 - capacity) / capacity;
  const double rate = std::sqrt(capacity / (1000.0 * w)), apart = std::acosh((w + lead) / lead) / rate;
  return time_error(run, "joint", "comes apart", apart) / apart;
}

double long_oscillation(const Finished& run) {
  return run.worst("mass.x", [](double t) { return 0.1 * std::cos(10.0 * t); }) / 0.1;
}

namespace {

// Path of a mass of 2 kg under a force that is linear between (t_i, f_i), zero outside, at `end`:
// each piece is a cubic.
double path_under(const std::vector<double>& t, const std::vector<double>& f, double end) {
  double x = 0.0, v = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double h = t[i] - t[i - 1];
    x += v * h + h * h / 2.0 * (2.0 * f[i - 1] + f[i]) / 6.0;
    v += 0.5 * h * (f[i - 1] + f[i]) / 2.0;
  }
  return x + v * (end - t.back());
}

} // namespace

double noisy_record(const Finished& run) {
  const CsvTable table = read_csv(std::string(STEPLAP_MODELS) + "/benchmarks/hard/noise_4khz.csv", {});
  const double path = path_under(table.columns[0], table.columns[1], run.times().back());
  return std::abs(run.last("mass.x") / path - 1.0);
}

// 10 N from 0.12345 s for 0.3 s; a triangle of −30 N from 0.23456 s for 0.2 s.
double jumps(const Finished& run) {
  const double end = run.times().back();
  const double path = path_under({0.12345, 0.42345}, {10.0, 10.0}, end) + path_under({0.23456, 0.33456, 0.43456}, {0.0, -30.0, 0.0}, end);
  return std::abs(run.last("mass.x") / path - 1.0);
}

} // namespace steplap::hard

#include "tests/physics/dips.h"

#include "mbd/model/method.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <numbers>

namespace steplap::testing {

namespace {

using random::RandomNumber;

constexpr double k_two_pi = 2.0 * std::numbers::pi;
constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
// By how much of its bound what holds may pass it, for rounding's sake (joint_friction.cpp; the area of sheets whose corners are
// a kilometre off, and the share of their capacity that is in use, are known to some 1e-12), and by how
// much a rope of 1 m may be stretched before it is caught (docs/explanation/theory.md), m.
constexpr double k_bound_slack(Hair hair) { return hair == Hair::friction ? 1e-13 : 4e-12; }
constexpr double k_dead_band = 2e-11;
// Of its range, how far a motion of a few periods may be off, in tolerances of its steps.
constexpr double k_grown = 30.0;
// The same of the fixed steps that are used: (ω h)⁴/120 of a radian in each radian.
constexpr double k_of_fixed_steps = 1e-5;

std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string list(const std::vector<double>& values) {
  std::string text = "[";
  for (const double v : values) text += (text.size() > 1 ? ", " : "") + digits(v);
  return text + "]";
}

// offset + Σ A cos(2π f t + φ)
struct Harmonics {
  double offset = 0.0;
  std::vector<double> amplitude, frequency, phase;

  [[nodiscard]] double at(double t) const {
    double sum = offset;
    for (std::size_t i = 0; i < amplitude.size(); ++i) sum += amplitude[i] * std::cos(k_two_pi * frequency[i] * t + phase[i]);
    return sum;
  }
  [[nodiscard]] double slope(double t) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < amplitude.size(); ++i)
      sum -= amplitude[i] * k_two_pi * frequency[i] * std::sin(k_two_pi * frequency[i] * t + phase[i]);
    return sum;
  }
  [[nodiscard]] double integral(double t) const {
    double sum = offset * t;
    for (std::size_t i = 0; i < amplitude.size(); ++i)
      sum += amplitude[i] / (k_two_pi * frequency[i]) * std::sin(k_two_pi * frequency[i] * t + phase[i]);
    return sum;
  }
  [[nodiscard]] double fastest() const { return k_two_pi * *std::max_element(frequency.begin(), frequency.end()); }
  [[nodiscard]] double size() const {
    double sum = std::abs(offset);
    for (const double a : amplitude) sum += std::abs(a);
    return sum;
  }
};

// The root of f between a, where it has another sign than at b, and b.
template <class F> double root(const F& f, double a, double b) {
  const bool is_rising = f(b) > 0.0;
  for (int i = 0; i < 200 && a < b; ++i) {
    const double middle = 0.5 * (a + b);
    if (middle <= a || middle >= b) break;
    (((f(middle) > 0.0) == is_rising) ? b : a) = middle;
  }
  return b;
}

// Places of the extremes of a sum of harmonics, from a sign change of its slope in a grid of which its fastest one has 200.
std::vector<double> peaks_of(const Harmonics& f, double end) {
  std::vector<double> peaks;
  const double step = k_two_pi / f.fastest() / 200.0;
  for (double t = 0.0; t < end; t += step)
    if (f.slope(t) > 0.0 && f.slope(t + step) <= 0.0) peaks.push_back(root([&f](double x) { return -f.slope(x); }, t, t + step));
  return peaks;
}

// Slips of what sticks as long as the load is at most `holds`, and then takes `drags` until it rests; false: it is a matter
// of rounding or tolerance when some slip ends.
bool find_slips(const Harmonics& load, double holds, double drags, double mass, DipCase& dip) {
  const double step = k_two_pi / load.fastest() / 400.0;
  const std::vector<double> peaks = peaks_of(load, dip.end);
  double t = 0.0;
  for (;;) {
    const auto peak = std::find_if(peaks.begin(), peaks.end(), [&](double p) { return p > t && load.at(p) > holds; });
    if (peak == peaks.end()) return load.at(dip.end) < holds;
    double before = *peak;
    while (before > t && load.at(before) > holds) before -= step;
    const double slip = root([&](double x) { return load.at(x) - holds; }, std::max(before, t), *peak);
    dip.begin.push_back(slip);
    dip.rounding.push_back((16.0 * k_epsilon * load.size() + 1.01 * k_bound_slack(dip.hair) * holds) / std::abs(load.slope(slip)));
    dip.motion.push_back(0.0);
    const auto speed = [&](double x) { return (load.integral(x) - load.integral(slip) - drags * (x - slip)) / mass; };
    double fastest = 0.0;
    if (!(speed(slip + step) > 0.0)) return false; // over before it can be told apart
    for (t = slip + step; t < dip.end && speed(t) > 0.0; t += step) {
      fastest = std::max(fastest, speed(t));
      const bool is_turning = speed(t) < speed(t - step) && speed(t) < speed(t + step);
      if (is_turning && speed(t) < 0.2 * fastest) return false; // it all but rests
    }
    if (t >= dip.end) return true;
    t = root([&](double x) { return -speed(x); }, t - step, t);
    if (load.at(t) > drags - 0.02 * (holds - drags)) return false;
  }
}

Harmonics random_load(RandomNumber& random) {
  Harmonics load;
  const int count = 1 + random.below(3);
  const double base = random.decades(-1.0, 1.0);
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    load.frequency.push_back(i == 0 ? base : base * random.between(1.1, 4.0));
    load.amplitude.push_back(10.0 * random.between(0.2, 1.0));
    load.phase.push_back(random.between(0.0, k_two_pi));
    sum += load.amplitude.back();
  }
  load.offset = sum * random.between(1.0, 3.0);
  return load;
}

std::string signal_of(const Harmonics& load) {
  return signal_entry("harmonics", "s",
                      "offset = " + digits(load.offset) + "; amplitudes = " + list(load.amplitude) +
                          "; frequencies = " + list(load.frequency) + "; phases = " + list(load.phase));
}

const char* const k_body = "mass = 10.0; inertia = 1.0";

std::string held_by_friction(double holds, double drags) {
  return body("b", k_body) + element("prismatic", "road", "a = 'b'; axis = [1.0, 0.0]") +
         element("joint_friction", "held", "a = 'b'; coordinate = 'x'; holds = " + digits(holds) + "; drags = " + digits(drags));
}

// Sheets of 0.02 m², pressed by 1e5 Pa, that move along each other and stay covered.
std::string held_by_sheets(double holds, double drags) {
  return body("b", k_body) + element("step_lap_joint", "held", "limb = 'b'; active_part = 'ground'") +
         element("step_lap_interface", "sheets",
                 "joint = 'held'; yoke = [[-1e3, -1e3], [1e3, -1e3], [1e3, 1e3], [-1e3, 1e3]]; limb = [[-0.1, -0.05], [0.1, -0.05], [0.1, "
                 "0.05], [-0.1, 0.05]]; pressure = 1e5; static_friction = " +
                     digits(holds / 2000.0) + "; kinetic_friction = " + digits(drags / 2000.0));
}

DipCase held(Hair hair, RandomNumber& random, double depth) {
  for (;;) {
    DipCase dip;
    const Harmonics load = random_load(random);
    dip.hair = hair;
    dip.element = "held";
    dip.begins = "slips";
    dip.fastest = load.fastest();
    dip.end = random.between(2.0, 5.0) / load.frequency[0];
    const std::vector<double> peaks = peaks_of(load, dip.end);
    double least = load.offset;
    for (double t = 0.0; t < dip.end; t += 0.01 / load.frequency[0]) least = std::min(least, load.at(t));
    double top = 0.0;
    for (const double p : peaks) top = std::max(top, load.at(p));
    if (depth > 0.0 && random.chance(0.5)) top = std::max(load.at(random.one_of(peaks)), load.offset); // not always the highest one
    const double holds = top - depth * (top - least), drags = load.offset + random.between(0.3, 0.8) * (holds - load.offset);
    if (load.at(0.0) >= holds - 1e-3 * (top - least) || load.at(dip.end) >= holds - 1e-3 * (top - least)) continue;
    if (!find_slips(load, holds, drags, 10.0, dip)) continue;
    dip.text = k_no_gravity + (hair == Hair::friction ? held_by_friction(holds, drags) : held_by_sheets(holds, drags)) + signal_of(load) +
               element("load", "pull", "at = 'b'; force_x = 's'");
    return dip;
  }
}

// A mass on a spring, pulled by a constant force and pushed at the start: x = A (cos(ω t + φ) − cos φ); a soft stop or a rope at the
// share 1 − 2·depth of the way from its middle to its top.
DipCase oscillating(Hair hair, RandomNumber& random, double depth) {
  DipCase dip;
  const double frequency = random.decades(-1.0, 1.0), amplitude = random.between(0.05, 0.2), mass = 10.0;
  const double omega = k_two_pi * frequency;
  double phase = 0.0; // such that the start is well below
  do phase = random.between(0.5, k_two_pi - 0.5);
  while (std::cos(phase) > 0.9 - 2.0 * depth);
  const double stiffness = mass * omega * omega, middle = -amplitude * std::cos(phase), reach = middle + amplitude * (1.0 - 2.0 * depth);
  dip.hair = hair;
  dip.element = "end";
  dip.begins = hair == Hair::gap ? "closes" : "closes its gap";
  dip.fastest = omega;
  dip.end = random.between(2.0, 4.0) / frequency;
  dip.counts_all = false;
  if (depth > 0.0) {
    const double before = std::acos(1.0 - 2.0 * depth); // rad before the top
    dip.begin.push_back((k_two_pi - phase - before) / omega);
    const double speed = amplitude * omega * std::sin(before);
    dip.rounding.push_back(64.0 * k_epsilon * (1.0 + amplitude) / speed + (hair == Hair::rope ? 1.01 * k_dead_band : 0.0) / speed);
    dip.motion.push_back(2.0 * amplitude / speed);
  }
  dip.text = k_no_gravity + body("b", std::string(k_body) + "; velocity = [" + digits(-amplitude * omega * std::sin(phase)) + ", 0.0]") +
             element("prismatic", "road", "a = 'b'; axis = [1.0, 0.0]") +
             element("spring_damper", "spring", "a = 'b'; axis = [1.0, 0.0]; stiffness = " + digits(stiffness)) +
             signal_entry("constant", "s", "value = " + digits(stiffness * middle)) + element("load", "pull", "at = 'b'; force_x = 's'");
  if (hair == Hair::gap)
    dip.text += element("unilateral_contact", "end",
                        "a = 'b'; b = { body = 'ground', at = [" + digits(reach) +
                            ", 0.0] }; normal = [-1.0, 0.0]; stiffness = " + digits(1e-3 * stiffness));
  else
    dip.text += element("rope", "end", "a = 'b'; b = { body = 'ground', at = [-1.0, 0.0] }; inextensible = true; slack = " + digits(reach));
  return dip;
}

} // namespace

DipCase random_dip(Hair hair, std::uint64_t seed, double depth) {
  RandomNumber random(seed);
  return hair == Hair::friction || hair == Hair::step_lap ? held(hair, random, depth) : oscillating(hair, random, depth);
}

double dip_depth(Hair hair, std::uint64_t seed, double tolerance) {
  RandomNumber random(seed + 7777777);
  const double least = hair == Hair::friction ? 1e-7 : hair == Hair::step_lap ? 1e-6 : std::max(1e-7, k_grown * tolerance);
  const double depth = random.decades(std::log10(least), std::max(-1.3, std::log10(least) + 0.5));
  return random.chance(0.25) ? -depth : depth;
}

DipOutcome outcome(const DipCase& dip, const std::string& integrator, double step_or_tolerance) {
  DipOutcome o;
  const bool has_fixed_step = method(integrator).has_fixed_step;
  const double period = k_two_pi / dip.fastest;
  try {
    const Model model = scene(dip.text + "\n[simulation]\nstep = 1e-3\n");
    const auto system = compile(model);
    SimulationOptions options;
    options.end = dip.end;
    options.integrator = integrator;
    options.output_step = dip.end;
    if (has_fixed_step) options.settings.step = step_or_tolerance * period;
    else options.settings.tolerance = step_or_tolerance;
    const RunResult result = simulate(*system, system->initial_state(), options);
    std::vector<double> found;
    for (const Event& event : result.events)
      if (event.element == dip.element && event.words().starts_with(dip.begins)) found.push_back(event.t);
    o.wanted = static_cast<int>(dip.begin.size());
    o.found = static_cast<int>(found.size());
    if (!dip.counts_all) o.found = std::min(o.found, o.wanted), found.resize(static_cast<std::size_t>(o.found));
    if (dip.begin.empty()) o.found = static_cast<int>(result.events.size());
    // While it sticks the load alone tells: a root is closed in on to a millionth of the tolerance, in steps of at most a
    // quarter of the fastest period, and to some spacings of the time. What moves is known to its tolerance besides.
    const double closing = 0.25 * period * 8e-6 * (has_fixed_step ? 0.0 : std::min(step_or_tolerance, 1e-3)) + 64.0 * k_epsilon * dip.end;
    for (std::size_t i = 0; i < std::min(found.size(), dip.begin.size()); ++i) {
      const double of_motion = k_grown * (has_fixed_step ? k_of_fixed_steps : step_or_tolerance) * dip.motion[i];
      o.worst = std::max(o.worst, std::abs(found[i] - dip.begin[i]) / (closing + dip.rounding[i] + of_motion));
    }
  } catch (const std::exception& e) {
    o.failure = e.what();
  }
  return o;
}

} // namespace steplap::testing

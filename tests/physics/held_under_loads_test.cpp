// Friction that holds under loads faster than anything that moves: no slip is missed, whatever the method, the
// tolerance and what else the scene holds.
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr double k_pi = std::numbers::pi;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

struct Tone {
  double amplitude, frequency, phase; // N m, Hz, rad
};

// Torque on a wheel of 1 kg m² and its integral.
struct Torque {
  std::vector<Tone> tones;
  [[nodiscard]] double at(double t) const {
    double sum = 0.0;
    for (const Tone& x : tones) sum += x.amplitude * std::cos(2.0 * k_pi * x.frequency * t + x.phase);
    return sum;
  }
  [[nodiscard]] double integral(double t) const {
    double sum = 0.0;
    for (const Tone& x : tones) sum += x.amplitude / (2.0 * k_pi * x.frequency) * std::sin(2.0 * k_pi * x.frequency * t + x.phase);
    return sum;
  }
};

struct Change {
  double t;
  int sign; // of the slip that begins, 0: rest
};

// Closed form between changes: at rest while |M| ≤ hold; sliding one way the rate is ∫ (M − sign·hold) dt. Changes are
// bracketed by steps of a thousandth of the shortest period and bisected to rounding.
std::vector<Change> exact_changes(const Torque& torque, double hold, double end) {
  double fastest = 0.0;
  for (const Tone& x : torque.tones) fastest = std::max(fastest, x.frequency);
  const double step = 1e-3 / fastest;
  std::vector<Change> changes;
  int sign = 0;
  double since = 0.0;
  const auto bad = [&](double t) { // has the present mode ended by t?
    if (sign == 0) return std::abs(torque.at(t)) > hold;
    return sign * (torque.integral(t) - torque.integral(since)) - hold * (t - since) < 0.0;
  };
  for (double t = 0.0; t < end;) {
    const double next = std::min(end, t + step);
    if (!bad(next)) {
      t = next;
      continue;
    }
    double low = t, high = next;
    for (int i = 0; i < 80; ++i) {
      const double middle = 0.5 * (low + high);
      (bad(middle) ? high : low) = middle;
    }
    if (sign == 0) sign = torque.at(high) > 0.0 ? 1 : -1;
    else sign = std::abs(torque.at(high)) > hold ? (torque.at(high) > 0.0 ? 1 : -1) : 0;
    since = t = high;
    changes.push_back({high, sign});
  }
  return changes;
}

std::string wheel(const Torque& torque, double hold, double slow_speed, const std::string& name = "torque") {
  std::string amplitudes, frequencies, phases;
  for (const Tone& x : torque.tones) {
    const char* comma = amplitudes.empty() ? "" : ", ";
    amplitudes += comma + number(x.amplitude);
    frequencies += comma + number(x.frequency);
    phases += comma + number(x.phase);
  }
  std::string text = "gravity = [0.0, 0.0]\n[[signal]]\nname = \"" + name + "\"\nkind = \"harmonics\"\namplitudes = [" + amplitudes +
                     "]\nfrequencies = [" + frequencies + "]\nphases = [" + phases + "]\n";
  text += "[[body]]\nname = \"wheel\"\nmass = 1.0\ninertia = 1.0\n[[element]]\nkind = \"revolute\"\nname = \"pin\"\na = \"wheel\"\n"
          "[[element]]\nkind = \"joint_friction\"\nname = \"bearing\"\na = \"wheel\"\nholds = " +
          number(hold) + "\n[[element]]\nkind = \"load\"\nname = \"load\"\nat = \"wheel\"\ntorque = \"" + name + "\"\n";
  if (slow_speed > 0.0)
    text += "[[body]]\nname = \"slow\"\nmass = 1.0\ninertia = 1.0\nposition = [3.0, 0.0]\nvelocity = [" + number(slow_speed) +
            ", 0.0]\n[[element]]\nkind = \"spring_damper\"\nname = \"spring\"\na = \"slow\"\nb = { body = \"ground\", at = [2.0, 0.0] }\n"
            "axis = [1.0, 0.0]\nstiffness = 10.0\n";
  return text;
}

void check_changes(const Run& r, const std::vector<Change>& exact, double within) {
  std::vector<Change> found;
  for (const Event& event : r.result.events)
    found.push_back({event.t, event.kind == EventKind::sticks ? 0 : event.kind == EventKind::slips_forward ? 1 : -1});
  REQUIRE(found.size() == exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    CHECK(found[i].sign == exact[i].sign);
    CHECK(std::abs(found[i].t - exact[i].t) < within);
  }
}

// splitmix64
struct Random {
  std::uint64_t state;
  double operator()(double low, double high) {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return low + (high - low) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
};

const std::vector<Settings> k_methods = {{"auto", 1e-9, 2.0},  {"dop853", 1e-9, 2.0},  {"dop853", 1e-4, 2.0}, {"tsit5", 1e-9, 2.0},
                                         {"tsit5", 1e-3, 2.0}, {"rodas5p", 1e-9, 2.0}, {"rk4", 1e-3, 2.0},    {"rk4", 0.1, 2.0}};

// A slip found is in place; where it ends is as exact as the run: rates to the tolerance over decelerations of some N m.
double within(const Settings& s) { return s.step_or_tolerance < 1e-6 ? 1e-7 : 2e-3; }

} // namespace

TEST_CASE("held under loads: a wheel under two frequencies slips at every instant of the closed form, with every method") {
  const Torque torque{{{7.0, 0.7, 0.0}, {4.0, 23.0, 1.7}}};
  const std::vector<Change> exact = exact_changes(torque, 10.0, 2.0);
  REQUIRE(exact.size() == 28);
  CHECK(std::abs(exact[0].t - 0.026842278) < 1e-9);
  for (const double slow : {0.0, 0.3})
    for (const Settings& s : k_methods) {
      CAPTURE(s.integrator);
      CAPTURE(s.step_or_tolerance);
      CAPTURE(slow);
      check_changes(run(wheel(torque, 10.0, slow), s), exact, within(s));
    }
}

TEST_CASE("held under loads: random loads of up to six frequencies over two decades") {
  Random random{2026};
  int slips = 0;
  for (int scene_number = 0; scene_number < 12; ++scene_number) {
    Torque torque;
    const int tones = 2 + scene_number % 5;
    double sum = 0.0;
    for (int i = 0; i < tones; ++i) {
      torque.tones.push_back({random(1.0, 5.0), 0.5 * std::pow(10.0, random(0.0, 2.0)), random(0.0, 2.0 * k_pi)});
      sum += torque.tones.back().amplitude;
    }
    const double hold = sum * random(0.55, 0.95);
    const std::vector<Change> exact = exact_changes(torque, hold, 1.0);
    slips += static_cast<int>(exact.size());
    CAPTURE(scene_number);
    for (const Settings& s : {Settings{"auto", 1e-9, 1.0}, Settings{"tsit5", 1e-12, 1.0}, Settings{"rodas5p", 1e-8, 1.0}}) {
      CAPTURE(s.integrator);
      check_changes(run(wheel(torque, hold, scene_number % 2 == 0 ? 0.0 : 0.2), s), exact, 1e-6);
    }
  }
  CHECK(slips > 50); // else the scenes say nothing
}

TEST_CASE("held under loads: bursts, and a record with a single spike") {
  // Ten seconds of rest with a burst of 0.05 s in them: 60 Hz, twice the bound.
  const std::string burst = "gravity = [0.0, 0.0]\n[[signal]]\nname = \"torque\"\nkind = \"harmonics\"\namplitudes = [20.0]\n"
                            "frequencies = [60.0]\nphases = [-1.5707963267948966]\nstart = 7.3\nduration = 0.05\n";
  const std::string whole = wheel({{{1.0, 1.0, 0.0}}}, 10.0, 0.0);
  const std::string text = burst + whole.substr(whole.find("[[body]]"));
  // sin reaches one half a twelfth of a period after each of its beginnings; the first slip begins at 7.3 s + T/12.
  const double first = 7.3 + 1.0 / 60.0 / 12.0;
  for (const char* method : {"auto", "tsit5", "rodas5p"}) {
    CAPTURE(std::string(method));
    const Run r = run(text, {method, 1e-9, 10.0});
    const std::vector<double> slips = r.event_times("bearing", "slips forward");
    REQUIRE(!slips.empty());
    CHECK(std::abs(slips.front() - first) < 1e-11);
    CHECK(r.result.events.back().kind == EventKind::sticks);
  }
}

TEST_CASE("held under loads: a margin that only grazes its bound between two ends of a step") {
  // Peaks of both tones, of 5 and 6 Hz, fall together at 0.5 s only: 10.02 N m, above the bound for about 2.6 ms,
  // after which what slipped has to come to rest.
  const Torque torque{{{6.0, 5.0, k_pi}, {4.02, 6.0, 0.0}}};
  const std::vector<Change> exact = exact_changes(torque, 10.0, 1.0);
  REQUIRE(exact.size() == 2);
  CHECK(exact[1].t - exact[0].t < 6e-3);
  for (const Settings& s :
       {Settings{"auto", 1e-9, 1.0}, Settings{"dop853", 1e-5, 1.0}, Settings{"tsit5", 1e-9, 1.0}, Settings{"rk4", 0.05, 1.0}}) {
    CAPTURE(s.integrator);
    check_changes(run(wheel(torque, 10.0, 0.0), s), exact, s.integrator == "rk4" ? 3e-3 : 1e-6); // rk4: a twelfth of a period a step
  }
}

// Pulses that are short against the run, the steps of a method, or both: what a body has taken from them is their integral, in
// closed form for every kind of signal. STEPLAP_PULSES: how many scenes instead of the usual number.
#include "mbd/base/number_text.h"
#include "mbd/model/method.h"
#include "mbd/trust/judge.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>

using namespace steplap;
using namespace steplap::testing;
using steplap::random::RandomNumber;

namespace {

constexpr double k_end = 1.0, k_pi = std::numbers::pi;

std::string text_of(double x) { return number_text(x); }

// A signal's entries in a model file, and its integral over the run.
struct Pulse {
  std::string text, name;
  double integral = 0.0, duration = 0.0;
};

class Pulses {
public:
  explicit Pulses(std::uint64_t seed) : random_(seed), seed_(seed) {}

  /// Of `impulse`, lasting 1e-9 to 1e-1 of the run, or a part of that if it is made of several.
  Pulse next(double impulse) {
    const double duration = k_end * random_.decades(-9.0, -1.0), start = random_.between(0.05, 0.85) * k_end;
    switch (random_.below(10)) {
    case 0: return simple("haversine", "", impulse / (0.5 * duration), start, duration, impulse);
    case 1: return simple("half_sine", "", impulse / (2.0 / k_pi * duration), start, duration, impulse);
    case 2: return simple("rectangle", "", impulse / duration, start, duration, impulse);
    case 3:
      return simple("triangle", "rise = " + text_of(random_.between(0.01, 0.99) * duration), impulse / (0.5 * duration), start, duration,
                    impulse);
    case 4: return trapezoid(impulse, start, duration);
    case 5: return harmonics(impulse, start, duration);
    case 6: return record(impulse, start, duration);
    case 7: return scaled_later(impulse, start, duration);
    case 8: return product(impulse, start, duration);
    default: return sum(impulse);
    }
  }

private:
  std::string name() { return "s" + std::to_string(count_++); }
  Pulse simple(const std::string& kind, const std::string& more, double peak, double start, double duration, double integral) {
    const std::string n = name();
    return {signal_entry(kind, n,
                         "peak = " + text_of(peak) + "; start = " + text_of(start) + "; duration = " + text_of(duration) + "; " + more),
            n, integral, duration};
  }
  Pulse trapezoid(double impulse, double start, double duration) {
    const double rise = random_.between(0.0, 0.5) * duration, fall = random_.between(0.0, 0.5) * duration;
    return simple("trapezoid", "rise = " + text_of(rise) + "; fall = " + text_of(fall), impulse / (duration - 0.5 * (rise + fall)), start,
                  duration, impulse);
  }
  Pulse harmonics(double impulse, double start, double duration) {
    const std::string n = name();
    const double offset = impulse / duration, amplitude = random_.between(-2.0, 2.0) * offset, phase = random_.between(-3.0, 3.0);
    const double frequency = random_.between(0.2, 6.0) / duration, w = 2.0 * k_pi * frequency;
    const double integral = offset * duration + amplitude / w * (std::sin(w * duration + phase) - std::sin(phase));
    return {signal_entry("harmonics", n,
                         "offset = " + text_of(offset) + "; amplitudes = [" + text_of(amplitude) + "]; frequencies = [" +
                             text_of(frequency) + "]; phases = [" + text_of(phase) + "]; start = " + text_of(start) +
                             "; duration = " + text_of(duration)),
            n, integral, duration};
  }
  Pulse record(double impulse, double start, double duration) {
    const std::string n = name();
    const std::string file = (std::filesystem::temp_directory_path() / ("steplap_pulse_" + std::to_string(seed_) + n + ".csv")).string();
    std::ofstream out(file);
    out.precision(17);
    const int rows = 3 + random_.below(20);
    double integral = 0.0, last = 0.0;
    for (int i = 0; i <= rows; ++i) {
      const double value = i == 0 || i == rows ? 0.0 : random_.between(0.0, 2.0) * impulse / duration;
      out << i * (duration / rows) << "," << value << "\n";
      integral += 0.5 * (value + last) * (duration / rows);
      last = value;
    }
    return {signal_entry("record", n, "file = \"" + file + "\"; offset = " + text_of(start)), n, integral, duration / rows};
  }
  Pulse scaled_later(double impulse, double start, double duration) {
    Pulse inner = simple("half_sine", "", 1.0 / (2.0 / k_pi * duration), 0.5 * start, duration, 1.0);
    const std::string n = name();
    inner.text +=
        signal_entry("scaled", n, "signal = \"" + inner.name + "\"; factor = " + text_of(impulse) + "; delay = " + text_of(0.5 * start));
    return {inner.text, n, impulse, duration};
  }
  // A wave within a triangle that rises only: ∫ p τ/D sin(wτ) over D, with a whole number of waves, is −p D/(2πn).
  Pulse product(double impulse, double start, double duration) {
    const int waves = 1 + random_.below(4);
    const Pulse ramp = simple("triangle", "rise = " + text_of(duration), 1.0, start, duration, 0.0);
    const std::string wave = name(), n = name();
    const double amplitude = -impulse * 2.0 * k_pi * waves / duration;
    return {ramp.text +
                signal_entry("harmonics", wave,
                             "amplitudes = [" + text_of(amplitude) + "]; frequencies = [" + text_of(waves / duration) + "]; phases = [" +
                                 text_of(-0.5 * k_pi) + "]; start = " + text_of(start)) +
                signal_entry("product", n, "signals = [\"" + ramp.name + "\", \"" + wave + "\"]"),
            n, impulse, duration};
  }
  Pulse sum(double impulse) {
    const double part = random_.between(0.2, 0.8);
    const Pulse a = next(part * impulse), b = next((1.0 - part) * impulse);
    const std::string n = name();
    return {a.text + b.text + signal_entry("sum", n, "signals = [\"" + a.name + "\", \"" + b.name + "\"]"), n, a.integral + b.integral,
            std::min(a.duration, b.duration)};
  }

  RandomNumber random_;
  std::uint64_t seed_;
  int count_ = 0;
};

struct Expected {
  std::string channel;
  double value = 0.0;
  double duration = k_end; ///< of the shortest pulse
};

// Bodies that fly freely: one pushed at its centre, one turned by a couple, one driven by a motor's effort along a line.
std::string flying(std::uint64_t seed, std::vector<Expected>& expected) {
  Pulses pulses(seed);
  RandomNumber random(seed + 1000003);
  std::string text = k_no_gravity;
  for (int i = 0; i < 3; ++i) {
    const std::string name = "b" + std::to_string(i);
    const double mass = random.decades(-1.0, 1.0), start = random.between(-1.0, 1.0);
    const bool turns = i == 1;
    text += body(name, "mass = " + text_of(mass) + "; inertia = " + text_of(mass) + "; " +
                           (turns ? "angular_velocity = " + text_of(start) : "velocity = [" + text_of(start) + ", 0.0]"));
    Expected of_body{name + (turns ? ".omega" : ".vx"), start};
    const int count = 1 + random.below(3);
    for (int k = 0; k < count; ++k) {
      const Pulse pulse = pulses.next(mass * random.between(0.5, 2.0));
      const std::string e = name + "p" + std::to_string(k);
      text += pulse.text;
      text += i == 2 ? element("motor", e, "a = \"" + name + "\"; coordinate = \"x\"; effort = \"" + pulse.name + "\"")
                     : element("load", e, "at = \"" + name + "\"; " + (turns ? "torque" : "force_x") + " = \"" + pulse.name + "\"");
      of_body.value += pulse.integral / mass;
      of_body.duration = std::min(of_body.duration, pulse.duration);
    }
    expected.push_back(of_body);
  }
  return text;
}

int case_count(int usual) {
  const char* const wanted = std::getenv("STEPLAP_PULSES");
  return wanted ? std::atoi(wanted) : usual;
}

// Of a method: what its steps may miss of a pulse, as a share of it. Fixed steps of the fourth order turn a wave by 0.4 rad at
// most, 1e-5 of its half waves; time stepping takes integrals.
double share_of(const Method& method) { return method.is_time_stepping ? 1e-9 : method.has_fixed_step ? 2e-5 : 1e-6; }

} // namespace

TEST_CASE("short pulses: every method gives a body their momentum") {
  for (int i = 0; i < case_count(100); ++i) {
    std::vector<Expected> expected;
    const Model model = scene(flying(static_cast<std::uint64_t>(i), expected));
    const auto system = compile(model);
    RandomNumber random(static_cast<std::uint64_t>(i) + 77);
    for (const Method& method : methods()) {
      SimulationOptions options;
      options.end = k_end;
      options.integrator = method.name;
      options.settings.tolerance = 1e-8;
      if (method.has_fixed_step) options.settings.step = random.decades(-3.0, -1.5);
      const RunResult result = simulate(*system, system->initial_state(), options);
      for (const Expected& e : expected) {
        CAPTURE(i);
        CAPTURE(method.name);
        CAPTURE(e.channel);
        CAPTURE(e.duration);
        const std::size_t body = static_cast<std::size_t>(e.channel[1] - '0') + 1;
        const double found = result.final_state.v[3 * body + (e.channel.ends_with("omega") ? 2 : 0)];
        // A pulse's ends are times, rounded as such.
        const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * k_end / e.duration;
        CHECK(std::abs(found - e.value) <= (share_of(method) + rounding) * 10.0);
      }
    }
  }
}

// Of a load that is far shorter than a step of time stepping bodies have the impulse, but no force or acceleration shows it, and the run
// says so. Steps end where longer pulses do (a ten-thousandth of a step is the border), and where those of drives do.
TEST_CASE("time stepping notes a pulse of a load that it passed over, and none of a drive, a longer one or another method") {
  constexpr double k_step = 1e-2;
  for (int i = 0; i < case_count(50); ++i) {
    RandomNumber random(static_cast<std::uint64_t>(i) + 500);
    const double duration = k_step * random.decades(-7.0, -4.3);
    const double start = (static_cast<double>(5 + random.below(80)) + random.between(0.05, 0.85)) * k_step;
    const std::string kind = random.one_of(std::vector<std::string>{"haversine", "half_sine"});
    const bool is_drive = random.chance(0.5);
    const double taken = (kind == "haversine" ? 0.5 : 2.0 / k_pi) * duration; // of a peak of one
    const auto run_of = [&](const std::string& method, double length) {
      const std::string pulse =
          signal_entry(kind, "p", "peak = " + text_of(1.0 / taken) + "; start = " + text_of(start) + "; duration = " + text_of(length));
      const std::string pushed = is_drive ? element("prescribed_motion", "drive", "a = \"b\"; signal = \"p\"")
                                          : element("load", "push", "at = \"b\"; force_x = \"p\"");
      Model model = scene(k_no_gravity + body("b", "mass = 1.0; inertia = 1.0") + pulse + pushed);
      const auto system = compile(model);
      SimulationOptions options;
      options.end = k_end;
      options.integrator = method;
      options.settings.tolerance = 1e-8;
      if (method == "moreau") options.settings.step = k_step;
      RunResult result = simulate(*system, system->initial_state(), options);
      return std::pair{judge(model, *system, result, "").distrust, result.statistics.passed_pulse};
    };
    CAPTURE(i);
    CAPTURE(kind);
    CAPTURE(is_drive);
    const auto [distrust, passed] = run_of("moreau", duration);
    CHECK(passed.has_value() == !is_drive);
    if (passed) CHECK(*passed == doctest::Approx(start).epsilon(1e-12));
    CHECK((distrust.find("time stepping passed over a part of a load at t = ") != std::string::npos) == !is_drive);
    CHECK(!run_of("dop853", duration).second);
    CHECK(!run_of("moreau", k_step * random.decades(-3.5, 0.5)).second);
  }
}

// What a drive moves has the pulse's integrals, and what is carried along has them too.
TEST_CASE("short pulses of drives: time stepping moves a body by them, and what is pinned to it") {
  for (int i = 0; i < case_count(100); ++i) {
    Pulses pulses(static_cast<std::uint64_t>(i) + 9000);
    RandomNumber random(static_cast<std::uint64_t>(i) + 9500);
    const Pulse pulse = pulses.next(random.between(0.5, 2.0));
    const std::string text = k_no_gravity + body("deck", "mass = 10.0; inertia = 10.0") +
                             body("load", "mass = 2.0; inertia = 1.0; position = [0.0, 0.5]") + pulse.text +
                             element("prismatic", "rail", "a = \"deck\"; axis = [1.0, 0.0]") +
                             element("weld", "bolt", "a = \"load\"; b = \"deck\"") +
                             element("prescribed_motion", "drive", "a = \"deck\"; signal = \"" + pulse.name + "\"");
    const Model model = scene(text);
    const auto system = compile(model);
    SimulationOptions options;
    options.end = k_end;
    options.integrator = "moreau";
    options.settings.step = random.decades(-3.0, -1.5);
    const RunResult result = simulate(*system, system->initial_state(), options);
    CAPTURE(i);
    CAPTURE(pulse.text);
    // Integrals of signals are exact, but for the rounding of the pulse's ends; the weld is met to a velocity's tolerance.
    const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * k_end / pulse.duration;
    for (const std::size_t at : {std::size_t{3}, std::size_t{6}})
      CHECK(std::abs(result.final_state.v[at] - pulse.integral) <= 10.0 * (1e-9 + rounding));
  }
}

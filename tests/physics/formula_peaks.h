// Formulas with kinks and narrow peaks whose extremes are known, and runs of them: of a body that moves evenly, or swings.
#pragma once

#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <cmath>
#include <sstream>

namespace steplap::testing {

inline std::string exactly(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return "(" + text.str() + ")";
}

/// A body 'b' that moves along x from 0.
inline std::string moving(double speed) {
  return "gravity = [0.0, 0.0]\n[simulation]\nend = 1.0\nstep = 1e-3\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\nvelocity = [" +
         exactly(speed).substr(1, exactly(speed).size() - 2) + ", 0.0]\n";
}

/// A body 'b' that swings between −1 m and 1 m on a spring, from 1 m.
inline std::string swinging(double frequency) {
  const std::string stiffness = exactly(frequency * frequency);
  return "gravity = [0.0, 0.0]\n[simulation]\nend = 1.0\nstep = 1e-3\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\nposition = [1.0, "
         "0.0]\n"
         "[[element]]\nkind = \"spring_damper\"\nname = \"spring\"\na = \"b\"\naxis = [1.0, 0.0]\nfree_length = 0.0\nstiffness = " +
         stiffness.substr(1, stiffness.size() - 2) + "\n";
}

inline std::string channel(const std::string& name, const std::string& expression) {
  return "[[channel]]\nname = \"" + name + "\"\nexpression = \"" + expression + "\"\n";
}

/// A run with extremes.
struct PeakRun {
  std::unique_ptr<System> system;
  RunResult result;

  PeakRun(const std::string& text, const Settings& settings) {
    system = compile(scene(text));
    SimulationOptions o = options(settings);
    if (settings.integrator == "moreau") o.settings.step = settings.step_or_tolerance;
    o.has_extremes = true;
    result = simulate(*system, system->initial_state(), o);
  }
  [[nodiscard]] const ChannelRange& range(const std::string& name) const {
    for (const ChannelRange& range : result.ranges)
      if (range.channel->name == name) return range;
    throw std::invalid_argument(name);
  }
};

/// A formula that reaches `top` where the body passes its place, and lies below everywhere else; or the same turned over.
struct Peak {
  std::string expression;
  double top = 0.0;
  bool is_turned = false;
};

// Products and compositions of these are peaks of the same place.
inline std::string shape(random::RandomNumber& random, const std::string& x) {
  switch (random.below(12)) {
  case 0: return "max(0, 1 - abs(" + x + "))";
  case 1: return "exp(-(" + x + ")^2)";
  case 2: return "1 / (1 + (" + x + ")^2)";
  case 3: return "1 / (1 + (" + x + ") * (" + x + "))";
  case 4: return "exp(-abs(" + x + "))";
  case 5: return "((" + x + ") > -1 && (" + x + ") < 1 ? 1 - (" + x + ")^2 : 0)";
  case 6: return "1 - min(1, abs(" + x + "))";
  case 7: return "1 / (1 + hypot(" + x + ", 0.1 * (" + x + ")))";
  case 8: return "exp(-(" + x + ")^2) * cos(" + x + ")";
  case 9: return "sqrt(max(0, 1 - (" + x + ")^2))";
  case 10: return "exp(-abs(" + x + ")^1.5) / (1 + (" + x + ")^4)";
  default: return "1 - 2 * atan(abs(" + x + ")) / pi";
  }
}

inline Peak random_peak(random::RandomNumber& random, double from, double to) {
  Peak peak;
  const double place = random.between(from, to), width = random.decades(-6.0, -0.5);
  const std::string x = "(b.x / '1 m' - " + exactly(place) + ") / " + exactly(width);
  std::string f = "(" + shape(random, x) + ")";
  if (random.chance(0.3)) f += " * (" + shape(random, x) + ")";
  if (random.chance(0.3)) f = "sin(pi / 2 * " + f + ")";
  peak.top = random.between(0.5, 3.0);
  f = exactly(peak.top) + " * " + f;
  if (random.chance(0.5)) {
    const double least = random.between(0.0, 0.4);
    f = "max(" + f + ", " + exactly(least) + " * cos(b.vx / '1 m/s'))";
  }
  peak.is_turned = random.chance(0.5);
  peak.expression = peak.is_turned ? "-(" + f + ")" : f;
  return peak;
}

/// What came of many.
struct PeakTally {
  std::size_t count = 0;
  std::vector<std::string> wrong;  ///< farther from what is true than is said
  std::vector<std::string> unsure; ///< said to be known worse than extremes are asked for

  void add(const Settings& settings, std::size_t seed) {
    random::RandomNumber random(seed);
    const bool swings = random.chance(0.5);
    const double speed = random.between(0.3, 3.0), frequency = random.between(4.0, 40.0);
    std::string text = swings ? swinging(frequency) : moving(speed);
    std::vector<Peak> peaks;
    for (int i = 0; i < 12; ++i) {
      peaks.push_back(swings ? random_peak(random, -0.95, 0.95) : random_peak(random, 0.01 * speed, 0.99 * speed));
      text += channel("p" + std::to_string(i), peaks.back().expression);
    }
    const PeakRun run(text, settings);
    for (std::size_t i = 0; i < peaks.size(); ++i) judge(peaks[i], run.range("p" + std::to_string(i)), settings, seed);
  }

private:
  void judge(const Peak& peak, const ChannelRange& range, const Settings& settings, std::size_t seed) {
    ++count;
    const double found = peak.is_turned ? -range.low.value : range.high.value;
    std::ostringstream text;
    text.precision(12);
    text << settings.integrator << " " << settings.step_or_tolerance << ", seed " << seed << ": " << found << " for " << peak.top << " ± "
         << range.resolution << ", " << peak.expression;
    // Two roundings of the formula itself beside the resolution.
    if (!(std::abs(found - peak.top) <= range.resolution + 1e-15)) wrong.push_back(text.str());
    // A millionth of the range, or of 1 where that is less, and what the text of the formula is evaluated to.
    if (!(range.resolution <= 1e-6 * std::max(1.0, peak.top) + 1e-9)) unsure.push_back(text.str());
  }
};

} // namespace steplap::testing

#include "tests/random/smooth_friction.h"

#include "tests/random/random_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap::random {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_share_of_slope = 0.2; // h in times of the smoothed slope
constexpr double k_steps_of_a_period = 60.0;

double force_at(const std::vector<Harmonic>& load, double t) {
  double sum = 0.0;
  for (const Harmonic& h : load) sum += h.amplitude * std::cos(2.0 * k_pi * h.frequency * t + h.phase);
  return sum;
}

// y: positions, then velocities.
void rates(const RailBlocks& scene, double epsilon, double t, const std::vector<double>& y, std::vector<double>& dy) {
  const std::size_t n = scene.blocks.size();
  const auto dry = [&](double bound, double v) { return bound * std::clamp(v / epsilon, -1.0, 1.0); };
  for (std::size_t i = 0; i < n; ++i) {
    dy[i] = y[n + i];
    dy[n + i] = force_at(scene.blocks[i].load, t) - dry(scene.blocks[i].friction, y[n + i]);
  }
  for (std::size_t i = 1; i < n; ++i) {
    const RailBlock& b = scene.blocks[i];
    const double stretch = y[i] - y[i - 1], rate = y[n + i] - y[n + i - 1];
    const double f = b.stiffness * stretch + b.damping * rate + dry(b.link_friction, rate);
    dy[n + i] -= f;
    dy[n + i - 1] += f;
  }
  for (std::size_t i = 0; i < n; ++i) dy[n + i] /= scene.blocks[i].mass;
}

double step_for(const RailBlocks& scene, double epsilon) {
  double fastest = 0.0, slope = 0.0;
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    const RailBlock& b = scene.blocks[i];
    const double m = i > 0 ? std::min(b.mass, scene.blocks[i - 1].mass) : b.mass;
    slope = std::max(slope, (b.friction + 2.0 * b.link_friction) / (epsilon * m));
    fastest = std::max(fastest, std::sqrt(4.0 * b.stiffness / m));
    for (const Harmonic& h : b.load) fastest = std::max(fastest, 2.0 * k_pi * h.frequency);
  }
  return std::min(k_share_of_slope / std::max(slope, 1e-300), 2.0 * k_pi / std::max(fastest, 1e-300) / k_steps_of_a_period);
}

std::vector<std::vector<double>> integrated(const RailBlocks& scene, double epsilon, int samples) {
  const std::size_t n = scene.blocks.size();
  std::vector<double> y(2 * n, 0.0), k1(2 * n), k2(2 * n), k3(2 * n), k4(2 * n), stage(2 * n);
  for (std::size_t i = 0; i < n; ++i) y[n + i] = scene.blocks[i].velocity;
  std::vector<std::vector<double>> list;
  const double span = scene.end / samples;
  const int steps = static_cast<int>(std::ceil(span / step_for(scene, epsilon)));
  const double h = span / steps;
  const auto at = [&](double share, const std::vector<double>& k) {
    for (std::size_t i = 0; i < 2 * n; ++i) stage[i] = y[i] + share * h * k[i];
  };
  for (int s = 0; s < samples; ++s) {
    for (int j = 0; j < steps; ++j) {
      const double t = s * span + j * h;
      rates(scene, epsilon, t, y, k1);
      at(0.5, k1);
      rates(scene, epsilon, t + 0.5 * h, stage, k2);
      at(0.5, k2);
      rates(scene, epsilon, t + 0.5 * h, stage, k3);
      at(1.0, k3);
      rates(scene, epsilon, t + h, stage, k4);
      for (std::size_t i = 0; i < 2 * n; ++i) y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
    list.emplace_back(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return list;
}

std::string body_text(const RailBlock& b, std::size_t i) {
  const std::string name = "b" + std::to_string(i);
  return "[[body]]\nname = \"" + name + "\"\nmass = " + number(b.mass) +
         "\ninertia = 1.0\nposition = " + pair(static_cast<double>(i), 0.0) + "\nvelocity = " + pair(b.velocity, 0.0) +
         "\n[[element]]\nkind = \"prismatic\"\nname = \"rail" + std::to_string(i) + "\"\na = \"" + name +
         "\"\nb = { body = \"ground\", at = " + pair(static_cast<double>(i), 0.0) + " }\n";
}

std::string friction_text(const std::string& name, const std::string& a, const std::string& b, double holds) {
  if (holds == 0.0) return "";
  return "[[element]]\nkind = \"joint_friction\"\nname = \"" + name + "\"\na = \"" + a + "\"\n" + (b.empty() ? "" : "b = \"" + b + "\"\n") +
         "coordinate = \"x\"\nholds = " + number(holds) + "\n";
}

std::string load_text(const RailBlock& b, const std::string& i) {
  if (b.load.empty()) return "";
  std::string amplitudes, frequencies, phases;
  for (const Harmonic& h : b.load) {
    const std::string comma = amplitudes.empty() ? "" : ", ";
    amplitudes += comma + number(h.amplitude);
    frequencies += comma + number(h.frequency);
    phases += comma + number(h.phase);
  }
  return "[[signal]]\nkind = \"harmonics\"\nname = \"s" + i + "\"\namplitudes = [" + amplitudes + "]\nfrequencies = [" + frequencies +
         "]\nphases = [" + phases + "]\n[[element]]\nkind = \"load\"\nname = \"load" + i + "\"\nat = \"b" + i + "\"\nforce_x = \"s" + i +
         "\"\n";
}

double rounded(double x) { return std::stod(number(x)); }

} // namespace

std::string RailBlocks::text() const {
  std::string text = "gravity = [0.0, 0.0]\n[simulation]\nend = " + number(end) + "\n";
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const RailBlock& b = blocks[i];
    const std::string index = std::to_string(i), name = "b" + index, before = i > 0 ? "b" + std::to_string(i - 1) : "";
    text += body_text(b, i) + friction_text("grip" + index, name, "", b.friction) + load_text(b, index);
    if (i == 0) continue;
    text += friction_text("link" + index, name, before, b.link_friction);
    if (b.stiffness > 0.0)
      text += "[[element]]\nkind = \"spring_damper\"\nname = \"spring" + index + "\"\na = \"" + name + "\"\nb = \"" + before +
              "\"\naxis = [1.0, 0.0]\nstiffness = " + number(b.stiffness) + "\ndamping = " + number(b.damping) + "\n";
  }
  return text;
}

RailBlocks random_rail_blocks(std::uint64_t seed) {
  RandomNumber r(seed);
  RailBlocks scene;
  const int count = 1 + r.below(3);
  for (int i = 0; i < count; ++i) {
    RailBlock b;
    b.mass = rounded(r.decades(-0.3, 0.5));
    b.friction = r.chance(0.8) ? rounded(r.between(1.0, 10.0)) : 0.0;
    b.velocity = r.chance(0.4) ? rounded(r.either(0.1, 2.0)) : 0.0;
    for (int h = r.below(4); h > 0; --h) {
      const double amplitude = rounded(r.either(1.0, 8.0)), frequency = rounded(r.decades(-0.3, 1.5));
      b.load.push_back({amplitude, frequency, rounded(r.between(-3.0, 3.0))});
    }
    if (i > 0) {
      b.stiffness = r.chance(0.8) ? rounded(r.decades(1.0, 3.5)) : 0.0;
      b.damping = r.chance(0.5) ? rounded(r.between(0.1, 5.0)) : 0.0;
      if (b.stiffness == 0.0) b.damping = 0.0;
      b.link_friction = r.chance(0.4) ? rounded(r.between(0.5, 5.0)) : 0.0;
    }
    scene.blocks.push_back(b);
  }
  return scene;
}

SmoothMotion smooth_motion(const RailBlocks& scene, int samples) {
  const double epsilon = 2e-3; // m/s, of velocities of 0.1 to 3
  const auto coarse = integrated(scene, epsilon, samples), middle = integrated(scene, 0.5 * epsilon, samples),
             fine = integrated(scene, 0.25 * epsilon, samples);
  SmoothMotion motion{fine, fine};
  std::vector<double> worst(scene.blocks.size(), 0.0);
  for (std::size_t s = 0; s < fine.size(); ++s)
    for (std::size_t i = 0; i < worst.size(); ++i) {
      const double before = 2.0 * middle[s][i] - coarse[s][i];
      motion.x[s][i] = 2.0 * fine[s][i] - middle[s][i];
      worst[i] = std::max(worst[i], std::abs(motion.x[s][i] - before));
      motion.estimate[s][i] = worst[i];
    }
  return motion;
}

} // namespace steplap::random

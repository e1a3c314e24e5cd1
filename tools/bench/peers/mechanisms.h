#pragma once

// Published small scenes: B2 … B5 hand-written, B1 … B3 in Simbody. Each program integrates the whole problem and returns its error at the
// end, relative to the exact solution; B5 returns samples of the run instead.

#include "andrews.h"

#include <vector>

namespace steplap::peers {

struct MechanismResult {
  double error = 0.0;
  long steps = 0;
  long evaluations = 0;
  long events = 0;
  double cpu_ms = 0.0; // CPU time of the integration, ms; set by programs whose preparation is costly
};

// B2 with N windows: exact position of point B0 after 10 s on the parallelogram branch, m.
struct FourBarExact {
  int windows;
  double x, y;
};
inline constexpr FourBarExact k_four_bar_exact[2] = {{2, 0.328458111540815, 0.944518538178601}, {40, 0.180512226686728, 0.983572740582312}};
inline constexpr double k_four_bar_end = 10.0;

[[nodiscard]] MechanismResult run_four_bar_dop853(const FourBarExact& exact, double tolerance);
[[nodiscard]] MechanismResult run_four_bar_arkode(const FourBarExact& exact, double tolerance);
[[nodiscard]] MechanismResult run_four_bar_kkt_rk4(const FourBarExact& exact, double step);
[[nodiscard]] MechanismResult run_four_bar_simbody(const FourBarExact& exact, double accuracy);

// B3: exact position after 10 s, m.
inline constexpr double k_pendulum_x = -0.275087462576117;
inline constexpr double k_pendulum_y = -0.961419205099125;
inline constexpr double k_pendulum_end = 10.0;

[[nodiscard]] MechanismResult run_pendulum_dop853(double tolerance);
[[nodiscard]] MechanismResult run_pendulum_arkode(double tolerance);
[[nodiscard]] MechanismResult run_pendulum_simbody(double accuracy);

// B1 in Simbody; error of the seven angles at the end.
[[nodiscard]] MechanismResult run_andrews_simbody(AndrewsVariant variant, double accuracy);

// B4a (mass on a belt) and B4b (Den Hartog's oscillator) with ARKODE.
[[nodiscard]] MechanismResult run_belt_arkode(double tolerance);
[[nodiscard]] MechanismResult run_den_hartog_arkode(double tolerance);

// B5 without adhesion. `samples` receives the heights every 10 ms, unless it is null.
inline constexpr int k_bounce_samples = 1000;
[[nodiscard]] MechanismResult run_bounce_arkode(double tolerance, std::vector<double>* samples);

} // namespace steplap::peers

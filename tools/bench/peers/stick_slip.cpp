// B4a and B4b: one mass with Coulomb friction, integrated by ARKODE with its root finding. Modes: sticking, and slip in either direction.

#include "arkode_runner.h"
#include "mechanisms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace steplap::peers {
namespace {

constexpr double k_stiffness = 100.0;  // N/m; the mass is 1 kg
constexpr double k_friction = 2.943;   // friction force, N
constexpr double k_longest_step = 0.1; // s; limits the step, so that no slip phase is missed

struct Oscillator {
  double belt;       // speed of the surface, m/s
  double drive;      // amplitude of the load drive cos 3t, N
  int direction = 0; // direction of slip relative to the surface, ±1; 0 while sticking
};

double pull(const Oscillator& o, double t, double x) { return o.drive * std::cos(3.0 * t) - k_stiffness * x; }

int rates(double t, N_Vector y, N_Vector dydt, void* data) {
  const auto& o = *static_cast<const Oscillator*>(data);
  const double* u = data_of(y);
  data_of(dydt)[0] = u[1];
  data_of(dydt)[1] = o.direction == 0 ? 0.0 : pull(o, t, u[0]) - o.direction * k_friction;
  return 0;
}

// Event functions. Sticking: distance of the force from both bounds. Slip: relative speed in the direction of slip.
int roots(double t, N_Vector y, double* g, void* data) {
  const auto& o = *static_cast<const Oscillator*>(data);
  const double* u = data_of(y);
  if (o.direction == 0) {
    g[0] = k_friction - pull(o, t, u[0]);
    g[1] = k_friction + pull(o, t, u[0]);
  } else {
    g[0] = o.direction * (u[1] - o.belt);
    g[1] = 1.0;
  }
  return 0;
}

void change_mode(Oscillator& o, int slot, double t, std::array<double, 2>& y) {
  if (o.direction == 0) {
    o.direction = slot == 0 ? 1 : -1;
    return;
  }
  y[1] = o.belt;
  const double force = pull(o, t, y[0]);
  if (std::abs(force) <= k_friction) o.direction = 0;
  else o.direction = force > 0.0 ? 1 : -1;
}

MechanismResult run(Oscillator o, double end, double x_exact, double v_exact, double tolerance) {
  std::array<double, 2> y = {0.0, 0.0};
  ArkodeRunner runner({2, rates, &o, 2, roots, k_longest_step}, y.data(), tolerance);
  MechanismResult result;
  while (runner.time() < end) {
    const int slot = runner.advance(end);
    if (slot < 0) break;
    ++result.events;
    change_mode(o, slot, runner.time(), y);
    runner.restart();
  }
  result.error = std::max(std::abs(y[0] - x_exact), std::abs(y[1] - v_exact));
  result.steps = runner.steps();
  result.evaluations = runner.evaluations();
  return result;
}

} // namespace

MechanismResult run_belt_arkode(double tolerance) { return run({0.2, 0.0, -1}, 3.0, 0.0314469318813080, -0.198980397472595, tolerance); }

MechanismResult run_den_hartog_arkode(double tolerance) {
  return run({0.0, 8.0, 1}, 10.0, -0.0363829137728667, 0.370762125122938, tolerance);
}

} // namespace steplap::peers

// B5: a mass of 1 kg dropped from 1 m onto a unilateral spring and damper without adhesion, integrated by ARKODE with its root finding.
// Modes: flight, contact (positive force), held (below the surface, with zero force).

#include "arkode_runner.h"
#include "mechanisms.h"

#include <array>

namespace steplap::peers {
namespace {

constexpr double k_gravity = 9.81, k_stiffness = 1e5, k_damping = 20.0;
constexpr double k_end = 10.0;
constexpr double k_contact_step = 1e-3; // first step after landing, s; contact lasts 10 ms

enum class Mode { flight, contact, held };

double force_law(const double* y) { return -k_stiffness * y[0] - k_damping * y[1]; }

int rates(double, N_Vector y, N_Vector dydt, void* mode) {
  const double* u = data_of(y);
  const bool touching = *static_cast<const Mode*>(mode) == Mode::contact;
  data_of(dydt)[0] = u[1];
  data_of(dydt)[1] = -k_gravity + (touching ? force_law(u) : 0.0);
  return 0;
}

int roots(double, N_Vector y, double* g, void* mode) {
  const double* u = data_of(y);
  g[0] = g[1] = 1.0;
  switch (*static_cast<const Mode*>(mode)) {
  case Mode::flight: g[0] = u[0]; break;
  case Mode::contact: g[0] = force_law(u); break;
  case Mode::held:
    g[0] = -u[0];
    g[1] = -force_law(u);
    break;
  }
  return 0;
}

Mode after(Mode mode, int slot) {
  if (mode == Mode::flight) return Mode::contact;
  if (mode == Mode::contact) return Mode::held;
  return slot == 0 ? Mode::flight : Mode::contact;
}

void sample(ArkodeRunner& runner, std::vector<double>& samples) {
  std::array<double, 2> y{};
  while (samples.size() < k_bounce_samples) {
    const double t = k_end * static_cast<double>(samples.size() + 1) / k_bounce_samples;
    if (t > runner.time()) return;
    runner.interpolate(t, y.data());
    samples.push_back(y[0]);
  }
}

} // namespace

MechanismResult run_bounce_arkode(double tolerance, std::vector<double>* samples) {
  std::array<double, 2> y = {1.0, 0.0};
  Mode mode = Mode::flight;
  ArkodeRunner runner({2, rates, &mode, 2, roots}, y.data(), tolerance);
  MechanismResult result;
  while (runner.time() < k_end) {
    const int slot = samples != nullptr ? runner.step(k_end) : runner.advance(k_end);
    if (samples != nullptr) sample(runner, *samples);
    if (slot < 0) continue;
    ++result.events;
    mode = after(mode, slot);
    runner.restart(mode == Mode::contact ? k_contact_step : 0.0);
  }
  result.steps = runner.steps();
  result.evaluations = runner.evaluations();
  return result;
}

} // namespace steplap::peers

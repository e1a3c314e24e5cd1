#include "mbd/trust/trust.h"

#include "mbd/model/method.h"
#include "mbd/model/validate.h"
#include "mbd/simulation/energy_account.h"
#include "mbd/trust/element_judgement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Limits relative to the size of the bodies: for rounding of coordinates, and for the gaps of joints after a step, before projection.
constexpr double k_rounded_share = 1e-6, k_open_share = 1e-2;

// Returns the largest radius of gyration, which is the scale of tolerances (Integrator).
double size_of(const System& system) {
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  return size;
}

} // namespace

std::string remedy(const SimulationSettings& s) {
  const bool has_steps = has_fixed_step(s.integrator);
  if (has_steps && s.step) return "try a step of " + limit_text(*s.step / 10.0) + " s, or the integrator auto";
  const double tolerance = s.tolerance.value_or(1e-8);
  return "try a tolerance of " + limit_text(std::max(1e-12, tolerance * (tolerance > 1e-6 ? 1e-4 : 1e-2))) +
         (method(s.integrator).is_for_damping ? ", or the integrator dop853" : ", or the integrator rodas5p");
}

std::string distrust_of(const Model& model, const System& system, const RunResult& result) {
  const RunStatistics& s = result.statistics;
  const double size = size_of(system);
  double furthest = 0.0;
  for (std::size_t i = 0; i < result.final_state.q.size(); ++i)
    if (i % 3 != 2) furthest = std::max(furthest, std::abs(result.final_state.q[i]));
  const double rounding = furthest * std::numeric_limits<double>::epsilon();
  if (rounding > k_rounded_share * size)
    return "positions of " + limit_text(furthest) + " m are known to " + limit_text(rounding) +
           " m only: let the scene begin and stay near the origin, and take common velocities away";
  if (s.max_position_residual > k_open_share * size)
    return "a step left joints open by " + limit_text(s.max_position_residual) + " m or rad: " + remedy(model.simulation);
  if (s.passed_pulse)
    return "time stepping passed over a part of a load at t = " + limit_text(*s.passed_pulse) +
           " s that is far shorter than its steps: bodies have its impulse, but no force or acceleration shows it: " +
           remedy(model.simulation);
  if (s.undecided_condition)
    return "whether the condition of an action was true for an instant at t = " + limit_text(*s.undecided_condition) +
           " s cannot be told: its two sides come nearer to each other there than the motion is known to. " + remedy(model.simulation);
  if (s.energy_residual > EnergyAccount::k_untrusted * s.energy_scale && s.energy_residual > s.energy_rounding)
    return "the energy balance is off by " + limit_text(s.energy_residual) + " J of " + limit_text(s.energy_scale) +
           " J turned over: " + remedy(model.simulation);
  return "";
}

} // namespace steplap

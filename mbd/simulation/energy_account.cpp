#include "mbd/simulation/energy_account.h"

#include "mbd/base/number_text.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Of scale(): what one step may make or lose, per unit of tolerance, and at least. An accepted step's error, √n times the
// tolerance in the weighted norm at most, changes the energy, to first order, by
//   |ΔE| ≤ tol √n Σ m (|v| (v₀ + |v|) + |a| (q₀ + |Δq|)),   q₀ = 1e-3 L, v₀ = 60/s q₀ (Integrator).
// The velocities' part is at most tol √n (3 T + T₀). The other, of a vibration of amplitude x, is a share 2 tol √n (1 +
// q₀/x) of its energy: with √n up to 5, 1e4 tol serves amplitudes down to a millionth of the body's size, L. The least and
// the most are no bounds of errors but of what a guard is for: below a thousandth the balance of the whole run judges.
constexpr double k_step_share = 1e4, k_least_share = 1e-3, k_most_share = 5e-2;
// Of scale(): what setting to rest may take at one event. Velocities of rounding are far below, a blow is far above.
constexpr double k_settled_share = 1e-4;
// √10 v₀/L: ten times the energy T₀ of the motion to which tolerances are absolute, 0.06 of the bodies' size a second.
constexpr double k_floor_rate = 0.2;

struct Kinetic {
  double total = 0.0, about_centre = 0.0, of_floor = 0.0;
};

Kinetic kinetic_energy(const Dynamics& dynamics, const double* y) {
  const Layout& layout = dynamics.layout();
  const double* v = y + dynamics.coordinate_count();
  Kinetic sum;
  double mass = 0.0, px = 0.0, py = 0.0;
  for (int k = 0; k < layout.cluster_count(); ++k, v += 3) {
    const Cluster& c = layout.clusters[k];
    sum.total += 0.5 * c.mass * (v[0] * v[0] + v[1] * v[1]) + 0.5 * c.inertia * v[2] * v[2];
    sum.of_floor += 0.5 * c.inertia * k_floor_rate * k_floor_rate;
    mass += c.mass;
    px += c.mass * v[0];
    py += c.mass * v[1];
  }
  sum.about_centre = sum.total;
  if (mass > 0.0) sum.about_centre -= 0.5 * (px * px + py * py) / mass;
  return sum;
}

} // namespace

double EnergyAccount::scale() const { return std::max({exchanged_, peak_about_centre_, floor_}); }

void EnergyAccount::start(Dynamics& dynamics, double t, const double* y, double tolerance) {
  const Kinetic kinetic = kinetic_energy(dynamics, y);
  kinetic_start_ = kinetic.total;
  floor_ = kinetic.of_floor;
  if (tolerance > 0.0) allowed_ = std::clamp(k_step_share * tolerance, k_least_share, k_most_share);
  start_ = dynamics.mechanical_energy(t, y) + y[dynamics.dimension() - 2] - y[dynamics.dimension() - 1];
  note(dynamics, t, y);
}

void EnergyAccount::note(Dynamics& dynamics, double t, const double* y) {
  const double energy = dynamics.mechanical_energy(t, y);
  const double dissipated = y[dynamics.dimension() - 2], work = y[dynamics.dimension() - 1];
  const Kinetic kinetic = kinetic_energy(dynamics, y);
  last_ = energy + dissipated - work - start_;
  worst_ = std::max(worst_, std::abs(last_));
  exchanged_ = std::max({exchanged_, std::abs(dissipated), std::abs(work), std::abs(kinetic.total - kinetic_start_)});
  peak_kinetic_ = std::max(peak_kinetic_, kinetic.total);
  peak_about_centre_ = std::max(peak_about_centre_, kinetic.about_centre);
  largest_ = std::max({largest_, std::abs(energy), kinetic.total, std::abs(energy - kinetic.total), std::abs(start_)});
}

void EnergyAccount::check_step(Dynamics& dynamics, double t, const double* y) {
  const double before = last_;
  note(dynamics, t, y);
  const double made = last_ - before;
  if (std::abs(made) <= allowed_ * std::max(scale(), peak_kinetic_) + rounding()) return;
  throw NumericalFailure("a step to t = " + number_text(t) + " s " + (made > 0.0 ? "made " : "lost ") +
                         number_text(std::abs(made)) + " J of " + number_text(std::max(scale(), peak_kinetic_)) +
                         " J turned over: its result is not to be trusted. Try a smaller tolerance or step, or another "
                         "integrator (rodas5p for stiff scenes)");
}

void EnergyAccount::check_settled(double t, double lost) const {
  if (std::abs(lost) <= k_settled_share * std::max(scale(), peak_kinetic_) + rounding()) return;
  throw NumericalFailure("at t = " + number_text(t) + " s friction that begins to hold would take " + number_text(lost) +
                         " J from the motion at once, of " + number_text(scale()) +
                         " J turned over: what is taken for rest is none. Try a smaller tolerance, or another integrator");
}

} // namespace steplap

// The balance of energy of a run, kept at every step: what it was worth, and whether it can be believed.
//
//   residual = |kinetic + potential + dissipated − work − their sum at the start|
// measured against what was turned over: the larger of the changes of kinetic energy, the dissipated energy, the work,
// and the peak kinetic energy about the common centre of mass (a fast train is no licence for its load), and not less
// than the energy of the motion to which tolerances are absolute (Integrator).
#pragma once

#include "mbd/dynamics/dynamics.h"

namespace steplap {

class EnergyAccount {
public:
  /// Begins with the state packed in y; `tolerance`: of the method's steps, 0 if it does not control them.
  void start(Dynamics& dynamics, double t, const double* y, double tolerance);
  /// At y, in the layout of `dynamics`.
  void note(Dynamics& dynamics, double t, const double* y);
  /// The same, at the end of a step of a method that follows the motion from event to event. Throws NumericalFailure
  /// if the step made or lost more energy than its tolerance lets it.
  void check_step(Dynamics& dynamics, double t, const double* y);
  /// What setting to rest took at an event, J. Throws NumericalFailure if that was no rest.
  void check_settled(double t, double lost) const;

  [[nodiscard]] double residual() const { return worst_; }   ///< largest so far, J
  [[nodiscard]] double exchanged() const { return exchanged_; } ///< largest change of kinetic energy, dissipation, work, J
  /// What the residual is to be measured against, J.
  [[nodiscard]] double scale() const;
  /// What rounding of the energies themselves can leave, J.
  [[nodiscard]] double rounding() const { return k_rounding * largest_; }

  /// A run whose residual is a larger share of scale() than this is not to be trusted.
  static constexpr double k_untrusted = 1e-2;

private:
  static constexpr double k_rounding = 1e-11;
  double start_ = 0.0, kinetic_start_ = 0.0, floor_ = 0.0, allowed_ = 5e-2;
  double exchanged_ = 0.0, peak_about_centre_ = 0.0, peak_kinetic_ = 0.0, worst_ = 0.0, last_ = 0.0, largest_ = 0.0;
};

} // namespace steplap

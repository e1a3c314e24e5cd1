// The balance of energy of a run, kept at every step: what it was worth, and whether it can be believed.
//
//   residual = |kinetic + potential + dissipated − work − their sum at the start|
// measured against what was turned over: the larger of the changes of kinetic energy, the dissipated energy, the work,
// and the peak kinetic energy about the common centre of mass (a fast train is no licence for its load), and not less
// than the energy of the motion to which tolerances are absolute (Integrator).
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <algorithm>

namespace steplap {

/// Follows the energies of one run; fed at every step.
class EnergyAccount {
public:
  /// Begins with the state packed in y; `tolerance`: of the method's steps, 0 if it does not control them.
  void start(Dynamics& dynamics, double t, const double* y, double tolerance);
  /// At y, in the layout of `dynamics`.
  void note(Dynamics& dynamics, double t, const double* y);
  /// The same, at the end of a step of a method that follows the motion from event to event. Throws NumericalFailure
  /// if the step made or lost more energy than its tolerance lets it, or took some back that was dissipated.
  void check_step(Dynamics& dynamics, double t, const double* y);
  /// What setting to rest took at an event, J. Throws NumericalFailure if that was no rest.
  void check_settled(double t, double lost) const;

  [[nodiscard]] double residual() const { return worst_; }      ///< largest so far, J
  [[nodiscard]] double exchanged() const { return exchanged_; } ///< largest change of kinetic energy, dissipation, work, J
  /// What the residual is to be measured against, J.
  [[nodiscard]] double scale() const;
  /// The largest energy that a step made or lost, of what its tolerance lets it (step_bound); 0 without a tolerance.
  [[nodiscard]] double worst_step() const { return worst_step_; }
  /// What rounding of the energies themselves can leave, J.
  [[nodiscard]] double rounding() const { return k_rounding * largest_; }

  /// A run whose residual is a larger share of scale() than this is not to be trusted.
  static constexpr double k_untrusted = 1e-2;
  /// What an accepted step of a method with error control makes or loses at most, J (docs/explanation/theory.md, "What a run says about
  /// its own accuracy"): of a state of `dimension` numbers, `turned_over` up to its end, `of_floor` the energy of the motion
  /// to which tolerances are absolute.
  [[nodiscard]] static double step_bound(double tolerance, int dimension, double turned_over, double of_floor);
  /// T₀ of all bodies, J: of the motion to which tolerances are absolute.
  [[nodiscard]] static double energy_of_floor(const System& system);
  /// A step stops the run beyond so many times its bound.
  static const double k_reserve;

private:
  static constexpr double k_rounding = 1e-11;
  [[nodiscard]] double turned_over() const { return std::max(exchanged_, peak_kinetic_); }
  void judge_step(const Dynamics& dynamics, double t, double made, double given_back);

  double start_ = 0.0, kinetic_start_ = 0.0, floor_ = 0.0, tolerance_ = 0.0, size_ = 1.0;
  double dissipated_ = 0.0, of_floor_ = 0.0, worst_step_ = 0.0;
  int dimension_ = 0;
  double exchanged_ = 0.0, peak_about_centre_ = 0.0, peak_kinetic_ = 0.0, worst_ = 0.0, last_ = 0.0, largest_ = 0.0;
};

} // namespace steplap

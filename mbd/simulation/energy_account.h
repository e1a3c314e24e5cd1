// Energy balance of a run, checked at every step.
//
//   residual = |kinetic + potential + dissipated − work − their sum at the start|
//
// The residual is compared with the energy converted: the largest of the change of kinetic energy, dissipation, work, and peak kinetic
// energy about the common centre of mass (so that a high common speed does not hide errors). The scale is at least the kinetic energy at
// the velocities below which tolerances are absolute (Integrator).
#pragma once

#include "mbd/dynamics/dynamics.h"

#include <algorithm>

namespace steplap {

/// Energy account of one run, updated at every step.
class EnergyAccount {
public:
  /// Starts with the packed state y. `tolerance` is that of the step control; 0 for fixed steps.
  void start(Dynamics& dynamics, double t, const double* y, double tolerance);
  /// Updates the account at y, in the present layout of `dynamics`.
  void note(Dynamics& dynamics, double t, const double* y);
  /// As note(), at the end of a step of a method that locates events. Throws NumericalFailure if the energy error of the step exceeds its
  /// bound, or if dissipated energy has decreased.
  void check_step(Dynamics& dynamics, double t, const double* y);
  /// Checks the energy, J, removed at an event by setting residual velocities to zero. Throws NumericalFailure if it is not negligible.
  void check_settled(double t, double lost) const;

  [[nodiscard]] double residual() const { return worst_; }      ///< largest residual so far, J
  [[nodiscard]] double exchanged() const { return exchanged_; } ///< largest change of kinetic energy, dissipation or work, J
  /// Returns the energy, J, to which the residual is compared.
  [[nodiscard]] double scale() const;
  /// Returns the largest energy error of a step relative to its bound (step_bound); 0 without a tolerance.
  [[nodiscard]] double worst_step() const { return worst_step_; }
  /// Returns the rounding error of the energies, J.
  [[nodiscard]] double rounding() const { return k_rounded_energy * largest_; }

  /// Residual relative to scale() above which a run cannot be trusted.
  static constexpr double k_untrusted = 1e-2;
  /// Returns a bound for the energy error, J, of an accepted step of a method with error control (docs/explanation/theory.md, "What a run
  /// says about its own accuracy"). `dimension`: length of the state; `turned_over`: energy converted up to the end of the step, J;
  /// `of_floor`: energy_of_floor().
  [[nodiscard]] static double step_bound(double tolerance, int dimension, double turned_over, double of_floor);
  /// Returns T₀, J: kinetic energy of all bodies at the velocities below which tolerances are absolute.
  [[nodiscard]] static double energy_of_floor(const System& system);
  /// A step whose energy error exceeds this multiple of its bound ends the run.
  static const double k_reserve;

private:
  static constexpr double k_rounded_energy = 1e-11; ///< rounding error of energies, relative to the largest energy
  [[nodiscard]] double turned_over() const { return std::max(exchanged_, peak_kinetic_); }
  void judge_step(const Dynamics& dynamics, double t, double made, double given_back);

  double start_ = 0.0, kinetic_start_ = 0.0, floor_ = 0.0, tolerance_ = 0.0, size_ = 1.0;
  double dissipated_ = 0.0, of_floor_ = 0.0, worst_step_ = 0.0;
  int dimension_ = 0;
  double exchanged_ = 0.0, peak_about_centre_ = 0.0, peak_kinetic_ = 0.0, worst_ = 0.0, last_ = 0.0, largest_ = 0.0;
};

} // namespace steplap

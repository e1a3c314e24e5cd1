// Small vibrations about an equilibrium: natural frequencies, damping ratios, mode shapes.
//
// The equations of statics (statics.h) are linearised and reduced to the motions that constraints, drives and sticking friction leave free:
// δq = Z η with J Z = 0 and Zᵀ M Z = 1. Then
//   η'' = A η + B η',   A = Zᵀ K Z,   B = Zᵀ ∂Q/∂v Z   (free_vibration.h).
// Dense algebra finds all modes of models with up to some hundred bodies. For larger ones, sparse algebra finds the slowest modes, or those
// near a frequency, in a small subspace (sparse_modes.h). Dense algebra includes inner states that relax, those of springs and dampers in
// series; all others are held. Assumptions: drives hold their coordinates (a moving or accelerating base counts as held, which Equilibrium
// reports), closed contacts stay closed, and sticking joints stick, because amplitudes are small.
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/system.h"

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Returns |z| portably; std::abs would call the C library, whose rounding depends on the platform.
[[nodiscard]] inline double size_of(const std::complex<double>& z) { return portable::hypot(z.real(), z.imag()); }

/// One mode of small vibrations.
struct VibrationMode {
  std::complex<double> eigenvalue; ///< 1/s; of a conjugate pair the one with positive imaginary part
  /// Displacements (x, y, θ) of the centre of gravity of each body, in m and rad. Scaled so that the largest of the displacements and of
  /// radius of gyration times θ is real and 1 m. Body 0 is the ground.
  std::vector<std::complex<double>> shape;
  /// Remaining acceleration of the mode over its own acceleration, in the mass metric and along free motions. Without damping, this bounds
  /// the relative error of the squared frequency.
  double residual = 0.0;

  /// Returns false if the mode decays or grows without oscillation.
  [[nodiscard]] bool oscillates() const { return eigenvalue.imag() != 0.0; }
  [[nodiscard]] double frequency() const;         ///< frequency of the damped vibration, Hz; 0 if it does not oscillate
  [[nodiscard]] double natural_frequency() const; ///< Hz, |eigenvalue|/2π
  [[nodiscard]] double damping_ratio() const;     ///< −Re/|eigenvalue|; negative if the mode grows
};

/// Selection of modes by number and frequency.
struct WantedModes {
  int count = 0;              ///< 0: all modes, or k_usual_modes of a large model
  std::optional<double> near; ///< Hz: modes whose eigenvalues are nearest to 2π i times this; empty: the slowest
  /// Returns the distance of an eigenvalue from the selected frequency, 1/s; the modes with the smallest distances are selected.
  [[nodiscard]] double distance(const std::complex<double>& eigenvalue) const;
};

/// The modes found.
struct VibrationModes {
  std::vector<VibrationMode> modes; ///< by ascending natural frequency, without rigid motions
  int rigid_motions = 0;            ///< number of coordinates without stiffness, damped or not
  bool is_all = true;               ///< the model has no further modes
  bool is_counted = true;           ///< no selected mode is missing: checked by a count (sparse_modes.h), or all modes were found
};

/// Largest number of coordinates for which dense algebra finds all modes.
inline constexpr int k_max_modal_coordinates = 1500;
inline constexpr int k_usual_modes = 20; ///< default number of modes of larger models

enum class ModesAlgebra { by_size, dense, sparse }; ///< Algebra for the modes. by_size: dense for small models, sparse for large ones.

/// Returns the modes about `state`, which must be an equilibrium. Throws NumericalFailure if they do not converge. `algebra` is for tests
/// that compare dense and sparse algebra.
[[nodiscard]] VibrationModes vibration_modes(const System& system, const State& state, WantedModes wanted = {},
                                             ModesAlgebra algebra = ModesAlgebra::by_size);

/// Returns notes on what vibration_modes() leaves out about `state`, one sentence each: inner states that forces follow, which count as
/// held, and laws that have a kink exactly there, of which one side counts.
[[nodiscard]] std::vector<std::string> remarks_on_modes(const System& system, const State& state);

} // namespace steplap

// Small vibrations about a state of rest: natural frequencies, damping ratios, mode shapes.
//
// The equations of statics (statics.h), linearised and reduced to the motions that constraints, drives and sticking
// friction leave free, δq = Z η with J Z = 0 and Zᵀ M Z = 1, are
//   η'' = A η + B η',   A = Zᵀ K Z,   B = Zᵀ ∂Q/∂v Z.
// Motions that nothing holds (A η = 0) are parted off before any eigenvalue is asked for, with rounding that is theirs;
// the state matrix of the others is balanced, and each eigenvalue refined on (λ² − λ B − A) x = 0, so that slow modes
// keep their digits beside fast or strongly damped ones.
// Drives hold their coordinates where they are: a base that moves or accelerates is taken as held (Equilibrium says so).
// Contacts that are closed and joints that stick stay so: amplitudes are as small as that asks for. Dense algebra: for
// scenes up to some hundred bodies.
#pragma once

#include "mbd/system/system.h"
#include "mbd/math/portable_math.h"

#include <complex>
#include <string>
#include <vector>

namespace steplap {

/// |z|, where std::abs would call the C library.
[[nodiscard]] inline double size_of(const std::complex<double>& z) {
  return portable::hypot(z.real(), z.imag());
}

struct VibrationMode {
  std::complex<double> eigenvalue; ///< 1/s; of a pair the one with the positive imaginary part
  /// Per body (x, y, θ) of its centre of gravity, in m and rad; the largest of displacements and of
  /// radius of gyration times θ is real and 1 m. Body 0 is the ground.
  std::vector<std::complex<double>> shape;

  [[nodiscard]] bool oscillates() const { return eigenvalue.imag() != 0.0; }
  [[nodiscard]] double frequency() const;         ///< Hz, of the damped vibration; 0 if it does not oscillate
  [[nodiscard]] double natural_frequency() const; ///< Hz, |eigenvalue|/2π
  [[nodiscard]] double damping_ratio() const;     ///< −Re/|eigenvalue|; negative: it grows
};

struct VibrationModes {
  std::vector<VibrationMode> modes; ///< ascending natural frequency; rigid motions are not among them
  int rigid_motions = 0; ///< coordinates along which nothing holds it, though dampers may resist
};

/// Largest number of coordinates of bodies that is worked on.
inline constexpr int k_max_modal_coordinates = 1500;

/// About `state`, which must be at rest. Throws NumericalFailure for a scene that is too large.
[[nodiscard]] VibrationModes vibration_modes(const System& system, const State& state);

} // namespace steplap

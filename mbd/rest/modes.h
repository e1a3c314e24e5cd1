// Small vibrations about a state of rest: natural frequencies, damping ratios, mode shapes.
//
// The equations of statics (statics.h), linearised and reduced to the motions that constraints, drives and sticking
// friction leave free, δq = Z η with J Z = 0 and Zᵀ M Z = 1, are
//   η'' = A η + B η',   A = Zᵀ K Z,   B = Zᵀ ∂Q/∂v Z   (free_vibration.h).
// Dense algebra finds all modes, of scenes of up to some hundred bodies; of larger ones some are found in a small space of
// motions that sparse algebra makes (sparse_modes.h): the slowest, or those near a frequency.
// Drives hold their coordinates where they are: a base that moves or accelerates is taken as held (Equilibrium says so).
// Contacts that are closed and joints that stick stay so: amplitudes are as small as that asks for.
#pragma once

#include "mbd/base/portable_math.h"
#include "mbd/system/system.h"

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// |z|, where std::abs would call the C library.
[[nodiscard]] inline double size_of(const std::complex<double>& z) { return portable::hypot(z.real(), z.imag()); }

/// One mode of small vibrations.
struct VibrationMode {
  std::complex<double> eigenvalue; ///< 1/s; of a pair the one with the positive imaginary part
  /// Per body (x, y, θ) of its centre of gravity, in m and rad; the largest of displacements and of
  /// radius of gyration times θ is real and 1 m. Body 0 is the ground.
  std::vector<std::complex<double>> shape;
  /// Acceleration that the mode's forces leave over, in the masses' metric and along what is free, against its own: where
  /// nothing damps, the square of the frequency is not further off than by this share.
  double residual = 0.0;

  /// False: it decays or grows without swinging.
  [[nodiscard]] bool oscillates() const { return eigenvalue.imag() != 0.0; }
  [[nodiscard]] double frequency() const;         ///< Hz, of the damped vibration; 0 if it does not oscillate
  [[nodiscard]] double natural_frequency() const; ///< Hz, |eigenvalue|/2π
  [[nodiscard]] double damping_ratio() const;     ///< −Re/|eigenvalue|; negative: it grows
};

/// Which of a scene's modes are looked for.
struct WantedModes {
  int count = 0;              ///< 0: all; of a scene too large for that, k_usual_modes
  std::optional<double> near; ///< Hz: those whose eigenvalues are nearest to 2π i times this; none: the slowest
  /// What the choice is made by, 1/s.
  [[nodiscard]] double distance(const std::complex<double>& eigenvalue) const;
};

/// The modes found.
struct VibrationModes {
  std::vector<VibrationMode> modes; ///< ascending natural frequency; rigid motions are not among them
  int rigid_motions = 0;            ///< coordinates along which nothing holds it, though dampers may resist
  bool is_all = true;               ///< there are no others
  bool is_counted = true;           ///< that none of those wanted is missing was checked (sparse_modes.h), or all are there
};

/// Largest number of coordinates of bodies of which all modes are found, by dense algebra.
inline constexpr int k_max_modal_coordinates = 1500;
inline constexpr int k_usual_modes = 20; ///< of larger scenes

enum class ModesAlgebra { by_size, dense, sparse }; ///< How modes are found; by_size: dense for small scenes, sparse for large ones.

/// About `state`, which must be at rest. Throws NumericalFailure where they do not converge. `algebra`: for tests that hold one
/// against the other.
[[nodiscard]] VibrationModes vibration_modes(const System& system, const State& state, WantedModes wanted = {},
                                             ModesAlgebra algebra = ModesAlgebra::by_size);

} // namespace steplap

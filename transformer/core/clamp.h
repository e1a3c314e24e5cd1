// Model table [[clamp]]: bolts or bands that press the yoke sheets of a core together, and the resulting pressure at its corners.
//
// For a yoke of length L (between the outer faces of the outer limbs) and height Y, on which clamps exert the forces F_i at x_i from its
// middle, with clamping beams that are rigid compared with the stack:
//
//   p(x) = ΣF_i/(L Y) + 12 ΣF_i x_i · x/(L³ Y),
//
// the linear pressure in equilibrium with the forces. All packets carry the same forces over their own heights: the pressure of a packet
// with yoke height Y_k is Y/Y_k times this. A joint has the pressure at the axis of its limb.
//
// The remaining force of a clamp that was tightened with F₀ is
//
//   F = (1 − r) F₀ − k s + k l (α_s − α_c) ΔT,  1/k = 1/k_c + 1/k_s,
//
// with r the loss by relaxation, s the settling of the stack, ΔT the temperature rise, l the clamped length, α_s and α_c the thermal
// expansion coefficients of stack and clamp, k_c and k_s the stiffnesses of a clamp and of the stack under it. Derivation:
// docs/reference/core.md, "What clamps".
#pragma once

#include "transformer/core/core.h"

namespace steplap {

/// Equal clamps on one yoke or on both.
struct Clamp : TableObject {
  std::string core;           ///< name of the core
  std::string at = "both";    ///< clamped yokes: "top", "bottom" or "both"
  std::optional<long> count;  ///< number of clamps on each yoke; default: number of `places`, or 1
  std::vector<double> places; ///< positions along the yoke from the middle between the outer limbs, m; none: symmetric
  double preload = 0.0;       ///< force of each clamp as tightened, N
  double relaxation = 0.0;    ///< fraction of the force lost by relaxation
  std::optional<double> stiffness, stack_stiffness; ///< stiffness of a clamp, and of the stack under it, N/m
  double settling = 0.0;                            ///< settling of the stack, m
  double warming = 0.0;                             ///< temperature rise, K
  std::optional<double> expansion;                  ///< thermal expansion of the clamp, 1/K
  double stack_expansion = 12e-6;                   ///< thermal expansion of the stack, 1/K
  std::optional<double> length;                     ///< clamped length, m; default: depth of the stack
  std::optional<double> yoke_length;                ///< length of the yoke, m; default: distance between the outer faces of the outer limbs

  /// Returns the present force of each clamp, N; negative: the clamp is loose. `depth`: depth of the stack, m.
  [[nodiscard]] double force(double depth) const;
};

/// Resultant of the clamps on one yoke.
struct YokeClamping {
  double force = 0.0;  ///< total force, N
  double moment = 0.0; ///< moment about the middle of the yoke, N m
  double length = 0.0; ///< length of the yoke, m
  double height = 0.0; ///< height of the highest packet of the yoke, m
  double middle = 0.0; ///< position of the yoke's middle along the active part, from its centre of gravity, m
  [[nodiscard]] double pressure() const { return force / (length * height); }
  /// Returns the pressure at x, m from the middle of the yoke, relative to pressure().
  [[nodiscard]] double share(double x) const { return 1.0 + 12.0 * moment * x / (force * length * length); }
};

[[nodiscard]] const TableKind& clamp_kind();

/// Returns true if the fields of all clamps of the core are within their ranges. Otherwise the clamps must not be used; the errors are
/// reported when the tables are checked.
[[nodiscard]] bool has_sound_clamps(const Core& core, const Model& model);
/// Returns true if the pressure of the core is that of clamps of the model, not its own field.
[[nodiscard]] bool is_clamped(const Core& core, const Model& model);
/// Returns the resultant for the top or bottom yoke of the core. Throws ModelError for invalid clamps.
[[nodiscard]] YokeClamping clamping_of(const Core& core, const Model& model, bool is_top);
/// Returns the core with the pressures of its clamps; unchanged if it has none. Throws ModelError.
[[nodiscard]] Core clamped(const Core& core, const Model& model);

} // namespace steplap

// [[clamp]]: the bolts or bands that press the sheets of a core's yokes together, and what pressure that makes at its corners.
//
// Of one yoke, from outer face to outer face of the outer limbs long (L) and Y high, on which clamps press with the forces F_i at the
// places x_i from its middle, clamping beams being rigid against the stack:
//   p(x) = ΣF_i/(L Y) + 12 ΣF_i x_i · x/(L³ Y),
// the pressure that is linear along the yoke and in equilibrium with the forces. All packets bear the same forces, each over its own
// height: the pressure of a packet whose yoke is Y_k high is Y/Y_k times that. A joint has the pressure at the axis of its limb.
//
// Of what a clamp was tightened with, F₀, there is left
//   F = (1 − r) F₀ − k s + k l (α_s − α_c) ΔT,  1/k = 1/k_c + 1/k_s,
// with r lost by relaxation, s what the stack has settled by since, ΔT what it has become warmer by, l the clamped length, α_s and α_c
// the expansions of stack and clamp, k_c and k_s the stiffnesses of a clamp and of the stack under it.
// Derivation: docs/reference/core.md, "What clamps".
#pragma once

#include "transformer/core/core.h"

namespace steplap {

/// Equal clamps on one yoke or on both.
struct Clamp : TableObject {
  std::string core;                                 ///< name of the core
  std::string at = "both";                          ///< yokes: "top", "bottom", "both"
  std::optional<long> count;                        ///< clamps on each yoke; default: as many as `places`, else 1
  std::vector<double> places;                       ///< m along the yoke, from the middle between the outer limbs; none: about its middle
  double preload = 0.0;                             ///< N, of each, as tightened
  double relaxation = 0.0;                          ///< share of it that is lost
  std::optional<double> stiffness, stack_stiffness; ///< N/m, of a clamp and of the stack under it
  double settling = 0.0;                            ///< m
  double warming = 0.0;                             ///< K
  std::optional<double> expansion;                  ///< 1/K, of the clamp
  double stack_expansion = 12e-6;                   ///< 1/K
  std::optional<double> length;                     ///< m; default: depth of the stack
  std::optional<double> yoke_length;                ///< m; default: between the outer faces of the outer limbs

  /// Of each clamp now, N; negative: it is loose. `depth`: of the stack, m.
  [[nodiscard]] double force(double depth) const;
};

/// What the clamps of one yoke come to.
struct YokeClamping {
  double force = 0.0;  ///< N, together
  double moment = 0.0; ///< N m, about the middle of the yoke
  double length = 0.0; ///< m, of the yoke
  double height = 0.0; ///< m, of its highest packet
  double middle = 0.0; ///< m along the active part from its centre of gravity
  [[nodiscard]] double pressure() const { return force / (length * height); }
  /// Share of the pressure that there is at x from the middle.
  [[nodiscard]] double share(double x) const { return 1.0 + 12.0 * moment * x / (force * length * length); }
};

[[nodiscard]] const TableKind& clamp_kind();

/// Are the fields of all clamps of the core within their ranges? If not, that is told where these tables are checked, and nothing is to be made of them.
[[nodiscard]] bool has_sound_clamps(const Core& core, const Model& model);
/// Is the core pressed by clamps of the model, and not by a pressure of its own?
[[nodiscard]] bool is_clamped(const Core& core, const Model& model);
/// Of the core's top or bottom yoke. Throws ModelError with what is wrong with its clamps.
[[nodiscard]] YokeClamping clamping_of(const Core& core, const Model& model, bool is_top);
/// The core with the pressures that its clamps make; as it is, if it has none. Throws ModelError.
[[nodiscard]] Core clamped(const Core& core, const Model& model);

} // namespace steplap

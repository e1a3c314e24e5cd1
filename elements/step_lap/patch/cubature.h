// Friction integrals over a piece with a far centre of rotation, for a single evaluation, by product Gauss rules over quadrilaterals.
//
// The piece is decomposed into a fan of quadrilaterals from the first corner of each ring; those of holes and concave corners count with
// their sign. They are within the piece's circle, and parts outside the piece cancel. On each, r = P + t D with P, D linear in s; the
// Jacobian and a linear traction are linear in t, and so is V = v + ω ẑ×r = A + t B. With the weights w_i of a rule in t
//
//   σ_k = Σ w_i J w tᵏ/|V|,  c_k = Σ w_i J w tᵏ/|V|³,
//
// the force of a row of nodes is A σ₀ + B σ₁ and its moment P×(A σ₀ + B σ₁) + D×(A σ₁ + B σ₂). Second derivatives are sums of the c_k up to
// k = 2, because r·V = r·v. By homogeneity h = f·v + m ω.
//
// Along a side of half length l, V = V_m (1 + q s) with |q| ≤ x = |ω| l/(|v| − |ω| R). The truncation error of n nodes in the series of |V|
// (degree 2n − 1 minus the degrees of Jacobian, lever twice and traction) is of the order x^(2n−3)/4ⁿ, or x^(2n−4)/4ⁿ with linear traction.
// The number of nodes is chosen so that this is below 2^-57; a change of their number then only appears as rounding.
#pragma once

#include "elements/step_lap/patch/far_field.h"
#include "elements/step_lap/patch/polygon.h"

namespace steplap {

/// Integrates about the piece's centroid. Precondition: |ω| radius ≤ |v| / k_far_ratio, v not zero.
template <bool WithCurvature>
[[nodiscard]] PieceDissipation integrate_far(const PatchEdge* edges, std::size_t count, const Traction& traction, double radius,
                                             const Vec2& v, double omega);

/// As above without curvature, for a polygon about any centre. `radius`: radius of a circle about the centre that contains the polygon;
/// `traction`: given at the centre.
[[nodiscard]] PieceDissipation integrate_far(const Polygon& polygon, const Vec2& centre, const Traction& traction, double radius,
                                             const Vec2& v, double omega);

extern template PieceDissipation integrate_far<false>(const PatchEdge*, std::size_t, const Traction&, double, const Vec2&, double);
extern template PieceDissipation integrate_far<true>(const PatchEdge*, std::size_t, const Traction&, double, const Vec2&, double);

} // namespace steplap

// Friction over a piece whose centre of rotation is far away, asked once: product Gauss rules over quadrilaterals.
//
// The piece is a fan of quadrilaterals from the first corner of each ring, those of holes and of dents with their signs: they
// lie within its circle, and what is outside cancels. On one of them, r = P + t D with P, D linear in s, the Jacobian and a
// linear traction are linear in t, and so is V = v + ω ẑ×r = A + t B. With the weights w_i of a rule in t
//   σ_k = Σ w_i J w tᵏ/|V|,  c_k = Σ w_i J w tᵏ/|V|³,
// the force of a row is A σ₀ + B σ₁ and its couple P×(A σ₀ + B σ₁) + D×(A σ₁ + B σ₂). Second derivatives are sums of the c_k
// up to k = 2, for r·V = r·v. The dissipation follows by homogeneity, h = f·v + m ω.
//
// Along a side of half length l, V = V_m (1 + q s) with |q| ≤ x = |ω| l/(|v| − |ω| R): what n nodes leave out of the series
// of |V|, of degree 2n − 1 less those of the Jacobian, of a lever twice and of the traction, is of the order of
// x^(2n−3)/4ⁿ, x^(2n−4)/4ⁿ with a linear traction. Nodes are as many as take that below 2^-57, so that a change of their
// number shows as rounding.
#pragma once

#include "elements/step_lap/patch/far_field.h"
#include "elements/step_lap/patch/polygon.h"

namespace steplap {

/// About the piece's centroid. Precondition: |ω| radius ≤ |v| / k_far_ratio, v not zero.
template <bool WithCurvature>
[[nodiscard]] PieceDissipation integrate_far(const PatchEdge* edges, std::size_t count, const Traction& traction, double radius,
                                             const Vec2& v, double omega);

/// The same, without curvature, of a polygon about any centre, `radius` being that of a circle about it which contains the
/// polygon; traction at the centre.
[[nodiscard]] PieceDissipation integrate_far(const Polygon& polygon, const Vec2& centre, const Traction& traction, double radius,
                                             const Vec2& v, double omega);

extern template PieceDissipation integrate_far<false>(const PatchEdge*, std::size_t, const Traction&, double, const Vec2&, double);
extern template PieceDissipation integrate_far<true>(const PatchEdge*, std::size_t, const Traction&, double, const Vec2&, double);

} // namespace steplap

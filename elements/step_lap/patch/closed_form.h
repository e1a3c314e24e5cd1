// Closed forms of the friction integrals over a polygon that rotates about a near point c.
//
// With r measured from c, unit tangent t and outward normal m = (t_y, −t_x) of an edge from a to b, d = a×t, s₁ = a·t, s₂ = b·t, ρᵢ = √(d²
// + sᵢ²), Λ = asinh(s₂/|d|) − asinh(s₁/|d|), the divergence theorem converts an integrand that is homogeneous of degree k to Σ_edges
// d/(k+2) ∫ ds:
//
//   ∬ |r| dA           = Σ d/6 [s₂ρ₂ − s₁ρ₁ + d²Λ]
//   ∬ r/|r| dA         = Σ d/2 [t(ρ₂−ρ₁) + d m Λ]
//   ∬ (I−uuᵀ)/|r| dA   = Σ d [m mᵀ(Λ−Δ(s/ρ)) + t tᵀ Δ(s/ρ) + d(m tᵀ+t mᵀ) Δ(1/ρ)],  u = r/|r|,
//
// and corresponding forms with a factor β·r for a linear pressure. Derivation: docs/explanation/limit_surface.md. Rounding errors grow like
// |c|²/area; for c beyond k_far_ratio radii far_field.h is used instead.
#pragma once

#include "elements/step_lap/patch/polygon.h"

namespace steplap {

/// An edge of a piece, relative to the piece's centroid.
struct PatchEdge {
  Vec2 start{0, 0};
  Vec2 along{1, 0};  ///< unit vector along the edge
  double length = 0; ///< length [m], > 0
  bool opens_ring = false;
};

/// Traction over a piece, n·μ·p [N/m²], at r from its centroid: at_centroid + gradient·r.
struct Traction {
  double at_centroid = 0;
  Vec2 gradient{0, 0};
};

/// Integrals of traction × (|r|, r/|r|, (I−uuᵀ)/|r|) over a piece, with r from the centre of rotation.
struct CentreIntegrals {
  double distance = 0;           ///< ∬ w |r| dA [N m]
  Vec2 direction{0, 0};          ///< ∬ w r/|r| dA [N]
  double xx = 0, xy = 0, yy = 0; ///< ∬ w (I−uuᵀ)/|r| dA [N/m]
};

/// Computes the integrals for the centre of rotation `c`, relative to the piece's centroid, which may be anywhere, also on an edge or a
/// vertex. Second derivatives are computed only with `WithCurvature`, otherwise zero.
template <bool WithCurvature>
[[nodiscard]] CentreIntegrals integrate_about(const PatchEdge* edges, std::size_t count, const Traction& traction, const Vec2& c);

extern template CentreIntegrals integrate_about<false>(const PatchEdge*, std::size_t, const Traction&, const Vec2&);
extern template CentreIntegrals integrate_about<true>(const PatchEdge*, std::size_t, const Traction&, const Vec2&);

} // namespace steplap

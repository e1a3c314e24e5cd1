// Friction integrals over a piece with a far centre of rotation, including pure translation.
//
// With complex r = x + iy from the piece's centroid, the velocity is V = v + iωr and
//
//   |V| = |v| Σ_jk b_j b_k qʲ q̄ᵏ rʲ r̄ᵏ,  q = iω/v,  b_j = binomial(1/2, j).
//
// With κ = ω/|v| and φ the direction of v
//
//   h = |v| g(κ, φ),  g = Re Σ_l e^{−ilφ} Σ_n a_{n,l} κⁿ  (n = l, l+2, …),
//   a_{n,l} = (2 if l > 0, else 1) · iˡ b_j b_k ∬ w rʲ r̄ᵏ dA,  j = (n+l)/2, k = (n−l)/2.
//
// The area moments are computed once per piece; g and its derivatives are then six real sums, smooth through ω = 0. The series converges
// for |κ| R < 1, with R the piece's radius about its centroid. It is truncated at order k_order and used for |κ| R ≤ 1/k_far_ratio, where
// the truncation error is below 1e-15 of h.
#pragma once

#include "elements/step_lap/patch/closed_form.h"

#include <array>

namespace steplap {

/// The closed form is used if the centre of rotation is within this number of radii.
inline constexpr double k_far_ratio = 6.0;

/// Dissipation of one piece for the twist (v at its centroid, ω), with derivatives.
struct PieceDissipation {
  double value = 0;              ///< h [W]
  double fx = 0, fy = 0, m = 0;  ///< gradient: wrench about the piece's centroid [N, N, N m]
  double xx = 0, xy = 0, yy = 0; ///< Hessian
  double xw = 0, yw = 0, ww = 0;
};

/// Coefficients a_{n,l} of one piece, or of several overlapping pieces; lengths are in units of the radius.
class FarField {
public:
  static constexpr int k_order = 18;

  /// Computes the coefficients, which takes about 7 µs for a quadrilateral.
  FarField(const PatchEdge* edges, std::size_t count, const Traction& traction, double radius);

  /// Constructor for several pieces about a common centre: call add() for each piece, then finish().
  explicit FarField(double radius);
  /// Adds a piece. Edges and traction are relative to its centroid, which is at `shift` from the centre.
  void add(const PatchEdge* edges, std::size_t count, const Traction& traction, const Vec2& shift);
  void finish();

  /// Returns the highest order n that is significant at |κ| R; at most k_order, which is also returned for NaN.
  [[nodiscard]] static int needed_order(double kappa_radius);

  /// Returns h with its derivatives. Precondition: |ω| radius ≤ |v| / k_far_ratio, v not zero.
  template <bool WithCurvature> [[nodiscard]] PieceDissipation evaluate(const Vec2& v, double omega) const;

private:
  static constexpr int k_row = k_order / 2 + 1;   // capacity for one l
  static constexpr int k_pairs = k_order / 2 + 1; // pairs of rows l and l + 2

  /// Adds the moments of a node at z (in radii) of the rule along an edge.
  void add_node(const Vec2& z, double uniform, double linear);

  /// Returns the index of a_{n,l}, n = l + 2k (real and imaginary part). Rows l and l + 2 are interleaved and summed together: four numbers
  /// for each n, zero where l + 2 has none.
  static constexpr int place(int l, int k) {
    const int second = l % 4 / 2;
    return 4 * ((l / 4 * 2 + l % 2) * k_row + k + second) + 2 * second;
  }

  double radius_ = 1;
  std::array<double, 4 * k_pairs * k_row> a_;
};

} // namespace steplap

// Dry friction distributed over an area: dissipation of a sliding twist, the corresponding wrench (Eqs. 11-15), and their derivatives.
//
// A twist ν = (v_x, v_y, ω) is the velocity of body b relative to body a at the patch's reference point and the relative angular velocity,
// in a's axes. With the traction w = n·μ·p (n interfaces, friction coefficient μ, pressure p) [N/m²]
//
//   h(ν) = ∬ w |v + ω ẑ×(r − reference)| dA   [W],
//
// convex, even, homogeneous of degree 1. The friction wrench on b about the reference is −∇h(ν); the admissible wrenches are {W : W·ν ≤
// h(ν) for all ν}.
//
// h is one smooth function of ν: the closed form for centres of rotation within k_far_ratio radii of a piece (closed_form.h), and the
// expansion (far_field.h) or cubature (cubature.h) beyond and for translation. Each is accurate to about 1e-13 of traction × area × size
// for pieces with an aspect ratio up to 100; the error grows in proportion beyond that. The pressure must not change during sliding.
// Derivation and limits: docs/explanation/limit_surface.md.
#pragma once

#include "elements/step_lap/patch/far_field.h"

namespace steplap {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// A weighted area: pieces with a traction each, and a reference point. clear() keeps the storage for reuse.
class Patch {
public:
  struct Piece {
    Vec2 centroid{0, 0}; ///< centroid in a's axes [m]
    Traction traction;
    double area = 0;
    double radius = 0; ///< radius of the circle about the centroid that contains the piece [m]
    std::size_t first_edge = 0, edges = 0;
  };

  explicit Patch(const Vec2& reference = Vec2::Zero()) : reference_(reference) {}

  /// Removes all pieces. Twists and wrenches then refer to `reference` [m].
  void clear(const Vec2& reference);

  /// Adds a polygon with uniform traction n·μ·p [N/m²] ≥ 0. Pieces with zero area or traction are ignored. Throws std::invalid_argument for
  /// a negative or non-finite traction.
  void add(const Polygon& polygon, double traction);
  /// Adds all polygons of a region with the same uniform traction.
  void add(const Region& region, double traction);

  /// Adds a polygon with linearly varying traction, integrated exactly; it must not be negative at any vertex.
  void add(const Polygon& polygon, const Traction& traction);

  /// Computes the expansions of all pieces (about 7 µs each), and common ones for overlapping pieces (the overlaps of a stack at one
  /// corner). Worthwhile for patches evaluated many times. Without it far evaluations use cubature, a tenth of a microsecond per node.
  void prepare();

  [[nodiscard]] bool empty() const { return pieces_.empty(); }
  [[nodiscard]] const Vec2& reference() const { return reference_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  [[nodiscard]] const PatchEdge* edges(const Piece& p) const { return edges_.data() + p.first_edge; }

  [[nodiscard]] double area() const { return area_; }              ///< total area of the pieces [m²]
  [[nodiscard]] double force() const { return force_; }            ///< ∬ w dA [N]: capacity in translation
  [[nodiscard]] Vec2 centroid() const { return moment_ / force_; } ///< centroid of the traction [m]
  /// Returns the radius of gyration of the traction about centroid() [m].
  [[nodiscard]] double gyration() const;

private:
  friend struct PatchAccess;
  void add_ring(const Ring& ring, const Vec2& centroid, double& radius);

  Vec2 reference_;
  std::vector<Piece> pieces_;
  std::vector<PatchEdge> edges_;
  void group_pieces();

  /// Pieces within a circle hardly larger than that of the largest of them, with a common expansion.
  struct Group {
    Vec2 centre{0, 0};
    double radius = 0;
    std::size_t first = 0, count = 0; ///< range in members_
    FarField far{1.0};
  };

  std::vector<FarField> far_; // expansions of a prepared patch, one per piece; otherwise empty
  std::vector<Group> groups_; // groups of a prepared patch; each piece is in one group; empty if no two pieces overlap
  bool are_groups_known_ = false;
  std::vector<std::size_t> members_;
  std::vector<char> is_grouped_;
  double area_ = 0, force_ = 0;
  double polar_ = 0; // ∬ w |r − centroid()|² dA [N m²]
  Vec2 moment_{0, 0};
};

/// h, wrench ∇h [N, N, N m] and Hessian at a twist. All zero at ν = 0, where h is not differentiable.
struct Dissipation {
  double h = 0;
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};

/// Returns h with its derivatives at ν (about the patch's reference point). The Hessian is positive semidefinite with ν in its null space,
/// of the order 1/|ν|.
[[nodiscard]] Dissipation evaluate(const Patch& patch, const Vec3& nu);

/// Returns h and its gradient; the Hessian is zero.
[[nodiscard]] Dissipation evaluate_gradient(const Patch& patch, const Vec3& nu);

/// Returns evaluate() with twist and wrench about another point [m].
[[nodiscard]] Dissipation evaluate_about(const Patch& patch, const Vec2& point, const Vec3& nu);
/// Returns evaluate_gradient() with twist and wrench about another point [m].
[[nodiscard]] Dissipation evaluate_gradient_about(const Patch& patch, const Vec2& point, const Vec3& nu);

/// Returns ∇h of one polygon with the traction w(r) = at_centroid + gradient·(r − origin), about `point`, for a single evaluation. For a
/// far centre of rotation cubature is used directly; for a near one the polygon is put into `spare`.
[[nodiscard]] Vec3 gradient_about(const Polygon& polygon, const Traction& traction, const Vec2& origin, const Vec2& point, const Vec3& nu,
                                  Patch& spare);

} // namespace steplap

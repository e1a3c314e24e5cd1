// Dry friction distributed over an area: the dissipation of a sliding twist, the wrench that goes
// with it (Eqs. 11-15) and their derivatives.
//
// A twist ν = (v_x, v_y, ω) is the relative velocity of body b against body a at the patch's
// reference point and its relative angular velocity, in a's axes. With the traction w = n·μ·p
// (n interfaces, friction coefficient μ, pressure p) [N/m²]
//   h(ν) = ∬ w |v + ω ẑ×(r − reference)| dA   [W],
// convex, even, homogeneous of degree 1. The friction wrench on b about the reference is −∇h(ν);
// the wrenches that friction can bear are {W : W·ν ≤ h(ν) for all ν}.
//
// One smooth function of ν: closed form for centres of rotation within k_far_ratio radii of a
// piece (closed_form.h), expansion (far_field.h) or cubature (cubature.h) beyond and for translation, each good to about
// 1e-13 of traction × area × size for pieces up to 100 times longer than wide; the loss grows in
// proportion beyond that. Assumes a pressure that does not change while sliding; see
// docs/explanation/limit_surface.md for derivation and limits.
#pragma once

#include "elements/step_lap/patch/far_field.h"

namespace steplap {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// A weighted area: pieces with a traction each, seen from one reference point. Reuse one by
/// clear(): it keeps its storage.
class Patch {
public:
  struct Piece {
    Vec2 centroid{0, 0}; ///< in a's axes [m]
    Traction traction;
    double area = 0;
    double radius = 0; ///< of the circle about the centroid that contains the piece [m]
    std::size_t first_edge = 0, edges = 0;
  };

  explicit Patch(const Vec2& reference = Vec2::Zero()) : reference_(reference) {}

  /// No pieces any more; twists and wrenches will be about `reference` [m].
  void clear(const Vec2& reference);

  /// Adds a polygon with uniform traction n·μ·p [N/m²] ≥ 0. Pieces without area or traction are
  /// left out. Throws std::invalid_argument for a negative or non-finite traction.
  void add(const Polygon& polygon, double traction);
  void add(const Region& region, double traction);

  /// The same with a traction that varies linearly over the polygon (exactly, in closed form);
  /// it must not be negative at any vertex.
  void add(const Polygon& polygon, const Traction& traction);

  /// Tabulates the expansions of all pieces (about 7 µs each), and those of pieces that lie over each other together
  /// (the overlaps of a stack at one corner), for patches evaluated many times.
  /// Without it far evaluations are integrated node by node (cubature.h), a tenth of a microsecond each.
  void prepare();

  [[nodiscard]] bool empty() const { return pieces_.empty(); }
  [[nodiscard]] const Vec2& reference() const { return reference_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  [[nodiscard]] const PatchEdge* edges(const Piece& p) const { return edges_.data() + p.first_edge; }

  [[nodiscard]] double area() const { return area_; }              ///< [m²]
  [[nodiscard]] double force() const { return force_; }            ///< ∬ w dA [N]: capacity in translation
  [[nodiscard]] Vec2 centroid() const { return moment_ / force_; } ///< of the traction [m]
  /// Radius of gyration of the traction about centroid() [m].
  [[nodiscard]] double gyration() const;

private:
  friend struct PatchAccess;
  void add_ring(const Ring& ring, const Vec2& centroid, double& radius);

  Vec2 reference_;
  std::vector<Piece> pieces_;
  std::vector<PatchEdge> edges_;
  void group_pieces();

  /// Pieces within a circle hardly larger than that of the largest: one expansion serves them all.
  struct Group {
    Vec2 centre{0, 0};
    double radius = 0;
    std::size_t first = 0, count = 0; ///< in members_
    FarField far{1.0};
  };

  std::vector<FarField> far_; // empty, or one per piece
  std::vector<Group> groups_; // of prepared patches, all pieces in one each; none if no two lie over each other
  bool are_groups_known_ = false;
  std::vector<std::size_t> members_;
  std::vector<char> is_grouped_;
  double area_ = 0, force_ = 0;
  double polar_ = 0; // ∬ w |r − centroid()|² dA
  Vec2 moment_{0, 0};
};

/// h, wrench ∇h [N, N, N m] and Hessian at a twist. All zero at ν = 0, where h has a kink.
struct Dissipation {
  double h = 0;
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};

/// h with its derivatives at ν (about the patch's reference point). The Hessian is positive
/// semidefinite with ν in its null space, and of the order of 1/|ν|.
[[nodiscard]] Dissipation evaluate(const Patch& patch, const Vec3& nu);

/// h and gradient only; the Hessian stays zero.
[[nodiscard]] Dissipation evaluate_gradient(const Patch& patch, const Vec3& nu);

/// The same with twist and wrench about another point [m] than the patch's reference.
[[nodiscard]] Dissipation evaluate_about(const Patch& patch, const Vec2& point, const Vec3& nu);
[[nodiscard]] Dissipation evaluate_gradient_about(const Patch& patch, const Vec2& point, const Vec3& nu);

/// ∇h of one polygon with the traction w(r) = at_centroid + gradient·(r − origin), about `point`, for who asks once: where the
/// centre of rotation is far, nothing is made of the polygon but what is asked for; where it is near, `spare` is made of it.
[[nodiscard]] Vec3 gradient_about(const Polygon& polygon, const Traction& traction, const Vec2& origin, const Vec2& point, const Vec3& nu,
                                  Patch& spare);

} // namespace steplap

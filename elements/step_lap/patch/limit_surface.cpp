#include "elements/step_lap/patch/limit_surface.h"

#include "elements/step_lap/patch/cubature.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace steplap {

struct PatchAccess {
  static const FarField* far(const Patch& p, std::size_t i) { return p.far_.empty() ? nullptr : &p.far_[i]; }
  static const std::vector<Patch::Group>& groups(const Patch& p) { return p.groups_; }
  static const std::vector<std::size_t>& members(const Patch& p) { return p.members_; }
};

namespace {

/// Returns h in closed form about the centre of rotation c = ẑ×v/ω: h = |ω| ∬ w|r−c| dA; the friction direction is u = ±ẑ×(r−c)/|r−c|.
template <bool WithCurvature>
PieceDissipation evaluate_near(const PatchEdge* edges, const Patch::Piece& piece, const Vec2& v, double omega) {
  const Vec2 c(-v.y() / omega, v.x() / omega);
  const auto k = integrate_about<WithCurvature>(edges, piece.edges, piece.traction, c);
  const double sign = omega > 0 ? 1.0 : -1.0, size = std::abs(omega);
  PieceDissipation out;
  out.value = size * k.distance;
  out.fx = -sign * k.direction.y();
  out.fy = sign * k.direction.x();
  out.m = sign * (k.distance + c.dot(k.direction));
  if constexpr (WithCurvature) {
    out.xx = k.yy / size; // ẑ× on both sides maps yy to xx
    out.yy = k.xx / size;
    out.xy = -k.xy / size;
    const double vx = v.x() / omega, vy = v.y() / omega;
    out.xw = -(out.xx * vx + out.xy * vy); // because Hessian · ν = 0
    out.yw = -(out.xy * vx + out.yy * vy);
    out.ww = -(out.xw * vx + out.yw * vy);
  }
  return out;
}

template <bool WithCurvature> PieceDissipation evaluate_piece(const Patch& patch, std::size_t i, const Vec2& v, double omega) {
  const Patch::Piece& piece = patch.pieces()[i];
  const double reach = k_far_ratio * piece.radius * omega;
  if (v.squaredNorm() <= reach * reach)
    return omega == 0 ? PieceDissipation{} : evaluate_near<WithCurvature>(patch.edges(piece), piece, v, omega);
  if (const FarField* far = PatchAccess::far(patch, i)) return far->evaluate<WithCurvature>(v, omega);
  return integrate_far<WithCurvature>(patch.edges(piece), piece.edges, piece.traction, piece.radius, v, omega);
}

/// Adds a piece whose centroid is at `arm` from the reference: v_piece = v + ω ẑ×arm.
template <bool WithCurvature> void add_shifted(Dissipation& out, const PieceDissipation& p, const Vec2& arm) {
  const double x = -arm.y(), y = arm.x();
  out.h += p.value;
  out.gradient += Vec3(p.fx, p.fy, p.m + x * p.fx + y * p.fy);
  if constexpr (WithCurvature) {
    const double hx = p.xx * x + p.xy * y, hy = p.xy * x + p.yy * y;
    Mat3& k = out.hessian;
    k(0, 0) += p.xx;
    k(0, 1) += p.xy;
    k(1, 1) += p.yy;
    k(0, 2) += p.xw + hx;
    k(1, 2) += p.yw + hy;
    k(2, 2) += p.ww + 2 * (x * p.xw + y * p.yw) + x * hx + y * hy;
  }
}

template <bool WithCurvature> void add_piece(Dissipation& out, const Patch& patch, std::size_t i, const Vec2& point, const Vec3& nu) {
  const Vec2 arm = patch.pieces()[i].centroid - point;
  const Vec2 v(nu[0] - nu[2] * arm.y(), nu[1] + nu[2] * arm.x());
  add_shifted<WithCurvature>(out, evaluate_piece<WithCurvature>(patch, i, v, nu[2]), arm);
}

/// Adds groups of overlapping pieces by their common expansions, if the centre of rotation is far from all of them.
template <bool WithCurvature> void add_groups(Dissipation& out, const Patch& patch, const Vec2& point, const Vec3& nu) {
  for (const auto& group : PatchAccess::groups(patch)) {
    const Vec2 arm = group.centre - point;
    const Vec2 v(nu[0] - nu[2] * arm.y(), nu[1] + nu[2] * arm.x());
    const double reach = k_far_ratio * group.radius * nu[2];
    if (group.count > 1 && v.squaredNorm() > reach * reach) {
      add_shifted<WithCurvature>(out, group.far.template evaluate<WithCurvature>(v, nu[2]), arm);
      continue;
    }
    for (std::size_t k = 0; k < group.count; ++k)
      add_piece<WithCurvature>(out, patch, PatchAccess::members(patch)[group.first + k], point, nu);
  }
}

template <bool WithCurvature> Dissipation evaluate_all(const Patch& patch, const Vec2& point, const Vec3& nu) {
  Dissipation out;
  if (!PatchAccess::groups(patch).empty()) {
    add_groups<WithCurvature>(out, patch, point, nu);
  } else {
    for (std::size_t i = 0; i < patch.pieces().size(); ++i) add_piece<WithCurvature>(out, patch, i, point, nu);
  }
  if constexpr (WithCurvature) {
    out.hessian(1, 0) = out.hessian(0, 1);
    out.hessian(2, 0) = out.hessian(0, 2);
    out.hessian(2, 1) = out.hessian(1, 2);
  }
  return out;
}

/// Moments ∬ w (1, r, |r|²) dA of one piece, r from its centroid.
struct TractionMoments {
  double force = 0;
  Vec2 first{0, 0};
  double polar = 0;
};

/// Returns the moments as sums over triangles (centroid, a, b), with ∬ λ₁ᵖλ₂^q dA = 2·area p! q!/(p+q+2)!.
TractionMoments moments_of(const PatchEdge* edges, const Patch::Piece& piece) {
  TractionMoments out;
  const Vec2& g = piece.traction.gradient;
  const double w = piece.traction.at_centroid;
  out.force = w * piece.area;
  for (std::size_t i = 0; i < piece.edges; ++i) {
    const PatchEdge& e = edges[i];
    const Vec2 &a = e.start, b = e.start + e.along * e.length, s = a + b;
    const double twice_area = cross(e.start, e.along) * e.length;
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
    const double ga = g.dot(a), gb = g.dot(b);
    out.polar += twice_area / 24 * w * (s.squaredNorm() + aa + bb);
    out.first += twice_area / 24 * ((ga + gb) * s + ga * a + gb * b);
    out.polar += twice_area / 60 * ((ga + gb) * (aa + bb + 2 * ab) + 2 * (ga * aa + gb * bb));
  }
  return out;
}

void require_traction(double w) {
  if (!(w >= 0) || !std::isfinite(w))
    throw std::invalid_argument("the traction of a friction patch (interfaces × friction "
                                "coefficient × pressure) must be a finite number, not negative");
}

} // namespace

void Patch::clear(const Vec2& reference) {
  reference_ = reference;
  pieces_.clear();
  edges_.clear();
  far_.clear();
  groups_.clear();
  are_groups_known_ = false;
  area_ = force_ = polar_ = 0;
  moment_.setZero();
}

void Patch::add_ring(const Ring& ring, const Vec2& centroid, double& radius) {
  bool opens = true;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i] - centroid, b = ring[i + 1 == ring.size() ? 0 : i + 1] - centroid;
    const double length = (b - a).norm();
    radius = std::max(radius, a.norm());
    if (length == 0) continue;
    edges_.push_back({a, (b - a) / length, length, std::exchange(opens, false)});
  }
}

void Patch::add(const Polygon& polygon, double traction) { add(polygon, Traction{traction, {0, 0}}); }

void Patch::add(const Region& region, double traction) {
  for (const Polygon& polygon : region) add(polygon, traction);
}

void Patch::add(const Polygon& polygon, const Traction& traction) {
  require_traction(traction.at_centroid);
  const double a = steplap::area(polygon);
  if (!(a > 0) || traction.at_centroid == 0) return;
  Piece piece;
  piece.centroid = steplap::centroid(polygon);
  piece.traction = traction;
  piece.area = a;
  piece.first_edge = edges_.size();
  add_ring(polygon.outer, piece.centroid, piece.radius);
  for (const Ring& hole : polygon.holes) add_ring(hole, piece.centroid, piece.radius);
  piece.edges = edges_.size() - piece.first_edge;

  if (!traction.gradient.isZero(0))
    for (std::size_t i = piece.first_edge; i < edges_.size(); ++i)
      require_traction(traction.at_centroid + traction.gradient.dot(edges_[i].start));

  const TractionMoments moments = moments_of(edges(piece), piece);
  const Vec2 centre = piece.centroid + moments.first / moments.force;
  const double polar = moments.polar - moments.first.squaredNorm() / moments.force;
  const Vec2 apart = centre - (force_ > 0 ? centroid() : centre);
  polar_ += polar + force_ * moments.force / (force_ + moments.force) * apart.squaredNorm();
  area_ += a;
  force_ += moments.force;
  moment_ += moments.force * centre;
  if (!far_.empty()) far_.emplace_back(edges(piece), piece.edges, traction, piece.radius);
  groups_.clear();
  are_groups_known_ = false;
  pieces_.push_back(piece);
}

void Patch::prepare() {
  for (std::size_t i = far_.size(); i < pieces_.size(); ++i)
    far_.emplace_back(edges(pieces_[i]), pieces_[i].edges, pieces_[i].traction, pieces_[i].radius);
  if (!are_groups_known_) group_pieces();
  are_groups_known_ = true;
}

// Forms groups: repeatedly takes the largest piece without a group and adds the pieces within nearly the same circle.
void Patch::group_pieces() {
  // Limits relative to the largest piece: its circle should contain the others with little excess, and smaller pieces should not lose
  // accuracy.
  constexpr double k_wider = 1.05, k_smaller = 0.8;
  members_.clear();
  is_grouped_.assign(pieces_.size(), 0);
  while (members_.size() < pieces_.size()) {
    std::size_t largest = pieces_.size();
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (!is_grouped_[i] && (largest == pieces_.size() || pieces_[i].radius > pieces_[largest].radius)) largest = i;
    Group group;
    group.centre = pieces_[largest].centroid;
    group.first = members_.size();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const double reach = (pieces_[i].centroid - group.centre).norm() + pieces_[i].radius;
      const bool is_like = reach <= k_wider * pieces_[largest].radius && pieces_[i].radius >= k_smaller * pieces_[largest].radius;
      if (is_grouped_[i] || !(is_like || i == largest)) continue;
      is_grouped_[i] = 1;
      members_.push_back(i);
      group.radius = std::max(group.radius, reach);
    }
    group.count = members_.size() - group.first;
    if (group.count > 1) {
      group.far = FarField(group.radius);
      for (std::size_t k = group.first; k < members_.size(); ++k) {
        const Piece& piece = pieces_[members_[k]];
        group.far.add(edges(piece), piece.edges, piece.traction, piece.centroid - group.centre);
      }
      group.far.finish();
    }
    groups_.push_back(group);
  }
  if (groups_.size() == pieces_.size()) groups_.clear(); // no two pieces overlap
}

double Patch::gyration() const { return std::sqrt(polar_ / force_); }

Dissipation evaluate(const Patch& patch, const Vec3& nu) { return evaluate_all<true>(patch, patch.reference(), nu); }
Dissipation evaluate_gradient(const Patch& patch, const Vec3& nu) { return evaluate_all<false>(patch, patch.reference(), nu); }
Dissipation evaluate_about(const Patch& patch, const Vec2& point, const Vec3& nu) { return evaluate_all<true>(patch, point, nu); }
Dissipation evaluate_gradient_about(const Patch& patch, const Vec2& point, const Vec3& nu) { return evaluate_all<false>(patch, point, nu); }

Vec3 gradient_about(const Polygon& polygon, const Traction& traction, const Vec2& origin, const Vec2& point, const Vec3& nu, Patch& spare) {
  Vec2 centre = Vec2::Zero();
  for (const Vec2& corner : polygon.outer) centre += corner;
  centre /= static_cast<double>(polygon.outer.size());
  double square = 0;
  for (const Vec2& corner : polygon.outer) square = std::max(square, (corner - centre).squaredNorm());
  const double radius = std::sqrt(square);
  const Vec2 arm = centre - point;
  const Vec2 v(nu[0] - nu[2] * arm.y(), nu[1] + nu[2] * arm.x());
  const double reach = k_far_ratio * radius * nu[2];
  if (v.squaredNorm() > reach * reach) {
    const Traction here{traction.at_centroid + traction.gradient.dot(centre - origin), traction.gradient};
    const PieceDissipation p = integrate_far(polygon, centre, here, radius, v, nu[2]);
    return {p.fx, p.fy, p.m + cross(arm, Vec2(p.fx, p.fy))};
  }
  spare.clear(point);
  const bool is_uniform = traction.gradient.isZero(0);
  const double at_centroid = traction.at_centroid + (is_uniform ? 0.0 : traction.gradient.dot(centroid(polygon) - origin));
  spare.add(polygon, Traction{at_centroid, traction.gradient});
  return evaluate_gradient(spare, nu).gradient;
}

} // namespace steplap

// Contact law of polygon_contact: forces from the overlap of two convex outlines.
//
// O is the overlap of the outlines of a and b, which is convex, and d(x) the distance of a point of O from the boundary of O. The stored
// energy is
//
//   U = 2 k ∫_O d(x) dA,
//
// the volume under a roof of slope 1 over O. The ridges of the roof divide O into cells, one for each edge: the points nearest to that
// edge. Moving edge i outwards by δ raises the roof over its cell by δ:
//
//   ∂U = 2 k A_i δ,  A_i the area of cell i: a force 2 k A_i acts on the edge at the centroid of its cell.
//
// Edges of a exert forces on a, those of b on b. A rigid motion of the roof preserves its volume, so both sums are equal and opposite, in
// forces and moments. Faces that overlap by d over a width w press with k w d (pressure k d); the force of a corner begins with the square
// of the penetration. U has continuous first derivatives also when corners and edges come and go, with one exception: if sides of a and b
// are on one line and adjacent faces press (bricks stacked flush), a ridge is there, and the force along the face jumps by k d², d/w of the
// normal force.
//
// The elastic force is computed from the body with fewer edges in O. For a face under a box it is then exactly normal to the face.
//
// Dissipation as by Hunt and Crossley at every point: the pressure is (1 + α c)₊ times the elastic one, with c the approach speed along the
// normal of the cell's edge. It never pulls. Both sets of cells cover O, so each contributes half.
//
// Sources: pressure fields and their overlap, R. Elandt et al., IROS 2019; energy of overlaps, Y. T. Feng, D. R. J. Owen, Eng. Comput. 21
// (2004) 265; potentials of distance, A. Munjiza, K. R. F. Andrews, Int. J. Numer. Meth. Eng. 49 (2000) 1377.
#pragma once

#include "mbd/base/dual.h"
#include "mbd/system/motion.h"

#include <array>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace steplap {

inline constexpr int k_most_corners = 16;                  ///< largest number of corners of an outline
inline constexpr int k_most_ring = 4 * k_most_corners + 4; ///< largest number of corners of a clipped polygon; a cut adds at most one

/// A convex outline relative to the body's centre of gravity, counter-clockwise; edge k runs from corner k to the next. A half-plane has
/// one edge and no corners.
struct ConvexOutline {
  std::vector<Vec2> corners;
  std::vector<Vec2> normals;   ///< outward unit normals of the edges
  std::vector<double> offsets; ///< normal · corner; smaller values of normal · x are inside

  [[nodiscard]] int edge_count() const { return static_cast<int>(normals.size()); }
  [[nodiscard]] int corner_count() const { return static_cast<int>(corners.size()); }
};

/// An array without initialisation, for outlines: most have four corners, and initialising the full capacity would take longer than
/// computing them. Elements must be written before they are read.
template <class T, std::size_t N> class Room {
public:
  Room() {} // NOLINT: not initialised
  [[nodiscard]] T& operator[](std::size_t i) { return items_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return items_[i]; }

private:
  static_assert(std::is_trivially_copyable_v<T>);
  union {
    T items_[N];
  };
};
/// Room for double, std::array for all other number types.
template <class S, class T, std::size_t N> using RoomFor = std::conditional_t<std::is_floating_point_v<S>, Room<T, N>, std::array<T, N>>;

/// An outline at the pose of its body, relative to a common origin.
template <class S> struct PlacedOutline {
  int corner_count = 0, edge_count = 0;
  RoomFor<S, Pair<S>, k_most_corners> corner, normal;
  RoomFor<S, S, k_most_corners> offset;
};

template <class S, class Body>
void place_outline(const ConvexOutline& outline, const Body& body, const Pair<S>& centre, PlacedOutline<S>& out) {
  out.corner_count = outline.corner_count();
  out.edge_count = outline.edge_count();
  for (int i = 0; i < out.corner_count; ++i) out.corner[i] = centre + to_ground(body, outline.corners[i]);
  for (int i = 0; i < out.edge_count; ++i) {
    out.normal[i] = to_ground(body, outline.normals[i]);
    out.offset[i] = S(outline.offsets[i]) + dot(out.normal[i], centre);
  }
}

/// Signed distance of two outlines (negative: least displacement that separates them), and the face and corner that define it.
struct Separation {
  double gap = -std::numeric_limits<double>::infinity();
  int face = -1;   ///< face as edge of a; edges of b are counted after those of a
  int corner = -1; ///< corner of the other body that is nearest to this face, or deepest behind it; −1: none
};

/// Returns the distance for one face, with the nearest or deepest corner of the other body. If it is not above `least` it may be too large:
/// the search ends at the first corner that shows this. Of two outlines far apart most faces have the other behind them.
inline Separation face_separation(const PlacedOutline<double>& own, int edge, const PlacedOutline<double>& other, double least) {
  Separation found;
  found.gap = std::numeric_limits<double>::infinity();
  for (int i = 0; i < other.corner_count; ++i) {
    const double height = dot(own.normal[edge], other.corner[i]) - own.offset[edge];
    if (!(height >= found.gap)) { // the comparison also accepts NaN, which is reported where forces are checked
      found.gap = height;
      found.corner = i;
      if (height <= least) break;
    }
  }
  return found;
}

/// Returns the distance of two outlines: the largest over all faces. Convex outlines are separate if and only if one of their faces
/// separates them.
inline Separation separation_of(const PlacedOutline<double>& a, const PlacedOutline<double>& b) {
  Separation best;
  const auto look = [&best](const PlacedOutline<double>& own, const PlacedOutline<double>& other, int first) {
    if (other.corner_count == 0) return; // a half-plane extends behind every face
    for (int edge = 0; edge < own.edge_count; ++edge) {
      Separation found = face_separation(own, edge, other, best.gap);
      if (best.corner >= 0 && found.gap <= best.gap) continue;
      found.face = first + edge;
      best = found;
    }
  };
  look(b, a, a.edge_count);
  look(a, b, 0);
  return best;
}

/// A convex polygon during clipping. `edge`: for each corner, the original edge that leads to the next corner; edges of b are counted after
/// those of a.
template <class S> struct CutRing {
  int size = 0;
  RoomFor<S, Pair<S>, k_most_ring> corner;
  std::array<int, k_most_ring> edge;
};

/// Writes the part of `in` with depth ≥ 0 to `out`; `depth` is a linear function of position. The new edge gets the number `made`. Returns
/// false, and leaves `out` as it is, if no corner is outside.
template <class S, class Depth> [[nodiscard]] bool cut(const CutRing<S>& in, const Depth& depth, int made, CutRing<S>& out) {
  if (in.size == 0) return false;
  const S first = depth(in.corner[0]);
  S now = first;
  int begin = 0; // last corner before the first one outside
  if (!(now < S(0)))
    for (;; ++begin) {
      if (begin + 1 == in.size) return false;
      const S next = depth(in.corner[begin + 1]);
      if (next < S(0)) break;
      now = next;
    }
  out.size = begin;
  for (int i = 0; i < begin; ++i) {
    out.corner[i] = in.corner[i];
    out.edge[i] = in.edge[i];
  }
  const auto put = [&out](const Pair<S>& corner, int edge) {
    // Capacity exceeded, only possible in slivers of rounding size, whose corners change sides more than twice: the rest is dropped.
    if (out.size == k_most_ring) return;
    out.corner[out.size] = corner;
    out.edge[out.size++] = edge;
  };
  for (int i = begin; i < in.size; ++i) {
    const int j = i + 1 < in.size ? i + 1 : 0;
    const S next = j == 0 ? first : depth(in.corner[j]);
    const bool is_in = !(now < S(0)), is_next_in = !(next < S(0));
    if (is_in) put(in.corner[i], in.edge[i]);
    if (is_in != is_next_in) {
      const S share = now / (now - next);
      const Pair<S> crossing = in.corner[i] + share * (in.corner[j] - in.corner[i]);
      put(crossing, is_in ? made : in.edge[i]);
    }
    now = next;
  }
  return true;
}

/// Resultant of the forces on a by the overlap.
template <class S> struct OverlapForce {
  Pair<S> force;
  S moment{0};      ///< moment about the origin, N m
  S volume{0};      ///< ∫ d dA, m³; zero unless it was asked for
  S dissipation{0}; ///< dissipated power, W
  /// True if one outline is completely inside the other: the boundary of the overlap then belongs to one body, and no force separates them.
  bool is_swallowed = false;
};

/// Velocity of points of a relative to b: u + Ω ẑ × x, with x from the common origin.
template <class S> struct RelativeVelocity {
  Pair<S> u;
  S spin{0};
};

namespace overlap_detail {

// Integrals ∫ 1, τ, τ² over a polygon, with τ the coordinate across n, and ∫ ν, with ν the coordinate along n from its first corner. The
// last two only if asked for.
template <class S> struct CellSums {
  S area{0}, across{0}, across2{0}, along{0};
};

// Sums over triangles from the first corner: triangles from a distant origin would cancel, and the cells at the ends of a thin overlap are
// as small as the depth squared.
template <class S> CellSums<S> sums_of(const CutRing<S>& ring, const Pair<S>& n, bool has_square, bool has_along) {
  CellSums<S> sums;
  if (ring.size < 3) return sums;
  const Pair<S>& first = ring.corner[0];
  for (int i = 1; i + 1 < ring.size; ++i) {
    const Pair<S> p = ring.corner[i] - first, q = ring.corner[i + 1] - first;
    const S twice = cross(p, q), s = cross(p, n), t = cross(q, n);
    sums.area += S(0.5) * twice;
    sums.across += S(1.0 / 6.0) * twice * (s + t);
    if (has_square) sums.across2 += S(1.0 / 12.0) * twice * (s * s + s * t + t * t);
    if (has_along) sums.along += S(1.0 / 6.0) * twice * (dot(p, n) + dot(q, n));
  }
  const S aside = cross(first, n);
  if (has_square) sums.across2 += aside * (S(2) * sums.across + aside * sums.area);
  sums.across += aside * sums.area;
  return sums;
}

template <class S> struct EdgeLine {
  Pair<S> normal;
  S offset{0};
  [[nodiscard]] S depth(const Pair<S>& x) const { return offset - dot(normal, x); }
};

} // namespace overlap_detail

/// Returns the forces of two outlines placed about a common origin. `stiffness`: k, N/m²; `dissipation`: α, s/m. `has_volume`: computes the
/// volume, too; otherwise cells without force are skipped.
template <class S>
OverlapForce<S> overlap_force(const PlacedOutline<S>& a, const PlacedOutline<S>& b, const RelativeVelocity<S>& velocity, double stiffness,
                              double dissipation, bool has_volume = false) {
  using overlap_detail::EdgeLine;
  OverlapForce<S> result;
  CutRing<S> rings[3];
  int now = 0;
  rings[0].size = a.corner_count;
  for (int i = 0; i < a.corner_count; ++i) {
    rings[0].corner[i] = a.corner[i];
    rings[0].edge[i] = i;
  }
  for (int j = 0; j < b.edge_count && rings[now].size > 0; ++j) {
    const auto depth = [&](const Pair<S>& x) { return b.offset[j] - dot(b.normal[j], x); };
    if (cut(rings[now], depth, a.edge_count + j, rings[1 - now])) now = 1 - now;
  }
  CutRing<S>& overlap = rings[now];
  if (overlap.size < 3) return result;
  const Pair<S> origin = overlap.corner[0]; // origin at a corner of the overlap, for accuracy of thin overlaps
  for (int i = 0; i < overlap.size; ++i) overlap.corner[i] = overlap.corner[i] - origin;
  const Pair<S> u = velocity.u + velocity.spin * perp(origin);
  RoomFor<S, EdgeLine<S>, k_most_ring> line;
  int of_a = 0;
  for (int i = 0; i < overlap.size; ++i) {
    const int edge = overlap.edge[i];
    const bool is_a = edge < a.edge_count;
    of_a += is_a ? 1 : 0;
    line[i].normal = is_a ? a.normal[edge] : b.normal[edge - a.edge_count];
    line[i].offset = (is_a ? a.offset[edge] : b.offset[edge - a.edge_count]) - dot(line[i].normal, origin);
  }
  CutRing<S>*cell = &rings[1 - now], *spare = &rings[2]; // `cell` points to the ring written last
  const S k(stiffness), alpha(dissipation);
  result.is_swallowed = of_a == 0 || of_a == overlap.size;
  const bool is_from_a = 2 * of_a < overlap.size;
  S moment(0);
  for (int i = 0; i < overlap.size; ++i) {
    const bool is_a = overlap.edge[i] < a.edge_count, is_elastic = is_a == is_from_a;
    if (!is_elastic && dissipation == 0.0 && !has_volume) continue;
    const CutRing<S>* source = &overlap;
    bool has_others = false; // edges besides this one
    for (int j = 0; j < overlap.size && source->size > 0; ++j) {
      if (overlap.edge[j] == overlap.edge[i]) continue;
      has_others = true;
      const auto below = [&](const Pair<S>& x) { return line[j].depth(x) - line[i].depth(x); };
      if (!cut(*source, below, overlap.edge[j], *spare)) continue;
      std::swap(cell, spare);
      source = cell;
    }
    if (!has_others || source->size < 3) continue;
    const Pair<S> n = S(is_a ? -1.0 : 1.0) * line[i].normal; // direction of the force on a
    const auto whole = overlap_detail::sums_of(*source, n, dissipation != 0.0, has_volume);
    const S closing = -dot(u, n), turning = -velocity.spin; // c = closing + turning τ
    if (has_volume) result.volume += line[i].depth(source->corner[0]) * whole.area + (is_a ? whole.along : -whole.along);
    if (is_elastic) {
      result.force = result.force + (S(2) * k * whole.area) * n;
      moment += S(2) * k * whole.across;
    }
    if (dissipation == 0.0) continue;
    const auto pressure = [&](const Pair<S>& x) { return S(1) + alpha * (closing + turning * cross(x, n)); };
    const bool is_less = cut(*source, pressure, -1, *spare); // some of the cell has no pressure
    const auto part = is_less ? overlap_detail::sums_of(*spare, n, true, false) : whole;
    const S rest = S(1) + alpha * closing, slope = alpha * turning;
    // Force of the dissipation; exactly zero at rest.
    const S f = rest * part.area + slope * part.across - whole.area, m = rest * part.across + slope * part.across2 - whole.across;
    result.force = result.force + (k * f) * n;
    moment += k * m;
    result.dissipation += k * (closing * f + turning * m);
  }
  result.moment = moment + cross(origin, result.force);
  return result;
}

} // namespace steplap

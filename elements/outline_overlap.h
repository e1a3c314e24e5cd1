// Overlap of two convex outlines, and what it costs to press them into each other: the contact law of polygon_contact.
//
// O is the overlap of the outlines of a and b, itself convex, d(x) the distance of a point of O from O's rim. The energy is
//   U = 2 k ∫_O d(x) dA,
// the volume under the roof of slope 1 over O. Its ridges part O into cells, one for each edge: the points nearest to it.
// Moving edge i outwards by δ raises the roof over its cell alone, by δ, so that
//   ∂U = 2 k A_i δ,  A_i the area of cell i: the edge is pushed back by 2 k A_i at the cell's middle.
// Edges of a push a, those of b push b; moved as a whole the roof keeps its volume, so that both sums are equal and opposite,
// as forces and as moments about any point. Faces that overlap by d over a width w press with k w d each on the other
// (pressure k d); corners come in with a force that begins as the square of the depth. U has continuous first derivatives
// whatever corners and edges come and go, but for one case: sides of a and b that lie on one line while faces across them
// press (bricks stacked flush) have a ridge there, and the force along the face jumps by k d², a share d/w of the normal one.
//
// So the elastic force is taken from the side with fewer edges: of a face under a box it is normal to that face to the last bit.
//
// Dissipation as of Hunt and Crossley in every point: the pressure is (1 + α c)₊ times the elastic one, c the speed at which
// the two bodies close along the cell's edge normal. It never pulls and is zero where they part. Both sets of cells cover O,
// each takes half.
// Sources: pressure fields and their overlap, R. Elandt et al., IROS 2019; energy of overlaps, Y. T. Feng, D. R. J. Owen, Eng.
// Comput. 21 (2004) 265; potentials of distance, A. Munjiza, K. R. F. Andrews, Int. J. Numer. Meth. Eng. 49 (2000) 1377.
#pragma once

#include "mbd/base/dual.h"
#include "mbd/system/motion.h"

#include <array>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace steplap {

inline constexpr int k_most_corners = 16;                  ///< of one outline
inline constexpr int k_most_ring = 4 * k_most_corners + 4; ///< a clip adds at most one corner

/// A convex outline about its body's centre of gravity, counter-clockwise; edge k runs from corner k to the next. A half-plane
/// has one edge and no corners.
struct ConvexOutline {
  std::vector<Vec2> corners;
  std::vector<Vec2> normals;   ///< of the edges, outwards, of length 1
  std::vector<double> offsets; ///< normal · corner: inside, normal · x is less

  [[nodiscard]] int edge_count() const { return static_cast<int>(normals.size()); }
  [[nodiscard]] int corner_count() const { return static_cast<int>(corners.size()); }
};

/// An array of which what is not used is not made either: most outlines have four corners, and to set the room for the most to
/// zero would take longer than to place them. What is read was written before.
template <class T, std::size_t N> class Room {
public:
  Room() {} // NOLINT: not as zeros
  [[nodiscard]] T& operator[](std::size_t i) { return items_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return items_[i]; }

private:
  static_assert(std::is_trivially_copyable_v<T>);
  union {
    T items_[N];
  };
};
/// Of plain numbers; others are made.
template <class S, class T, std::size_t N> using RoomFor = std::conditional_t<std::is_floating_point_v<S>, Room<T, N>, std::array<T, N>>;

/// The same where its body is, seen from one origin.
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

/// By how much two outlines are apart (negative: the least way that parts them), and where.
struct Separation {
  double gap = -std::numeric_limits<double>::infinity();
  int face = -1;   ///< edge of a, or edge of b behind those of a
  int corner = -1; ///< of the other body, nearest to that face or deepest behind it
};

/// Of one face: the other body's corner that is nearest to it, or deepest behind it.
inline Separation face_separation(const PlacedOutline<double>& own, int edge, const PlacedOutline<double>& other) {
  Separation found;
  found.gap = std::numeric_limits<double>::infinity();
  for (int i = 0; i < other.corner_count; ++i) {
    const double height = dot(own.normal[edge], other.corner[i]) - own.offset[edge];
    if (!(height >= found.gap)) { // not-a-number, too, is no gap: it is told where forces are checked
      found.gap = height;
      found.corner = i;
    }
  }
  return found;
}

/// Convex outlines are apart if and only if a face of one of them has the other before it.
inline Separation separation_of(const PlacedOutline<double>& a, const PlacedOutline<double>& b) {
  Separation best;
  const auto look = [&best](const PlacedOutline<double>& own, const PlacedOutline<double>& other, int first) {
    if (other.corner_count == 0) return; // a half-plane reaches behind every face
    for (int edge = 0; edge < own.edge_count; ++edge) {
      Separation found = face_separation(own, edge, other);
      if (best.corner >= 0 && found.gap <= best.gap) continue;
      found.face = first + edge;
      best = found;
    }
  };
  look(b, a, a.edge_count);
  look(a, b, 0);
  return best;
}

/// A convex polygon being cut; `edge` of the edge from each corner to the next: of a, or of b behind those of a.
template <class S> struct CutRing {
  int size = 0;
  RoomFor<S, Pair<S>, k_most_ring> corner;
  std::array<int, k_most_ring> edge;
};

/// What of `in` has a depth that is not negative; depth is linear in the place. The edge that this makes is `made`.
template <class S, class Depth> void cut(const CutRing<S>& in, const Depth& depth, int made, CutRing<S>& out) {
  out.size = 0;
  if (in.size == 0) return;
  const auto put = [&out](const Pair<S>& corner, int edge) {
    if (out.size == k_most_ring) return; // slivers of rounding, whose corners change sides more than twice
    out.corner[out.size] = corner;
    out.edge[out.size++] = edge;
  };
  S now = depth(in.corner[0]);
  const S first = now;
  for (int i = 0; i < in.size; ++i) {
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
}

/// Force and moment on a that the overlap makes.
template <class S> struct OverlapForce {
  Pair<S> force;
  S moment{0};      ///< about the origin
  S volume{0};      ///< ∫ d dA
  S dissipation{0}; ///< W
  /// One outline lies wholly within the other: the rim of the overlap belongs to one of them alone, nothing pushes it out.
  bool is_swallowed = false;
};

/// Relative velocity of a's points seen from b's: u + Ω ẑ × x.
template <class S> struct RelativeVelocity {
  Pair<S> u;
  S spin{0};
};

namespace overlap_detail {

// ∫ 1, τ, τ², ν over a polygon, τ and ν the components of places across and along n.
template <class S> struct CellSums {
  S area{0}, across{0}, across2{0}, along{0};
};

template <class S> CellSums<S> sums_of(const CutRing<S>& ring, const Pair<S>& n) {
  CellSums<S> sums;
  for (int i = 0; i < ring.size; ++i) {
    const Pair<S>&p = ring.corner[i], &q = ring.corner[i + 1 < ring.size ? i + 1 : 0];
    const S twice = cross(p, q), s = cross(p, n), t = cross(q, n);
    sums.area += S(0.5) * twice;
    sums.across += S(1.0 / 6.0) * twice * (s + t);
    sums.across2 += S(1.0 / 12.0) * twice * (s * s + s * t + t * t);
    sums.along += S(1.0 / 6.0) * twice * (dot(p, n) + dot(q, n));
  }
  return sums;
}

template <class S> struct EdgeLine {
  Pair<S> normal;
  S offset{0};
  [[nodiscard]] S depth(const Pair<S>& x) const { return offset - dot(normal, x); }
};

} // namespace overlap_detail

/// Of outlines placed about one origin. `stiffness` k in N/m², `dissipation` α in s/m. The volume is that of the whole roof only
/// if `is_whole`; else cells that no force is asked of are left out.
template <class S>
OverlapForce<S> overlap_force(const PlacedOutline<S>& a, const PlacedOutline<S>& b, const RelativeVelocity<S>& velocity, double stiffness,
                              double dissipation, bool is_whole = false) {
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
    cut(rings[now], depth, a.edge_count + j, rings[1 - now]);
    now = 1 - now;
  }
  CutRing<S>& overlap = rings[now];
  if (overlap.size < 3) return result;
  const Pair<S> origin = overlap.corner[0]; // thin as it is, it is measured from a corner of its own
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
  CutRing<S>*cell = &rings[1 - now], *spare = &rings[2]; // `cell` is the one written last
  const S k(stiffness), alpha(dissipation);
  result.is_swallowed = of_a == 0 || of_a == overlap.size;
  const bool is_from_a = 2 * of_a < overlap.size;
  S moment(0);
  for (int i = 0; i < overlap.size; ++i) {
    const bool is_a = overlap.edge[i] < a.edge_count, is_elastic = is_a == is_from_a;
    if (!is_elastic && dissipation == 0.0 && !is_whole) continue;
    const CutRing<S>* source = &overlap;
    for (int j = 0; j < overlap.size && source->size > 0; ++j) {
      if (overlap.edge[j] == overlap.edge[i]) continue;
      const auto below = [&](const Pair<S>& x) { return line[j].depth(x) - line[i].depth(x); };
      cut(*source, below, overlap.edge[j], *spare);
      std::swap(cell, spare);
      source = cell;
    }
    if (source == &overlap || source->size < 3) continue;
    const Pair<S> n = S(is_a ? -1.0 : 1.0) * line[i].normal; // along which a is pushed
    const auto whole = overlap_detail::sums_of(*cell, n);
    const S closing = -dot(u, n), turning = -velocity.spin; // c = closing + turning τ
    result.volume += line[i].offset * whole.area + (is_a ? whole.along : -whole.along);
    if (is_elastic) {
      result.force = result.force + (S(2) * k * whole.area) * n;
      moment += S(2) * k * whole.across;
    }
    if (dissipation == 0.0) continue;
    const auto pressure = [&](const Pair<S>& x) { return S(1) + alpha * (closing + turning * cross(x, n)); };
    cut(*cell, pressure, -1, *spare);
    const auto part = overlap_detail::sums_of(*spare, n);
    const S rest = S(1) + alpha * closing, slope = alpha * turning;
    // What the dissipation adds; nothing, to the last bit, at rest.
    const S f = rest * part.area + slope * part.across - whole.area, m = rest * part.across + slope * part.across2 - whole.across;
    result.force = result.force + (k * f) * n;
    moment += k * m;
    result.dissipation += k * (closing * f + turning * m);
  }
  result.moment = moment + cross(origin, result.force);
  return result;
}

} // namespace steplap

#include "elements/step_lap/patch/exact_polygon.h"

#include "mbd/base/portable_math.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <variant>

namespace steplap {

namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = Exact::Point_2;
using ExactRing = std::vector<ExactPoint>;
using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel; // double coordinates, exact decisions
using Point = Predicates::Point_2;

Point point(const Vec2& p) { return {p.x(), p.y()}; }

std::size_t next(std::size_t i, std::size_t n) { return i + 1 == n ? 0 : i + 1; }

struct Box {
  Vec2 low, high;
  [[nodiscard]] bool apart(const Box& o) const { return (high.array() < o.low.array()).any() || (o.high.array() < low.array()).any(); }
};

Box edge_box(const Ring& r, std::size_t i) {
  const Vec2 &a = r[i], &b = r[next(i, r.size())];
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

bool edges_meet(const Ring& r, std::size_t i, const Ring& q, std::size_t j) {
  return !edge_box(r, i).apart(edge_box(q, j)) && CGAL::do_intersect(Predicates::Segment_2(point(r[i]), point(r[next(i, r.size())])),
                                                                     Predicates::Segment_2(point(q[j]), point(q[next(j, q.size())])));
}

/// Consecutive edges a-b, b-c intersect beyond b only if the second runs back along the first.
bool folds_back(const Ring& r, std::size_t i) {
  const std::size_t j = next(i, r.size());
  const Vec2 &a = r[i], &b = r[j], &c = r[next(j, r.size())];
  return CGAL::orientation(point(a), point(b), point(c)) == CGAL::COLLINEAR && (b - a).dot(c - b) <= 0;
}

std::optional<std::array<std::size_t, 4>> clash_within(const Ring& r, std::size_t index) {
  const std::size_t n = r.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (folds_back(r, i)) return std::array{index, index, i, next(i, n)};
    for (std::size_t j = i + 2; j < n; ++j)
      if (next(j, n) != i && edges_meet(r, i, r, j)) return std::array{index, index, i, j};
  }
  return std::nullopt;
}

/// Rings of a polygon after repaired(): the outer ring counter-clockwise, holes clockwise, so that the interior is on the left of every
/// edge.
using ExactRings = std::vector<ExactRing>;

ExactRing exact_ring(const Ring& ring, const Pose& pose) {
  // The affine map itself is evaluated exactly, so a simple ring stays simple whatever the rounding of sine and cosine.
  const portable::SinCos turn = portable::sin_cos(pose.theta);
  const Exact::FT c(turn.cos), s(turn.sin), x(pose.x), y(pose.y);
  const bool moved = pose.theta != 0;
  ExactRing out;
  for (const Vec2& p : ring) {
    const Exact::FT px(p.x()), py(p.y());
    out.push_back(moved ? ExactPoint(c * px - s * py + x, s * px + c * py + y) : ExactPoint(px + x, py + y));
  }
  return out;
}

ExactRings exact_rings(const Polygon& polygon, const Pose& pose) {
  ExactRings out{exact_ring(polygon.outer, pose)};
  for (const Ring& hole : polygon.holes) out.push_back(exact_ring(hole, pose));
  return out;
}

struct ExactEdge {
  ExactPoint from, to;
  friend bool operator<(const ExactEdge& a, const ExactEdge& b) {
    const CGAL::Comparison_result order = CGAL::compare_xy(a.from, b.from);
    return order != CGAL::EQUAL ? order == CGAL::SMALLER : CGAL::compare_xy(a.to, b.to) == CGAL::SMALLER;
  }
};

#if CGAL_VERSION_NR >= 1060000000 // from CGAL 6.0 on the result is a std::variant, before a boost::variant
template <class Alternative, class Meeting> const Alternative* as(const Meeting& meeting) { return std::get_if<Alternative>(&meeting); }
#else
template <class Alternative, class Meeting> const Alternative* as(const Meeting& meeting) { return boost::get<Alternative>(&meeting); }
#endif

/// Adds the end points of the intersection of two edges, if there is one.
void add_meeting(const ExactEdge& a, const ExactEdge& b, std::vector<ExactPoint>& out) {
  const auto meeting = CGAL::intersection(Exact::Segment_2(a.from, a.to), Exact::Segment_2(b.from, b.to));
  if (!meeting) return;
  if (const auto* p = as<ExactPoint>(*meeting)) {
    out.push_back(*p);
  } else if (const auto* s = as<Exact::Segment_2>(*meeting)) {
    out.push_back(s->source());
    out.push_back(s->target());
  }
}

/// Returns the edges of `rings`, divided wherever edges of `others` meet them. Afterwards no two edges cross, and overlapping ones are
/// equal or reversed.
std::vector<ExactEdge> cut_edges(const ExactRings& rings, const ExactRings& others) {
  std::vector<ExactEdge> out;
  std::vector<ExactPoint> stations;
  for (const ExactRing& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const ExactEdge edge{ring[i], ring[next(i, ring.size())]};
      const CGAL::Bbox_2 box = edge.from.bbox() + edge.to.bbox();
      stations = {edge.from, edge.to};
      for (const ExactRing& other : others)
        for (std::size_t j = 0; j < other.size(); ++j) {
          const ExactEdge its{other[j], other[next(j, other.size())]};
          if (CGAL::do_overlap(box, its.from.bbox() + its.to.bbox())) add_meeting(edge, its, stations);
        }
      const bool goes_up = CGAL::compare_xy(edge.from, edge.to) == CGAL::SMALLER;
      std::sort(stations.begin(), stations.end(), [&](const ExactPoint& p, const ExactPoint& q) {
        return CGAL::compare_xy(p, q) == (goes_up ? CGAL::SMALLER : CGAL::LARGER);
      });
      for (std::size_t k = 1; k < stations.size(); ++k)
        if (stations[k - 1] != stations[k]) out.push_back({stations[k - 1], stations[k]});
    }
  return out;
}

/// Returns true if a point that is on none of the rings is inside an outer ring and in no hole.
bool is_within(const ExactPoint& p, const ExactRings& rings) {
  bool inside = false;
  for (const ExactRing& ring : rings)
    if (CGAL::bounded_side_2(ring.begin(), ring.end(), p, Exact()) == CGAL::ON_BOUNDED_SIDE) inside = !inside;
  return inside;
}

ExactPoint middle(const ExactEdge& e) { return CGAL::midpoint(e.from, e.to); }

/// Adds the edges of one polygon that are inside the other polygon (`wanted`) or outside it.
void keep_apart(const std::vector<ExactEdge>& edges, const std::set<ExactEdge>& of_other, const ExactRings& other, bool wanted,
                bool reverse, std::vector<ExactEdge>& out) {
  for (const ExactEdge& e : edges) {
    if (of_other.contains(e) || of_other.contains({e.to, e.from}) || is_within(middle(e), other) != wanted) continue;
    out.push_back(reverse ? ExactEdge{e.to, e.from} : e);
  }
}

/// Returns the boundary of a ∩ b, or of a without b, with the interior on the left of each edge. A common edge bounds a ∩ b if the
/// interiors of both are on its left, and a without b if only that of a is.
std::vector<ExactEdge> boundary(const ExactRings& a, const ExactRings& b, bool without) {
  const std::vector<ExactEdge> edges_a = cut_edges(a, b), edges_b = cut_edges(b, a);
  const std::set<ExactEdge> set_a(edges_a.begin(), edges_a.end()), set_b(edges_b.begin(), edges_b.end());
  std::vector<ExactEdge> out;
  keep_apart(edges_a, set_b, b, !without, false, out);
  keep_apart(edges_b, set_a, a, true, without, out);
  for (const ExactEdge& e : edges_a)
    if (set_b.contains(without ? ExactEdge{e.to, e.from} : e)) out.push_back(e);
  return out;
}

/// Returns, among the edges that start where `arriving` ends, the one that bounds the same piece: the first clockwise from the reverse
/// direction.
std::size_t going_on(const ExactEdge& arriving, const std::vector<std::size_t>& candidates, const std::vector<ExactEdge>& edges) {
  const Exact::Direction_2 back(Exact::Vector_2(arriving.to, arriving.from));
  const auto direction = [&](std::size_t i) { return Exact::Direction_2(Exact::Vector_2(edges[i].from, edges[i].to)); };
  std::size_t best = candidates.front();
  for (const std::size_t i : candidates)
    if (direction(i).counterclockwise_in_between(direction(best), back)) best = i;
  return best;
}

/// Returns the ring without corners on straight sides.
ExactRing without_straight_corners(const ExactRing& ring) {
  ExactRing out;
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!CGAL::collinear(ring[(i + n - 1) % n], ring[i], ring[next(i, n)])) out.push_back(ring[i]);
  return out;
}

/// Joins edges to rings; pieces that touch only at a corner become separate rings.
ExactRings joined(const std::vector<ExactEdge>& edges) {
  std::map<ExactPoint, std::vector<std::size_t>> from;
  for (std::size_t i = 0; i < edges.size(); ++i) from[edges[i].from].push_back(i);
  std::vector<bool> is_used(edges.size(), false);
  ExactRings out;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    ExactRing ring;
    for (std::size_t i = start; !is_used[i];) {
      is_used[i] = true;
      ring.push_back(edges[i].from);
      const auto candidates = from.find(edges[i].to);
      if (candidates == from.end()) throw PolygonError("the outlines of two polygons do not close: their rings cross or touch");
      i = going_on(edges[i], candidates->second, edges);
    }
    if (!ring.empty()) out.push_back(without_straight_corners(ring));
  }
  return out;
}

Exact::FT twice_area(const ExactRing& ring) {
  Exact::FT sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const ExactPoint &p = ring[i], &q = ring[next(i, ring.size())];
    sum += p.x() * q.y() - q.x() * p.y();
  }
  return sum;
}

/// Returns the nearest double. Without exact(), to_double() may return the middle of an interval as wide as 1e-5, as occurs for
/// intersections of nearly parallel edges.
double rounded(const Exact::FT& x) { return CGAL::to_double(x.exact()); }

Ring rounded(const ExactRing& ring) {
  Ring out;
  for (const ExactPoint& p : ring) out.emplace_back(rounded(p.x()), rounded(p.y()));
  return out;
}

/// Returns the index of the smallest outer ring that contains a hole. The hole may touch the ring only at corners.
std::size_t ring_around(const ExactRing& hole, const ExactRings& outer, const std::vector<Exact::FT>& areas) {
  const ExactPoint p = CGAL::midpoint(hole[0], hole[1]);
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < outer.size(); ++i)
    if (is_within(p, {outer[i]}) && (!best || areas[i] < areas[*best])) best = i;
  if (!best) throw PolygonError("a hole of two polygons' overlap lies in none of its pieces: their rings cross or touch");
  return *best;
}

Region rounded(const ExactRings& rings) {
  ExactRings outer, holes;
  std::vector<Exact::FT> areas;
  for (const ExactRing& ring : rings) {
    const Exact::FT area = twice_area(ring);
    (area > 0 ? outer : holes).push_back(ring);
    if (area > 0) areas.push_back(area);
  }
  Region out;
  for (const ExactRing& ring : outer) out.push_back({rounded(ring), {}});
  for (const ExactRing& hole : holes) out[ring_around(hole, outer, areas)].holes.push_back(rounded(hole));
  return out;
}

} // namespace

std::optional<std::array<std::size_t, 4>> find_clash(const std::vector<Ring>& rings) {
  for (std::size_t a = 0; a < rings.size(); ++a) {
    if (const auto clash = clash_within(rings[a], a)) return clash;
    for (std::size_t b = a + 1; b < rings.size(); ++b)
      for (std::size_t i = 0; i < rings[a].size(); ++i)
        for (std::size_t j = 0; j < rings[b].size(); ++j)
          if (edges_meet(rings[a], i, rings[b], j)) return std::array{a, b, i, j};
  }
  return std::nullopt;
}

bool is_inside(const Vec2& p, const Ring& ring) {
  std::vector<Point> points;
  for (const Vec2& v : ring) points.push_back(point(v));
  return CGAL::bounded_side_2(points.begin(), points.end(), point(p), Predicates()) == CGAL::ON_BOUNDED_SIDE;
}

Region exact_intersection(const Polygon& a, const Polygon& b, const Pose& b_in_a) {
  try {
    return rounded(joined(boundary(exact_rings(a, {}), exact_rings(b, b_in_a), false)));
  } catch (const CGAL::Failure_exception& e) {
    throw PolygonError(std::string("the overlap of two polygons could not be found: ") + e.what());
  }
}

Region exact_difference(const Polygon& a, const Ring& hole) {
  try {
    Ring taken = hole;
    if (signed_area(taken) < 0) std::reverse(taken.begin(), taken.end());
    return rounded(joined(boundary(exact_rings(a, {}), {exact_ring(taken, {})}, true)));
  } catch (const CGAL::Failure_exception& e) {
    throw PolygonError(std::string("a hole could not be taken out of a polygon: ") + e.what());
  }
}

} // namespace steplap

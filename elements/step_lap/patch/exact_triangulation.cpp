#include "elements/step_lap/patch/exact_triangulation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

namespace steplap {

namespace {

using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel; // double coordinates, exact decisions
using Point = Predicates::Point_2;

/// A directed edge; the area still to be triangulated is on its left.
struct Edge {
  std::size_t from = 0, to = 0;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// Adds triangles on the left of an edge of the remaining area. The third corner is the visible vertex from which the edge appears under
/// the largest angle. No other visible vertex is then inside the circle through the three corners, which makes it a constrained Delaunay
/// triangulation (Chew 1989). Angles are compared in doubles; whether the triangle is inside the remaining area and contains no vertex is
/// decided exactly. The edges of removed triangles bound the remaining area.
class Cutter {
public:
  explicit Cutter(const Polygon& polygon) {
    add_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) add_ring(hole);
  }

  [[nodiscard]] std::vector<std::array<std::size_t, 3>> triangles() {
    std::vector<std::array<std::size_t, 3>> out;
    while (!front_.empty()) {
      const Edge edge = front_.begin()->first;
      const std::optional<std::size_t> corner = third_corner(edge);
      if (!corner) throw PolygonError("a polygon could not be cut into triangles: its rings cross or touch");
      out.push_back({edge.from, edge.to, *corner});
      front_.erase(edge);
      lay({edge.to, *corner});
      lay({*corner, edge.from});
    }
    return out;
  }

private:
  struct Extent {
    double low_x, high_x, low_y, high_y;
    [[nodiscard]] bool apart(const Extent& o) const { return high_x < o.low_x || o.high_x < low_x || high_y < o.low_y || o.high_y < low_y; }
  };

  void add_ring(const Ring& ring) {
    const std::size_t first = points_.size();
    for (const Vec2& p : ring) points_.emplace_back(p.x(), p.y());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Edge edge{first + i, first + (i + 1) % ring.size()};
      front_.emplace(edge, extent(edge));
    }
  }

  [[nodiscard]] Extent extent(const Edge& e) const {
    const Point &a = points_[e.from], &b = points_[e.to];
    return {std::min(a.x(), b.x()), std::max(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.y(), b.y())};
  }

  /// Updates the boundary for a side of the last triangle: an edge of the remaining area is removed; otherwise the remaining area is now on
  /// the other side.
  void lay(const Edge& side) {
    const Edge other_hand{side.to, side.from};
    if (front_.erase(side) == 0) front_.emplace(other_hand, extent(side));
  }

  [[nodiscard]] std::optional<std::size_t> third_corner(const Edge& edge) const {
    std::vector<bool> is_hidden(points_.size(), false);
    for (;;) {
      std::optional<std::size_t> best;
      double narrowest = 0;
      for (std::size_t v = 0; v < points_.size(); ++v) {
        if (is_hidden[v] || !is_left(edge, v)) continue;
        const double narrowness = cotangent(edge, v);
        if (best && narrowness >= narrowest) continue;
        best = v;
        narrowest = narrowness;
      }
      if (!best || (is_free({edge.to, *best}) && is_free({*best, edge.from}) && is_empty(edge, *best))) return best;
      is_hidden[*best] = true;
    }
  }

  [[nodiscard]] bool is_left(const Edge& e, std::size_t v) const {
    return CGAL::orientation(points_[e.from], points_[e.to], points_[v]) == CGAL::LEFT_TURN;
  }

  /// Returns the cotangent of the angle under which the edge appears from a vertex on its left.
  [[nodiscard]] double cotangent(const Edge& e, std::size_t v) const {
    const Point &a = points_[e.from], &b = points_[e.to], &c = points_[v];
    const double dot = (a.x() - c.x()) * (b.x() - c.x()) + (a.y() - c.y()) * (b.y() - c.y());
    const double area = (a.x() - c.x()) * (b.y() - c.y()) - (a.y() - c.y()) * (b.x() - c.x());
    return area > 0.0 ? dot / area : dot < 0.0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool is_empty(const Edge& e, std::size_t corner) const {
    const Edge second{e.to, corner}, third{corner, e.from};
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (v != corner && is_left(e, v) && is_left(second, v) && is_left(third, v)) return false;
    return true;
  }

  /// Returns true if the open side meets no boundary: no edge crosses it, no vertex is on it. The side may itself be an edge.
  [[nodiscard]] bool is_free(const Edge& side) const {
    if (front_.contains(side)) return true;
    const Extent box = extent(side);
    const Predicates::Segment_2 segment(points_[side.from], points_[side.to]);
    for (const auto& [edge, its_box] : front_) {
      if (box.apart(its_box)) continue;
      const bool from_is_shared = edge.from == side.from || edge.from == side.to, to_is_shared = edge.to == side.from || edge.to == side.to;
      if (from_is_shared && to_is_shared) return false; // an edge with the same ends: the remaining area is on the other side
      if (from_is_shared || to_is_shared) {
        if (runs_along(side, from_is_shared ? edge.from : edge.to, from_is_shared ? edge.to : edge.from)) return false;
      } else if (CGAL::do_intersect(segment, Predicates::Segment_2(points_[edge.from], points_[edge.to]))) {
        return false;
      }
    }
    return true;
  }

  /// Returns true if the edge from an end of the side to `other` is collinear with the side and in the same direction.
  [[nodiscard]] bool runs_along(const Edge& side, std::size_t shared, std::size_t other) const {
    const Point &a = points_[shared], &b = points_[shared == side.from ? side.to : side.from], &c = points_[other];
    return CGAL::orientation(a, b, c) == CGAL::COLLINEAR && !CGAL::collinear_are_strictly_ordered_along_line(b, a, c);
  }

  std::vector<Point> points_;
  std::map<Edge, Extent> front_; ///< edges of the remaining area
};

} // namespace

std::vector<std::array<std::size_t, 3>> triangulated(const Polygon& polygon) { return Cutter(polygon).triangles(); }

} // namespace steplap

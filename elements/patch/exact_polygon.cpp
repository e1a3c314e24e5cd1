#include "elements/patch/exact_polygon.h"

#include "mbd/math/portable_math.h"

#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Polygon_with_holes_2.h>

#include <cmath>
#include <map>
#include <string>

namespace steplap {

namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPolygon = CGAL::Polygon_with_holes_2<Exact>;
using ExactRing = CGAL::Polygon_2<Exact>;
using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel; // doubles, exact decisions
using Point = Predicates::Point_2;

Point point(const Vec2& p) {
  return {p.x(), p.y()};
}

std::size_t next(std::size_t i, std::size_t n) {
  return i + 1 == n ? 0 : i + 1;
}

struct Box {
  Vec2 low, high;
  [[nodiscard]] bool apart(const Box& o) const {
    return (high.array() < o.low.array()).any() || (o.high.array() < low.array()).any();
  }
};

Box edge_box(const Ring& r, std::size_t i) {
  const Vec2 &a = r[i], &b = r[next(i, r.size())];
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

bool edges_meet(const Ring& r, std::size_t i, const Ring& q, std::size_t j) {
  return !edge_box(r, i).apart(edge_box(q, j)) &&
         CGAL::do_intersect(Predicates::Segment_2(point(r[i]), point(r[next(i, r.size())])),
                            Predicates::Segment_2(point(q[j]), point(q[next(j, q.size())])));
}

/// Consecutive edges a-b, b-c: they meet beyond b only when the second runs back over the first.
bool folds_back(const Ring& r, std::size_t i) {
  const std::size_t j = next(i, r.size());
  const Vec2 &a = r[i], &b = r[j], &c = r[next(j, r.size())];
  return CGAL::orientation(point(a), point(b), point(c)) == CGAL::COLLINEAR &&
         (b - a).dot(c - b) <= 0;
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

ExactRing exact_ring(const Ring& ring, const Pose& pose) {
  // The affine map itself is exact: a simple ring stays simple whatever sine and cosine round to.
  const portable::SinCos turn = portable::sin_cos(pose.theta);
  const Exact::FT c(turn.cos), s(turn.sin), x(pose.x), y(pose.y);
  const bool moved = pose.theta != 0;
  ExactRing out;
  for (const Vec2& p : ring) {
    const Exact::FT px(p.x()), py(p.y());
    out.push_back(moved ? Exact::Point_2(c * px - s * py + x, s * px + c * py + y)
                        : Exact::Point_2(px + x, py + y));
  }
  return out;
}

ExactPolygon exact_polygon(const Polygon& polygon, const Pose& pose) {
  ExactPolygon out(exact_ring(polygon.outer, pose));
  for (const Ring& hole : polygon.holes)
    out.add_hole(exact_ring(hole, pose));
  return out;
}

/// To a double's own rounding. to_double() of the number as it stands settles for the middle of an interval that may
/// be 1e-5 wide, as it is where nearly parallel edges cross.
double rounded(const Exact::FT& x) { return CGAL::to_double(x.exact()); }

Ring rounded(const ExactRing& ring) {
  Ring out;
  for (auto v = ring.vertices_begin(); v != ring.vertices_end(); ++v)
    out.emplace_back(rounded(v->x()), rounded(v->y()));
  return out;
}

Region rounded(const std::vector<ExactPolygon>& pieces) {
  Region out;
  for (const ExactPolygon& piece : pieces) {
    Polygon polygon{rounded(piece.outer_boundary()), {}};
    for (auto hole = piece.holes_begin(); hole != piece.holes_end(); ++hole) polygon.holes.push_back(rounded(*hole));
    out.push_back(std::move(polygon));
  }
  return out;
}

/// Marks for each finite triangle whether it is inside: crossing an edge of a ring changes it.
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Predicates, CGAL::Default, CGAL::No_constraint_intersection_requiring_constructions_tag>;

std::vector<Triangulation::Face_handle> faces_inside(const Triangulation& mesh) {
  std::map<Triangulation::Face_handle, int> depth{{mesh.infinite_face(), 0}};
  std::vector<Triangulation::Face_handle> stack{mesh.infinite_face()}, inside;
  while (!stack.empty()) {
    const auto face = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto neighbour = face->neighbor(i);
      const int there = depth[face] + (mesh.is_constrained({face, i}) ? 1 : 0);
      if (!depth.emplace(neighbour, there).second) continue;
      stack.push_back(neighbour);
      if (there % 2 == 1) inside.push_back(neighbour);
    }
  }
  return inside;
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
  for (const Vec2& v : ring)
    points.push_back(point(v));
  return CGAL::bounded_side_2(points.begin(), points.end(), point(p), Predicates()) ==
         CGAL::ON_BOUNDED_SIDE;
}

Region exact_intersection(const Polygon& a, const Polygon& b, const Pose& b_in_a) {
  try {
    std::vector<ExactPolygon> pieces;
    CGAL::intersection(exact_polygon(a, {}), exact_polygon(b, b_in_a), std::back_inserter(pieces));
    return rounded(pieces);
  } catch (const std::exception& e) {
    throw PolygonError(std::string("the overlap of two polygons could not be found: ") + e.what());
  }
}

Region exact_difference(const Polygon& a, const Ring& hole) {
  try {
    ExactRing taken = exact_ring(hole, {});
    if (taken.is_clockwise_oriented()) taken.reverse_orientation();
    std::vector<ExactPolygon> pieces;
    CGAL::difference(exact_polygon(a, {}), taken, std::back_inserter(pieces));
    return rounded(pieces);
  } catch (const std::exception& e) {
    throw PolygonError(std::string("a hole could not be taken out of a polygon: ") + e.what());
  }
}

std::vector<std::array<std::size_t, 3>> triangulated(const Polygon& polygon) {
  std::vector<std::array<std::size_t, 3>> out;
  try {
    Triangulation mesh;
    std::map<Triangulation::Vertex_handle, std::size_t> number;
    const auto insert = [&](const Ring& ring) {
      std::vector<Triangulation::Vertex_handle> vertices;
      for (const Vec2& p : ring) {
        vertices.push_back(mesh.insert(point(p)));
        number.emplace(vertices.back(), number.size());
      }
      for (std::size_t i = 0; i < ring.size(); ++i)
        mesh.insert_constraint(vertices[i], vertices[next(i, ring.size())]);
    };
    insert(polygon.outer);
    for (const Ring& hole : polygon.holes)
      insert(hole);
    for (const auto& face : faces_inside(mesh)) {
      out.push_back({number.at(face->vertex(0)), number.at(face->vertex(1)), number.at(face->vertex(2))});
    }
  } catch (const std::exception& e) {
    throw PolygonError(std::string("a polygon could not be cut into triangles: ") + e.what());
  }
  return out;
}

} // namespace steplap

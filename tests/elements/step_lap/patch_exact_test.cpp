// Overlaps and differences found exactly, and triangulations, where nothing is in general position: polygons whose corners lie on a
// coarse grid, so that edges run along each other, corners lie on edges and pieces touch at corners.
#include "elements/step_lap/patch/exact_triangulation.h"
#include "patch_cases.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <set>

using namespace steplap;
using namespace steplap::patch_cases;

namespace {

// Corners are small whole numbers, those of overlaps fractions of them: areas are sums of a few dozen products below 100.
constexpr double k_area = 1e-12;

Vec2 grid_point(Draw& draw, int grid) {
  const double x = draw.index(grid); // one after the other: the order of arguments is the compiler's choice
  return {x, double(draw.index(grid))};
}

/// A simple polygon with corners on a grid, at times with holes; tried until one has no crossings.
Polygon grid_polygon(Draw& draw, int grid) {
  for (;;) {
    try {
      Polygon polygon;
      const int corners = 3 + draw.index(6);
      for (int i = 0; i < corners; ++i) polygon.outer.push_back(grid_point(draw, grid));
      polygon = repaired(polygon);
      for (int holes = draw.index(3); holes > 0; --holes) {
        Polygon more = polygon;
        const Vec2 corner = grid_point(draw, grid) + Vec2(0.25, 0.25);
        more.holes.push_back({corner, corner + Vec2(0.5, 0), corner + Vec2(0.25, 0.5)});
        try {
          polygon = repaired(more);
        } catch (const PolygonError&) {} // outside, or across an edge
      }
      return polygon;
    } catch (const PolygonError&) {}
  }
}

Ring corners_of(const Polygon& polygon) {
  Ring out = polygon.outer;
  for (const Ring& hole : polygon.holes) out.insert(out.end(), hole.begin(), hole.end());
  return out;
}

std::vector<Ring> triangle_rings(const Polygon& polygon) {
  const Ring corners = corners_of(polygon);
  std::vector<Ring> out;
  for (const auto& t : triangulated(polygon)) out.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  return out;
}

/// Of two triangles, by clipping one with the sides of the other, in doubles.
double common_area(Ring ring, const Ring& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 p = other[i], along = other[(i + 1) % 3] - p;
    Ring kept;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
      const double da = cross(along, a - p), db = cross(along, b - p);
      if (da >= 0) kept.push_back(a);
      if ((da < 0) != (db < 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    ring = kept;
  }
  return signed_area(ring);
}

double common_area(const std::vector<Ring>& a, const std::vector<Ring>& b) {
  double sum = 0;
  for (const Ring& one : a)
    for (const Ring& two : b) sum += common_area(one, two);
  return sum;
}

} // namespace

TEST_CASE("exact overlap: as much as triangles have in common, in whichever order it is asked for") {
  Draw draw(31);
  double most_pieces = 0, holes = 0;
  for (int i = 0; i < cases(1500); ++i) {
    const int grid = 3 + draw.index(6);
    const Polygon a = grid_polygon(draw, grid), b = grid_polygon(draw, grid);
    const Vec2 shift = grid_point(draw, 3) - Vec2(1, 1);
    Polygon shifted = b;
    for (Vec2& p : shifted.outer) p += shift;
    for (Ring& hole : shifted.holes)
      for (Vec2& p : hole) p += shift;
    const Region both = exact_intersection(a, b, {shift.x(), shift.y(), 0}),
                 other_way = exact_intersection(b, a, {-shift.x(), -shift.y(), 0});
    CHECK(std::abs(area(both) - common_area(triangle_rings(a), triangle_rings(shifted))) < k_area);
    CHECK(std::abs(area(both) - area(other_way)) < k_area);
    CHECK(both.size() == other_way.size());
    for (const Polygon& piece : both) {
      CHECK(area(piece) > 0);
      holes += double(piece.holes.size());
    }
    most_pieces = std::max(most_pieces, double(both.size()));
  }
  CHECK(most_pieces >= 3); // else the cases are too easy
  CHECK(holes > 0);
}

TEST_CASE("exact difference: with what is taken away it makes up the whole") {
  Draw draw(32);
  for (int i = 0; i < cases(1500); ++i) {
    const int grid = 3 + draw.index(6);
    const Polygon a = grid_polygon(draw, grid);
    Polygon b = grid_polygon(draw, grid);
    b.holes.clear();
    Ring turned = b.outer; // either sense is asked for
    std::reverse(turned.begin(), turned.end());
    const double left = area(exact_difference(a, b.outer));
    CHECK(std::abs(left + area(exact_intersection(a, b, {})) - area(a)) < k_area);
    CHECK(left == area(exact_difference(a, turned)));
  }
  const Polygon square{{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {}};
  CHECK(exact_difference(square, square.outer).empty());
  const Region ring = exact_difference(square, {{0.5, 0.5}, {1.5, 0.5}, {1.5, 1.5}, {0.5, 1.5}});
  REQUIRE(ring.size() == 1);
  CHECK(ring[0].holes.size() == 1);
  CHECK(exact_difference(square, {{1, -1}, {1.5, -1}, {1.5, 3}, {1, 3}}).size() == 2); // cut in two
  const Region corners = exact_difference(square, {{1, 0}, {2, 1}, {1, 2}, {0, 1}});   // four, that touch where edges are halved
  CHECK(corners.size() == 4);
}

TEST_CASE("triangles make up their polygon, and no corner lies in the circle of one from which it is seen") {
  Draw draw(33);
  for (int i = 0; i < cases(1500); ++i) {
    const bool on_grid = draw.coin();
    const Polygon polygon = on_grid ? grid_polygon(draw, 3 + draw.index(6)) : make_outline(concave_polygon(draw)).polygon;
    const Ring corners = corners_of(polygon);
    const auto triangles = triangulated(polygon);
    // Euler: as many as corners, two less for the outer ring and two more for every hole.
    CHECK(triangles.size() == corners.size() - 2 + 2 * polygon.holes.size());
    double sum = 0;
    std::set<std::array<std::size_t, 2>> sides;
    for (const auto& t : triangles) {
      const double its = signed_area({corners[t[0]], corners[t[1]], corners[t[2]]});
      CHECK(its > 0);
      sum += its;
      for (std::size_t k = 0; k < 3; ++k) CHECK(sides.insert({t[k], t[(k + 1) % 3]}).second); // no two on one hand of a side
    }
    CHECK(std::abs(sum - area(polygon)) < k_area);
    // Delaunay's condition for neighbours is enough for the whole: opposite corners of two triangles that share a cut.
    for (const auto& t : triangles)
      for (const auto& u : triangles)
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t m = 0; m < 3; ++m) {
            if (t[k] != u[(m + 1) % 3] || t[(k + 1) % 3] != u[m]) continue;
            const Vec2 a = corners[t[k]], b = corners[t[(k + 1) % 3]], c = corners[t[(k + 2) % 3]], d = corners[u[(m + 2) % 3]];
            // The angles at c and d are together at most 180°: the sine of their sum is not negative. To rounding of four products.
            const double at_c = cross(a - c, b - c), dot_c = (a - c).dot(b - c), at_d = cross(b - d, a - d), dot_d = (b - d).dot(a - d);
            CHECK(at_c * dot_d + at_d * dot_c >= -1e-12 * (a - c).norm() * (b - c).norm() * (a - d).norm() * (b - d).norm());
          }
  }
}

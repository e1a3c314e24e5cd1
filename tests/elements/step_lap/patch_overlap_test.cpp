// Overlap of sheets: both paths against an independent area, degenerate and untidy input.
#include "patch_cases.h"

#include <doctest/doctest.h>

#include <string>

using namespace steplap;
using namespace steplap::patch_cases;

namespace {

// Area errors relative to the size squared: 1e-12 is asked for; both paths and the independent
// area are sums of products of a few dozen coordinates with a rounding of 1e-16 each.
constexpr double k_area = 1e-12;

Polygon box(double x0, double y0, double x1, double y1) { return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}; }

Polygon moved(Polygon polygon, const Pose& pose) {
  for (Vec2& p : polygon.outer) p = placed(p, pose);
  for (Ring& hole : polygon.holes)
    for (Vec2& p : hole) p = placed(p, pose);
  return polygon;
}

template <class Visit> void each_edge(const Polygon& polygon, Visit visit) {
  const auto round = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  };
  round(polygon.outer);
  for (const Ring& hole : polygon.holes) round(hole);
}

int winding(const Polygon& polygon, const Vec2& p) {
  int turns = 0;
  each_edge(polygon, [&](const Vec2& a, const Vec2& b) {
    const double side = cross(b - a, p - a);
    if (a.y() <= p.y() && b.y() > p.y() && side > 0) ++turns;
    if (a.y() > p.y() && b.y() <= p.y() && side < 0) --turns;
  });
  return turns;
}

/// Twice the area swept from the origin by those parts of p's edges that lie inside q: by Green's
/// theorem the overlap is bounded by p's edges inside q and q's edges inside p.
double swept_inside(const Polygon& p, const Polygon& q) {
  double sum = 0;
  each_edge(p, [&](const Vec2& a, const Vec2& b) {
    std::vector<double> cuts{0, 1};
    each_edge(q, [&](const Vec2& c, const Vec2& d) {
      const double at = cross(c - a, d - c) / cross(b - a, d - c);
      const double other = cross(c - a, b - a) / cross(b - a, d - c);
      if (at > 0 && at < 1 && other >= 0 && other <= 1) cuts.push_back(at);
    });
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
      if (winding(q, a + 0.5 * (cuts[i] + cuts[i + 1]) * (b - a)) != 0) sum += (cuts[i + 1] - cuts[i]) * cross(a, b);
  });
  return sum;
}

double independent_area(const Polygon& a, const Polygon& b) { return 0.5 * (swept_inside(a, b) + swept_inside(b, a)); }

double overlap_area(const Polygon& a, const Polygon& b, const Pose& pose = {}) {
  OverlapWorkspace workspace;
  Region out;
  intersect(make_outline(a), make_outline(b), pose, workspace, out);
  return area(out);
}

/// Repeats and splits edges at random: the same area, told in more vertices.
Ring untidy(Draw& draw, const Ring& ring) {
  Ring out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    out.push_back(a);
    if (draw.coin()) out.push_back(a);
    if (draw.coin()) out.push_back(a + draw.unit() * (b - a));
    if (draw.unit() < 0.2) out.push_back(b + 1e-16 * draw.point(1));
  }
  if (draw.coin()) std::reverse(out.begin(), out.end());
  return out;
}

std::string refusal(const Polygon& polygon) {
  try {
    (void)repaired(polygon);
  } catch (const PolygonError& e) {
    return e.what();
  }
  return "accepted";
}

} // namespace

TEST_CASE("overlap: convex pairs against an independent area") {
  Draw draw(21);
  OverlapWorkspace workspace;
  Region out;
  int empty = 0;
  for (int i = 0; i < cases(90000); ++i) {
    const Outline a = make_outline(convex_polygon(draw)), b = make_outline(convex_polygon(draw));
    REQUIRE(a.convex);
    const Pose at = pose(draw, 1.5);
    intersect(a, b, at, workspace, out);
    const double expected = independent_area(a.polygon, moved(b.polygon, at));
    CHECK(std::abs(area(out) - expected) < k_area);
    CHECK(out.size() <= 1);
    CHECK((penetration(a, b, at, workspace) > 0) == !out.empty());
    empty += out.empty();
  }
  CHECK(empty > cases(5000)); // both kinds occur
  CHECK(empty < cases(80000));
}

TEST_CASE("overlap: concave pairs with holes against an independent area") {
  Draw draw(22);
  OverlapWorkspace workspace;
  Region out;
  std::size_t most_pieces = 0;
  for (int i = 0; i < cases(10000); ++i) {
    const Outline a = make_outline(concave_polygon(draw)), b = make_outline(concave_polygon(draw));
    const Pose at = pose(draw, 1.5);
    intersect(a, b, at, workspace, out);
    CHECK(std::abs(area(out) - independent_area(a.polygon, moved(b.polygon, at))) < k_area);
    CHECK((penetration(a, b, at, workspace) > 0) == !out.empty());
    most_pieces = std::max(most_pieces, out.size());
  }
  CHECK(most_pieces >= 2);
}

TEST_CASE("overlap: the fast path agrees with the exact one") {
  // Also where edges coincide: integer boxes at quarter turns and integer shifts.
  Draw draw(23);
  OverlapWorkspace workspace;
  Region fast;
  for (int i = 0; i < cases(4000); ++i) {
    const bool snapped = draw.coin();
    const Outline a = make_outline(snapped ? box(0, 0, 1 + draw.index(3), 1 + draw.index(3)) : convex_polygon(draw));
    const Outline b = make_outline(snapped ? box(0, 0, 1 + draw.index(3), 1 + draw.index(3)) : convex_polygon(draw));
    Pose at = pose(draw, 1.5);
    if (snapped) at = {double(draw.index(7) - 3), double(draw.index(7) - 3), 0.5 * std::numbers::pi * draw.index(4)};
    intersect(a, b, at, workspace, fast);
    const Region exact = exact_intersection(a.polygon, b.polygon, at);
    CHECK(std::abs(area(fast) - area(exact)) < 20 * k_area); // coordinates up to 4.5
    if (area(exact) > 1e-9)                                  // a thin one's centroid is only as good as its width
      CHECK((centroid(fast) - centroid(exact)).norm() < 1e-4);
  }
}

TEST_CASE("overlap: the parts of an outline make it up") {
  Draw draw(24);
  for (int i = 0; i < cases(2000); ++i) {
    const Outline a = make_outline(concave_polygon(draw));
    double sum = 0;
    for (const ConvexPart& p : a.cut.parts) {
      const Ring part(a.cut.corners.begin() + long(p.first), a.cut.corners.begin() + long(p.first + p.count));
      CHECK(is_convex(part));
      CHECK(signed_area(part) > 0);
      sum += signed_area(part);
    }
    CHECK(std::abs(sum - area(a.polygon)) < k_area);
  }
}

TEST_CASE("overlap: touching is not overlapping") {
  const Polygon unit = box(0, 0, 1, 1);
  const Polygon ell{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {}};
  CHECK(overlap_area(unit, unit, {1, 0, 0}) == 0); // an edge
  CHECK(overlap_area(unit, unit, {1, 1, 0}) == 0); // a vertex
  CHECK(overlap_area(unit, unit, {5, 0, 0}) == 0); // apart
  CHECK(overlap_area(ell, unit, {1, 1, 0}) == 0);  // fills the notch of an L
  CHECK(overlap_area(ell, unit, {2, 2, 0}) == 0);
  CHECK(overlap_area(unit, unit) == 1);
  CHECK(overlap_area(ell, ell) == 3);
  CHECK(overlap_area(box(0, 0, 4, 4), unit, {2, 2, 0}) == 1); // inside
  const Polygon frame{{{0, 0}, {3, 0}, {3, 3}, {0, 3}}, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
  CHECK(overlap_area(frame, unit, {1, 1, 0}) == 0); // in the hole, edge to edge
  CHECK(overlap_area(frame, unit, {0.5, 0.5, 0}) == 0.75);
  CHECK(overlap_area(frame, frame) == 8);
}

TEST_CASE("overlap: slivers down to rounding, and pieces") {
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12}) {
    // the edge at 1 − width is itself rounded by 1.1e-16
    CHECK(std::abs(overlap_area(box(0, 0, 1, 1), box(0, 0, 1, 1), {1 - width, 0, 0}) - width) < 2.3e-16);
    const Polygon notched{{{0, 0}, {1, 0}, {1, 1}, {0.5, 0.5}, {0, 1}}, {}};
    CHECK(std::abs(overlap_area(notched, box(0, 0, 1, 1), {1 - width, 0, 0}) - (width - 0.5 * width * width)) < 2.3e-16);
  }
  CHECK(overlap_area(box(0, 0, 1, 1), box(0, 0, 1, 1), {1 - 1e-16, 0, 0}) == 0);

  const Polygon comb{{{0, 0}, {5, 0}, {5, 2}, {4, 2}, {4, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {}};
  OverlapWorkspace workspace;
  Region out;
  intersect(make_outline(comb), make_outline(box(-1, 1.25, 6, 1.75)), {}, workspace, out);
  CHECK(out.size() == 3);
  CHECK(area(out) == 1.5);
}

TEST_CASE("overlap: the way apart crosses zero transversally where the area does not") {
  // Corner to corner along the diagonal: area (√2 e)²/2·…, quadratic; penetration linear.
  const Outline unit = make_outline(box(0, 0, 1, 1));
  OverlapWorkspace workspace;
  for (const double e : {1e-3, 1e-5, -1e-5, -1e-3}) {
    CHECK(std::abs(penetration(unit, unit, {1 - e, 1 - e, 0}, workspace) - e) < 2.3e-16);
    CHECK(std::abs(overlap_area(unit.polygon, unit.polygon, {1 - e, 1 - e, 0}) - (e > 0 ? e * e : 0)) < 1e-15);
  }
  const Outline ell = make_outline({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {}});
  CHECK(penetration(ell, unit, {1.25, 1.25, 0}, workspace) == doctest::Approx(-0.25));
  CHECK(penetration(ell, unit, {0.75, 1.25, 0}, workspace) > 0);
}

TEST_CASE("overlap: repeated and collinear vertices and reversed rings are repaired") {
  Draw draw(25);
  for (int i = 0; i < cases(20000); ++i) {
    const Polygon clean = draw.coin() ? convex_polygon(draw) : concave_polygon(draw);
    Polygon dirty{untidy(draw, clean.outer), {}};
    for (const Ring& hole : clean.holes) dirty.holes.push_back(untidy(draw, hole));
    const Polygon tidy = repaired(dirty);
    CHECK(tidy.outer.size() <= clean.outer.size());
    CHECK(std::abs(area(tidy) - area(clean)) < k_area);
    CHECK(signed_area(tidy.outer) > 0);
    for (const Ring& hole : tidy.holes) CHECK(signed_area(hole) < 0);
    if (i % 20 == 0) {
      const Outline other = make_outline(concave_polygon(draw));
      const Pose at = pose(draw, 1);
      CHECK(std::abs(overlap_area(dirty, other.polygon, at) - independent_area(clean, moved(other.polygon, at))) < k_area);
    }
  }
  // a spike carries no area and is dropped
  CHECK(repaired({{{0, 0}, {1, 0}, {2, 0}, {1, 0}, {1, 1}, {0, 1}}, {}}).outer.size() == 4);
}

TEST_CASE("overlap: what cannot be repaired is named") {
  const Ring square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const auto contains = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  contains(refusal({{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}}), "outer ring: the edge from vertex");
  contains(refusal({{{0, 0}, {1, 1}, {2, 2}}, {}}), "outer ring: has no area");
  contains(refusal({{}, {}}), "has no area");
  contains(refusal({{{0, 0}, {1, 0}, {NAN, 1}}, {}}), "vertex 2 is not a finite number");
  contains(refusal({square, {{{5, 5}, {5, 6}, {6, 5}}}}), "hole 0: lies outside");
  contains(refusal({square, {{{3, 3}, {3, 5}, {5, 3}}}}), "meets hole 0's");
  contains(refusal({square, {{{1, 1}, {1, 3}, {3, 1}}, {{1.25, 1.25}, {1.25, 1.5}, {1.5, 1.25}}}}), "hole 1: lies inside hole 0");
  // touching itself in a vertex
  contains(refusal({{{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 1}}, {}}), "meets");
  CHECK(is_convex(square));
  Ring pentagram;
  for (int i = 0; i < 5; ++i) pentagram.emplace_back(std::cos(i * 0.8 * std::numbers::pi), std::sin(i * 0.8 * std::numbers::pi));
  CHECK(!is_convex(pentagram));
  contains(refusal({pentagram, {}}), "must not cross");
}

TEST_CASE("overlap: no depth is less than the bound from another pose") {
  Draw draw(71);
  OverlapWorkspace workspace;
  for (int i = 0; i < cases(4000); ++i) {
    const auto sheet = [&] { return make_outline(draw.coin() ? convex_polygon(draw) : concave_polygon(draw)); };
    const Outline a = sheet(), b = sheet();
    const Pose from = pose(draw, 1);
    const double size = draw.scale(1e-6, 1);
    const Pose to{from.x + size * draw.within(-1, 1), from.y + size * draw.within(-1, 1), from.theta + size * draw.within(-1, 1)};
    const DepthBound bound = depth_bound(a, b, from, workspace);
    const double depth = penetration(a, b, to, workspace);
    CHECK(bound.at_least(from) == bound.depth);
    CHECK(depth >= bound.at_least(to) - 1e-14); // roundings of coordinates of a few metres
  }
  // It says all that there is to say where a square leaves another one straight: 0.3 deep, then 0.2. Some roundings of numbers of order 1.
  const Outline unit = make_outline({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}});
  const DepthBound bound = depth_bound(unit, unit, {0.7, 0, 0}, workspace);
  CHECK(std::abs(penetration(unit, unit, {0.8, 0, 0}, workspace) - 0.2) < 1e-15);
  CHECK(std::abs(bound.at_least({0.8, 0, 0}) - 0.2) < 1e-15);
}

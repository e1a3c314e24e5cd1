// Overlaps of sheets that are not convex, of sheets with holes and of sheets with many corners: cut into
// convex parts, against CGAL's set operations on the whole polygons.
#include "patch_cases.h"

#include <doctest/doctest.h>

#include <array>

using namespace steplap;
using namespace steplap::patch_cases;

namespace {

// Shapes are of size 3 to 10 (half of that: 5), coordinates with their rounding are good to 2e-16 of that, a crossing
// at an angle of some degrees to ten times that; areas have sides of up to 10: 5e-14. Both ways are that good.
constexpr double k_area = 1e-13;
// A second moment has the square of the distance, up to 25, on top.
constexpr double k_moment = 25 * k_area;

Polygon box(double x0, double y0, double x1, double y1) { return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}; }

Polygon ell() { return {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, {}}; }
Polygon u_shape() { return {{{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, {}}; }
Polygon comb(int teeth) {
  Polygon polygon{{{0, 0}, {2.0 * teeth - 1, 0}}, {}};
  for (int i = teeth - 1; i >= 0; --i) {
    const double x = 2.0 * i;
    for (const Vec2& p : {Vec2(x + 1, 3), Vec2(x, 3), Vec2(x, 1), Vec2(x - 1, 1)})
      if (i > 0 || p.y() > 1) polygon.outer.push_back(p);
  }
  return polygon;
}
Polygon star_shape(int tips) {
  Polygon polygon;
  for (int i = 0; i < 2 * tips; ++i) {
    const double a = std::numbers::pi * i / tips, r = i % 2 == 0 ? 3.0 : 1.75;
    polygon.outer.emplace_back(r * std::cos(a), r * std::sin(a));
  }
  return polygon;
}
Polygon round_shape(int corners, double radius = 3) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i)
    polygon.outer.push_back(radius * Vec2(std::cos(2 * std::numbers::pi * i / corners), std::sin(2 * std::numbers::pi * i / corners)));
  return polygon;
}
/// A window with four panes, and one with a round one.
Polygon window() {
  return {{{0, 0}, {5, 0}, {5, 5}, {0, 5}}, {box(1, 1, 2, 2).outer, box(3, 1, 4, 2).outer, box(1, 3, 2, 4).outer, box(3, 3, 4, 4).outer}};
}
Polygon ring_shape() { return {{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}}, {round_shape(24, 2).outer}}; }

std::vector<Polygon> shapes() {
  return {ell(), u_shape(), comb(5), star_shape(5), star_shape(20), window(), ring_shape(), box(0, 0, 3, 2)};
}

template <class Visit> void each_edge(const Region& region, Visit visit) {
  const auto round = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  };
  for (const Polygon& polygon : region) {
    round(polygon.outer);
    for (const Ring& hole : polygon.holes) round(hole);
  }
}

/// ∬ (x², xy, y²) dA about the origin.
Vec3 second_moments(const Region& region) {
  Vec3 sum = Vec3::Zero();
  each_edge(region, [&](const Vec2& a, const Vec2& b) {
    const Vec2 s = a + b;
    const double c = cross(a, b) / 24;
    sum += c * Vec3(s.x() * s.x() + a.x() * a.x() + b.x() * b.x(), s.x() * s.y() + a.x() * a.y() + b.x() * b.y(),
                    s.y() * s.y() + a.y() * a.y() + b.y() * b.y());
  });
  return sum;
}

struct Both {
  OverlapWorkspace workspace;
  Region fast, exact;
  void at(const Outline& a, const Outline& b, const Pose& pose) {
    intersect(a, b, pose, workspace, fast);
    intersect_exactly(a, b, pose, workspace, exact);
    CHECK(std::abs(area(fast) - area(exact)) < k_area);
    CHECK((second_moments(fast) - second_moments(exact)).lpNorm<Eigen::Infinity>() < k_moment);
  }
  /// Friction, for centres of rotation inside, outside and far away.
  void check_friction(Draw& draw) const {
    Patch p, q;
    p.add(fast, 1.0);
    q.add(exact, 1.0);
    // The closed form is good to 36e-16 R²/area of area·speed (docs/explanation/limit_surface.md), R up to 5: 1e-13 of speed for each
    // edge, a few dozen of them with errors of either sign; wrenches have an arm of up to 10.
    for (int i = 0; i < 4; ++i) {
      Vec3 nu = draw.twist();
      nu[2] = std::copysign(std::min(std::abs(nu[2]), 10.0), nu[2]);
      const double speed = nu.norm() * 10;
      const Dissipation f = evaluate_gradient(p, nu), e = evaluate_gradient(q, nu);
      CHECK(std::abs(f.h - e.h) < 1e-12 * speed);
      CHECK((f.gradient - e.gradient).norm() < 1e-11);
    }
  }
};

} // namespace

TEST_CASE("concave overlap: areas, moments and friction are those of exact set operations") {
  Draw draw(81);
  Both both;
  const std::vector<Polygon> all = shapes();
  std::vector<Outline> outlines;
  for (const Polygon& p : all) outlines.push_back(make_outline(p));
  int most = 0;
  for (int round = 0; round < cases(8); ++round)
    for (const Outline& a : outlines)
      for (const Outline& b : outlines) {
        const Pose at = pose(draw, 4);
        both.at(a, b, at);
        CHECK(both.fast.size() == both.exact.size()); // the cuts leave no trace
        std::size_t holes[2] = {0, 0}, corners[2] = {0, 0};
        for (const Polygon& p : both.fast) holes[0] += p.holes.size();
        for (const Polygon& p : both.exact) holes[1] += p.holes.size();
        CHECK(holes[0] == holes[1]);
        each_edge(both.fast, [&](const Vec2&, const Vec2&) { ++corners[0]; });
        each_edge(both.exact, [&](const Vec2&, const Vec2&) { ++corners[1]; });
        CHECK(corners[0] == corners[1]);
        CHECK((penetration(a, b, at, both.workspace) > 0) == !both.exact.empty());
        both.check_friction(draw);
        most = std::max(most, static_cast<int>(both.fast.size()));
      }
  CHECK(most > (cases(8) == 8 ? 5 : 1)); // under the sanitizers poses are fewer, and so are pieces
}

TEST_CASE("concave overlap: edges on edges, corners on edges, cuts on cuts") {
  // Corners at whole numbers and shifts of halves: with quarter turns everything that can coincide does.
  Draw draw(82);
  Both both;
  std::vector<Outline> outlines;
  for (const Polygon& p : {ell(), u_shape(), comb(5), window(), box(0, 0, 3, 2)}) outlines.push_back(make_outline(p));
  int touching = 0;
  for (const Outline& a : outlines)
    for (const Outline& b : outlines)
      for (int i = 0; i < cases(40); ++i) {
        const Pose at{0.5 * (draw.index(21) - 10), 0.5 * (draw.index(21) - 10), 0.5 * std::numbers::pi * draw.index(4)};
        both.at(a, b, at);
        CHECK(both.fast.empty() == (area(both.exact) < k_area)); // no film of rounding where they only touch
        if (at.theta == 0) CHECK(area(both.fast) == area(both.exact));
        // to touch is a depth of nought, to the rounding of coordinates
        const double depth = penetration(a, b, at, both.workspace);
        CHECK((both.fast.empty() ? depth < 1e-14 : depth > 0.1));
        touching += both.fast.empty() && depth > -1e-14;
        both.check_friction(draw);
      }
  CHECK(touching > cases(20));
  // on itself
  for (const Polygon& p : shapes()) {
    const Outline a = make_outline(p);
    intersect(a, a, {}, both.workspace, both.fast);
    CHECK(std::abs(area(both.fast) - area(a.polygon)) < k_area);
  }
}

TEST_CASE("concave overlap: nearly on each other") {
  // Shifts and turns of down to a rounding: the sides of cells agree, or do not, by chance.
  Draw draw(83);
  Both both;
  for (const Polygon& p : shapes()) {
    const Outline a = make_outline(p);
    for (int i = 0; i < cases(40); ++i) {
      const double by = draw.scale(1e-17, 1e-3);
      both.at(a, a, {by * draw.within(-1, 1), by * draw.within(-1, 1), by * draw.within(-1, 1)});
      both.check_friction(draw);
    }
  }
}

TEST_CASE("exact overlap: coordinates are rounded from exact numbers") {
  // Squares of side 1 on one centre, turned by φ: an octagon of area 2/(1 + sin φ + cos φ). Its edges cross at the angle
  // φ, and an interval about such a crossing is 1e-16/φ wide: its middle was up to 1e-5 off.
  for (const double phi : {0.5, 1e-3, 1e-6, 1e-9, 1e-11, 1e-13}) {
    const Polygon square = box(-0.5, -0.5, 0.5, 0.5);
    CHECK(std::abs(area(exact_intersection(square, square, {0, 0, phi})) - 2 / (1 + std::sin(phi) + std::cos(phi))) < 1e-15);
  }
}

TEST_CASE("concave overlap: slits") {
  Both both;
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const Outline slit = make_outline({{{0, 0}, {2, 0}, {2, 1}, {1 + width, 1}, {1, 0.25}, {1, 1}, {0, 1}}, {}});
    const Outline bar = make_outline(box(-1, 0.5, 3, 0.75));
    both.at(slit, bar, {});
    CHECK(both.fast.size() == 2); // the slit parts it
    // its width at y is width (y − 0.25)/0.75
    CHECK(std::abs(area(both.fast) - (0.5 - width / 0.75 * 0.375 * 0.25)) < 1e-15);
    both.at(slit, slit, {0, 0.125, 0});
    const Outline needle = make_outline({{{0, 0}, {1, 0}, {1, 1}, {0.5, width}, {0, 1}}, {}});
    intersect(needle, bar, {0, 1 - 1e-9, 0}, both.workspace, both.fast);
    CHECK(both.fast.empty());
    CHECK(penetration(needle, bar, {0, 1, 0}, both.workspace) < 0);
  }
}

TEST_CASE("overlap: rings of a hundred corners and more") {
  Draw draw(84);
  Both both;
  for (const int n : {20, 21, 100, 360}) {
    const Outline a = make_outline(round_shape(n)), b = make_outline(round_shape(n == 100 ? 77 : n, 2.5));
    REQUIRE(a.convex);
    for (int i = 0; i < cases(20); ++i) {
      const double reach = draw.scale(1e-16, 6);
      const Pose at{draw.within(-reach, reach), draw.within(-reach, reach), draw.coin() ? 0 : draw.within(-3, 3)};
      both.at(a, b, at);
      both.at(a, a, at);
      const double depth = penetration(a, a, at, both.workspace);
      CHECK((depth > 0) == !both.fast.empty());
      // Two equal discs part by 2 R − |shift|; the polygons are within R (1 − cos(π/n)) of them on either side.
      const double shift = std::hypot(at.x, at.y);
      CHECK(std::abs(depth - (6 - shift)) < 12 * (1 - std::cos(std::numbers::pi / n)) + 1e-12);
      both.at(a, make_outline(star_shape(50)), at);
    }
    // against all edge normals and all corners, one by one
    const Pose at{1.5, 1.25, 0.5};
    double widest = -1e9;
    const auto gaps = [&](const Ring& ring, const Ring& other) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 e = ring[(i + 1) % ring.size()] - ring[i];
        double nearest = 1e9;
        for (const Vec2& p : other) nearest = std::min(nearest, -cross(e, p - ring[i]) / e.norm());
        widest = std::max(widest, nearest);
      }
    };
    Ring moved;
    for (const Vec2& p : b.polygon.outer) moved.push_back(placed(p, at));
    gaps(a.polygon.outer, moved);
    gaps(moved, a.polygon.outer);
    CHECK(penetration(a, b, at, both.workspace) == doctest::Approx(-widest).epsilon(1e-14));
  }
}

TEST_CASE("overlap: a plate with a hole is the plate less the plug") {
  Draw draw(85);
  OverlapWorkspace workspace;
  Region with, without, plug;
  const Ring hole{{0.25, -0.5}, {1.5, 0.25}, {0.5, 0.5}, {0.25, 1.5}}; // concave itself
  const Outline plate = make_outline({box(-3, -3, 3, 3).outer, {hole}}), whole = make_outline(box(-3, -3, 3, 3)),
                filling = make_outline({hole, {}});
  for (const Outline& other : {make_outline(box(-1, -1, 1, 1)), make_outline(ell()), make_outline(star_shape(20))})
    for (int i = 0; i < cases(50); ++i) {
      const Pose at = pose(draw, 4);
      intersect(plate, other, at, workspace, with);
      intersect(whole, other, at, workspace, without);
      intersect(filling, other, at, workspace, plug);
      CHECK(std::abs(area(with) - (area(without) - area(plug))) < k_area);
      Patch p, q, r;
      p.add(with, 2.0);
      q.add(without, 2.0);
      r.add(plug, 2.0);
      // every twist, not translation alone: h is an integral over the area
      for (const Vec3& nu : {Vec3(1, 0.5, 0), Vec3(-0.25, 1, 0), Vec3(0.5, -0.25, 1), Vec3(0, 0, -1)}) {
        const Dissipation d = evaluate_gradient(p, nu), e = evaluate_gradient(q, nu), f = evaluate_gradient(r, nu);
        CHECK(std::abs(d.h - (e.h - f.h)) < 1e-11);
        CHECK((d.gradient - (e.gradient - f.gradient)).norm() < 1e-11);
      }
    }
}

TEST_CASE("overlap: friction of a square plate with a square hole in closed form") {
  // Turning about the middle: ∬ r dA over a square of side a is a³ (√2 + asinh 1)/6; the difference of two.
  // Sliding: the area, whatever the direction.
  const Outline plate = make_outline({box(-2, -2, 2, 2).outer, {box(-1, -1, 1, 1).outer}});
  const Outline large = make_outline(box(-5, -5, 5, 5));
  OverlapWorkspace workspace;
  Region out;
  intersect(large, plate, {}, workspace, out);
  REQUIRE(out.size() == 1);
  CHECK(out.front().holes.size() == 1);
  CHECK(area(out) == 12);
  Patch patch;
  patch.add(out, 3.0);
  const double polar = (64.0 - 8.0) * (std::sqrt(2.0) + std::asinh(1.0)) / 6.0;
  CHECK(evaluate_gradient(patch, {0, 0, 1}).h == doctest::Approx(3 * polar).epsilon(1e-14));
  CHECK(evaluate_gradient(patch, {0.6, 0.8, 0}).h == doctest::Approx(36).epsilon(1e-14));
  CHECK(patch.gyration() == doctest::Approx(std::sqrt((256.0 - 16.0) / 6.0 / 12.0)).epsilon(1e-14));

  // The midpoint rule on a fine grid whose squares the hole's edges do not divide, for a centre of rotation on the
  // plate. The rule is off by 1/24 cell² ∬ Δ|s| = 1/24 (1/64)² ∬ |ω|/r dA, with ∬ dA/r < 12: 1.2e-4.
  const Vec3 nu(0.5, -1.5, 1);
  Vec3 sum = Vec3::Zero();
  double h = 0;
  for (int i = -128; i < 128; ++i)
    for (int j = -128; j < 128; ++j) {
      const Vec2 r((i + 0.5) / 64, (j + 0.5) / 64);
      if (r.lpNorm<Eigen::Infinity>() < 1) continue;
      const Vec2 s(nu[0] - nu[2] * r.y(), nu[1] + nu[2] * r.x()), u = s.normalized();
      h += 3 * s.norm() / 4096;
      sum += 3 * Vec3(u.x(), u.y(), cross(r, u)) / 4096;
    }
  const Dissipation d = evaluate_gradient(patch, nu);
  CHECK(std::abs(d.h - h) < 3 * 1.3e-4);
  CHECK((d.gradient - sum).norm() < 1e-2); // 1/r is not smooth: a cell at the centre is off by its size
}

TEST_CASE("overlap: a hole that leaves the overlap, and a sheet that lies in a hole") {
  const Outline plate = make_outline({box(0, 0, 6, 2).outer, {box(2.5, 0.5, 3.5, 1.5).outer}});
  const Outline limb = make_outline(box(0, -1, 3, 3)), small = make_outline(box(0, 0, 0.5, 0.5));
  OverlapWorkspace workspace;
  Region out;
  const auto area_at = [&](const Outline& other, double x, double y) {
    intersect(plate, other, {x, y, 0}, workspace, out);
    return area(out);
  };
  CHECK(area_at(limb, 1.0, 0) == 5); // wholly in: x from 1 to 4
  CHECK(area_at(limb, 0.5, 0) == 5); // its edge on the limb's
  CHECK(area_at(limb, 0.0, 0) == 5.5);
  CHECK(area_at(limb, -0.5, 0) == 5); // out of the overlap, edge on edge
  CHECK(area_at(limb, -1.5, 0) == 3);
  CHECK(out.front().holes.empty());
  CHECK(area_at(small, 2.75, 0.75) == 0);
  CHECK(out.empty());
  CHECK(penetration(plate, small, {2.75, 0.75, 0}, workspace) == -0.25);
  CHECK(area_at(small, 2.5, 0.5) == 0); // in its corner
  CHECK(penetration(plate, small, {2.5, 0.5, 0}, workspace) == 0);
  CHECK(area_at(small, 2.25, 0.75) == 0.125);
  CHECK(penetration(plate, small, {2.25, 0.75, 0}, workspace) == 0.25);
}

TEST_CASE("concave overlap: what it costs goes with corners and crossings, not with pairs of convex parts") {
  // Counted instead of timed: no cell of two parts is made, be the pose plain or edge on edge, and crossings are those that
  // there are. With cells a plate with a hole of 360 corners on itself made thousands.
  Draw draw(86);
  Both both;
  const Polygon plate{box(-3, -3, 3, 3).outer, {round_shape(360, 2).outer}};
  Polygon fine_comb = comb(25);
  for (Vec2& p : fine_comb.outer) p *= 0.2; // of the others' size
  for (const Polygon& p : {star_shape(50), plate, window(), fine_comb}) {
    const Outline a = make_outline(p);
    for (int i = 0; i < cases(6); ++i) {
      const bool is_plain = i % 2 == 0;
      both.at(a, a, is_plain ? pose(draw, 2) : Pose{draw.within(-2, 2), 0, 0});
      CHECK(both.workspace.cells.cells.empty());
      both.check_friction(draw);
      if (!is_plain) continue;
      CHECK(both.fast.size() == both.exact.size());
      std::size_t corners = 0;
      each_edge(both.fast, [&](const Vec2&, const Vec2&) { ++corners; });
      CHECK(corners <= both.workspace.trace.crossings.size() + 2 * a.boundary.corners.size());
    }
  }
}

TEST_CASE("concave overlap: along a common edge in any direction") {
  // Sliding along an edge keeps edges on edges at every pose: none may be left to the pairs of convex parts.
  Both both;
  for (const double turn : {0.0, 0.3, 0.785398163397448, 1.0, 1.1, 2.2}) {
    const Vec2 along(std::cos(turn), std::sin(turn));
    Polygon plate = ring_shape();
    const auto turned = [&](Ring& ring) {
      for (Vec2& p : ring) p = Vec2(along.x() * p.x() - along.y() * p.y(), along.y() * p.x() + along.x() * p.y());
    };
    turned(plate.outer);
    turned(plate.holes.front());
    const Outline a = make_outline(plate);
    for (int i = 0; i < cases(20); ++i) {
      const double by = 0.25 * i + 0.01;
      both.at(a, a, {by * along.x(), by * along.y(), 0});
      CHECK(both.workspace.cells.cells.empty());
    }
  }
}

TEST_CASE("concave overlap: islands in holes, holes in islands") {
  // Frames within frames: a crossed by a bar that leaves pieces about which other pieces lie.
  const auto frame = [](double r, double s) { return Polygon{box(-r, -r, r, r).outer, {box(-s, -s, s, s).outer}}; };
  Both both;
  const Outline outer = make_outline(frame(5, 4)), sheet = make_outline({box(-6, -6, 6, 6).outer, {box(-4.5, -4.5, 4.5, 4.5).outer}});
  // the two frames share a frame of 5 to 4.5, shifted: its hole belongs to it
  for (const Pose at : {Pose{0.1, 0.2, 0.05}, Pose{0, 0, 0}, Pose{0.25, 0, 0}}) {
    both.at(outer, sheet, at);
    REQUIRE(both.fast.size() == 1);
    CHECK(both.fast.front().holes.size() == 1);
    CHECK(area(both.fast.front()) > 0);
  }
  // two windows of a U, each with a piece of a plate that has a hole in it
  const Outline pair = make_outline({{{-5, 0}, {5, 0}, {5, 4}, {1, 4}, {1, 1}, {-1, 1}, {-1, 4}, {-5, 4}}, {}});
  const Outline holed = make_outline({box(-4.5, 1.5, 4.5, 3.5).outer, {box(-3.5, 2, -2.5, 3).outer, box(2.5, 2, 3.5, 3).outer}});
  for (const Pose at : {Pose{0, 0, 0}, Pose{0.1, -0.2, 0.01}}) {
    both.at(pair, holed, at);
    REQUIRE(both.fast.size() == 2);
    for (const Polygon& piece : both.fast) {
      REQUIRE(piece.holes.size() == 1);
      CHECK((piece.holes.front().front().x() > 0) == (piece.outer.front().x() > 0)); // each its own
    }
  }
}

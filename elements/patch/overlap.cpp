#include "elements/patch/overlap.h"

#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr double k_rounding = 1e-16; // of coordinates, turned and shifted, relative to the sheets' reach together

void place(const Ring& ring, const Pose& pose, Ring& out) {
  const auto [s, c] = portable::sin_cos(pose.theta);
  out.resize(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i)
    out[i] = {c * ring[i].x() - s * ring[i].y() + pose.x,
              s * ring[i].x() + c * ring[i].y() + pose.y};
}

/// out := the part of the convex ring on the left of the line through p and q.
void clip(const Ring& ring, const Vec2& p, const Vec2& q, Ring& out) {
  out.clear();
  if (ring.empty()) return;
  const Vec2 along = q - p;
  Vec2 from = ring.back();
  double d_from = cross(along, from - p);
  for (const Vec2& to : ring) {
    const double d_to = cross(along, to - p);
    if ((d_from < 0) != (d_to < 0)) out.push_back(from + (to - from) * (d_from / (d_from - d_to)));
    if (d_to >= 0) out.push_back(to);
    from = to;
    d_from = d_to;
  }
}

/// workspace.front := convex ring a ∩ workspace.placed.
void clip_convex(const Ring& a, OverlapWorkspace& w) {
  w.front.assign(a.begin(), a.end());
  for (std::size_t i = 0; i < w.placed.size() && !w.front.empty(); ++i) {
    clip(w.front, w.placed[i], w.placed[i + 1 == w.placed.size() ? 0 : i + 1], w.back);
    std::swap(w.front, w.back);
  }
}

bool circles_apart(const Outline& a, const Outline& b, const Pose& pose) {
  return (placed(b.centre, pose) - a.centre).norm() > (a.radius + b.radius) * (1 + 1e-12);
}

RingView part(const ConvexCut& cut, std::size_t i, const Ring& corners) {
  const ConvexPart& p = cut.parts[i];
  return {&corners[p.first], &cut.sides[p.first], p.count};
}

/// Of convex rings: the least overlap over all edge normals of both.
double depth(const RingView& a, const RingView& b) {
  return -std::max(widest_gap(a, b), widest_gap(b, a));
}

double depth(const Box& a, const Box& b) {
  return (a.high.cwiseMin(b.high) - a.low.cwiseMax(b.low)).minCoeff();
}

/// No pair of parts is deeper than its boxes: most need not be looked at.
double depth_of_parts(const Outline& a, const Outline& b, CellWorkspace& w) {
  const std::size_t n = a.cut.parts.size(), m = b.cut.parts.size();
  w.boxes.resize(m);
  for (std::size_t j = 0; j < m; ++j)
    w.boxes[j] = box_of(&w.placed[b.cut.parts[j].first], b.cut.parts[j].count);
  const auto of_pair = [&](std::size_t i, std::size_t j) {
    return std::min(depth(a.cut.parts[i].box, w.boxes[j]),
                    depth(part(a.cut, i, a.cut.corners), part(b.cut, j, w.placed)));
  };
  std::size_t likely[2] = {0, 0};
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j)
      if (const double d = depth(a.cut.parts[i].box, w.boxes[j]); d > most) most = d, likely[0] = i, likely[1] = j;
  double deepest = of_pair(likely[0], likely[1]);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j)
      if (depth(a.cut.parts[i].box, w.boxes[j]) > deepest) deepest = std::max(deepest, of_pair(i, j));
  return deepest;
}

double least_area(const Outline& a, const Outline& b) {
  const double size = std::min(a.radius, b.radius);
  return k_no_area * size * size;
}

void put_convex(const Ring& ring, CellWorkspace& w, Region& out) {
  if (w.polygons.empty()) w.polygons.emplace_back();
  out.push_back(std::move(w.polygons.back()));
  w.polygons.pop_back();
  out.back().outer.assign(ring.begin(), ring.end());
}

void intersect_convex(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w, Region& out) {
  const Ring &ring_a = a.polygon.outer, &ring_b = b.polygon.outer;
  place(ring_b, pose, w.placed);
  if (ring_a.size() * ring_b.size() < k_many_corners) {
    clip_convex(ring_a, w);
  } else {
    clip({ring_a.data(), nullptr, ring_a.size()}, {w.placed.data(), nullptr, w.placed.size()}, w.cells.clip);
    w.front.clear();
    for (const Corner& c : w.cells.clip.ring) w.front.push_back(c.at);
  }
  if (w.front.size() >= 3 && signed_area(w.front) > least_area(a, b)) put_convex(w.front, w.cells, out);
}

bool trace(const Outline& a, const Outline& b, const Pose& pose, double rounding, OverlapWorkspace& w, Region& out) {
  place(b.boundary.corners, pose, w.trace.placed);
  build_edge_tree(b.boundary, w.trace.placed, w.trace.tree);
  return trace_overlap({&a.boundary, &a.boundary.corners, &a.tree}, {&b.boundary, &w.trace.placed, &w.trace.tree}, rounding,
                       least_area(a, b), w.trace, w.cells, out);
}

} // namespace

Vec2 placed(const Vec2& p, const Pose& pose) {
  const auto [s, c] = portable::sin_cos(pose.theta);
  return {c * p.x() - s * p.y() + pose.x, s * p.x() + c * p.y() + pose.y};
}

Outline make_outline(Polygon polygon) {
  Outline out;
  out.polygon = repaired(std::move(polygon));
  out.convex = out.polygon.holes.empty() && is_convex(out.polygon.outer);
  Vec2 low = out.polygon.outer.front(), high = low;
  for (const Vec2& p : out.polygon.outer) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  out.centre = 0.5 * (low + high);
  for (const Vec2& p : out.polygon.outer)
    out.radius = std::max(out.radius, (p - out.centre).norm());
  out.cut = out.convex ? uncut(out.polygon.outer) : cut_into_convex(out.polygon);
  out.boundary = boundary_of(out.polygon);
  build_edge_tree(out.boundary, out.boundary.corners, out.tree);
  return out;
}

void intersect(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w,
               Region& out) {
  empty_keeping_storage(out, w.cells);
  if (circles_apart(a, b, pose)) return;
  if (a.convex && b.convex) return intersect_convex(a, b, pose, w, out);
  const double reach = a.centre.norm() + a.radius + b.centre.norm() + b.radius;
  if (trace(a, b, pose, k_rounding * reach, w, out)) return;
  place(b.cut.corners, pose, w.cells.placed);
  join_cells(a.cut, b.cut, k_rounding * reach, least_area(a, b), w.cells, out);
}

void intersect_exactly(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w,
                       Region& out) {
  if (circles_apart(a, b, pose) || (a.convex && b.convex)) return intersect(a, b, pose, w, out);
  out = exact_intersection(a.polygon, b.polygon, pose);
  std::erase_if(out, [&](const Polygon& p) { return area(p) <= least_area(a, b); });
}

double penetration(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w) {
  place(b.cut.corners, pose, w.cells.placed);
  if (a.convex && b.convex) return depth(part(a.cut, 0, a.cut.corners), part(b.cut, 0, w.cells.placed));
  return depth_of_parts(a, b, w.cells);
}

} // namespace steplap

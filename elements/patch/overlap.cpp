#include "elements/patch/overlap.h"

#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

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

/// Empties the region, keeping the storage of its first polygon for the next time.
void empty_keeping_storage(Region& out, OverlapWorkspace& w) {
  if (!out.empty()) std::swap(w.spare, out.front());
  out.clear();
}

bool circles_apart(const Outline& a, const Outline& b, const Pose& pose) {
  return (placed(b.centre, pose) - a.centre).norm() > (a.radius + b.radius) * (1 + 1e-12);
}

/// Greatest signed distance of the nearest vertex of `other` from an edge of `ring`, outwards
/// positive: positive means that the edge separates them.
double widest_gap(const Ring& ring, const Ring& other) {
  double widest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 e = ring[i + 1 == ring.size() ? 0 : i + 1] - ring[i];
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2& p : other)
      nearest = std::min(nearest, -cross(e, p - ring[i]));
    widest = std::max(widest, nearest / e.norm());
  }
  return widest;
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
  if (out.convex)
    out.parts.push_back(out.polygon.outer);
  else
    out.parts = triangulated(out.polygon);
  return out;
}

void intersect(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w,
               Region& out) {
  const double size = std::min(a.radius, b.radius);
  const double least_area = k_no_area * size * size;
  if (circles_apart(a, b, pose)) {
    empty_keeping_storage(out, w);
  } else if (a.convex && b.convex) {
    place(b.polygon.outer, pose, w.placed);
    clip_convex(a.polygon.outer, w);
    empty_keeping_storage(out, w);
    if (w.front.size() < 3 || signed_area(w.front) <= least_area) return;
    out.push_back(std::move(w.spare));
    out.front().outer.assign(w.front.begin(), w.front.end());
    out.front().holes.clear();
  } else {
    out = exact_intersection(a.polygon, b.polygon, pose);
    std::erase_if(out, [&](const Polygon& p) { return area(p) <= least_area; });
  }
}

double penetration(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Ring& part_b : b.parts) {
    place(part_b, pose, w.placed);
    for (const Ring& part_a : a.parts)
      deepest =
          std::max(deepest, -std::max(widest_gap(part_a, w.placed), widest_gap(w.placed, part_a)));
  }
  return deepest;
}

} // namespace steplap

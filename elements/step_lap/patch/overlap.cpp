#include "elements/step_lap/patch/overlap.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr double k_rounded_place =
    1e-16; // relative rounding error of rotated and translated coordinates, in units of the size of both sheets

// Returns sine and cosine of the angle, cached from the previous call, because all sheets of a joint have the same pose.
const portable::SinCos& turn_of(double angle) {
  static thread_local double turned = 0.0;
  static thread_local portable::SinCos turn{0.0, 1.0};
  // Bit comparison, because it also distinguishes the sign of zero.
  if (std::bit_cast<std::uint64_t>(angle) != std::bit_cast<std::uint64_t>(turned)) {
    turn = portable::sin_cos(angle);
    turned = angle;
  }
  return turn;
}

Vec2 placed(const Vec2& p, const Pose& pose, const portable::SinCos& turn) {
  const auto [s, c] = turn;
  return {c * p.x() - s * p.y() + pose.x, s * p.x() + c * p.y() + pose.y};
}

void place(const Ring& ring, const Pose& pose, const portable::SinCos& turn, Ring& out) {
  const auto [s, c] = turn;
  out.resize(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i)
    out[i] = {c * ring[i].x() - s * ring[i].y() + pose.x, s * ring[i].x() + c * ring[i].y() + pose.y};
}

/// Sets `out` to the part of the convex ring on the left of the line through p and q. Returns false, with `out` unchanged, if the whole
/// ring is on the left.
[[gnu::always_inline]] inline bool clip(const Ring& ring, const Vec2& p, const Vec2& q, Ring& out) {
  const Vec2 along = q - p;
  if (std::all_of(ring.begin(), ring.end(), [&](const Vec2& corner) { return cross(along, corner - p) >= 0; })) return false;
  out.clear();
  Vec2 from = ring.back();
  double d_from = cross(along, from - p);
  for (const Vec2& to : ring) {
    const double d_to = cross(along, to - p);
    if ((d_from < 0) != (d_to < 0)) out.push_back(from + (to - from) * (d_from / (d_from - d_to)));
    if (d_to >= 0) out.push_back(to);
    from = to;
    d_from = d_to;
  }
  return true;
}

/// Sets workspace.front to a ∩ workspace.placed for a convex ring a.
[[gnu::always_inline]] inline void clip_convex_as_is(const Ring& a, OverlapWorkspace& w) {
  w.front.assign(a.begin(), a.end());
  for (std::size_t i = 0; i < w.placed.size() && !w.front.empty(); ++i)
    if (clip(w.front, w.placed[i], w.placed[i + 1 == w.placed.size() ? 0 : i + 1], w.back)) std::swap(w.front, w.back);
}

#if defined(__x86_64__)
// The same code compiled for AVX, whose three-operand instructions save copies; results are bit-identical.
[[gnu::target("avx")]] void clip_by_three_operands(const Ring& a, OverlapWorkspace& w) { clip_convex_as_is(a, w); }
const bool may_clip_by_three_operands = __builtin_cpu_supports("avx") != 0;
#endif

void clip_convex(const Ring& a, OverlapWorkspace& w) {
#if defined(__x86_64__)
  if (may_clip_by_three_operands) return clip_by_three_operands(a, w);
#endif
  clip_convex_as_is(a, w);
}

bool circles_apart(const Outline& a, const Outline& b, const Pose& pose, const portable::SinCos& turn) {
  return (placed(b.centre, pose, turn) - a.centre).norm() > (a.radius + b.radius) * (1 + 1e-12);
}

RingView part(const ConvexCut& cut, std::size_t i, const Ring& corners) {
  const ConvexPart& p = cut.parts[i];
  return {&corners[p.first], &cut.sides[p.first], p.count};
}

/// Returns, for convex rings, the smallest overlap over all edge normals of both.
double depth(const RingView& a, const RingView& b) { return -std::max(widest_gap(a, b), widest_gap(b, a)); }

double depth(const Box& a, const Box& b) { return (a.high.cwiseMin(b.high) - a.low.cwiseMax(b.low)).minCoeff(); }

/// Search for the deepest pair of convex parts. The depth of a pair is at most that of its bounding boxes, so most pairs are excluded
/// without examination.
class DeepestPair {
public:
  DeepestPair(const Outline& a, const Outline& b, const Ring& placed, const BoxTree& parts) : a_(a), b_(b), placed_(placed), parts_(parts) {
    guess();
    search(BoxTree::k_root, BoxTree::k_root);
  }
  [[nodiscard]] double depth() const { return deepest_; }

private:
  [[nodiscard]] double bound(std::size_t p, std::size_t q) const { return steplap::depth(a_.parts.box(p), parts_.box(q)); }

  /// Returns the two pairs of nodes below a pair of nodes, in the tree whose node is higher.
  [[nodiscard]] std::array<std::array<std::size_t, 2>, 2> below(std::size_t p, std::size_t q) const {
    if (parts_.is_leaf(q) || (!a_.parts.is_leaf(p) && p <= q)) return {{{2 * p, q}, {2 * p + 1, q}}};
    return {{{p, 2 * q}, {p, 2 * q + 1}}};
  }

  /// Finds a deep pair as first candidate, so that others can be excluded.
  void guess() {
    std::size_t p = BoxTree::k_root, q = BoxTree::k_root;
    while (!(a_.parts.is_leaf(p) && parts_.is_leaf(q))) {
      const auto [one, two] = below(p, q);
      const auto& better = bound(two[0], two[1]) > bound(one[0], one[1]) ? two : one;
      p = better[0];
      q = better[1];
    }
    look_at(p, q);
  }

  void search(std::size_t p, std::size_t q) {
    if (a_.parts.is_leaf(p) && parts_.is_leaf(q)) return look_at(p, q);
    auto [one, two] = below(p, q);
    double d_one = bound(one[0], one[1]), d_two = bound(two[0], two[1]);
    if (d_two > d_one) {
      std::swap(one, two);
      std::swap(d_one, d_two);
    }
    if (d_one > deepest_) search(one[0], one[1]);
    if (d_two > deepest_) search(two[0], two[1]);
  }

  void look_at(std::size_t p, std::size_t q) {
    const double of_boxes = bound(p, q);
    const RingView one = part(a_.cut, a_.parts.first(p), a_.cut.corners), two = part(b_.cut, parts_.first(q), placed_);
    const double gap = widest_gap(one, two, -deepest_);
    if (!(std::min(of_boxes, -gap) > deepest_)) return;
    deepest_ = std::max(deepest_, std::min(of_boxes, -std::max(gap, widest_gap(two, one, -deepest_))));
  }

  const Outline &a_, &b_;
  const Ring& placed_;
  const BoxTree& parts_;
  double deepest_ = -std::numeric_limits<double>::infinity();
};

double depth_of_parts(const Outline& a, const Outline& b, OverlapWorkspace& w) {
  const Ring& placed = w.cells.placed;
  w.parts.build(b.cut.parts.size(), 1, [&](std::size_t j) { return box_of(&placed[b.cut.parts[j].first], b.cut.parts[j].count); });
  return DeepestPair(a, b, placed, w.parts).depth();
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
  place(ring_b, pose, turn_of(pose.theta), w.placed);
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
  place(b.boundary.corners, pose, turn_of(pose.theta), w.trace.placed);
  build_edge_tree(b.boundary, w.trace.placed, w.trace.tree);
  return trace_overlap({&a.boundary, &a.boundary.corners, &a.tree}, {&b.boundary, &w.trace.placed, &w.trace.tree}, rounding,
                       least_area(a, b), w.trace, w.cells, out);
}

} // namespace

Vec2 placed(const Vec2& p, const Pose& pose) { return placed(p, pose, portable::sin_cos(pose.theta)); }

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
  for (const Vec2& p : out.polygon.outer) out.radius = std::max(out.radius, (p - out.centre).norm());
  out.cut = out.convex ? uncut(out.polygon.outer) : cut_into_convex(out.polygon);
  out.boundary = boundary_of(out.polygon);
  build_edge_tree(out.boundary, out.boundary.corners, out.tree);
  out.parts.build(out.cut.parts.size(), 1, [&](std::size_t i) { return out.cut.parts[i].box; });
  return out;
}

void intersect(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w, Region& out) {
  empty_keeping_storage(out, w.cells);
  if (circles_apart(a, b, pose, turn_of(pose.theta))) return;
  if (a.convex && b.convex) return intersect_convex(a, b, pose, w, out);
  const double reach = a.centre.norm() + a.radius + b.centre.norm() + b.radius;
  if (trace(a, b, pose, k_rounded_place * reach, w, out)) return;
  place(b.cut.corners, pose, turn_of(pose.theta), w.cells.placed);
  join_cells(a.cut, b.cut, k_rounded_place * reach, least_area(a, b), w.cells, out);
}

void intersect_exactly(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w, Region& out) {
  if (circles_apart(a, b, pose, turn_of(pose.theta)) || (a.convex && b.convex)) return intersect(a, b, pose, w, out);
  out = exact_intersection(a.polygon, b.polygon, pose);
  std::erase_if(out, [&](const Polygon& p) { return area(p) <= least_area(a, b); });
}

double penetration(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w) {
  place(b.cut.corners, pose, turn_of(pose.theta), w.cells.placed);
  if (a.convex && b.convex) return depth(part(a.cut, 0, a.cut.corners), part(b.cut, 0, w.cells.placed));
  return depth_of_parts(a, b, w);
}

DepthBound depth_bound(const Outline& a, const Outline& b, const Pose& pose, OverlapWorkspace& w) {
  const double of_a = (a.centre - Vec2(pose.x, pose.y)).norm() + a.radius, of_b = b.centre.norm() + b.radius;
  return {pose, penetration(a, b, pose, w), std::max(of_a, of_b)};
}

double DepthBound::at_least(const Pose& there) const {
  const double shift = std::abs(there.x - pose.x) + std::abs(there.y - pose.y);
  return depth - shift - (reach + shift) * std::abs(there.theta - pose.theta);
}

} // namespace steplap

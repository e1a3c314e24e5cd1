// Distances of circles and segments, as measures for LawGroup. The gap is value − offset; the law's offset contains the radii. The distance
// is that of a's point p (the circle's centre), through which the force passes. It is undefined at zero distance, a penetration by the
// whole radius.
#pragma once

#include "mbd/system/gap_source.h"
#include "mbd/system/turn_table.h"

namespace steplap {

/// Value −|p_A − p_B|: a circle of a inside a ring of b.
struct InsideMeasure {
  Vec2 point_a, point_b;
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    static_assert(!WithBias, "no row takes it");
    MeasureValue<S> m = DistanceMeasure{point_a, point_b}.at<false, S>(a, b);
    m.value = -m.value;
    m.rate = -m.rate;
    m.direction = S(-1) * m.direction;
    return m;
  }
};

/// Part of a segment that is nearest to p: one of its sides or ends.
enum class SegmentPart : unsigned char { left, right, from, to };

/// Distance of p from the segment of b that begins at `from` and runs along `tangent`. The gradient is continuous.
struct SegmentMeasure {
  Vec2 point_a, from, tangent; ///< point_a in the frame of a; from, tangent (unit vector) in the frame of b
  double length = 0.0;

  [[nodiscard]] Vec2 to() const { return from + length * tangent; }
  /// Returns the coordinates of p along the segment and across it (positive on the left), m.
  template <class S, class B> STEPLAP_INLINE Pair<S> place(const Motion<S>& a, const B& b) const {
    const Pair<S> start = to_ground(b, from), t = to_ground(b, tangent);
    const Pair<S> d = offset(a, b) + to_ground(a, point_a) - start;
    return {dot(t, d), cross(t, d)};
  }
  template <class S, class B> STEPLAP_INLINE SegmentPart part(const Motion<S>& a, const B& b) const {
    const Pair<S> p = place(a, b);
    if (p.x < S(0)) return SegmentPart::from;
    if (p.x > S(length)) return SegmentPart::to;
    return p.y < S(0) ? SegmentPart::right : SegmentPart::left;
  }
  template <bool WithBias, class S, class B> STEPLAP_INLINE MeasureValue<S> at(const Motion<S>& a, const B& b) const {
    static_assert(!WithBias, "no row takes it");
    switch (part(a, b)) {
    case SegmentPart::left: return AxisMeasure{point_a, from, perp(tangent)}.at<false, S>(a, b);
    case SegmentPart::right: return AxisMeasure{point_a, from, -perp(tangent)}.at<false, S>(a, b);
    case SegmentPart::from: return DistanceMeasure{point_a, from}.at<false, S>(a, b);
    case SegmentPart::to: break;
    }
    return DistanceMeasure{point_a, to()}.at<false, S>(a, b);
  }
};

[[nodiscard]] inline Turning turning_of(const InsideMeasure& m) { return {moves_by_turning(m.point_a), moves_by_turning(m.point_b)}; }
[[nodiscard]] inline Turning turning_of(const SegmentMeasure& m) { return {moves_by_turning(m.point_a), true}; }

/// Returns the bounds of the gap. A circle cannot pass through the ring that encloses it.
inline GapBounds gap_bounds(const InsideMeasure& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  GapBounds bounds = gap_bounds(DistanceMeasure{measure.point_a, measure.point_b}, 0.0, a, b);
  bounds.gap = -bounds.gap - offset;
  bounds.normal = -1.0 * bounds.normal;
  bounds.through = std::numeric_limits<double>::infinity();
  return bounds;
}

/// Returns the bounds of the gap. `offset`: radius of the circle plus half the thickness of the segment, m.
inline GapBounds gap_bounds(const SegmentMeasure& measure, double offset, const Motion<double>& a, const Motion<double>& b) {
  const auto m = measure.at<false, double>(a, b);
  GapBounds bounds;
  bounds.gap = m.value - offset;
  bounds.normal = m.direction;
  bounds.reach_a = measure.point_a.norm();
  bounds.reach_b = std::max(measure.from.norm(), measure.to().norm());
  bounds.through = offset;
  return bounds;
}

} // namespace steplap

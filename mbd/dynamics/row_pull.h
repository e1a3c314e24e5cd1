// What a constraint row does to accelerations: its gradient and bias in the coordinates of the clusters that its bodies belong to.
//
// load_row() does it for every measure by the functions of row_gradient.h. The most frequent rows, along an axis and along a slide,
// between bodies that are clusters of their own, have a shorter way: pull_along_axis() and pull_along_slide() see a from b and leave
// out the value and the rate, which no acceleration needs. tests/mbd/test_row_gradient.cpp holds both ways against each other.
#pragma once

#include "mbd/dynamics/layout.h"
#include "mbd/system/row_gradient.h"

namespace steplap {

template <class S> struct RowPull {
  Pair<S> direction;
  S couple_a, couple_b; // of the unit force on a, about a's and b's centre of gravity
  S bias;
};

template <class S> STEPLAP_INLINE RowPull<S> pull_along_axis(const RowSpec& row, const Motion<S>& link) {
  RowPull<S> p;
  const Pair<S> lever = to_ground(link, row.point_a);
  p.direction = {row.direction.x(), row.direction.y()};
  p.couple_a = cross(lever, p.direction);
  p.couple_b = p.couple_a + cross(Pair<S>{link.x, link.y}, p.direction);
  p.bias = -(link.omega * link.omega) * dot(p.direction, lever);
  return p;
}

// SlideMeasure. With the shaft s, a unit vector, α = n·s and the gap δ along it, the unit force on a is g = −ẑ×s/α at the tip,
// r − δ s from a's centre if r is the contact's point; r·s and r×s are fixed in a:
//   couple on a = (δ − r·s)/α,  rate = g·v + ω · couple,  bias = ω (2 (v·s − rate β) + ω r×s)/α,  β = s × n
template <class S> STEPLAP_INLINE RowPull<S> pull_along_slide(const RowSpec& row, const Motion<S>& link) {
  RowPull<S> p;
  const Pair<S> s = to_ground(link, row.contact_axis), r = to_ground(link, row.point_a);
  const Pair<S> n{row.direction.x(), row.direction.y()}, v{link.vx, link.vy};
  const S inverse = 1.0 / dot(n, s);
  const S gap = inverse * (n.x * (link.x + r.x - row.point_b.x()) + n.y * (link.y + r.y - row.point_b.y()));
  p.direction = {inverse * s.y, -(inverse * s.x)};
  p.couple_a = inverse * (gap - dot(r, s));
  p.couple_b = p.couple_a + cross(Pair<S>{link.x, link.y}, p.direction);
  const S rate = dot(p.direction, v) + link.omega * p.couple_a;
  p.bias = inverse * link.omega * (2.0 * (dot(v, s) - rate * cross(s, n)) + link.omega * cross(r, s));
  return p;
}

/// Fills one side of a row in the clusters' coordinates.
template <class S> STEPLAP_INLINE void set_gradient(SchurRowOf<S>& row, int side, const S& fx, const S& fy, const S& couple) {
  const double* const w = row.w[side];
  S* const j = row.j[side];
  S* const wj = row.wj[side];
  const S wx = w[0] * fx, wy = w[1] * fy, wm = w[2] * couple;
  j[0] = fx;
  j[1] = fy;
  j[2] = couple;
  wj[0] = wx;
  wj[1] = wy;
  wj[2] = wm;
}

/// What is left of `right` where the accelerations of the clusters are `a`: right − J a.
template <class S> STEPLAP_INLINE S less_accelerations(const SchurRowOf<S>& row, S right, const S* a) {
  for (int side = 0; side < 2; ++side) {
    if (row.body[side] < 0) continue;
    const S* const ak = a + 3 * row.body[side];
    const S* const j = row.j[side];
    right -= row.is_constant ? j[2] * ak[2] : j[0] * ak[0] + j[1] * ak[1] + j[2] * ak[2];
  }
  return right;
}

/// Fills in row r, which is between bodies that are clusters of their own or the ground, at the motion placed; returns γ.
template <class S> STEPLAP_INLINE S pull_simple_row(const ActiveRow& active, SchurRowOf<S>& row, const Motion<S>* motion) {
  const Motion<S>& link = motion[active.link];
  const Motion<S>& b = motion[active.spec->b];
  const RowPull<S> p = active.pull == RowPullKind::axis ? pull_along_axis(*active.spec, link) : pull_along_slide(*active.spec, link);
  const S x = b.c * p.direction.x - b.s * p.direction.y, y = b.s * p.direction.x + b.c * p.direction.y;
  set_gradient(row, 0, x, y, p.couple_a);
  if (row.body[1] >= 0) set_gradient<S>(row, 1, -x, -y, -p.couple_b);
  return -(p.bias + dot(p.direction, frame_acceleration(link, b.omega)));
}

// --- rows of any measure, between any clusters --------------------------------------------------------

/// A body `off` from its cluster's centre has the acceleration −ω² off where its cluster has none: what is due to that in the second
/// rate of a row.
template <class S> STEPLAP_INLINE void add_centripetal(int side, const Pair<S>& direction, const S& omega, const Pair<S>& off, S& bias) {
  const S term = omega * omega * dot(direction, off);
  if (side == 0) bias -= term;
  else bias += term;
}

/// From b's axes into the ground's.
template <class S> [[nodiscard]] STEPLAP_INLINE MeasureValue<S> turned(MeasureValue<S> m, const Motion<S>& b) {
  for (Pair<S>* p : {&m.direction, &m.lever_a, &m.lever_b}) *p = {b.c * p->x - b.s * p->y, b.s * p->x + b.c * p->y};
  return m;
}

/// J and W J of a row, or of a part of one, whose measure is m in ground axes. With `WithBias` the bias becomes that of the clusters.
template <bool WithBias, class S>
STEPLAP_INLINE void put_in_clusters(const Layout& layout, const RowSpec& spec, const Motion<S>* motion, MeasureValue<S>& m,
                                    SchurRowOf<S>& row) {
  const int body[2] = {spec.a, spec.b};
  for (int side = 0; side < 2; ++side) {
    const Placement& place = layout.placements[body[side]];
    if (place.cluster < 0) continue;
    Pair<S> lever = side == 0 ? m.lever_a : m.lever_b;
    if (!place.is_trivial) {
      const Motion<S>& k = motion[layout.clusters[place.cluster].motion];
      const Pair<S> off{motion[body[side]].x - k.x, motion[body[side]].y - k.y};
      lever = lever + off;
      if constexpr (WithBias) add_centripetal(side, m.direction, k.omega, off, m.bias);
    }
    S* const j = row.j[side];
    put_gradient(m, side, lever, j);
    for (int c = 0; c < 3; ++c) row.wj[side][c] = row.w[side][c] * j[c];
  }
}

/// Fills in an active row at the motion placed, whatever it measures; `row.body` and `row.w` are known.
template <bool WithBias, class S>
STEPLAP_INLINE MeasureValue<S> load_row(const Layout& layout, const ActiveRow& active, const Motion<S>* motion, SchurRowOf<S>& row) {
  const Motion<S>& link = motion[active.link];
  if (row.is_constant) { // an angle: make_layout has filled in its gradient
    MeasureValue<S> m;
    m.value = link.theta;
    m.rate = link.omega;
    return m;
  }
  const Motion<S>& b = motion[active.spec->b];
  MeasureValue<S> m = evaluate_row<WithBias>(*active.spec, link, Origin{});
  if constexpr (WithBias) m.bias += dot(m.direction, frame_acceleration(link, b.omega));
  if (!active.is_simple) {
    m = turned(m, b);
    put_in_clusters<WithBias>(layout, *active.spec, motion, m, row);
    return m;
  }
  const S x = b.c * m.direction.x - b.s * m.direction.y, y = b.s * m.direction.x + b.c * m.direction.y;
  if (row.body[0] >= 0) set_gradient<S>(row, 0, x, y, cross(m.lever_a, m.direction) + m.couple);
  if (row.body[1] >= 0) set_gradient<S>(row, 1, -x, -y, -(cross(m.lever_b, m.direction) + m.couple));
  return m;
}

/// Fills in an active row for an evaluation of accelerations; returns γ.
template <class S> STEPLAP_INLINE S pull_row(const Layout& layout, const ActiveRow& active, const Motion<S>* motion, SchurRowOf<S>& row) {
  if (active.pull == RowPullKind::angle) return S(0.0);
  if (active.pull == RowPullKind::other) return -load_row<true>(layout, active, motion, row).bias;
  return pull_simple_row(active, row, motion);
}

/// Fills in part i of the layout's long rows, at the motion placed. With `WithBias` the bias is that of the clusters.
template <bool WithBias, class S>
STEPLAP_INLINE MeasureValue<S> load_part(const Layout& layout, std::size_t i, const Motion<S>* motion, SchurRowOf<S>* rows) {
  const RowSpec& part = *layout.part_specs[i];
  MeasureValue<S> m = evaluate_row<WithBias>(part, motion[part.a], motion[part.b]);
  put_in_clusters<WithBias>(layout, part, motion, m, rows[layout.parts[i].row]);
  return m;
}

/// What the parts of long rows add to γ, `right`.
template <class S> void pull_parts(const Layout& layout, const Motion<S>* motion, SchurRowOf<S>* rows, S* right) {
  for (std::size_t i = 0; i < layout.parts.size(); ++i) right[layout.parts[i].of] -= load_part<true>(layout, i, motion, rows).bias;
}

/// What they take of it where the accelerations of the clusters are `a`.
template <class S> void take_part_accelerations(const Layout& layout, const SchurRowOf<S>* rows, const S* a, S* right) {
  for (const SchurPart& part : layout.parts) right[part.of] = less_accelerations(rows[part.row], right[part.of], a);
}

/// a += W Jᵀ λ of the parts.
template <class S> void add_part_responses(const Layout& layout, const SchurRowOf<S>* rows, const S* lambda, S* a) {
  for (const SchurPart& part : layout.parts) {
    const SchurRowOf<S>& row = rows[part.row];
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0)
        for (int c = 0; c < 3; ++c) a[3 * row.body[side] + c] += row.wj[side][c] * lambda[part.of];
  }
}

/// a += W Jᵀ λ: a constant row is zero but for θ.
template <class S> STEPLAP_INLINE void add_response(const SchurRowOf<S>& row, int side, const S& lambda, S* a) {
  S* const ak = a + 3 * row.body[side];
  const S x = row.wj[side][0] * lambda, y = row.wj[side][1] * lambda, m = row.wj[side][2] * lambda;
  ak[0] += x;
  ak[1] += y;
  ak[2] += m;
}
template <class S> STEPLAP_INLINE void add_responses(const SchurRowOf<S>* rows, std::size_t count, const S* lambda, S* a) {
  for (std::size_t r = 0; r < count; ++r) {
    const SchurRowOf<S>& row = rows[r];
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < 0) continue;
      if (row.is_constant) a[3 * row.body[side] + 2] += row.wj[side][2] * lambda[r];
      else add_response(row, side, lambda[r], a);
    }
  }
}

} // namespace steplap

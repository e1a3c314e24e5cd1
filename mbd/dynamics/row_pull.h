// Gradient and bias of constraint rows in the coordinates of clusters, and their use in (29)–(31).
//
// load_row() works for every measure, by the functions of row_gradient.h. The most frequent rows, axis and slide rows between bodies that
// are alone in their clusters, have the faster functions pull_along_axis() and pull_along_slide(), which use the motion of a relative to b
// and omit value and rate. tests/mbd/test_row_gradient.cpp compares both.
#pragma once

#include "mbd/dynamics/layout.h"
#include "mbd/system/row_gradient.h"

namespace steplap {

/// Gradient and bias of a row, in the axes of b.
template <class S> struct RowPull {
  Pair<S> direction;
  S couple_a, couple_b; // moments of the unit force about the centres of gravity of a and b
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

// Gradient and bias of a SlideMeasure. Let s be the unit vector along the contact axis, α = n·s, δ the gap along s, and r the position of
// the contact point relative to a's centre. The unit force on a is g = −ẑ×s/α at r − δ s; r·s and r×s are constant in a.
//
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

/// Sets J and W J on one side of a row for a unit force (fx, fy) and its moment `couple`.
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

/// Returns right − J a for the accelerations `a` of the clusters.
template <class S> STEPLAP_INLINE S less_accelerations(const SchurRowOf<S>& row, S right, const S* a) {
  for (int side = 0; side < 2; ++side) {
    if (row.body[side] < 0) continue;
    const S* const ak = a + 3 * row.body[side];
    const S* const j = row.j[side];
    right -= row.is_constant ? j[2] * ak[2] : j[0] * ak[0] + j[1] * ak[1] + j[2] * ak[2];
  }
  return right;
}

/// Computes J and W J of a row between bodies that are alone in their clusters, or the ground. Returns γ.
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

/// Adds the centripetal term to the bias, for a body at distance `off` from its cluster's centre: if the cluster has no acceleration, the
/// body has the acceleration −ω² off.
template <class S> STEPLAP_INLINE void add_centripetal(int side, const Pair<S>& direction, const S& omega, const Pair<S>& off, S& bias) {
  const S term = omega * omega * dot(direction, off);
  if (side == 0) bias -= term;
  else bias += term;
}

/// Returns the measure with its vectors rotated from b's axes to ground axes.
template <class S> [[nodiscard]] STEPLAP_INLINE MeasureValue<S> turned(MeasureValue<S> m, const Motion<S>& b) {
  for (Pair<S>* p : {&m.direction, &m.lever_a, &m.lever_b}) *p = {b.c * p->x - b.s * p->y, b.s * p->x + b.c * p->y};
  return m;
}

/// Sets J and W J of a row, or of one part of it, from its measure m in ground axes. With `WithBias`, m.bias becomes the bias in the
/// coordinates of the clusters.
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

/// Computes J and W J of an active row with any measure. Returns the measure. Precondition: row.body and row.w are set.
template <bool WithBias, class S>
STEPLAP_INLINE MeasureValue<S> load_row(const Layout& layout, const ActiveRow& active, const Motion<S>* motion, SchurRowOf<S>& row) {
  const Motion<S>& link = motion[active.link];
  if (row.is_constant) { // gradient of an angle, set by make_layout
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

/// Computes J and W J of an active row, for an evaluation of accelerations. Returns γ.
template <class S> STEPLAP_INLINE S pull_row(const Layout& layout, const ActiveRow& active, const Motion<S>* motion, SchurRowOf<S>& row) {
  if (active.pull == RowPullKind::angle) return S(0.0);
  if (active.pull == RowPullKind::other) return -load_row<true>(layout, active, motion, row).bias;
  return pull_simple_row(active, row, motion);
}

/// Computes J and W J of part i of the rows over more than two bodies, and returns its measure. With `WithBias`, its bias is that in the
/// coordinates of the clusters.
template <bool WithBias, class S>
STEPLAP_INLINE MeasureValue<S> load_part(const Layout& layout, std::size_t i, const Motion<S>* motion, SchurRowOf<S>* rows) {
  const RowSpec& part = *layout.part_specs[i];
  MeasureValue<S> m = evaluate_row<WithBias>(part, motion[part.a], motion[part.b]);
  put_in_clusters<WithBias>(layout, part, motion, m, rows[layout.parts[i].row]);
  return m;
}

/// Computes all parts of rows over more than two bodies, and adds their contributions to γ in `right`.
template <class S> void pull_parts(const Layout& layout, const Motion<S>* motion, SchurRowOf<S>* rows, S* right) {
  for (std::size_t i = 0; i < layout.parts.size(); ++i) right[layout.parts[i].of] -= load_part<true>(layout, i, motion, rows).bias;
}

/// Subtracts the contributions of the further parts of rows to J a from `right`, for the accelerations `a` of the clusters.
template <class S> void subtract_part_accelerations(const Layout& layout, const SchurRowOf<S>* rows, const S* a, S* right) {
  for (const SchurPart& part : layout.parts) right[part.of] = less_accelerations(rows[part.row], right[part.of], a);
}

/// Adds the contributions of the further parts of rows to W Jᵀ λ to the accelerations `a`.
template <class S> void add_part_responses(const Layout& layout, const SchurRowOf<S>* rows, const S* lambda, S* a) {
  for (const SchurPart& part : layout.parts) {
    const SchurRowOf<S>& row = rows[part.row];
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0)
        for (int c = 0; c < 3; ++c) a[3 * row.body[side] + c] += row.wj[side][c] * lambda[part.of];
  }
}

/// Adds W Jᵀ λ of one side of a row to the accelerations `a`. A constant row acts on θ only.
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

// What a constraint row does to accelerations: its gradient and bias, seen from b and not from the ground. The same
// as evaluate_row gives, without the value and the rate, which no acceleration needs.
#pragma once

#include "mbd/system/row.h"
#include "mbd/dynamics/schur.h"

namespace steplap {

struct RowPull {
  Pair<double> direction;
  double couple_a, couple_b; // of the unit force on a, about a's and b's centre of gravity
  double bias;
};

STEPLAP_INLINE RowPull pull_along_axis(const RowSpec& row, const Motion<double>& link) {
  RowPull p;
  const Pair<double> lever = to_ground(link, row.point_a);
  p.direction = {row.direction.x(), row.direction.y()};
  p.couple_a = cross(lever, p.direction);
  p.couple_b = p.couple_a + cross(Pair<double>{link.x, link.y}, p.direction);
  p.bias = -(link.omega * link.omega) * dot(p.direction, lever);
  return p;
}

STEPLAP_INLINE RowPull pull_along_slide(const RowSpec& row, const Motion<double>& link) {
  const MeasureValue<double> m = SlideMeasure{row.point_a, row.point_b, row.direction, row.contact_axis, true}
                                     .at<true>(link, Origin{});
  return {m.direction, cross(m.lever_a, m.direction), cross(m.lever_b, m.direction), m.bias};
}

/// Fills one side of a row in the clusters' coordinates.
STEPLAP_INLINE void set_gradient(SchurRow& row, int side, double fx, double fy, double couple) {
  const double* const w = row.w[side];
  double* const j = row.j[side];
  double* const wj = row.wj[side];
  const double wx = w[0] * fx, wy = w[1] * fy, wm = w[2] * couple;
  j[0] = fx;
  j[1] = fy;
  j[2] = couple;
  wj[0] = wx;
  wj[1] = wy;
  wj[2] = wm;
}

/// What is left of `right` where the accelerations of the clusters are `a`: right − J a.
STEPLAP_INLINE double less_accelerations(const SchurRow& row, double right, const double* a) {
  for (int side = 0; side < 2; ++side) {
    if (row.body[side] < 0) continue;
    const double* const ak = a + 3 * row.body[side];
    const double* const j = row.j[side];
    right -= row.is_constant ? j[2] * ak[2] : j[0] * ak[0] + j[1] * ak[1] + j[2] * ak[2];
  }
  return right;
}

} // namespace steplap

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

// SlideMeasure. With the shaft s, a unit vector, α = n·s and the gap δ along it, the unit force on a is g = −ẑ×s/α at the tip,
// r − δ s from a's centre if r is the contact's point; r·s and r×s are fixed in a:
//   couple on a = (δ − r·s)/α,  rate = g·v + ω · couple,  bias = ω (2 (v·s − rate β) + ω r×s)/α,  β = s × n
STEPLAP_INLINE RowPull pull_along_slide(const RowSpec& row, const Motion<double>& link) {
  RowPull p;
  const Pair<double> s = to_ground(link, row.contact_axis), r = to_ground(link, row.point_a);
  const Pair<double> n{row.direction.x(), row.direction.y()}, v{link.vx, link.vy};
  const double inverse = 1.0 / dot(n, s);
  const double gap = inverse * (n.x * (link.x + r.x - row.point_b.x()) + n.y * (link.y + r.y - row.point_b.y()));
  p.direction = {inverse * s.y, -(inverse * s.x)};
  p.couple_a = inverse * (gap - dot(r, s));
  p.couple_b = p.couple_a + cross(Pair<double>{link.x, link.y}, p.direction);
  const double rate = dot(p.direction, v) + link.omega * p.couple_a;
  p.bias = inverse * link.omega * (2.0 * (dot(v, s) - rate * cross(s, n)) + link.omega * cross(r, s));
  return p;
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

// Dynamics: from the poses and rates of bodies to the coordinates that are integrated, those of clusters, and back.
#include "mbd/dynamics/dynamics.h"

#include <algorithm>

namespace steplap {

void Dynamics::pack(const State& state, double* y) const {
  const int n = coordinate_count();
  std::fill(y, y + 2 * n, 0.0);
  for (std::size_t i = 1; i < layout_->placements.size(); ++i) {
    const Placement& place = layout_->placements[i];
    const Cluster& cluster = layout_->clusters[place.cluster];
    double* q = y + 3 * place.cluster;
    double* v = q + n;
    const double* bq = &state.q[3 * i];
    const double* bv = &state.v[3 * i];
    if (place.is_alone) {
      std::copy(bq, bq + 3, q);
      std::copy(bv, bv + 3, v);
      continue;
    }
    // The root's angle turns the cluster; momentum decides its rates (exact for a rigid motion).
    if (static_cast<int>(i) == cluster.root) q[2] = bq[2];
    const double share = system_.bodies[i].mass / cluster.mass;
    const Vec2 lever = rotated(place.offset, state.q[3 * cluster.root + 2]);
    q[0] += share * bq[0];
    q[1] += share * bq[1];
    v[0] += share * bv[0];
    v[1] += share * bv[1];
    v[2] += (system_.bodies[i].inertia * bv[2] +
             system_.bodies[i].mass * (lever.x() * bv[1] - lever.y() * bv[0])) / cluster.inertia;
  }
  // Angular momentum was taken about the cluster's centre, where Σ m lever = 0: no correction is due.
  double* const rest = std::copy(state.inner.begin(), state.inner.end(), y + 2 * n);
  rest[0] = state.dissipated;
  rest[1] = state.work;
}

void Dynamics::unpack(double t, const double* y, State& state) const {
  const int n = coordinate_count();
  state.t = t;
  for (std::size_t i = 1; i < layout_->placements.size(); ++i) {
    const Placement& place = layout_->placements[i];
    const double* q = y + 3 * place.cluster;
    const double* v = q + n;
    double* bq = &state.q[3 * i];
    double* bv = &state.v[3 * i];
    std::copy(q, q + 3, bq);
    std::copy(v, v + 3, bv);
    if (place.is_trivial) continue;
    const Vec2 lever = rotated(place.offset, q[2]);
    bq[0] += lever.x();
    bq[1] += lever.y();
    bq[2] += place.angle;
    bv[0] -= v[2] * lever.y();
    bv[1] += v[2] * lever.x();
  }
  const double* const rest = y + 2 * n + inner_count();
  std::copy(y + 2 * n, rest, state.inner.begin());
  state.dissipated = rest[0];
  state.work = rest[1];
}

} // namespace steplap

// Dynamics: conversion between the poses and velocities of bodies and the coordinates that are integrated.
#include "mbd/dynamics/dynamics.h"

#include <algorithm>

namespace steplap {

// Writes the coordinates of clusters to y. Those in mechanisms are converted from `all_q` and `all_v`, 3 numbers for each cluster.
void Dynamics::pack(const State& state, double* y) const {
  const int n = coordinate_count();
  std::fill(y, y + 2 * n, 0.0);
  double* all_q = y;
  double* all_v = y + n;
  if (layout_->has_mechanisms()) {
    const std::size_t count = 3 * layout_->clusters.size();
    cluster_q_.assign(count, 0.0);
    cluster_v_.assign(count, 0.0);
    all_q = cluster_q_.data();
    all_v = cluster_v_.data();
  }
  for (std::size_t i = 1; i < layout_->placements.size(); ++i) {
    const Placement& place = layout_->placements[i];
    const Cluster& cluster = layout_->clusters[place.cluster];
    double* q = all_q + 3 * place.cluster;
    double* v = all_v + 3 * place.cluster;
    const double* bq = &state.q[3 * i];
    const double* bv = &state.v[3 * i];
    if (place.is_alone) {
      std::copy(bq, bq + 3, q);
      std::copy(bv, bv + 3, v);
      continue;
    }
    // The angle of a cluster is that of its root. Its velocity conserves the momentum of the bodies, and is exact for a rigid motion.
    if (static_cast<int>(i) == cluster.root) q[2] = bq[2];
    const double share = system_.bodies[i].mass / cluster.mass;
    const Vec2 lever = rotated(place.offset, state.q[3 * cluster.root + 2]);
    q[0] += share * bq[0];
    q[1] += share * bq[1];
    v[0] += share * bv[0];
    v[1] += share * bv[1];
    v[2] += (system_.bodies[i].inertia * bv[2] + system_.bodies[i].mass * (lever.x() * bv[1] - lever.y() * bv[0])) / cluster.inertia;
  }
  // Angular momentum needs no further term: it refers to the cluster's centre, where Σ m lever = 0.
  if (layout_->has_mechanisms()) {
    std::copy_n(all_q, 3 * layout_->absolute_count, y);
    std::copy_n(all_v, 3 * layout_->absolute_count, y + n);
    for (Mechanism& m : layout_->mechanisms) m.pack(all_q, all_v, y + m.first_coordinate, y + n + m.first_coordinate);
  }
  double* const rest = std::copy(state.inner.begin(), state.inner.end(), y + 2 * n);
  rest[0] = state.dissipated;
  rest[1] = state.work;
}

void Dynamics::unpack(double t, const double* y, State& state) const {
  const int n = coordinate_count();
  state.t = t;
  const double* all_q = y;
  const double* all_v = y + n;
  if (layout_->has_mechanisms()) {
    const std::size_t absolute = 3 * static_cast<std::size_t>(layout_->absolute_count);
    cluster_q_.resize(3 * layout_->clusters.size());
    cluster_v_.resize(cluster_q_.size());
    std::copy_n(y, absolute, cluster_q_.begin());
    std::copy_n(y + n, absolute, cluster_v_.begin());
    all_q = cluster_q_.data();
    all_v = cluster_v_.data();
    for (Mechanism& m : layout_->mechanisms)
      m.unpack(y + m.first_coordinate, y + n + m.first_coordinate, cluster_q_.data(), cluster_v_.data());
  }
  for (std::size_t i = 1; i < layout_->placements.size(); ++i) {
    const Placement& place = layout_->placements[i];
    const double* q = all_q + 3 * place.cluster;
    const double* v = all_v + 3 * place.cluster;
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
  record_rank(state);
}

const double* Dynamics::cluster_rates(const double* y) {
  const int n = coordinate_count();
  if (!layout_->has_mechanisms()) return y + n;
  cluster_q_.resize(3 * layout_->clusters.size());
  cluster_v_.resize(cluster_q_.size());
  std::copy_n(y, 3 * layout_->absolute_count, cluster_q_.begin());
  std::copy_n(y + n, 3 * layout_->absolute_count, cluster_v_.begin());
  for (const Mechanism& m : layout_->mechanisms)
    m.unpack(y + m.first_coordinate, y + n + m.first_coordinate, cluster_q_.data(), cluster_v_.data());
  return cluster_v_.data();
}

const double* Dynamics::cluster_accelerations(const double* dy) {
  const double* const a = dy + coordinate_count();
  if (!layout_->has_mechanisms()) return a;
  ensure_byproducts();
  std::copy_n(a, 3 * layout_->absolute_count, cluster_a_.begin());
  for (const Mechanism& m : layout_->mechanisms) m.expand(a + m.first_coordinate, cluster_a_.data());
  return cluster_a_.data();
}

} // namespace steplap

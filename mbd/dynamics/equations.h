// The equations of one evaluation as templates, for doubles or recorded numbers (mbd/tape):
//
//   M a = Q(q, v, t) + Jᵀλ,  J a = γ            (27), (29)–(31)
//
// The functions are in the order in which Dynamics::rates_at and the tracer (traced_evaluation.cpp) call them. The layout defines all
// indices. The caller owns the arrays: motions and forces per slot; gradients, γ and multipliers per active row; accelerations per
// coordinate. The caller also solves for the multipliers and manages factorisations (schur.h, mechanism.h).
#pragma once

#include "mbd/dynamics/row_pull.h"
#include "mbd/tape/traced.h"

#include <cstddef>

namespace steplap {

// --- positions and velocities --------------------------------------------------------------------------

/// Computes the motion m of a body from the motion k of its cluster.
template <class S> STEPLAP_INLINE void place_in_cluster(const Placement& place, const Motion<S>& k, Motion<S>& m) {
  const Pair<S> lever = to_ground(k, place.offset);
  m.x = k.x + lever.x;
  m.y = k.y + lever.y;
  m.theta = k.theta + place.angle;
  m.c = k.c * place.c - k.s * place.s;
  m.s = k.s * place.c + k.c * place.s;
  m.vx = k.vx - k.omega * lever.y;
  m.vy = k.vy + k.omega * lever.x;
  m.omega = k.omega;
}

/// Computes the motions of the listed bodies, whose motions differ from those of their clusters.
template <class S> STEPLAP_INLINE void place_members(const Layout& layout, const std::vector<int>& members, Motion<S>* motion) {
  for (const int i : members) {
    const Placement& place = layout.placements[i];
    place_in_cluster(place, motion[layout.clusters[place.cluster].motion], motion[i]);
  }
}

/// Computes the motion of a cluster in absolute coordinates; q and v have 3 numbers each.
template <class S> STEPLAP_INLINE void place_cluster(const S* q, const S* v, Motion<S>& m) {
  m.x = q[0];
  m.y = q[1];
  m.vx = v[0];
  m.vy = v[1];
  m.omega = v[2];
  set_angle(m, q[2]);
}

/// Sets a coordinate that a drive prescribes, and its rate, in the motion of a cluster.
template <class S> STEPLAP_INLINE void place_locked(int coordinate, const S& value, const S& rate, Motion<S>& m) {
  if (coordinate == 2) set_angle(m, value);
  else (coordinate == 0 ? m.x : m.y) = value;
  (coordinate == 0 ? m.vx : coordinate == 1 ? m.vy : m.omega) = rate;
}

/// Computes all motions that forces and rows need, from the coordinates q and rates v of the layout. target(i) returns the prescribed
/// value, rate and acceleration of lock i. Precondition: the motions of mechanisms are computed.
template <class S, class F>
STEPLAP_INLINE void place_all(const Layout& layout, const S* q, const S* v, const F& target, Motion<S>* motion) {
  for (int k = 0; k < layout.absolute_count; ++k) place_cluster(q + 3 * k, v + 3 * k, motion[layout.slots[k]]);
  for (std::size_t i = 0; i < layout.locks.size(); ++i) {
    const Lock& lock = layout.locks[i];
    const auto& of_lock = target(i);
    place_locked(lock.coordinate, of_lock.value, of_lock.rate, motion[layout.slots[lock.cluster]]);
  }
  place_members(layout, layout.riding, motion);
  for (const ActiveLink& link : layout.links) motion[link.slot] = seen_from(motion[link.a], motion[link.b]);
}

// --- forces -------------------------------------------------------------------------------------------

/// The rows of a sliding friction element, one or three, with the slip velocities along them.
template <class S> struct SlidingRows {
  int count = 0;
  MeasureValue<S> measure[3];
  S rate[3];

  /// `motion` is that of body a relative to body b.
  STEPLAP_INLINE SlidingRows(const RowSpec* rows, int count_, const Motion<S>& motion) : count(count_) {
    for (int r = 0; r < count; ++r) {
      measure[r] = evaluate_row<false>(rows[r], motion, Origin{});
      rate[r] = measure[r].rate;
    }
  }
  /// Adds the slip law's wrench w to the force on the link, and the power −w·rate to `dissipation`.
  STEPLAP_INLINE void pull(const S* wrench, BodyForceOf<S>& link_force, S& dissipation) const {
    for (int r = 0; r < count; ++r) {
      apply_force(link_force, measure[r], wrench[r]);
      dissipation -= wrench[r] * rate[r];
    }
  }
};

/// Adds the forces on links to those on their bodies, and the forces on bodies to those on their clusters. Forces that are zero in this
/// layout are skipped: links that only rows use, or with open contacts only.
template <class S> STEPLAP_INLINE void gather_forces(const Layout& layout, const Motion<S>* motion, BodyForceOf<S>* force) {
  for (const ActiveLink& link : layout.links) {
    const BodyForceOf<S>& f = force[link.slot];
    if (is_structural_zero(f.fx) && is_structural_zero(f.fy) && is_structural_zero(f.m)) continue;
    add_link_force(f, motion[link.slot], motion[link.b], force[link.a], force[link.b]);
  }
  for (const int i : layout.riding) {
    const int slot = layout.slots[layout.placements[i].cluster];
    add_member_force(force[i], motion[i], motion[slot], force[slot]);
  }
}

// --- accelerations ------------------------------------------------------------------------------------

/// Computes a = W (m g + Q) for clusters in absolute coordinates, (27) without rows, and sets the accelerations of locked coordinates,
/// which target(i) returns for lock i.
template <class S, class F>
STEPLAP_INLINE void accelerate_clusters(const Layout& layout, const BodyForceOf<S>* force, const F& target, S* a) {
  const double *weight = layout.weight.data(), *w = layout.inverse_mass.data();
  S* out = a;
  for (int k = 0; k < layout.absolute_count; ++k, out += 3, w += 3, weight += 3) {
    const BodyForceOf<S>& f = force[layout.slots[k]];
    out[0] = w[0] * (weight[0] + f.fx);
    out[1] = w[1] * (weight[1] + f.fy);
    out[2] = w[2] * (weight[2] + f.m);
  }
  for (std::size_t i = 0; i < layout.locks.size(); ++i)
    a[3 * layout.locks[i].cluster + layout.locks[i].coordinate] = target(i).acceleration;
}

/// Computes the gradients of the rows `first` ≤ r < `end`, and their γ (29).
template <class S>
STEPLAP_INLINE void pull_rows(const Layout& layout, std::size_t first, std::size_t end, const Motion<S>* motion, SchurRowOf<S>* rows,
                              S* gamma) {
  for (std::size_t r = first; r < end; ++r) gamma[r] = pull_row(layout, layout.active[r], motion, rows[r]);
}

/// Subtracts J a from γ, with a = `cluster_a` the accelerations without rows (30).
template <class S>
STEPLAP_INLINE void take_accelerations(const SchurRowOf<S>* rows, std::size_t first, std::size_t end, const S* cluster_a, S* gamma) {
  for (std::size_t r = first; r < end; ++r) gamma[r] = less_accelerations(rows[r], gamma[r], cluster_a);
}

// --- power --------------------------------------------------------------------------------------------

/// Returns the force of the drive on a locked coordinate, from the equation of motion of its cluster. `f`: force on the cluster; `lambda`
/// and `rows` per active row.
template <class S>
[[nodiscard]] STEPLAP_INLINE S missing_force(const Layout& layout, const Lock& lock, const BodyForceOf<S>& f, const S* a,
                                             const SchurRowOf<S>* rows, const S* lambda) {
  const int k = 3 * lock.cluster + lock.coordinate;
  const Cluster& cluster = layout.clusters[lock.cluster];
  S force = (lock.coordinate < 2 ? cluster.mass : cluster.inertia) * a[k] - layout.weight[k] -
            (lock.coordinate == 0   ? f.fx
             : lock.coordinate == 1 ? f.fy
                                    : f.m);
  for (const LockedTerm& term : lock.terms) force -= rows[term.row].j[term.side][lock.coordinate] * lambda[term.multiplier];
  return force;
}

/// Adds the power of drives to `work`: force times prescribed rate. row_rate(i) returns the rate of driven row i, target(i) that of lock i.
template <class S, class R, class F>
STEPLAP_INLINE void add_power_of_drives(const Layout& layout, const BodyForceOf<S>* force, const SchurRowOf<S>* rows, const S* lambda,
                                        const S* a, const R& row_rate, const F& target, S& work) {
  S of_rows(0.0);
  for (std::size_t i = 0; i < layout.driven_rows.size(); ++i) of_rows += lambda[layout.driven_rows[i]] * row_rate(i);
  work += of_rows;
  for (std::size_t i = 0; i < layout.locks.size(); ++i) {
    const Lock& lock = layout.locks[i];
    work += missing_force(layout, lock, force[layout.clusters[lock.cluster].motion], a, rows, lambda) * target(i).rate;
  }
}

} // namespace steplap

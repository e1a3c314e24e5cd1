// Wrenches in the rigid joints inside clusters, in the axes of the cluster. By the Newton–Euler method, from the leaves of each cluster to
// its root: the inertial wrench of a body minus the known forces on it must come from its joint to the parent. Templates for doubles and
// recorded numbers (mbd/tape).
#pragma once

#include "mbd/dynamics/layout.h"

#include <vector>

namespace steplap {

/// Computes the geometry of all joints inside clusters for the present contact points and anchors, one entry per edge.
void compute_edge_geometry(const System& system, const Layout& layout, const State& state, std::vector<EdgeGeometry>& edges);

/// Returns the wrench that joints must exert on a member of a cluster: its inertial wrench m (R a_c + α ẑ×r − ω² r − g) minus the force f
/// on it, with R the rotation to the cluster's axes. `k` and `a` are motion and accelerations of the cluster.
template <class S>
STEPLAP_INLINE BodyForceOf<S> member_lack(const BodyData& body, const Placement& place, const Vec2& gravity, const Motion<S>& k, const S* a,
                                          const BodyForceOf<S>& f) {
  const S fx = body.mass * (a[0] - gravity.x()) - f.fx, fy = body.mass * (a[1] - gravity.y()) - f.fy;
  const Pair<S> at_centre{k.c * fx + k.s * fy, k.c * fy - k.s * fx};
  const S turning = body.mass * a[2], centripetal = body.mass * k.omega * k.omega;
  const double x = place.offset.x(), y = place.offset.y();
  return {at_centre.x - turning * y - centripetal * x, at_centre.y + turning * x - centripetal * y, body.inertia * a[2] - f.m};
}

/// Subtracts the force of an active row, or of one part of it, from the wrenches that joints must exert on the row's bodies.
template <class S>
void take_carried(const Layout& layout, const RowSpec& spec, const S& lambda, const Motion<S>* motion, BodyForceOf<S>* lack) {
  const int body[2] = {spec.a, spec.b};
  if (!layout.is_carried[body[0]] && !layout.is_carried[body[1]]) return;
  const MeasureValue<S> m = evaluate_row<false>(spec, motion[spec.a], motion[spec.b]);
  for (int side = 0; side < 2; ++side) {
    if (!layout.is_carried[body[side]]) continue;
    const S f = side == 0 ? -lambda : lambda;
    const Motion<S>& k = motion[layout.clusters[layout.placements[body[side]].cluster].motion];
    const S fx = f * m.direction.x, fy = f * m.direction.y;
    BodyForceOf<S>& w = lack[body[side]];
    w.fx += k.c * fx + k.s * fy;
    w.fy += k.c * fy - k.s * fx;
    w.m += f * (cross(side == 0 ? m.lever_a : m.lever_b, m.direction) + m.couple);
  }
}

/// Computes, for each member of a cluster that a joint carries, the wrench that joints must exert on it: inertia minus forces minus active
/// rows. `cluster_a` has 3 numbers per cluster, `lambda` one per active row.
template <class S>
void find_lacks(const System& system, const Layout& layout, const Motion<S>* motion, const BodyForceOf<S>* force, const S* cluster_a,
                const S* lambda, BodyForceOf<S>* lack) {
  for (const RigidEdge& edge : layout.edges) {
    const Placement& place = layout.placements[edge.child];
    const Motion<S>& k = motion[layout.clusters[place.cluster].motion];
    lack[edge.child] = member_lack(system.bodies[edge.child], place, system.gravity, k, cluster_a + 3 * place.cluster, force[edge.child]);
  }
  for (const int r : layout.carried_rows)
    for (const RowSpec* part = layout.active[r].spec; part; part = part->next) take_carried(layout, *part, lambda[r], motion, lack);
}

/// Adds the wrenches on members up from children to parents. Calls bears(edge, along) for each joint, with its wrench on the rows' body a
/// about the joint's point, along the joint's rows (two axes fixed in b, then the angle).
template <class S, class F>
STEPLAP_INLINE void hand_on_lack(const Layout& layout, const std::vector<EdgeGeometry>& edges, BodyForceOf<S>* lack, const F& bears) {
  for (std::size_t e = 0; e < layout.edges.size(); ++e) {
    const RigidEdge& edge = layout.edges[e];
    const EdgeGeometry& geometry = edges[e];
    const BodyForceOf<S>& on_child = lack[edge.child];
    const Pair<S> force{on_child.fx, on_child.fy};
    const S at_parent = on_child.m + cross<S>(geometry.lever, force); // moment about the parent's centre
    if (layout.is_carried[edge.parent]) {
      BodyForceOf<S>& w = lack[edge.parent];
      w.fx += force.x;
      w.fy += force.y;
      w.m += at_parent;
    }
    const double sign = geometry.is_child_a ? 1.0 : -1.0;
    const S along[3] = {sign * dot<S>(force, geometry.axis[0]), sign * dot<S>(force, geometry.axis[1]),
                        sign * ((geometry.is_child_a ? on_child.m : at_parent) - cross<S>(geometry.point, force))};
    bears(edge, along);
  }
}

} // namespace steplap

// Wrenches in the rigid joints inside clusters, by the Newton–Euler method from the leaves of each cluster to its root, in its axes: a
// joint carries the wrench missing in the equations of motion of the bodies beyond it. Templates over double and recorded numbers
// (mbd/tape).
#pragma once

#include "mbd/dynamics/layout.h"

#include <vector>

namespace steplap {

/// Computes the geometry of all joints inside clusters for the present contact points and anchors, one entry per edge.
void compute_edge_geometry(const System& system, const Layout& layout, const State& state, std::vector<EdgeGeometry>& edges);

/// Returns the wrench missing in the equation of motion of a member of a cluster: m (R a_c + α ẑ×r − ω² r − g) minus the forces on it, with
/// R the rotation to the cluster's axes. `k` and `a` are motion and accelerations of the cluster, `f` is the force on the member.
template <class S>
STEPLAP_INLINE BodyForceOf<S> member_lack(const BodyData& body, const Placement& place, const Vec2& gravity, const Motion<S>& k, const S* a,
                                          const BodyForceOf<S>& f) {
  const S fx = body.mass * (a[0] - gravity.x()) - f.fx, fy = body.mass * (a[1] - gravity.y()) - f.fy;
  const Pair<S> at_centre{k.c * fx + k.s * fy, k.c * fy - k.s * fx};
  const S turning = body.mass * a[2], centripetal = body.mass * k.omega * k.omega;
  const double x = place.offset.x(), y = place.offset.y();
  return {at_centre.x - turning * y - centripetal * x, at_centre.y + turning * x - centripetal * y, body.inertia * a[2] - f.m};
}

/// Subtracts the force of an active row, or of a part of one, from the missing wrenches of its bodies.
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

/// Computes the missing wrench of each member of a cluster that a joint carries, per body: inertia minus forces minus active rows.
/// `cluster_a` has 3 numbers per cluster, `lambda` one per active row.
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

/// Passes the missing wrenches from children to parents. Calls bears(edge, along) with the wrench of each joint on the rows' body a about
/// the joint's point, along its rows (two axes fixed in b, then the angle).
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

#include "mbd/dynamics/reactions.h"

#include "mbd/dynamics/carriage.h"

#include <algorithm>
#include <cmath>

namespace steplap {

Reactions::Reactions(const System& system, const Kinematics& kinematics, const BodyForce* force)
    : system_(system), motion_(kinematics.motion().data()), force_(force), acceleration_(3 * system.bodies.size(), 0.0),
      wrench_(system.bodies.size()), row_force_(system.rows.size(), 0.0), friction_force_(system.friction_row_count, 0.0) {}

void Reactions::use(const Layout& layout, const State& state) {
  layout_ = &layout;
  state_ = &state;
  place_edges();
}

void Reactions::find_accelerations(const double* cluster_a) {
  const Layout& layout = *layout_;
  for (int i = 1; i < system_.body_count(); ++i) {
    const Placement& place = layout.placements[i];
    const double* a = cluster_a + 3 * place.cluster;
    double* out = &acceleration_[3 * i];
    std::copy(a, a + 3, out);
    if (place.is_trivial) continue;
    const Motion<double>& k = motion_[layout.clusters[place.cluster].motion];
    const Pair<double> lever = to_ground(k, place.offset);
    out[0] += -a[2] * lever.y - k.omega * k.omega * lever.x;
    out[1] += a[2] * lever.x - k.omega * k.omega * lever.y;
  }
}

double* Reactions::multipliers_of(const RigidEdge& edge) {
  if (edge.block >= 0) return &row_force_[system_.row_blocks[edge.block].first];
  return &friction_force_[system_.frictions[edge.friction].row];
}

// The joints inside clusters in their present places (rows of friction move to another foot, or anchor).
void Reactions::place_edges() {
  const Layout& layout = *layout_;
  edges_.resize(layout.edges.size());
  for (std::size_t e = 0; e < layout.edges.size(); ++e) {
    const RigidEdge& edge = layout.edges[e];
    const RowSpec* const rows =
        edge.block >= 0 ? &system_.rows[system_.row_blocks[edge.block].first]
                        : system_.frictions[edge.friction].friction->rows(state_->friction[edge.friction]);
    const auto turned = [](const Placement& p, const Vec2& local) {
      return Pair<double>{p.c * local.x() - p.s * local.y(), p.s * local.x() + p.c * local.y()};
    };
    const Vec2 lever = layout.placements[edge.child].offset - layout.placements[edge.parent].offset;
    const Placement& a = layout.placements[rows[0].a];
    const Placement& b = layout.placements[rows[0].b];
    EdgeGeometry& geometry = edges_[e];
    geometry.lever = {lever.x(), lever.y()};
    for (int r = 0; r < 2; ++r) geometry.axis[r] = turned(b, rows[r].direction);
    geometry.point = turned(a, rows[0].point_a);
    geometry.is_child_a = rows[0].a == edge.child;
  }
}

// Takes what a row, or a part of one, bears from the wrench balance of the members of clusters that it acts on.
void Reactions::add_carried(const RowSpec& spec, double lambda) {
  const Layout& layout = *layout_;
  const int body[2] = {spec.a, spec.b};
  if (!layout.is_carried[body[0]] && !layout.is_carried[body[1]]) return;
  const auto m = evaluate_row<false>(spec, motion_[spec.a], motion_[spec.b]);
  for (int side = 0; side < 2; ++side) {
    if (!layout.is_carried[body[side]]) continue;
    const double f = side == 0 ? -lambda : lambda;
    const Motion<double>& k = motion_[layout.clusters[layout.placements[body[side]].cluster].motion];
    const double fx = f * m.direction.x, fy = f * m.direction.y;
    BodyForce& w = wrench_[body[side]];
    w.fx += k.c * fx + k.s * fy;
    w.fy += k.c * fy - k.s * fx;
    w.m += f * (cross(side == 0 ? m.lever_a : m.lever_b, m.direction) + m.couple);
  }
}

// Multipliers of the pins and rods of mechanisms, which are no rows of theirs: what hangs on them lacks so much.
void Reactions::find_pins(const double* cluster_a, const double* lambda) {
  const Layout& layout = *layout_;
  if (layout.carriages) find_guides(cluster_a);
  for (const Mechanism& mechanism : layout.mechanisms) {
    mechanism.pin_forces(cluster_a, force_, layout.schur_rows.data() + mechanism.first_row, lambda + mechanism.first_row,
                         pin_force_);
    for (std::size_t i = 0; i < mechanism.members.size(); ++i) {
      const Member& m = mechanism.members[i];
      if (m.block < 0) continue;
      const RowBlock& block = system_.row_blocks[m.block];
      const Pair<double> force = pin_force_[i];
      if (m.is_rod_end) { // along the rod, whose end stays where it is whichever of the two bodies a is
        const Pair<double> along = mechanism.arm(static_cast<int>(i));
        row_force_[block.first] = dot(force, along) / std::sqrt(dot(along, along));
        continue;
      }
      for (int r = block.first; r < block.first + block.count; ++r) {
        const RowSpec& spec = system_.rows[r];
        const double on_a = dot(force, to_ground(motion_[spec.b], spec.direction));
        row_force_[r] = layout.placements[spec.a].cluster == m.cluster ? on_a : -on_a;
      }
    }
  }
}

// Multipliers of the guides of carriages: across the axis at the point where a is led, and the couple.
void Reactions::find_guides(const double* cluster_a) {
  const Layout& layout = *layout_;
  for (const Carriage& k : layout.carriages->carriages) {
    const RowSpec& spec = system_.rows[system_.row_blocks[k.block].first];
    const BodyForce held = layout.carriages->held_by(k, cluster_a, force_);
    const double sign = layout.placements[spec.a].cluster == k.cluster ? 1.0 : -1.0;
    const Pair<double> n = to_ground(motion_[spec.b], spec.direction);
    const Motion<double>& a = motion_[spec.a];
    const Pair<double> lever = offset(a, motion_[k.slot]) + to_ground(a, spec.point_a);
    double* const along = &row_force_[system_.row_blocks[k.block].first];
    along[0] = sign * (held.fx * n.x + held.fy * n.y);
    along[1] = sign * held.m - cross(lever, n) * along[0];
  }
}

// Newton–Euler from the leaves of each merged cluster, in its axes: what an edge carries is what its subtree lacks.
void Reactions::find_joints(const double* cluster_a, const double* lambda) {
  const Layout& layout = *layout_;
  const auto in_cluster = [](const Motion<double>& k, double x, double y) {
    return Pair<double>{k.c * x + k.s * y, k.c * y - k.s * x};
  };
  for (const RigidEdge& edge : layout.edges) {
    const BodyData& body = system_.bodies[edge.child];
    const Placement& place = layout.placements[edge.child];
    const Motion<double>& k = motion_[layout.clusters[place.cluster].motion];
    const double* const a = cluster_a + 3 * place.cluster;
    const BodyForce& f = force_[edge.child];
    // m (R a_c + α ẑ×r − ω² r − g) less the forces; R the same for all.
    const Pair<double> at_centre = in_cluster(k, body.mass * (a[0] - system_.gravity.x()) - f.fx,
                                              body.mass * (a[1] - system_.gravity.y()) - f.fy);
    const double turning = body.mass * a[2], centripetal = body.mass * k.omega * k.omega;
    const double x = place.offset.x(), y = place.offset.y();
    wrench_[edge.child] = {at_centre.x - turning * y - centripetal * x, at_centre.y + turning * x - centripetal * y,
                           body.inertia * a[2] - f.m};
  }
  for (const int r : layout.carried_rows)
    for (const RowSpec* part = layout.active[r].spec; part; part = part->next) add_carried(*part, lambda[r]);
  if (layout.is_carried_by_pins) {
    find_pins(cluster_a, lambda);
    for (const Mechanism& mechanism : layout.mechanisms)
      for (const Member& m : mechanism.members) {
        if (m.block < 0) continue;
        const RowBlock& block = system_.row_blocks[m.block];
        for (int r = block.first; r < block.first + block.count; ++r) add_carried(system_.rows[r], row_force_[r]);
      }
    if (layout.carriages)
      for (const Carriage& k : layout.carriages->carriages)
        for (int r = 0; r < 2; ++r) {
          const int row = system_.row_blocks[k.block].first + r;
          add_carried(system_.rows[row], row_force_[row]);
        }
  }
  for (std::size_t e = 0; e < layout.edges.size(); ++e) {
    const RigidEdge& edge = layout.edges[e];
    const EdgeGeometry& geometry = edges_[e];
    const BodyForce& on_child = wrench_[edge.child];
    const Pair<double> force{on_child.fx, on_child.fy};
    const double at_parent = on_child.m + cross(geometry.lever, force); // its couple about the parent's centre
    if (layout.is_carried[edge.parent]) {
      BodyForce& w = wrench_[edge.parent];
      w.fx += force.x;
      w.fy += force.y;
      w.m += at_parent;
    }
    // Along the rows (two axes fixed in b, then the angle): the wrench on a about the joint's point.
    const double sign = geometry.is_child_a ? 1.0 : -1.0;
    double* const along = multipliers_of(edge);
    along[0] = sign * dot(force, geometry.axis[0]);
    along[1] = sign * dot(force, geometry.axis[1]);
    along[2] = sign * ((geometry.is_child_a ? on_child.m : at_parent) - cross(geometry.point, force));
  }
}

double Reactions::of_lock(const Lock& lock, const double* a, const double* lambda) const {
  const Layout& layout = *layout_;
  const int carrier = layout.carriages ? layout.carriages->carrier_of_lock[&lock - layout.locks.data()] : -1;
  if (carrier < 0)
    return missing_force(layout, lock, force_[layout.clusters[lock.cluster].motion], a, layout.schur_rows.data(), lambda);
  double force = Carriages::lack(layout.carriages->carriers[carrier], lock.coordinate, a + 3 * lock.cluster);
  for (const LockedTerm& term : lock.terms)
    force -= layout.schur_rows[term.row].j[term.side][lock.coordinate] * lambda[term.multiplier];
  return force;
}

void Reactions::take_rows(const double* a, const double* lambda) {
  const Layout& layout = *layout_;
  for (std::size_t r = 0; r < layout.active.size(); ++r)
    if (layout.active[r].row >= 0) row_force_[layout.active[r].row] = lambda[r];
  for (const Lock& lock : layout.locks) row_force_[lock.row] = of_lock(lock, a, lambda);
  for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
    const FrictionPhase phase = state_->friction[f].phase;
    if (phase == FrictionPhase::stick || phase == FrictionPhase::slip) continue;
    const FrictionUnit& unit = system_.frictions[f];
    std::fill_n(&friction_force_[unit.row], unit.friction->dimension(), 0.0);
  }
}

} // namespace steplap

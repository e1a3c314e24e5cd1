#include "mbd/dynamics/reactions.h"

#include "mbd/dynamics/joint_wrench.h"

#include <algorithm>
#include <cmath>

namespace steplap {

Reactions::Reactions(const System& system, const Kinematics& kinematics, const BodyForce* force)
    : system_(system), motion_(kinematics.motion().data()), force_(force), acceleration_(3 * system.bodies.size(), 0.0),
      wrench_(system.bodies.size()), row_force_(system.rows.size(), 0.0), friction_force_(system.friction_row_count, 0.0) {}

void Reactions::use(const Layout& layout, const State& state) {
  layout_ = &layout;
  state_ = &state;
  compute_edge_geometry(system_, layout, state, edges_);
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

void compute_edge_geometry(const System& system, const Layout& layout, const State& state, std::vector<EdgeGeometry>& edges) {
  edges.resize(layout.edges.size());
  for (std::size_t e = 0; e < layout.edges.size(); ++e) {
    const RigidEdge& edge = layout.edges[e];
    const RowSpec* const rows = edge.block >= 0 ? &system.rows[system.row_blocks[edge.block].first]
                                                : system.frictions[edge.friction].friction->rows(state.friction[edge.friction]);
    const auto turned = [](const Placement& p, const Vec2& local) {
      return Pair<double>{p.c * local.x() - p.s * local.y(), p.s * local.x() + p.c * local.y()};
    };
    const Vec2 lever = layout.placements[edge.child].offset - layout.placements[edge.parent].offset;
    const Placement& a = layout.placements[rows[0].a];
    const Placement& b = layout.placements[rows[0].b];
    EdgeGeometry& geometry = edges[e];
    geometry.lever = {lever.x(), lever.y()};
    for (int r = 0; r < 2; ++r) geometry.axis[r] = turned(b, rows[r].direction);
    geometry.point = turned(a, rows[0].point_a);
    geometry.is_child_a = rows[0].a == edge.child;
  }
}

void Reactions::add_carried(const RowSpec& spec, double lambda) { take_carried(*layout_, spec, lambda, motion_, wrench_.data()); }

// Computes the forces of the pins and rods of mechanisms, which are not rows, from the equations of motion of the members.
void Reactions::find_pins(const double* cluster_a, const double* lambda) {
  const Layout& layout = *layout_;
  for (const Mechanism& mechanism : layout.mechanisms) {
    mechanism.pin_forces(cluster_a, force_, layout.schur_rows.data() + mechanism.first_row, lambda + mechanism.first_row, pin_force_);
    for (std::size_t i = 0; i < mechanism.members.size(); ++i) {
      const Member& m = mechanism.members[i];
      if (m.block < 0) continue;
      const RowBlock& block = system_.row_blocks[m.block];
      const Pair<double> force = pin_force_[i];
      if (m.is_rod_end) { // the force along the rod; which of its two bodies is a does not matter
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

void Reactions::find_joints(const double* cluster_a, const double* lambda) {
  const Layout& layout = *layout_;
  find_lacks(system_, layout, motion_, force_, cluster_a, lambda, wrench_.data());
  if (layout.is_carried_by_pins) {
    find_pins(cluster_a, lambda);
    for (const Mechanism& mechanism : layout.mechanisms)
      for (const Member& m : mechanism.members) {
        if (m.block < 0) continue;
        const RowBlock& block = system_.row_blocks[m.block];
        for (int r = block.first; r < block.first + block.count; ++r) add_carried(system_.rows[r], row_force_[r]);
      }
  }
  hand_on_lack(layout, edges_, wrench_.data(),
               [this](const RigidEdge& edge, const double* along) { std::copy_n(along, 3, multipliers_of(edge)); });
}

double Reactions::of_lock(const Lock& lock, const double* a, const double* lambda) const {
  return missing_force(*layout_, lock, force_[layout_->clusters[lock.cluster].motion], a, layout_->schur_rows.data(), lambda);
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

// Dynamics of a large scene: the evaluation part by part (parts.h), shared between threads.
//
// Where parts are separate each of them goes through all of it at once. Else they wait for each other: bodies before the links
// to them, links and elements before what they do to bodies of other parts, accelerations before multipliers.
#include "mbd/dynamics/dynamics.h"
#include "mbd/dynamics/parts.h"

namespace steplap {

// Elements of the part, on its links and on the bodies that the ground is linked to. Its bodies and links must be placed.
void Dynamics::apply_forces_of(int p) {
  const Layout& layout = *layout_;
  const Parts& division = *layout.division;
  const Part& part = division.parts[p];
  BodyForce* const force = force_.data();
  for (int k = part.clusters; k < part.clusters_end; ++k) force[layout.slots[k]] = {};
  for (int i = part.mechanisms; i < part.mechanisms_end; ++i) {
    const Mechanism& m = layout.mechanisms[i];
    for (int k = m.first_cluster; k < m.first_cluster + m.cluster_count(); ++k) force[layout.slots[k]] = {};
  }
  for (const int i : division.riding[p]) force[i] = {};
  for (int i = part.links; i < part.links_end; ++i) force[layout.links[i].slot] = {};
  Evaluation e = evaluation_; // what is summed in it is the part's
  for (std::size_t g = 0; g < division.elements.size(); ++g)
    if (const auto elements = division.elements[g][p]; !elements.empty()) system_.groups[g]->add_forces_of(elements, e);
  part_power_[p] = {e.dissipation, e.work};
}

void Dynamics::add_links_inside(int p) {
  const Part& part = layout_->division->parts[p];
  BodyForce* const force = force_.data();
  for (int i = part.links; i < part.links_inside; ++i) {
    const ActiveLink& link = layout_->links[i];
    const BodyForce& f = force[link.slot];
    if (f.fx == 0.0 && f.fy == 0.0 && f.m == 0.0) continue; // as in apply_forces
    add_link_force(f, motion_[link.slot], motion_[link.b], force[link.a], force[link.b]);
  }
}

// What links to other parts, and bodies that ride on clusters, do to the part's bodies.
void Dynamics::collect_forces_of(int p) {
  const Layout& layout = *layout_;
  BodyForce* const force = force_.data();
  for (const int place : layout.division->link_sides[p]) {
    const ActiveLink& link = layout.links[place / 2];
    const BodyForce& f = force[link.slot];
    if (f.fx == 0.0 && f.fy == 0.0 && f.m == 0.0) continue;
    if (place % 2 == 0) add_link_force_on_a(f, motion_[link.b], force[link.a]);
    else add_link_force_on_b(f, motion_[link.slot], motion_[link.b], force[link.b]);
  }
  for (const int i : layout.division->riding[p]) {
    const int slot = layout.slots[layout.placements[i].cluster];
    add_member_force(force[i], motion_[i], motion_[slot], force[slot]);
  }
}

// Without rows between clusters in absolute coordinates; those of mechanisms begin here.
void Dynamics::accelerate_part(int p, const double* y, double* dy) {
  const Layout& layout = *layout_;
  const Part& part = layout.division->parts[p];
  const int n = coordinate_count();
  double* const a = dy + n;
  const double* const weight = layout.weight.data();
  const double* const w = layout.inverse_mass.data();
  for (int k = part.clusters; k < part.clusters_end; ++k) {
    const BodyForce& f = force_[layout.slots[k]];
    a[3 * k] = w[3 * k] * (weight[3 * k] + f.fx);
    a[3 * k + 1] = w[3 * k + 1] * (weight[3 * k + 1] + f.fy);
    a[3 * k + 2] = w[3 * k + 2] * (weight[3 * k + 2] + f.m);
  }
  for (int i = part.coordinates; i < part.coordinates_end; ++i) dy[i] = y[n + i];
  for (const int i : layout.division->locks[p]) {
    const int k = 3 * layout.locks[i].cluster + layout.locks[i].coordinate;
    a[k] = kinematics_.lock_target(i).acceleration;
    dy[k] = kinematics_.lock_target(i).rate;
  }
  rows_.accelerate_part(p, force_.data(), a);
}

void Dynamics::rates_in_parts(double t, const double* y, double* dy) {
  const Layout& layout = *layout_;
  const Parts& division = *layout.division;
  const int count = division.count(), n = coordinate_count();
  kinematics_.begin(t);
  force_[k_ground] = {};
  const auto place = [&](int p) { kinematics_.place_part(p, y, y + n); };
  const bool are_links_last = !division.whole_groups.empty() || !layout.sliding.empty();
  const auto load = [&](int p) {
    kinematics_.place_links(p);
    rows_.pull_part(p);
    apply_forces_of(p);
    if (!are_links_last) add_links_inside(p);
  };
  const auto move = [&](int p) {
    if (are_links_last) add_links_inside(p);
    collect_forces_of(p);
    accelerate_part(p, y, dy);
  };
  if (division.are_separate && !are_links_last) {
    team_.each(count, [&](int p) {
      place(p);
      load(p);
      move(p);
    });
  } else {
    team_.each(count, place);
    team_.each(count, load);
    for (const int g : division.whole_groups) system_.groups[g]->add_forces(evaluation_);
    if (!layout.sliding.empty())
      team_.each(count, [this](int p) { apply_sliding_of(p); });
    team_.each(count, move);
  }
  for (int p = 0; p < count; ++p) {
    evaluation_.dissipation += part_power_[p].dissipation;
    evaluation_.work += part_power_[p].work;
  }
  rows_.solve_divided(t, dy + n);
  finish_divided_rates(y, dy);
}

double Dynamics::energy_in_parts(const double* y) {
  const Parts& division = *layout_->division;
  team_.each(division.count(), [&](int p) {
    const Part& part = division.parts[p];
    double sum = 0.0;
    const auto add = [&](int k) {
      const Cluster& c = layout_->clusters[k];
      const Motion<double>& m = motion_[c.motion];
      sum += 0.5 * c.mass * (m.vx * m.vx + m.vy * m.vy) + 0.5 * c.inertia * m.omega * m.omega;
      sum -= c.mass * (system_.gravity.x() * m.x + system_.gravity.y() * m.y);
    };
    for (int k = part.clusters; k < part.clusters_end; ++k) add(k);
    for (int i = part.mechanisms; i < part.mechanisms_end; ++i) {
      const Mechanism& m = layout_->mechanisms[i];
      for (int k = m.first_cluster; k < m.first_cluster + m.cluster_count(); ++k) add(k);
    }
    for (std::size_t g = 0; g < division.elements.size(); ++g)
      if (const auto elements = division.elements[g][p]; !elements.empty())
        sum += system_.groups[g]->potential_of(elements, motion_);
    part_power_[p].work = sum;
  });
  double energy = 0.0;
  for (int p = 0; p < division.count(); ++p) energy += part_power_[p].work;
  for (const int g : division.whole_groups) energy += system_.groups[g]->potential(motion_);
  for (const ForceGroup* group : system_.inner_groups) energy += group->inner_energy(motion_, y + 2 * coordinate_count());
  return energy;
}

} // namespace steplap

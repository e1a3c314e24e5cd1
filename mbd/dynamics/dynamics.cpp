#include "mbd/dynamics/dynamics.h"
#include "mbd/dynamics/row_pull.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace steplap {

namespace {

// Below this smallest pivot the rates of a stage are those of the nearest state on the constraints.
constexpr double k_placed_pivot = 1e-4;

// From b's axes into the ground's.
MeasureValue<double> turned(MeasureValue<double> m, const Motion<double>& b) {
  for (Pair<double>* p : {&m.direction, &m.lever_a, &m.lever_b})
    *p = {b.c * p->x - b.s * p->y, b.s * p->x + b.c * p->y};
  return m;
}

} // namespace

Dynamics::Dynamics(const System& system) : system_(system) {
  const std::size_t n = system.bodies.size();
  motion_.resize(n + system.links.slot_count()); // at most every body is a cluster's with a slot of its own
  force_.resize(motion_.size());
  contact_force_.assign(system.contact_count, 0.0);
  watch_.assign(system.watch_count, 1.0);
  watch_rate_.assign(system.watch_count, std::numeric_limits<double>::quiet_NaN());
  inner_ = system.initial_inner;
  acceleration_.assign(3 * n, 0.0);
  wrench_.resize(n);
  row_force_.assign(system.rows.size(), 0.0);
  friction_force_.assign(system.friction_row_count, 0.0);
  evaluation_.motion = motion_.data();
  evaluation_.force = force_.data();
  evaluation_.link_motion = motion_.data();
  evaluation_.link_force = force_.data();
  evaluation_.contact_force = contact_force_.data();
  evaluation_.watch = watch_.data();
  evaluation_.inner = inner_.data();
  evaluation_.watch_rate = watch_rate_.data();
  for (const FrictionUnit& unit : system.frictions) {
    scratch_.push_back(unit.friction->make_scratch());
    scratch_pointers_.push_back(scratch_.back().get());
  }
  evaluation_.scratch = scratch_pointers_.data();
}

void Dynamics::set_state(const State& state) {
  state_ = &state;
  evaluation_.mode = state.mode.data();
  evaluation_.friction = state.friction.data();
  evaluation_.memory = state.memory.data();
  is_factored_ = false;
  is_merged_near_ = was_merged_near_ = false;
  placed_time_ = lock_time_ = std::numeric_limits<double>::quiet_NaN();
  std::fill(watch_.begin(), watch_.end(), 1.0);
  layout_key(state, choice_, key_);
  for (const auto& layout : layouts_)
    if (layout->key == key_) {
      layout_ = layout.get();
      place_edges();
      decide_rank();
      return;
    }
  layouts_.push_back(std::make_unique<Layout>(make_layout(system_, state, choice_)));
  layout_ = layouts_.back().get();
  place_edges();
  std::vector<double> packed(dimension());
  pack(system_.initial_state(), packed.data());
  layout_->reference.assign(packed.begin(), packed.begin() + coordinate_count());
  if (placed_.size() < packed.size()) placed_.resize(packed.size());
  const std::size_t rows = layout_->active.size();
  if (right_side_.size() < rows) {
    right_side_.resize(rows);
    row_value_.resize(rows);
    row_rate_.resize(rows);
    target_rate_.resize(rows);
  }
  if (layout_->has_mechanisms()) cluster_a_.resize(3 * layout_->clusters.size());
  if (lock_target_.size() < layout_->locks.size()) lock_target_.resize(layout_->locks.size());
  decide_rank();
}

void Dynamics::decide_rank() {
  is_rank_new_ = !layout_->held_rows.empty();
  if (!is_rank_new_) return;
  layout_->schur.decide_rank(layout_->is_friction_row);
  for (Mechanism& m : layout_->mechanisms) m.decide_rank(layout_->is_friction_row.data() + m.first_row);
}

void Dynamics::set_time_limit(double limit) {
  time_cap_ = std::nextafter(limit, -std::numeric_limits<double>::infinity());
}

// --- one evaluation -----------------------------------------------------------------------------

// Targets of the driven coordinates: several evaluations of a step are at the same time.
void Dynamics::aim_locks(double t) {
  if (t == lock_time_) return;
  lock_time_ = t;
  for (std::size_t i = 0; i < layout_->locks.size(); ++i) {
    lock_target_[i] = row_target(system_.rows[layout_->locks[i].row], state_->memory.data(), t);
    lock_target_[i].value += layout_->locks[i].offset;
  }
}

void Dynamics::place(double t, const double* q, const double* v) {
  const Layout& layout = *layout_;
  placed_time_ = t;
  Motion<double>* const motion = motion_.data();
  for (Mechanism& m : layout_->mechanisms) m.place(q + m.first_coordinate, v + m.first_coordinate, motion);
  for (int k = 0; k < layout.absolute_count; ++k) {
    Motion<double>& m = motion[layout.slots[k]];
    m.x = q[0];
    m.y = q[1];
    m.vx = v[0];
    m.vy = v[1];
    m.omega = v[2];
    set_angle(m, q[2]);
    q += 3;
    v += 3;
  }
  aim_locks(t);
  for (std::size_t i = 0; i < layout.locks.size(); ++i) {
    const Lock& lock = layout.locks[i];
    const SignalJet& target = lock_target_[i];
    Motion<double>& m = motion[layout.slots[lock.cluster]];
    if (lock.coordinate == 2) set_angle(m, target.value);
    else (lock.coordinate == 0 ? m.x : m.y) = target.value;
    (lock.coordinate == 0 ? m.vx : lock.coordinate == 1 ? m.vy : m.omega) = target.rate;
  }
  for (const int i : layout.riding) place_member(i);
  for (const ActiveLink& link : layout.links) motion[link.slot] = seen_from(motion[link.a], motion[link.b]);
}

void Dynamics::take_inner(const double* inner) { std::copy_n(inner, inner_count(), inner_.begin()); }

bool Dynamics::is_placed(double t, const double* y) const {
  if (t != placed_time_) return false;
  const double* const v = y + coordinate_count();
  for (const Mechanism& m : layout_->mechanisms)
    if (!m.is_at(y + m.first_coordinate, v + m.first_coordinate)) return false;
  for (int k = 0; k < layout_->absolute_count; ++k) {
    const Motion<double>& m = motion_[layout_->slots[k]];
    const double* const qk = y + 3 * k;
    const double* const vk = v + 3 * k;
    if (m.x != qk[0] || m.y != qk[1] || m.theta != qk[2] || m.vx != vk[0] || m.vy != vk[1] || m.omega != vk[2]) return false;
  }
  return true;
}

// A body that moves with others: from its cluster's motion.
void Dynamics::place_member(int i) {
  const Placement& place = layout_->placements[i];
  if (place.is_trivial) return;
  const Motion<double>& k = motion_[layout_->clusters[place.cluster].motion];
  Motion<double>& m = motion_[i];
  const Pair<double> lever = to_ground(k, place.offset);
  m.x = k.x + lever.x;
  m.y = k.y + lever.y;
  m.theta = k.theta + place.angle;
  m.c = k.c * place.c - k.s * place.s;
  m.s = k.s * place.c + k.c * place.s;
  m.vx = k.vx - k.omega * lever.y;
  m.vy = k.vy + k.omega * lever.x;
  m.omega = k.omega;
}

void Dynamics::apply_sliding() {
  for (std::size_t i = 0; i < layout_->sliding.size(); ++i) {
    const int f = layout_->sliding[i], link = layout_->sliding_link[i];
    const FrictionUnit& unit = system_.frictions[f];
    const FrictionState& friction = state_->friction[f];
    const RowSpec* rows = unit.friction->rows(friction);
    const int n = unit.friction->dimension();
    MeasureValue<double> m[3];
    double rate[3], wrench[3];
    for (int r = 0; r < n; ++r) {
      m[r] = evaluate_row<false>(rows[r], motion_[link], Origin{});
      rate[r] = m[r].rate;
    }
    unit.friction->slip_wrench(evaluation_, friction, rate, wrench);
    for (int r = 0; r < n; ++r) {
      apply_force(force_[link], m[r], wrench[r]);
      evaluation_.dissipation -= wrench[r] * rate[r];
      friction_force_[unit.row + r] = wrench[r];
    }
    unit.friction->watch_slip(evaluation_, friction, rate, &watch_[unit.watch]);
  }
}

// Forces of all elements, on clusters and on the bodies that ride on them.
void Dynamics::apply_forces() {
  const Layout& layout = *layout_;
  BodyForce* const force = force_.data();
  std::memset(static_cast<void*>(force), 0, static_cast<std::size_t>(layout.slot_count) * sizeof(BodyForce));
  for (const auto& group : system_.groups) group->add_forces(evaluation_);
  if (!layout.sliding.empty()) apply_sliding();
  const Motion<double>* const motion = motion_.data();
  for (const ActiveLink& link : layout.links)
    add_link_force(force[link.slot], motion[link.slot], motion[link.b], force[link.a], force[link.b]);
  for (const int i : layout.riding) {
    const int slot = layout.slots[layout.placements[i].cluster];
    const BodyForce& f = force[i];
    BodyForce& sum = force[slot];
    sum.fx += f.fx;
    sum.fy += f.fy;
    sum.m += f.m + (motion[i].x - motion[slot].x) * f.fy - (motion[i].y - motion[slot].y) * f.fx;
  }
}

void Dynamics::to_clusters(const RowSpec& spec, const MeasureValue<double>& m, SchurRow& row) const {
  const int body[2] = {spec.a, spec.b};
  for (int side = 0; side < 2; ++side) {
    if (row.body[side] < 0) continue;
    const Placement& place = layout_->placements[body[side]];
    const Cluster& cluster = layout_->clusters[row.body[side]];
    Pair<double> lever = side == 0 ? m.lever_a : m.lever_b;
    if (!place.is_trivial) {
      const Motion<double>& k = motion_[cluster.motion];
      lever = lever + Pair<double>{motion_[body[side]].x - k.x, motion_[body[side]].y - k.y};
    }
    const double sign = side == 0 ? 1.0 : -1.0;
    double* j = row.j[side];
    j[0] = sign * m.direction.x;
    j[1] = sign * m.direction.y;
    j[2] = sign * (cross(lever, m.direction) + m.couple);
    for (int c = 0; c < 3; ++c) row.wj[side][c] = row.w[side][c] * j[c];
  }
}

// The second rate at zero accelerations of the clusters: a body off its cluster's centre has −ω² lever.
double Dynamics::cluster_bias(const RowSpec& spec, const MeasureValue<double>& m) const {
  double bias = m.bias;
  const int body[2] = {spec.a, spec.b};
  for (int side = 0; side < 2; ++side) {
    const Placement& place = layout_->placements[body[side]];
    if (place.cluster < 0 || place.is_trivial) continue;
    const Motion<double>& k = motion_[layout_->clusters[place.cluster].motion];
    const Pair<double> lever{motion_[body[side]].x - k.x, motion_[body[side]].y - k.y};
    const double term = k.omega * k.omega * dot(m.direction, lever);
    bias += side == 0 ? -term : term;
  }
  return bias;
}

// Row r at the placed motion: J and W J in the clusters' coordinates. Most rows are between bodies that
// are clusters of their own: no lever to add.
template <bool WithBias> STEPLAP_INLINE MeasureValue<double> Dynamics::load_row(std::size_t r) {
  const ActiveRow& active = layout_->active[r];
  SchurRow& row = layout_->schur_rows[r];
  const Motion<double>& link = motion_[active.link];
  if (row.is_constant) { // an angle: make_layout has filled in its gradient
    MeasureValue<double> m;
    m.value = link.theta;
    m.rate = link.omega;
    return m;
  }
  const Motion<double>& b = motion_[active.spec->b];
  MeasureValue<double> m = evaluate_row<WithBias>(*active.spec, link, Origin{});
  if constexpr (WithBias) m.bias += dot(m.direction, frame_acceleration(link, b.omega));
  if (!active.is_simple) {
    m = turned(m, b);
    to_clusters(*active.spec, m, row);
    if constexpr (WithBias) m.bias = cluster_bias(*active.spec, m);
    return m;
  }
  const double dx = b.c * m.direction.x - b.s * m.direction.y, dy = b.s * m.direction.x + b.c * m.direction.y;
  const auto fill = [&row](int side, double fx, double fy, double couple) {
    if (row.body[side] < 0) return;
    const double wx = row.w[side][0] * fx, wy = row.w[side][1] * fy, wm = row.w[side][2] * couple;
    row.j[side][0] = fx;
    row.j[side][1] = fy;
    row.j[side][2] = couple;
    row.wj[side][0] = wx;
    row.wj[side][1] = wy;
    row.wj[side][2] = wm;
  };
  fill(0, dx, dy, cross(m.lever_a, m.direction) + m.couple);
  fill(1, -dx, -dy, -(cross(m.lever_b, m.direction) + m.couple));
  return m;
}

// Values and rates of all active rows against their targets, for projection.
void Dynamics::evaluate_rows() {
  for (std::size_t r = 0; r < layout_->active.size(); ++r) {
    const SignalJet target = row_target(*layout_->active[r].spec, state_->memory.data(), evaluation_.t);
    const MeasureValue<double> m = load_row<false>(r);
    row_value_[r] = off_target(*layout_->active[r].spec, m.value, target.value);
    row_rate_[r] = m.rate - target.rate;
  }
  reduce_rows();
}

// Gradients of the rows of mechanisms by their coordinates.
void Dynamics::reduce_rows() {
  for (Mechanism& m : layout_->mechanisms) m.reduce_rows(layout_->schur_rows.data() + m.first_row);
}

// Row r at the placed motion, as load_row does it; returns γ − J a.
STEPLAP_INLINE double Dynamics::pull(std::size_t r, const double* a) {
  const ActiveRow& active = layout_->active[r];
  SchurRow& row = layout_->schur_rows[r];
  if (active.pull == RowPullKind::other) {
    double right = -load_row<true>(r).bias;
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < 0) continue;
      const double* ak = a + 3 * row.body[side];
      right -= row.j[side][0] * ak[0] + row.j[side][1] * ak[1] + row.j[side][2] * ak[2];
    }
    return right;
  }
  const bool is_between = row.body[1] >= 0; // two clusters, or one and the ground
  const double* const a0 = a + 3 * row.body[0];
  const double* const a1 = is_between ? a + 3 * row.body[1] : nullptr;
  if (active.pull == RowPullKind::angle) return (is_between ? a1[2] : 0.0) - a0[2];
  const Motion<double>& link = motion_[active.link];
  const Motion<double>& b = motion_[active.spec->b];
  const RowPull p = active.pull == RowPullKind::axis ? pull_along_axis(*active.spec, link)
                                                     : pull_along_slide(*active.spec, link);
  double right = -(p.bias + dot(p.direction, frame_acceleration(link, b.omega)));
  const double x = b.c * p.direction.x - b.s * p.direction.y, y = b.s * p.direction.x + b.c * p.direction.y;
  set_gradient(row, 0, x, y, p.couple_a, a0, right);
  if (is_between) set_gradient(row, 1, -x, -y, -p.couple_b, a1, right);
  return right;
}

// J (a_f + W Jᵀλ) = γ; leaves λ in right_side_ and adds W Jᵀλ to a. In mechanisms the same with M⁻¹ Jᵀλ.
void Dynamics::solve_constraints(double* a) {
  Layout& layout = *layout_;
  const auto count = static_cast<std::size_t>(layout.schur.size());
  double* const right = right_side_.data();
  for (std::size_t r = 0; r < count; ++r) right[r] = pull(r, a);
  for (Mechanism& m : layout.mechanisms) {
    m.factor_mass();
    m.accelerate(force_.data(), a + m.first_coordinate);
    if (m.row_count == 0) continue;
    m.expand(a + m.first_coordinate, cluster_a_.data());
    for (int r = m.first_row; r < m.first_row + m.row_count; ++r) right[r] = pull(r, cluster_a_.data());
  }
  if (layout.active.empty()) return;
  for (const int r : layout.driven_rows) {
    const SignalJet target = row_target(*layout.active[r].spec, state_->memory.data(), evaluation_.t);
    right[r] += target.acceleration;
    target_rate_[r] = target.rate;
  }
  is_factored_ = true;
  for (Mechanism& m : layout.mechanisms) {
    if (m.row_count == 0) continue;
    const SchurRow* const rows = layout.schur_rows.data() + m.first_row;
    m.reduce_rows(rows);
    m.factor_rows(rows, 0.0);
    m.solve_rows(right + m.first_row);
    m.add_response(right + m.first_row, a + m.first_coordinate);
  }
  if (count == 0) return;
  layout.schur.factor(layout.schur_rows);
  layout.schur.solve(layout.schur_rows, right);
  for (std::size_t r = 0; r < count; ++r) {
    const SchurRow& row = layout.schur_rows[r];
    const double lambda = right[r];
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < 0) continue;
      double* ak = a + 3 * row.body[side];
      const double x = row.wj[side][0] * lambda, y = row.wj[side][1] * lambda, m = row.wj[side][2] * lambda;
      ak[0] += x;
      ak[1] += y;
      ak[2] += m;
    }
  }
}

// What is missing in the equation of motion of a locked coordinate.
double Dynamics::lock_reaction(const Lock& lock, const double* a) const {
  const Layout& layout = *layout_;
  const int k = 3 * lock.cluster + lock.coordinate;
  const Cluster& cluster = layout.clusters[lock.cluster];
  const BodyForce& f = force_[cluster.motion];
  double force = (lock.coordinate < 2 ? cluster.mass : cluster.inertia) * a[k] - layout.weight[k] -
                 (lock.coordinate == 0 ? f.fx : lock.coordinate == 1 ? f.fy : f.m);
  for (const LockedTerm& term : lock.terms)
    force -= layout.schur_rows[term.row].j[term.side][lock.coordinate] * right_side_[term.row];
  return force;
}

// Work of drives: multiplier times the rate of the target.
void Dynamics::finish_power(const double* a) {
  const Layout& layout = *layout_;
  for (const int r : layout.driven_rows) evaluation_.work += right_side_[r] * target_rate_[r];
  for (std::size_t i = 0; i < layout.locks.size(); ++i)
    evaluation_.work += lock_reaction(layout.locks[i], a) * lock_target_[i].rate;
}

void Dynamics::finish_watches() {
  const Layout& layout = *layout_;
  for (const HeldRow& held : layout.held_rows) friction_force_[held.friction_row] = right_side_[held.row];
  if (layout.is_singular() && (!layout.sharing || is_rank_new_)) [[unlikely]] {
    find_sharing();
    is_rank_new_ = false;
  }
  const LoadSharing* const shared = sharing(); // elements that share a load are watched at a step's ends
  for (const int f : layout.holding) {
    const FrictionUnit& unit = system_.frictions[f];
    if (!shared || shared->group_of(f) < 0) [[likely]]
      unit.friction->watch_stick(evaluation_, state_->friction[f], &friction_force_[unit.row],
                                 &watch_[unit.watch]);
    watch_[unit.watch + 2] = unit.friction->watch_place(evaluation_, state_->friction[f]);
  }
  for (const int f : layout.sliding) {
    const FrictionUnit& unit = system_.frictions[f];
    watch_[unit.watch + 2] = unit.friction->watch_place(evaluation_, state_->friction[f]);
  }
}

void Dynamics::rates(double t, const double* y, double* dy) {
  rates_at(t, y, dy);
  if (layout_->active.empty()) return;
  const double pivot = layout_->smallest_pivot();
  lowest_pivot_ = std::min(lowest_pivot_, pivot);
  if (pivot < k_placed_pivot) [[unlikely]]
    rates_nearby(t, y, dy);
}

void Dynamics::rates_at(double t, const double* y, double* dy) {
  const Layout& layout = *layout_;
  const int n = coordinate_count();
  ++evaluations_;
  t = std::min(t, time_cap_);
  evaluation_.t = t;
  evaluation_.dissipation = 0.0;
  evaluation_.work = 0.0;
  place(t, y, y + n);
  if (inner_count() > 0) {
    take_inner(y + 2 * n);
    evaluation_.inner_rate = dy + 2 * n;
    std::fill_n(evaluation_.inner_rate, inner_count(), 0.0);
  }
  apply_forces();

  double* const a = dy + n;
  std::copy(y + n, y + 2 * n, dy);
  const double* weight = layout.weight.data();
  const double* w = layout.inverse_mass.data();
  double* out = a;
  for (int k = 0; k < layout.absolute_count; ++k) {
    const BodyForce& f = force_[layout.slots[k]];
    out[0] = w[0] * (weight[0] + f.fx);
    out[1] = w[1] * (weight[1] + f.fy);
    out[2] = w[2] * (weight[2] + f.m);
    out += 3;
    w += 3;
    weight += 3;
  }
  for (std::size_t i = 0; i < layout.locks.size(); ++i) {
    const int k = 3 * layout.locks[i].cluster + layout.locks[i].coordinate;
    a[k] = lock_target_[i].acceleration;
    dy[k] = lock_target_[i].rate;
  }
  solve_constraints(a);
  finish_power(a);
  finish_watches();
  double* const power = dy + 2 * n + inner_count();
  std::copy_n(y + 2 * n + inner_count(), 2, booked_);
  power[0] = evaluation_.dissipation;
  power[1] = evaluation_.work;
}

double Dynamics::mechanical_energy(double t, const double* y) {
  t = std::min(t, time_cap_);
  if (!is_placed(t, y)) place(t, y, y + coordinate_count());
  double kinetic = 0.0, potential = 0.0;
  for (const Cluster& c : layout_->clusters) {
    const Motion<double>& m = motion_[c.motion];
    kinetic += 0.5 * c.mass * (m.vx * m.vx + m.vy * m.vy) + 0.5 * c.inertia * m.omega * m.omega;
    potential -= c.mass * (system_.gravity.x() * m.x + system_.gravity.y() * m.y);
  }
  for (const auto& group : system_.groups) potential += group->potential(motion_.data());
  for (const ForceGroup* group : system_.inner_groups)
    potential += group->inner_energy(motion_.data(), y + 2 * coordinate_count());
  return kinetic + potential;
}

} // namespace steplap

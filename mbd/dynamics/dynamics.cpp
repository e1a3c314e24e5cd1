#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace steplap {

namespace {

// Relative pivot below which a stage uses the rates of the nearest state on the constraints (rates_nearby()).
constexpr double k_placed_pivot = 1e-4;

// Returns arrays with additional force slots, after those of links, for clusters of several bodies.
EvaluationArrays arrays_with_clusters(const System& system) {
  EvaluationArrays arrays(system);
  arrays.force.resize(system.bodies.size() + static_cast<std::size_t>(system.links.slot_count()));
  return arrays;
}

} // namespace

Dynamics::Dynamics(const System& system)
    : system_(system), layouts_(system), scratch_(system), arrays_(arrays_with_clusters(system)), kinematics_(system), rows_(kinematics_),
      reactions_(system, kinematics_, arrays_.force.data()), motion_(kinematics_.motion().data()),
      friction_force_(reactions_.friction_force().data()) {
  inner_ = system.initial_inner;
  arrays_.connect(evaluation_, kinematics_.motion());
  evaluation_.inner = inner_.data();
  evaluation_.scratch = scratch_.pointers();
}

void Dynamics::refuse(ResultLevel level) const {
  constexpr const char* k_names[] = {"layout", "motion", "rates", "reactions"};
  throw std::logic_error(std::string("dynamics: ") + k_names[static_cast<int>(level)] + " are read, but results reach only to " +
                         k_names[static_cast<int>(level_)]);
}

void Dynamics::set_state(const State& state) {
  level_ = ResultLevel::layout;
  state_ = &state;
  evaluation_.mode = state.mode.data();
  evaluation_.friction = state.friction.data();
  evaluation_.bases = state.bases.data();
  is_merged_near_ = was_merged_near_ = false;
  pending_.end();
  stage_programs_.leave();
  std::fill(arrays_.event_value.begin(), arrays_.event_value.end(), 1.0);
  std::fill(arrays_.force.begin(), arrays_.force.end(), BodyForce{}); // so that bodies on which nothing acts have zero force
  const auto [layout, is_new] = layouts_.at(state, choice_);
  // The layout may have been discarded and computed again since its last use. If a layout kept its load sharing, results would depend on
  // the size of the cache.
  if (layout_ != &layout) layout.forget_sharing();
  layout_ = &layout;
  kinematics_.use(*layout_, state);
  rows_.use(*layout_, state);
  reactions_.use(*layout_, state);
  if (is_new) {
    std::vector<double> packed(dimension());
    pack(system_.initial_state(), packed.data());
    layout_->reference.assign(packed.begin(), packed.begin() + coordinate_count());
    if (projected_state_.size() < packed.size()) projected_state_.resize(packed.size());
    pending_.reserve(packed.size());
    if (row_scratch_.size() < layout_->active.size()) row_scratch_.resize(layout_->active.size());
  }
  if (layout_->has_mechanisms()) cluster_a_.resize(3 * layout_->clusters.size());
  decide_rank();
}

void Dynamics::decide_rank() {
  is_rank_new_ = !layout_->held_rows.empty();
  if (!is_rank_new_) return;
  was_dependent_.assign(layout_->active.size(), 0);
  for (std::size_t r = 0; r < was_dependent_.size(); ++r)
    if (const ActiveRow& row = layout_->active[r]; row.friction >= 0)
      was_dependent_[r] = static_cast<char>(state_->friction[row.friction].left_out >> static_cast<unsigned>(row.friction_row) & 1U);
  layout_->schur.decide_rank(layout_->is_friction_row, was_dependent_);
  for (Mechanism& m : layout_->mechanisms)
    m.decide_rank(layout_->is_friction_row.data() + m.first_row, was_dependent_.data() + m.first_row);
}

// Writes the decisions about dependent friction rows to `state`. Rows that were not decided since set_state() keep their entry.
void Dynamics::record_rank(State& state) const {
  if (layout_->held_rows.empty()) return;
  for (std::size_t r = 0; r < layout_->active.size(); ++r) {
    const ActiveRow& row = layout_->active[r];
    if (row.friction < 0 || layout_->is_rank_open(static_cast<int>(r))) continue;
    std::uint8_t& left_out = state.friction[row.friction].left_out;
    const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(row.friction_row));
    if (layout_->is_left_out(static_cast<int>(r))) left_out |= bit;
    else left_out &= static_cast<std::uint8_t>(~bit);
  }
}

void Dynamics::set_left_limit_time(double limit) { time_cap_ = std::nextafter(limit, -std::numeric_limits<double>::infinity()); }

void Dynamics::begin_stages() { stage_programs_.enter(*layout_, *state_, layouts_); }

// --- one evaluation -----------------------------------------------------------------------------

void Dynamics::take_inner(const double* inner) { std::copy_n(inner, inner_count(), inner_.begin()); }

STEPLAP_INLINE void Dynamics::apply_sliding(std::size_t i) {
  const int f = layout_->sliding[i], link = layout_->sliding_link[i];
  const FrictionUnit& unit = system_.frictions[f];
  const FrictionState& friction = state_->friction[f];
  const SlidingRows<double> rows(unit.friction->rows(friction), unit.friction->dimension(), motion_[link]);
  double* const wrench = &friction_force_[unit.row];
  unit.friction->slip_wrench(evaluation_, friction, rows.rate, wrench);
  rows.pull(wrench, arrays_.force[link], evaluation_.dissipation);
  unit.friction->slip_events(evaluation_, friction, rows.rate, &arrays_.event_value[unit.first_event]);
}

// Computes the forces of all elements on bodies, and sums them over clusters.
void Dynamics::apply_forces() {
  const Layout& layout = *layout_;
  BodyForce* const force = arrays_.force.data();
  // Only slots that receive forces are cleared, one by one; clearing all at once would take longer.
  force[k_ground] = {};
  for (const int slot : layout.slots) force[slot] = {};
  for (const ActiveLink& link : layout.links) force[link.slot] = {};
  for (const int i : layout.riding) force[i] = {};
  for (const auto& group : system_.groups) group->add_forces(evaluation_);
  for (std::size_t i = 0; i < layout.sliding.size(); ++i) apply_sliding(i);
  gather_forces(layout, motion_, force);
}

void Dynamics::finish_power(const double* a) {
  const Layout& layout = *layout_;
  add_power_of_drives(
      layout, arrays_.force.data(), layout.schur_rows.data(), rows_.multipliers().data(), a,
      [&](std::size_t i) { return rows_.target_rates()[layout.driven_rows[i]]; },
      [this](std::size_t i) -> const SignalJet& { return kinematics_.lock_target(i); }, evaluation_.work);
}

void Dynamics::finish_events() {
  const Layout& layout = *layout_;
  for (const HeldRow& held : layout.held_rows) friction_force_[held.friction_row] = rows_.multipliers()[held.row];
  if (layout.is_singular() && (!layout.sharing || is_rank_new_)) [[unlikely]] {
    find_sharing();
    is_rank_new_ = false;
  }
  const LoadSharing* const shared = sharing(); // the event functions of elements that share a load are evaluated at the ends of steps only
  const auto contact_point_event = [this](int f) {
    const FrictionUnit& unit = system_.frictions[f];
    arrays_.event_value[unit.slot(FrictionWatch::contact_point)] = unit.friction->contact_point_event(evaluation_, state_->friction[f]);
  };
  const auto event_value = [&](int f) {
    const FrictionUnit& unit = system_.frictions[f];
    if (!shared || shared->group_of(f) < 0) [[likely]]
      unit.friction->stick_events(evaluation_, state_->friction[f], &friction_force_[unit.row], &arrays_.event_value[unit.first_event]);
    contact_point_event(f);
  };
  for (const int f : layout.holding) event_value(f);
  for (const int f : layout.sliding) contact_point_event(f);
}

void Dynamics::evaluate(Request request, double t, const double* y, double* dy) {
  switch (request) {
  case Request::rates: return rates(t, y, dy);
  case Request::rates_without_projection: return rates_without_projection(t, y, dy);
  case Request::stage: evaluate_stage(t, y, dy); break;
  case Request::stage_near_limit: evaluate_stage_and_joints(t, y, dy, false); break;
  case Request::stage_and_joints: evaluate_stage_and_joints(t, y, dy, true); break;
  case Request::end: return evaluate_end(t, y, dy);
  }
  level_ = ResultLevel::layout; // whether there are by-products depends on machine code
}

void Dynamics::rates(double t, const double* y, double* dy) {
  rates_without_projection(t, y, dy);
  if (!layout_->active.empty() && layout_->smallest_pivot() < k_placed_pivot) [[unlikely]]
    rates_nearby(t, y, dy);
}

void Dynamics::rates_without_projection(double t, const double* y, double* dy) {
  rates_at(t, y, dy);
  if (!layout_->active.empty()) least_pivot_ = std::min(least_pivot_, layout_->smallest_pivot());
}

STEPLAP_INLINE void Dynamics::finish_rates(const double* y, double* dy) {
  const int n = coordinate_count();
  finish_power(dy + n);
  finish_events();
  double* const power = dy + 2 * n + inner_count();
  std::copy_n(y + 2 * n + inner_count(), 2, energy_integrals_);
  power[0] = evaluation_.dissipation;
  power[1] = evaluation_.work;
}

STEPLAP_INLINE void Dynamics::begin_rates(double t, const double* y, double* dy) {
  const int n = coordinate_count();
  ++evaluations_;
  pending_.end();
  evaluation_.t = t;
  evaluation_.dissipation = 0.0;
  evaluation_.work = 0.0;
  if (inner_count() > 0) {
    take_inner(y + 2 * n);
    evaluation_.inner_rate = dy + 2 * n;
    std::fill_n(evaluation_.inner_rate, inner_count(), 0.0);
  }
}

// Writes the rates of the coordinates to dy: from y, or from drives for locked coordinates.
STEPLAP_INLINE void Dynamics::put_place_rates(const double* y, double* dy) const {
  std::copy_n(y + coordinate_count(), coordinate_count(), dy);
  for (std::size_t i = 0; i < layout_->locks.size(); ++i)
    dy[3 * layout_->locks[i].cluster + layout_->locks[i].coordinate] = kinematics_.lock_target(i).rate;
}

void Dynamics::rates_at(double t, const double* y, double* dy) {
  const Layout& layout = *layout_;
  const int n = coordinate_count();
  t = std::min(t, time_cap_);
  begin_rates(t, y, dy);
  kinematics_.place(t, y, y + n);
  level_ = ResultLevel::motion;
  rows_.prepare();
  apply_forces();

  double* const a = dy + n;
  const auto target = [this](std::size_t i) -> const SignalJet& { return kinematics_.lock_target(i); };
  accelerate_clusters(layout, arrays_.force.data(), target, a);
  put_place_rates(y, dy);
  rows_.solve(t, arrays_.force.data(), a);
  finish_rates(y, dy);
  level_ = ResultLevel::rates;
}

// Writes the targets of driven rows to `into`. Not inlined, since few models have driven rows.
[[gnu::noinline]] static void take_row_inputs(const Layout& layout, const RowBase* bases, double t, double* into) {
  for (const int r : layout.driven_rows) {
    const SignalJet target = row_target(*layout.active[r].spec, bases, t);
    *into++ = target.acceleration;
    *into++ = target.rate;
  }
}

void Dynamics::take_time_inputs(double t, double* into) {
  kinematics_.aim_locks(t);
  for (const SignalJet& target : kinematics_.lock_targets()) {
    *into++ = target.value;
    *into++ = target.rate;
    *into++ = target.acceleration;
  }
  if (!layout_->driven_rows.empty()) take_row_inputs(*layout_, state_->bases.data(), t, into);
}

// Computes rates, powers and event functions by machine code; with `all` also the data for evaluate_joint_events_by_code() and
// defer_byproducts(). Returns false, with results unchanged, if there is no code or if it is not valid at this state.
bool Dynamics::run_code(double t, const double* y, double* dy, bool all) {
  StageProgram* const program = stage_programs_.now();
  if (!program || !program->is_ready() || !(layout_->smallest_pivot() >= k_traced_pivot)) return false;
  const double now = std::min(t, time_cap_);
  take_time_inputs(now, program->time_inputs());
  if (!program->run(now, y, dy + coordinate_count(), arrays_.event_value.data(), arrays_.event_derivative.data(), all)) return false;
  ++evaluations_;
  ++coded_stages_;
  pending_.end();
  rows_.forget_factors();
  put_place_rates(y, dy);
  return true;
}

void Dynamics::evaluate_stage(double t, const double* y, double* dy) {
  if (!run_code(t, y, dy, false)) evaluate_stage_without_code(t, y, dy);
}

void Dynamics::evaluate_stage_without_code(double t, const double* y, double* dy) {
  rates(t, y, dy);
  // A projection would start with the factors of this evaluation, which an evaluation by machine code does not have. They are discarded, so
  // that results do not depend on the use of machine code. Below k_traced_pivot no machine code is used.
  if (layout_->smallest_pivot() >= k_traced_pivot) rows_.forget_factors();
  count_stage(t, y, dy);
}

void Dynamics::evaluate_stage_and_joints(double t, const double* y, double* dy, bool always) {
  if (!needs_rigid_joint_events(always)) {
    if (run_code(t, y, dy, false)) return; // loads are never shared while code is in use
    evaluate_stage_without_code(t, y, dy);
    evaluate_rigid_joint_events_if_near_limit(dy, always);
  } else if (may_evaluate_joint_events_by_code() && run_code(t, y, dy, true)) {
    const StageProgram& program = *stage_programs_.now();
    defer_byproducts(program, t, y);
    (void)evaluate_joint_events_by_code(program, t);
  } else {
    rates(t, y, dy);
    evaluate_rigid_joint_events_if_near_limit(dy, always);
    count_stage(t, y, dy);
  }
}

void Dynamics::evaluate_end(double t, const double* y, double* dy) {
  if (!may_evaluate_joint_events_by_code() || !run_code(t, y, dy, true)) {
    rates(t, y, dy);
    evaluate_rigid_joint_events(dy);
    return;
  }
  const StageProgram& program = *stage_programs_.now();
  defer_byproducts(program, t, y);
  level_ = ResultLevel::rates;
  if (!layout_->has_rigid_joint_events) return;
  was_merged_near_ = is_merged_near_;
  is_merged_near_ = evaluate_joint_events_by_code(program, t);
}

bool Dynamics::may_evaluate_joint_events_by_code() const {
  const StageProgram* const program = stage_programs_.now();
  return program && program->is_ready() && program->has_joint_wrenches() && !sharing();
}

// Computes the event functions of sticking joints whose bodies are merged to one, after machine code has evaluated a stage. Returns true if
// one of them is within k_near_limit of its limit and has to be evaluated exactly.
bool Dynamics::evaluate_joint_events_by_code(const StageProgram& program, double t) {
  // Joints inside clusters need only their wrench, the time and the friction state.
  evaluation_.t = std::min(t, time_cap_);
  program.put_wrenches(friction_force_);
  return evaluate_wrench_events();
}

// Counts a stage evaluated without code, and records it if compiled code is likely to repay the effort.
void Dynamics::count_stage(double t, const double* y, const double* dy) {
  StageProgram* const program = stage_programs_.now();
  if (!program) return;
  program->count_stage();
  if (!program->needs_recording()) return;
  const double now = std::min(t, time_cap_);
  take_time_inputs(now, program->time_inputs());
  reactions_.find_joints(cluster_accelerations(dy), multipliers().data());
  const StageFound found{dy + coordinate_count(), arrays_.event_value.data(), arrays_.event_derivative.data(), friction_force_,
                         layout_->smallest_pivot()};
  program->record(system_, *state_, evaluation_, now, y, found);
}

void Dynamics::defer_byproducts(const StageProgram& program, double t, const double* y) {
  pending_.begin(std::min(t, time_cap_), y, dimension(), program.smallest_pivot());
}

// Computes the pending by-products. Not counted in evaluations(), which must not depend on the use of code.
void Dynamics::evaluate_byproducts() {
  --evaluations_;
  rates_at(pending_.t(), pending_.y(), pending_.dy());
}

double Dynamics::mechanical_energy(double t, const double* y) {
  t = std::min(t, time_cap_);
  if (!kinematics_.is_placed(t, y)) {
    kinematics_.place(t, y, y + coordinate_count());
    level_ = ResultLevel::motion;
  }
  double kinetic = 0.0, potential = 0.0;
  for (const Cluster& c : layout_->clusters) {
    const Motion<double>& m = motion_[c.motion];
    kinetic += 0.5 * c.mass * (m.vx * m.vx + m.vy * m.vy) + 0.5 * c.inertia * m.omega * m.omega;
    potential -= c.mass * (system_.gravity.x() * m.x + system_.gravity.y() * m.y);
  }
  for (const auto& group : system_.groups) potential += group->potential(motion_);
  for (const ForceGroup* group : system_.inner_groups) potential += group->inner_energy(motion_, y + 2 * coordinate_count());
  return kinetic + potential;
}

// --- results of an evaluation --------------------------------------------------------------------

void Dynamics::evaluate_rigid_joint_events(const double* dy) {
  if (!layout_->has_rigid_joint_events) return;
  was_merged_near_ = is_merged_near_;
  is_merged_near_ = evaluate_joint_events(dy);
}

void Dynamics::evaluate_rigid_joint_events_if_near_limit(const double* dy, bool always) {
  if (needs_rigid_joint_events(always)) (void)evaluate_joint_events(dy);
}

bool Dynamics::has_groups() const { return !sharing()->groups().empty(); }

// Computes the event functions of merged joints and of load-sharing groups. Returns true if one of them is near its limit.
bool Dynamics::evaluate_joint_events(const double* dy) {
  need(ResultLevel::rates);
  ensure_byproducts();
  kinematics_.complete();
  const double* const cluster_a = cluster_accelerations(dy);
  if (layout_->sharing) {
    store_solved_friction();
    reactions_.find_accelerations(cluster_a); // needed by LoadSharing::discord()
  }
  reactions_.find_joints(cluster_a, multipliers().data());
  const bool is_group_near = evaluate_group_events();
  return evaluate_wrench_events() || is_group_near;
}

// Computes the event functions of merged joints from their wrenches. Returns true if one of them is near its limit.
bool Dynamics::evaluate_wrench_events() {
  bool is_near = false;
  for (const int f : layout_->merged) {
    if (is_shared(f)) continue;
    const FrictionUnit& unit = system_.frictions[f];
    double* event_value = &arrays_.event_value[unit.first_event];
    unit.friction->stick_events(evaluation_, state_->friction[f], &friction_force_[unit.row], event_value);
    if (std::min(event_value[0], event_value[1]) < k_near_limit) is_near = true;
  }
  return is_near;
}

Snapshot Dynamics::snapshot(const double* dy) {
  need(ResultLevel::rates);
  const Layout& layout = *layout_;
  ensure_byproducts();
  kinematics_.complete();
  if (layout.sharing) store_solved_friction();
  const double* const cluster_a = cluster_accelerations(dy);
  const double* const lambda = multipliers().data();
  reactions_.find_accelerations(cluster_a);
  reactions_.find_joints(cluster_a, lambda);
  if (layout.has_mechanisms()) reactions_.find_pins(cluster_a, lambda);
  reactions_.take_rows(dy + coordinate_count(), lambda);
  settle_loads();
  level_ = ResultLevel::reactions;
  Snapshot s;
  s.t = evaluation_.t;
  s.motion = motion_;
  s.acceleration = reactions_.acceleration().data();
  s.evaluation = &evaluation_;
  s.row_force = reactions_.row_force().data();
  s.friction_force = friction_force_;
  s.impacts = state_->impacts.data();
  s.dissipated = energy_integrals_[0];
  s.work = energy_integrals_[1];
  s.integrals = integrals_;
  return s;
}

} // namespace steplap

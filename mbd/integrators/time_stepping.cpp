#include "mbd/integrators/time_stepping.h"

#include "mbd/base/number_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_max_mode_passes = 12; // after so many passes, or where contact modes return to earlier ones, the step is halved
constexpr int k_passes_of_cycle = 2;  // passes made again with earlier modes: both of a contact that neither closed nor open is consistent
// Share of its displacement in a part by which a contact that is taken as open may be closed at the end. Its force then begins late by about
// this share of the part; times of events have errors of a whole step.
constexpr double k_late = 0.25;
// Limit of passes for the normal forces at the end of the step; without convergence the step is halved.
constexpr int k_max_force_passes = 60;
constexpr int k_passes_in_full = 12;  // later passes apply half of the change, so that an alternation between two states converges
constexpr int k_passes_repeated = 20; // later passes linearise the bounds as functions of the wrenches, because plain iteration diverges
constexpr int k_passes_static = 6;    // later passes keep the kinetic coefficient of elements that have slipped
constexpr int k_max_halvings = 20;
// Wrenches are converged if each changes by less than this, relative to its element's wrench; far below the error of the method.
constexpr double k_settled = 1e-8;
// Larger changes, up to this, are accepted if they no longer decrease. The wrenches are then those of a step whose normal forces and
// velocities differ from the true ones by this relative amount.
constexpr double k_tolerated = 1e-6;
// A step shorter than this fraction of the longest is treated as rounding. The residual velocities of earlier steps, 1e-8 of the change
// within a step, would otherwise appear as forces a hundred times the real ones.
constexpr double k_negligible = 1e-6;
constexpr double k_roundings_of_time = 64.0;
constexpr double k_whole = 1e-6; // a remainder shorter than this fraction of a part is added to the part
// Shortest part that is searched for hidden slips, relative to the longest step. A load of ordinary curvature deviates within shorter
// parts by 1e-6 of its deviation within a step.
constexpr double k_shortest_searched = 1e-3;
constexpr double k_known = 1e-12; // accuracy of positions relative to the length of the scene, equal to that of the constraints

// During the lifetime of this object rates use the means of force signals over [`from`, t].
class Means {
public:
  Means(Dynamics& dynamics, double from) : dynamics_(dynamics) { dynamics.average_signals_from(from); }
  ~Means() { dynamics_.average_signals_from(std::numeric_limits<double>::infinity()); }
  Means(const Means&) = delete;
  Means& operator=(const Means&) = delete;

private:
  Dynamics& dynamics_;
};

// Throws, by next_mode(), if a force law has left its range of validity in any mode (a rope that has run onto its pulley).
void refuse_beyond_laws(const System& system, Dynamics& dynamics, const State& state) {
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    const Unit& unit = system.units[u];
    for (int w = 0; w < unit.event_count; ++w)
      if (dynamics.event_value()[unit.first_event + w] < 0.0)
        (void)unit.group->next_mode(unit.index, state.mode[u], w, dynamics.evaluation());
  }
}

} // namespace

TimeStepping::TimeStepping(const System& system) : system_(system) {
  const auto n = static_cast<std::size_t>(system.largest_dimension());
  for (auto* v : {&y0_, &y1_, &dy_, &right_, &free_, &probe_, &response_}) v->assign(n, 0.0);
  modes_made_.reserve(k_max_mode_passes * system.units.size());
}

bool TimeStepping::is_rounding(double t0, double t1) const {
  const double rounding = k_roundings_of_time * std::numeric_limits<double>::epsilon() * std::max(std::abs(t0), std::abs(t1));
  return t1 - t0 <= std::max(rounding, k_negligible * longest_);
}

// Advances a step whose length is only rounding; no mode changes.
void TimeStepping::drift(Dynamics& dynamics, State& state, double t1) {
  const double h = t1 - state.t;
  dynamics.set_state(state);
  dynamics.pack(state, y1_.data());
  const Means means(dynamics, time_of_loads(state.t));
  dynamics.rates(time_of_loads(t1), y1_.data(), dy_.data());
  for (int i = 0; i < dynamics.dimension(); ++i) y1_[i] += h * dy_[i];
  dynamics.unpack(t1, y1_.data(), state);
}

void TimeStepping::step(Dynamics& dynamics, State& state, double t1, double tolerance, const PartObserver& observe) {
  residual_ = {};
  if (is_rounding(state.t, t1)) return drift(dynamics, state, t1);
  longest_ = std::max(longest_, t1 - state.t);
  double part = t1 - state.t; // length of a part: halved after a failure, doubled after success
  int halvings = 0;
  while (state.t < t1) {
    const double left = t1 - state.t;
    const bool is_last = left <= part * (1.0 + k_whole);
    const double h = is_last ? left : std::min(part, 0.5 * left), end = is_last ? t1 : state.t + h;
    start_ = state;
    StepFailure trouble;
    try {
      trouble = try_part(dynamics, state, end, tolerance);
    } catch (const ConstraintFailure&) {
      if (halvings == k_max_halvings) throw;
      trouble.what = "constraints";
    }
    if (!trouble.what) {
      impacts_.note_end();
      const bool is_near = note_sticking(dynamics, end);
      finish_phases(dynamics, state, h);
      if (is_near && std::isnan(held_time_) && h > k_shortest_searched * longest_ && slips_inside(dynamics, end, tolerance))
        trouble.what = "a slip inside it";
      if (is_near) dynamics.set_state(state);
    }
    if (!trouble.what) {
      std::swap(sticking_, sticking_now_);
      impacts_.commit();
      if (observe) observe(start_, state);
      if (halvings > 0 && !is_last) {
        part = 2.0 * h;
        --halvings;
      }
      continue;
    }
    state = start_;
    if (halvings == k_max_halvings || state.t + 0.5 * h == state.t) fail(trouble, state.t, h);
    ++halvings;
    ++extra_parts_;
    part = 0.5 * h;
  }
}

void TimeStepping::fail(const StepFailure& trouble, double t, double h) const {
  std::string message =
      "a time step at t = " + number_text(t) + " s, halved down to " + number_text(h) + " s, has no consistent end: " + trouble.what;
  if (trouble.element >= 0)
    message += " of '" + system_.element_names[trouble.element] + "', off by " + number_text(trouble.residual) + trouble.unit;
  throw NumericalFailure(message);
}

void TimeStepping::evaluate(Dynamics& dynamics, double t, const double* y) {
  dynamics.rates(time_of_loads(t), y, dy_.data());
  (void)dynamics.snapshot(dy_.data()); // computes the motion of bodies to which only friction refers
}

// Computes the end of the step for the present wrenches, and projects it onto the constraints.
void TimeStepping::move(Dynamics& dynamics, double t1, double tolerance) {
  const int numbers = 2 * n_ + dynamics.inner_count(); // includes own states, which follow the motion without friction
  std::copy(y0_.begin(), y0_.begin() + numbers + 2, y1_.begin());
  for (int i = 0; i < numbers; ++i) y1_[i] += free_[i];
  if (std::any_of(wrench_.begin(), wrench_.end(), [](double w) { return w != 0.0; })) {
    compliance_.apply(wrench_);
    compliance_.response(response_.data());
    for (int i = 0; i < 2 * n_; ++i) y1_[i] += response_[i];
  }
  const Residual found = dynamics.project(time_of_loads(t1), y1_.data(), tolerance);
  residual_.position = std::max(residual_.position, found.position);
  residual_.velocity = std::max(residual_.velocity, found.velocity);
  evaluate(dynamics, t1, y1_.data());
}

// Iterates friction together with the normal forces and velocities at the end of the step.
TimeStepping::StepFailure TimeStepping::settle_forces(Dynamics& dynamics, double t1, double tolerance) {
  move(dynamics, t1, tolerance);
  double change = 0.0;
  int worst = 0;
  is_coupled_ = false;
  for (int pass = 0; pass < k_max_force_passes && !parts_.empty(); ++pass) {
    if (pass >= k_passes_repeated) couple_bounds(dynamics, t1, tolerance);
    before_ = wrench_;
    rates_without_friction(dynamics, tolerance);
    if (const StepFailure trouble = balance_friction(dynamics, pass >= k_passes_static); trouble.what) return trouble;
    if (pass >= k_passes_in_full && !is_coupled_)
      for (int r = 0; r < rows_; ++r) wrench_[r] = 0.5 * (before_[r] + wrench_[r]);
    move(dynamics, t1, tolerance);
    const double last = change;
    change = 0.0;
    const double size = largest_size(dynamics.evaluation());
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (const double c = change_of(parts_[p], &before_[parts_[p].first], size); !(c <= change)) {
        change = c;
        worst = static_cast<int>(p);
      }
    if (change <= k_settled || (change <= k_tolerated && pass > 0 && change > 0.5 * last)) return {};
  }
  if (change <= k_tolerated) return {};
  return {"friction and the normal forces on which it depends", system_.frictions[parts_[worst].friction].element, change, " of its force"};
}

// Sets the modes for the end of the step, or for another pass. Returns the first unit whose mode differs from that used in the step, or whose
// impact has to be adapted; −1 if there is none.
int TimeStepping::changed_unit(Dynamics& dynamics, State& state) {
  int first = -1;
  impacts_.end_pass(dynamics);
  for (std::size_t u = 0; u < system_.units.size(); ++u) {
    const Unit& unit = system_.units[u];
    const UnitMode mode = unit.group->initial_mode(unit.index, dynamics.evaluation());
    if (impacts_.contains(u)) {
      if (impacts_.refine(u, mode) && first < 0) first = static_cast<int>(u);
      if (!impacts_.contains(u)) state.mode[u] = mode;
      continue;
    }
    if (mode != state.mode[u] && first < 0) first = static_cast<int>(u);
    if (impacts_.has_closed(u) && start_.mode[u] == k_contact_open && state.mode[u] == k_contact_open && mode == k_contact_pressed)
      impacts_.land(u, start_event_derivative_[unit.first_event], dynamics.event_derivative()[unit.first_event]);
    state.mode[u] = mode;
  }
  return first;
}

// Notes the modes used in a pass. Returns true if an earlier pass of the part was made with them: the next ones would repeat those after it.
bool TimeStepping::repeats_modes(const State& state) {
  const std::size_t count = state.mode.size();
  bool is_known = false;
  for (std::size_t first = 0; first < modes_made_.size() && !is_known; first += count)
    is_known = std::equal(state.mode.begin(), state.mode.end(), modes_made_.begin() + static_cast<std::ptrdiff_t>(first));
  modes_made_.insert(modes_made_.end(), state.mode.begin(), state.mode.end());
  return is_known;
}

// Returns true if the modes at the end of the pass differ from those used in it only by contacts that close late in the part.
bool TimeStepping::only_closes_late(const Dynamics& dynamics, const State& state) const {
  const UnitMode* const used = &modes_made_[modes_made_.size() - state.mode.size()];
  for (std::size_t u = 0; u < system_.units.size(); ++u) {
    if (state.mode[u] == used[u] || impacts_.contains(u)) continue;
    const auto gap = std::min_element(dynamics.event_value().begin() + system_.units[u].first_event,
                                      dynamics.event_value().begin() + system_.units[u].first_event + system_.units[u].event_count);
    const double at_start = start_event_value_[gap - dynamics.event_value().begin()];
    const bool closes_late = used[u] == 0 && start_.mode[u] == 0 && *gap < 0.0 && -*gap <= k_late * (at_start - *gap);
    if (!closes_late) return false;
  }
  return true;
}

// Returns the first contact that is open at both ends of the step, but would have closed by linear extrapolation from either end; −1 if
// there is none. A fast body may have passed a plate that is thinner than the step's displacement. If the body really reversed without
// contact, another force did it, which a part of half the length resolves. A penetration below the accuracy of positions is ignored.
int TimeStepping::passed_unit(const Dynamics& dynamics, const State& state, double h) const {
  const double known = k_known * system_.scale.length;
  for (std::size_t u = 0; u < system_.units.size(); ++u) {
    const Unit& unit = system_.units[u];
    if (state.mode[u] != 0 || start_.mode[u] != 0) continue;
    for (int slot = unit.first_event; slot < unit.first_event + unit.event_count; ++slot)
      if (start_event_value_[slot] + h * start_event_derivative_[slot] < -known && // false for NaN: rate unknown
          dynamics.event_value()[slot] - h * dynamics.event_derivative()[slot] < -known)
        return static_cast<int>(u);
  }
  return -1;
}

// Computes the part from start_ to t1. Results: y1_ and the modes in `state`.
TimeStepping::StepFailure TimeStepping::try_part(Dynamics& dynamics, State& state, double t1, double tolerance) {
  const double h = t1 - state.t;
  for (std::size_t f = 0; f < state.friction.size(); ++f)
    if (state.friction[f].phase != FrictionPhase::apart && !system_.frictions[f].friction->never_slips())
      state.friction[f].phase = FrictionPhase::free;
  dynamics.set_state(state);
  n_ = dynamics.coordinate_count();
  dynamics.pack(state, y0_.data());
  evaluate(dynamics, start_.t, y0_.data());
  start_event_value_ = dynamics.event_value();
  start_event_derivative_ = dynamics.event_derivative();
  impacts_.begin_part(dynamics, start_);
  collect_friction(dynamics, state);
  dynamics.set_state(state);
  StepFailure trouble;
  modes_made_.clear();
  int repeated = 0;
  const Linearization::PartsHook weigh = [this](const Evaluation& e, std::vector<PairJacobian>& parts,
                                                const std::vector<std::size_t>& first) { impacts_.weigh(e, parts, first); };
  bool is_adapted = false; // only shares of impacts have changed in the last pass
  for (int pass = 0; pass < k_max_mode_passes; ++pass) {
    impacts_.set_force_modes(state.mode);
    if (repeats_modes(state) && !is_adapted && ++repeated > k_passes_of_cycle) break;
    {
      const Means means(dynamics, time_of_loads(glance_ > 0.0 ? t1 - glance_ : start_.t));
      linearization_.evaluate(dynamics, time_of_loads(t1), y0_.data(), weigh);
      stages_.set(linearization_, dynamics.layout());
      impacts_.set_mean_motion(dynamics.layout(), stages_);
      if (!stages_.factor(h)) return {"its equations are singular"};
      evaluate(dynamics, t1, y0_.data());
    }
    std::copy(dy_.begin(), dy_.begin() + 2 * n_ + dynamics.inner_count(), right_.begin());
    stages_.solve(right_.data(), free_.data());
    impacts_.add_forces(dynamics.layout(), dynamics.motion(), stages_, free_.data());
    impacts_.set_friction_modes(state.mode);
    respond(dynamics, h);
    trouble = settle_forces(dynamics, t1, tolerance);
    if (!trouble.what)
      for (int i = 0; i < 2 * n_ + dynamics.inner_count(); ++i)
        if (!std::isfinite(y1_[i])) trouble.what = "the motion became infinite";
    if (trouble.what) return trouble;
    const int unit = changed_unit(dynamics, state);
    is_adapted = unit >= 0 && impacts_.contains(static_cast<std::size_t>(unit));
    if (unit < 0 || (repeated > 0 && only_closes_late(dynamics, state))) {
      if (const int passed = passed_unit(dynamics, state, h); passed >= 0)
        return {"the gap", system_.units[passed].element, dynamics.event_value()[system_.units[passed].first_event], " m"};
      impacts_.set_end_modes(state.mode);
      refuse_beyond_laws(system_, dynamics, state);
      dynamics.unpack(t1, y1_.data(), state);
      return {};
    }
    const Unit& changed = system_.units[unit];
    const double* const event_value = &dynamics.event_value()[changed.first_event];
    trouble = {"the mode", changed.element, *std::min_element(event_value, event_value + changed.event_count), ""};
  }
  return trouble;
}

// Adds dissipation and work of the part. A force that is constant in a step does work with the mean of the velocities at its ends; this
// applies to loads and drives, whose impulse is exact. Dissipation uses the power at the end of the step, where the laws are satisfied.
void TimeStepping::book_power(Dynamics& dynamics, State& state, double h) {
  const int n = dynamics.dimension(), m = dynamics.coordinate_count();
  dynamics.rates(time_of_loads(state.t), y1_.data(), dy_.data());
  state.dissipated += h * dy_[n - 2];
  if (!system_.has_work) return;
  dynamics.pack(start_, y0_.data());
  for (int i = m; i < 2 * m; ++i) y1_[i] = 0.5 * (y0_[i] + y1_[i]);
  const Means means(dynamics, time_of_loads(start_.t));
  dynamics.rates(time_of_loads(state.t), y1_.data(), dy_.data());
  state.work += h * dy_[n - 1];
}

// From its touch until its friction has stopped it an element that lands with a velocity slips, however short this is. Steps of zero length
// have no landing.
bool TimeStepping::slides_at_landing(const FrictionPart& part) const {
  if (!part.has_landed || !part.block.sticks || !std::isnan(held_time_)) return false;
  return std::any_of(part.landing_rate, part.landing_rate + part.dimension, [&](double rate) { return std::abs(rate) > part.noise; });
}

// Sets phase and anchor of each friction element, and adds the energy integrals of the part.
void TimeStepping::finish_phases(Dynamics& dynamics, State& state, double h) {
  bool has_rejoined = false;
  for (const FrictionPart& part : parts_) {
    const FrictionElement& element = *system_.frictions[part.friction].friction;
    FrictionState& friction = state.friction[part.friction];
    const RowSpec* rows = element.rows(friction);
    if (!part.is_loaded) continue; // it is free
    double rate[3] = {0, 0, 0};
    const bool stays = part.block.sticks && has_held(friction, part.friction);
    for (int r = 0; r < part.dimension; ++r) {
      const auto m = evaluate_row<false>(rows[r], dynamics.motion().data());
      rate[r] = m.rate;
      if (rows[r].base >= 0 && !stays) state.bases[rows[r].base].value = m.value;
    }
    friction.is_onset = false;
    friction.phase = part.block.sticks ? FrictionPhase::stick : FrictionPhase::slip;
    has_rejoined = has_rejoined || (part.block.sticks && !stays && element.is_rigid());
    if (slides_at_landing(part)) {
      friction.has_slipped = true;
      friction.slid += 0.5 * h * std::abs(part.landing_rate[0]) * usage_of(dynamics.evaluation(), part); // stops in this share of the step
      element.aim(friction, part.landing_rate);
    }
    if (part.block.sticks) continue;
    friction.has_slipped = true;
    friction.slid += h * std::abs(rate[0]);
    std::copy(part.block.direction, part.block.direction + 3, friction.direction);
    friction.sign = part.block.direction[0] > 0.0 ? 1 : -1;
    if (part.dimension == 3) element.aim(friction, rate);
  }
  if (has_rejoined) dynamics.clear_layouts(); // cached layouts that merge the two bodies still have their previous relative pose
  dynamics.set_state(state);
  dynamics.pack(state, y1_.data());
  book_power(dynamics, state, h);
}

} // namespace steplap

#include "mbd/rest/descent.h"

#include "mbd/base/stop.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/finite_forces.h"
#include "mbd/rest/landing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr const char* k_where = "in the search for rest"; // for the message of a stop
constexpr double k_no_share = 1e-6;                       // fraction of the total work: a force on a body that does less is rounding
constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_first_radius = 0.1, k_first_turn = 0.3; // initial trust region: fraction of the model's size; rad
// Radii of the trust region for rotations, rad. Larger rotations could confuse poses that differ by half a turn.
constexpr double k_small_turn = 0.4, k_largest_turn = 1.5;
constexpr double k_balanced = 1e-11; // fraction of the size of the model; smaller Newton steps are rounding of the pose
constexpr double k_nearly_balanced = 1e-8;
constexpr double k_nudge = 1e-3; // displacement out of an unstable equilibrium: fraction of the size of the model, rad
// A step is too long if the forces at its end oppose it by more than this fraction of their drive at its start.
constexpr double k_turned_against = 0.5;
constexpr int k_most_measurements = 1000; // gap measurements along one step
constexpr int k_most_halved_measurements = 40;
// Way of a friction row, as a fraction of the model's size, and turn, rad, up to which its bodies are near their first touch.
constexpr double k_near_way = 1e-2, k_near_turn = 0.1;
constexpr double k_touch = 64.0; // depth to which a landing body penetrates, in rounding errors of the largest coordinate
constexpr int k_most_trials = 44, k_most_corrections = 4, k_most_projections = 25, k_most_polishing = 4;
constexpr int k_most_dense = 90; // number of coordinates above which sparse algebra is faster

// Limits for a sparse projection. If it converges slowly, the step is too long, and halving the step is cheaper than more iterations.
constexpr int k_most_sparse_projections = 12;
constexpr double k_slow = 0.5;

constexpr int k_most_iterations = 3000, k_most_iterations_large = 1000; // with more than 1000 coordinates
constexpr int k_most_iterations_near = 200; // after a small change of the loads; rests near by are found within 35
// Limits the search where a step needs thousands of measurements: bodies 1e9 m apart, whose gaps drown in rounding. In `steplap equilibrium`
// of the files in models/ the longest search that finds no rest evaluates 72 000 times, the longest that finds one 6100 times.
constexpr long k_most_evaluations = 200'000;

} // namespace

Descent::Descent(const System& system, State& state, RestAlgebra algebra)
    : system_(system), state_(state), statics_(system), n_(statics_.coordinates()), start_(state.q),
      hold_(system.frictions.size(), Hold::none), touch_(system.frictions.size()) {
  std::fill(state_.v.begin(), state_.v.end(), 0.0);
  for (std::size_t f = 0; f < hold_.size(); ++f) {
    const FrictionPhase phase = state.friction[f].phase;
    hold_[f] = phase == FrictionPhase::stick ? Hold::sticks : phase == FrictionPhase::slip ? Hold::slides : Hold::none;
  }
  std::vector<Motion<double>> placed;
  place_bodies(state.q, state.v, placed);
  for (std::size_t f = 0; f < hold_.size(); ++f) {
    if (hold_[f] != Hold::sticks) continue;
    const RowSpec& row = *system.frictions[f].friction->rows(state.friction[f]);
    touch_[f] = {row.a, row.b, placed[static_cast<std::size_t>(row.a)], placed[static_cast<std::size_t>(row.b)], false};
  }
  measure_scene();
  is_sparse_ = algebra == RestAlgebra::sparse || (algebra == RestAlgebra::by_size && n_ > k_most_dense);
  const Landscape::StepProblem scene{system_, statics_, scale_, mass_, length_};
  most_iterations_ = n_ <= 1000 ? k_most_iterations : k_most_iterations_large;
  landscape_ = is_sparse_ ? sparse_landscape(scene) : dense_landscape(scene);
  clearance_ = std::make_unique<Clearance>(system_, k_touch * k_epsilon * reach_);
  radius_ = k_first_radius * length_;
  turn_ = k_first_turn;
}

void Descent::follow_increment(double reach) {
  far_ = many_turns_ = reach;
  keeps_directions_ = true;
  most_iterations_ = k_most_iterations_near;
}

void Descent::measure_scene() {
  const SceneScale scene = scale_of(system_, state_);
  length_ = scene.length;
  reach_ = scene.reach;
  scale_ = scene.scale;
  mass_ = VecX(n_);
  for (int k = 0; k < n_; ++k) {
    const BodyData& body = system_.bodies[k / 3 + 1];
    mass_[k] = k % 3 < 2 ? body.mass : body.inertia * scale_[k] * scale_[k];
  }
}

bool Descent::is_exhausted() const { return statics_.evaluations() >= k_most_evaluations; }

void Descent::linearise() {
  statics_.evaluate(state_);
  statics_.collect_rows(state_, left_out_);
  landscape_->linearise(state_);
  if (!landscape_->acceleration().allFinite()) throw no_direction(system_, statics_);
}

double Descent::step_size(const VecX& step) const {
  double size = 0.0;
  for (int i = 0; i < n_; ++i) size = std::max(size, i % 3 < 2 ? std::abs(step[i]) / radius_ : std::abs(step[i]) * scale_[i] / turn_);
  return size;
}

// Projects the pose onto the rows by the least displacement. Returns false if this fails or needs more than the size of the model.
bool Descent::project() {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    statics_.evaluate(state_);
    const VecX off = statics_.off();
    VecX way;
    const double size = landscape_->displacement_to_rows(off, way);
    if (statics_.rows().empty()) return true;
    const double close = 8.0 * k_epsilon * reach_;
    if (!std::isfinite(size) || size > length_) return false;
    // Dependent rows are not part of the solution. They are satisfied together with the others or not at all, which is checked at the end.
    if (size <= close || (size >= 0.5 * before && size <= 64.0 * close)) {
      for (int r = 0; r < statics_.bilateral_count(); ++r)
        if (!(std::abs(off[r]) <= 1e-7 * length_ * std::max(1.0, landscape_->row_size()[r]))) return false;
      return true;
    }
    if (i == (is_sparse_ ? k_most_sparse_projections : k_most_projections)) return false;
    if (i > 4 && size > (is_sparse_ ? k_slow : 0.9) * before) return false;
    before = size;
    for (int k = 0; k < n_; ++k) state_.q[k + 3] -= scale_[k] * way[k];
  }
}

bool Descent::move_to(const std::vector<double>& from, const VecX& step) {
  for (int k = 0; k < n_; ++k) state_.q[k + 3] = from[k + 3] + scale_[k] * step[k];
  return project();
}

// Returns the derivative of the potential along the step at its end; negative if the forces still drive the step.
double Descent::slope_along(const VecX& step) const { return -landscape_->along_rows(step).dot(scale_.cwiseProduct(statics_.force())); }

// Corrects a straight step, which may leave the curved path of a stiff contact or spring, along the stiff directions. The correction is
// kept only if it brings the pose closer to balance. Returns slope_along() at the resulting pose; `slope` is that before.
double Descent::correct(const VecX& step, const std::vector<double>& from, double slope) {
  const std::vector<double> first = state_.q;
  VecX moved = step;
  double before = 0.0, after = 0.0;
  VecX back = landscape_->stiff_imbalance(before);
  if (before == 0.0) return slope;
  double now = slope;
  bool is_better = false;
  for (int round = 0; round < k_most_corrections; ++round) {
    moved += back;
    if (!(step_size(moved) < 2.0) || !move_to(from, moved)) {
      is_better = false;
      break;
    }
    back = landscape_->stiff_imbalance(after);
    now = slope_along(step);
    if (!(after < 0.5 * before)) break;
    is_better = true;
    before = after;
  }
  clearance_->measure(first);
  clearance_->measure(state_.q);
  if (is_better && (now < slope || now < 0.0) && clearance_->keeps_sides(displacement_from(first))) return now;
  state_.q = first;
  statics_.evaluate(state_);
  return slope;
}

// Returns the number of gap measurements along a step: one per quarter of a body's size and per tenth of a radian, because contacts may
// close and open again in between.
int Descent::measurement_count(const VecX& step) const {
  double parts = 0.0;
  for (int k = 0; k < n_; ++k) {
    const double inverse_size = scale_[k - k % 3 + 2];
    parts = std::max(parts, (k % 3 < 2 ? 4.0 : 10.0) * std::abs(step[k]) * inverse_size);
  }
  return static_cast<int>(std::clamp(std::ceil(parts), 1.0, 1.0 * k_most_measurements));
}

// Only for large models: shortens the step of each body to its first contact, so that many bodies land in one step. Returns false if none
// lands.
bool Descent::land(const std::vector<double>& from, VecX& step) {
  if (!is_sparse_ || system_.contact_count == 0) return false;
  std::vector<double> measurements(system_.bodies.size(), 0.0);
  for (int k = 0; k < n_; ++k) {
    const double parts = (k % 3 < 2 ? 4.0 : 10.0) * std::abs(step[k]) * scale_[k - k % 3 + 2];
    measurements[k / 3 + 1] = std::max(measurements[k / 3 + 1], std::min(std::ceil(parts), 1.0 * k_most_measurements));
  }
  const auto evaluate = [&](const VecX& way) {
    for (int k = 0; k < n_; ++k) state_.q[k + 3] = from[k + 3] + scale_[k] * way[k];
    statics_.evaluate(state_);
  };
  const auto room = [&](const VecX& way) {
    clearance_->measure(state_.q);
    return clearance_->share(scale_.cwiseProduct(way));
  };
  const bool is_cut = Landing(system_, statics_).cut(step, measurements, k_touch * k_epsilon * reach_, {evaluate, room});
  state_.q = from;
  statics_.evaluate(state_);
  return is_cut;
}

VecX Descent::displacement_from(const std::vector<double>& from) const {
  VecX way(n_);
  for (int k = 0; k < n_; ++k) way[k] = state_.q[k + 3] - from[k + 3];
  return way;
}

// Moves to the fraction `share` of a step, projected onto the rows, and measures the gaps. `share` is reduced until no contact can have
// closed and opened again since the fraction `before`, at which gaps were measured last.
void Descent::refine_first_contact(const std::vector<double>& from, const VecX& step, double before, double& share) {
  const std::vector<double> last = state_.q;
  const bool is_on_rows = !is_sparse_ && !statics_.rows().empty();
  for (int i = 0; i < k_most_halved_measurements; ++i) {
    if (!is_on_rows || !move_to(from, share * step))
      for (int k = 0; k < n_; ++k) state_.q[k + 3] = from[k + 3] + scale_[k] * step[k] * share;
    clearance_->measure(state_.q, i > 0);
    if (clearance_->keeps_sides(displacement_from(last))) return;
    share = 0.5 * (before + share);
  }
}

// Returns the fraction of a step at which a contact first closes; 1 if none closes.
double Descent::first_contact(const std::vector<double>& from, const VecX& step) {
  if (clearance_->is_endless()) return 1.0;
  const double spacing = 1.0 / measurement_count(step);
  const VecX way = scale_.cwiseProduct(step);
  clearance_->measure(from);
  double share = 0.0;
  for (int i = 0; i < k_most_measurements && share < 1.0 && !is_exhausted(); ++i) {
    throw_if_stopped(k_where);
    const double before = share;
    share = std::min(1.0, before + std::min(spacing, clearance_->share(way)));
    refine_first_contact(from, step, before, share);
    if (clearance_->has_met()) break;
  }
  state_.q = from;
  return share;
}

bool Descent::loads_friction() const {
  for (std::size_t f = 0; f < hold_.size(); ++f)
    if (hold_[f] == Hold::none && state_.friction[f].phase != FrictionPhase::apart &&
        system_.frictions[f].friction->is_loaded(statics_.evaluation(), state_.friction[f]))
      return true;
  return false;
}

// Returns the fraction of a step, between `low` and `high`, at which the first friction element gains normal force, and moves there.
// Friction must hold a contact at the pose of first touch, not at the depth that the step reached.
double Descent::first_load(const std::vector<double>& from, const VecX& step, double low, double high) {
  if (!loads_friction()) return high;
  const std::vector<double> reached = state_.q;
  double taken = high;
  std::vector<double> place = reached;
  for (int i = 0; i < k_most_trials && taken - low > 1e-12 * taken; ++i) {
    const double middle = 0.5 * (low + taken);
    if (move_to(from, middle * step) && loads_friction()) {
      taken = middle;
      place = state_.q;
    } else {
      low = middle;
    }
  }
  state_.q = place;
  statics_.evaluate(state_);
  return taken;
}

// Adapts the trust region after a step that was shortened to the fraction `factor`. `is_straight`: the forces changed little along the
// step.
void Descent::adapt_region(double factor, const VecX& step, bool is_straight) {
  double moved = 0.0, turned = 0.0;
  for (int k = 0; k < n_; ++k) {
    double& most = k % 3 < 2 ? moved : turned;
    most = std::max(most, std::abs(step[k]) * scale_[k]); // the scale of a displacement is 1
  }
  if (factor < 1.0 && is_sparse_ && system_.contact_count == 0) {
    radius_ = std::max(1.5 * moved, 0.25 * radius_);
    turn_ = std::min(k_small_turn, std::max(1.5 * turned, 0.25 * turn_));
    return;
  }
  if (factor < 1.0) {
    radius_ = std::clamp(4.0 * moved, 0.25 * radius_, radius_);
    turn_ = std::min(k_small_turn, std::clamp(4.0 * turned, 0.25 * turn_, turn_));
    return;
  }
  if (moved > 0.5 * radius_) radius_ *= 2.0;
  if (turned > 0.5 * turn_) turn_ = is_straight ? std::min(k_largest_turn, 1.5 * turn_) : std::min(k_small_turn, 2.0 * turn_);
  else if (!is_straight) turn_ = std::min(turn_, k_small_turn);
}

bool Descent::advance(VecX step) {
  const std::vector<double> from = state_.q;
  const std::vector<UnitMode> modes = state_.mode;
  const bool has_landed = land(from, step);
  const double start = -step.dot(landscape_->force());
  if (!(start < 0.0)) return false;
  const double whole = has_landed ? 1.0 : first_contact(from, step);
  double low = 0.0, high = whole, slope = 0.0, factor = whole;
  bool is_taken = false;
  for (int trial = 0; trial < k_most_trials; ++trial) {
    throw_if_stopped(k_where);
    bool is_too_far = !move_to(from, factor * step);
    if (!is_too_far) {
      slope = slope_along(step);
      // Bodies that have landed are not moved on: friction will hold them where they touch.
      if (!has_landed && (slope > -k_turned_against * start || state_.mode != modes)) slope = correct(factor * step, from, slope);
      is_too_far = !(slope <= -k_turned_against * start);
      is_taken = !is_too_far && (factor == whole || slope >= k_turned_against * start);
    }
    if (is_taken) break;
    (is_too_far ? high : low) = factor;
    // In a large model the step is accepted here, since finding its best length would cost as much as many steps.
    if (is_sparse_ && low > 0.0 && slope < 0.0 && high < whole) break;
    if (trial > 12 && low > 0.0 && high - low < 1e-3 * high) break;
    factor = 0.5 * (low + high);
  }
  if (!is_taken && low > 0.0) {
    factor = low;
    is_taken = move_to(from, factor * step);
  }
  if (!is_taken) {
    state_.q = from;
    return false;
  }
  if (!has_landed || factor < whole) factor = first_load(from, step, low < factor ? low : 0.0, factor);
  const bool is_straight = std::abs(slope - start) < 0.3 * std::abs(start);
  adapt_region(factor, factor * step, is_straight);
  follow_friction(from);
  return true;
}

// Returns true if the bodies of a friction element are so near their first touch that rocking from corner to corner explains the way.
// Precondition: at_touch_ holds the poses of the first touch.
bool Descent::is_near_touch(int f) const {
  const Touch& touch = touch_[static_cast<std::size_t>(f)];
  const RowSpec& row = *system_.frictions[f].friction->rows(state_.friction[f]);
  const bool is_same = touch.a == row.a && touch.b == row.b, is_swapped = touch.a == row.b && touch.b == row.a;
  if (touch.a < 0 || !(is_same || is_swapped) || system_.frictions[f].friction->dimension() > 1) return false;
  const std::vector<Motion<double>>& now = statics_.motion();
  const double turn = now[touch.a].theta - now[touch.b].theta - (touch.at_a.theta - touch.at_b.theta);
  const double was = evaluate_row<false>(row, at_touch_.data()).value, is = evaluate_row<false>(row, now.data()).value;
  return std::abs(turn) <= k_near_turn && std::abs(is - was) <= k_near_way * length_;
}

// Anchors sticking friction. Rocking from one contact point to another on the way to the rest must not make it slide. In a small change of the
// loads every pose on the way is one of the machine.
void Descent::anchor(int f, bool is_switched) {
  Touch& touch = touch_[static_cast<std::size_t>(f)];
  const std::vector<Motion<double>>& now = statics_.motion();
  touch.has_switched = touch.has_switched || is_switched;
  if (touch.a >= 0 && touch.has_switched && !keeps_directions_) {
    at_touch_.assign(now.begin(), now.begin() + system_.body_count());
    at_touch_[touch.a] = touch.at_a;
    at_touch_[touch.b] = touch.at_b;
    if (is_near_touch(f)) return anchor_friction(system_, state_, f, at_touch_.data());
  }
  const RowSpec& row = *system_.frictions[f].friction->rows(state_.friction[f]);
  touch = {row.a, row.b, now[row.a], now[row.b], touch.has_switched};
  anchor_friction(system_, state_, f, now.data());
}

// Updates friction after a step from the poses `from`. An element that gains normal force, or whose slip reverses, sticks; one without normal
// force is released.
void Descent::follow_friction(const std::vector<double>& from) {
  statics_.evaluate(state_);
  bool is_changed = false, is_moved = false;
  std::vector<Motion<double>> before_it;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    FrictionState& friction = state_.friction[f];
    if (friction.phase == FrictionPhase::apart) continue;
    const FrictionElement& element = *system_.frictions[f].friction;
    const FrictionPhase before = friction.phase;
    if (keeps_directions_ && hold_[f] == Hold::slides) continue; // even if it has no load on the way
    if (!element.is_loaded(statics_.evaluation(), friction)) {
      friction.phase = FrictionPhase::free;
      hold_[f] = Hold::none;
    } else if (before == FrictionPhase::slip && hold_[f] == Hold::slides) {
      const RowSpec& row = *element.rows(friction);
      if (before_it.empty()) place_bodies(from, state_.v, before_it);
      const double was = evaluate_row<false>(row, before_it.data()).value;
      const double slid = evaluate_row<false>(row, statics_.motion().data()).value - was;
      if (slid * friction.sign >= -1e-9 * length_) continue;
      friction.phase = FrictionPhase::stick;
      touch_[f].a = -1; // it has slid
      anchor(f, false);
      hold_[f] = Hold::sticks;
    } else {
      const bool is_displaced = element.contact_point_event(statics_.evaluation(), friction) < 0.0;
      if (is_displaced) element.switch_contact_point(statics_.evaluation(), friction);
      if (friction.phase == FrictionPhase::apart) continue;
      friction.phase = FrictionPhase::stick;
      if (is_displaced || hold_[f] != Hold::sticks) anchor(f, is_displaced);
      hold_[f] = Hold::sticks;
      is_moved = is_moved || is_displaced;
    }
    is_changed = is_changed || friction.phase != before;
  }
  if (is_changed) statics_.evaluate(state_);
  if (is_changed || is_moved || left_out_.empty()) find_dependent_friction();
  statics_.collect_rows(state_, left_out_);
}

// Finds friction rows that depend on others, by the rule of the equations of motion, and leaves them out. Several feet of one body hold it
// in a direction only once. If all rows were kept, they would also hold the body against tilting, which changes the distance of two feet
// slightly.
void Descent::find_dependent_friction() {
  left_out_.assign(static_cast<std::size_t>(system_.friction_row_count) + 1, 0);
  const auto is_bounded = [this](std::size_t f) {
    return state_.friction[f].phase == FrictionPhase::stick && !system_.frictions[f].friction->never_slips();
  };
  bool is_any = false;
  for (std::size_t f = 0; f < state_.friction.size(); ++f) is_any = is_any || is_bounded(f);
  if (!is_any) return;
  Dynamics dynamics(system_);
  dynamics.set_state(state_);
  std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
  dynamics.pack(state_, y.data());
  dynamics.rates(state_.t, y.data(), dy.data());
  for (std::size_t r = 0; r < dynamics.layout().active.size(); ++r)
    if (const ActiveRow& row = dynamics.layout().active[r]; row.friction >= 0 && dynamics.layout().is_left_out(static_cast<int>(r)))
      left_out_[system_.frictions[row.friction].row + row.friction_row] = 1;
}

bool Descent::has_run_away() {
  VecX moved(n_);
  bool is_far = false;
  for (int k = 0; k < n_; ++k) {
    const double way = state_.q[k + 3] - start_[k + 3];
    is_far = is_far || !(std::abs(way) < (k % 3 < 2 ? far_ * length_ : many_turns_));
    moved[k] = k % 3 < 2 ? way / (far_ * length_) : way / many_turns_;
  }
  if (!is_far) return false;
  runaway_ = largest_part(moved);
  const int driven = 3 * runaway_.body - 3 + runaway_.coordinate;
  driving_force_ = std::abs(statics_.force()[driven]);
  // If almost no force acts on this coordinate itself, other coordinates that move with it drive it: the rotation of a pinion that rolls
  // down its rack by its weight. The driving force is then the total work divided by the displacement.
  double work = 0.0;
  for (int k = 0; k < n_; ++k) work += statics_.force()[k] * (state_.q[k + 3] - start_[k + 3]);
  const double way = std::abs(state_.q[driven + 3] - start_[driven + 3]);
  if (driving_force_ * way < k_no_share * work && std::isfinite(work / way)) driving_force_ = work / way;
  return true;
}

// Improves the balance by Newton steps until rounding errors prevent it. Returns true if it improved.
bool Descent::polish() {
  bool is_better = false;
  for (int i = 0; i < k_most_polishing; ++i) {
    const State before = state_;
    const double size = landscape_->imbalance();
    const VecX step = landscape_->newton_step();
    if (!(step_size(step) <= 1.0) || !move_to(before.q, step)) {
      state_ = before;
      linearise();
      break;
    }
    linearise();
    if (!(landscape_->imbalance() < 0.5 * size)) {
      state_ = before;
      linearise();
      break;
    }
    is_better = true;
  }
  return is_better;
}

bool Descent::leave_saddle() {
  const auto unstable = landscape_->most_unstable_direction();
  if (!unstable) return false;
  VecX direction = unstable->direction;
  const MotionPart part = largest_part(direction);
  const bool is_pushed = std::abs(unstable->force) > 8.0 * unstable->rounding;
  if (is_pushed ? unstable->force < 0.0 : part.sign < 0.0) direction = -direction;
  left_.push_back(largest_part(direction));
  radius_ = std::max(radius_, k_first_radius * length_);
  turn_ = k_first_turn;
  double largest = 0.0;
  for (int i = 0; i < n_; ++i)
    largest = std::max(largest, i % 3 < 2 ? std::abs(direction[i]) / length_ : std::abs(direction[i]) * scale_[i]);
  const std::vector<double> from = state_.q;
  for (double nudge = k_nudge; nudge > 1e-9; nudge *= 0.25)
    if (move_to(from, (nudge / largest) * direction)) {
      follow_friction(from);
      return true;
    }
  state_.q = from;
  return false;
}

void Descent::finish() {
  yielding_ = landscape_->count_yielding();
  residual_ = landscape_->acceleration().cwiseProduct(scale_).cwiseAbs().maxCoeff();
  indifferent_ = landscape_->indifferent(more_indifferent_);
  // Friction rows that were left out get their anchors at the present pose.
  for (std::size_t f = 0; f < system_.frictions.size(); ++f)
    if (const int row = system_.frictions[f].row; state_.friction[f].phase == FrictionPhase::stick && left_out_[row] != 0)
      anchor_friction(system_, state_, static_cast<int>(f), statics_.motion().data());
}

DescentEnd Descent::run() {
  const OneThread alone;
  statics_.evaluate(state_);
  follow_friction(state_.q);
  const std::vector<double> given = state_.q;
  linearise();
  if (!project()) state_.q = given;
  int failures = 0;
  for (iterations_ = 0; iterations_ < most_iterations_ && !is_exhausted(); ++iterations_) {
    throw_if_stopped(k_where);
    linearise();
    if (iterations_ == 0) yielding_at_start_ = landscape_->count_yielding();
    const VecX newton = landscape_->newton_step();
    const bool is_pushed = landscape_->is_pushed();
    const double left = newton.size() > 0 ? newton.cwiseAbs().maxCoeff() : 0.0;
    if (!is_pushed && left <= (failures > 0 ? k_nearly_balanced : k_balanced) * length_) {
      polish();
      if (leave_saddle()) continue;
      finish();
      return DescentEnd::rest;
    }
    if (landscape_->is_skew() && !is_pushed && step_size(newton) <= 0.5 && polish()) {
      follow_friction(state_.q);
      continue;
    }
    if (advance(landscape_->trust_step([this](const VecX& step) { return step_size(step); }))) {
      failures = 0;
      if (has_run_away()) return DescentEnd::runs_away;
      continue;
    }
    if (++failures > 20) break;
    radius_ *= 0.1;
    turn_ *= 0.1;
  }
  finish();
  runaway_ = largest_part(landscape_->acceleration());
  driving_force_ = std::abs(statics_.force()[3 * runaway_.body - 3 + runaway_.coordinate]);
  return DescentEnd::no_way;
}

} // namespace steplap

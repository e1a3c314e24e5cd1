#include "mbd/rest/equilibrium.h"

#include "mbd/base/stop.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/events/blow.h"
#include "mbd/rest/admissible_rest.h"
#include "mbd/rest/descent.h"
#include "mbd/rest/indifference.h"
#include "mbd/rest/ramped_rest.h"
#include "mbd/rest/settling.h"
#include "mbd/system/element_failure.h"
#include "mbd/system/one_sided_row.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace steplap {

namespace {

constexpr double k_admissible = 1.0 + 1e-9; // largest utilisation of friction at an equilibrium; the excess is rounding at stiff contacts
constexpr double k_least_used = 1e-9;       // smaller utilisations are rounding
constexpr double k_flowed = 1e-12;          // fraction of the model's size; smaller slides of elastic joints are rounding
constexpr int k_most_flows = 200;
// A taut rope counts as pushing only beyond this multiple of its tension's rounding error, since accelerations at an equilibrium are known
// to about 1e-9 m/s² only.
constexpr double k_pushes = 1e3;
constexpr double k_on_rows = 1e-12;            // m, rad
constexpr std::size_t k_most_rope_changes = 8; // per rope
constexpr double k_short = 0.999;
constexpr int k_most_slips = 12;   // of one friction element before the search fails
constexpr int k_most_shared = 150; // coordinates of the largest model for which all admissible friction forces are searched
// Fraction of the model's size. If contacts slid further, held by friction alone, the machine did not stand.
constexpr double k_stands = 1e-2;
constexpr double k_slid = 1e-9; // share of the size of the model; rows of sticking friction are met to 1e-12 m
constexpr double k_at_bound =
    1.0 - 1e-4; // share of its bound from which friction that has slid slides on; five times less than forces are asked for
constexpr double k_most_moved = 0.1;          // sizes of the model, rad: a body that moves further in one increment has left its place
constexpr double k_anywhere = 1e4;            // sizes of the model
constexpr double k_far_from_bound = 0.99;     // utilisation up to which friction does not slide in the shortest increment
constexpr int k_most_sets = 16;               // of sliding friction, tried for one increment
constexpr double k_balanced_use = 1.0 + 1e-6; // utilisation of friction that has just slid; time steps know forces to 1e-6

std::string rounded(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// A friction element that slid during the search.
struct Slip {
  int friction = 0;
  double used = 0.0; ///< utilisation just before it first slid
  double from = 0.0; ///< value of its row at that time, m or rad
  int times = 0;
  bool is_least = false;  ///< `used` is the least value over all admissible friction forces
  bool is_new = true;     ///< slides since the last descent
  bool gives_way = false; ///< while it slid, nothing else resisted the motion
};

// Failure of the search because friction between touching bodies gave way.
class SlidingFailure : public ElementFailure {
public:
  SlidingFailure(const std::string& message, std::vector<std::string> names, const Slip& slip)
      : ElementFailure(message, std::move(names)), friction_(slip.friction), from_(slip.from) {}
  [[nodiscard]] int friction() const { return friction_; }
  [[nodiscard]] double from() const { return from_; } ///< value of its row when it first gave way

private:
  int friction_ = 0;
  double from_ = 0.0;
};

std::string unstable_text(const System& system, const MotionPart& nudge) {
  return "a pose on the way balances, but not stably: a nudge of " + part_text(system, nudge) + " leaves it";
}

class RestSearch {
public:
  RestSearch(const System& system, const State& start, RestAlgebra algebra)
      : system_(system), algebra_(algebra), start_(start), state_(start) {
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
    start_drives(system_, state_);
    for (FrictionState& friction : state_.friction)
      if (friction.phase != FrictionPhase::apart) friction.phase = FrictionPhase::free;
    (void)set_ropes(system_, state_);
  }

  Equilibrium run() {
    if (system_.body_count() <= 1) return at_rest();
    try {
      return search();
    } catch (const SlidingFailure& none) {
      return settled(none, &none);
    } catch (const ElementFailure& none) {
      if (system_.units.empty() && system_.frictions.empty()) throw;
      return settled(none, nullptr);
    }
  }

  // Returns the rest under loads that differ a little from those of `before`: with a consistent set of sliding friction, or else where the
  // machine creeps to.
  RampedRest run_increment(const RampedRest& before, bool may_creep) {
    if (system_.body_count() <= 1) return {at_rest(), {}};
    length_ = scale_of(system_, start_).length;
    if (!find_sliding_set(before)) {
      if (!may_creep) throw RestNotFound("no static equilibrium found with a consistent set of sliding friction", {});
      creep(before.sliding);
      hold_where_it_is();
      if (balance(k_most_moved) != DescentEnd::rest) throw RestNotFound("no static equilibrium found where the machine creeps to", {});
    }
    std::vector<int> sliding = note_slides();
    check_increment();
    return {at_rest(), std::move(sliding)};
  }

  // Returns the rest with all friction sticking; nothing if friction slides, or if it is not known. Throws if the machine leaves its place.
  std::optional<Equilibrium> run_still() {
    const DescentEnd end = balance(k_anywhere);
    if (end == DescentEnd::no_way) return {};
    note_tipping();
    if (result_.turned != 0.0) away_ = {result_.turned_body, 2, result_.turned < 0.0 ? -1.0 : 1.0};
    if (end == DescentEnd::runs_away || !result_.left.empty() || result_.turned != 0.0) leave_place(away_);
    if (!overloads_.empty() || has_slid_beside(start_)) return {};
    return at_rest();
  }

private:
  // Balances forces with a set of friction sliding at its bound, first that of `before`, and all other friction sticking at its place in the
  // start. Overloaded friction enters the set, friction that would slide back leaves it. Returns true once each element agrees with the set:
  // that is the implicit increment of friction, exact for the normal forces of its end. Otherwise state_ is the start again. Throws if the
  // machine leaves its place although friction is far from its bounds.
  bool find_sliding_set(const RampedRest& before) {
    const State start = state_;
    State with_set = start;
    for (const int f : before.sliding) set_sliding(with_set, f, start_.friction[f]);
    std::vector<std::vector<int>> tried;
    while (static_cast<int>(tried.size()) < k_most_sets && std::find(tried.begin(), tried.end(), sliding_in(with_set)) == tried.end()) {
      tried.push_back(sliding_in(with_set));
      state_ = with_set;
      result_ = {};
      DescentEnd end = DescentEnd::no_way;
      try {
        end = balance(k_most_moved);
      } catch (const RunStopped&) {
        throw;
      } catch (const NumericalFailure&) { // the search came to a pose without a direction
        if (flows_ > 0) throw;            // an elastic joint slips
        break;
      }
      const auto is_far = [](const FrictionMargin& margin) { return margin.used < k_far_from_bound; };
      const bool has_left = end == DescentEnd::runs_away || !result_.left.empty();
      if (has_left && std::all_of(before.margins.begin(), before.margins.end(), is_far)) leave_place(away_);
      if (has_left || end != DescentEnd::rest) break;
      if (change_sliding_set(with_set)) continue;
      if (has_slid_beside(with_set)) break;
      release_unloaded();
      return true;
    }
    state_ = start;
    result_ = {};
    return false;
  }

  static void set_sliding(State& state, int f, const FrictionState& direction) {
    state.friction[f] = direction;
    state.friction[f].phase = FrictionPhase::slip;
    state.friction[f].is_onset = false;
  }

  [[nodiscard]] bool is_sliding_in(const State& state, int f) const {
    return state.friction[f].phase == FrictionPhase::slip && !system_.frictions[f].friction->never_slips(); // excludes slack ropes
  }

  [[nodiscard]] std::vector<int> sliding_in(const State& state) const {
    std::vector<int> sliding;
    for (int f = 0; f < static_cast<int>(state.friction.size()); ++f)
      if (is_sliding_in(state, f)) sliding.push_back(f);
    return sliding;
  }

  // Frees friction that has slid and is without load at the end.
  void release_unloaded() {
    Statics statics(system_);
    statics.evaluate(state_);
    for (const int f : sliding_in(state_))
      if (!system_.frictions[f].friction->is_loaded(statics.evaluation(), state_.friction[f]))
        state_.friction[f].phase = FrictionPhase::free;
  }

  // Adapts the set of sliding friction in `with_set` to the equilibrium found with it. Returns false if all friction agrees with the set.
  bool change_sliding_set(State& with_set) {
    bool is_changed = false;
    for (int f = 0; f < static_cast<int>(with_set.friction.size()); ++f) {
      if (!is_sliding_in(with_set, f) || slid_since_start(f) * with_set.friction[f].sign >= -k_slid * length_) continue;
      with_set.friction[f].phase = FrictionPhase::free; // sticks where it is loaded
      is_changed = true;
    }
    if (is_changed || overloads_.empty()) return is_changed;
    const auto worst =
        std::max_element(overloads_.begin(), overloads_.end(), [](const Overload& a, const Overload& b) { return a.used < b.used; });
    const int f = worst->friction;
    const FrictionElement& element = *system_.frictions[f].friction;
    if (element.dimension() > 1) throw ElementFailure("no static equilibrium: '" + name_of(f) + "' slips", {name_of(f)});
    Statics statics(system_);
    statics.evaluate(state_);
    FrictionState direction = state_.friction[f];
    element.set_onset_direction(statics.evaluation(), direction, worst->wrench);
    set_sliding(with_set, f, direction);
    return true;
  }

  // Returns true if friction that is not in the set of `with_set` has slid since the start, or if some of the set sticks.
  [[nodiscard]] bool has_slid_beside(const State& with_set) const {
    for (int f = 0; f < static_cast<int>(state_.friction.size()); ++f) {
      if (system_.frictions[f].friction->never_slips()) continue;
      const bool should_slide = is_sliding_in(with_set, f), sticks = state_.friction[f].phase == FrictionPhase::stick;
      if (should_slide ? sticks : std::abs(slid_since_start(f)) > k_slid * length_) return true;
    }
    return false;
  }

  [[noreturn]] void leave_place(const MotionPart& part) const {
    throw ElementFailure("no static equilibrium: " + part_text(system_, part) + " leaves its place", {system_.bodies[part.body].name});
  }

  // Releases the machine at its start, where friction holds except for `sliding`.
  void creep(const std::vector<int>& sliding) {
    state_ = start_;
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
    start_drives(system_, state_);
    for (const int f : sliding) state_.friction[f].phase = FrictionPhase::slip;
    const Settling settling = settle_near(system_, with_drives_held(), k_most_moved);
    if (settling.away) leave_place(*settling.away);
    if (!settling.rest) {
      const std::string steps = std::to_string(settling.steps);
      throw RestNotFound(settling.is_tried ? "no static equilibrium found in " + steps + " steps" : "the scene is too large to be let go",
                         {});
    }
    State rest = *settling.rest;
    rest.bases = held_bases(rest);
    state_ = rest;
    result_.settling_steps = settling.steps;
  }

  // Notes friction that has slid in this increment, and returns that which slides on: it ends at its bound, against its slide.
  std::vector<int> note_slides() {
    std::vector<int> sliding;
    Statics statics(system_);
    statics.evaluate(state_);
    for (const FrictionMargin& margin : result_.margins) {
      const int f = margin.friction;
      const double slid = slid_since_start(f);
      if (std::abs(slid) <= k_slid * length_ || state_.friction[f].phase == FrictionPhase::free) continue;
      result_.slid.push_back(f);
      FrictionState& friction = state_.friction[f];
      friction.sign = slid > 0.0 ? 1 : -1;
      double bound[3];
      statics.slip_wrench(f, bound);
      if (forces_[system_.frictions[f].row] * bound[0] >= k_at_bound * bound[0] * bound[0]) sliding.push_back(f);
    }
    return sliding;
  }

  // Returns the displacement of a friction's row since the start, the largest one in a plane; 0 for friction without load there.
  [[nodiscard]] double slid_since_start(int f) const {
    const FrictionUnit& unit = system_.frictions[f];
    if (start_.friction[f].phase != FrictionPhase::stick) return 0.0;
    std::vector<Motion<double>> before, now;
    place_bodies(start_.q, state_.v, before);
    place_bodies(state_.q, state_.v, now);
    double most = 0.0;
    for (int r = 0; r < unit.friction->dimension(); ++r) {
      const RowSpec& row = unit.friction->rows(start_.friction[f])[r];
      const double slid = evaluate_row<false>(row, now.data()).value - evaluate_row<false>(row, before.data()).value;
      if (std::abs(slid) > std::abs(most)) most = slid;
    }
    return most;
  }

  void hold_where_it_is() {
    for (int f = 0; f < static_cast<int>(state_.friction.size()); ++f) {
      if (state_.friction[f].phase != FrictionPhase::slip || system_.frictions[f].friction->never_slips()) continue; // excludes slack ropes
      state_.friction[f].phase = FrictionPhase::stick;
      anchor_friction(system_, state_, f);
    }
  }

  // Balances forces with friction sticking where it is, and finds the margins. `reach`: see Descent.
  DescentEnd balance(double reach) {
    do {
      Descent descent(system_, state_, algebra_);
      descent.follow_increment(reach);
      const DescentEnd end = descent.run();
      take_over(descent);
      away_ = end == DescentEnd::rest && !result_.left.empty() ? result_.left.front() : descent.runaway();
      if (end != DescentEnd::rest) return end;
      find_margins(descent);
      if (let_flow()) throw ElementFailure("no static equilibrium: an elastic joint slips", {}); // as a rigid one, see check_increment
    } while (change_ropes());
    return DescentEnd::rest;
  }

  // Throws if a joint that friction holds in the plane slipped, because its sliding is not followed, or if friction of contacts slid far,
  // because then nothing else held the body.
  void check_increment() const {
    for (const int f : result_.slid) {
      if (system_.frictions[f].friction->dimension() > 1)
        throw ElementFailure("no static equilibrium: '" + name_of(f) + "' slips", {name_of(f)});
      if (std::abs(slid_since_start(f)) <= k_stands * length_ || !is_of_contacts(f)) continue;
      const RowSpec& row = *system_.frictions[f].friction->rows(start_.friction[f]);
      const std::string& body = system_.bodies[row.a == k_ground ? row.b : row.a].name;
      throw ElementFailure("no static equilibrium: '" + name_of(f) + "' cannot hold, and '" + body + "' slides", {name_of(f), body});
    }
    for (const Overload& overload : overloads_)
      if (overload.used > k_balanced_use)
        throw RestNotFound("no static equilibrium found: '" + name_of(overload.friction) + "' would have to hold " +
                               rounded(overload.used) + " times what it can",
                           {name_of(overload.friction)});
    if (!result_.left.empty()) leave_place(result_.left.front());
  }

  // Releases the machine with strong damping and repeats the search from its final pose. `none`: failure of the first search;
  // `slid`: the same, if friction gave way.
  Equilibrium settled(const ElementFailure& none, const SlidingFailure* slid) {
    state_ = start_;
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
    start_drives(system_, state_);
    const Settling settling = settle_in_time(system_, with_drives_held());
    if (!settling.is_tried)
      throw ElementFailure(std::string(none.what()) + "; the scene is too large to be released and damped", none.elements());
    const std::string tried = std::string(none.what()) + "; released and strongly damped, it does not come to rest either (" +
                              std::to_string(settling.steps) + " time steps)";
    if (!settling.rest) throw ElementFailure(tried, none.elements());
    const int iterations = result_.iterations;
    State rest = *settling.rest;
    rest.bases = held_bases(rest);
    state_ = rest;
    // A body that slid away did not stand, even if it came to rest somewhere.
    if (const double way = slid ? std::abs(row_value(slid->friction()) - slid->from()) : 0.0; way > k_stands * length_)
      throw ElementFailure(std::string(none.what()) +
                               ". It does not stand as given; released and strongly damped, it comes to rest after " + rounded(way) +
                               " m of sliding",
                           none.elements());
    result_ = {};
    slips_.clear();
    result_.iterations = iterations;
    result_.settling_steps = settling.steps;
    result_.is_settled = true;
    try {
      return search();
    } catch (const ElementFailure&) {
      throw ElementFailure(tried, none.elements());
    }
  }
  // Returns the bases of all rows: those of drives unchanged, friction anchors as in `rest`.
  [[nodiscard]] std::vector<RowBase> held_bases(const State& rest) const {
    std::vector<RowBase> bases = rest.bases;
    for (const RowSpec& row : system_.rows)
      if (row.drive) bases[row.base] = state_.bases[row.base];
    return bases;
  }

  Equilibrium search() {
    while (true) {
      Descent descent(system_, state_, algebra_);
      const DescentEnd end = descent.run();
      take_over(descent);
      if (descent.yielding_at_start() > yielding_)
        for (Slip& slip : slips_) slip.gives_way = slip.gives_way || slip.is_new;
      for (Slip& slip : slips_) slip.is_new = false;
      yielding_ = descent.yielding();
      if (end != DescentEnd::rest && tighten_long()) continue;
      if (end != DescentEnd::rest) fail(descent, end);
      if (let_flow()) continue;
      find_margins(descent);
      if (change_ropes()) continue;
      if (overloads_.empty()) break;
      if (result_.is_settled || !share_anew(descent)) let_go(); // after settling the load is distributed already
    }
    check_slides();
    return at_rest();
  }

  void take_over(const Descent& descent) {
    result_.iterations += descent.iterations();
    result_.residual = descent.residual();
    result_.indifferent = descent.indifferent();
    result_.more_indifferent = descent.more_indifferent();
    result_.left.insert(result_.left.end(), descent.left().begin(), descent.left().end());
    length_ = std::max(length_, descent.length());
  }

  Equilibrium at_rest() {
    hold_where_it_is();
    for (const Slip& slip : slips_) result_.slid.push_back(slip.friction);
    result_.depends_on_path = (result_.is_settled || !result_.slid.empty()) && !result_.margins.empty();
    note_drives();
    result_.state = state_;
    result_.state.v = start_.v;
    note_tipping();
    for (std::size_t i = 3; i < start_.q.size(); ++i)
      if (i % 3 < 2) result_.moved = std::max(result_.moved, std::abs(state_.q[i] - start_.q[i]));
    return std::move(result_);
  }

  // Lets elastic joints that exceed their bound slide until they are on the bound, which changes the equilibrium. Returns true if one slid.
  bool let_flow() {
    if (system_.inner_groups.empty()) return false;
    Statics statics(system_);
    statics.evaluate(state_);
    const std::vector<double> before = state_.inner;
    for (const ForceGroup* group : system_.inner_groups) (void)group->project_inner(statics.evaluation(), state_.inner.data());
    double most = 0.0, along = 0.0, square = 0.0;
    std::vector<double> flow(before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      flow[i] = state_.inner[i] - before[i];
      most = std::max(most, std::abs(flow[i]));
      if (i < last_flow_.size()) along += flow[i] * last_flow_[i], square += last_flow_[i] * last_flow_[i];
    }
    if (most <= k_flowed * length_) return false;
    // A joint that slides gets back a part of its load, depending on the stiffness parallel to it. Successive slides therefore form a
    // geometric series. Its sum is extrapolated at every second slide, with a factor slightly below 1 so as not to slide too far.
    const double ratio = square > 0.0 ? along / square : 0.0;
    const double rest = ratio > 0.0 && ratio < 1.0 ? k_short * ratio / (1.0 - ratio) : 0.0;
    if (++flows_ > k_most_flows || ratio >= 1.0 || rest * most > length_)
      throw NumericalFailure(
          "no static equilibrium found: an elastic joint slides without end, since no other element carries the load that it loses");
    last_flow_ = rest > 0.0 ? std::vector<double>() : flow;
    for (std::size_t i = 0; i < flow.size(); ++i) state_.inner[i] += rest * flow[i];
    return true;
  }

  // Returns the state with all drives at their present values and zero rates, so that the equations of motion describe a machine at rest.
  [[nodiscard]] State with_drives_held() const {
    State held = state_;
    for (const RowSpec& row : system_.rows) {
      if (!row.drive) continue;
      const double now = static_target(row, state_);
      held.bases[row.base].rate = -row.drive->drive(state_.t, row.level).rate;
      held.bases[row.base].value += now - static_target(row, held);
    }
    return held;
  }

  void find_margins(const Descent& descent) {
    result_.margins.clear();
    overloads_.clear();
    pushing_.clear();
    if (system_.frictions.empty()) return;
    const State held = with_drives_held();
    Dynamics dynamics(system_);
    dynamics.set_state(held);
    std::vector<double> y(static_cast<std::size_t>(dynamics.dimension())), dy(y.size());
    dynamics.pack(held, y.data());
    dynamics.rates(held.t, y.data(), dy.data());
    dynamics.evaluate_rigid_joint_events(dy.data());
    const LoadSharing* const sharing = dynamics.sharing();
    std::vector<double>& wrench = forces_;
    wrench.assign(system_.friction_row_count, 0.0);
    const std::vector<StaticRow>& rows = descent.statics().rows();
    for (std::size_t r = 0; r < rows.size(); ++r)
      if (rows[r].friction >= 0) wrench[rows[r].friction_row] = descent.multipliers()[static_cast<Eigen::Index>(r)];
    for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
      const FrictionUnit& unit = system_.frictions[f];
      const FrictionPhase phase = state_.friction[f].phase;
      if (const OneSidedRow* rope = unit.rope; rope && phase == FrictionPhase::stick && wrench[unit.row] > k_pushes * rope->rest_tension)
        pushing_.push_back({f, {wrench[unit.row], 0.0, 0.0}, 0.0});
      if ((phase != FrictionPhase::stick && phase != FrictionPhase::slip) || unit.friction->never_slips()) continue;
      double* const own = &wrench[unit.row];
      if (phase == FrictionPhase::slip) descent.statics().slip_wrench(f, own);
      const int group = sharing && phase == FrictionPhase::stick ? sharing->group_of(f) : -1;
      FrictionMargin margin{f, share_used(descent.statics().evaluation(), f, own), group >= 0};
      if (group >= 0) margin.used = sharing->groups()[group].least.usage();
      result_.margins.push_back(margin);
      if (phase == FrictionPhase::slip || margin.used <= k_admissible) continue;
      if (group < 0) {
        overloads_.push_back({f, {0.0, 0.0, 0.0}, margin.used});
        std::copy_n(own, unit.friction->dimension(), overloads_.back().wrench);
        continue;
      }
      for (const Release& release : sharing->releases(group))
        if (release.friction == f) overloads_.push_back({f, {release.wrench[0], 0.0, 0.0}, margin.used});
    }
  }

  // Changes the phase of one rope: a taut rope that would have to push becomes slack, a slack rope that is too long becomes taut. Returns
  // true if a rope changed.
  bool change_ropes() {
    const auto worst =
        std::max_element(pushing_.begin(), pushing_.end(), [](const Overload& a, const Overload& b) { return a.wrench[0] < b.wrench[0]; });
    if (worst != pushing_.end()) {
      state_.friction[worst->friction].phase = FrictionPhase::slip;
      return count_rope(worst->friction);
    }
    std::vector<Motion<double>> motion;
    place_bodies(state_.q, state_.v, motion);
    for (const auto& [rope, f] : one_sided_rows(system_)) {
      if (state_.friction[f].phase == FrictionPhase::stick || rope->left(motion.data()) >= -OneSidedRow::k_at_length * rope->length)
        continue;
      state_.friction[f].phase = FrictionPhase::stick;
      try {
        put_on_rows();
      } catch (const ConstraintFailure&) { // an element that slid sticks elsewhere now and conflicts with the rope, so it is released
        free_contacts();
        put_on_rows();
      }
      return count_rope(static_cast<int>(f));
    }
    return false;
  }
  bool count_rope(int f) {
    if (++rope_changes_ <= k_most_rope_changes * system_.frictions.size()) return true;
    throw ElementFailure("no static equilibrium found: whether '" + name_of(f) + "' and other ropes are taut at rest cannot be decided",
                         {name_of(f)});
  }
  // Called for a body that moves without end. Ropes that were slack at the start may hold it: those that it has stretched are set taut, at
  // the poses of the start. Returns true if the search must be repeated.
  bool tighten_long() {
    std::vector<Motion<double>> motion;
    place_bodies(state_.q, state_.v, motion);
    int changed = -1;
    for (const auto& [rope, f] : one_sided_rows(system_)) {
      if (state_.friction[f].phase == FrictionPhase::stick || rope->left(motion.data()) >= 0.0) continue;
      state_.friction[f].phase = FrictionPhase::stick;
      changed = static_cast<int>(f);
    }
    if (changed < 0) return false;
    const std::vector<double> ran_to = state_.q;
    state_.q = start_.q;
    try {
      put_on_rows();
    } catch (const ConstraintFailure&) { // not all of them can be taut
      state_.q = ran_to;
      return false;
    }
    return count_rope(changed);
  }
  // Releases sticking friction of contacts. In the next descent it sticks again where it gains normal force.
  void free_contacts() {
    for (int f = 0; f < static_cast<int>(state_.friction.size()); ++f)
      if (state_.friction[f].phase == FrictionPhase::stick && !system_.frictions[f].rope && is_of_contacts(f))
        state_.friction[f].phase = FrictionPhase::free;
  }
  void put_on_rows() {
    Dynamics dynamics(system_);
    dynamics.set_state(state_);
    std::vector<double> y(static_cast<std::size_t>(dynamics.dimension()));
    dynamics.pack(state_, y.data());
    dynamics.project(state_.t, y.data(), k_on_rows);
    dynamics.unpack(state_.t, y.data(), state_);
    std::fill(state_.v.begin(), state_.v.end(), 0.0);
  }

  [[nodiscard]] double share_used(const Evaluation& evaluation, int f, const double* wrench) const {
    const FrictionElement& element = *system_.frictions[f].friction;
    double size = 0.0, normal[3];
    for (int r = 0; r < element.dimension(); ++r) size = std::max(size, std::abs(wrench[r]));
    const double used = size == 0.0 ? 0.0 : element.gauge(evaluation, state_.friction[f], wrench, normal);
    return used < k_least_used ? 0.0 : used;
  }

  // Returns true if the bound of the friction element comes from contacts, that is, if it carries no load with all contacts open. Elements
  // with three dimensions belong to joints.
  [[nodiscard]] bool is_of_contacts(int f) const {
    const FrictionElement& friction = *system_.frictions[f].friction;
    if (friction.dimension() > 1) return false;
    Statics statics(system_);
    State state = state_;
    statics.evaluate(state);
    const std::vector<UnitMode> open(system_.units.size(), k_contact_open);
    Evaluation apart = statics.evaluation();
    apart.mode = open.data();
    return !friction.is_loaded(apart, state.friction[f]);
  }
  [[nodiscard]] double row_value(int f) const {
    std::vector<Motion<double>> motion;
    place_bodies(state_.q, state_.v, motion);
    return evaluate_row<false>(*system_.frictions[f].friction->rows(state_.friction[f]), motion.data()).value;
  }

  // Sticking forces are not determined by statics, since they depend on the history of loading. Searches for other admissible friction
  // forces that hold the machine, and returns true if there are any.
  bool share_anew(const Descent& descent) {
    if (was_shared_anew_) return false;
    // This search uses dense algebra, which takes hours in large models. In these, overloaded friction slides until it sticks.
    if (3 * (system_.body_count() - 1) > k_most_shared) {
      is_too_large_ = true;
      return false;
    }
    const OneThread alone;
    const auto rest = admissible_rest(system_, state_, descent.scale(), length_);
    if (!rest) return false;
    least_usage_ = rest->usage;
    if (rest->usage > 1.0) return false;
    was_shared_anew_ = true;
    state_ = rest->state;
    return true;
  }

  // Lets the most overloaded friction elements slide, and those that share the load with them.
  void let_go() {
    const auto worst =
        std::max_element(overloads_.begin(), overloads_.end(), [](const Overload& a, const Overload& b) { return a.used < b.used; });
    for (const Overload& overload : overloads_) {
      if (overload.used < worst->used) continue;
      const int f = overload.friction;
      const FrictionElement& element = *system_.frictions[f].friction;
      if (element.dimension() > 1)
        throw ElementFailure("no static equilibrium: '" + name_of(f) + "' would have to hold " + rounded(overload.used) +
                                 " times what it can",
                             {name_of(f)});
      auto slip = std::find_if(slips_.begin(), slips_.end(), [f](const Slip& s) { return s.friction == f; });
      if (slip == slips_.end()) {
        const bool is_least = least_usage_ > 1.0;
        slip = slips_.insert(slips_.end(), {f, is_least ? least_usage_ : overload.used, row_value(f), 0, is_least});
      }
      slip->is_new = true;
      if (++slip->times > k_most_slips) fail_sliding(*slip);
      Statics statics(system_);
      statics.evaluate(state_);
      element.set_onset_direction(statics.evaluation(), state_.friction[f], overload.wrench);
      state_.friction[f].phase = FrictionPhase::slip;
    }
    was_shared_anew_ = false;
  }

  void check_slides() const {
    for (const Slip& slip : slips_)
      if (slip.gives_way && is_of_contacts(slip.friction) && std::abs(row_value(slip.friction) - slip.from) > k_stands * length_)
        fail_sliding(slip);
  }

  [[nodiscard]] std::string name_of(int f) const { return system_.element_names[system_.frictions[f].element]; }
  [[nodiscard]] std::string overload_text(const Slip& slip) const {
    if (std::isinf(slip.used)) return "'" + name_of(slip.friction) + "' would have to hold and can hold nothing";
    if (!slip.is_least)
      return "'" + name_of(slip.friction) + "' would have to hold " + rounded(slip.used) + " times what it can" +
             (is_too_large_ ? " (as the load came to be shared; other ways are not looked for in scenes of this size)" : "");
    return "friction ('" + name_of(slip.friction) + "' and what shares its load) would have to hold " + rounded(slip.used) +
           " times what it can, whichever way the load is shared";
  }
  [[noreturn]] void fail_sliding(const Slip& slip) const {
    const RowSpec& row = *system_.frictions[slip.friction].friction->rows(state_.friction[slip.friction]);
    const int body = row.a == k_ground ? row.b : row.a;
    throw SlidingFailure("no static equilibrium: " + overload_text(slip) + ", and '" + system_.bodies[body].name + "' slides",
                         {name_of(slip.friction), system_.bodies[body].name}, slip);
  }
  [[noreturn]] void fail(const Descent& descent, DescentEnd end) const {
    const MotionPart& part = descent.runaway();
    const std::string unit = part.coordinate == 2 ? " N m" : " N";
    // If an unstable equilibrium was found, the message says that there is no stable one.
    std::string text = "no static equilibrium: ";
    if (!result_.left.empty()) text = "no stable equilibrium: " + unstable_text(system_, result_.left.front()) + "; downhill from there ";
    if (!slips_.empty()) text += overload_text(slips_.front()) + "; ";
    if (end == DescentEnd::runs_away)
      text += part_text(system_, part) + " moves without end: nothing holds it against the " + rounded(descent.driving_force()) + unit +
              " that drive it";
    else
      text += "none was found; forces do not balance on " + part_text(system_, part) + " (" + rounded(descent.residual()) +
              " m/s² are left after " + std::to_string(descent.iterations()) + " steps)";
    std::vector<std::string> names;
    if (!slips_.empty()) names.push_back(name_of(slips_.front().friction));
    names.push_back(system_.bodies[part.body].name);
    if (end == DescentEnd::no_way) throw RestNotFound(text, std::move(names));
    throw ElementFailure(text, std::move(names));
  }

  // Records the body without joints to the ground that turned furthest, if it tipped over.
  void note_tipping() {
    if (system_.contact_count == 0) return;
    const std::vector<char> is_led = led_bodies(system_);
    for (int i = 1; i < system_.body_count(); ++i) {
      const double turn = state_.q[3 * i + 2] - start_.q[3 * i + 2];
      if (is_led[i] || std::abs(turn) < k_overturned || std::abs(turn) < std::abs(result_.turned)) continue;
      result_.turned = turn;
      result_.turned_body = i;
    }
  }

  void note_drives() {
    for (const RowSpec& row : system_.rows) {
      if (!row.drive) continue;
      const SignalJet jet = row.drive->drive(state_.t, row.level);
      const bool is_moving = row.level != DriveLevel::acceleration && jet.rate != 0.0;
      if (is_moving || jet.acceleration != 0.0) result_.moving_drives.push_back(row.element);
    }
  }

  struct Overload {
    int friction = 0;
    double wrench[3] = {0, 0, 0};
    double used = 0.0;
  };

  const System& system_;
  const RestAlgebra algebra_;
  int flows_ = 0;                 ///< slides of elastic joints in this search
  std::vector<double> last_flow_; ///< slide of each inner state at the last call of let_flow()
  const State& start_;
  State state_;
  double length_ = 0.0;
  int yielding_ = 0;         ///< directions without resistance at the last equilibrium
  double least_usage_ = 0.0; ///< least utilisation over all admissible friction forces, if it was searched
  bool was_shared_anew_ = false;
  bool is_too_large_ = false;  ///< the model is too large for that search
  MotionPart away_;            ///< motion with which the last descent left its start
  std::vector<double> forces_; ///< of friction at the last equilibrium, per row
  std::vector<Slip> slips_;
  std::vector<Overload> overloads_;
  std::vector<Overload> pushing_; ///< taut ropes that would have to push, with their wrenches
  std::size_t rope_changes_ = 0;
  Equilibrium result_;
};

} // namespace

std::string part_text(const System& system, const MotionPart& part) {
  const std::string name = "'" + system.bodies[part.body].name + "'";
  if (part.coordinate == 2) return name + " turning " + (part.sign < 0.0 ? "clockwise" : "counter-clockwise");
  return name + " along " + (part.sign < 0.0 ? "-" : "+") + (part.coordinate == 0 ? "x" : "y");
}

std::vector<std::string> remarks_on(const System& system, const Equilibrium& found) {
  std::vector<std::string> remarks;
  if (found.depends_on_path && found.is_settled)
    remarks.push_back(
        "friction holds it where it came to rest when released from the given pose with strong damping: this rest is one of many, "
        "need not be the nearest, and depends on the path");
  else if (found.depends_on_path)
    remarks.push_back("friction holds it where it slid to: this rest is one of many, need not be the nearest, and "
                      "it depends on the path");
  for (const MotionPart& nudge : found.left) remarks.push_back(unstable_text(system, nudge) + ", and so did the search");
  for (std::string& text : indifference_texts(system, found.indifferent)) remarks.push_back(std::move(text));
  if (found.more_indifferent > 0)
    remarks.push_back("indifferent: so it is in " + std::to_string(found.more_indifferent) + " more directions");
  if (found.turned != 0.0)
    remarks.push_back("'" + system.bodies[found.turned_body].name + "' turned by " + rounded(found.turned * 180.0 / std::numbers::pi) +
                      "° on the way to this rest: it does not stand as given");
  for (const int f : found.slid)
    remarks.push_back("'" + system.element_names[system.frictions[f].element] +
                      "' could not hold where it got its load: it slid to where it does");
  for (const int element : found.moving_drives)
    remarks.push_back("the drive '" + system.element_names[element] +
                      "' moves or accelerates at this time: this is the rest of the machine with the drive held");
  return remarks;
}

std::vector<char> led_bodies(const System& system) {
  std::vector<std::vector<int>> joined(system.bodies.size());
  for (const RowSpec& row : system.rows) {
    joined[row.a].push_back(row.b);
    joined[row.b].push_back(row.a);
  }
  std::vector<char> is_led(system.bodies.size(), 0);
  std::vector<int> next{k_ground};
  is_led[k_ground] = 1;
  while (!next.empty()) {
    const int body = next.back();
    next.pop_back();
    for (const int other : joined[body])
      if (std::exchange(is_led[other], char{1}) == 0) next.push_back(other);
  }
  return is_led;
}

Equilibrium find_equilibrium(const System& system, const State& start, RestAlgebra algebra) {
  return RestSearch(system, start, algebra).run();
}

std::optional<Equilibrium> find_still_rest(const System& system, const Equilibrium& start) {
  return RestSearch(system, start.state, RestAlgebra::by_size).run_still();
}

RampedRest rest_after_increment(const System& system, const RampedRest& before, bool may_creep) {
  return RestSearch(system, before.state, RestAlgebra::by_size).run_increment(before, may_creep);
}

} // namespace steplap

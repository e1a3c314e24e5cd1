// Handles events: switches modes of contacts, contact points and phases of friction. The phases of all affected friction elements are
// decided together.
#pragma once

#include "mbd/events/event_transaction.h"
#include "mbd/events/friction_modes.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns the utilisation |λ|/bound of a sticking element (u for a step-lap joint) from its event functions
/// (FrictionElement::stick_events()).
[[nodiscard]] double share_of_bound(const FrictionUnit& unit, const std::vector<double>& event_value);

/// Applies events to states of one system.
class EventHandler {
public:
  EventHandler(const System& system, Dynamics& dynamics);

  /// Determines modes and phases at the start: contacts by their gaps, friction by the mode problem.
  void start(State& state);
  /// Appends events for contacts and friction elements that slide from the start. Precondition: start(). Friction elements without capacity
  /// are not reported.
  void note_start(const State& state, std::vector<Event>& events) const;
  /// Handles an event at `state`: changes modes, phases and anchors, and appends to `events`. `fired`: slots of the event functions that
  /// became negative; empty at a breakpoint of a signal, where loads may jump. `event_value_before`: all event functions just before a
  /// breakpoint, otherwise null.
  void handle(State& state, const std::vector<int>& fired, const std::vector<double>* event_value_before, std::vector<Event>& events);
  /// Continues with a state converted from another system at the same time (mbd/simulation/changeover.h), in which other elements were
  /// active. `closes_rows`: new constraints may cause an impact.
  void take_over(State& state, bool closes_rows, std::vector<Event>& events);
  /// Decides all friction phases from accelerations. For use after a method that determines modes and phases itself (time stepping).
  void settle_phases(State& state);
  /// Appends the changes between two states of such a method, and clears fresh().
  void note_changes(const State& before, const State& state, std::vector<Event>& events);
  /// Appends the events that lead from one state to the other. Changes nothing else except stop_reason(). Precondition: the system has no
  /// inextensible ropes.
  void list_changes(const State& before, const State& state, std::vector<Event>& events);

  /// Returns a flag per slot: the unit or friction element changed in the last handle(). Input of EventFinder.
  [[nodiscard]] const std::vector<char>& fresh() const { return fresh_; }
  /// Returns the element that ended the run and the reason, as text; empty if none did.
  [[nodiscard]] const std::string& stop_reason() const { return stop_reason_; }
  /// Returns the kinetic energy, J, removed in the last handle() by setting residual velocities of sticking elements to zero.
  [[nodiscard]] double settled() const { return settled_; }
  /// Returns true if the last evaluation was made at the final state of handle(). packed() and rates() are then valid.
  [[nodiscard]] bool is_evaluated() const { return modes_.is_evaluated(); }
  [[nodiscard]] const double* packed() const { return modes_.packed(); }
  [[nodiscard]] const double* rates() const { return modes_.rates(); }
  /// Returns the simultaneous slips of the last handle(): `sticks` has a utilisation above 1 − k_near_bound.
  [[nodiscard]] const std::vector<SimultaneousSlip>& ties() const { return ties_; }
  static constexpr double k_near_bound = 1e-3;
  /// Returns the ropes and clutches with an impulse in the last start(), handle() or take_over().
  [[nodiscard]] const std::vector<RigidImpact>& blows() const { return blows_; }
  void clear_fresh() { std::fill(fresh_.begin(), fresh_.end(), 0); }

private:
  enum class Blow { ropes, rows };

  // Rules of an event, called by handle() in their order.
  bool switch_units(EventTransaction& event, const std::vector<int>& slots);
  void follow_breakpoint(EventTransaction& event);
  void follow_jumps(EventTransaction& event);
  void change_phases(EventTransaction& event);
  void resolve_rope_impacts(EventTransaction& event);
  void stop_ended_slips(EventTransaction& event);
  void update_loading(EventTransaction& event);
  void catch_reversals(EventTransaction& event);
  void decide_phases(EventTransaction& event);
  void meet_new_rows(EventTransaction& event);
  void record_simultaneous_slips(const EventTransaction& event);
  void conclude(EventTransaction& event);

  void begin_event();
  void strike(EventTransaction& event, Blow blow);
  void settle(EventTransaction& event);
  void settle(State& state);
  void load(EventTransaction& event, int f);
  void change_phase(EventTransaction& event, int f, FrictionWatch fired);
  void change_foot(EventTransaction& event, int f);
  void move_on(EventTransaction& event, int f, const FrictionState& from);
  [[nodiscard]] std::vector<int> slots_made_negative_by_jump(const EventTransaction& event, const std::vector<double>& before) const;
  [[noreturn]] void fail_on_pulley(EventTransaction& event, int f) const;

  void meet_constraints(State& state);
  void begin_units(State& state) const;
  void forget_moved_layouts(const State& state);
  void slip_rates(const State& state, const Motion<double>* motion, int f, double* rate) const;
  [[nodiscard]] static bool has_new_rows(const std::vector<FrictionState>& before, const State& state);
  [[nodiscard]] bool is_same_direction(std::size_t f, const FrictionState& a, const FrictionState& b) const;
  [[nodiscard]] bool has_capacity(const State& state, std::size_t f) const;
  [[nodiscard]] EventKind slip_kind(std::size_t f, const FrictionState& old, const FrictionState& now) const;

  void record_blows(const std::vector<Impact>& impacts_before, const State& state);
  void list_changes_within(const State& before, const State& state, std::vector<Event>& events) const;
  void list_unit_change(int u, UnitMode from, UnitMode to, double t, std::vector<Event>& events) const;
  [[nodiscard]] bool list_friction_change(std::size_t f, const FrictionState& old, const std::vector<Impact>& impacts_before,
                                          const State& state, std::vector<Event>& events);
  void list_friction_changes(const std::vector<FrictionState>& before, const std::vector<Impact>& impacts_before, const State& state,
                             std::vector<Event>& events);

  const System& system_;
  Dynamics& dynamics_;
  FrictionModes modes_;
  std::vector<int> unit_of_slot_, friction_of_slot_;
  std::vector<char> fresh_;
  std::string stop_reason_;
  double settled_ = 0.0;
  std::vector<double> y_, dy_;
  std::vector<SimultaneousSlip> ties_;
  std::vector<RigidImpact> blows_;
};

} // namespace steplap

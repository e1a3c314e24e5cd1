// Handles events: switches modes of contacts, contact points and phases of friction, and then decides the phases of all affected friction
// elements together.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/events/friction_modes.h"

#include <string>
#include <vector>

namespace steplap {

/// One entry of the event list.
struct Event {
  double t = 0.0;
  std::string element;
  EventKind kind = EventKind::none;
  std::string detail = {};     ///< additional text after the words of the kind; mostly empty
  double located_within = 0.0; ///< uncertainty of t, s: the event happened at most this long before t; 0 for events located by root finding

  /// Returns the text of the event for output, such as "slips forward". Not for comparisons.
  [[nodiscard]] std::string words() const;
  /// Returns true for an event at t = 0. Its time has no error, and it is not the same as a slip that begins later.
  [[nodiscard]] bool is_at_start() const { return t == 0.0; }
};

/// Rigid impact in which an element took part: its impulse is known, its force is not.
struct RigidBlow {
  double t = 0.0; ///< s
  std::string element;
};

/// Two elements that reach their friction bounds almost at once: one began to slip, the other one stuck close to its bound. Rounding
/// decides which one slips first.
struct SimultaneousSlip {
  double t = 0.0;     ///< time at which `slips` began to slip, s
  std::string slips;  ///< element that began to slip
  std::string sticks; ///< element that stuck before and after
  double share = 0.0; ///< utilisation of `sticks` just before the event
  double rate = 0.0;  ///< rate of change of that utilisation, 1/s, mean over the step before
};
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
  /// Handles an event at `state`: changes modes, phases and anchors, and appends events. `fired`: slots of the event functions that became
  /// negative; empty at a breakpoint of a signal, where loads may jump. `event_value_before`: all event functions just before a breakpoint,
  /// else null.
  void handle(State& state, const std::vector<int>& fired, const std::vector<double>* event_value_before, std::vector<Event>& events);
  /// Takes over a state from another system at the same time (mbd/simulation/changeover.h), in which some elements were active that are not
  /// now, or the reverse. `closes_rows`: new constraints may cause an impact.
  void take_over(State& state, bool closes_rows, std::vector<Event>& events);
  /// Marks an event function as zero up to rounding: it is not armed before it has been positive.
  void mark_fresh(int slot) { fresh_[slot] = 1; }

  /// Decides phases at acceleration level after a method that decides modes and phases itself (time stepping).
  void settle_phases(State& state);
  /// Appends the changes between two states, for such a method, and updates fresh().
  void note_changes(const State& before, const State& state, std::vector<Event>& events);
  /// Appends the events that lead from one state to the other. It changes nothing else except stop_reason(). Precondition: the system has
  /// no inextensible ropes.
  void list_changes(const State& before, const State& state, std::vector<Event>& events);

  /// Returns flags per slot: the unit or friction element changed in the last handle(). For EventFinder.
  [[nodiscard]] const std::vector<char>& fresh() const { return fresh_; }
  /// Returns which element ended the run and why; empty if none did.
  [[nodiscard]] const std::string& stop_reason() const { return stop_reason_; }
  /// Returns the kinetic energy removed in the last handle() by projecting residual velocities of sticking elements, J.
  [[nodiscard]] double settled() const { return settled_; }
  /// Returns true if the last evaluation belongs to the final state of handle(). packed() and rates() are then valid.
  [[nodiscard]] bool is_evaluated() const { return modes_.is_evaluated(); }
  [[nodiscard]] const double* packed() const { return modes_.packed(); }
  [[nodiscard]] const double* rates() const { return modes_.rates(); }
  /// Returns the ties of the last handle(): sticking elements with a utilisation above 1 − k_near_bound.
  [[nodiscard]] const std::vector<SimultaneousSlip>& ties() const { return ties_; }
  static constexpr double k_near_bound = 1e-3;
  /// Returns the ropes and clutches struck in the last start(), handle() or take_over().
  [[nodiscard]] const std::vector<RigidBlow>& blows() const { return blows_; }
  void clear_fresh() { std::fill(fresh_.begin(), fresh_.end(), 0); }

private:
  void meet_constraints(State& state);
  void begin_units(State& state) const;
  bool switch_units(State& state, const std::vector<int>& fired, std::vector<Event>& events);
  [[nodiscard]] std::vector<int> slots_made_negative_by_jump(const std::vector<double>& before) const;
  bool follow_jumps(State& state, const std::vector<double>* event_value_before, std::vector<Event>& events);
  void fire_friction(State& state, int f, FrictionWatch fired);
  void move_on(State& state, int f, const FrictionState& from);
  bool update_loading(State& state);
  void note_blows(const std::vector<Impact>& impacts_before, const State& state);
  void record_simultaneous_slips(const State& state, const std::vector<double>& event_value);
  [[nodiscard]] bool is_same_direction(std::size_t f, const FrictionState& a, const FrictionState& b) const;
  [[nodiscard]] bool has_capacity(const State& state, std::size_t f) const;
  [[nodiscard]] EventKind slip_kind(std::size_t f, const FrictionState& old, const FrictionState& now) const;
  void list_changes_within(const State& before, const State& state, std::vector<Event>& events) const;
  void list_unit_change(int u, UnitMode from, UnitMode to, double t, std::vector<Event>& events) const;
  [[nodiscard]] bool list_friction_change(std::size_t f, const FrictionState& old, const std::vector<Impact>& impacts_before,
                                          const State& state, std::vector<Event>& events);
  void note_friction(const std::vector<FrictionState>& before, const std::vector<Impact>& impacts_before, const State& state,
                     std::vector<Event>& events);
  void forget_moved_layouts(const State& state);
  void load(State& state, int f);
  struct Fired {
    bool is_any_at_rest = false;
    bool is_any_tight = false; ///< a rope has reached its length
  };
  Fired fire(State& state, const std::vector<int>& fired);
  [[noreturn]] void fail_on_pulley(const State& state, int f) const;
  enum class Blow { ropes, rows };
  bool strike(State& state, Blow blow, std::vector<Event>& events);
  void conclude(State& state, bool is_loading_changed, bool is_settled, std::vector<Event>& events);
  void slip_rates(const State& state, int f, double* rate);
  void settle(State& state);
  [[nodiscard]] static bool has_new_rows(const std::vector<FrictionState>& before, const State& state);

  const System& system_;
  Dynamics& dynamics_;
  FrictionModes modes_;
  std::vector<int> unit_of_slot_, friction_of_slot_;
  std::vector<char> fresh_;
  std::vector<char> has_switched_; ///< per slot: the mode has switched in the present event
  std::string stop_reason_;
  double settled_ = 0.0;
  std::vector<double> y_, dy_;
  std::vector<FrictionState> before_; ///< friction states at the start of handle()
  std::vector<Impact> impacts_before_;
  std::vector<double> event_value_before_; ///< event functions at the start of handle(), if two or more elements stuck
  std::vector<SimultaneousSlip> ties_;
  std::vector<RigidBlow> blows_;
  std::vector<char> is_released_;      ///< per group of LoadSharing
  std::vector<char> has_fired_;        ///< per friction element
  std::vector<Motion<double>> motion_; ///< scratch: motions of the bodies
};

} // namespace steplap

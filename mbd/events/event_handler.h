// What happens at an event: contacts change mode, friction changes place or phase, and all friction
// modes that this may upset are decided anew together.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/events/friction_modes.h"

#include <string>
#include <vector>

namespace steplap {

/// One line of the list of events.
struct Event {
  double t = 0.0;
  std::string element;
  EventKind kind = EventKind::none;
  std::string detail = {};     ///< for people, behind the words of the kind: mostly nothing
  double located_within = 0.0; ///< s: it happened at most so long before t; 0 of events that were closed in on

  /// As it is written, never compared: "slips forward".
  [[nodiscard]] std::string words() const;
  /// It slides from where runs begin: a time without error, and not that of a slip that begins later.
  [[nodiscard]] bool is_at_start() const { return t == 0.0; }
};

/// An element began to slip while another one stuck and was all but at its bound: which slips first is a matter of digits.
struct SlipTie {
  double t = 0.0;     ///< s, when `slips` began to slip
  std::string slips;  ///< element that began to slip
  std::string sticks; ///< element that stuck before and after
  double share = 0.0; ///< of what `sticks` holds, just before the event
  double rate = 0.0;  ///< 1/s, of that share, mean over the step before
};
/// |λ| over its bound, by the event functions of an element while it sticks (FrictionElement::watch_stick()).
[[nodiscard]] double share_of_bound(const FrictionUnit& unit, const std::vector<double>& watch);

class EventHandler {
public:
  EventHandler(const System& system, Dynamics& dynamics);

  /// Modes and phases at the start: contacts from their gaps, friction from the mode problem.
  void start(State& state);
  /// Behind start(): notes what slides from there, if it could hold at all (friction of zero never does).
  void note_start(const State& state, std::vector<Event>& events) const;
  /// `state` is at the event, `fired` the watch slots that fell below zero (none: a breakpoint of a
  /// signal, at which loads may jump). `watch_before`: at a breakpoint, all watch values just before it; else null. Changes modes,
  /// phases and anchors, notes what changed.
  void handle(State& state, const std::vector<int>& fired, const std::vector<double>* watch_before, std::vector<Event>& events);
  /// `state` comes from another system at the same time (mbd/simulation/changeover.h): some elements act that did not, or the other way
  /// round. `closes_rows`: new constraints may take a blow.
  void take_over(State& state, bool closes_rows, std::vector<Event>& events);
  /// A watch value that is at its zero, and not to be believed negative.
  void mark_fresh(int slot) { fresh_[slot] = 1; }

  /// After a method that decides modes and phases itself: those that hold at the accelerations' level.
  void settle_phases(State& state);
  /// Notes what has changed between two states, for a method that decides modes and phases itself.
  void note_changes(const State& before, const State& state, std::vector<Event>& events);
  /// Appends the events that lead from one state to the other, in a system without inextensible ropes, and changes nothing else but
  /// stop_reason().
  void list_changes(const State& before, const State& state, std::vector<Event>& events);

  /// Slots whose unit or friction changed in the last handle(), for EventFinder.
  [[nodiscard]] const std::vector<char>& fresh() const { return fresh_; }
  /// Not empty once an element has ended the run: which, and why.
  [[nodiscard]] const std::string& stop_reason() const { return stop_reason_; }
  /// Kinetic energy that setting to rest took in the last handle(), J: what errors have left of it.
  [[nodiscard]] double settled() const { return settled_; }
  /// Did handle() end with an evaluation of the state that it left? Then packed() and rates() are its.
  [[nodiscard]] bool is_evaluated() const { return modes_.is_evaluated(); }
  [[nodiscard]] const double* packed() const { return modes_.packed(); }
  [[nodiscard]] const double* rates() const { return modes_.rates(); }
  /// Ties of the last handle() with a share within `k_near_bound` of 1.
  [[nodiscard]] const std::vector<SlipTie>& ties() const { return ties_; }
  static constexpr double k_near_bound = 1e-3;
  void clear_fresh() { std::fill(fresh_.begin(), fresh_.end(), 0); }

private:
  void meet_constraints(State& state);
  void begin_units(State& state) const;
  bool switch_units(State& state, const std::vector<int>& fired, std::vector<Event>& events);
  [[nodiscard]] std::vector<int> carried(const std::vector<double>& before) const;
  bool follow_jumps(State& state, const std::vector<double>* watch_before, std::vector<Event>& events);
  void fire_friction(State& state, int f, int slot);
  void move_on(State& state, int f, const FrictionState& from);
  bool update_loading(State& state);
  void note_ties(const State& state, const std::vector<double>& watch);
  [[nodiscard]] bool is_same_direction(std::size_t f, const FrictionState& a, const FrictionState& b) const;
  [[nodiscard]] bool has_capacity(const State& state, std::size_t f) const;
  [[nodiscard]] EventKind slip_kind(std::size_t f, const FrictionState& old, const FrictionState& now) const;
  void list_changes_within(const State& before, const State& state, std::vector<Event>& events) const;
  void list_unit_change(int u, UnitMode from, UnitMode to, double t, std::vector<Event>& events) const;
  [[nodiscard]] bool list_friction_change(std::size_t f, const FrictionState& old, const std::vector<double>& memory_before,
                                          const State& state, std::vector<Event>& events);
  void note_friction(const std::vector<FrictionState>& before, const std::vector<double>& memory_before, const State& state,
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
  std::vector<char> has_switched_; ///< per watch slot, in the event at hand
  std::string stop_reason_;
  double settled_ = 0.0;
  std::vector<double> y_, dy_;
  std::vector<FrictionState> before_; ///< as friction was when handle() began
  std::vector<double> memory_before_;
  std::vector<double> watch_before_; ///< event functions when handle() began, if something stuck
  std::vector<SlipTie> ties_;
  std::vector<char> is_released_;      ///< per group of those that share a load
  std::vector<char> has_fired_;        ///< per friction element
  std::vector<Motion<double>> motion_; ///< of the bodies: scratch
};

} // namespace steplap

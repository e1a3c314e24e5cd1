// The roles that an element plays in a compiled system, each a small interface.
//
//   ForceGroup       all elements of one kind that give forces, evaluated in one loop;
//   FrictionElement  rows along which it can stick, the convex set of wrenches it can bear, its slip law;
//   RowSpec (row.h)  bilateral and driven constraint rows.
// A force element may have an *inner state*: numbers with rates of their own, of the first order, which are integrated
// with the motion (the slid distance of an elastic joint).
// A *unit* is a force element with modes (a contact: open, pressed, released): its present mode selects
// a smooth law, and its watch values tell how far that law stays valid: an event is where one of them
// falls below zero.
#pragma once

#include "mbd/base/event_kind.h"
#include "mbd/system/link.h"
#include "mbd/system/row.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace steplap {

/// Mode of a unit: which of the smooth pieces of its law holds. Wide enough for two segments of tables of 65 536.
using UnitMode = std::uint32_t;

enum class FrictionPhase : std::uint8_t {
  free,  ///< no normal force: no friction
  stick, ///< its rows hold as constraints
  slip,  ///< relative motion, the wrench follows the slip law
  apart  ///< the joint has come apart: no friction for good
};

/// What a watch value is known to inside a step: as exactly as it is computed; or, of one that says where the present piece of a
/// continuous force ends, as places or velocities of the motion are.
enum class WatchKind : std::uint8_t { exact, place, rate };

/// What a friction element remembers; anchors are in the state's memory (RowSpec::memory).
struct FrictionState {
  FrictionPhase phase = FrictionPhase::stick;
  std::int8_t sign = 0;   ///< direction of slip, for one-dimensional friction
  std::uint32_t foot = 0; ///< which of its places it acts at; or a set of places, by bits
  bool has_slipped = false;
  bool is_starting = false;        ///< slip has only begun: `direction` still shares in the slip law
  std::uint8_t stage = 0;          ///< of a slip's start or end, as its element counts them
  std::uint8_t left_out = 0;       ///< by bits, its rows that the equations left out while it stuck, since others hold them
  double slid = 0.0;               ///< path length of finished slips (first row), m
  double direction[3] = {0, 0, 0}; ///< of slip, as last looked at, for three-dimensional friction
};

/// What an element keeps between evaluations to save work, never to change a result: one per thread.
struct FrictionScratch {
  virtual ~FrictionScratch() = default;
};

/// What of an evaluation is on numbers of kind S, double or Traced.
template <class S> struct Evaluated {
  const Motion<S>* motion = nullptr;      ///< per body
  BodyForceOf<S>* force = nullptr;        ///< per body, accumulated
  const Motion<S>* link_motion = nullptr; ///< per slot of links (link.h): of a, seen from b
  BodyForceOf<S>* link_force = nullptr;   ///< per slot: on a, about its centre, in b's axes; accumulated
  S* contact_force = nullptr;             ///< per contact: normal force f ≥ 0 (N = Σ f)
  S* watch = nullptr;                     ///< per watch slot: valid while ≥ 0
  S* watch_rate = nullptr;                ///< its rate where the element knows it, else NaN
  S dissipation{0.0};                     ///< W
  S work{0.0};                            ///< W, of loads and drives
  const UnitMode* mode = nullptr;         ///< per unit
  const FrictionState* friction = nullptr;
  const S* inner = nullptr; ///< inner states of force elements
  S* inner_rate = nullptr;  ///< their rates: zero, unless an element says more
};

/// What a signal is asked for: its value, or the rate at which a drive by it moves (DriveLevel::position).
struct TimeInput {
  const Signal* signal = nullptr;
  bool is_rate = false;

  [[nodiscard]] double at(double t) const { return is_rate ? signal->drive(t, DriveLevel::position).rate : signal->value(t); }
};

/// An evaluation that is written down in one set of modes (mbd/tape).
struct TracedEvaluation : Evaluated<Traced> {
  double t = 0.0;
  std::vector<TimeInput> time_inputs; ///< in the order of their inputs; others may stand between those

  [[nodiscard]] Traced of_time(const TimeInput& input) {
    time_inputs.push_back(input);
    return Traced::input(input.at(t));
  }
};

/// Everything an evaluation reads and writes; one per thread, sized once.
struct Evaluation : Evaluated<double> {
  double t = 0.0;
  /// Signals that are forces (SignalUse) are taken by their means from here to t, for the impulse of a step of time
  /// stepping; where this is not before t (infinite) by their values at t.
  double mean_from = std::numeric_limits<double>::infinity();
  const double* memory = nullptr;            ///< of the state: anchors of rows
  FrictionScratch* const* scratch = nullptr; ///< per friction element; null where it wants none

  [[nodiscard]] double force_of(const Signal& signal) const { return mean_from < t ? signal.mean(mean_from, t) : signal.value(t); }
};

/// Adds f along the gradient of a measure taken in the link's frame (Origin).
template <class S> STEPLAP_INLINE void apply_force(BodyForceOf<S>& link_force, const MeasureValue<S>& m, const S& f) {
  const Pair<S> d = f * m.direction;
  link_force.fx += d.x;
  link_force.fy += d.y;
  link_force.m += cross(m.lever_a, d) + f * m.couple;
}

template <class S, int K> STEPLAP_INLINE void apply_force(BodyForceOf<S>& link_force, const CoordinateValue<K, S>& m, const S& f) {
  (K == 0 ? link_force.fx : link_force.fy) += f;
  link_force.m += K == 0 ? -m.lever_a.y * f : m.lever_a.x * f;
}

/// ∂(force on a, force on b)/∂(pose a, pose b) and /∂(velocity a, velocity b) of one element.
struct PairJacobian {
  int a = 0, b = 0;
  Eigen::Matrix<double, 6, 6> stiffness; ///< ∂F/∂q
  Eigen::Matrix<double, 6, 6> damping;   ///< ∂F/∂v
  int contact = -1;                      ///< index of its normal force, if it is one
  Eigen::Matrix<double, 12, 1> normal;   ///< ∂(normal force)/∂(pose a, pose b, velocity a, velocity b)
};

/// ∂(force on a, force on b)/∂(inner state) of one element, and what the rates of that depend on: ∂/∂(pose a, pose b),
/// ∂/∂(velocity a, velocity b), ∂/∂(inner state). `count` ≤ 3 numbers of the inner state from `first` on.
struct InnerJacobian {
  int a = 0, b = 0;
  int first = 0, count = 0;
  Eigen::Matrix<double, 6, 3> force = Eigen::Matrix<double, 6, 3>::Zero();
  Eigen::Matrix<double, 3, 6> by_pose = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix<double, 3, 6> by_velocity = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix<double, 3, 3> by_inner = Eigen::Matrix<double, 3, 3>::Zero();
};

class ForceGroup {
public:
  virtual ~ForceGroup() = default;
  virtual void add_forces(Evaluation& e) const = 0;
  /// The same operations in the same order on numbers that are written down. Returns false, with `e` untouched, if this group
  /// has no such template: what is written down then is a call of add_forces().
  [[nodiscard]] virtual bool trace_forces(TracedEvaluation& /*e*/) const { return false; }
  [[nodiscard]] virtual double potential(const Motion<double>* motion) const = 0;
  virtual void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const = 0;
  virtual void mark_bodies(std::vector<char>& is_used) const = 0;
  /// Enters the pairs of bodies that it acts between, and remembers their indices.
  virtual void enter_links(LinkTable& /*links*/) {}

  /// Modes, for groups whose elements are units. `slot` is the watch value that fell below zero.
  [[nodiscard]] virtual UnitMode initial_mode(int /*element*/, const Evaluation&) const { return 0; }
  [[nodiscard]] virtual UnitMode next_mode(int /*element*/, UnitMode mode, int /*slot*/, const Evaluation&) const { return mode; }
  /// Of a mode that has just begun: is this watch value positive, by more than rounding? Else nobody believes its sign before
  /// it was positive once.
  [[nodiscard]] virtual bool is_surely_positive(int /*element*/, UnitMode /*mode*/, int /*slot*/, const Evaluation&) const { return false; }
  /// Of a watch value of each element.
  [[nodiscard]] virtual WatchKind watch_kind(int /*slot*/) const { return WatchKind::exact; }
  /// Do its watch values jump where something else does: a signal at a breakpoint, another of an element's own values? Then what such a
  /// jump carries below zero is an event there, too.
  [[nodiscard]] virtual bool follows_jumps() const { return false; }
  /// Which event the change is.
  [[nodiscard]] virtual EventKind transition(UnitMode /*from*/, UnitMode /*to*/) const { return EventKind::none; }
  /// Does the run end with the change to this mode?
  [[nodiscard]] virtual bool stops_in(int /*element*/, UnitMode /*to*/) const { return false; }

  /// For groups with inner states: energy stored beside potential().
  [[nodiscard]] virtual double inner_energy(const Motion<double>* /*motion*/, const double* /*inner*/) const { return 0.0; }
  /// Onto what integration may have left (a yield surface); returns the energy that this dissipates. `inner`: as in `e`.
  virtual double settle_inner(const Evaluation& /*e*/, double* /*inner*/) const { return 0.0; }
  /// An element enters a mode at an event: what its inner state changes by at once; returns the energy dissipated.
  virtual double enter_mode(int /*element*/, UnitMode /*to*/, const Evaluation& /*e*/, double* /*inner*/) const { return 0.0; }
  /// Without force where the bodies are now: for poses that were given roughly.
  virtual void start_inner(const Motion<double>* /*motion*/, double* /*inner*/) const {}
  virtual void add_inner_jacobian(const Evaluation& /*e*/, std::vector<InnerJacobian>& /*out*/) const {}
};

/// Solution of one element's part of the mode problem.
struct FrictionBlock {
  double wrench[3] = {0, 0, 0};
  double direction[3] = {0, 0, 0}; ///< of the relative acceleration, if it starts to slip
  bool is_inside = true;           ///< true: sticks
};

/// How fine velocities have to be known for a slip law that turns with the direction of slip.
struct SlipScale {
  double speed = std::numeric_limits<double>::infinity(); ///< m/s: errors have to be small against it
  double lever = 0.0;                                     ///< m: a rate of turning counts as so much velocity
};

class FrictionElement {
public:
  virtual ~FrictionElement() = default;
  /// What slip_wrench(), watch_slip(), watch_stick() and watch_place() do, on numbers that are written down: with `rate` while
  /// it slips, then `wrench` is found; else `wrench` is what it bears. Returns false, with all untouched, if it has no such
  /// template: what is written down then is a call of those functions. Of `state` it may use phase, sign and foot alone: by
  /// these (and modes of units) it is known whether what was written down still holds.
  [[nodiscard]] virtual bool trace_friction(TracedEvaluation& /*e*/, const FrictionState& /*state*/, const Traced* /*rate*/,
                                            Traced* /*wrench*/, Traced* /*watch*/) const {
    return false;
  }
  [[nodiscard]] virtual int dimension() const = 0; ///< 1 or 3
  /// The `dimension()` rows along which it sticks, at its present place.
  [[nodiscard]] virtual const RowSpec* rows(const FrictionState& state) const = 0;
  /// 3 rows that hold b rigidly to a, so that the two may be merged into one body while sticking.
  [[nodiscard]] virtual bool is_rigid() const { return false; }
  /// Its wrench is that of a ForceGroup, a spring that yields: it is no constraint and has no phase but free.
  [[nodiscard]] virtual bool is_elastic() const { return false; }
  /// Sticks whatever it takes: nothing to watch.
  [[nodiscard]] virtual bool never_slips() const { return false; }
  virtual void mark_bodies(std::vector<char>& is_used) const = 0;
  [[nodiscard]] virtual std::unique_ptr<FrictionScratch> make_scratch() const { return nullptr; }

  /// Can it bear any wrench at all (some contact closed, some area left)?
  [[nodiscard]] virtual bool is_loaded(const Evaluation& e, const FrictionState& state) const = 0;
  /// The wrench of the slip law for the relative velocity `rate` along its rows.
  virtual void slip_wrench(const Evaluation& e, const FrictionState& state, const double* rate, double* wrench) const = 0;
  /// Support function of the set it can bear while sticking: the largest power that an admissible wrench takes
  /// from `rate`.
  [[nodiscard]] virtual double support(const Evaluation& e, const FrictionState& state, const double* rate) const = 0;
  /// Share of its capacity that `wrench` uses, 1 at the bound; `normal`: the n with n·w ≤ share of w for every w,
  /// equal for `wrench`.
  [[nodiscard]] virtual double gauge(const Evaluation& e, const FrictionState& state, const double* wrench, double* normal) const {
    const double forward = 1.0, capacity = support(e, state, &forward); // of one dimension
    normal[0] = wrench[0] < 0.0 ? -1.0 / capacity : 1.0 / capacity;
    return normal[0] * wrench[0];
  }
  /// Watch values while sticking with `wrench`: admissible while both are ≥ 0. A rigid element judges by `wrench`, the time,
  /// what the state remembers and its scratch alone: motions, forces and modes may be others than at which it was found.
  virtual void watch_stick(const Evaluation& e, const FrictionState& state, const double* wrench, double* watch) const = 0;
  /// At the onset of slip, when `wrench` has reached the bound: sets sign or direction.
  virtual void begin_slip(const Evaluation& e, FrictionState& state, const double* wrench) const = 0;
  /// Sets sign or direction for a slip that is under way.
  virtual void aim(FrictionState& state, const double* rate) const { state.sign = rate[0] > 0.0 ? 1 : -1; }
  /// Watch values while sliding at `rate`: its slip law is the one of `state` while both are ≥ 0.
  virtual void watch_slip(const Evaluation&, const FrictionState& state, const double* rate, double* watch) const {
    watch[0] = state.sign * rate[0];
    watch[1] = 1.0;
  }
  /// Can slip_scale() or decay_rate() say anything of a slip, whatever its rate?
  [[nodiscard]] virtual bool turns_with_slip(const FrictionState&) const { return true; }
  /// Of a slip at `rate`; infinite where the law does not turn with it.
  [[nodiscard]] virtual SlipScale slip_scale(const Evaluation&, const FrictionState&, const double* /*rate*/) const { return {}; }
  /// The fastest rate, 1/s, at which friction alone makes a change of `rate` decay (an upper bound).
  [[nodiscard]] virtual double decay_rate(const Evaluation&, const FrictionState&, const double* /*rate*/) const { return 0.0; }
  /// After one of them fell below zero: true if the slip goes on, with `state` brought up to date;
  /// false if it is at rest, so that the mode problem must tell what comes next.
  [[nodiscard]] virtual bool goes_on_slipping(const Evaluation&, FrictionState&, const double* /*rate*/, int /*slot*/) const {
    return false;
  }
  /// Watch value of the place it acts at (foot switch, coming apart): valid while ≥ 0.
  [[nodiscard]] virtual double watch_place(const Evaluation&, const FrictionState&) const { return 1.0; }
  /// Changes the place, or the phase to apart, after watch_place fell below zero.
  virtual void change_place(const Evaluation&, FrictionState&) const {}
  [[nodiscard]] virtual EventKind place_change(const FrictionState& /*from*/, const FrictionState& /*to*/) const {
    return EventKind::changes_foot;
  }
  /// Does coming apart end the run?
  [[nodiscard]] virtual bool stops_when_apart() const { return false; }
  /// min ½ wᵀA w + bᵀw over admissible w (A: dimension × dimension, row-major); `kinetic`: with the
  /// slip law's bounds instead of the static ones.
  [[nodiscard]] virtual FrictionBlock solve_block(const Evaluation& e, const FrictionState& state, const double* a, const double* b,
                                                  bool kinetic) const = 0;
};

/// Mode of a contact unit in which it presses; every contact law uses these three.
inline constexpr UnitMode k_contact_open = 0, k_contact_pressed = 1, k_contact_released = 2;

/// Watch slots of a friction element: two for stick bounds or the end of slip, one for its place.
inline constexpr int k_friction_watches = 3;

} // namespace steplap

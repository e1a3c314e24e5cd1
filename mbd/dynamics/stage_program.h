// Rates at the stages inside steps by machine code.
//
// Stages are most of a run's evaluations, and nobody asks them for anything but rates and switching values. So where a set of
// modes lasts, one of its evaluations is written down (traced_evaluation.h), and the stages after it are made by the machine code
// of that tape (mbd/tape): the same bits without the loops, indices and branches. The tape's
// conditions tell what is not as it was when the tape was written (a branch, a singular position that comes near): that stage is
// evaluated without code.
#pragma once

#include "mbd/dynamics/traced_evaluation.h"
#include "mbd/tape/code_store.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace steplap {

/// Nearer to a singular position than this, pivot against diagonal, stages are evaluated without code: the integrators ask how
/// near they came (Dynamics::lowest_pivot), and below 2e-2 it matters.
inline constexpr double k_traced_pivot = 2.5e-2;

/// Whether stages are made by machine code. Results do not hang on it, to the bit.
enum class StageCode : std::uint8_t {
  never,
  when_it_pays, ///< once a set of modes has lasted, and code for its tape would have paid
  at_once,      ///< from the second stage on
};

/// What an evaluation without code has found.
struct StageFound {
  const double* dy; ///< accelerations, rates of inner states, dissipation and work
  const double *watch, *watch_rate, *friction_force;
  double smallest_pivot;
};

/// Of one layout, which owns it, in one set of modes.
class StageProgram {
public:
  StageProgram(const Layout& layout, const State& state, StageCode choice);
  /// Was it made for these modes, in its layout?
  [[nodiscard]] bool is_of(const State& state) const;

  /// Code may have been made since. It is used if it makes of the stage that was written down what that has made.
  void look_for_code();
  [[nodiscard]] bool is_ready() const { return code_ != nullptr; }
  /// For accelerations, rates of inner states, power and switching values at coordinates, rates and inner states y. False: evaluate
  /// without code; what was found before may be lost.
  /// `all`: also what can_look(), put_wrenches() and smallest_pivot() are asked for.
  [[nodiscard]] bool run(double t, const double* y, double* dy, double* watch, double* watch_rate, bool all);
  /// Can merged joints be looked at by what a stage has found? Then: what they bear at the last run(), into their slots.
  [[nodiscard]] bool can_look() const { return traced_.has_wrenches; }
  void put_wrenches(double* friction_force) const;
  /// To the bit that of Layout::smallest_pivot, at the last run().
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_in(rest_.data()); }
  /// Where run() takes the layout's numbers of time, in the order of traced_evaluation.h.
  [[nodiscard]] double* time_inputs() { return time_inputs_.data(); }

  /// Have the modes lasted, so that the stage that follows is to be written down?
  [[nodiscard]] bool wants_stage() const {
    return !is_hopeless_ && !tape_code_ && (candidate_ || stages_ >= k_settled || choice_ == StageCode::at_once);
  }
  /// Counts a stage that was evaluated without code.
  void count_stage();
  /// Where modes come back: was code made for such a tape since?
  void look_for_candidate();
  /// Writes down the stage evaluated last, at t, y and these time_inputs(). The tape is held against what was found.
  /// `live`: as trace_rates.
  void record(const System& system, const State& state, const Evaluation& live, double t, const double* y, const StageFound& found);

private:
  void note_failure();
  [[nodiscard]] bool has_call_failed() const;
  [[nodiscard]] bool makes_what_was_traced(const MachineCode& made) const;
  [[nodiscard]] double smallest_pivot_in(const double* rest) const;
  void give_up();
  [[nodiscard]] std::uint64_t key() const;
  [[nodiscard]] bool has_found(const StageFound& found) const;

  /// After so many failures in a row another branch is the usual one (angles that grow beyond the series of their sines): it is
  /// written down anew, but not for ever.
  static constexpr int k_most_failures = 16, k_most_tapes = 8;
  /// Writing a stage down for the first time takes as long as code saves in so many: in this run, or in others before it.
  /// A candidate needs nothing but its constants gathered, which most stretches between events are long enough for.
  static constexpr long k_settled = 120;

  struct Friction {
    FrictionPhase phase;
    std::int8_t sign;
    std::uint32_t foot;
    friend bool operator==(const Friction&, const Friction&) = default;
  };

  const Layout* layout_;
  std::vector<UnitMode> modes_;
  std::vector<Friction> frictions_;
  TracedRates traced_;
  std::shared_ptr<TapeFamily> family_;
  std::shared_ptr<TapeCode> candidate_; ///< a tape that has code, which this one should be; null: none, or it was not
  std::shared_ptr<TapeCode> tape_code_; ///< null until it is written down
  const MachineCode* code_ = nullptr;
  std::vector<double> time_inputs_; ///< the layout's, then those of signals
  std::vector<double> rest_;        ///< what run() has found for who looks at merged joints
  CodeArrays arrays_;
  std::size_t coordinate_count_ = 0, inner_count_ = 0, time_count_ = 0;
  long stages_ = 0;              ///< made without code, in this run and those before it
  int failures_ = 0, tapes_ = 0; ///< failures: since it last held
  StageCode choice_;
  bool is_hopeless_ = false;
};

class LayoutStore;

/// The one in use, of those that layouts keep for their sets of modes: these come back.
class StagePrograms {
public:
  /// Those made until now must be given up (LayoutStore::clear_programs).
  void choose(StageCode choice) {
    choice_ = choice;
    leave();
  }
  void leave() { now_ = nullptr; }
  /// `kept`: all layouts.
  void enter(Layout& layout, const State& state, LayoutStore& kept);
  /// Of the modes entered; null: none.
  [[nodiscard]] StageProgram* now() const { return now_; }

private:
  /// Scenes with many contacts have more sets of modes than it pays to keep.
  static constexpr std::size_t k_most_programs = 64;

  StageProgram* now_ = nullptr;
  StageCode choice_ = StageCode::when_it_pays;
};

} // namespace steplap

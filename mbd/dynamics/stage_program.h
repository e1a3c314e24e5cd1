// Evaluates the stages within a step by machine code.
//
// Most evaluations of a run are stages, and only their rates and event functions are needed. If a set of modes persists, one evaluation is
// recorded on a tape (traced_evaluation.h), and the following stages are computed by machine code compiled from it (mbd/tape):
// bit-identical results without loops, indices and branches. The tape is valid under conditions (branches taken, distance from singular
// positions). A stage that violates one of them is evaluated without code.
#pragma once

#include "mbd/dynamics/evaluation_choices.h"
#include "mbd/dynamics/traced_evaluation.h"
#include "mbd/tape/code_store.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace steplap {

/// Relative pivot below which stages are evaluated without code. If the smallest pivot of a step (Dynamics::least_pivot) is below 2e-2,
/// integrators need its value, and stages by code do not compute it.
inline constexpr double k_traced_pivot = 2.5e-2;

/// Results of an evaluation without code, for comparison.
struct StageFound {
  const double* dy; ///< accelerations, rates of inner states, dissipated power and power of loads
  const double *event_value, *event_derivative, *friction_force;
  double smallest_pivot;
};

/// The compiled stage for one set of modes of one layout, which owns this object.
class StageProgram {
public:
  StageProgram(const Layout& layout, const State& state, StageCode choice);
  /// Returns true if this program is for the modes and friction phases of `state`.
  [[nodiscard]] bool is_of(const State& state) const;

  /// Takes machine code that was compiled in the meantime into use, if it reproduces the recorded stage bit by bit.
  void adopt_code();
  [[nodiscard]] bool is_ready() const { return code_ != nullptr; }
  /// Computes accelerations, rates of inner states, powers and event functions at y (coordinates, rates, inner states). Returns false if
  /// the stage must be evaluated without code; the outputs are then undefined. `all`: also computes the data for put_wrenches() and
  /// smallest_pivot().
  [[nodiscard]] bool run(double t, const double* y, double* dy, double* event_value, double* event_derivative, bool all);
  /// Returns true if a stage by code provides what the event functions of merged joints need. put_wrenches() then writes the wrenches of
  /// these joints at the last run().
  [[nodiscard]] bool has_joint_wrenches() const { return traced_.has_wrenches; }
  void put_wrenches(double* friction_force) const;
  /// Returns Layout::smallest_pivot() at the last run(), bit-identical.
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_in(rest_.data()); }
  /// Returns the array of the time-dependent numbers of the layout, in the order of traced_evaluation.h, which must be filled before run().
  [[nodiscard]] double* time_inputs() { return time_inputs_.data(); }

  /// Returns true if the modes have persisted so long that the next stage should be recorded.
  [[nodiscard]] bool needs_recording() const {
    return !is_hopeless_ && !tape_code_ && (candidate_ || stages_ >= k_settled || choice_ == StageCode::at_once);
  }
  /// Counts a stage evaluated without code.
  void count_stage();
  /// Must be called when modes recur: finds code that was compiled for an equal tape in the meantime.
  void find_candidate();
  /// Records the last stage evaluated without code, at t, y and time_inputs(), and compares the results of the tape with those of the
  /// evaluation, `found`. `live` as for trace_rates().
  void record(const System& system, const State& state, const Evaluation& live, double t, const double* y, const StageFound& found);

private:
  void note_failure();
  [[nodiscard]] bool has_call_failed() const;
  [[nodiscard]] bool makes_what_was_traced(const MachineCode& made) const;
  [[nodiscard]] double smallest_pivot_in(const double* rest) const;
  void give_up();
  [[nodiscard]] std::uint64_t key() const;
  [[nodiscard]] bool has_found(const StageFound& found) const;

  /// After this many consecutive failures the recorded branches are not the usual ones any more; for example, angles have left the range of
  /// the series for sine. The stage is then recorded again, at most k_most_tapes times.
  static constexpr int k_most_failures = 16, k_most_tapes = 8;
  /// Number of stages without code, in this run or earlier ones with the same tape, after which recording repays its cost. Code saves about
  /// 70 ns a stage; recording and compiling a tape take 150 to 400 µs, and 2 ms for the first one of a process. A single run with events
  /// therefore has too few stages in each set of modes. If code for the same tape exists, recording collects only its constants, which takes
  /// 9 µs, the saving of 130 stages. In a study of the paper's transformer a recording serves 165 stages on average.
  static constexpr long k_settled = 4000;

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
  std::shared_ptr<TapeCode> candidate_; ///< compiled tape of another run that probably equals this one; null: none
  std::shared_ptr<TapeCode> tape_code_; ///< null until the stage is recorded
  const MachineCode* code_ = nullptr;
  std::vector<double> time_inputs_; ///< time-dependent numbers of the layout, then values of signals
  std::vector<double> rest_;        ///< results of run() for the event functions of merged joints
  CodeArrays arrays_;
  std::size_t coordinate_count_ = 0, inner_count_ = 0, time_count_ = 0;
  long stages_ = 0;              ///< stages evaluated without code, in this run and earlier ones
  int failures_ = 0, tapes_ = 0; ///< failures_: number since the last success
  StageCode choice_;
  bool is_hopeless_ = false;
};

class LayoutStore;

/// Selects the compiled stage for the present modes. Those of other modes are kept with their layouts.
class StagePrograms {
public:
  /// Sets the choice. Existing programs must be deleted by the caller (LayoutStore::clear_programs).
  void choose(StageCode choice) {
    choice_ = choice;
    leave();
  }
  void leave() { now_ = nullptr; }
  /// Selects the program for the modes of `state`, which is created if there is none. `kept` contains all layouts.
  void enter(Layout& layout, const State& state, LayoutStore& kept);
  /// Returns the program for the present modes; null: none.
  [[nodiscard]] StageProgram* now() const { return now_; }

private:
  /// Largest number of programs. Models with many contacts have more sets of modes than it is useful to keep.
  static constexpr std::size_t k_most_programs = 64;

  StageProgram* now_ = nullptr;
  StageCode choice_ = StageCode::when_it_pays;
};

} // namespace steplap

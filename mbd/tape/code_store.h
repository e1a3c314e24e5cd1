// Store of the machine code compiled in this process. Runs of the same model with other parameter values record equal tapes (tape.h) and
// share one code.
#pragma once

#include "mbd/tape/machine_code.h"

#include <atomic>
#include <cstring>
#include <memory>
#include <mutex>
#include <type_traits>

namespace steplap {

/// A tape with its machine code, which is compiled after enough evaluations to repay the compilation. Thread-safe.
class TapeCode {
public:
  /// Copies `tape` without its constants.
  explicit TapeCode(const Tape& tape) : tape_(tape) { tape_.constants = {}; }
  /// Returns true if `tape` has the same steps, inputs and outputs; the values of constants may differ.
  [[nodiscard]] bool is_of(const Tape& tape) const {
    static_assert(std::has_unique_object_representations_v<TapeStep>);
    return tape_.steps.size() == tape.steps.size() && tape_.outputs == tape.outputs && tape_.input_count == tape.input_count &&
           tape_.usual_outputs == tape.usual_outputs && tape_.first_inputs == tape.first_inputs && tape_.places == tape.places &&
           std::memcmp(tape_.steps.data(), tape.steps.data(), tape_.steps.size() * sizeof(TapeStep)) == 0;
  }
  /// Returns the tape, without constants.
  [[nodiscard]] const Tape& tape() const { return tape_; }
  /// Returns the compiled code; null if it is not compiled yet, or if no code is available on this machine.
  [[nodiscard]] const MachineCode* code() const;
  /// Adds to the number of evaluations made without code. Compiles the tape when this number reaches k_enough.
  void count_uses(long evaluations);
  /// Compiles the tape now, unless that was done before.
  void make();

private:
  /// Number of evaluations from which on the time saved by code exceeds the time of compilation.
  static constexpr long k_enough = 600;

  Tape tape_;
  std::atomic<long> evaluations_{0};
  mutable std::mutex mutex_; ///< protects the members below. An atomic pointer would suffice, but helgrind cannot follow it
  bool is_made_ = false;
  MachineCode made_;
};

/// Evaluations with a common key, which are expected to record equal tapes. Holds the number of evaluations made without code and the last
/// recorded tape. A new recording is compared with that tape step by step, which is faster than storing a new one. Thread-safe.
class TapeFamily {
public:
  /// Counts one evaluation made without code.
  void count_evaluation() { made_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] long made() const { return made_.load(std::memory_order_relaxed); }
  /// Returns the tape recorded last; null if there is none, or if its code is not compiled.
  [[nodiscard]] std::shared_ptr<TapeCode> coded() const;
  void keep(std::shared_ptr<TapeCode> code);

private:
  std::atomic<long> made_{0};
  mutable std::mutex mutex_;
  std::shared_ptr<TapeCode> code_;
};

/// Returns the family of the evaluations with this key, created on first use. Two different evaluations with the same key still give
/// correct results, but compare their tapes in vain. Thread-safe.
[[nodiscard]] std::shared_ptr<TapeFamily> tape_family(std::uint64_t key);

/// Returns the TapeCode for `tape`, the same object for equal tapes in all threads. The store holds some hundred tapes and is emptied when
/// full; code that is still referenced remains valid. Thread-safe.
[[nodiscard]] std::shared_ptr<TapeCode> shared_code(const Tape& tape);

} // namespace steplap

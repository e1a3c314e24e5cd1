// Machine code compiled in this process, stored by tape: runs of the same scene with other numbers have the same tapes and share it.
#pragma once

#include "mbd/tape/machine_code.h"

#include <atomic>
#include <cstring>
#include <memory>
#include <mutex>
#include <type_traits>

namespace steplap {

/// A tape with its machine code, which is compiled once it pays. Thread-safe.
class TapeCode {
public:
  /// Copies `tape` without its constants.
  explicit TapeCode(const Tape& tape) : tape_(tape) { tape_.constants = {}; }
  /// Returns true if `tape` is the same computation; constants may differ.
  [[nodiscard]] bool is_of(const Tape& tape) const {
    static_assert(std::has_unique_object_representations_v<TapeStep>);
    return tape_.steps.size() == tape.steps.size() && tape_.outputs == tape.outputs && tape_.input_count == tape.input_count &&
           tape_.usual_outputs == tape.usual_outputs && tape_.first_inputs == tape.first_inputs && tape_.places == tape.places &&
           std::memcmp(tape_.steps.data(), tape.steps.data(), tape_.steps.size() * sizeof(TapeStep)) == 0;
  }
  /// Returns the tape, without constants.
  [[nodiscard]] const Tape& tape() const { return tape_; }
  /// Returns the code; null if it is not compiled yet.
  [[nodiscard]] const MachineCode* code() const;
  /// Counts evaluations made without the code. Compiles it as soon as it would have paid for itself.
  void count_uses(long evaluations);
  /// Compiles the code now, unless that has been done.
  void make();

private:
  /// Number of evaluations by code that save the time of compilation.
  static constexpr long k_enough = 600;

  Tape tape_;
  std::atomic<long> evaluations_{0};
  mutable std::mutex mutex_; ///< protects the members below. An atomic pointer would suffice, but helgrind cannot follow it
  bool is_made_ = false;
  MachineCode made_;
};

/// Evaluations that are likely to have the same tape: how many were made without code, and the tape recorded last. The next recording is
/// compared with that tape, which is faster than writing a new one. Thread-safe.
class TapeFamily {
public:
  /// Counts an evaluation made without code.
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

/// Returns the family of evaluations with this key. Different evaluations should have different keys; a collision only costs time.
/// Thread-safe.
[[nodiscard]] std::shared_ptr<TapeFamily> tape_family(std::uint64_t key);

/// Returns the TapeCode for `tape`, the same object for equal tapes in all threads. The store holds some hundred tapes and is emptied when
/// full; code that is still referenced remains valid. Thread-safe.
[[nodiscard]] std::shared_ptr<TapeCode> shared_code(const Tape& tape);

} // namespace steplap

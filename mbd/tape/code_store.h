// Machine code made in this process, by the tape that it was made of: runs of one scene with other numbers have the same tapes.
#pragma once

#include "mbd/tape/machine_code.h"

#include <atomic>
#include <cstring>
#include <memory>
#include <mutex>
#include <type_traits>

namespace steplap {

/// One tape and its code, once that is worth making. Thread-safe.
class TapeCode {
public:
  /// `tape`: its constants are not looked at.
  explicit TapeCode(const Tape& tape) : tape_(tape) { tape_.constants = {}; }
  [[nodiscard]] bool is_of(const Tape& tape) const {
    static_assert(std::has_unique_object_representations_v<TapeStep>);
    return tape_.steps.size() == tape.steps.size() && tape_.outputs == tape.outputs && tape_.input_count == tape.input_count &&
           tape_.usual_outputs == tape.usual_outputs && tape_.first_inputs == tape.first_inputs && tape_.places == tape.places &&
           std::memcmp(tape_.steps.data(), tape.steps.data(), tape_.steps.size() * sizeof(TapeStep)) == 0;
  }
  /// Without constants.
  [[nodiscard]] const Tape& tape() const { return tape_; }
  /// Null where it is not made yet.
  [[nodiscard]] const MachineCode* code() const;
  /// So many evaluations were made without the code. It is made as soon as it would have paid for itself.
  void count_uses(long evaluations);
  void make();

private:
  /// Making code takes as long as some of these save.
  static constexpr long k_enough = 600;

  Tape tape_;
  std::atomic<long> evaluations_{0};
  mutable std::mutex mutex_; ///< of those below: asked for until there is code, which helgrind follows, unlike an atomic pointer
  bool is_made_ = false;
  MachineCode made_;
};

/// What this process knows of evaluations that are likely to have the same tape: how many were made without code, and the tape
/// recorded last. The next one to be recorded is compared with that tape, which is quicker than writing a new one. Thread-safe.
class TapeFamily {
public:
  /// One more was made without code.
  void count_evaluation() { made_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] long made() const { return made_.load(std::memory_order_relaxed); }
  /// Null: none, or its code is not made.
  [[nodiscard]] std::shared_ptr<TapeCode> coded() const;
  void keep(std::shared_ptr<TapeCode> code);

private:
  std::atomic<long> made_{0};
  mutable std::mutex mutex_;
  std::shared_ptr<TapeCode> code_;
};

/// Different evaluations should have different keys. Where two share one by chance, nothing but time is lost.
/// Thread-safe.
[[nodiscard]] std::shared_ptr<TapeFamily> tape_family(std::uint64_t key);

/// Equal tapes share one, whichever thread asked first. The store keeps some hundred tapes and is emptied when it is full; code that
/// somebody still uses lives on. Thread-safe.
[[nodiscard]] std::shared_ptr<TapeCode> shared_code(const Tape& tape);

} // namespace steplap

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
class StoredCode {
public:
  /// `tape`: its constants are not looked at.
  explicit StoredCode(const Tape& tape) : tape_{tape.steps, {}, tape.input_count, tape.outputs, tape.usual_outputs} {}
  [[nodiscard]] bool is_of(const Tape& tape) const {
    static_assert(std::has_unique_object_representations_v<TapeStep>);
    return tape_.steps.size() == tape.steps.size() && tape_.outputs == tape.outputs && tape_.input_count == tape.input_count &&
           tape_.usual_outputs == tape.usual_outputs &&
           std::memcmp(tape_.steps.data(), tape.steps.data(), tape_.steps.size() * sizeof(TapeStep)) == 0;
  }
  /// Without constants.
  [[nodiscard]] const Tape& tape() const { return tape_; }
  /// Null where it is not made yet.
  [[nodiscard]] const MachineCode* code() const;
  /// So many evaluations were made that it could have made: it is made as soon as they are as many as would have paid for it.
  void note_use(long evaluations);
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

/// What this process has met of one kind of computation, before and beside whoever asks: how often it was made, and the tape that
/// was written down of it last, which another sample's is then compared with instead of being written. Thread-safe.
class KnownKind {
public:
  /// Made once more, as ever.
  void note_made() { made_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] long made() const { return made_.load(std::memory_order_relaxed); }
  /// Null: none, or its code is not made.
  [[nodiscard]] std::shared_ptr<StoredCode> coded() const;
  void keep(std::shared_ptr<StoredCode> stored);

private:
  std::atomic<long> made_{0};
  mutable std::mutex mutex_;
  std::shared_ptr<StoredCode> stored_;
};

/// By a number that is different for what can be told to be another kind; of two that share one by chance nothing but time is lost.
/// Thread-safe.
[[nodiscard]] std::shared_ptr<KnownKind> known_kind(std::uint64_t key);

/// That of an equal tape, whichever thread has asked first. Of some hundred tapes: the store is emptied when it is full, and who
/// has one keeps it. Thread-safe.
[[nodiscard]] std::shared_ptr<StoredCode> stored_code(const Tape& tape);

} // namespace steplap

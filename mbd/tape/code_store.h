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
  explicit StoredCode(const Tape& tape) : steps_(tape.steps), outputs_(tape.outputs), input_count_(tape.input_count) {}
  [[nodiscard]] bool is_of(const Tape& tape) const {
    static_assert(std::has_unique_object_representations_v<TapeStep>);
    return steps_.size() == tape.steps.size() && outputs_ == tape.outputs && input_count_ == tape.input_count &&
           std::memcmp(steps_.data(), tape.steps.data(), steps_.size() * sizeof(TapeStep)) == 0;
  }
  /// Null where it is not made yet.
  [[nodiscard]] const MachineCode* code() const { return code_.load(std::memory_order_acquire); }
  /// So many evaluations were made that it could have made: it is made as soon as they are as many as would have paid for it.
  void note_use(long evaluations);
  void make();
  /// Code for several lanes (MachineCode::most_lanes), made when asked for once note_use() has heard of enough; null till then,
  /// and where there is none.
  [[nodiscard]] const MachineCode* lane_code();
  /// The same, made at once.
  [[nodiscard]] const MachineCode* make_lanes();

private:
  /// Making code takes as long as some of these save.
  static constexpr long k_enough = 600;

  std::vector<TapeStep> steps_;
  std::vector<std::int32_t> outputs_;
  int input_count_;
  std::atomic<long> evaluations_{0};
  [[nodiscard]] Tape tape() const;

  std::once_flag is_made_, are_lanes_made_;
  MachineCode made_, made_lanes_;
  std::atomic<const MachineCode*> code_{nullptr};
};

/// That of an equal tape, whichever thread has asked first. Of some hundred tapes: the store is emptied when it is full, and who
/// has one keeps it. Thread-safe.
[[nodiscard]] std::shared_ptr<StoredCode> stored_code(const Tape& tape);

} // namespace steplap

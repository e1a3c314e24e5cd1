// A tape as machine code of the processor that the program runs on, for one sample or for several side by side.
//
// One sample takes one double of a register; 2, 4 or 8 samples take the lanes of one register (of SSE2, AVX2, AVX-512): the
// same instructions, on as many numbers. Both give the bits of `replay`, but for the sign and payload of a NaN: each operation
// is one instruction that IEEE 754 defines, nothing is contracted, reordered by algebra, or flushed to zero. Sines and cosines
// are calls of portable::sin_cos.
//
// Made for x86-64 and the calling convention of System V, with asmjit. Elsewhere, or built with STEPLAP_MACHINE_CODE=OFF,
// nothing is available and callers go on with the code that the tape was written from.
#pragma once

#include "mbd/tape/tape.h"

#include <cstddef>
#include <cstdint>

namespace steplap {

/// What the code may use: that and what stands before it.
enum class InstructionSet : std::uint8_t { sse2, avx2, avx512 };

class MachineCode {
public:
  /// Whether this program can make machine code for the processor that it runs on.
  [[nodiscard]] static bool is_available();
  /// The largest that the processor and the system have; sse2 where nothing is available.
  [[nodiscard]] static InstructionSet best_instructions();
  /// Lanes of a register with these instructions: 2, 4 or 8; 1 where nothing is available.
  [[nodiscard]] static int most_lanes(InstructionSet instructions = best_instructions());

  MachineCode() = default;
  /// The tape need not be simplified, but should be: some 60 ns a step. `lanes`: 1, 2, 4 or 8, at most `most_lanes`, and no
  /// instructions beyond best_instructions(): std::invalid_argument. Empty, where nothing is available, where the system grants
  /// no memory for code, or where what has to be kept beside the registers takes more than 256 kB of the stack: whoever makes
  /// it has to ask by `operator bool`. Precondition: a tape that `simplified` takes.
  explicit MachineCode(const Tape& tape, int lanes = 1, InstructionSet instructions = best_instructions());
  MachineCode(MachineCode&& other) noexcept;
  MachineCode& operator=(MachineCode&& other) noexcept;
  MachineCode(const MachineCode&) = delete;
  MachineCode& operator=(const MachineCode&) = delete;
  ~MachineCode();

  explicit operator bool() const { return run_ != nullptr; }

  /// Bit l of the result: the conditions hold in lane l. Arrays are [index][lane], as long as the tape says, aligned as doubles
  /// are, and `outputs` is apart from the others. With one lane and a condition that fails, outputs are untouched; with more, the
  /// outputs of lanes that fail mean nothing and the others are right. Not `all`: the tape's usual outputs may be all that is
  /// found. Thread-safe. Precondition: not empty.
  unsigned run(const double* inputs, const double* constants, double* outputs, bool all = true) const {
    return run_(inputs, constants, outputs, all ? 1 : 0);
  }

  /// run() as a function of its own, good as long as this object.
  using Run = unsigned (*)(const double* inputs, const double* constants, double* outputs, int all);
  [[nodiscard]] Run entry() const { return run_; }

  [[nodiscard]] int lanes() const { return lanes_; }
  /// Bytes of instructions, and how many there are.
  [[nodiscard]] std::size_t code_size() const { return code_size_; }
  [[nodiscard]] std::size_t instruction_count() const { return instruction_count_; }

private:
  Run run_ = nullptr;
  void* memory_ = nullptr;      ///< where the system's pages begin
  std::size_t memory_size_ = 0; ///< 0: none
  std::size_t code_size_ = 0, instruction_count_ = 0;
  int lanes_ = 1;
};

} // namespace steplap

// A tape as machine code of the processor that the program runs on.
//
// It gives the bits of `replay`, but for the sign and payload of a NaN: each operation is one instruction that IEEE 754
// defines, nothing is contracted, reordered by algebra, or flushed to zero. Sines and cosines are calls of portable::sin_cos.
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

/// What code reads and writes beside the inputs that come first and the outputs of the first array.
struct CodeArrays {
  static constexpr int k_more = 3;

  const double* constants = nullptr;
  const double* later_inputs = nullptr; ///< those behind Tape::first_inputs
  double* outputs[k_more] = {};         ///< arrays 1 and on of Tape::places
};

class MachineCode {
public:
  /// Whether this program can make machine code for the processor that it runs on.
  [[nodiscard]] static bool is_available();
  /// The largest that the processor and the system have; sse2 where nothing is available.
  [[nodiscard]] static InstructionSet best_instructions();

  MachineCode() = default;
  /// The tape need not be simplified, but should be: some 60 ns a step. Throws std::invalid_argument for instructions beyond
  /// best_instructions(). Empty, where nothing is available, where the system grants no memory for code, or where what has to
  /// be kept beside the registers takes more than 256 kB of the stack: whoever makes it has to ask by `operator bool`.
  /// Precondition: a tape that `simplified` takes.
  explicit MachineCode(const Tape& tape, InstructionSet instructions = best_instructions());
  MachineCode(MachineCode&& other) noexcept;
  MachineCode& operator=(MachineCode&& other) noexcept;
  MachineCode(const MachineCode&) = delete;
  MachineCode& operator=(const MachineCode&) = delete;
  ~MachineCode();

  explicit operator bool() const { return run_ != nullptr; }

  /// Whether the conditions hold; where one fails, outputs are untouched. Arrays are as long as the tape says, and `outputs` is
  /// apart from the others. Not `all`: the tape's usual outputs may be all that is found. Thread-safe. Precondition: not empty.
  bool run(const double* inputs, const CodeArrays& arrays, double* outputs, bool all) const {
    return run_(inputs, &arrays, outputs, all ? 1 : 0) != 0;
  }
  /// The same of a tape whose inputs and outputs lie in one array each.
  bool run(const double* inputs, const double* constants, double* outputs, bool all = true) const {
    return run(inputs, CodeArrays{constants}, outputs, all);
  }

  /// Bytes of instructions, and how many there are.
  [[nodiscard]] std::size_t code_size() const { return code_size_; }
  [[nodiscard]] std::size_t instruction_count() const { return instruction_count_; }

private:
  using Run = int (*)(const double* inputs, const CodeArrays* arrays, double* outputs, int all);

  Run run_ = nullptr;
  void* memory_ = nullptr;      ///< where the system's pages begin
  std::size_t memory_size_ = 0; ///< 0: none
  std::size_t code_size_ = 0, instruction_count_ = 0;
};

} // namespace steplap

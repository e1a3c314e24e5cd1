// Compiles a tape to machine code of the present processor.
//
// The results are bit-identical to those of `replay`, except for the sign and payload of a NaN: each operation is one IEEE 754 instruction,
// without contraction, reordering or flushing of subnormal numbers to zero. Sines and cosines are calls of portable::sin_cos.
//
// Implemented for x86-64 with the System V calling convention, by asmjit. On other systems, or with STEPLAP_MACHINE_CODE=OFF, no code is
// available, and callers use the templates from which the tape was recorded.
#pragma once

#include "mbd/tape/tape.h"

#include <cstddef>
#include <cstdint>

namespace steplap {

/// Instruction sets; each includes the previous ones.
enum class InstructionSet : std::uint8_t { sse2, avx2, avx512 };

/// Arrays that the code uses in addition to its first inputs and the first array of outputs.
struct CodeArrays {
  static constexpr int k_more = 3;

  const double* constants = nullptr;
  const double* later_inputs = nullptr; ///< inputs after the first Tape::first_inputs
  double* outputs[k_more] = {};         ///< arrays 1, 2, … of Tape::places
};

/// The code of one tape.
class MachineCode {
public:
  /// Returns true if machine code can be made for the present processor.
  [[nodiscard]] static bool is_available();
  /// Returns the largest instruction set of the processor and the operating system; sse2 if code is not available.
  [[nodiscard]] static InstructionSet best_instructions();

  MachineCode() = default;
  /// Compiles the tape, in some 60 ns per step. The tape should be simplified. Precondition: `simplified` accepts it. The object is empty
  /// (check by `operator bool`) if code is not available, if the system grants no executable memory, or if values outside of registers need
  /// more than 256 kB of the stack. Throws std::invalid_argument for instructions beyond best_instructions().
  explicit MachineCode(const Tape& tape, InstructionSet instructions = best_instructions());
  MachineCode(MachineCode&& other) noexcept;
  MachineCode& operator=(MachineCode&& other) noexcept;
  MachineCode(const MachineCode&) = delete;
  MachineCode& operator=(const MachineCode&) = delete;
  ~MachineCode();

  explicit operator bool() const { return run_ != nullptr; }

  /// Evaluates the tape. Returns false, with outputs unchanged, if a condition of the tape is not met. The lengths of the arrays are those
  /// of the tape; `outputs` must not overlap the others. If `all` is false, only the usual outputs (Tape::usual_outputs) are guaranteed to
  /// be computed. Thread-safe. Precondition: not empty.
  bool run(const double* inputs, const CodeArrays& arrays, double* outputs, bool all) const {
    return run_(inputs, &arrays, outputs, all ? 1 : 0) != 0;
  }
  /// Evaluates a tape whose inputs are in one array, and whose outputs are in one array.
  bool run(const double* inputs, const double* constants, double* outputs, bool all = true) const {
    return run(inputs, CodeArrays{constants}, outputs, all);
  }

  /// Return the size of the code in bytes, and its number of instructions.
  [[nodiscard]] std::size_t code_size() const { return code_size_; }
  [[nodiscard]] std::size_t instruction_count() const { return instruction_count_; }

private:
  using Run = int (*)(const double* inputs, const CodeArrays* arrays, double* outputs, int all);

  Run run_ = nullptr;
  void* memory_ = nullptr;      ///< start of the memory pages
  std::size_t memory_size_ = 0; ///< 0: none
  std::size_t code_size_ = 0, instruction_count_ = 0;
};

} // namespace steplap

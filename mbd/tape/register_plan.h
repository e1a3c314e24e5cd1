// Register allocation for the code of a tape.
//
// The code has no branches, so the position of the next use of each value is known. If registers do not suffice, the value with the latest
// next use is evicted (L. A. Belady, IBM Systems Journal 5 (1966) 78), preferably one that is in memory already: an input, a constant, or a
// value stored before. A value in memory is read by the instruction that uses it, without a separate load. The plan depends on the
// processor only by RegisterRules.
#pragma once

#include "mbd/tape/tape.h"

#include <cstdint>
#include <vector>

namespace steplap {

/// Location of a value.
struct OperandPlace {
  enum class Kind : std::uint8_t {
    nowhere,
    in_register,
    input,
    later_input, ///< after the first Tape::first_inputs
    constant,
    literal,    ///< index by literal_index()
    output,     ///< in `array`
    slot,       ///< in the stack frame
    call_slot,  ///< in the part of the frame for arguments and results of calls
    sign_bits,  ///< bit pattern of −0
    value_bits, ///< all bits except the sign
  };
  Kind kind = Kind::nowhere;
  std::int8_t array = 0; ///< number of the output array
  std::int32_t index = 0;
};

/// One instruction of the plan.
struct PlannedInstruction {
  enum class Kind : std::uint8_t {
    load,       ///< destination = second, which is in memory
    move,       ///< destination = second, another register
    store,      ///< second = first
    arithmetic, ///< destination = first operation second; maximum: first > second ? first : second, with first the tape's b; negate: first
                ///< ^ second (sign_bits); absolute: first & second (value_bits); square_root: of first
    condition,  ///< first is the tape's b and second its a: a < b is tested as b > a, which is false for NaN
    sin_cos,    ///< slots sine_slot and cosine_slot = sine and cosine of second, in memory; all registers are overwritten
    call,       ///< calls the function whose address is the first argument; arguments begin at call slot `second`, results at call slot
                ///< `result_slot`; all registers are overwritten
    leave,      ///< usual outputs are stored and conditions checked; the code returns here unless all outputs are requested
  };
  TapeOperation operation = TapeOperation::constant;
  Kind kind = Kind::load;
  std::int8_t destination = 0, first = 0; ///< register numbers
  OperandPlace second;
  std::int32_t sine_slot = 0, cosine_slot = 0, result_slot = 0;
};

/// Properties of the processor's instructions.
struct RegisterRules {
  int registers = 16;
  bool has_three_operands = false; ///< otherwise the destination is the register of the first operand
};

/// The whole plan.
struct RegisterPlan {
  std::vector<PlannedInstruction> instructions;
  int slots = 0, call_slots = 0;
  bool has_later_inputs = false;
  std::uint32_t arrays = 0; ///< bit set of the output arrays in use
  int conditions = 0;
  bool has_calls = false;
};

/// Returns the order in which the steps of the tape are executed, without inputs, constants and arguments. The steps on which sines,
/// cosines and calls depend come first, so that few values must be saved across calls. Steps needed only for outputs other than the usual
/// ones come last. Otherwise the recorded order is kept.
[[nodiscard]] std::vector<std::int32_t> order_of_steps(const Tape& tape);

/// Returns the plan for the steps in `order`. Steps on which no output and no condition depends are omitted.
[[nodiscard]] RegisterPlan plan_registers(const Tape& tape, const std::vector<std::int32_t>& order, const RegisterRules& rules);

} // namespace steplap

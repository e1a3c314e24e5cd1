// Which register holds which value of a tape at which step, and what is kept in memory meanwhile.
//
// The code of a tape runs straight on, so that for every value the place of its next use is known. Where registers do not
// suffice the value leaves that is used again last (L. A. Belady, IBM Systems Journal 5 (1966) 78), preferably one that lies
// in memory already: an input, a constant, or one that had to leave before. What lies in memory is taken from there by the
// instruction that uses it, without a load of its own. Nothing of a processor's instructions is known here.
#pragma once

#include "mbd/tape/tape.h"

#include <cstdint>
#include <vector>

namespace steplap {

/// Where a value lies.
struct OperandPlace {
  enum class Kind : std::uint8_t {
    nowhere,
    in_register,
    input,
    later_input, ///< behind Tape::first_inputs
    constant,
    literal,    ///< by literal_index()
    output,     ///< in `array`
    slot,       ///< of the frame
    call_slot,  ///< the same, of the part that arguments and results of calls have to themselves
    sign_bits,  ///< the bit pattern of −0
    value_bits, ///< all bits but the sign
  };
  Kind kind = Kind::nowhere;
  std::int8_t array = 0; ///< of an output
  std::int32_t index = 0;
};

struct PlannedInstruction {
  enum class Kind : std::uint8_t {
    load,       ///< destination = second
    move,       ///< destination = second, another register
    store,      ///< second = first
    arithmetic, ///< destination = first operation second; maximum: first > second ? first : second, first being the tape's b;
                ///< negate: first ^ second, sign_bits; absolute: first & second, value_bits; square_root: of first
    condition,  ///< first is the tape's b and second its a: a < b is b > a, whose jump is not taken with NaN
    sin_cos,    ///< slots sine_slot and cosine_slot = of second, in memory; registers are lost
    call,       ///< of the function whose address is the first argument; arguments begin at the call slot `second`, results at
                ///< call slot `result_slot`; registers are lost
    leave,      ///< the usual outputs are stored, and conditions looked at: here it ends if no more is wanted
  };
  TapeOperation operation = TapeOperation::constant;
  Kind kind = Kind::load;
  std::int8_t destination = 0, first = 0; ///< registers
  OperandPlace second;
  std::int32_t sine_slot = 0, cosine_slot = 0, result_slot = 0;
};

/// What instructions can do.
struct RegisterRules {
  int registers = 16;
  bool has_three_operands = false; ///< else the destination is the first operand's register
};

struct RegisterPlan {
  std::vector<PlannedInstruction> instructions;
  int slots = 0, call_slots = 0;
  bool has_later_inputs = false;
  std::uint32_t arrays = 0; ///< of outputs, by bits
  int conditions = 0;
  bool has_calls = false;
};

/// The steps of the tape without inputs, constants and arguments, in an order in which they can be done: what sines, cosines and
/// calls hang on first, so that little has to be kept while they are found, what more is wanted than the usual outputs last, else as it stands.
[[nodiscard]] std::vector<std::int32_t> order_of_steps(const Tape& tape);

/// Steps that no output and no condition hangs on are left out of the plan.
[[nodiscard]] RegisterPlan plan_registers(const Tape& tape, const std::vector<std::int32_t>& order, const RegisterRules& rules);

} // namespace steplap

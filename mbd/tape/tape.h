// A tape: the sequence of all operations on doubles in one evaluation, without loops, indices and branches.
//
// For fixed modes an evaluation of the equations of motion always makes the same operations, on other numbers. They are recorded once
// (traced.h) and then repeated by machine code (machine_code.h). Each operation rounds according to IEEE 754, in the recorded order, so
// results are bit-identical to those of the recorded code. (A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., SIAM 2008, ch. 4.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace steplap {

enum class TapeOperation : std::uint32_t {
  input,       ///< a: index of the input
  constant,    ///< a: index of the constant, or a literal (k_one and following)
  add,         ///< a + b; here and below a and b are the steps whose values are used
  subtract,    ///< a − b
  multiply,    ///< a b
  divide,      ///< a / b
  negate,      ///< −a, also for zero
  square_root, ///< √a
  absolute,    ///< |a|
  minimum,     ///< a < b ? a : b
  maximum,     ///< a < b ? b : a
  sine,        ///< portable::sin_cos(a).sin
  cosine,      ///< portable::sin_cos(a).cos; computed together with a `sine` of the same a
  if_less,     ///< no value; the tape is valid only for a < b
  if_not_less, ///< no value; the tape is valid only for not a < b, which includes NaN
  argument,    ///< no value; a is an argument of a call, after the arguments that end with step b; b = −1: it is the first
  call,        ///< no value; calls a TapeFunction with the arguments that end with step a. The bits of the first argument are its address,
               ///< and it returns b numbers
  result,      ///< result number b of call a
};

/// A function called by a tape: computes `results` from `arguments`, the first of which is its own address. Results must depend on the
/// arguments only, and on objects that these refer to, which may change between runs of the tape.
using TapeFunction = void (*)(const double* arguments, double* results);

[[nodiscard]] constexpr bool is_condition(TapeOperation o) { return o == TapeOperation::if_less || o == TapeOperation::if_not_less; }
[[nodiscard]] constexpr bool is_given(TapeOperation o) { return o == TapeOperation::input || o == TapeOperation::constant; }
/// Returns true if other steps may use the step's value.
[[nodiscard]] constexpr bool has_value(TapeOperation o) {
  return !is_condition(o) && o != TapeOperation::argument && o != TapeOperation::call;
}
/// Returns true if exchanging a and b gives the same bits, except for which of two NaN results.
[[nodiscard]] constexpr bool is_commutative(TapeOperation o) { return o == TapeOperation::add || o == TapeOperation::multiply; }
[[nodiscard]] constexpr bool takes_two(TapeOperation o) {
  using enum TapeOperation;
  return is_commutative(o) || o == subtract || o == divide || o == minimum || o == maximum || is_condition(o);
}

/// Literals. A constant step has one of these in place of an index if its value allows simplifications, such as x · 1 = x. Tapes with
/// different literals are different tapes.
inline constexpr std::int32_t k_one = -1, k_minus_one = -2, k_zero = -3, k_minus_zero = -4;
/// Values of the literals, beginning with k_one.
inline constexpr double k_literals[] = {1.0, -1.0, 0.0, -0.0};
[[nodiscard]] constexpr bool is_literal(std::int32_t constant) { return constant < 0; }
[[nodiscard]] constexpr std::size_t literal_index(std::int32_t literal) { return static_cast<std::size_t>(-1 - literal); }

/// One operation.
struct TapeStep {
  TapeOperation operation = TapeOperation::constant;
  std::int32_t a = 0, b = 0;

  friend bool operator==(const TapeStep&, const TapeStep&) = default;
};

/// Returns true if operand b of the step is a step, too.
[[nodiscard]] constexpr bool has_second_step(const TapeStep& s) {
  return takes_two(s.operation) || (s.operation == TapeOperation::argument && s.b >= 0);
}

/// Location of an output: number of the array (CodeArrays) and index in it.
struct OutputLocation {
  std::int32_t array = 0, place = 0;

  friend bool operator==(const OutputLocation&, const OutputLocation&) = default;
};

/// A recorded computation.
struct Tape {
  std::vector<TapeStep> steps;
  std::vector<double> constants; ///< values in the recorded evaluation; another evaluation of the same tape replaces them
  int input_count = 0;
  std::vector<std::int32_t> outputs;       ///< steps whose values are outputs
  std::size_t usual_outputs = 0;           ///< number of outputs, the first ones, that may be requested alone (MachineCode::run); 0: all or
                                           ///< none
  std::int32_t first_inputs = 0;           ///< number of inputs, the first ones, that code reads from a separate array; 0: all are in one
                                           ///< array
  std::vector<OutputLocation> places = {}; ///< location of each output for code; empty: all in the first array, in order
};

/// Returns the steps that are the arguments of a call, in order.
[[nodiscard]] std::vector<std::int32_t> arguments_of(const Tape& tape, const TapeStep& call);

/// Returns a simplified tape with bit-identical results (except for the sign of a NaN) and the same indices of constants: without steps
/// that no output and no condition depends on, without repeated steps, with negations merged into other operations where possible (x + (−y)
/// is x − y), and without operations that a literal makes trivial (x · 1, x − 0). Values of constants are not used and may be missing.
/// Linear in the number of steps. Throws std::logic_error if a step uses something that is not an earlier value, or not an input or
/// constant of the tape.
[[nodiscard]] Tape simplified(const Tape& tape);

/// Executes the steps one after another. Returns false, with outputs unchanged, if a condition fails. Slow; used for comparison with other
/// methods. Array lengths are those of the tape. Precondition: `simplified` accepts the tape.
[[nodiscard]] bool replay(const Tape& tape, const double* inputs, const double* constants, double* outputs);

} // namespace steplap

// A computation written down: every operation on doubles that an evaluation makes, in its order, without the loops,
// indices and branches that led there.
//
// An evaluation of the equations of motion in one set of modes makes the same operations each time, on other numbers.
// Written down once (traced.h) they can be done again by machine code made for them (machine_code.h). Each operation rounds
// as IEEE 754 says, in the order in which it was written down: the results have the same bits as those of the code that was traced. (Tapes: A. Griewank, A. Walther, Evaluating
// Derivatives, 2nd ed., SIAM 2008, ch. 4.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace steplap {

enum class TapeOperation : std::uint32_t {
  input,       ///< a: which input
  constant,    ///< a: which constant, or which literal (k_one and those below it)
  add,         ///< a + b; a, b here and below: the steps whose values are taken
  subtract,    ///< a − b
  multiply,    ///< a b
  divide,      ///< a / b
  negate,      ///< −a, the sign of zero turned too
  square_root, ///< √a
  absolute,    ///< |a|
  minimum,     ///< a < b ? a : b
  maximum,     ///< a < b ? b : a
  sine,        ///< portable::sin_cos(a).sin
  cosine,      ///< portable::sin_cos(a).cos; behind a `sine` of the same a both are found by one call
  if_less,     ///< no value: what follows holds where a < b only
  if_not_less, ///< no value: where not a < b, as with NaN
  argument,    ///< no value: a is an argument of a call, behind those that end with step b; b = −1: it is the first
  call,        ///< no value: a TapeFunction is called. Its address is the bits of the first of the arguments that end with step a,
               ///< and it finds b numbers
  result,      ///< of the call a, number b
};

/// What a call on a tape does: finds `results` from `arguments`, of which the first is its own address. The same from the same
/// arguments, but for what the objects that these refer to are told between runs of the tape.
using TapeFunction = void (*)(const double* arguments, double* results);

[[nodiscard]] constexpr bool is_condition(TapeOperation o) { return o == TapeOperation::if_less || o == TapeOperation::if_not_less; }
[[nodiscard]] constexpr bool is_given(TapeOperation o) { return o == TapeOperation::input || o == TapeOperation::constant; }
/// Something that other steps may take.
[[nodiscard]] constexpr bool has_value(TapeOperation o) {
  return !is_condition(o) && o != TapeOperation::argument && o != TapeOperation::call;
}
/// a and b may change places: the same bits, but for which of two NaN it is.
[[nodiscard]] constexpr bool is_commutative(TapeOperation o) { return o == TapeOperation::add || o == TapeOperation::multiply; }
[[nodiscard]] constexpr bool takes_two(TapeOperation o) {
  using enum TapeOperation;
  return is_commutative(o) || o == subtract || o == divide || o == minimum || o == maximum || is_condition(o);
}

/// What a constant step has instead of a place among the constants, where its value is one that arithmetic can do without: x · 1 is x,
/// whatever x is. It is the same in all samples: one that has another value there has another tape.
inline constexpr std::int32_t k_one = -1, k_minus_one = -2, k_zero = -3, k_minus_zero = -4;
/// Those values, the one of k_one first.
inline constexpr double k_literals[] = {1.0, -1.0, 0.0, -0.0};
[[nodiscard]] constexpr bool is_literal(std::int32_t constant) { return constant < 0; }
[[nodiscard]] constexpr std::size_t literal_index(std::int32_t literal) { return static_cast<std::size_t>(-1 - literal); }

struct TapeStep {
  TapeOperation operation = TapeOperation::constant;
  std::int32_t a = 0, b = 0;

  friend bool operator==(const TapeStep&, const TapeStep&) = default;
};

/// Is b a step, too?
[[nodiscard]] constexpr bool has_second_step(const TapeStep& s) {
  return takes_two(s.operation) || (s.operation == TapeOperation::argument && s.b >= 0);
}

/// Where an output is put: one of the arrays that code writes to (CodeArrays), and its place there.
struct OutputPlace {
  std::int32_t array = 0, place = 0;

  friend bool operator==(const OutputPlace&, const OutputPlace&) = default;
};

struct Tape {
  std::vector<TapeStep> steps;
  std::vector<double> constants; ///< those of the sample that was traced; another has others in the same places
  int input_count = 0;
  std::vector<std::int32_t> outputs;    ///< the steps whose values are wanted
  std::size_t usual_outputs = 0;        ///< so many, the first ones, may be wanted alone (MachineCode::run); 0: all or none
  std::int32_t first_inputs = 0;        ///< so many, the first ones, lie apart from the others for code; 0: all lie in one array
  std::vector<OutputPlace> places = {}; ///< of each output, for code; empty: all in the first array, in their order
};

/// The steps whose values a call takes, in their order.
[[nodiscard]] std::vector<std::int32_t> arguments_of(const Tape& tape, const TapeStep& call);

/// Without what no output and no condition hangs on, with steps that are equal made once, and with signs turned where that
/// costs nothing (x + (−y) is x − y), and without what a literal does nothing to (x · 1, x − 0): the same bits, but for the sign of a NaN, and constants in the same places. Values of
/// constants are not looked at, and may be left out. Linear in the number of steps. A step that takes what is no value before it, or no input or
/// constant of the tape, is a fault of the program: std::logic_error.
[[nodiscard]] Tape simplified(const Tape& tape);

/// Does the steps one after another; false, with outputs untouched, where a condition fails. Slow: what others are compared
/// with. Arrays are as long as the tape says. Precondition: a tape that `simplified` takes.
[[nodiscard]] bool replay(const Tape& tape, const double* inputs, const double* constants, double* outputs);

} // namespace steplap

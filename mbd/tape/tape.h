// A computation written down: every operation on doubles that an evaluation makes, in its order, without the loops,
// indices and branches that led there.
//
// An evaluation of the equations of motion in one set of modes makes the same operations each time, on other numbers.
// Written down once (traced.h) they can be done again by machine code made for them (machine_code.h), for one sample or for
// several in the lanes of one register. Each operation rounds as IEEE 754 says, in the order in which it was written down:
// the results have the same bits as those of the code that was traced.
#pragma once

#include <cstdint>
#include <vector>

namespace steplap {

enum class TapeOperation : std::uint8_t {
  input,       ///< a: which input
  constant,    ///< a: which constant
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
};

struct TapeStep {
  TapeOperation operation = TapeOperation::constant;
  std::int32_t a = 0, b = 0;

  friend bool operator==(const TapeStep&, const TapeStep&) = default;
};

struct Tape {
  std::vector<TapeStep> steps;
  std::vector<double> constants;     ///< those of the sample that was traced; another has others in the same places
  int input_count = 0;
  std::vector<std::int32_t> outputs; ///< the steps whose values are wanted
};

/// Without what no output and no condition hangs on, and with steps that are equal made once: the same bits, and constants
/// in the same places.
[[nodiscard]] Tape simplified(const Tape& tape);

/// Does the steps one after another; false, with outputs untouched, where a condition fails. Slow: what others are compared with.
[[nodiscard]] bool replay(const Tape& tape, const double* inputs, const double* constants, double* outputs);

} // namespace steplap

// Tapes at random, of all operations.
#pragma once

#include "mbd/tape/tape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace steplap::testing {

struct TapeShape {
  int inputs = 10, constants = 10, steps = 200, outputs = 10;
  int reach = 50;               ///< operands are among the last so many steps: few live values; more than steps: many
  double calls = 0.01, conditions = 0.02;
};

inline Tape random_tape(std::mt19937& random, const TapeShape& shape) {
  using enum TapeOperation;
  Tape tape;
  tape.input_count = shape.inputs;
  tape.constants.assign(static_cast<std::size_t>(shape.constants), 0.0);
  std::vector<std::int32_t> values; // steps that have one
  const auto push = [&](TapeOperation o, std::int32_t a, std::int32_t b = 0) {
    if (!is_condition(o)) values.push_back(static_cast<std::int32_t>(tape.steps.size()));
    tape.steps.push_back({o, a, b});
  };
  for (int i = 0; i < shape.inputs; ++i) push(input, i);
  for (int i = 0; i < shape.constants; ++i) push(constant, i);
  const auto among = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const auto operand = [&] {
    const std::size_t n = values.size(), reach = std::min(n, static_cast<std::size_t>(shape.reach));
    return values[among(8) == 0 ? among(n) : n - 1 - among(reach)];
  };
  const TapeOperation usual[] = {add,    add,    add,      add,         subtract, subtract, subtract, multiply, multiply, multiply,
                                 divide, negate, absolute, square_root, minimum,  maximum,  input,    constant};
  for (int i = 0; i < shape.steps; ++i) {
    const double p = std::uniform_real_distribution<double>()(random);
    TapeOperation o = usual[among(std::size(usual))];
    if (p < shape.calls)
      o = among(2) == 0 ? sine : cosine;
    else if (p < shape.calls + shape.conditions)
      o = among(2) == 0 ? if_less : if_not_less;
    if ((o == input && shape.inputs == 0) || (o == constant && shape.constants == 0)) continue;
    if (is_given(o))
      push(o, static_cast<std::int32_t>(among(static_cast<std::size_t>(o == input ? shape.inputs : shape.constants))));
    else {
      const std::int32_t a = operand();
      push(o, a, takes_two(o) ? operand() : 0);
      if (o == sine && among(2) == 0) push(cosine, a);
    }
  }
  for (int k = 0; k < shape.outputs; ++k) tape.outputs.push_back(among(4) == 0 ? values[among(values.size())] : operand());
  return tape;
}

/// Numbers of all kinds: ordinary ones, and of each hundred some that are ±0, ±∞, NaN, subnormal or very large.
inline double random_number(std::mt19937& random, bool has_special) {
  static const double special[] = {0.0,
                                   -0.0,
                                   std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN(),
                                   4.9406564584124654e-324,
                                   -3e-310,
                                   1.7e308,
                                   1.0,
                                   -1.0};
  const int choice = std::uniform_int_distribution<int>(0, 99)(random);
  if (has_special && choice < 10) return special[choice];
  if (choice < 40) return std::uniform_real_distribution<double>(-2.0, 2.0)(random);
  return std::ldexp(std::uniform_real_distribution<double>(-1.0, 1.0)(random), std::uniform_int_distribution<int>(-30, 12)(random));
}

inline std::vector<double> random_numbers(std::mt19937& random, int count, bool has_special) {
  std::vector<double> numbers(static_cast<std::size_t>(count));
  for (double& x : numbers) x = random_number(random, has_special);
  return numbers;
}

} // namespace steplap::testing

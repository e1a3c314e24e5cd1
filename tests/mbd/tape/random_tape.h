// Tapes at random, of all operations.
#pragma once

#include "mbd/tape/tape.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace steplap::testing {

struct TapeShape {
  int inputs = 10, constants = 10, steps = 200, outputs = 10;
  int reach = 50; ///< operands are among the last so many steps: few live values; more than steps: many
  double calls = 0.01, conditions = 0.02;
  double functions = 0.0; ///< calls of functions of ours
};

/// Functions that a tape may call. They mix their arguments, so that one in a wrong place shows, and tell orders apart.
inline void sum_and_product(const double* x, double* found) {
  found[0] = x[1] - 2.0 * x[2];
  found[1] = x[1] * x[2];
}
inline void weighed_sum(const double* x, double* found) { // of so many that registers do not hold them
  *found = 0.0;
  for (int i = 1; i <= 40; ++i) *found = 0.5 * *found + x[i];
}
inline void many_results(const double* x, double* found) {
  for (int i = 0; i < 20; ++i) found[i] = x[1] + i;
}
struct CalledFunction {
  TapeFunction function;
  int arguments, results;
};
inline constexpr CalledFunction k_called[] = {{sum_and_product, 2, 2}, {weighed_sum, 40, 1}, {many_results, 1, 20}};

inline Tape random_tape(std::mt19937& random, const TapeShape& shape) {
  using enum TapeOperation;
  Tape tape;
  tape.input_count = shape.inputs;
  tape.constants.assign(static_cast<std::size_t>(shape.constants), 0.0);
  std::vector<std::int32_t> values; // steps that have one
  const auto push = [&](TapeOperation o, std::int32_t a, std::int32_t b = 0) {
    if (has_value(o)) values.push_back(static_cast<std::int32_t>(tape.steps.size()));
    tape.steps.push_back({o, a, b});
  };
  for (int i = 0; i < shape.inputs; ++i) push(input, i);
  for (int i = 0; i < shape.constants; ++i) push(constant, i);
  const auto among = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const auto operand = [&] {
    const std::size_t n = values.size(), reach = std::min(n, static_cast<std::size_t>(shape.reach));
    return values[among(8) == 0 ? among(n) : n - 1 - among(reach)];
  };
  const auto push_call = [&](const CalledFunction& called) {
    const auto next = [&tape] { return static_cast<std::int32_t>(tape.steps.size()); };
    tape.constants.push_back(std::bit_cast<double>(called.function));
    tape.steps.push_back({constant, static_cast<std::int32_t>(tape.constants.size()) - 1});
    tape.steps.push_back({argument, next() - 1, -1});
    for (int i = 0; i < called.arguments; ++i) {
      const std::int32_t before = next() - 1;
      tape.steps.push_back({argument, operand(), before});
    }
    tape.steps.push_back({call, next() - 1, called.results});
    const std::int32_t made = next() - 1;
    for (int i = 0; i < called.results; ++i)
      if (among(4) != 0) push(result, made, i); // some are never asked for
  };
  const TapeOperation usual[] = {add,      add,    add,    add,      subtract,    subtract, subtract, multiply, multiply,
                                 multiply, divide, negate, absolute, square_root, minimum,  maximum,  input,    constant};
  for (int i = 0; i < shape.steps; ++i) {
    const double p = std::uniform_real_distribution<double>()(random);
    TapeOperation o = usual[among(std::size(usual))];
    if (p < shape.calls) o = among(2) == 0 ? sine : cosine;
    else if (p < shape.calls + shape.conditions) o = among(2) == 0 ? if_less : if_not_less;
    else if (p < shape.calls + shape.conditions + shape.functions) {
      push_call(k_called[among(std::size(k_called))]);
      continue;
    }
    if ((o == input && shape.inputs == 0) || (o == constant && shape.constants == 0)) continue;
    if (o == constant && among(3) == 0) push(constant, k_one - static_cast<std::int32_t>(among(std::size(k_literals))));
    else if (is_given(o)) push(o, static_cast<std::int32_t>(among(static_cast<std::size_t>(o == input ? shape.inputs : shape.constants))));
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

/// Those of a sample: addresses of functions are as they are.
inline std::vector<double> random_constants(std::mt19937& random, const Tape& tape, bool has_special) {
  std::vector<double> constants = random_numbers(random, static_cast<int>(tape.constants.size()), has_special);
  for (std::size_t i = 0; i < constants.size(); ++i)
    if (tape.constants[i] != 0.0) constants[i] = tape.constants[i];
  return constants;
}

} // namespace steplap::testing

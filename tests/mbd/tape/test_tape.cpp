// Tapes: replay against the same operations written out, and simplified tapes against those that they were made of.
#include "mbd/base/portable_math.h"
#include "mbd/tape/traced.h"
#include "random_tape.h"
#include "same_bits.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace steplap;
using namespace steplap::testing;
using enum TapeOperation;

namespace {

const double k_nan = std::numeric_limits<double>::quiet_NaN();

int count(const Tape& tape, TapeOperation o) {
  return static_cast<int>(std::count_if(tape.steps.begin(), tape.steps.end(), [o](const TapeStep& s) { return s.operation == o; }));
}

// One step on inputs a and b.
double result_of(TapeOperation o, double a, double b) {
  const Tape tape{{{input, 0}, {input, 1}, {o, 0, 1}}, {}, 2, {2}};
  const double inputs[2] = {a, b};
  double output = 0.0;
  REQUIRE(replay(tape, inputs, nullptr, &output));
  return output;
}

bool holds(TapeOperation o, double a, double b) {
  const Tape tape{{{input, 0}, {input, 1}, {o, 0, 1}}, {}, 2, {0}};
  const double inputs[2] = {a, b};
  double output = 77.0;
  const bool does = replay(tape, inputs, nullptr, &output);
  CHECK(are_same_bits(output, does ? a : 77.0)); // untouched where it fails
  return does;
}

} // namespace

TEST_CASE("operations are those of C++, on zeros of both signs and NaN too") {
  for (const double a : {1.5, -2.25, 0.0, -0.0, k_nan, std::numeric_limits<double>::infinity(), 5e-324})
    for (const double b : {0.1, -3.0, 0.0, -0.0, k_nan, 1e308}) {
      CAPTURE(a);
      CAPTURE(b);
      CHECK(are_same_bits(result_of(add, a, b), a + b));
      CHECK(are_same_bits(result_of(subtract, a, b), a - b));
      CHECK(are_same_bits(result_of(multiply, a, b), a * b));
      CHECK(are_same_bits(result_of(divide, a, b), a / b));
      CHECK(are_same_bits(result_of(minimum, a, b), a < b ? a : b));
      CHECK(are_same_bits(result_of(maximum, a, b), a < b ? b : a));
      CHECK(are_same_bits(result_of(negate, a, 0), -a));
      CHECK(are_same_bits(result_of(absolute, a, 0), std::abs(a)));
      CHECK(are_same_bits(result_of(square_root, a, 0), std::sqrt(a)));
      CHECK(are_same_bits(result_of(sine, a, 0), portable::sin(a)));
      CHECK(are_same_bits(result_of(cosine, a, 0), portable::cos(a)));
      CHECK(holds(if_less, a, b) == (a < b));
      CHECK(holds(if_not_less, a, b) == !(a < b));
    }
}

TEST_CASE("constants are those of the sample, not of the tape") {
  const Tape tape{{{constant, 0}, {constant, 1}, {multiply, 0, 1}}, {2.0, 3.0}, 0, {2}};
  const double others[2] = {5.0, 7.0};
  double output = 0.0;
  REQUIRE(replay(tape, nullptr, others, &output));
  CHECK(output == 35.0);
  REQUIRE(replay(simplified(tape), nullptr, others, &output));
  CHECK(output == 35.0);
  const Tape without{tape.steps, {}, 0, tape.outputs}; // no sample's
  CHECK(simplified(without).steps == simplified(tape).steps);
}

TEST_CASE("what nothing hangs on goes, what is equal is made once") {
  // x y + y x, and a root that nobody wants
  const Tape tape{
      {{input, 0}, {input, 1}, {multiply, 0, 1}, {input, 0}, {input, 1}, {multiply, 4, 3}, {add, 2, 5}, {square_root, 0}}, {}, 2, {6}};
  const Tape simple = simplified(tape);
  CHECK(simple.steps == std::vector<TapeStep>{{input, 0}, {input, 1}, {multiply, 0, 1}, {add, 2, 2}});
  CHECK(simple.outputs == std::vector<std::int32_t>{3});
  CHECK(simple.input_count == 2);
  // a − b is not b − a, nor a / b b / a, nor the smaller of a, b that of b, a (zeros of two signs)
  for (const TapeOperation o : {subtract, divide, minimum, maximum})
    CHECK(count(simplified({{{input, 0}, {input, 1}, {o, 0, 1}, {o, 1, 0}}, {}, 2, {2, 3}}), o) == 2);
}

TEST_CASE("a condition is kept with what it hangs on, and once") {
  const Tape tape{{{input, 0}, {input, 1}, {square_root, 0}, {if_less, 2, 1}, {square_root, 0}, {if_less, 4, 1}}, {}, 2, {0}};
  CHECK(simplified(tape).steps == std::vector<TapeStep>{{input, 0}, {input, 1}, {square_root, 0}, {if_less, 2, 1}});
}

TEST_CASE("signs are turned by what takes the value") {
  // c − (−a) b = c + a b; |−a| = |a|; −a < −b where b < a
  const Tape tape{
      {{input, 0}, {input, 1}, {input, 2}, {negate, 0}, {multiply, 3, 1}, {subtract, 2, 4}, {absolute, 3}, {negate, 1}, {if_less, 3, 7}},
      {},
      3,
      {5, 6}};
  const Tape simple = simplified(tape);
  CHECK(count(simple, negate) == 0);
  CHECK(simple.steps.back() == TapeStep{if_less, 1, 0});
  // −a − b is not −(a + b): with a = −b the first is +0.
  const Tape both{{{input, 0}, {input, 1}, {negate, 0}, {negate, 1}, {add, 2, 3}, {subtract, 2, 1}}, {}, 2, {4, 5}};
  const double inputs[2] = {1.5, -1.5};
  double outputs[2] = {};
  REQUIRE(replay(simplified(both), inputs, nullptr, outputs));
  CHECK(are_same_bits(outputs[0], 0.0));
  CHECK(are_same_bits(outputs[1], 0.0));
}

TEST_CASE("a negative that is an output, a divisor, under a root") {
  const Tape tape{
      {{input, 0}, {negate, 0}, {divide, 0, 1}, {square_root, 1}, {minimum, 1, 0}, {negate, 1}, {sine, 1}}, {}, 1, {1, 2, 3, 4, 5, 6}};
  for (const double x : {2.0, -2.0, 0.0, -0.0, 5e-324}) {
    double plain[6], simple[6];
    REQUIRE(replay(tape, &x, nullptr, plain));
    REQUIRE(replay(simplified(tape), &x, nullptr, simple));
    for (int k = 0; k < 6; ++k) CHECK(are_same_bits(plain[k], simple[k]));
  }
}

// IEEE 754: x · 1, x / 1, x − 0 and x + −0 are x, whatever x is, its sign as a zero included; x + 0 is not (−0 + 0 = 0), nor is 0 − x −x.
TEST_CASE("what a literal does nothing to is left as it is, to the sign of a zero") {
  const auto steps_left = [](TapeOperation o, std::int32_t literal, bool is_first) {
    const std::int32_t a = is_first ? 1 : 0, b = is_first ? 0 : 1;
    const Tape tape{{{input, 0}, {constant, literal}, {o, a, b}}, {}, 1, {2}}, less = simplified(tape);
    for (const double x : {1.5, -2.25, 0.0, -0.0, k_nan, std::numeric_limits<double>::infinity(), 5e-324}) {
      double as_it_is = 0.0, simple = 0.0;
      REQUIRE(replay(tape, &x, nullptr, &as_it_is));
      REQUIRE(replay(less, &x, nullptr, &simple));
      CHECK(are_same_bits(as_it_is, simple));
    }
    return less.steps.size();
  };
  for (const bool is_first : {false, true}) {
    CHECK(steps_left(multiply, k_one, is_first) == 1);
    CHECK(steps_left(multiply, k_minus_one, is_first) == 2); // the input, negated
    CHECK(steps_left(multiply, k_zero, is_first) == 3);
    CHECK(steps_left(add, k_minus_zero, is_first) == 1);
    CHECK(steps_left(add, k_zero, is_first) == 3);
  }
  CHECK(steps_left(divide, k_one, false) == 1);
  CHECK(steps_left(divide, k_one, true) == 3);
  CHECK(steps_left(subtract, k_zero, false) == 1);
  CHECK(steps_left(subtract, k_zero, true) == 3);
  CHECK(steps_left(subtract, k_minus_zero, false) == 3); // x + 0
}

TEST_CASE("ones and zeros that are written down are literals, all other constants the sample's") {
  TapeNumber::start();
  const TapeNumber x = TapeNumber::input(0.5);
  TapeNumber::output(x * 1.0 + 0.0 + x * -1.0 + 3.0 * x + (x - -0.0));
  Tape tape;
  REQUIRE(TapeNumber::finish(&tape));
  CHECK(tape.constants == std::vector<double>{3.0});
  CHECK(std::count(tape.steps.begin(), tape.steps.end(), TapeStep{constant, k_minus_zero, 0}) == 1);
  double output = 0.0;
  REQUIRE(replay(tape, std::vector<double>{0.25}.data(), tape.constants.data(), &output));
  CHECK(output == 1.0); // 0.25 (1 − 1 + 3 + 1), exactly
}

TEST_CASE("random tapes have the same bits when simplified, and nothing more goes when simplified again") {
  std::mt19937 random(2026);
  int fewer = 0, held = 0;
  for (int i = 0; i < 400; ++i) {
    TapeShape shape;
    shape.steps = 1 + i;
    shape.reach = 3 + i % 97;
    shape.conditions = i % 2 == 0 ? 0.0 : 0.02;
    const Tape tape = random_tape(random, shape), simple = simplified(tape);
    fewer += simple.steps.size() < tape.steps.size();
    CHECK(simplified(simple).steps.size() == simple.steps.size());
    for (int sample = 0; sample < 3; ++sample) {
      const auto inputs = random_numbers(random, tape.input_count, true),
                 constants = random_numbers(random, static_cast<int>(tape.constants.size()), true);
      std::vector<double> plain(tape.outputs.size(), 1.25), others = plain;
      const bool holds_plain = replay(tape, inputs.data(), constants.data(), plain.data());
      CHECK(replay(simple, inputs.data(), constants.data(), others.data()) == holds_plain);
      CHECK(std::equal(plain.begin(), plain.end(), others.begin(), are_same_bits));
      held += holds_plain;
    }
  }
  CHECK(fewer > 350);
  CHECK(held > 600);
  CHECK(held < 1200);
}

TEST_CASE("random tapes that call functions have the same bits when simplified") {
  std::mt19937 random(2027);
  for (int i = 0; i < 200; ++i) {
    TapeShape shape;
    shape.steps = 1 + i;
    shape.functions = 0.1;
    shape.conditions = 0.0;
    const Tape tape = random_tape(random, shape), simple = simplified(tape);
    CHECK(simplified(simple).steps.size() == simple.steps.size());
    const auto inputs = random_numbers(random, tape.input_count, true), constants = random_constants(random, tape, true);
    std::vector<double> plain(tape.outputs.size(), 1.25), others = plain;
    CHECK(replay(tape, inputs.data(), constants.data(), plain.data()));
    CHECK(replay(simple, inputs.data(), constants.data(), others.data()));
    CHECK(std::equal(plain.begin(), plain.end(), others.begin(), are_same_bits));
  }
}

TEST_CASE("a call is made once of the same arguments, and not at all where nothing hangs on it") {
  const double address = std::bit_cast<double>(&sum_and_product);
  const std::vector<TapeStep> wanted{{input, 0},       {constant, 0}, {argument, 1, -1}, {argument, 0, 2},
                                     {argument, 0, 3}, {call, 4, 2},  {result, 5, 0},    {result, 5, 1}};
  std::vector<TapeStep> twice = wanted;
  for (std::size_t i = 2; i < wanted.size(); ++i) {
    TapeStep s = wanted[i];
    if (s.operation != argument) s.a += 6;
    else if (s.b >= 0) s.b += 6;
    twice.push_back(s);
  }
  const Tape simple = simplified({twice, {address}, 1, {6, 13}});
  CHECK(simple.steps == wanted);
  CHECK(simple.outputs == std::vector<std::int32_t>{6, 7});
  CHECK(simplified({wanted, {address}, 1, {0}}).steps == std::vector<TapeStep>{{input, 0}});
}

TEST_CASE("what a tape calls is written down with its results, and is a constant where all that it takes is") {
  const auto add_up = [](const double* of, double* found) {
    found[0] = of[1] + of[2];
    found[1] = of[1] - of[2];
  };
  Tape tape;
  TapeNumber::start();
  const TapeNumber x = TapeNumber::input(0.75), given[] = {x, TapeNumber(2.0)}, known[] = {TapeNumber(3.0), TapeNumber(2.0)};
  TapeNumber found[2], fixed[2];
  TapeNumber::call(add_up, given, found);
  TapeNumber::call(add_up, known, fixed);
  CHECK(fixed[0].is_constant());
  CHECK(value_of(fixed[1]) == 1.0);
  CHECK_FALSE(found[0].is_constant());
  CHECK(value_of(found[1]) == -1.25);
  for (const TapeNumber& y : found) TapeNumber::output(y * x);
  TapeNumber::output(atan2(x, TapeNumber(2.0)));
  REQUIRE(TapeNumber::finish(&tape));
  double output[3];
  const double other = 1.5;
  REQUIRE(replay(tape, &other, tape.constants.data(), output));
  CHECK(output[0] == 5.25);
  CHECK(output[1] == -0.75);
  CHECK(are_same_bits(output[2], portable::atan2(1.5, 2.0)));
}

TEST_CASE("a tape that takes what there is not is refused") {
  const Tape wrong[] = {{{{input, 1}}, {}, 1, {}},
                        {{{input, -1}}, {}, 1, {}},
                        {{{constant, 1}}, {0.5}, 1, {}},
                        {{{constant, k_minus_zero - 1}}, {}, 1, {}},
                        {{{input, 0}, {add, 0, 1}}, {}, 1, {}},
                        {{{input, 0}, {negate, 2}, {negate, 0}}, {}, 1, {}},
                        {{{input, 0}, {if_less, 0, 0}, {add, 0, 1}}, {}, 1, {}},
                        {{{input, 0}, {if_less, 0, 0}}, {}, 1, {1}},
                        {{{input, 0}, {argument, 0, 0}}, {}, 1, {}},
                        {{{input, 0}, {argument, 0, 2}, {argument, 0, -1}}, {}, 1, {}},
                        {{{input, 0}, {call, 0, 1}}, {}, 1, {}},
                        {{{input, 0}, {argument, 0, -1}, {call, 1, 0}}, {}, 1, {}},
                        {{{input, 0}, {argument, 0, -1}, {call, 1, 1}, {result, 2, 1}}, {}, 1, {}},
                        {{{input, 0}, {argument, 0, -1}, {result, 1, 0}}, {}, 1, {}},
                        {{{input, 0}, {argument, 0, -1}, {add, 0, 1}}, {}, 1, {}},
                        {{{input, 0}, {argument, 0, -1}, {call, 1, 1}}, {}, 1, {2}},
                        {{{input, 0}}, {}, 1, {1}},
                        {{{input, 0}}, {}, 1, {-1}}};
  for (const Tape& tape : wrong) CHECK_THROWS_AS(static_cast<void>(simplified(tape)), std::logic_error);
}

namespace {

// What another sample does, with another number of the file, on another branch, or with more of it.
struct Written {
  double number = 2.0, x = 0.5;
  int turns = 3;

  void write() const {
    const TapeNumber a = TapeNumber::input(x), b = TapeNumber::input(x + 1.0);
    TapeNumber sum(0.0);
    for (int i = 0; i < turns; ++i) sum += number * a - b / (number + i);
    if (sum < b) sum = sqrt(abs(sum));
    TapeNumber::output(sum);
    TapeNumber::end_usual_outputs();
    TapeNumber::output(sum * number);
  }
  [[nodiscard]] Tape tape() const {
    Tape tape;
    TapeNumber::start();
    write();
    REQUIRE(TapeNumber::finish(&tape));
    return tape;
  }
  [[nodiscard]] bool is(const Tape& known, std::vector<double>& constants) const {
    Tape tape;
    TapeNumber::start(&known);
    write();
    const bool is_same = TapeNumber::finish(&tape);
    constants = tape.constants;
    return is_same;
  }
};

} // namespace

TEST_CASE("of a tape that is known only the constants are gathered, and what is another tape is told") {
  const Tape known = Written{}.tape();
  CHECK(known.usual_outputs == 1);
  CHECK(known.outputs.size() == 2);
  std::vector<double> constants;
  CHECK(Written{}.is(known, constants));
  CHECK(constants == known.constants);
  const Written other{.number = 1.5};
  CHECK(other.is(known, constants));
  CHECK(constants == other.tape().constants); // as if it had been written
  CHECK(other.tape().steps == known.steps);
  CHECK_FALSE(Written{.x = 3.0}.is(known, constants)); // on the other branch
  CHECK_FALSE(Written{.turns = 4}.is(known, constants));
  CHECK_FALSE(Written{.turns = 2}.is(known, constants));
  Tape others = known;
  others.outputs.back() = known.outputs.front();
  CHECK_FALSE(Written{}.is(others, constants));
  CHECK_FALSE(Written{}.is(Tape{}, constants));
  CHECK(Written{}.tape().steps == known.steps); // nothing of it is left behind
}

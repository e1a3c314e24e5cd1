#include "mbd/tape/tape.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

namespace steplap {

namespace {

using enum TapeOperation;

double result_of(TapeOperation o, double a, double b) {
  switch (o) {
  case add: return a + b;
  case subtract: return a - b;
  case multiply: return a * b;
  case divide: return a / b;
  case negate: return -a;
  case square_root: return std::sqrt(a);
  case absolute: return std::abs(a);
  case minimum: return a < b ? a : b;
  case maximum: return a < b ? b : a;
  case sine: return portable::sin_cos(a).sin;
  default: return portable::sin_cos(a).cos;
  }
}

// Throws std::logic_error for a tape whose steps use steps that do not exist, or come later: an error of the recorder.
class TapeCheck {
public:
  explicit TapeCheck(const Tape& tape) : tape_(tape), has_constants_(!tape.constants.empty()) {}

  void step(std::size_t i) const {
    const TapeStep& s = tape_.steps[i];
    if (s.operation == input) return need(s.a >= 0 && s.a < tape_.input_count, i);
    if (s.operation == constant) return need(is_constant(s.a), i);
    if (s.operation == argument) return need(is_value_before(s.a, i) && (s.b == -1 || is_before(argument, s.b, i)), i);
    if (s.operation == call) return need(is_before(argument, s.a, i) && s.b > 0, i);
    if (s.operation == result) return need(is_before(call, s.a, i) && s.b >= 0 && s.b < tape_.steps[static_cast<std::size_t>(s.a)].b, i);
    need(is_value_before(s.a, i) && (!takes_two(s.operation) || is_value_before(s.b, i)), i);
  }

  void output(std::size_t k) const {
    if (!is_value_before(tape_.outputs[k], tape_.steps.size()))
      throw std::logic_error("tape: output " + std::to_string(k) + " is no value");
  }

private:
  bool is_constant(std::int32_t a) const {
    if (is_literal(a)) return literal_index(a) < std::size(k_literals);
    return !has_constants_ || static_cast<std::size_t>(a) < tape_.constants.size();
  }
  bool is_value_before(std::int32_t step, std::size_t i) const {
    return step >= 0 && static_cast<std::size_t>(step) < i && has_value(tape_.steps[static_cast<std::size_t>(step)].operation);
  }
  bool is_before(TapeOperation o, std::int32_t step, std::size_t i) const {
    return step >= 0 && static_cast<std::size_t>(step) < i && tape_.steps[static_cast<std::size_t>(step)].operation == o;
  }
  static void need(bool holds, std::size_t i) {
    if (!holds) throw std::logic_error("tape: step " + std::to_string(i) + " takes what is no value before it");
  }

  const Tape& tape_;
  const bool has_constants_;
};

/// Step of the simplified tape, possibly with opposite sign. A negation needs no step of its own if the operation that uses it can absorb
/// it: x + (−y) = x − y, (−x) y = −(x y), bit-identical.
struct Signed {
  std::int32_t step = -1;
  bool is_negative = false;
};

/// Simplifies a tape and removes repeated steps, which are found by a hash table with open addressing. At most two steps are made for each
/// step of the tape.
class Simplifier {
public:
  explicit Simplifier(const Tape& tape) : tape_(tape), table_(std::bit_ceil(4 * tape.steps.size() + 4), -1), value_(tape.steps.size()) {
    made_.reserve(tape.steps.size());
  }

  Tape simplified() {
    const TapeCheck check(tape_);
    for (std::size_t i = 0; i < tape_.steps.size(); ++i) {
      check.step(i);
      value_[i] = value_of(tape_.steps[i]);
    }
    std::vector<std::int32_t> outputs(tape_.outputs.size());
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      check.output(k);
      outputs[k] = plain(at(tape_.outputs[k]));
    }
    return with_what_counts(std::move(outputs));
  }

private:
  Signed at(std::int32_t step) const { return value_[static_cast<std::size_t>(step)]; }

  std::int32_t make(TapeOperation o, std::int32_t a, std::int32_t b = 0) {
    if (is_commutative(o) && b < a) std::swap(a, b); // gives the same rounding
    const std::size_t mask = table_.size() - 1;
    std::uint64_t hash = (static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b)) * 0x9e3779b97f4a7c15u;
    hash = (hash ^ hash >> 32 ^ static_cast<std::uint64_t>(o)) * 0xd6e8feb86659fd93u;
    const TapeStep step{o, a, b};
    for (std::size_t i = hash >> 32 & mask;; i = (i + 1) & mask) {
      if (table_[i] < 0) {
        table_[i] = static_cast<std::int32_t>(made_.size());
        made_.push_back(step);
        return table_[i];
      }
      if (made_[static_cast<std::size_t>(table_[i])] == step) return table_[i];
    }
  }

  std::int32_t plain(Signed x) {
    if (!x.is_negative) return x.step;
    if (is(x, k_one)) return make(constant, k_minus_one);
    if (is(x, k_zero)) return make(constant, k_minus_zero);
    return make(negate, x.step);
  }

  // Returns true if the step of x is the given literal; the sign of x is ignored.
  bool is(Signed x, std::int32_t literal) const { return made_[static_cast<std::size_t>(x.step)] == TapeStep{constant, literal, 0}; }

  Signed given(const TapeStep& s) {
    const bool is_negative = s.operation == constant && (s.a == k_minus_one || s.a == k_minus_zero);
    return {make(s.operation, is_negative ? s.a + 1 : s.a), is_negative};
  }

  static Signed turned(Signed x, bool is_turned) { return {x.step, x.is_negative != is_turned}; }

  // Returns a + b. Adding −0 changes nothing, not even the sign of a zero. If both terms are negative, −a − b is not replaced by −(a + b),
  // whose zero would have the other sign.
  Signed sum(Signed a, Signed b) {
    if (b.is_negative && is(b, k_zero)) return a;
    if (a.is_negative && is(a, k_zero)) return b;
    if (b.is_negative) return {make(subtract, plain(a), b.step)};
    if (a.is_negative) return {make(subtract, b.step, a.step)};
    return {make(add, a.step, b.step)};
  }

  Signed value_of(const TapeStep& s) {
    const TapeOperation o = s.operation;
    if (is_given(o)) return given(s);
    if (o == argument) return {make(o, plain(at(s.a)), s.b < 0 ? s.b : at(s.b).step)};
    if (o == call || o == result) return {make(o, at(s.a).step, s.b)};
    const Signed a = at(s.a), b = takes_two(o) ? at(s.b) : a;
    switch (o) {
    case add: return sum(a, b);
    case subtract: return sum(a, {b.step, !b.is_negative});
    case multiply:
      if (is(a, k_one)) return turned(b, a.is_negative);
      [[fallthrough]];
    case divide:
      if (is(b, k_one)) return turned(a, b.is_negative);
      return {make(o, a.step, b.step), a.is_negative != b.is_negative};
    case negate: return {a.step, !a.is_negative};
    case absolute: return made_[static_cast<std::size_t>(a.step)].operation == absolute ? Signed{a.step} : Signed{make(o, a.step)};
    case if_less:
    case if_not_less:
      if (a.is_negative && b.is_negative) return {make(o, b.step, a.step)};
      return {make(o, plain(a), plain(b))};
    case minimum:
    case maximum: return {make(o, plain(a), plain(b))};
    default: return {make(o, plain(a))};
    }
  }

  // Returns the tape with only those steps that an output or a condition depends on, renumbered.
  Tape with_what_counts(std::vector<std::int32_t> outputs) {
    std::vector<std::int32_t> number(made_.size(), 0); // 1 for the steps needed, then their numbers
    for (const std::int32_t output : outputs) number[static_cast<std::size_t>(output)] = 1;
    for (std::size_t i = made_.size(); i-- > 0;) {
      const TapeStep& s = made_[i];
      if (is_condition(s.operation)) number[i] = 1;
      if (number[i] == 0 || is_given(s.operation)) continue;
      number[static_cast<std::size_t>(s.a)] = 1;
      if (has_second_step(s)) number[static_cast<std::size_t>(s.b)] = 1;
    }
    Tape result{{}, tape_.constants, tape_.input_count, std::move(outputs), tape_.usual_outputs, tape_.first_inputs, tape_.places};
    result.steps.reserve(made_.size());
    for (std::size_t i = 0; i < made_.size(); ++i) {
      if (number[i] == 0) continue;
      TapeStep s = made_[i];
      number[i] = static_cast<std::int32_t>(result.steps.size());
      if (!is_given(s.operation)) s.a = number[static_cast<std::size_t>(s.a)];
      if (has_second_step(s)) s.b = number[static_cast<std::size_t>(s.b)];
      result.steps.push_back(s);
    }
    for (std::int32_t& output : result.outputs) output = number[static_cast<std::size_t>(output)];
    return result;
  }

  const Tape& tape_;
  std::vector<std::int32_t> table_; ///< indices of steps by hash, −1: empty; the size is a power of two
  std::vector<TapeStep> made_;
  std::vector<Signed> value_; ///< for each step of the original tape
};

// Returns the value of a step that is not a call, an argument or a result of one.
double value_of(const TapeStep& s, const double* inputs, const double* constants, const std::vector<double>& values) {
  if (s.operation == input) return inputs[s.a];
  if (s.operation == constant) return is_literal(s.a) ? k_literals[literal_index(s.a)] : constants[s.a];
  return result_of(s.operation, values[static_cast<std::size_t>(s.a)],
                   takes_two(s.operation) ? values[static_cast<std::size_t>(s.b)] : 0.0);
}

/// Results of the calls of a tape.
class CallResults {
public:
  void call(const Tape& tape, std::size_t i, const std::vector<double>& values) {
    const TapeStep& s = tape.steps[i];
    std::vector<double> arguments;
    for (const std::int32_t step : arguments_of(tape, s)) arguments.push_back(values[static_cast<std::size_t>(step)]);
    std::vector<double>& results = of_call_[static_cast<std::int32_t>(i)];
    results.resize(static_cast<std::size_t>(s.b));
    std::bit_cast<TapeFunction>(arguments.front())(arguments.data(), results.data());
  }
  double of(const TapeStep& s) const { return of_call_.at(s.a)[static_cast<std::size_t>(s.b)]; }

private:
  std::unordered_map<std::int32_t, std::vector<double>> of_call_; ///< by step
};

} // namespace

std::vector<std::int32_t> arguments_of(const Tape& tape, const TapeStep& call) {
  std::vector<std::int32_t> values;
  for (std::int32_t i = call.a; i >= 0; i = tape.steps[static_cast<std::size_t>(i)].b)
    values.push_back(tape.steps[static_cast<std::size_t>(i)].a);
  std::reverse(values.begin(), values.end());
  return values;
}

Tape simplified(const Tape& tape) { return Simplifier(tape).simplified(); }

bool replay(const Tape& tape, const double* inputs, const double* constants, double* outputs) {
  std::vector<double> values(tape.steps.size());
  CallResults found;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const TapeStep& s = tape.steps[i];
    if (is_condition(s.operation)) {
      const bool is_less = values[static_cast<std::size_t>(s.a)] < values[static_cast<std::size_t>(s.b)];
      if (is_less != (s.operation == if_less)) return false;
    } else if (s.operation == call) {
      found.call(tape, i, values);
    } else if (s.operation == result) {
      values[i] = found.of(s);
    } else if (s.operation != argument) {
      values[i] = value_of(s, inputs, constants, values);
    }
  }
  for (std::size_t k = 0; k < tape.outputs.size(); ++k) outputs[k] = values[static_cast<std::size_t>(tape.outputs[k])];
  return true;
}

} // namespace steplap
